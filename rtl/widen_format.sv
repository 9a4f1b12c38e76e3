// Output: a pixel of FORMAT (see output_format) as a colour of 8 bits a channel, by repeating its bits. Without registers.
`default_nettype none

module widen_format #(
    parameter int FORMAT  = 3,
    parameter int W_PIXEL = FORMAT == 1 ? 24 : FORMAT == 2 ? 16 : FORMAT == 3 ? 8 : 1
) (
    input  wire logic [W_PIXEL-1:0] s_pixel,
    output logic      [       23:0] m_rgb
);
    generate
        if (FORMAT == 1) begin : g_rgb888
            assign m_rgb = s_pixel;
        end else if (FORMAT == 2) begin : g_rgb565
            assign m_rgb = {
                s_pixel[15:11], s_pixel[15:13], s_pixel[10:5], s_pixel[10:9], s_pixel[4:0], s_pixel[4:2]
            };
        end else if (FORMAT == 3) begin : g_rgb332
            assign m_rgb = {
                s_pixel[7:5], s_pixel[7:5], s_pixel[7:6], s_pixel[4:2], s_pixel[4:2], s_pixel[4:3], {4{s_pixel[1:0]}}
            };
        end else begin : g_lit
            assign m_rgb = {24{s_pixel}};
        end
    endgenerate
endmodule

`default_nettype wire
