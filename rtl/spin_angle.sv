// Control: the angle of the stand-alone mode, 1024 steps a turn.
//
//   angle = angle + speed + faster  (modulo 1024) with each `step`, unless it is paused
//
//   | speed   | steps a picture, modulo 1024: 1023 is one step back                                                  |
//   | buttons | with BUTTONS 1, pins of any clock: `buttons[0]` adds one to `faster`, `buttons[1]` takes one away,     |
//   |         | `buttons[2]` stops and goes on; STABLE clocks of rest make a press, see debounce                      |
//
// After reset: angle 0, faster 0, not paused.
`default_nettype none

module spin_angle #(
    parameter int BUTTONS = 0,
    parameter int STABLE  = 1_000_000
) (
    input  wire logic       clk,
    input  wire logic       rst_n,
    input  wire logic [2:0] buttons,
    input  wire logic [9:0] speed,
    input  wire logic       step,
    output logic      [9:0] angle
);
    logic       paused;
    logic [9:0] faster;

    generate
        if (BUTTONS != 0) begin : g_buttons
            logic [2:0] pressed;
            logic [2:0] unused_level;
            for (genvar i = 0; i < 3; i++) begin : g_button
                debounce #(
                    .STABLE(STABLE)
                ) i_debounce (
                    .clk    (clk),
                    .rst_n  (rst_n),
                    .pin    (buttons[i]),
                    .level  (unused_level[i]),
                    .pressed(pressed[i])
                );
            end
            always_ff @(posedge clk) begin
                faster <= faster + 10'(pressed[0]) - 10'(pressed[1]);
                paused <= paused ^ pressed[2];
                if (!rst_n) {faster, paused} <= '0;
            end
        end else begin : g_no_buttons
            logic unused_buttons;
            assign unused_buttons = ^buttons;
            assign {faster, paused} = '0;
        end
    endgenerate

    always_ff @(posedge clk) begin
        if (step && !paused) angle <= angle + speed + faster;
        if (!rst_n) angle <= '0;
    end
endmodule

`default_nettype wire
