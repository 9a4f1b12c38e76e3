// Quotient and remainder of a product: b n / d for 0 <= n <= d, 0 < d, without the product.
//
//   b n = q d + r,  0 <= r < d          b, q: W_B bits, unsigned; n, d, r: W_D bits, unsigned
//
// b's bits from the top: r becomes 2 r, and n is added where the bit is one; d is taken out after each, at most once, since r < d and
// n <= d. One adder of W_D + 2 bits and no multiplier: a clock for a bit that is zero, three at most for a one.
//
// `start` takes b, n and d, also while busy; n and d must stay as they are until `busy` falls. Clocks: W_B + 1 to 3 W_B + 1.
// The clip stages share it; lines that need them are few.
`default_nettype none

module muldiv #(
    parameter int W_B = 32,
    parameter int W_D = 47
) (
    input  wire logic           clk,
    input  wire logic           rst_n,
    input  wire logic           start,
    input  wire logic [W_B-1:0] b,
    input  wire logic [W_D-1:0] n,
    input  wire logic [W_D-1:0] d,
    output logic                busy,
    output logic [W_B-1:0]      q,
    output logic [W_D-1:0]      r
);
    typedef enum logic [1:0] {DOUBLE, ADD, RESTORE} state_t;
    localparam int W_COUNT = $clog2(W_B + 1);

    state_t             state;
    logic [W_COUNT-1:0] left;
    logic [W_B-1:0]     bits;

    // DOUBLE: 2 r - d.  ADD: r + (n - d), where n - d was found at the start.  RESTORE: r + d.
    logic [W_D+1:0] first, second, sum;
    logic [W_D+1:0] rest, short_by;
    logic           negative;
    assign first    = state == DOUBLE ? {rest[W_D:0], 1'b0} : rest;
    assign second   = state == DOUBLE ? ~{2'b0, d} : state == ADD ? short_by : {2'b0, d};
    assign sum      = first + second + (W_D + 2)'(state == DOUBLE);
    assign negative = sum[W_D+1];
    assign r        = rest[W_D-1:0];

    always_ff @(posedge clk) begin
        if (start) begin
            busy     <= 1'b1;
            state    <= DOUBLE;
            left     <= W_COUNT'(W_B);
            bits     <= b;
            rest     <= '0;
            short_by <= {2'b0, n} - {2'b0, d};
        end else if (busy) begin
            case (state)
                DOUBLE: begin
                    rest  <= negative ? first : sum;
                    q     <= {q[W_B-2:0], !negative};
                    bits  <= bits << 1;
                    left  <= left - 1'b1;
                    if (bits[W_B-1]) state <= ADD;
                    else busy <= left != W_COUNT'(1);
                end
                ADD: begin
                    rest <= sum;
                    if (negative) begin
                        state <= RESTORE;
                    end else begin
                        q     <= q + 1'b1;
                        state <= DOUBLE;
                        busy  <= left != '0;
                    end
                end
                default: begin
                    rest  <= sum;
                    state <= DOUBLE;
                    busy  <= left != '0;
                end
            endcase
        end
        if (!rst_n) busy <= 1'b0;
    end
endmodule

`default_nettype wire
