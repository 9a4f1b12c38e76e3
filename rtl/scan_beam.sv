// Scan-out: where the monitor's beam is, and which pixel of which eye's picture is shown there.
//
//   video_timing -> column and row of the mode -> (>> SCALE_BITS) -> stereo_place -> scan_x, scan_y, right
//
//   | scan_read          | the beam is in the picture: the memory's pixel is wanted                                           |
//   | scan_x, scan_y     | its column and row in the eye's picture; `right`: in the right eye's                               |
//   | scan_blank         | high from the first clock after the last line until shortly before the first line: nothing is read |
//   | first              | the picture's first pixel                                                                          |
//   | hsync, vsync       | as the mode wants them, see video_timing                                                           |
//   | blank_start        | for a clock: the first one after the last line                                                     |
//
// SCALE_BITS 1 shows each pixel as 2x2. Places are known in the counters' own clock: latency 0.
`default_nettype none

module scan_beam #(
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
    parameter int W_X        = $clog2(H_ACTIVE >> SCALE_BITS),
    parameter int W_Y        = $clog2(V_ACTIVE >> SCALE_BITS),
    parameter int W_ARRANGED = STEREO > 1 ? 3 : 2
) (
    input  wire logic                  clk,
    input  wire logic                  rst_n,
    input  wire logic [W_ARRANGED-1:0] arrangement,
    output logic                       scan_read,
    output logic                       scan_blank,
    output logic      [       W_X-1:0] scan_x,
    output logic      [       W_Y-1:0] scan_y,
    output logic                       right,
    output logic                       first,
    output logic                       hsync,
    output logic                       vsync,
    output logic                       blank_start
);
    localparam int W_H = $clog2(H_ACTIVE + H_FRONT + H_SYNC + H_BACK);
    localparam int W_V = $clog2(V_ACTIVE + V_FRONT + V_SYNC + V_BACK);
    localparam logic [W_H-1:0] X_READ = W_H'(H_ACTIVE + H_FRONT);
    localparam logic [W_V-1:0] Y_LAST = W_V'(V_ACTIVE + V_FRONT + V_SYNC + V_BACK - 1);

    logic [W_H-1:0] h;
    logic [W_V-1:0] v;

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
        .active     (scan_read),
        .hsync      (hsync),
        .vsync      (vsync),
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

    assign first = h == '0 && v == '0;

    always_ff @(posedge clk) begin
        if (blank_start) scan_blank <= 1'b1;
        // A little before line 0, so that no swap of pictures is under way when it begins.
        if (v == Y_LAST && h == X_READ) scan_blank <= 1'b0;
        if (!rst_n) scan_blank <= 1'b1;
    end
endmodule

`default_nettype wire
