// iCEBreaker with an iCE40UP5K: a model turns in 320x240, shown as 640x480 at 60 Hz on the 12-bit DVI Pmod, without any host.
//
// The break-off buttons turn faster, slower, and stop; the button on the board resets. The green LED blinks once a second.
// One clock: 12 MHz times 67 / 32 = 25.125 MHz (59.8 Hz). The planes are in the four SPRAMs, the model and its projection in block
// RAM.
`default_nettype none

module icebreaker (
    input  wire logic       clk_12m,
    input  wire logic       btn_n,
    input  wire logic [2:0] btn,
    output logic            led_n,
    output logic            dvi_clk,
    output logic            dvi_hsync,
    output logic            dvi_vsync,
    output logic            dvi_de,
    output logic      [3:0] dvi_r,
    output logic      [3:0] dvi_g,
    output logic      [3:0] dvi_b
);
    logic clk, locked;
    SB_PLL40_PAD #(
        .FEEDBACK_PATH("SIMPLE"),
        .DIVR         (4'd0),
        .DIVF         (7'd66),
        .DIVQ         (3'd5),
        .FILTER_RANGE (3'd1)
    ) i_pll (
        .PACKAGEPIN   (clk_12m),
        .RESETB       (1'b1),
        .BYPASS       (1'b0),
        .PLLOUTGLOBAL (clk),
        .LOCK         (locked)
    );

    // Block RAM keeps its first content only if nothing reads it in the first microseconds after configuration.
    logic       button_n;
    logic [9:0] wait_count;
    logic       rst_n;
    logic       go;
    assign go = locked && button_n;
    synchronise i_button (
        .clk  (clk),
        .rst_n(1'b1),
        .s    (btn_n),
        .m    (button_n)
    );
    assign rst_n = wait_count[9];
    always_ff @(posedge clk) begin
        if (!go) wait_count <= '0;
        else if (!rst_n) wait_count <= wait_count + 1'b1;
    end

    logic        vsync;
    logic [31:0] unused_word;
    logic        unused_ack, unused_err, unused_camera;
    gpu #(
        .WAY           (0),
        .SCALE_BITS    (1),
        .STRIDE_BITS   (6),
        .SPRAM         (1),
        .BUS           (0),
        .SPIN          (1),
        .BUTTONS       (1),
        .MULTIPLIERS   (1),
        .VERTICES      (512),
        .EDGES         (1024),
        .MODEL_VERTICES(400),
        .MODEL_EDGES   (800),
        .VERTEX_HEX    ("boards/models/torus/vertices.hex"),
        .EDGE_HEX      ("boards/models/torus/edges.hex"),
        .SPIN_HEX      ("boards/models/torus/spin.hex"),
        .W_R           (4),
        .W_G           (4),
        .W_B           (4)
    ) i_gpu (
        .clk           (clk),
        .rst_n         (rst_n),
        .clk_pixel     (clk),
        .pixel_rst_n   (rst_n),
        .buttons       (btn),
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
        .r             (dvi_r),
        .g             (dvi_g),
        .b             (dvi_b),
        .active        (dvi_de),
        .hsync         (dvi_hsync),
        .vsync         (vsync)
    );
    assign dvi_vsync = vsync;

    // The transmitter takes the pins with the rising edge of dvi_clk, in the middle of a pixel.
    SB_IO #(
        .PIN_TYPE(6'b010000)
    ) i_dvi_clk (
        .PACKAGE_PIN (dvi_clk),
        .OUTPUT_CLK  (clk),
        .CLOCK_ENABLE(1'b1),
        .D_OUT_0     (1'b0),
        .D_OUT_1     (1'b1)
    );

    logic       was_vsync;
    logic [5:0] frames;
    always_ff @(posedge clk) begin
        was_vsync <= vsync;
        if (was_vsync && !vsync) frames <= frames + 1'b1;
    end
    assign led_n = frames[5];
endmodule

`default_nettype wire
