// Scan-out: where in an eye's picture a pixel of the screen is, and which eye's it is.
//
//   arrangement          code  left eye      right eye     place in the eye's picture    eye's size
//   mono                   0   all           -             x, y                          W x H
//   anaglyph               1   red           green, blue   x, y                          W x H
//   side by side           2   x < W / 2     x >= W / 2    x, or x - W / 2 on the right  W/2 x H (the right one has W - W/2)
//   interlaced             3   even lines    odd lines     x, y                          W x H
//   top and bottom         4   y < H / 2     y >= H / 2    y, or y - H / 2 below         W x H/2 (the lower one has H - H/2)
//   grey, half-colour,    5, 6 both, weighted              x, y                          W x H
//   Dubois' anaglyph       7
//
// Halves hold an eye's picture squeezed or in natural proportions: that is the projection's concern, so these codes are the library's
// nine arrangements (`scanout_head::stereo::Arrangement::place`). STEREO 1 knows codes 0 to 3 only.
//
// Without registers. stereo_mix puts the two eyes together again, from `right` as it was here.
`default_nettype none

module stereo_place #(
    parameter int STEREO     = 1,
    parameter int WIDTH      = 640,
    parameter int HEIGHT     = 480,
    parameter int W_X        = 10,
    parameter int W_Y        = 9,
    parameter int W_ARRANGED = STEREO > 1 ? 3 : 2
) (
    input  wire logic [W_ARRANGED-1:0] arrangement,
    input  wire logic [       W_X-1:0] s_x,
    input  wire logic [       W_Y-1:0] s_y,
    output logic      [       W_X-1:0] m_x,
    output logic      [       W_Y-1:0] m_y,
    output logic                       m_right
);
    localparam logic [W_X-1:0] HALF_X = W_X'(WIDTH / 2);
    localparam logic [W_Y-1:0] HALF_Y = W_Y'(HEIGHT / 2);

    logic [2:0] code;
    assign code = {STEREO > 1 ? arrangement[W_ARRANGED-1] : 1'b0, arrangement[1:0]};

    always_comb begin
        m_x     = s_x;
        m_y     = s_y;
        m_right = 1'b0;
        if (code == 3'd2) begin
            m_right = s_x >= HALF_X;
            if (m_right) m_x = s_x - HALF_X;
        end
        if (code == 3'd3) m_right = s_y[0];
        if (STEREO > 1 && code == 3'd4) begin
            m_right = s_y >= HALF_Y;
            if (m_right) m_y = s_y - HALF_Y;
        end
    end
endmodule

`default_nettype wire
