// Raster, lines: from two ends anywhere in the guard band to the pixels on the screen, of one colour.
//
//   line_setup -> line_clip -> line_walk
//
//   | s_a_, s_b_    | ends: column and row, W bits with sign; W = W_SCREEN + 13 holds the guard band                   |
//   | width, height | of the screen, at most 2^W_SCREEN each                                                          |
//   | m_            | visible pixels in order of the major axis: column, row, and whether it is the line's last one   |
//   | busy          | a line is in here                                                                               |
//
// Clocks: a pixel a clock; a line takes at least 4, and line_clip's more where it leaves the screen.
`default_nettype none

module line_clipped #(
    parameter int W_SCREEN = 10,
    parameter int W        = W_SCREEN + 13
) (
    input  wire logic                clk,
    input  wire logic                rst_n,
    input  wire logic [W_SCREEN:0]   width,
    input  wire logic [W_SCREEN:0]   height,
    input  wire logic                s_valid,
    output logic                     s_ready,
    input  wire logic signed [W-1:0] s_a_x,
    input  wire logic signed [W-1:0] s_a_y,
    input  wire logic signed [W-1:0] s_b_x,
    input  wire logic signed [W-1:0] s_b_y,
    output logic                     m_valid,
    input  wire logic                m_ready,
    output logic [W_SCREEN-1:0]      m_x,
    output logic [W_SCREEN-1:0]      m_y,
    output logic                     m_last,
    output logic                     busy
);
    logic [2:0]          valid;
    logic                advance, clip_ready;
    logic signed [W-1:0] x, y;
    logic [W-1:0]        n, m;
    logic                steep, back;
    logic [23:0]         unused_from, unused_to, unused_rgb;
    assign advance = clip_ready || !valid[2];
    assign s_ready = advance;
    assign busy    = valid != '0 || !clip_ready || m_valid;
    always_ff @(posedge clk) begin
        if (!rst_n) valid <= '0;
        else if (advance) valid <= {valid[1:0], s_valid};
    end

    line_setup #(
        .W(W)
    ) i_setup (
        .s_a_z  (1'b0),
        .s_b_z  (1'b0),
        .s_a_rgb(24'd0),
        .s_b_rgb(24'd0),
        .m_x    (x),
        .m_y    (y),
        .m_steep(steep),
        .m_back (back),
        .m_n    (n),
        .m_m    (m),
        .m_from (unused_from),
        .m_to   (unused_to),
        .clk(clk),
        .advance(advance),
        .s_a_x(s_a_x),
        .s_a_y(s_a_y),
        .s_b_x(s_b_x),
        .s_b_y(s_b_y)
    );

    logic                path_valid, path_ready, path_steep, path_back;
    logic [W_SCREEN-1:0] path_x, path_y;
    logic [W-1:0]        path_steps, path_rise;
    logic signed [W:0]   path_turn;
    logic signed [W+1:0] path_error;
    line_clip #(
        .W       (W),
        .W_SCREEN(W_SCREEN)
    ) i_clip (
        .s_valid(valid[2]),
        .s_ready(clip_ready),
        .s_x    (x),
        .s_y    (y),
        .s_steep(steep),
        .s_back (back),
        .s_n    (n),
        .s_m    (m),
        .m_valid(path_valid),
        .m_ready(path_ready),
        .m_x    (path_x),
        .m_y    (path_y),
        .m_steep(path_steep),
        .m_back (path_back),
        .m_steps(path_steps),
        .m_rise (path_rise),
        .m_turn (path_turn),
        .m_error(path_error),
        .clk(clk),
        .rst_n(rst_n),
        .width(width),
        .height(height)
    );

    line_walk #(
        .W  (W_SCREEN),
        .W_N(W)
    ) i_walk (
        .s_valid(path_valid),
        .s_ready(path_ready),
        .s_x    (path_x),
        .s_y    (path_y),
        .s_steep(path_steep),
        .s_back (path_back),
        .s_steps(path_steps),
        .s_rise (path_rise),
        .s_turn (path_turn),
        .s_error(path_error),
        .s_now  (84'd0),
        .s_step (84'd0),
        .s_fall (3'd0),
        .m_rgb  (unused_rgb),
        .clk(clk),
        .rst_n(rst_n),
        .m_valid(m_valid),
        .m_ready(m_ready),
        .m_x(m_x),
        .m_y(m_y),
        .m_last(m_last)
    );
endmodule

`default_nettype wire
