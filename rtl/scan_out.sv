// Scan-out: from a picture's memory to the monitor's pins.
//
//   video_timing -> stereo_place -> the memory (outside, LATENCY clocks) -> stereo_mix -> overlay -> video_pins
//                        |                                                      ^            ^          ^
//                        +------------------ delay_line: right ----------------+            |          |
//                        +------------------ delay_line: active, first -----------------------+          |
//                        +------------------ delay_line: active, syncs --------------------------------+
//
// The memory side asks for the pixel `scan_x`, `scan_y` of an eye's picture; LATENCY clocks later `scan_left_*` and
// `scan_right_*` hold what both eyes see there: whether it is drawn, and its colour. SCALE_BITS 1 shows each pixel as 2x2.
// `scan_blank` is high from the first clock after the last line until shortly before the first line: then nothing is read.
//
// Parameters STEREO and OVERLAY 0 leave those parts away. Latency from the counters to the pins: LATENCY + 2 clocks.
//
// With STEREO 2 and 3 (weighted anaglyphs, see stereo_mix) the overlay says what lies under both eyes, and they are mixed a clock later:
//
//   memory -> delay_line: eyes, right -> stereo_mix -> video_pins
//   camera -> overlay ------------------------^                                                  Latency: LATENCY + 3 clocks
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
    localparam int W_H = $clog2(H_ACTIVE + H_FRONT + H_SYNC + H_BACK);
    localparam int W_V = $clog2(V_ACTIVE + V_FRONT + V_SYNC + V_BACK);
    localparam logic [W_H-1:0] X_READ = W_H'(H_ACTIVE + H_FRONT);
    localparam logic [W_V-1:0] Y_LAST = W_V'(V_ACTIVE + V_FRONT + V_SYNC + V_BACK - 1);

    // ----------------------------------------------------------------------------------------------------- before the memory
    logic [W_H-1:0] h;
    logic [W_V-1:0] v;
    logic           h_active;
    logic           h_sync;
    logic           v_sync;
    logic           right;

    video_timing #(
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
        .W_X       (W_H),
        .W_Y       (W_V)
    ) i_timing (
        .clk        (clk),
        .rst_n      (rst_n),
        .x          (h),
        .y          (v),
        .active     (h_active),
        .hsync      (h_sync),
        .vsync      (v_sync),
        .blank_start(blank_start)
    );

    stereo_place #(
        .STEREO(STEREO),
        .WIDTH (H_ACTIVE >> SCALE_BITS),
        .HEIGHT(V_ACTIVE >> SCALE_BITS),
        .W_X   (W_X),
        .W_Y   (W_Y)
    ) i_place (
        .arrangement(STEREO != 0 ? arrangement : '0),
        .s_x        (W_X'(h >> SCALE_BITS)),
        .s_y        (v[SCALE_BITS+:W_Y]),
        .m_x        (scan_x),
        .m_y        (scan_y),
        .m_right    (right)
    );

    assign scan_read = h_active;

    always_ff @(posedge clk) begin
        if (blank_start) scan_blank <= 1'b1;
        // A little before line 0, so that no swap of pictures is under way when it begins.
        if (v == Y_LAST && h == X_READ) scan_blank <= 1'b0;
        if (!rst_n) scan_blank <= 1'b1;
    end

    // ----------------------------------------------------------------------------------------------------- after the memory
    logic        late_active;
    logic        late_hsync;
    logic        late_vsync;
    logic        late_first;
    logic        late_right;
    logic [ 2:0] mixed_set;
    logic [23:0] mixed_rgb;
    logic [23:0] over_rgb;
    logic [23:0] shown_rgb;
    logic        shown_active;
    logic        shown_hsync;
    logic        shown_vsync;

    delay_line #(
        .W     (5),
        .STAGES(LATENCY)
    ) i_late (
        .clk(clk),
        .s  ({h_active && rst_n, h_sync, v_sync, h == '0 && v == '0, right}),
        .m  ({late_active, late_hsync, late_vsync, late_first, late_right})
    );

    generate
        if (STEREO > 1) begin : g_weighted
            logic        eye;
            logic        left_set;
            logic        right_set;
            logic [23:0] left_rgb;
            logic [23:0] right_rgb;
            logic [ 2:0] all_set;
            logic [23:0] weighted_rgb;

            // Nothing hides what lies under the eyes.
            assign mixed_set = '0;
            assign mixed_rgb = '0;

            delay_line #(
                .W     (51),
                .STAGES(1)
            ) i_eyes (
                .clk(clk),
                .s  ({late_right, scan_left_set, scan_left_rgb, scan_right_set, scan_right_rgb}),
                .m  ({eye, left_set, left_rgb, right_set, right_rgb})
            );

            stereo_mix #(
                .STEREO(STEREO)
            ) i_mix (
                .arrangement(arrangement),
                .s_right    (eye),
                .s_left_set (left_set),
                .s_left_rgb (left_rgb),
                .s_right_set(right_set),
                .s_right_rgb(right_rgb),
                .s_under_rgb(over_rgb),
                .m_set      (all_set),
                .m_rgb      (weighted_rgb)
            );

            always_ff @(posedge clk) shown_rgb <= weighted_rgb;
            logic unused_set;
            assign unused_set = &all_set;
        end else if (STEREO != 0) begin : g_stereo
            stereo_mix i_mix (
                .arrangement(arrangement),
                .s_right    (late_right),
                .s_left_set (scan_left_set),
                .s_left_rgb (scan_left_rgb),
                .s_right_set(scan_right_set),
                .s_right_rgb(scan_right_rgb),
                .s_under_rgb('0),
                .m_set      (mixed_set),
                .m_rgb      (mixed_rgb)
            );
            assign shown_rgb = over_rgb;
        end else begin : g_mono
            logic unused_right;
            assign unused_right = late_right ^ scan_right_set ^ (^scan_right_rgb) ^ (^arrangement);
            assign mixed_set    = {3{scan_left_set}};
            assign mixed_rgb    = scan_left_rgb;
            assign shown_rgb    = over_rgb;
        end

        if (OVERLAY != 0) begin : g_overlay
            overlay i_overlay (
                .clk           (clk),
                .rst_n         (rst_n),
                .enable        (camera_enable),
                .background    (background),
                .s_camera_valid(s_camera_valid),
                .s_camera_ready(s_camera_ready),
                .s_camera_first(s_camera_first),
                .s_camera_rgb  (s_camera_rgb),
                .s_active      (late_active),
                .s_first       (late_first),
                .s_set         (mixed_set),
                .s_rgb         (mixed_rgb),
                .m_rgb         (over_rgb),
                .late          (camera_late)
            );
        end else begin : g_alone
            logic unused_camera;
            assign unused_camera  = camera_enable ^ s_camera_valid ^ s_camera_first ^ (^s_camera_rgb) ^ late_first;
            assign s_camera_ready = 1'b0;
            assign camera_late    = 1'b0;
            always_ff @(posedge clk) begin
                for (int c = 0; c < 3; c++) over_rgb[8*c+:8] <= mixed_set[c] ? mixed_rgb[8*c+:8] : background[8*c+:8];
            end
        end
    endgenerate

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
