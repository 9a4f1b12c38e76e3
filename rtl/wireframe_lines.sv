// The edges of a wireframe: from two projected ends to pixels on the screen.
//
//   s_end_ -> end b -> end a -> line_clipped (CLIP 1) or line (CLIP 0) -> m_
//
// Ends enter one after the other with `take`: a, then b. The edge that they make is drawn with `s_valid`, until `s_ready`, if the
// ends' flags and sides allow that: the user of this module looks at them.
//
//   | s_end_x, s_end_y     | column and row, W bits with sign, in the guard band (CLIP 1) or on the screen (CLIP 0)          |
//   | flags_a, flags_b     | of the ends as they came: 0 where the end can be drawn to                                       |
//   | sides_a, sides_b     | of the screen that an end lies beyond: 1 left, 2 right, 4 above, 8 below; 0 with CLIP 0         |
//   | s_on_screen          | both ends are on the screen, so that nothing must be clipped                                    |
//   | s_group              | of the edge, 0 to 3 (TAGGED 1)                                                                  |
//   | s_volume_, m_volume_ | clip coordinates through the clip stage, which is line_clipped's; `volume_idle`: nothing in it  |
//   | m_x, m_y             | a pixel's column and row, below `width` and `height`                                            |
//   | m_steep, m_group     | of the pixel's line (TAGGED 1: draw an edge only while `busy` is low)                           |
//   | busy                 | pixels of an edge are still to come; a clock after the edge was taken                           |
//
// Clocks: 1 a pixel, at least 1 an edge; clip's where an edge crosses the screen's border.
`default_nettype none

module wireframe_lines #(
    parameter int W_SCREEN = 10,
    parameter int W        = 23,
    parameter int TAGGED   = 0,
    parameter int CLIP     = 1
) (
    input  wire logic                clk,
    input  wire logic                rst_n,
    input  wire logic [  W_SCREEN:0] width,
    input  wire logic [  W_SCREEN:0] height,
    // The ends.
    input  wire logic                take,
    input  wire logic signed [W-1:0] s_end_x,
    input  wire logic signed [W-1:0] s_end_y,
    input  wire logic [         2:0] s_end_flags,
    output logic      [         2:0] flags_a,
    output logic      [         2:0] flags_b,
    output logic      [         3:0] sides_a,
    output logic      [         3:0] sides_b,
    // The clip stage.
    input  wire logic                s_volume_valid,
    output logic                     s_volume_ready,
    input  wire logic signed [31:0]  s_volume_data,
    output logic                     m_volume_valid,
    input  wire logic                m_volume_ready,
    output logic signed [31:0]       m_volume_data,
    output logic                     volume_idle,
    // The edge, and its pixels.
    input  wire logic                s_valid,
    output logic                     s_ready,
    input  wire logic                s_on_screen,
    input  wire logic [         1:0] s_group,
    output logic                     busy,
    output logic                     m_valid,
    input  wire logic                m_ready,
    output logic      [W_SCREEN-1:0] m_x,
    output logic      [W_SCREEN-1:0] m_y,
    output logic                     m_steep,
    output logic      [         1:0] m_group
);
    logic signed [W-1:0] a_x, a_y, b_x, b_y;
    logic                line_steep;
    logic                unused_last;

    always_ff @(posedge clk) begin
        if (take) begin
            {flags_a, sides_a, a_y, a_x} <= {flags_b, sides_b, b_y, b_x};
            {flags_b, b_y, b_x} <= {s_end_flags, s_end_y, s_end_x};
        end
    end

    generate
        if (CLIP != 0) begin : g_line_clipped
            assign sides_b[0] = b_x < 0;
            assign sides_b[1] = b_x >= $signed({{(W - W_SCREEN - 1) {1'b0}}, width});
            assign sides_b[2] = b_y < 0;
            assign sides_b[3] = b_y >= $signed({{(W - W_SCREEN - 1) {1'b0}}, height});
            line_clipped #(
                .W_SCREEN(W_SCREEN)
            ) i_line (
                .clk           (clk),
                .rst_n         (rst_n),
                .width         (width),
                .height        (height),
                .s_volume_valid(s_volume_valid),
                .s_volume_ready(s_volume_ready),
                .s_volume_data (s_volume_data),
                .m_volume_valid(m_volume_valid),
                .m_volume_ready(m_volume_ready),
                .m_volume_data (m_volume_data),
                .idle          (volume_idle),
                .s_valid       (s_valid),
                .s_ready       (s_ready),
                .s_on_screen   (s_on_screen),
                .s_a_x         (a_x),
                .s_a_y         (a_y),
                .s_b_x         (b_x),
                .s_b_y         (b_y),
                .m_valid       (m_valid),
                .m_ready       (m_ready),
                .m_x           (m_x),
                .m_y           (m_y),
                .m_steep       (line_steep),
                .m_last        (unused_last),
                .busy          (busy)
            );
        end else begin : g_line
            assign s_volume_ready = 1'b1;
            assign m_volume_valid = 1'b0;
            assign m_volume_data  = '0;
            assign volume_idle    = 1'b1;
            assign sides_b        = '0;
            // Both ends are on the screen; two more bits keep line's sums from overflowing.
            logic [W-1:0] x, y;
            logic [ 23:0] unused_rgb;
            logic [  2:0] lines;  // in here: at most four in the set-up and one that is walked
            logic         unused_top;
            line #(
                .W(W)
            ) i_line (
                .clk    (clk),
                .rst_n  (rst_n),
                .s_valid(s_valid),
                .s_ready(s_ready),
                .s_a_x  (a_x),
                .s_a_y  (a_y),
                .s_b_x  (b_x),
                .s_b_y  (b_y),
                .s_a_z  (1'b0),
                .s_b_z  (1'b0),
                .s_a_rgb(24'd0),
                .s_b_rgb(24'd0),
                .m_valid(m_valid),
                .m_ready(m_ready),
                .m_x    (x),
                .m_y    (y),
                .m_steep(line_steep),
                .m_rgb  (unused_rgb),
                .m_last (unused_last)
            );
            assign m_x        = x[W_SCREEN-1:0];
            assign m_y        = y[W_SCREEN-1:0];
            assign busy       = lines != '0;
            assign unused_top = ^{x, y, unused_rgb, s_on_screen, s_volume_valid, s_volume_data, m_volume_ready, width, height};
            always_ff @(posedge clk) begin
                lines <= lines + 3'(s_valid && s_ready) - 3'(m_valid && m_ready && unused_last);
                if (!rst_n) lines <= '0;
            end
        end
    endgenerate

    generate
        if (TAGGED != 0) begin : g_tagged
            assign m_steep = line_steep;
            always_ff @(posedge clk) if (s_valid) m_group <= s_group;
        end else begin : g_plain
            logic unused_group;
            assign m_steep      = 1'b0;
            assign m_group      = 2'd0;
            assign unused_group = ^{s_group, line_steep};
        end
    endgenerate
endmodule

`default_nettype wire
