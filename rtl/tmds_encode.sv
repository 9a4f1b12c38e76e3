// Scan-out: one channel's 8 bits become 10 bits with few transitions and no direct current (DVI 1.0, section 3.2.2,
// figures 3-5; HDMI uses the same code).
//
//   1. q_m: a chain of XOR, or of XNOR where the byte has more than four ones (or four and an even one): few transitions
//   2. inverted or not, so that the running balance of ones and zeros stays near 0
//   outside of the picture: one of four control words, and the balance begins anew
//
// `balance` is half of the standard's cnt: (ones sent - zeros sent) / 2, which is never odd there. Bit 0 is sent first.
// Latency: 3 clocks, a byte a clock.
`default_nettype none

module tmds_encode (
    input  wire logic       clk,
    input  wire logic [7:0] s_data,
    input  wire logic [1:0] s_control,
    input  wire logic       s_active,
    output logic      [9:0] m_word
);
    function automatic logic [3:0] ones(input logic [7:0] v);
        ones = '0;
        for (int i = 0; i < 8; i++) ones = ones + {3'b000, v[i]};
    endfunction

    // Stage 1: how many ones.
    logic [7:0] data_1;
    logic       xnor_1;
    logic       active_1;
    logic [1:0] control_1;
    logic [3:0] ones_0;
    assign ones_0 = ones(s_data);

    // Stage 2: the chain, and its ones less zeros, halved: -4 to 4.
    logic        [8:0] q_m_2;
    logic signed [3:0] more_ones_2;
    logic              active_2;
    logic        [1:0] control_2;
    logic        [7:0] chain;

    // Bit i of the chain is the parity of bits 0 to i; an XNOR at each step turns every second one over.
    generate
        for (genvar i = 0; i < 8; i++) begin : g_chain
            if (i % 2 == 1) assign chain[i] = ^data_1[i:0] ^ xnor_1;
            else assign chain[i] = ^data_1[i:0];
        end
    endgenerate

    // Stage 3: the word.
    logic signed [4:0] balance;
    logic              invert;
    logic signed [4:0] sent;  // what this word adds to the balance

    always_comb begin
        if (balance == 0 || more_ones_2 == 0) invert = !q_m_2[8];
        else invert = balance[4] == more_ones_2[3];
        sent = {more_ones_2[3], more_ones_2};
        if (invert) sent = -sent;
        // The two bits before the eight: 01 and 10 are in balance, 00 and 11 are not.
        if (invert && q_m_2[8]) sent = sent + 5'sd1;
        if (!invert && !q_m_2[8]) sent = sent - 5'sd1;
    end

    always_ff @(posedge clk) begin
        data_1      <= s_data;
        xnor_1      <= ones_0 > 4'd4 || (ones_0 == 4'd4 && !s_data[0]);
        active_1    <= s_active;
        control_1   <= s_control;

        q_m_2       <= {!xnor_1, chain};
        more_ones_2 <= ones(chain) - 4'd4;
        active_2    <= active_1;
        control_2   <= control_1;

        if (active_2) begin
            m_word  <= {invert, q_m_2[8], q_m_2[7:0] ^ {8{invert}}};
            balance <= balance + sent;
        end else begin
            balance <= '0;
            case (control_2)
                2'b00:   m_word <= 10'b1101010100;
                2'b01:   m_word <= 10'b0010101011;
                2'b10:   m_word <= 10'b0101010100;
                default: m_word <= 10'b1010101011;
            endcase
        end
    end
endmodule

`default_nettype wire
