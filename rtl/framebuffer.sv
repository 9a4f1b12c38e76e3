// Two pictures in block RAM: one is drawn while the other is shown, and the shown one is cleared while it is scanned.
//
//   draw side                                   scan side
//   -----------------------------------------   -------------------------------------------------------------
//   draw_enable: the picture behind is clear    draw_done seen -> clear the rows that the beam has left
//   pixels s_x, s_y, s_pixel, s_mask            beam in the blank -> swap; clear the rest of the picture behind
//   draw_done (one clock) -> draw_enable = 0    all clear -> draw_enable = 1
//
// So nothing half drawn is ever shown, and a picture that is not finished when a scan begins leaves the old one on the screen
// (system A cleared for 64,000 clocks of every frame and flickered). Clearing takes one clock an address; an address holds
// COLUMNS pixels, and what the blanks of the lines cannot do is done behind, so drawing waits a few thousand clocks at worst.
//
// W_PIXEL is 1 for a wireframe plane, 2 for a plane an eye, 8 to 24 for a colour framebuffer of any output format; `s_mask`
// names the bits that a pixel writes. Pixels beyond the picture are dropped. `scan_pixel` is three clocks behind `scan_x`
// and `scan_y`, and all zeros until the first picture is finished.
//
// The two sides may have different clocks: only two levels cross, each through two registers. Clearing behind the beam relies on
// rows that are shown in order, each for the last time before the next.
`default_nettype none

module framebuffer #(
    parameter int SPRAM       = 0,
    parameter int W_PIXEL     = 1,
    parameter int COLUMNS     = 20,
    parameter int STRIDE_BITS = 5,
    parameter int HEIGHT      = 480,
    parameter int W_X         = $clog2(COLUMNS) + STRIDE_BITS,
    parameter int W_Y         = $clog2(HEIGHT)
) (
    input  wire logic               draw_clk,
    input  wire logic               draw_rst_n,
    output logic                    draw_enable,
    input  wire logic               draw_done,
    input  wire logic               s_valid,
    output logic                    s_ready,
    input  wire logic [    W_X-1:0] s_x,
    input  wire logic [    W_Y-1:0] s_y,
    input  wire logic [W_PIXEL-1:0] s_pixel,
    input  wire logic [W_PIXEL-1:0] s_mask,
    input  wire logic               scan_clk,
    input  wire logic               scan_rst_n,
    input  wire logic               scan_read,
    input  wire logic               scan_blank,
    input  wire logic [    W_X-1:0] scan_x,
    input  wire logic [    W_Y-1:0] scan_y,
    output logic      [W_PIXEL-1:0] scan_pixel,
    output logic                    scan_swapped
);
    localparam int W_COLUMN = W_X - STRIDE_BITS;
    localparam int W_ADDRESS = W_Y + STRIDE_BITS;
    localparam logic [W_ADDRESS-1:0] LAST = W_ADDRESS'((HEIGHT << STRIDE_BITS) - 1);

    // ------------------------------------------------------------------------------------------------------- draw side
    logic                 granted;  // changes when a clear picture is handed over
    logic                 drawn;  // changes when it is finished
    logic                 granted_here;
    logic                 front;  // which picture is shown; changes only while nothing is drawn
    logic                 visible;
    logic [          1:0] write;
    logic [ W_COLUMN-1:0] write_column;
    logic [W_ADDRESS-1:0] write_address;
    logic [  W_PIXEL-1:0] write_pixel;
    logic [  W_PIXEL-1:0] write_mask;

    synchronise i_granted (
        .clk  (draw_clk),
        .rst_n(draw_rst_n),
        .s    (granted),
        .m    (granted_here)
    );

    assign draw_enable = granted_here != drawn;
    assign s_ready     = draw_enable;
    assign visible      = {1'b0, s_x} < (W_X + 1)'(COLUMNS << STRIDE_BITS) && {1'b0, s_y} < (W_Y + 1)'(HEIGHT);

    always_ff @(posedge draw_clk) begin
        write[0]      <= s_valid && s_ready && visible && front;
        write[1]      <= s_valid && s_ready && visible && !front;
        write_column  <= s_x[W_X-1:STRIDE_BITS];
        write_address <= {s_y, s_x[STRIDE_BITS-1:0]};
        write_pixel   <= s_pixel;
        write_mask    <= s_mask;
        if (!draw_rst_n) begin
            drawn <= 1'b0;
            write <= '0;
        end else if (draw_done && draw_enable) begin
            drawn <= granted_here;
        end
    end

    // ------------------------------------------------------------------------------------------------------- scan side
    logic                      drawn_here;
    logic                      finished;  // the picture behind is complete
    logic                      swapped;  // and has come to the front since
    logic                      cleared;
    logic                      scanned;  // what is shown is being scanned, or has been
    logic                      started;  // at least one clear picture was handed over
    logic                      shown;
    logic                      begun;  // the beam is in the picture
    logic                      trailing;
    logic                      clear;
    logic                      target;
    logic      [W_ADDRESS-1:0] clear_address;
    logic [1:0]                plane_clear;
    logic [1:0][W_ADDRESS-1:0] plane_address;
    logic [1:0][  W_PIXEL-1:0] plane_pixel;
    logic      [ W_COLUMN-1:0] column;

    synchronise i_drawn (
        .clk  (scan_clk),
        .rst_n(scan_rst_n),
        .s    (drawn),
        .m    (drawn_here)
    );

    assign finished = drawn_here == granted;
    // A row that the beam has left, in a clock in which nothing is read.
    assign trailing = begun && !scan_read && clear_address[W_ADDRESS-1:STRIDE_BITS] < scan_y;
    assign clear    = finished && !cleared && (swapped || trailing);
    assign target   = swapped ? !front : front;

    always_ff @(posedge scan_clk) begin
        column <= scan_x[W_X-1:STRIDE_BITS];
        for (int i = 0; i < 2; i++) begin
            plane_clear[i]   <= clear && target == 1'(i);
            plane_address[i] <= clear && target == 1'(i) ? clear_address : {scan_y, scan_x[STRIDE_BITS-1:0]};
        end
        scan_swapped <= 1'b0;
        if (clear) begin
            clear_address <= clear_address + 1'b1;
            if (clear_address == LAST) cleared <= 1'b1;
        end
        // The memory's power-up content is no picture: what is handed over first needs no blank to hide the swap.
        begun <= !scan_blank && (begun || scan_read);
        if (begun) scanned <= 1'b1;
        if (finished && !swapped && ((scan_blank && scanned) || !started)) begin
            scanned      <= 1'b0;
            swapped      <= 1'b1;
            scan_swapped <= started;
            front        <= !front;
            shown        <= started;
        end
        if (finished && swapped && cleared) begin
            granted       <= !granted;
            started       <= 1'b1;
            swapped       <= 1'b0;
            cleared       <= 1'b0;
            clear_address <= '0;
        end
        if (!scan_rst_n) begin
            granted       <= 1'b0;
            front         <= 1'b0;
            started       <= 1'b0;
            shown         <= 1'b0;
            scanned       <= 1'b0;
            swapped       <= 1'b0;
            cleared       <= 1'b0;
            clear_address <= '0;
            plane_clear   <= '0;
        end
    end

    generate
        for (genvar i = 0; i < 2; i++) begin : g_plane
            plane_memory #(
                .SPRAM      (SPRAM),
                .W_PIXEL    (W_PIXEL),
                .COLUMNS    (COLUMNS),
                .STRIDE_BITS(STRIDE_BITS),
                .HEIGHT     (HEIGHT)
            ) i_memory (
                .draw_clk    (draw_clk),
                .draw_write  (write[i]),
                .draw_column (write_column),
                .draw_address(write_address),
                .draw_pixel  (write_pixel),
                .draw_mask   (write_mask),
                .scan_clk    (scan_clk),
                .scan_clear  (plane_clear[i]),
                .scan_column (column),
                .scan_address(plane_address[i]),
                .scan_pixel  (plane_pixel[i])
            );
        end
    endgenerate

    assign scan_pixel = shown ? plane_pixel[front] : '0;
endmodule

`default_nettype wire
