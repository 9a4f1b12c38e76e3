// Scan-out: from a picture's memory to the monitor's pins.
//
//   scan_beam -> the memory (outside, LATENCY clocks) -> scan_mix -> video_pins
//       |                                                 ^           ^
//       +--- delay_line: active, first, right ------------+           |
//       +--- delay_line: active, syncs -------------------------------+
//
// The memory side asks for the pixel `scan_x`, `scan_y` of an eye's picture; LATENCY clocks later `scan_left_*` and
// `scan_right_*` hold what both eyes see there: whether it is drawn, and its colour. SCALE_BITS 1 shows each pixel as 2x2.
// `scan_blank` is high from the first clock after the last line until shortly before the first line: then nothing is read.
//
// Parameters STEREO and OVERLAY 0 leave those parts away. Latency from the counters to the pins: LATENCY + 2 clocks, and one more with
// STEREO 2 and 3 (weighted anaglyphs).
`default_nettype none

module scan_out #(
    parameter int H_ACTIVE   = 640,
    parameter int H_FRONT    = 16,
    parameter int H_SYNC     = 96,
    parameter int H_BACK     = 48,
    parameter int V_ACTIVE   = 480,
    parameter int V_FRONT    = 10,
    parameter int V_SYNC     = 2,
    parameter int V_BACK     = 33,
    parameter int H_POSITIVE = 0,
    parameter int V_POSITIVE = 0,
    parameter int SCALE_BITS = 0,
    parameter int STEREO     = 1,
    parameter int OVERLAY    = 1,
    parameter int LATENCY    = 3,
    parameter int W_R        = 8,
    parameter int W_G        = 8,
    parameter int W_B        = 8,
    parameter int W_X        = $clog2(H_ACTIVE >> SCALE_BITS),
    parameter int W_Y        = $clog2(V_ACTIVE >> SCALE_BITS),
    parameter int W_ARRANGED = STEREO > 1 ? 3 : 2
) (
    input  wire logic                  clk,
    input  wire logic                  rst_n,
    input  wire logic [W_ARRANGED-1:0] arrangement,
    input  wire logic                  camera_enable,
    input  wire logic [          23:0] background,
    // The memory.
    output logic                       scan_read,
    output logic                       scan_blank,
    output logic      [       W_X-1:0] scan_x,
    output logic      [       W_Y-1:0] scan_y,
    input  wire logic                  scan_left_set,
    input  wire logic [          23:0] scan_left_rgb,
    input  wire logic                  scan_right_set,
    input  wire logic [          23:0] scan_right_rgb,
    // The camera.
    input  wire logic                  s_camera_valid,
    output logic                       s_camera_ready,
    input  wire logic                  s_camera_first,
    input  wire logic [          23:0] s_camera_rgb,
    output logic                       camera_late,
    // The monitor.
    output logic                       blank_start,
    output logic      [       W_R-1:0] r,
    output logic      [       W_G-1:0] g,
    output logic      [       W_B-1:0] b,
    output logic                       active,
    output logic                       hsync,
    output logic                       vsync
);
    logic        right;
    logic        first;
    logic        beam_hsync;
    logic        beam_vsync;
    logic        late_active;
    logic        late_hsync;
    logic        late_vsync;
    logic        late_first;
    logic        late_right;
    logic [23:0] shown_rgb;
    logic        shown_active;
    logic        shown_hsync;
    logic        shown_vsync;

    scan_beam #(
        .H_ACTIVE  (H_ACTIVE),
        .H_FRONT   (H_FRONT),
        .H_SYNC    (H_SYNC),
        .H_BACK    (H_BACK),
        .V_ACTIVE  (V_ACTIVE),
        .V_FRONT   (V_FRONT),
        .V_SYNC    (V_SYNC),
        .V_BACK    (V_BACK),
        .H_POSITIVE(H_POSITIVE),
        .V_POSITIVE(V_POSITIVE),
        .SCALE_BITS(SCALE_BITS),
        .STEREO    (STEREO)
    ) i_beam (
        .clk        (clk),
        .rst_n      (rst_n),
        .arrangement(arrangement),
        .scan_read  (scan_read),
        .scan_blank (scan_blank),
        .scan_x     (scan_x),
        .scan_y     (scan_y),
        .right      (right),
        .first      (first),
        .hsync      (beam_hsync),
        .vsync      (beam_vsync),
        .blank_start(blank_start)
    );

    delay_line #(
        .W     (5),
        .STAGES(LATENCY)
    ) i_late (
        .clk(clk),
        .s  ({scan_read && rst_n, beam_hsync, beam_vsync, first, right}),
        .m  ({late_active, late_hsync, late_vsync, late_first, late_right})
    );

    scan_mix #(
        .STEREO (STEREO),
        .OVERLAY(OVERLAY)
    ) i_mix (
        .clk           (clk),
        .rst_n         (rst_n),
        .arrangement   (arrangement),
        .camera_enable (camera_enable),
        .background    (background),
        .s_active      (late_active),
        .s_first       (late_first),
        .s_right       (late_right),
        .s_left_set    (scan_left_set),
        .s_left_rgb    (scan_left_rgb),
        .s_right_set   (scan_right_set),
        .s_right_rgb   (scan_right_rgb),
        .s_camera_valid(s_camera_valid),
        .s_camera_ready(s_camera_ready),
        .s_camera_first(s_camera_first),
        .s_camera_rgb  (s_camera_rgb),
        .camera_late   (camera_late),
        .m_rgb         (shown_rgb)
    );

    delay_line #(
        .W     (3),
        .STAGES(STEREO > 1 ? 2 : 1)
    ) i_shown (
        .clk(clk),
        .s  ({late_active, late_hsync, late_vsync}),
        .m  ({shown_active, shown_hsync, shown_vsync})
    );

    video_pins #(
        .W_R(W_R),
        .W_G(W_G),
        .W_B(W_B)
    ) i_pins (
        .clk     (clk),
        .rst_n   (rst_n),
        .s_rgb   (shown_rgb),
        .s_active(shown_active),
        .s_hsync (shown_hsync),
        .s_vsync (shown_vsync),
        .r       (r),
        .g       (g),
        .b       (b),
        .active  (active),
        .hsync   (hsync),
        .vsync   (vsync)
    );
endmodule

`default_nettype wire
