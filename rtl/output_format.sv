// Output: a colour of 8 bits a channel becomes a pixel of FORMAT, with or without ordered dither; the library's `output` module.
//
//   FORMAT  pixel                 bits
//     1     RGB888: R8 G8 B8      24
//     2     RGB565: R5 G6 B5      16
//     3     RGB332: R3 G3 B2       8      system C's
//     4     lit or not             1      luma = (77 R + 150 G + 29 B) >> 8 >= 128
//
// Without dither a channel keeps its top n bits. With dither, b = BAYER[y mod 4][x mod 4] in 0 - 15:
// v - (v >> n) + (b << 4 >> n), then its top n bits; FORMAT 4: luma > 16 b + 7. Without registers.
`default_nettype none

module output_format #(
    parameter int FORMAT  = 3,
    parameter int DITHER  = 0,
    parameter int W_PIXEL = FORMAT == 1 ? 24 : FORMAT == 2 ? 16 : FORMAT == 3 ? 8 : 1
) (
    input  wire logic [         1:0] s_x,
    input  wire logic [         1:0] s_y,
    input  wire logic [        23:0] s_rgb,
    output logic      [W_PIXEL-1:0]  m_pixel
);
    localparam int N_R = FORMAT == 1 ? 8 : FORMAT == 2 ? 5 : 3;
    localparam int N_G = FORMAT == 1 ? 8 : FORMAT == 2 ? 6 : 3;
    localparam int N_B = FORMAT == 1 ? 8 : FORMAT == 2 ? 5 : 2;

    // The matrix's bits interleave those of x ^ y and y.
    logic [3:0] bayer;
    assign bayer = {s_x[0] ^ s_y[0], s_y[0], s_x[1] ^ s_y[1], s_y[1]};

    logic [7:0] r;
    logic [7:0] g;
    logic [7:0] b;

    always_comb begin
        {r, g, b} = s_rgb;
        if (DITHER != 0) begin
            r = r - (r >> N_R) + 8'({bayer, 4'b0} >> N_R);
            g = g - (g >> N_G) + 8'({bayer, 4'b0} >> N_G);
            b = b - (b >> N_B) + 8'({bayer, 4'b0} >> N_B);
        end
    end

    generate
        if (FORMAT == 4) begin : g_lit
            logic [15:0] luma;
            logic        unused_rgb;
            assign luma       = 16'd77 * 16'(s_rgb[23:16]) + 16'd150 * 16'(s_rgb[15:8]) + 16'd29 * 16'(s_rgb[7:0]);
            assign m_pixel    = DITHER != 0 ? luma[15:8] > {bayer, 4'd7} : luma[15];
            assign unused_rgb = ^{r, g, b, luma};
        end else begin : g_colour
            logic unused_low;
            assign m_pixel    = {r[7-:N_R], g[7-:N_G], b[7-:N_B]};
            assign unused_low = ^{r, g, b, bayer};
        end
    endgenerate
endmodule

`default_nettype wire
