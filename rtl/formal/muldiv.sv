// muldiv: q d + r = b n with r < d, in at most 3 W_B clocks after the start; all operands of 4 bits.
`default_nettype none

module muldiv_properties (
    input wire logic       clk,
    input wire logic       start,
    input wire logic [3:0] b,
    input wire logic [3:0] n,
    input wire logic [3:0] d
);
    logic       busy, rst_n;
    logic [3:0] q, r;
    muldiv #(
        .W_B(4),
        .W_D(4)
    ) i_muldiv (
        .clk  (clk),
        .rst_n(rst_n),
        .start(start),
        .b    (b),
        .n    (n),
        .d    (d),
        .busy (busy),
        .q    (q),
        .r    (r)
    );

    logic       began = 1'b0;
    logic       running = 1'b0;
    logic [3:0] b_then, n_then, d_then, age;
    assign rst_n = began;
    always_ff @(posedge clk) begin
        began <= 1'b1;
        if (start) begin
            {b_then, n_then, d_then} <= {b, n, d};
            running <= began;
            age     <= '0;
        end else age <= age + 1'b1;

        // The caller's side: 0 <= n <= d, 0 < d; they stay; one division at a time.
        assume (!start || (n <= d && d != '0 && !busy));
        assume (!running || (n == n_then && d == d_then));
        // From the first clock after the reset: what came before doesn't matter, since a start sets every register.
        assume (start == (began && !running));

        if (running && !start) begin
            if (!busy) begin
                assert ({4'b0, q} * {4'b0, d_then} + {4'b0, r} == {4'b0, b_then} * {4'b0, n_then});
                assert (r < d_then);
            end
            assert (!busy || age < 4'd12);
        end
    end
endmodule

`default_nettype wire
