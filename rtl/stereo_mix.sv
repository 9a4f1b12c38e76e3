// Scan-out: one pixel from the two eyes' pixels; see stereo_place for the arrangements.
//
// An anaglyph takes the left eye's red and the right eye's green and blue, whatever the colours are; so `m_set`, whether something
// is drawn here, has a bit for each channel: red, green, blue from the top. Without registers.
`default_nettype none

module stereo_mix (
    input  wire logic [ 1:0] arrangement,
    input  wire logic        s_right,
    input  wire logic        s_left_set,
    input  wire logic [23:0] s_left_rgb,
    input  wire logic        s_right_set,
    input  wire logic [23:0] s_right_rgb,
    output logic      [ 2:0] m_set,
    output logic      [23:0] m_rgb
);
    always_comb begin
        m_rgb = s_right ? s_right_rgb : s_left_rgb;
        m_set = {3{s_right ? s_right_set : s_left_set}};
        if (arrangement == 2'd1) begin
            m_rgb = {s_left_rgb[23:16], s_right_rgb[15:0]};
            m_set = {s_left_set, s_right_set, s_right_set};
        end
    end
endmodule

`default_nettype wire
