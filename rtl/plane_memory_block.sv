// One column of a plane in block RAM: one bit wide, written by one clock, read or cleared by another.
//
// `scan_pixel` is the cell at `scan_address` one clock later; it keeps its value in a clock with `scan_clear`. What is read while
// the other port writes the same cell is not defined; nobody does that, because a picture is either drawn or shown.
`default_nettype none

module plane_memory_block #(
    parameter int DEPTH     = 15360,
    parameter int W_ADDRESS = 14
) (
    input  wire logic                 draw_clk,
    input  wire logic                 draw_write,
    input  wire logic [W_ADDRESS-1:0] draw_address,
    input  wire logic                 draw_pixel,
    input  wire logic                 scan_clk,
    input  wire logic                 scan_clear,
    input  wire logic [W_ADDRESS-1:0] scan_address,
    output logic                      scan_pixel
);
    // Two ports write one memory, each in its own clock: that is what a dual-port RAM is.
    // verilator lint_off MULTIDRIVEN
    (* no_rw_check, ram_style = "block" *) logic cells[0:DEPTH-1];
    // verilator lint_on MULTIDRIVEN

    always @(posedge draw_clk) begin
        if (draw_write) cells[draw_address] <= draw_pixel;
    end

    always @(posedge scan_clk) begin
        if (scan_clear) cells[scan_address] <= 1'b0;
        else scan_pixel <= cells[scan_address];
    end
endmodule

`default_nettype wire
