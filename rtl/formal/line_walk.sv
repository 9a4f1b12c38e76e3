// line_walk: from any path, a pixel a step, the last one at the end point, and none is lost while the sink waits. Lines of up to 3
// steps, several of them; the next may follow without a clock between.
`default_nettype none

module line_walk_properties (
    input wire logic       clk,
    input wire logic       s_valid,
    input wire logic [3:0] s_x,
    input wire logic [3:0] s_y,
    input wire logic       s_steep,
    input wire logic       s_back,
    input wire logic [1:0] n,
    input wire logic [1:0] m,
    input wire logic       m_ready
);
    logic       s_ready, m_valid, m_last, rst_n;
    logic [3:0] m_x, m_y;
    logic [23:0] unused_rgb;
    logic signed [2:0] turn;
    logic signed [3:0] error;
    assign turn  = {1'b0, m} - {1'b0, n};
    assign error = {1'b0, m, 1'b0} - {2'b0, n};
    line_walk #(
        .W  (4),
        .W_N(2)
    ) i_walk (
        .clk    (clk),
        .rst_n  (rst_n),
        .s_valid(s_valid),
        .s_ready(s_ready),
        .s_x    (s_x),
        .s_y    (s_y),
        .s_steep(s_steep),
        .s_back (s_back),
        .s_steps(n),
        .s_rise (m),
        .s_turn (turn),
        .s_error(error),
        .s_now  (84'd0),
        .s_step (84'd0),
        .s_fall (3'd0),
        .m_valid(m_valid),
        .m_ready(m_ready),
        .m_x    (m_x),
        .m_y    (m_y),
        .m_rgb  (unused_rgb),
        .m_last (m_last)
    );

    logic       began = 1'b0;
    logic       walking = 1'b0;
    logic       waited = 1'b0;
    logic       steep, back;
    logic [3:0] x, y, end_x, end_y, before_x, before_y;
    logic [2:0] pixels;
    logic [1:0] steps;
    assign rst_n = began;
    always_ff @(posedge clk) begin
        began <= 1'b1;
        if (began) assume (m <= n);
        waited   <= began && m_valid && !m_ready;
        before_x <= m_x;
        before_y <= m_y;
        if (began && s_valid && s_ready) begin
            // The end point, from the textbook's definition and not from the walker's sums.
            end_x  <= s_steep ? (s_back ? s_x - {2'b0, m} : s_x + {2'b0, m}) : s_x + {2'b0, n};
            end_y  <= s_steep ? s_y + {2'b0, n} : (s_back ? s_y - {2'b0, m} : s_y + {2'b0, m});
            {x, y, steep, back, steps} <= {s_x, s_y, s_steep, s_back, n};
            pixels  <= '0;
            walking <= 1'b1;
        end else if (m_valid && m_ready && m_last) walking <= 1'b0;
        if (began && m_valid && m_ready && !m_last) begin
            pixels <= pixels + 1'b1;
            {x, y} <= {m_x, m_y};
        end
        if (began) begin
            // Taken or not, what is offered stays.
            if (waited) assert (m_valid && m_x == before_x && m_y == before_y);
            assert (m_valid == walking);
            if (m_valid) begin
                assert (m_last == (pixels == {1'b0, steps}));
                if (m_last) assert (m_x == end_x && m_y == end_y);
                if (pixels == '0) assert (m_x == x && m_y == y);
                else if (steep) begin
                    assert (m_y == y + 4'd1);
                    assert (m_x == x || m_x == (back ? x - 4'd1 : x + 4'd1));
                end else begin
                    assert (m_x == x + 4'd1);
                    assert (m_y == y || m_y == (back ? y - 4'd1 : y + 4'd1));
                end
            end
        end
    end
endmodule

`default_nettype wire
