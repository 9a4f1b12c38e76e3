// Pixels to pins: one of three ways to the screen, chosen by WAY.
//
//   WAY  memory                                               colour                    source
//    0   two planes of one bit a pixel                        `ink`                     system A
//    1   two colour framebuffers of FORMAT and a bit "drawn"  of each pixel
//    2   MEMORIES line memories, filled in the blank          `palette` by `s_group`    system C
//
// The drawing side: while `draw_enable` is high, send the picture's pixels, then `draw_done` for one clock after the last one
// was taken; draw_enable falls and rises again when the next picture may be drawn. Ways 0 and 1 take it at any
// time, in its own clock; way 2 only in the vertical blank that begins with `draw_want` high, and draw_clk must be clk.
//
// With STEREO ways 0 and 1 hold a picture for each eye; `s_right` says whose pixel it is. Way 2 has one picture for both.
// The memory is COLUMNS << STRIDE_BITS by V_ACTIVE >> SCALE_BITS pixels; see plane_memory. Nothing is drawn where `background`
// (or the camera) is seen.
`default_nettype none

module screen #(
    parameter int WAY         = 0,
    parameter int H_ACTIVE    = 640,
    parameter int H_FRONT     = 16,
    parameter int H_SYNC      = 96,
    parameter int H_BACK      = 48,
    parameter int V_ACTIVE    = 480,
    parameter int V_FRONT     = 10,
    parameter int V_SYNC      = 2,
    parameter int V_BACK      = 33,
    parameter int H_POSITIVE  = 0,
    parameter int V_POSITIVE  = 0,
    parameter int SCALE_BITS  = 0,
    parameter int STRIDE_BITS = 5,
    parameter int COLUMNS     = (H_ACTIVE >> SCALE_BITS) >> STRIDE_BITS,
    parameter int SPRAM       = 0,
    parameter int FORMAT      = 3,
    parameter int DITHER      = 0,
    parameter int MEMORIES    = 12,
    parameter int STEREO      = 0,
    parameter int OVERLAY     = 0,
    parameter int W_R         = 8,
    parameter int W_G         = 8,
    parameter int W_B         = 8,
    parameter int W_X         = $clog2(H_ACTIVE >> SCALE_BITS),
    parameter int W_Y         = $clog2(V_ACTIVE >> SCALE_BITS),
    parameter int W_ARRANGED  = STEREO > 1 ? 3 : 2
) (
    input  wire logic                  clk,
    input  wire logic                  rst_n,
    input  wire logic [W_ARRANGED-1:0] arrangement,
    input  wire logic                  camera_enable,
    input  wire logic [          23:0] ink,
    input  wire logic [          23:0] background,
    input  wire logic [          95:0] palette,
    // The drawing.
    input  wire logic                  draw_clk,
    input  wire logic                  draw_rst_n,
    input  wire logic                  draw_want,
    output logic                       draw_enable,
    input  wire logic                  draw_done,
    input  wire logic                  s_valid,
    output logic                       s_ready,
    input  wire logic [       W_X-1:0] s_x,
    input  wire logic [       W_Y-1:0] s_y,
    input  wire logic [          23:0] s_rgb,
    input  wire logic                  s_steep,
    input  wire logic [           1:0] s_group,
    input  wire logic                  s_right,
    // The camera.
    input  wire logic                  s_camera_valid,
    output logic                       s_camera_ready,
    input  wire logic                  s_camera_first,
    input  wire logic [          23:0] s_camera_rgb,
    // What went wrong: pixels that found no line memory; a camera that came too late.
    output logic      [          15:0] dropped,
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
    localparam int W_COLOUR = FORMAT == 1 ? 24 : FORMAT == 2 ? 16 : FORMAT == 3 ? 8 : 1;
    localparam int EYES = STEREO != 0 ? 2 : 1;

    logic           scan_read;
    logic           scan_blank;
    logic [W_X-1:0] scan_x;
    logic [W_Y-1:0] scan_y;
    logic [    1:0] set;  // right eye, left eye
    logic [   47:0] rgb;

    scan_out #(
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
        .STEREO    (STEREO),
        .OVERLAY   (OVERLAY),
        .LATENCY   (3),
        .W_R       (W_R),
        .W_G       (W_G),
        .W_B       (W_B)
    ) i_scan_out (
        .clk           (clk),
        .rst_n         (rst_n),
        .arrangement   (arrangement),
        .camera_enable (camera_enable),
        .background    (background),
        .scan_read     (scan_read),
        .scan_blank    (scan_blank),
        .scan_x        (scan_x),
        .scan_y        (scan_y),
        .scan_left_set (set[0]),
        .scan_left_rgb (rgb[23:0]),
        .scan_right_set(set[1]),
        .scan_right_rgb(rgb[47:24]),
        .s_camera_valid(s_camera_valid),
        .s_camera_ready(s_camera_ready),
        .s_camera_first(s_camera_first),
        .s_camera_rgb  (s_camera_rgb),
        .camera_late   (camera_late),
        .blank_start   (blank_start),
        .r             (r),
        .g             (g),
        .b             (b),
        .active        (active),
        .hsync         (hsync),
        .vsync         (vsync)
    );

    generate
        if (WAY == 2) begin : g_lines
            logic       hit;
            logic [1:0] group;
            line_memories #(
                .MEMORIES(MEMORIES),
                .W_X     (W_X),
                .W_Y     (W_Y),
                .W_GROUP (2)
            ) i_memories (
                .clk        (clk),
                .rst_n      (rst_n),
                .draw_want  (draw_want),
                .draw_enable(draw_enable),
                .draw_done  (draw_done),
                .s_valid    (s_valid),
                .s_ready    (s_ready),
                .s_x        (s_x),
                .s_y        (s_y),
                .s_steep    (s_steep),
                .s_group    (s_group),
                .scan_blank (scan_blank),
                .scan_x     (scan_x),
                .scan_y     (scan_y),
                .scan_hit   (hit),
                .scan_group (group),
                .dropped    (dropped)
            );
            assign set = {2{hit}};
            assign rgb = {2{palette[24*group+:24]}};
            logic unused;
            assign unused = ^{draw_clk, draw_rst_n, s_rgb, s_right, ink, scan_read};
        end else begin : g_framebuffer
            // A cell: whether it is drawn, and its colour.
            localparam int W_CELL = WAY == 0 ? 1 : 1 + W_COLOUR;
            logic [     W_CELL-1:0] cell_drawn;
            logic [EYES*W_CELL-1:0] cells;  // the right eye's in the high half
            logic [EYES*W_CELL-1:0] mask;
            logic                   swapped;

            for (genvar e = 0; e < EYES; e++) begin : g_mask
                assign mask[W_CELL*e+:W_CELL] = {W_CELL{STEREO == 0 || s_right == 1'(e)}};
            end

            framebuffer #(
                .SPRAM      (SPRAM),
                .W_PIXEL    (EYES * W_CELL),
                .COLUMNS    (COLUMNS),
                .STRIDE_BITS(STRIDE_BITS),
                .HEIGHT     (V_ACTIVE >> SCALE_BITS)
            ) i_framebuffer (
                .draw_clk    (draw_clk),
                .draw_rst_n  (draw_rst_n),
                .draw_enable (draw_enable),
                .draw_done   (draw_done),
                .s_valid     (s_valid),
                .s_ready     (s_ready),
                .s_x         (s_x),
                .s_y         (s_y),
                .s_pixel     ({EYES{cell_drawn}}),
                .s_mask      (mask),
                .scan_clk    (clk),
                .scan_rst_n  (rst_n),
                .scan_read   (scan_read),
                .scan_blank  (scan_blank),
                .scan_x      (scan_x),
                .scan_y      (scan_y),
                .scan_pixel  (cells),
                .scan_swapped(swapped)
            );
            assign dropped = '0;

            if (WAY == 0) begin : g_ink
                logic unused;
                assign cell_drawn = 1'b1;
                assign set        = {cells[EYES-1], cells[0]};
                assign rgb        = {2{ink}};
                assign unused     = ^{s_rgb, s_steep, s_group, palette, s_right, swapped, draw_want};
            end else begin : g_colour
                logic unused;
                logic [W_COLOUR-1:0] pixel;
                assign cell_drawn = {1'b1, pixel};
                output_format #(
                    .FORMAT(FORMAT),
                    .DITHER(DITHER)
                ) i_format (
                    .s_x    (s_x[1:0]),
                    .s_y    (s_y[1:0]),
                    .s_rgb  (s_rgb),
                    .m_pixel(pixel)
                );
                for (genvar e = 0; e < 2; e++) begin : g_eye
                    widen_format #(
                        .FORMAT(FORMAT)
                    ) i_widen (
                        .s_pixel(cells[W_CELL*(e%EYES)+:W_COLOUR]),
                        .m_rgb  (rgb[24*e+:24])
                    );
                    assign set[e] = cells[W_CELL*(e%EYES)+W_COLOUR];
                end
                assign unused = ^{s_steep, s_group, palette, s_right, ink, swapped, draw_want};
            end
        end
    endgenerate
endmodule

`default_nettype wire
