// transform: each word stays until it is taken.
`default_nettype none

module transform_properties (
    input wire logic        clk,
    input wire logic        write,
    input wire logic [3:0]  write_address,
    input wire logic [31:0] write_data,
    input wire logic        swap,
    input wire logic        s_valid,
    input wire logic [47:0] s_position,
    input wire logic        m_ready
);
    logic        rst_n, s_ready, m_valid, m_tag;
    logic [31:0] m_data;
    transform #(
        .MULTIPLIERS(3)
    ) i_transform (
        .clk          (clk),
        .rst_n        (rst_n),
        .write        (write),
        .write_address(write_address),
        .write_data   (write_data),
        .swap         (swap),
        .s_valid      (s_valid),
        .s_ready      (s_ready),
        .s_position   (s_position),
        .s_tag        (1'b0),
        .m_valid      (m_valid),
        .m_ready      (m_ready),
        .m_data       (m_data),
        .m_tag        (m_tag)
    );
    logic [32:0] word, before;
    assign word = {m_data, m_tag};
    `include "stream.svh"
endmodule

`default_nettype wire
