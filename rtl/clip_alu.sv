// The clip unit's arithmetic: one adder with an accumulator, and the quotient and remainder of a product without the product.
//
//   sum = first + second + carry          first: 0, the accumulator, or twice it; second: word or its complement, quotient, s_data
//   b n = q d + r,  0 <= r < d            for 0 <= n <= d, 0 < d, b and q unsigned: `divide`, with b in the accumulator
//
// The division takes b's bits from the top, without restoring: -d <= r < d, and d is added or taken away by r's sign.
//
//   r = 2 r -+ d                          a digit of the quotient
//   r = r + n, then r - d if not negative where the bit is one; r was negative or became at least n
//
//   | prepare    | the clock before an operation: `word` is being read                                                          |
//   | run        | the operation's clocks, one after the other until `last`: `word` and the controls are there                      |
//   | divide     | and use_word: word is d, except where `other` was high a clock before: then n. The accumulator becomes r                       |
//   | shift      | as many clocks as SHIFT says: the accumulator is doubled in each                                                 |
//   | round      | with `quotient`: one more, where the accumulator is not negative                                                 |
//
// Clocks: 1; SHIFT, 2 or more; W_Q to 3 W_Q, and 1, for a division. W holds 4 d, with sign.
`default_nettype none

module clip_alu #(
    parameter int W     = 47,
    parameter int W_Q   = 32,
    parameter int SHIFT = 13
) (
    input  wire logic                  clk,
    input  wire logic                  prepare,
    input  wire logic                  run,
    input  wire logic                  load,
    input  wire logic                  accumulate,
    input  wire logic                  twice,
    input  wire logic                  use_word,
    input  wire logic                  invert,
    input  wire logic                  carry,
    input  wire logic                  quotient,
    input  wire logic                  use_input,
    input  wire logic                  divide,
    input  wire logic                  shift,
    input  wire logic signed [W-1:0]   word,
    input  wire logic signed [W_Q-1:0] s_data,
    output logic                       other,
    output logic                       last,
    output logic                       negative,
    output logic signed [W-1:0]        accumulator
);
    localparam int W_LEFT = $clog2(W_Q + 1);
    // PLAIN: no division. END: r becomes positive.
    localparam logic [3:0] PLAIN = 4'b0000;
    localparam logic [3:0] DIGIT = 4'b0001;
    localparam logic [3:0] ADD = 4'b0010;
    localparam logic [3:0] BACK = 4'b0100;
    localparam logic [3:0] END = 4'b1000;

    logic [3:0]        step;
    logic [W_LEFT-1:0] left;
    logic              none_left;
    assign negative = accumulator[W-1];

    // b's bits leave at the top, the quotient's enter below. Its digit is known a clock after its step: r's sign.
    logic [W_Q-1:0] digits;
    logic           enter, count, bit_is_one;
    assign bit_is_one = enter ? digits[W_Q-2] : digits[W_Q-1];
    assign other      = run && step[0] && bit_is_one;

    // A bit of the step each, so that little stands before the adder.
    logic keep, double, complement, carry_in, take;
    assign keep       = accumulate || step[1] || step[2] || step[3];
    assign double     = twice || step[0];
    assign complement = invert || step[2] || (step[0] && !negative);
    assign carry_in   = carry || step[2] || ((step[0] || quotient) && !negative);
    assign take       = load || step[0] || step[1] || step[2] || (step[3] && negative);

    logic signed [W-1:0] first, second, outside, sum;
    assign first   = double ? accumulator <<< 1 : keep ? accumulator : '0;
    assign outside = use_input ? W'(s_data) : quotient ? $signed({{(W - W_Q){1'b0}}, digits}) : '0;
    assign second  = ((use_word ? word : '0) ^ {W{complement}}) | outside;
    assign sum     = first + second + $signed({{(W - 1){1'b0}}, carry_in});
    assign last    = step == PLAIN ? none_left : step[3];

    always_ff @(posedge clk) begin
        if (prepare) begin
            left      <= divide ? W_LEFT'(W_Q - 1) : W_LEFT'(SHIFT - 2);
            none_left <= !shift;
            step      <= divide ? DIGIT : PLAIN;
        end else if (run) begin
            case (step)
                PLAIN: begin
                    left      <= left - 1'b1;
                    none_left <= left == '0;
                end
                DIGIT: begin
                    left      <= left - 1'b1;
                    none_left <= left == '0;
                    step      <= bit_is_one ? ADD : left == '0 ? END : DIGIT;
                end
                ADD: step <= !negative ? BACK : none_left ? END : DIGIT;
                BACK: step <= none_left ? END : DIGIT;
                default: step <= PLAIN;
            endcase
        end
        // Zero for a division's remainder.
        if (prepare && divide) accumulator <= '0;
        else if (run && take) accumulator <= sum;
        enter <= run && step[0];
        count <= run && ((step[1] && negative) || step[2]);
        if (prepare && divide) digits <= accumulator[W_Q-1:0];
        else if (enter) digits <= {digits[W_Q-2:0], !negative};
        else if (count) digits <= digits + W_Q'(!negative);
    end
endmodule

`default_nettype wire
