// Control: the clip matrix of a model that turns about an axis, so that a board shows something without any host.
//
// A rotation by an angle is linear in its cosine and sine, and so is each word of the clip matrix:
//
//   m[k] = A[k] + (B[k] cos + C[k] sin + 2^29 >> 30)        k = 0 .. 15; exact, one rounding (floor after the half)
//
// The table (`spin` in registers.md) holds a quarter turn's 256 sines in Q2.30, the library's, and A, B, C; it is a block RAM
// with HEX as its first content, and a host may write it. The angle has 1024 steps a turn; `right` takes the A, B, C of the other eye.
//
// B cos + C sin is found a bit of both factors after the other, from the lowest: sum = (sum + b B + c C) / 2, where the bit that
// drops out is a bit of the exact result that rounding has already used up; two clocks a bit, one adder. With `start` a matrix is
// written in about 1,050 clocks: `m_write` with each word, then `done`.
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
    typedef enum logic [3:0] {
        IDLE, SINE, COSINE, COSINE_SEEN, READ_A, READ_B, READ_C, SEEN_B, SEEN_C, ADD_B, ADD_C, OFFSET, NEXT
    } state_t;
    state_t state;

    logic [ 8:0] read_address;
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
        .read_word    (word)
    );

    // The sine of quadrant q and step i: table[i], 1 - mirrored: table[256 - i], which for i = 0 is one; negative for q >= 2.
    logic [9:0] at;
    logic       mirrored_zero;
    assign at = state == IDLE ? angle : angle + 10'd256;

    logic        one_1;  // the sine that is being read is one
    logic        minus_1;
    logic [31:0] size;
    logic [31:0] factor;
    assign mirrored_zero = at[8] && at[7:0] == 8'd0;
    assign size   = one_1 ? 32'h4000_0000 : word;
    assign factor = minus_1 ? -size : size;

    logic        [31:0] cosine, sine;
    logic        [31:0] a, b, c;
    logic signed [33:0] sum;
    logic        [ 4:0] step;
    logic        [ 3:0] k;

    // What a bit adds. Bits 31 and 30 of a factor in [-1, 1] together weigh -1, 0 or 1.
    logic               last;
    logic        [31:0] operand;
    logic               present, negative;
    logic signed [33:0] added;
    assign last     = step == 5'd30;
    assign operand  = state == ADD_B ? b : c;
    assign present  = state == ADD_B ? cosine[0] : sine[0];
    assign negative = last && (state == ADD_B ? cosine[1] : sine[1]);
    assign added    = present ? {{2{operand[31]}}, operand} ^ {34{negative}} : '0;

    logic signed [33:0] total;
    logic               half;
    // The half that rounds is worth one at bit 29, and a negative operand's complement lacks one.
    assign half  = state == ADD_B ? (present && negative) || step == 5'd29 : present && negative;
    assign total = sum + added + 34'(half);

    always_ff @(posedge clk) begin
        m_write <= 1'b0;
        done    <= 1'b0;
        case (state)
            IDLE: begin
                k            <= '0;
                read_address <= {1'b0, at[8] ? -at[7:0] : at[7:0]};
                one_1        <= mirrored_zero;
                minus_1      <= at[9];
                if (start) state <= SINE;
            end
            SINE: state <= COSINE;
            COSINE: begin
                sine         <= factor;
                read_address <= {1'b0, at[8] ? -at[7:0] : at[7:0]};
                one_1        <= mirrored_zero;
                minus_1      <= at[9];
                state        <= COSINE_SEEN;
            end
            COSINE_SEEN: state <= READ_A;
            READ_A: begin
                if (k == '0) cosine <= factor;
                read_address <= {2'b10, right, k, 2'd0};
                state        <= READ_B;
            end
            READ_B: begin
                read_address <= {2'b10, right, k, 2'd1};
                state        <= READ_C;
            end
            READ_C: begin
                a            <= word;
                read_address <= {2'b10, right, k, 2'd2};
                state        <= SEEN_B;
            end
            SEEN_B: begin
                b     <= word;
                state <= SEEN_C;
            end
            SEEN_C: begin
                c     <= word;
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
                step   <= step + 1'b1;
                // Turned a bit further; after 32 turns both are where they were.
                cosine <= {cosine[0], cosine[31:1]};
                sine   <= {sine[0], sine[31:1]};
                state  <= last ? OFFSET : ADD_B;
            end
            OFFSET: begin
                m_write   <= 1'b1;
                m_address <= k;
                m_data    <= a + sum[31:0];
                cosine    <= {cosine[0], cosine[31:1]};
                sine      <= {sine[0], sine[31:1]};
                state     <= NEXT;
            end
            NEXT: begin
                k     <= k + 1'b1;
                done  <= k == 4'd15;
                state <= k == 4'd15 ? IDLE : READ_A;
            end
            default: state <= IDLE;
        endcase
        if (!rst_n) begin
            state   <= IDLE;
            m_write <= 1'b0;
            done    <= 1'b0;
        end
    end

    logic unused_top;
    assign unused_top = ^sum[33:32];
endmodule

`default_nettype wire
