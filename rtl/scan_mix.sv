// Scan-out: one colour a pixel, of both eyes' pictures and of what lies under them, the camera or `background`.
//
//   STEREO 0, 1   eyes -> (stereo_mix) -> overlay over the camera -> m_rgb                                    1 clock
//   STEREO 2, 3   camera -> overlay ----------------+                                                         2 clocks
//                 eyes -> delay_line -> stereo_mix <+ -> m_rgb
//
// Weighted anaglyphs (see stereo_mix) need to know what lies under both eyes, so that they are mixed a clock later. OVERLAY 0 leaves
// the camera away, STEREO 0 the right eye.
//
//   | s_active           | the beam is in the picture; `s_first`: at its first pixel                                          |
//   | s_right            | the beam is where the right eye's picture is shown (halves, rows in turn)                          |
//   | s_left_, s_right_  | what the eyes see there: whether it is drawn, and its colour, U8.0 each: blue, green, red from bit 0 |
//   | s_camera_          | the camera's pixels, from the frame's first one on, see overlay                                    |
//   | camera_late        | for a clock: the camera did not keep up, see overlay                                               |
//   | m_rgb              | the colour, not yet black in the blank                                                             |
`default_nettype none

module scan_mix #(
    parameter int STEREO     = 1,
    parameter int OVERLAY    = 1,
    parameter int W_ARRANGED = STEREO > 1 ? 3 : 2
) (
    input  wire logic                  clk,
    input  wire logic                  rst_n,
    input  wire logic [W_ARRANGED-1:0] arrangement,
    input  wire logic                  camera_enable,
    input  wire logic [          23:0] background,
    input  wire logic                  s_active,
    input  wire logic                  s_first,
    input  wire logic                  s_right,
    input  wire logic                  s_left_set,
    input  wire logic [          23:0] s_left_rgb,
    input  wire logic                  s_right_set,
    input  wire logic [          23:0] s_right_rgb,
    input  wire logic                  s_camera_valid,
    output logic                       s_camera_ready,
    input  wire logic                  s_camera_first,
    input  wire logic [          23:0] s_camera_rgb,
    output logic                       camera_late,
    output logic      [          23:0] m_rgb
);
    logic [ 2:0] mixed_set;
    logic [23:0] mixed_rgb;
    logic [23:0] over_rgb;

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
                .s  ({s_right, s_left_set, s_left_rgb, s_right_set, s_right_rgb}),
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

            always_ff @(posedge clk) m_rgb <= weighted_rgb;
            logic unused_set;
            assign unused_set = &all_set;
        end else if (STEREO != 0) begin : g_stereo
            stereo_mix i_mix (
                .arrangement(arrangement),
                .s_right    (s_right),
                .s_left_set (s_left_set),
                .s_left_rgb (s_left_rgb),
                .s_right_set(s_right_set),
                .s_right_rgb(s_right_rgb),
                .s_under_rgb('0),
                .m_set      (mixed_set),
                .m_rgb      (mixed_rgb)
            );
            assign m_rgb = over_rgb;
        end else begin : g_mono
            logic unused_right;
            assign unused_right = s_right ^ s_right_set ^ (^s_right_rgb) ^ (^arrangement);
            assign mixed_set    = {3{s_left_set}};
            assign mixed_rgb    = s_left_rgb;
            assign m_rgb    = over_rgb;
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
                .s_active      (s_active),
                .s_first       (s_first),
                .s_set         (mixed_set),
                .s_rgb         (mixed_rgb),
                .m_rgb         (over_rgb),
                .late          (camera_late)
            );
        end else begin : g_alone
            logic unused_camera;
            assign unused_camera  = camera_enable ^ s_camera_valid ^ s_camera_first ^ (^s_camera_rgb) ^ s_first ^ s_active ^ rst_n;
            assign s_camera_ready = 1'b0;
            assign camera_late    = 1'b0;
            always_ff @(posedge clk) begin
                for (int c = 0; c < 3; c++) over_rgb[8*c+:8] <= mixed_set[c] ? mixed_rgb[8*c+:8] : background[8*c+:8];
            end
        end
    endgenerate
endmodule

`default_nettype wire
