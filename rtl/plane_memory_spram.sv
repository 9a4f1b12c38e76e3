// The columns of a one-bit plane in single-port RAM of 16,384 x 16 (iCE40UP5K's SB_SPRAM256KA, which yosys infers).
//
// That RAM can write four bits on their own, so a column is four equal bits of a word: 5 columns take two RAMs. Drawing, clearing
// and reading share the port; drawing comes first.
`default_nettype none

module plane_memory_spram #(
    parameter int COLUMNS   = 5,
    parameter int W_COLUMN  = 3,
    parameter int W_ADDRESS = 14
) (
    input  wire logic                 clk,
    input  wire logic                 draw_write,
    input  wire logic [ W_COLUMN-1:0] draw_column,
    input  wire logic [W_ADDRESS-1:0] draw_address,
    input  wire logic                 draw_pixel,
    input  wire logic                 scan_clear,
    input  wire logic [W_ADDRESS-1:0] scan_address,
    output logic      [  COLUMNS-1:0] scan_cells
);
    (* ram_style = "huge" *) logic [4*COLUMNS-1:0] cells[0:(1<<W_ADDRESS)-1];

    logic [  COLUMNS-1:0] write;
    logic [W_ADDRESS-1:0] address;
    logic [4*COLUMNS-1:0] word;
    logic [4*COLUMNS-1:0] data;

    assign address = draw_write ? draw_address : scan_address;
    assign data    = {4 * COLUMNS{draw_write && draw_pixel}};

    always_comb begin
        for (int c = 0; c < COLUMNS; c++) begin
            write[c]      = draw_write ? draw_column == W_COLUMN'(c) : scan_clear;
            scan_cells[c] = word[4*c];
        end
    end

    always_ff @(posedge clk) begin
        for (int c = 0; c < COLUMNS; c++) begin
            if (write[c]) cells[address][4*c+:4] <= data[4*c+:4];
        end
        if (write == '0) word <= cells[address];
    end

    // Three of a column's four bits repeat the first.
    logic unused_word;
    assign unused_word = &word;
endmodule

`default_nettype wire
