// Scan-out: a drawing over a camera's picture while both pass by (system A): the drawing's pixel where it is set, the camera's
// elsewhere. `s_set` has a bit for each channel, red in the top one, because an anaglyph's eyes see lines at different places.
//
// The camera is a stream of pixels, as many a frame as the screen shows, from the top left; `s_camera_first` marks a frame's
// first. One is taken for each pixel of the screen, so the camera (or a FIFO behind it) must keep up. When it does not,
// nothing slips: the rest of that frame shows `background`, `late` is high for a clock, and the next frame of the camera begins
// with the next frame of the screen. Pixels before a frame's first are thrown away.
//
//   SEARCH --first seen--> WAIT --screen's first pixel--> RUN --pixel missing, or a first too early, or none in time--> SEARCH
//
// Latency: one clock. With `enable` low the background takes the camera's place and the camera is not taken from.
`default_nettype none

module overlay (
    input  wire logic        clk,
    input  wire logic        rst_n,
    input  wire logic        enable,
    input  wire logic [23:0] background,
    // The camera.
    input  wire logic        s_camera_valid,
    output logic             s_camera_ready,
    input  wire logic        s_camera_first,
    input  wire logic [23:0] s_camera_rgb,
    // The screen's pixel.
    input  wire logic        s_active,
    input  wire logic        s_first,
    input  wire logic [ 2:0] s_set,
    input  wire logic [23:0] s_rgb,
    output logic      [23:0] m_rgb,
    output logic             late
);
    logic        running;
    logic        begins;
    logic        fits;
    logic        take;
    logic        drop;
    logic [23:0] under;

    assign under  = take ? s_camera_rgb : background;
    assign begins = s_active && s_first;
    // The head of the camera's stream belongs to this pixel.
    assign fits = s_camera_valid && s_camera_first == s_first && (running || s_first);
    assign take = enable && s_active && fits;
    // While waiting for a frame, whatever is not its first pixel; it then waits at the head.
    assign drop = enable && !running && s_camera_valid && !s_camera_first;
    assign s_camera_ready = take || drop;

    always_ff @(posedge clk) begin
        late  <= 1'b0;
        for (int c = 0; c < 3; c++) m_rgb[8*c+:8] <= s_set[c] ? s_rgb[8*c+:8] : under[8*c+:8];
        if (enable && s_active && !fits && (running || s_first)) begin
            running <= 1'b0;
            late    <= 1'b1;
        end else if (enable && begins) begin
            running <= 1'b1;
        end
        if (!rst_n || !enable) running <= 1'b0;
    end
endmodule

`default_nettype wire
