// Control: one picture after the other, in the screen's rhythm.
//
//   WAIT -> FILL -> FILLED -> BEGIN -> DRAW -> FINISH -> RELEASE -> WAIT
//     ^      ^                          |        tell the screen; wait until it has taken the picture
//     |      +------ the right eye -----+
//     until the screen takes a picture and one is wanted; then `commit` exchanges the banks
//
//   | run, ALWAYS | a picture is wanted while `run` is high; with ALWAYS 1 whenever the screen takes one                         |
//   | commit      | for a clock: the bank that the host has written comes with the next picture; `committed` until then           |
//   | bank        | of the matrix memory: the one in use, from the picture's first clock to the next one's                        |
//   | stereo      | the model is drawn twice: `right` is low, then high                                                           |
//   | matrix_     | `start` for a clock, then `fill` until `done`: an eye's matrix, see matrix_source                             |
//   | draw_start  | for a clock; `drawn` answers after the last pixel                                                             |
//   | draw_enable | the screen takes a picture; `draw_done`, for a clock, tells it that this one is whole; then it falls           |
//   | pictures    | drawn since reset, modulo 2^32; `clocks`: the last one's, from its first clock to draw_done                   |
`default_nettype none

module picture_sequence #(
    parameter int ALWAYS = 0
) (
    input  wire logic        clk,
    input  wire logic        rst_n,
    input  wire logic        run,
    input  wire logic        commit,
    input  wire logic        stereo,
    output logic             drawing,
    output logic             committed,
    output logic      [31:0] pictures,
    output logic      [31:0] clocks,
    output logic             bank,
    output logic             right,
    output logic             matrix_start,
    output logic             matrix_fill,
    input  wire logic        matrix_done,
    output logic             draw_start,
    input  wire logic        drawn,
    input  wire logic        draw_enable,
    output logic             draw_done
);
    typedef enum logic [2:0] {WAIT, FILL, FILLED, BEGIN, DRAW, FINISH, RELEASE} state_t;
    state_t      state;
    logic [31:0] clocks_now;

    assign drawing      = state != WAIT;
    assign matrix_start = state == FILL;
    assign matrix_fill  = state == FILLED;
    assign draw_start   = state == BEGIN;
    assign draw_done    = state == FINISH;

    always_ff @(posedge clk) begin
        if (commit) committed <= 1'b1;
        clocks_now <= clocks_now + 1'b1;
        case (state)
            WAIT: begin
                clocks_now <= '0;
                right      <= 1'b0;
                if (draw_enable && (run || ALWAYS != 0)) begin
                    state <= FILL;
                    // Run and commit may be written at once.
                    if (committed || commit) bank <= !bank;
                    committed <= 1'b0;
                end
            end
            FILL: state <= FILLED;
            FILLED: if (matrix_done) state <= BEGIN;
            BEGIN: state <= DRAW;
            DRAW: begin
                if (drawn) begin
                    state <= FINISH;
                    if (stereo && !right) begin
                        right <= 1'b1;
                        state <= FILL;
                    end
                end
            end
            FINISH: begin
                clocks   <= clocks_now;
                pictures <= pictures + 1'b1;
                state    <= RELEASE;
            end
            RELEASE: if (!draw_enable) state <= WAIT;
            default: state <= WAIT;
        endcase
        if (!rst_n) begin
            state     <= WAIT;
            bank      <= 1'b0;
            committed <= 1'b0;
            pictures  <= '0;
            clocks    <= '0;
        end
    end
endmodule

`default_nettype wire
