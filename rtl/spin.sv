// Control: the clip matrix of a model that turns about an axis, so that a board shows something without any host.
//
// A rotation by an angle is linear in its cosine and sine, and so is each word of the clip matrix:
//
//   m[k] = A[k] + (B[k] cos + C[k] sin + 2^29 >> 30)        k = 0 .. 15; exact, one rounding (floor after the half)
//
// The table (`spin` in registers.md) holds a quarter turn's 256 sines in Q2.30, the library's, and A, B, C; it is a block RAM
// with HEX as its first content, and a host may write it. The angle has 1024 steps a turn; `right` takes the A, B, C of the
// other eye.
//
// Cosine and sine are kept as sizes and signs. B cos + C sin is found a bit of both sizes after the other, from the lowest:
// sum = (sum +- b B +- c C) / 2, two clocks a bit and one adder. What drops out are the exact result's low bits, the last of them
// the half that rounds. B and C come from the memory each time, so that no register holds them. With `start` a matrix is
// written in about 1,040 clocks: `m_write` with each word, then `done`.
`default_nettype none

module spin #(
    parameter HEX = ""
) (
    input  wire logic        clk,
    input  wire logic        rst_n,
    input  wire logic        write,
    input  wire logic [ 8:0] write_address,
    input  wire logic [31:0] write_word,
    input  wire logic        start,
    input  wire logic [ 9:0] angle,
    input  wire logic        right,
    output logic             m_write,
    output logic      [ 3:0] m_address,
    output logic      [31:0] m_data,
    output logic             done
);
    // The word that a state sees was addressed two states before: the memory's output has a register of its own.
    typedef enum logic [3:0] {IDLE, SINE, TAKE_SINE, TAKE_COSINE, FIRST_B, FIRST_C, ADD_B, ADD_C, OFFSET} state_t;
    state_t state;

    logic [ 3:0] k;
    logic [ 4:0] step;
    logic        last;
    logic [ 8:0] read_address;
    logic [31:0] read_word;
    logic [31:0] word;
    model_memory #(
        .W_WORD(32),
        .WORDS (512),
        .HEX   (HEX)
    ) i_table (
        .clk          (clk),
        .write        (write),
        .write_address(write_address),
        .write_word   (write_word),
        .read_address (read_address),
        .read_word    (read_word)
    );

    // The sine of quadrant q and step i: table[i], or table[256 - i] in quadrants 1 and 3, which for i = 0 is one; negative in 2 and
    // 3. The cosine is the sine a quadrant further.
    logic [9:0] at;
    logic       is_one;
    assign at     = state == IDLE ? angle : angle + 10'd256;
    assign is_one = at[8] && at[7:0] == 8'd0;
    assign last   = step == 5'd30;

    always_comb begin
        case (state)
            FIRST_B: read_address = {2'b10, right, k, 2'd1};
            FIRST_C, ADD_C: read_address = {2'b10, right, k, 2'd2};
            ADD_B: read_address = {2'b10, right, k, last ? 2'd0 : 2'd1};
            default: read_address = {1'b0, at[8] ? -at[7:0] : at[7:0]};
        endcase
    end

    logic [ 1:0] was_one;  // the sine that is being read
    logic [ 1:0] was_minus;
    logic [30:0] cosine, sine, size;
    logic        cosine_minus, sine_minus;
    assign size = was_one[1] ? 31'h4000_0000 : word[30:0];

    logic signed [33:0] sum, added, total;
    logic               present, minus, half;
    assign present = state == ADD_B ? cosine[0] : sine[0];
    assign minus   = state == ADD_B ? cosine_minus : sine_minus;
    assign added   = present ? {{2{word[31]}}, word} ^ {34{minus}} : '0;
    assign total   = sum + added + 34'(signed'({1'b0, present && minus}));

    assign m_address = k;
    assign m_write   = state == OFFSET;
    assign m_data    = word + sum[31:0] + 32'(half);

    always_ff @(posedge clk) begin
        done      <= 1'b0;
        word      <= read_word;
        was_one   <= {was_one[0], is_one};
        was_minus <= {was_minus[0], at[9]};
        case (state)
            IDLE: begin
                k <= '0;
                if (start) state <= SINE;
            end
            SINE: state <= TAKE_SINE;
            TAKE_SINE: begin
                sine       <= size;
                sine_minus <= was_minus[1];
                state      <= TAKE_COSINE;
            end
            TAKE_COSINE: begin
                cosine       <= size;
                cosine_minus <= was_minus[1];
                state        <= FIRST_B;
            end
            FIRST_B: state <= FIRST_C;
            FIRST_C: begin
                sum   <= '0;
                step  <= '0;
                state <= ADD_B;
            end
            ADD_B: begin
                sum   <= total;
                state <= ADD_C;
            end
            ADD_C: begin
                sum    <= last ? total : total >>> 1;
                // Of all bits that drop out, that of step 29 is worth a half.
                if (!last) half <= total[0];
                step   <= step + 1'b1;
                // 31 bits, so after the last step both are where they were.
                cosine <= {cosine[0], cosine[30:1]};
                sine   <= {sine[0], sine[30:1]};
                state  <= last ? OFFSET : ADD_B;
            end
            OFFSET: begin
                k     <= k + 1'b1;
                done  <= k == 4'd15;
                state <= k == 4'd15 ? IDLE : FIRST_B;
            end
            default: state <= IDLE;
        endcase
        if (!rst_n) begin
            state <= IDLE;
            done  <= 1'b0;
        end
    end

    logic unused_top;
    assign unused_top = ^sum[33:32];
endmodule

`default_nettype wire
