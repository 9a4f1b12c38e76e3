// Raster, lines: two ends become a path for the walker (system D's initialiser).
//
//   n = |d major|, m = |d minor|       the major axis is x when |dx| >= |dy|, else y
//   start = the end with the smaller major coordinate; of ends on one pixel the nearer, of equally near ones the darker
//   error = 2 m - n                    the walker's first decision: step sideways when it is not negative
//   turn  = m - n
//
//   | s_        | two ends: column and row (signed, W bits), depth (unsigned), colour {red, green, blue}            |
//   | m_x, m_y  | the first pixel                                                                                   |
//   | m_steep   | the major axis is y                                                                               |
//   | m_back    | the minor coordinate falls                                                                        |
//   | m_n, m_m  | steps from end to end, and the rise; unsigned, W bits                                             |
//   | m_from, m_to | colours of the first and the last pixel (COLOUR = 1)                                           |
//
// A line is its own reverse, since both give the same start. Depth matters only for the order of ends that coincide; a plane
// without depth leaves s_a_z and s_b_z at 0.
//
// Latency 3 clocks of `advance`; a line a clock. Valid and ready are the caller's: all registers move on with `advance`.
`default_nettype none

module line_setup #(
    parameter int W       = 12,
    parameter int W_DEPTH = 1,
    parameter int COLOUR  = 0
) (
    input  wire logic                clk,
    input  wire logic                advance,
    input  wire logic signed [W-1:0] s_a_x,
    input  wire logic signed [W-1:0] s_a_y,
    input  wire logic signed [W-1:0] s_b_x,
    input  wire logic signed [W-1:0] s_b_y,
    input  wire logic [W_DEPTH-1:0]  s_a_z,
    input  wire logic [W_DEPTH-1:0]  s_b_z,
    input  wire logic [23:0]         s_a_rgb,
    input  wire logic [23:0]         s_b_rgb,
    output logic signed [W-1:0]      m_x,
    output logic signed [W-1:0]      m_y,
    output logic                     m_steep,
    output logic                     m_back,
    output logic [W-1:0]             m_n,
    output logic [W-1:0]             m_m,
    output logic [23:0]              m_from,
    output logic [23:0]              m_to
);
    // Stage 1: differences.
    logic signed [W:0]   dx_1, dy_1;
    logic signed [W-1:0] a_x_1, a_y_1, b_x_1, b_y_1;

    // Stage 2: their sizes, at most 2^W - 1.
    logic [W-1:0]        size_x_2, size_y_2;
    logic                left_2, up_2;
    logic signed [W-1:0] a_x_2, a_y_2, b_x_2, b_y_2;

    always_ff @(posedge clk) begin
        if (advance) begin
            dx_1     <= s_b_x - s_a_x;
            dy_1     <= s_b_y - s_a_y;
            {a_x_1, a_y_1, b_x_1, b_y_1} <= {s_a_x, s_a_y, s_b_x, s_b_y};
            size_x_2 <= W'(dx_1 < 0 ? -dx_1 : dx_1);
            size_y_2 <= W'(dy_1 < 0 ? -dy_1 : dy_1);
            left_2   <= dx_1[W];
            up_2     <= dy_1[W];
            {a_x_2, a_y_2, b_x_2, b_y_2} <= {a_x_1, a_y_1, b_x_1, b_y_1};
        end
    end

    // Stage 3: the major axis, and which end comes first.
    logic steep, swap, swap_same;
    assign steep = size_y_2 > size_x_2;
    assign swap  = (steep ? up_2 : left_2) || swap_same;

    always_ff @(posedge clk) begin
        if (advance) begin
            m_steep <= steep;
            m_back  <= (steep ? left_2 : up_2) ^ (steep ? up_2 : left_2);
            m_n     <= steep ? size_y_2 : size_x_2;
            m_m     <= steep ? size_x_2 : size_y_2;
            m_x     <= swap ? b_x_2 : a_x_2;
            m_y     <= swap ? b_y_2 : a_y_2;
        end
    end

    generate
        if (COLOUR != 0) begin : g_colour
            logic [23:0] a_rgb_1, b_rgb_1, a_rgb_2, b_rgb_2;
            logic        farther_1, farther_2;
            assign swap_same = farther_2 && size_x_2 == '0 && size_y_2 == '0;
            always_ff @(posedge clk) begin
                if (advance) begin
                    farther_1 <= {s_a_z, s_a_rgb} > {s_b_z, s_b_rgb};
                    farther_2 <= farther_1;
                    {a_rgb_1, b_rgb_1} <= {s_a_rgb, s_b_rgb};
                    {a_rgb_2, b_rgb_2} <= {a_rgb_1, b_rgb_1};
                    m_from <= swap ? b_rgb_2 : a_rgb_2;
                    m_to   <= swap ? a_rgb_2 : b_rgb_2;
                end
            end
        end else begin : g_plain
            logic unused_colour;
            assign unused_colour = &{1'b0, s_a_z, s_b_z, s_a_rgb, s_b_rgb};
            assign swap_same = 1'b0;
            assign m_from = '0;
            assign m_to   = '0;
        end
    endgenerate
endmodule

`default_nettype wire
