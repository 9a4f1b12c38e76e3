// project: the result stays until it is taken.
`default_nettype none

module project_properties (
    input wire logic        clk,
    input wire logic [11:0] width,
    input wire logic        s_valid,
    input wire logic [31:0] s_data,
    input wire logic        m_ready
);
    logic        rst_n, s_ready, m_valid, m_tag;
    logic [31:0] m_x, m_y, m_z, m_inverse;
    logic [2:0]  m_flags;
    logic [4:0]  m_exponent;
    project i_project (
        .clk       (clk),
        .rst_n     (rst_n),
        .width     (width),
        .height    (width),
        .s_valid   (s_valid),
        .s_ready   (s_ready),
        .s_data    (s_data),
        .s_tag     (1'b0),
        .m_valid   (m_valid),
        .m_ready   (m_ready),
        .m_x       (m_x),
        .m_y       (m_y),
        .m_z       (m_z),
        .m_flags   (m_flags),
        .m_inverse (m_inverse),
        .m_exponent(m_exponent),
        .m_tag     (m_tag)
    );
    logic [104:0] word, before;
    assign word = {m_x, m_y, m_inverse, m_flags, m_exponent, m_tag};
    `include "stream.svh"
endmodule

`default_nettype wire
