// line: a pixel that is offered stays until it is taken, whatever comes in, and each line ends with exactly one `last`: there are
// never more ends than lines that went in.
`default_nettype none

module line_properties (
    input wire logic       clk,
    input wire logic       s_valid,
    input wire logic [3:0] s_a_x,
    input wire logic [3:0] s_a_y,
    input wire logic [3:0] s_b_x,
    input wire logic [3:0] s_b_y,
    input wire logic       m_ready
);
    logic        s_ready, m_valid, m_last, rst_n;
    logic [3:0]  m_x, m_y;
    logic [23:0] m_rgb;
    line #(
        .W(4)
    ) i_line (
        .clk    (clk),
        .rst_n  (rst_n),
        .s_valid(s_valid),
        .s_ready(s_ready),
        .s_a_x  (s_a_x),
        .s_a_y  (s_a_y),
        .s_b_x  (s_b_x),
        .s_b_y  (s_b_y),
        .s_a_z  (1'b0),
        .s_b_z  (1'b0),
        .s_a_rgb(24'd0),
        .s_b_rgb(24'd0),
        .m_valid(m_valid),
        .m_ready(m_ready),
        .m_x    (m_x),
        .m_y    (m_y),
        .m_rgb  (m_rgb),
        .m_last (m_last)
    );

    logic       began = 1'b0;
    logic       waited = 1'b0;
    logic [8:0] before;
    logic [4:0] inside = '0;
    assign rst_n = began;
    always_ff @(posedge clk) begin
        began  <= 1'b1;
        waited <= began && m_valid && !m_ready;
        before <= {m_x, m_y, m_last};
        if (began) begin
            inside <= inside + {4'b0, s_valid && s_ready} - {4'b0, m_valid && m_ready && m_last};
            if (waited) assert (m_valid && before == {m_x, m_y, m_last});
            if (m_valid) assert (inside != '0);
            // Four stages and the walker.
            assert (inside <= 5'd5);
        end
    end
endmodule

`default_nettype wire
