// clip: each word stays until it is taken.
`default_nettype none

module clip_properties (
    input wire logic        clk,
    input wire logic        s_valid,
    input wire logic [31:0] s_data,
    input wire logic        m_ready
);
    logic        rst_n, s_ready, m_valid, idle;
    logic [31:0] m_data;
    clip i_clip (
        .clk    (clk),
        .rst_n  (rst_n),
        .s_valid(s_valid),
        .s_ready(s_ready),
        .s_data (s_data),
        .m_valid(m_valid),
        .m_ready(m_ready),
        .m_data (m_data),
        .idle   (idle)
    );
    logic [31:0] word, before;
    assign word = m_data;
    `include "stream.svh"
endmodule

`default_nettype wire
