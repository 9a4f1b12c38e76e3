// Raster, lines: the colour steps of a line, exactly the library's, without a divider.
//
//   step = sign(d) floor(|d| 2^20 / n)         d = to - from, n steps, 1 <= n < 2^W: system D's 12.20
//
// A table of reciprocals of normalised n stands for system D's three dividers:
//
//   lz = leading zeros of n,  k = n 2^lz in [2^(W-1), 2^W),  R(k) = floor(2^(W+28) / k) + 1      30 bits
//   |d| 2^lz R / 2^(W+8) = |d| 2^20 / n + e,   0 < e <= |d| 2^lz / 2^(W+8) < 1 / n       since |d| < 2^8 and n 2^lz < 2^W
//
// The exact quotient is a multiple of 1 / n, so the floor is the same: no correction. The product is never a whole number,
// since e > 0; so the arithmetic shift of a negative product is the complement of the step that is meant, and the walker, which
// adds one for a falling colour, needs no absolute value either. lz is applied in two parts: 0 to 7 to the factor, which stays
// within 16 bits, and 8 by choosing the product's bits.
//
//   | s_n            | steps of the line; 0: the steps don't matter                                          |
//   | s_from, s_to   | colours, {red, green, blue}                                                           |
//   | m_step, m_fall | three steps of 28 bits (8.20), complemented where `fall`                              |
//
// Cost: 2^(W-1) x 30 bits of memory, three products of 16 x 30 bits. Latency 7 clocks of `advance`; a line a clock.
`default_nettype none

module line_ramp #(
    parameter int W = 12
) (
    input  wire logic         clk,
    input  wire logic         advance,
    input  wire logic [W-1:0] s_n,
    input  wire logic [23:0]  s_from,
    input  wire logic [23:0]  s_to,
    output logic [83:0]       m_step,
    output logic [2:0]        m_fall
);
    localparam int W_LOW = 15;

    logic [29:0] reciprocal[2**(W-1)];
    initial begin
        for (int i = 0; i < 2 ** (W - 1); i++) begin
            reciprocal[i] = 30'((64'd1 << (W + 28)) / {32'd0, 2 ** (W - 1) + i} + 64'd1);
        end
    end

    // Stage 1: leading zeros. Stage 2: normalised. Stages 3, 4: the table, and a register behind it.
    logic [W-1:0] n_1, k_2;
    logic [3:0]   zeros, lz_1;
    logic [29:0]  r_3, r_4;
    logic [6:2]   window;
    always_comb begin
        zeros = 4'd0;
        for (int i = 0; i < W; i++) begin
            if (s_n[i]) zeros = 4'(W - 1 - i);
        end
    end
    always_ff @(posedge clk) begin
        if (advance) begin
            n_1    <= s_n;
            lz_1   <= zeros;
            k_2    <= n_1 << lz_1;
            r_3    <= reciprocal[k_2[W-2:0]];
            r_4    <= r_3;
            window <= {window[5:2], lz_1[3]};
        end
    end
    logic unused_top;
    assign unused_top = k_2[W-1];

    generate
        for (genvar c = 0; c < 3; c++) begin : g_channel
            logic signed [8:0]  d_1;
            logic signed [15:0] d_2, d_3, d_4;
            logic signed [31:0] high_5, low_5;
            logic signed [47:0] product_6;
            logic               fall_7;
            logic [27:0]        step_7;
            always_ff @(posedge clk) begin
                if (advance) begin
                    d_1 <= $signed({1'b0, s_to[8*c+:8]}) - $signed({1'b0, s_from[8*c+:8]});
                    d_2 <= 16'(d_1) <<< lz_1[2:0];
                    d_3 <= d_2;
                    d_4 <= d_3;
                    // 30 bits as 15 and 15, so that both factors fit 16 bits with a sign.
                    high_5    <= d_4 * $signed({1'b0, r_4[29:W_LOW]});
                    low_5     <= d_4 * $signed({1'b0, r_4[W_LOW-1:0]});
                    product_6 <= (48'(high_5) <<< W_LOW) + 48'(low_5);
                    step_7    <= window[6] ? product_6[W+:28] : product_6[W+8+:28];
                    fall_7    <= product_6[47];
                end
            end
            logic unused_fraction;
            assign unused_fraction = &{1'b0, product_6[W-1:0]};
            assign m_step[28*c+:28] = step_7;
            assign m_fall[c] = fall_7;
        end
    endgenerate
endmodule

`default_nettype wire
