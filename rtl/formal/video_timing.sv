// video_timing: 640x480 as the table says, forever: each output follows from where the counters are, the counters go through every
// place of the frame and no other, and a frame has one pulse.
`default_nettype none

module video_timing_properties (
    input wire logic clk
);
    logic        rst_n, active, hsync, vsync, blank_start;
    logic [10:0] x;
    logic [ 9:0] y;
    video_timing i_timing (
        .clk        (clk),
        .rst_n      (rst_n),
        .x          (x),
        .y          (y),
        .active     (active),
        .hsync      (hsync),
        .vsync      (vsync),
        .blank_start(blank_start)
    );
    // The register inside, by its name after flattening.
    (* hierconn *) wire logic \i_timing.line_shown ;

    logic        began = 1'b0;
    logic        told = 1'b0;  // the pulse of this frame has come
    logic        framed = 1'b0;  // a whole frame has begun: reset ends in the last line of one
    logic        counted = 1'b0;
    logic [10:0] before_x;
    logic [ 9:0] before_y;
    assign rst_n = began;
    always_ff @(posedge clk) begin
        began    <= 1'b1;
        counted  <= began;
        framed   <= began && (framed || (x == 11'd799 && y == 10'd524));
        before_x <= x;
        before_y <= y;
        told     <= began && (told || blank_start) && !(x == 11'd799 && y == 10'd524);
        if (began) begin
            assert (x < 11'd800 && y < 10'd525);
            assert (active == (x < 11'd640 && y < 10'd480));
            assert (hsync == !(x >= 11'd656 && x < 11'd752));
            assert (vsync == !(y >= 10'd490 && y < 10'd492));
            assert (blank_start == (x == 11'd0 && y == 10'd480));
            assert (\i_timing.line_shown == (y < 10'd480));
            assert (!(told && blank_start));
            // What the induction needs to know about the pulse.
            if (framed) assert (told == (y > 10'd480 || (y == 10'd480 && x != 11'd0)));
            else assert (!told && y == 10'd524);
        end
        if (counted) begin
            if (before_x != 11'd799) assert (x == before_x + 11'd1 && y == before_y);
            else assert (x == 11'd0 && y == (before_y == 10'd524 ? 10'd0 : before_y + 10'd1));
        end
    end

endmodule

`default_nettype wire
