// Raster, lines: from two ends to pixels, the same as the library's `raster::line` (system D's line unit).
//
//   line_setup -> [line_ramp] -> line_walk
//
//   | s_a_, s_b_ | ends: column and row (signed, W bits), depth (for the order of ends on one pixel), colour 8-8-8    |
//   | m_         | pixels in order of the major axis: column, row, whether the line is steep, colour, whether it is its last |
//
// COLOUR 0: the line has one colour, which is the caller's business; m_rgb is 0. COLOUR 1: colours are interpolated and rounded to
// nearest (see line_ramp), W at most 12: the format 12.20 is exact to 4095 steps.
//
// Clocks: a pixel a clock, 1.000 over any sequence of lines, points among them. Latency 4 (COLOUR 0) or 11 clocks and one of
// the walker. Nothing is clipped here: see line_clipped.
`default_nettype none

module line #(
    parameter int W       = 12,
    parameter int W_DEPTH = 1,
    parameter int COLOUR  = 0
) (
    input  wire logic                clk,
    input  wire logic                rst_n,
    input  wire logic                s_valid,
    output logic                     s_ready,
    input  wire logic signed [W-1:0] s_a_x,
    input  wire logic signed [W-1:0] s_a_y,
    input  wire logic signed [W-1:0] s_b_x,
    input  wire logic signed [W-1:0] s_b_y,
    input  wire logic [W_DEPTH-1:0]  s_a_z,
    input  wire logic [W_DEPTH-1:0]  s_b_z,
    input  wire logic [23:0]         s_a_rgb,
    input  wire logic [23:0]         s_b_rgb,
    output logic                     m_valid,
    input  wire logic                m_ready,
    output logic signed [W-1:0]      m_x,
    output logic signed [W-1:0]      m_y,
    output logic                 m_steep,
    output logic [23:0]              m_rgb,
    output logic                     m_last
);
    // Stages behind line_setup's three, the last of which makes the walker's first decision.
    localparam int DELAY = COLOUR != 0 ? 6 : 0;
    localparam int STAGES = 3 + DELAY + 1;
    localparam int W_PATH = 4 * W + 2 + (COLOUR != 0 ? 24 : 0);

    logic [STAGES-1:0] valid;
    logic              advance, walk_ready;
    assign advance = walk_ready || !valid[STAGES-1];
    assign s_ready = advance;
    always_ff @(posedge clk) begin
        if (!rst_n) valid <= '0;
        else if (advance) valid <= {valid[STAGES-2:0], s_valid};
    end

    logic signed [W-1:0] x_3, y_3;
    logic [W-1:0]        n_3, m_3;
    logic                steep_3, back_3;
    logic [23:0]         from_3, to_3;
    line_setup #(
        .W      (W),
        .W_DEPTH(W_DEPTH),
        .COLOUR (COLOUR)
    ) i_setup (
        .m_x    (x_3),
        .m_y    (y_3),
        .m_steep(steep_3),
        .m_back (back_3),
        .m_n    (n_3),
        .m_m    (m_3),
        .m_from (from_3),
        .m_to   (to_3),
        .clk(clk),
        .advance(advance),
        .s_a_x(s_a_x),
        .s_a_y(s_a_y),
        .s_b_x(s_b_x),
        .s_b_y(s_b_y),
        .s_a_z(s_a_z),
        .s_b_z(s_b_z),
        .s_a_rgb(s_a_rgb),
        .s_b_rgb(s_b_rgb)
    );

    logic [W_PATH-1:0] path_3, path;
    logic [W-1:0]      x, y, n, m;
    logic              steep, back;
    logic [83:0]       now, step;
    logic [2:0]        fall;
    assign {x, y, n, m, steep, back} = path[W_PATH-1-:4*W+2];

    generate
        if (COLOUR != 0) begin : g_colour
            logic [W_PATH*DELAY-1:0] delayed;
            logic [23:0]             from;
            assign path_3 = {x_3, y_3, n_3, m_3, steep_3, back_3, from_3};
            assign path = delayed[W_PATH*DELAY-1-:W_PATH];
            always_ff @(posedge clk) begin
                if (advance) begin
                    delayed <= (W_PATH * DELAY)'({delayed, path_3});
                    from    <= path[23:0];
                end
            end
            line_ramp #(
                .W(W)
            ) i_ramp (
                .s_n   (n_3),
                .s_from(from_3),
                .s_to  (to_3),
                .m_step(step),
                .m_fall(fall),
                .clk(clk),
                .advance(advance)
            );
            for (genvar c = 0; c < 3; c++) begin : g_channel
                assign now[28*c+:28] = {from[8*c+:8], 1'b1, 19'b0};
            end
        end else begin : g_plain
            logic unused_colour;
            assign unused_colour = &{1'b0, from_3, to_3};
            assign path_3 = {x_3, y_3, n_3, m_3, steep_3, back_3};
            assign path = path_3;
            assign {now, step, fall} = '0;
        end
    endgenerate

    // The last stage.
    logic [W-1:0]        walk_x, walk_y, steps, rise;
    logic                walk_steep, walk_back;
    logic signed [W:0]   turn;
    logic signed [W+1:0] error;
    always_ff @(posedge clk) begin
        if (advance) begin
            {walk_x, walk_y, steps, rise, walk_steep, walk_back} <= {x, y, n, m, steep, back};
            turn  <= $signed({1'b0, m}) - $signed({1'b0, n});
            error <= $signed({1'b0, m, 1'b0}) - $signed({2'b0, n});
        end
    end

    line_walk #(
        .W     (W),
        .COLOUR(COLOUR)
    ) i_walk (
        .s_valid(valid[STAGES-1]),
        .s_ready(walk_ready),
        .s_x    (walk_x),
        .s_y    (walk_y),
        .s_steep(walk_steep),
        .s_back (walk_back),
        .s_steps(steps),
        .s_rise (rise),
        .s_turn (turn),
        .s_error(error),
        .s_now  (now),
        .s_step (step),
        .s_fall (fall),
        .clk(clk),
        .rst_n(rst_n),
        .m_valid(m_valid),
        .m_ready(m_ready),
        .m_x(m_x),
        .m_y(m_y),
        .m_steep(m_steep),
        .m_rgb(m_rgb),
        .m_last(m_last)
    );
endmodule

`default_nettype wire
