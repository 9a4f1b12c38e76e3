// A picture's memory: one cell of W_PIXEL bits a pixel, in columns that need no address arithmetic.
//
//   pixel (x, y)  ->  column x >> STRIDE_BITS,  address {y, x[STRIDE_BITS-1:0]}
//
//        x:  0 .. 31 | 32 .. 63 | ... | 608 .. 639          640x480: 20 columns of 480 x 32 = 15,360 cells,
//   column:     0    |    1     | ... |     19              each one block RAM of 16,384 x 1
//
// So a picture whose width is COLUMNS << STRIDE_BITS wastes almost nothing, writing decodes an address instead of
// multiplying, and a cell is written without reading its neighbours.
//
// Port `draw` writes: the cells of one column, only the planes (bits) that `draw_mask` names. Port `scan` reads `scan_column` of
// the address, two clocks later, or clears the address in all columns. In a clock with `scan_clear` nothing is read.
// Block RAM has a clock for each port; with SPRAM (iCE40UP5K, 5 to 8 columns of one bit) both must be the same clock, and
// the ports may not be used in the same clock: a picture is either drawn or shown.
`default_nettype none

module plane_memory #(
    parameter int SPRAM       = 0,
    parameter int W_PIXEL     = 1,
    parameter int COLUMNS     = 20,
    parameter int STRIDE_BITS = 5,
    parameter int HEIGHT      = 480,
    parameter int W_COLUMN    = $clog2(COLUMNS),
    parameter int W_ADDRESS   = $clog2(HEIGHT) + STRIDE_BITS
) (
    input  wire logic                 draw_clk,
    input  wire logic                 draw_write,
    input  wire logic [ W_COLUMN-1:0] draw_column,
    input  wire logic [W_ADDRESS-1:0] draw_address,
    input  wire logic [  W_PIXEL-1:0] draw_pixel,
    input  wire logic [  W_PIXEL-1:0] draw_mask,
    input  wire logic                 scan_clk,
    input  wire logic                 scan_clear,
    input  wire logic [ W_COLUMN-1:0] scan_column,
    input  wire logic [W_ADDRESS-1:0] scan_address,
    output logic      [  W_PIXEL-1:0] scan_pixel
);
    logic [ COLUMNS-1:0][W_PIXEL-1:0] read;
    logic [W_COLUMN-1:0]              read_column;

    generate
        if (SPRAM != 0) begin : g_spram
            logic unused_clk;
            logic unused_mask;
            assign unused_clk  = draw_clk;
            assign unused_mask = &draw_mask;
            plane_memory_spram #(
                .COLUMNS  (COLUMNS),
                .W_COLUMN (W_COLUMN),
                .W_ADDRESS(W_ADDRESS)
            ) i_cells (
                .clk         (scan_clk),
                .draw_write  (draw_write),
                .draw_column (draw_column),
                .draw_address(draw_address),
                .draw_pixel  (draw_pixel[0]),
                .scan_clear  (scan_clear),
                .scan_address(scan_address),
                .scan_cells  (read)
            );
        end else begin : g_block
            for (genvar c = 0; c < COLUMNS; c++) begin : g_column
                for (genvar p = 0; p < W_PIXEL; p++) begin : g_plane
                    plane_memory_block #(
                        .DEPTH    (HEIGHT << STRIDE_BITS),
                        .W_ADDRESS(W_ADDRESS)
                    ) i_cells (
                        .draw_clk    (draw_clk),
                        .draw_write  (draw_write && draw_column == W_COLUMN'(c) && draw_mask[p]),
                        .draw_address(draw_address),
                        .draw_pixel  (draw_pixel[p]),
                        .scan_clk    (scan_clk),
                        .scan_clear  (scan_clear),
                        .scan_address(scan_address),
                        .scan_pixel  (read[c][p])
                    );
                end
            end
        end
    endgenerate

    always_ff @(posedge scan_clk) begin
        read_column <= scan_column;
        scan_pixel  <= read[read_column];
    end
endmodule

`default_nettype wire
