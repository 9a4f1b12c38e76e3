// clip_alu's division: q d + r = b n with r < d, in at most 3 W_Q + 1 clocks; all operands of 3 bits.
`default_nettype none

module clip_alu_properties (
    input wire logic       clk,
    input wire logic [2:0] b,
    input wire logic [2:0] n,
    input wire logic [2:0] d
);
    // b is taken in, prepared for and divided; then the quotient is asked for.
    typedef enum logic [2:0] {FIRST, TAKE, PREPARE, DIVIDE, NEXT, QUOTIENT, OVER} state_t;
    state_t             state = FIRST;
    logic               last, other, was_other, negative;
    logic signed [5:0]  word, accumulator;
    logic [2:0]         b_then, n_then, d_then, r_then;
    logic [3:0]         age;
    logic signed [2:0]  number;
    assign word   = $signed({3'b0, was_other ? n_then : d_then});
    assign number = $signed(b_then);
    logic [5:0]         quotient;
    assign quotient = accumulator - 6'd1;
    clip_alu #(
        .W    (6),
        .W_Q  (3),
        .SHIFT(2)
    ) i_alu (
        .clk        (clk),
        .prepare    (state == FIRST || state == PREPARE || state == NEXT),
        .run        (state == TAKE || state == DIVIDE || state == QUOTIENT),
        .load       (state == TAKE || state == QUOTIENT),
        .accumulate (1'b0),
        .twice      (1'b0),
        .use_word   (state == PREPARE || state == DIVIDE),
        .invert     (1'b0),
        .carry      (1'b0),
        .quotient   (state == QUOTIENT),
        .use_input  (state == TAKE),
        .divide     (state == PREPARE || state == DIVIDE),
        .shift      (1'b0),
        .word       (word),
        .s_data     (number),
        .other      (other),
        .last       (last),
        .negative   (negative),
        .accumulator(accumulator)
    );

    always_ff @(posedge clk) begin
        was_other <= other;
        age       <= state == DIVIDE ? age + 1'b1 : 4'd0;
        case (state)
            FIRST: begin
                {b_then, n_then, d_then} <= {b, n, d};
                // The caller's side.
                assume (n <= d && d != '0);
                state <= TAKE;
            end
            TAKE: state <= PREPARE;
            PREPARE: state <= DIVIDE;
            DIVIDE: begin
                assert (age < 4'd10);
                if (last) state <= NEXT;
            end
            NEXT: begin
                assert (!negative && accumulator[5:3] == '0 && accumulator[2:0] < d_then);
                r_then <= accumulator[2:0];
                state  <= QUOTIENT;
            end
            QUOTIENT: begin
                assert (last);
                state <= OVER;
            end
            // The remainder was not negative: the quotient came with one added.
            OVER: assert (quotient * {3'b0, d_then} + {3'b0, r_then} == {3'b0, b_then} * {3'b0, n_then});
            default: state <= OVER;
        endcase
    end
endmodule

`default_nettype wire
