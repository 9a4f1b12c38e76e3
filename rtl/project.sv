// Transform, second half: clip coordinates to the screen, as the library's `Viewport::project`.
//
//   W = w << lz                          the leading one moved to bit 31
//   r = floor((2^63 - 1) / W)            recip32, 32 bits
//   x = 8 width  + ((x_c r >> 31) 8 width  + 2^(31 - lz)) >> (32 - lz)       1/16 pixel
//   y = 8 height - ((y_c r >> 31) 8 height + 2^(31 - lz)) >> (32 - lz)
//   z = ((z_c r >> 31) 65535 2^16) >> (32 - lz), at most 65535.0             U16.16, with DEPTH 1
//
//   | s_x ... s_w  | clip coordinates, 32 bits with sign, sizes below 2^30 + 4                                      |
//   | width, height | of the frame in pixels, 1 to 4095                                                              |
//   | m_x, m_y     | Q28.4                                                                                           |
//   | m_flags      | bit 0 near (z < 0 or w <= 0), 1 far (z > w), 2 guard band (|x| or |y| > 8192 w); when any is set |
//   |              | nothing else means anything                                                                     |
//   | m_inverse, m_exponent | r and lz: 1/w = r 2^(lz - 63)                                                          |
//
// Two units in a row, so that a vertex is divided while the one before is scaled. The first finds lz a bit a clock and r by
// restoring division, a bit a clock; the numerator is all ones, so no register holds it. The second has one multiplier of
// 16 x 16 bits with sign and works in digits: with t = r - 3 2^30, which is r's bits with bit 30 turned over as sign,
//
//   x_c r = (2^31 + 2^30) x_c + (c1 2^16 + c0)(t1 2^16 + t0)
//
// Clocks a vertex: the larger of lz + 35 (first) and 2 (lz + 14) + 1 (second; 3 (lz + 14) + 1 with DEPTH), lz being at least 1 and small
// when the matrix uses its bits; a flagged vertex takes 2. Latency: their sum.
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
    input  wire logic signed [31:0] s_x,
    input  wire logic signed [31:0] s_y,
    input  wire logic signed [31:0] s_z,
    input  wire logic signed [31:0] s_w,
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
    // ---- First unit: flags, lz and r.
    typedef enum logic [1:0] {EMPTY, NORMALISE, DIVIDE, DONE} state_t;
    state_t             state;
    logic signed [31:0] x, y, z;
    logic [31:0]        divisor, quotient;
    logic [31:0]        rest;
    logic [4:0]         count, exponent;
    logic [2:0]         flags, s_flags;
    logic [W_TAG-1:0]   tag;
    logic               scale_ready;

    logic signed [45:0] guard;
    assign guard = {s_w[31], s_w, 13'b0};
    assign s_flags[0] = s_z < 0 || s_w <= 0;
    assign s_flags[1] = s_z > s_w;
    assign s_flags[2] = 46'(s_x) > guard || -46'(s_x) > guard || 46'(s_y) > guard || -46'(s_y) > guard;
    assign s_ready = state == EMPTY;

    // 2 rest + 1 - divisor: the numerator's next bit is a one. Within 33 bits, since rest < divisor.
    logic [32:0] difference;
    logic        fits;
    assign difference = {rest, 1'b1} - {1'b0, divisor};
    assign fits       = !difference[32];

    always_ff @(posedge clk) begin
        case (state)
            EMPTY: begin
                if (s_valid) state <= s_flags != '0 ? DONE : NORMALISE;
                {x, y, z, divisor} <= {s_x, s_y, s_z, s_w};
                flags    <= s_flags;
                tag      <= s_tag;
                exponent <= '0;
                count    <= '0;
                rest     <= 32'h7fff_ffff;
            end
            NORMALISE: begin
                if (divisor[31]) begin
                    state <= DIVIDE;
                end else begin
                    divisor  <= divisor << 1;
                    exponent <= exponent + 1'b1;
                end
            end
            DIVIDE: begin
                rest     <= fits ? difference[31:0] : {rest[30:0], 1'b1};
                quotient <= {quotient[30:0], fits};
                count    <= count + 1'b1;
                if (count == '1) state <= DONE;
            end
            default: if (scale_ready) state <= EMPTY;
        endcase
        if (!rst_n) state <= EMPTY;
    end

    // ---- Second unit: ratio, scale, shift, for x, y and z in turn.
    //
    //   step  0 1 2 3 4 5   6 7    8 9 10   11 12   13 ...      13 + lz
    //         six products  sum    three    sum     shift left  round
    //
    // Products enter the sum two clocks after their digits are chosen.
    localparam logic [3:0] SCALE = 4'd8;
    localparam logic [3:0] SHIFT = 4'd13;
    localparam logic [1:0] LAST_AXIS = DEPTH != 0 ? 2'd2 : 2'd1;

    logic               busy;
    logic [1:0]         axis;
    logic [3:0]         step;
    logic [4:0]         shifts;
    logic signed [31:0] c, next_c, last_c;
    logic signed [15:0] half;
    logic signed [63:0] sum;
    logic signed [15:0] a_1, b_1;
    logic signed [31:0] product_2;
    logic [1:0]         place_1, place_2;
    logic               add_1, add_2, take;

    assign scale_ready = !busy && (!m_valid || m_ready);
    assign take        = state == DONE && scale_ready;
    assign half        = $signed({1'b0, axis == 2'd0 ? width : height, 3'b000});

    // Digits of c, t, and of the ratio, which is bits 63 to 31 of the sum; each digit but the highest takes its sign from below.
    logic signed [15:0] c1, c0, t1, t0, ratio0, ratio1, ratio2;
    logic [16:0]        upper;
    assign c0     = c[15:0];
    assign c1     = c[31:16] + 16'(c[15]);
    assign t0     = m_inverse[15:0];
    assign t1     = {{2{!m_inverse[30]}}, m_inverse[29:16]} + 16'(m_inverse[15]);
    assign ratio0 = sum[46:31];
    assign upper  = sum[63:47] + 17'(sum[46]);
    assign ratio1 = upper[15:0];
    assign ratio2 = 16'(signed'(upper[16])) + 16'(upper[15]);

    logic signed [15:0] a, b;
    logic [1:0]         place;
    logic               add;
    always_comb begin
        {a, b, place, add} = {c1, t1, 2'd2, busy};
        case (step)
            4'd0: {a, b, place} = {c1, t1, 2'd2};
            4'd1: {a, b, place} = {c1, t0, 2'd1};
            4'd2: {a, b, place} = {c0, t1, 2'd1};
            4'd3: {a, b, place} = {c0, t0, 2'd0};
            4'd4: {a, b, place} = {c1, 16'sh4000, 2'd2};
            4'd5: {a, b, place} = {c0, 16'sh4000, 2'd1};
            4'd8: {a, b, place} = {ratio0, half, 2'd0};
            4'd9: {a, b, place} = {ratio1, half, 2'd1};
            4'd10: {a, b, place} = {ratio2, half, 2'd2};
            default: add = 1'b0;
        endcase
        if (DEPTH != 0 && axis == 2'd2 && step >= SCALE) add = 1'b0;
    end

    logic signed [63:0] addend;
    always_comb begin
        case (place_2)
            2'd2: addend = {product_2, 32'b0};
            2'd1: addend = {{16{product_2[31]}}, product_2, 16'b0};
            default: addend = 64'(product_2);
        endcase
    end

    logic signed [31:0] rounded;
    assign rounded = sum[63:32] + 32'(sum[31]);

    always_ff @(posedge clk) begin
        {a_1, b_1, place_1} <= {a, b, place};
        product_2 <= a_1 * b_1;
        place_2   <= place_1;
        {add_2, add_1} <= {add_1, add};

        // 2^31 c comes before the first six products, nothing before the other three: the ratio's last digit is taken from the
        // sum when their first one enters.
        if (step == 4'd1) sum <= {c[31], c, 31'b0};
        else if (step == SCALE + 4'd2) sum <= DEPTH != 0 && axis == 2'd2 ? depth : addend;
        else if (add_2) sum <= sum + addend;
        else if (step == SHIFT && shifts != '0) sum <= sum << 1;

        if (take) begin
            busy       <= flags == '0;
            m_valid    <= flags != '0;
            m_flags    <= flags;
            m_inverse  <= quotient;
            m_exponent <= exponent;
            m_tag      <= tag;
            {c, next_c, last_c} <= {x, y, z};
            shifts     <= exponent;
            axis       <= '0;
            step       <= '0;
        end else begin
            if (m_ready) m_valid <= 1'b0;
            if (busy) begin
                if (step != SHIFT) step <= step + 1'b1;
                else if (shifts != '0) shifts <= shifts - 1'b1;
                else begin
                    // Round, and on to the next axis.
                    if (axis == 2'd0) m_x <= 32'(half) + rounded;
                    if (axis == 2'd1) m_y <= 32'(half) - rounded;
                    step   <= '0;
                    shifts <= m_exponent;
                    axis   <= axis + 1'b1;
                    {c, next_c} <= {next_c, last_c};
                    if (axis == LAST_AXIS) begin
                        busy    <= 1'b0;
                        m_valid <= 1'b1;
                    end
                end
            end
        end
        if (!rst_n) {busy, m_valid} <= '0;
    end

    // 65535 2^16 ratio, and the limit of depths.
    logic [63:0] depth;
    generate
        if (DEPTH != 0) begin : g_depth
            assign depth = {sum[62:31], 32'b0} - {15'b0, sum[63:31], 16'b0};
            always_ff @(posedge clk) begin
                if (axis == 2'd2) m_z <= &sum[63:48] ? 32'hffff_0000 : sum[63:32];
            end
        end else begin : g_no_depth
            logic unused_z;
            assign unused_z = &{1'b0, last_c};
            assign depth = '0;
            assign m_z = '0;
        end
    endgenerate
endmodule

`default_nettype wire
