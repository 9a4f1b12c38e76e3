// Scan-out: where in an eye's picture a pixel of the screen is, and which eye's it is.
//
//   arrangement     code  left eye    right eye    x of the eye's picture        eye's size
//   mono              0   all         -            x                             W x H
//   anaglyph          1   red         green, blue  x                             W x H
//   side by side      2   x < W / 2   x >= W / 2   x, or x - W / 2 on the right  W/2 x H (the right one has W - W/2)
//   interlaced        3   even lines  odd lines    x                             W x H
//
// Without registers. stereo_mix puts the two eyes together again, from `right` as it was here.
`default_nettype none

module stereo_place #(
    parameter int WIDTH = 640,
    parameter int W_X   = 10,
    parameter int W_Y   = 9
) (
    input  wire logic [    1:0] arrangement,
    input  wire logic [W_X-1:0] s_x,
    input  wire logic [W_Y-1:0] s_y,
    output logic      [W_X-1:0] m_x,
    output logic                m_right
);
    localparam logic [W_X-1:0] HALF = W_X'(WIDTH / 2);

    always_comb begin
        m_x     = s_x;
        m_right = 1'b0;
        if (arrangement == 2'd2) begin
            m_right = s_x >= HALF;
            if (m_right) m_x = s_x - HALF;
        end
        if (arrangement == 2'd3) m_right = s_y[0];
    end

    logic unused_y;
    assign unused_y = &s_y;
endmodule

`default_nettype wire
