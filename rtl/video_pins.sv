// Scan-out: colours of 8 bits a channel become pins, in registers.
//
// A channel with n pins gets its n top bits (as the output stage does; 3-3-2 is system C's). Pins are black outside of the
// picture, where a monitor clamps its black level.
`default_nettype none

module video_pins #(
    parameter int W_R = 8,
    parameter int W_G = 8,
    parameter int W_B = 8
) (
    input  wire logic            clk,
    input  wire logic            rst_n,
    input  wire logic [    23:0] s_rgb,
    input  wire logic            s_active,
    input  wire logic            s_hsync,
    input  wire logic            s_vsync,
    output logic      [ W_R-1:0] r,
    output logic      [ W_G-1:0] g,
    output logic      [ W_B-1:0] b,
    output logic                 active,
    output logic                 hsync,
    output logic                 vsync
);
    // The low bits of narrow channels have no pin.
    logic unused_low;
    assign unused_low = ^s_rgb;

    always_ff @(posedge clk) begin
        r      <= s_active ? s_rgb[23-:W_R] : '0;
        g      <= s_active ? s_rgb[15-:W_G] : '0;
        b      <= s_active ? s_rgb[7-:W_B] : '0;
        active <= s_active && rst_n;
        hsync  <= s_hsync;
        vsync  <= s_vsync;
    end
endmodule

`default_nettype wire
