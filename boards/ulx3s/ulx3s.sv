// ULX3S with an ECP5-85F: a model turns in 640x480 at 60 Hz on the GPDI (HDMI) connector, without any host.
//
// Buttons: up and down turn faster and slower, fire 1 stops and goes on, fire 2 resets. LEDs count pictures.
//
//   25 MHz -> PLL -> 100 MHz core
//                 ->  25 MHz pixels (59.5 Hz)
//                 -> 125 MHz, two bits a clock to each of the four lanes
`default_nettype none

module ulx3s (
    input  wire logic       clk_25mhz,
    input  wire logic [6:0] btn,
    output logic      [7:0] led,
    output logic      [3:0] gpdi_dp,
    output logic            wifi_gpio0
);
    // Low would let the ESP32 take the board over.
    assign wifi_gpio0 = 1'b1;

    logic clk_5x, clk_pixel, clk, locked;
    ulx3s_clocks i_clocks (
        .clk_25mhz(clk_25mhz),
        .clk_5x   (clk_5x),
        .clk_pixel(clk_pixel),
        .clk      (clk),
        .locked   (locked)
    );

    logic       rst_n, pixel_rst_n;
    logic       go;
    logic [2:0] buttons;
    assign go      = locked && !btn[2];
    assign buttons = {btn[1], btn[4], btn[3]};
    synchronise i_reset (
        .clk  (clk),
        .rst_n(1'b1),
        .s    (go),
        .m    (rst_n)
    );
    synchronise i_pixel_reset (
        .clk  (clk_pixel),
        .rst_n(1'b1),
        .s    (go),
        .m    (pixel_rst_n)
    );

    logic [7:0]  r, g, b;
    logic        active, hsync, vsync;
    logic [31:0] unused_word;
    logic        unused_ack, unused_err, unused_camera;
    gpu #(
        .WAY           (0),
        .BUS           (0),
        .SPIN          (1),
        .BUTTONS       (1),
        .STABLE        (4_000_000),
        .MULTIPLIERS   (1),
        .VERTICES      (1024),
        .EDGES         (2048),
        .MODEL_VERTICES(529),
        .MODEL_EDGES   (1520),
        .VERTEX_HEX    ("boards/models/teapot/vertices.hex"),
        .EDGE_HEX      ("boards/models/teapot/edges.hex"),
        .SPIN_HEX      ("boards/models/teapot/spin.hex")
    ) i_gpu (
        .clk           (clk),
        .rst_n         (rst_n),
        .clk_pixel     (clk_pixel),
        .pixel_rst_n   (pixel_rst_n),
        .buttons       (buttons),
        .wb_cyc        (1'b0),
        .wb_stb        (1'b0),
        .wb_we         (1'b0),
        .wb_adr        (13'd0),
        .wb_sel        (4'd0),
        .wb_dat_w      (32'd0),
        .wb_dat_r      (unused_word),
        .wb_ack        (unused_ack),
        .wb_err        (unused_err),
        .s_camera_valid(1'b0),
        .s_camera_ready(unused_camera),
        .s_camera_first(1'b0),
        .s_camera_rgb  (24'd0),
        .r             (r),
        .g             (g),
        .b             (b),
        .active        (active),
        .hsync         (hsync),
        .vsync         (vsync)
    );

    logic [7:0] pairs;
    dvi i_dvi (
        .clk    (clk_pixel),
        .rst_n  (pixel_rst_n),
        .clk_5x (clk_5x),
        .r      (r),
        .g      (g),
        .b      (b),
        .active (active),
        .hsync  (hsync),
        .vsync  (vsync),
        .m_pairs(pairs)
    );

    generate
        for (genvar i = 0; i < 4; i++) begin : g_lane
            ODDRX1F i_ddr (
                .SCLK(clk_5x),
                .RST (1'b0),
                .D0  (pairs[2*i]),
                .D1  (pairs[2*i+1]),
                .Q   (gpdi_dp[i])
            );
        end
    endgenerate

    // A frame a step.
    logic was_vsync;
    always_ff @(posedge clk_pixel) begin
        was_vsync <= vsync;
        if (was_vsync && !vsync) led <= led + 1'b1;
        if (!pixel_rst_n) led <= '0;
    end

    logic unused_buttons;
    assign unused_buttons = ^{btn[0], btn[5], btn[6]};
endmodule

`default_nettype wire
