// Transform, second half: clip coordinates to the screen, as the library's `Viewport::project`.
//
//   W = w << lz                          the leading one moved to bit 31
//   r = floor((2^63 - 1) / W)            recip32, 32 bits
//   x = 8 width  + ((x_c r >> 31) 8 width  + 2^(31 - lz)) >> (32 - lz)       1/16 pixel
//   y = 8 height - ((y_c r >> 31) 8 height + 2^(31 - lz)) >> (32 - lz)
//   z = ((z_c r >> 31) 65535 2^16) >> (32 - lz), at most 65535.0             U16.16, with DEPTH 1
//
//   | s_data       | clip coordinates, a word each: w, x, y, z; 32 bits with sign, sizes below 2^30 + 4              |
//   | s_tag, m_tag | comes back with the result; that of the last word counts                                        |
//   | width, height | of the frame in pixels, 1 to 4095                                                              |
//   | m_x, m_y     | Q28.4                                                                                           |
//   | m_flags      | bit 0 near (z < 0 or w <= 0), 1 far (z > w), 2 guard band (|x| or |y| > 8192 w); when any is set |
//   |              | nothing else means anything                                                                     |
//   | m_inverse, m_exponent | r and lz: 1/w = r 2^(lz - 63)                                                          |
//
// r comes from a restoring division, a bit a clock; the numerator is all ones, so no register holds it. The rest is done by one
// multiplier of 16 x 16 bits with sign, in digits of 15 bits, which are slices of their numbers, the highest one with its sign:
//
//   (c2 2^30 + c1 2^15 + c0)(r2 2^30 + r1 2^15 + r0)     nine, the largest place first; the sum moves 15 bits between places
//   (g2 2^30 + g1 2^15 + g0) 8 width                     three, with g = the ratio, 33 bits
//
// Clocks a vertex in view: 4 words, lz + 33 for r, lz + 17 an axis, 2: 3 lz + 73 with x and y. lz is at least 1, and small where the
// matrix uses its bits. A flagged vertex takes 7.
`default_nettype none

module project #(
    parameter int DEPTH = 0,
    parameter int W_TAG = 1
) (
    input  wire logic               clk,
    input  wire logic               rst_n,
    input  wire logic [11:0]        width,
    input  wire logic [11:0]        height,
    input  wire logic               s_valid,
    output logic                    s_ready,
    input  wire logic signed [31:0] s_data,
    input  wire logic [W_TAG-1:0]   s_tag,
    output logic                    m_valid,
    input  wire logic               m_ready,
    output logic signed [31:0]      m_x,
    output logic signed [31:0]      m_y,
    output logic [31:0]             m_z,
    output logic [2:0]              m_flags,
    output logic [31:0]             m_inverse,
    output logic [4:0]              m_exponent,
    output logic [W_TAG-1:0]        m_tag
);
    typedef enum logic [2:0] {LOAD, JUDGE, NORMALISE, DIVIDE, RATIO, SHIFT, DONE} state_t;
    localparam logic [1:0] LAST_AXIS = DEPTH != 0 ? 2'd2 : 2'd1;

    state_t             state;
    logic [1:0]         word;
    logic [4:0]         step;
    logic               last_step;
    logic [31:0]        divisor, rest;
    logic signed [31:0] c, c_next, c_last;
    assign s_ready   = state == LOAD;
    assign m_valid   = state == DONE;
    assign last_step = step == '1;

    // A clock after each word came. |v| > 2^13 w, without the low 13 bits: -v > 2^13 w when w + floor(v / 2^13) < 0, and v > 2^13 w
    // when w - ceil(v / 2^13) < 0.
    logic signed [32:0] w, below, above, beyond;
    logic signed [18:0] high;
    logic [2:0]         flags;
    logic               judged;
    logic [1:0]         judged_word;
    assign w      = $signed({divisor[31], divisor});
    assign high   = c_last[31:13];
    assign below  = w + 33'(high);
    assign above  = w - 33'(high) - 33'(signed'({1'b0, c_last[12:0] != '0}));
    assign beyond = w - 33'(c_last);
    always_comb begin
        flags = m_flags;
        case (judged_word)
            2'd0: flags = {2'b00, c_last <= 0};
            2'd3: begin
                flags[0] = m_flags[0] || c_last < 0;
                flags[1] = beyond < 0;
            end
            default: flags[2] = m_flags[2] || below < 0 || above < 0;
        endcase
    end

    // 2 rest + 1 - divisor: the numerator's next bit is a one. Within 33 bits, since rest < divisor.
    logic [32:0] difference;
    logic        fits;
    assign difference = {rest, 1'b1} - {1'b0, divisor};
    assign fits       = !difference[32];

    // Digits for step 0 to 11, products two clocks later, added in steps 2 to 13; `move` before the first product of a place.
    logic signed [15:0] a, b, a_1, b_1, half;
    logic signed [31:0] product_2;
    logic signed [63:0] sum;
    logic [1:0]         axis;
    logic               move;
    assign half = $signed({1'b0, axis == 2'd0 ? width : height, 3'b000});
    always_comb begin
        case (step[3:0])
            4'd0, 4'd1, 4'd3: a = {{14{c[31]}}, c[31:30]};
            4'd2, 4'd4, 4'd6: a = {1'b0, c[29:15]};
            4'd5, 4'd7, 4'd8: a = {1'b0, c[14:0]};
            4'd11: a = {{13{sum[63]}}, sum[63:61]};
            4'd12: a = {1'b0, sum[60:46]};
            default: a = {1'b0, sum[45:31]};
        endcase
        case (step[3:0])
            4'd0, 4'd2, 4'd5: b = {14'b0, m_inverse[31:30]};
            4'd1, 4'd4, 4'd7: b = {1'b0, m_inverse[29:15]};
            4'd3, 4'd6, 4'd8: b = {1'b0, m_inverse[14:0]};
            default: b = half;
        endcase
    end

    logic signed [63:0] total, rounded;
    logic signed [63:0] depth;
    assign total   = (move ? sum << 15 : sum) + (state == SHIFT ? sum : 64'(product_2));
    assign rounded = sum + 64'sh8000_0000;

    always_ff @(posedge clk) begin
        a_1       <= a;
        b_1       <= b;
        product_2 <= a_1 * b_1;
        // For the steps after these.
        case (step[3:0])
            4'd2, 4'd4, 4'd7, 4'd9, 4'd13, 4'd14: move <= state == RATIO;
            default: move <= 1'b0;
        endcase
        judged      <= state == LOAD && s_valid;
        judged_word <= word;
        if (judged) m_flags <= flags;
        case (state)
            LOAD: begin
                step       <= '0;
                axis       <= '0;
                m_exponent <= '0;
                rest       <= 32'h7fff_ffff;
                if (s_valid) begin
                    word    <= word + 1'b1;
                    m_tag   <= s_tag;
                    if (word == 2'd0) divisor <= s_data;
                    {c, c_next, c_last} <= {c_next, c_last, s_data};
                    if (word == 2'd3) state <= JUDGE;
                end
            end
            JUDGE: state <= NORMALISE;
            NORMALISE: begin
                if (m_flags != '0) begin
                    state <= DONE;
                end else if (divisor[31]) begin
                    state <= DIVIDE;
                end else begin
                    divisor    <= divisor << 1;
                    m_exponent <= m_exponent + 1'b1;
                end
            end
            DIVIDE: begin
                rest      <= fits ? difference[31:0] : {rest[30:0], 1'b1};
                m_inverse <= {m_inverse[30:0], fits};
                step      <= step + 1'b1;
                if (last_step) state <= RATIO;
            end
            RATIO: begin
                step <= step + 1'b1;
                // Nothing is in the sum before the first product of each kind.
                if (step[3:0] == 4'd2) sum <= 64'(product_2);
                else if (step[3:0] == 4'd13) sum <= DEPTH != 0 && axis == 2'd2 ? depth : 64'(product_2);
                else if (step != 5'd0 && step != 5'd1 && step[3:0] != 4'd11 && step[3:0] != 4'd12
                         && !(DEPTH != 0 && axis == 2'd2 && step[3:0] > 4'd13)) sum <= total;
                if (step[3:0] == 4'd15) begin
                    state <= SHIFT;
                    step  <= m_exponent;
                end
            end
            SHIFT: begin
                step <= step - 1'b1;
                if (step != '0) begin
                    sum <= total;
                end else begin
                    if (axis == 2'd0) m_x <= 32'(half) + rounded[63:32];
                    if (axis == 2'd1) m_y <= 32'(half) - rounded[63:32];
                    step  <= '0;
                    axis  <= axis + 1'b1;
                    {c, c_next} <= {c_next, c_last};
                    state <= axis == LAST_AXIS ? DONE : RATIO;
                end
            end
            default: if (m_ready) state <= LOAD;
        endcase
        if (!rst_n) begin
            state <= LOAD;
            word  <= '0;
        end
    end

    // 65535 2^16 ratio = (2^32 - 2^16) ratio, and the limit of depths.
    generate
        if (DEPTH != 0) begin : g_depth
            assign depth = {sum[62:31], 32'b0} - {15'b0, sum[63:31], 16'b0};
            always_ff @(posedge clk) begin
                if (axis == 2'd2) m_z <= &sum[63:48] ? 32'hffff_0000 : sum[63:32];
            end
        end else begin : g_no_depth
            assign depth = '0;
            assign m_z = '0;
        end
    endgenerate
    logic unused_fraction;
    assign unused_fraction = &{1'b0, rounded[31:0]};
endmodule

`default_nettype wire
