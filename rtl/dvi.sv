// Scan-out: a picture's pins as the four lanes of DVI (and of HDMI, whose receivers accept DVI): blue with the syncs, green, red,
// and the pixel clock as a pattern of five ones and five zeros.
//
// `m_pairs` holds two bits a lane, lane 0 (blue) in the low bits, lane 3 the clock; see tmds_serialise.
`default_nettype none

module dvi (
    input  wire logic       clk,
    input  wire logic       rst_n,
    input  wire logic       clk_5x,
    input  wire logic [7:0] r,
    input  wire logic [7:0] g,
    input  wire logic [7:0] b,
    input  wire logic       active,
    input  wire logic       hsync,
    input  wire logic       vsync,
    output logic      [7:0] m_pairs
);
    logic [9:0] red;
    logic [9:0] green;
    logic [9:0] blue;

    tmds_encode i_blue (
        .clk      (clk),
        .s_data   (b),
        .s_control({vsync, hsync}),
        .s_active (active),
        .m_word   (blue)
    );
    tmds_encode i_green (
        .clk      (clk),
        .s_data   (g),
        .s_control(2'b00),
        .s_active (active),
        .m_word   (green)
    );
    tmds_encode i_red (
        .clk      (clk),
        .s_data   (r),
        .s_control(2'b00),
        .s_active (active),
        .m_word   (red)
    );
    tmds_serialise #(
        .LANES(4)
    ) i_serialise (
        .clk    (clk),
        .rst_n  (rst_n),
        .clk_5x (clk_5x),
        .s_words({10'b0000011111, red, green, blue}),
        .m_pairs(m_pairs)
    );
endmodule

`default_nettype wire
