// Control: a button's clean level, from a pin that bounces (system C).
//
// The clean level follows the pin once the pin has been the same for STABLE clocks in a row; a single clock of the other
// level starts the count anew. STABLE is system C's 1,000,000: 40 ms at 25 MHz. `pressed` is one clock long, with the
// clean level's rise.
//
// Latency: 2 clocks of synchronisation and STABLE clocks.
`default_nettype none

module debounce #(
    parameter int STABLE = 1_000_000
) (
    input  wire logic clk,
    input  wire logic rst_n,
    input  wire logic pin,
    output logic      level,
    output logic      pressed
);
    localparam int W = $clog2(STABLE + 1);

    logic         synchronised;
    logic [W-1:0] count;

    synchronise i_synchronise (
        .clk  (clk),
        .rst_n(rst_n),
        .s    (pin),
        .m    (synchronised)
    );

    always_ff @(posedge clk) begin
        pressed <= 1'b0;
        if (!rst_n) begin
            level <= 1'b0;
            count <= '0;
        end else if (synchronised == level) begin
            count <= '0;
        end else if (count == W'(STABLE - 1)) begin
            level   <= synchronised;
            pressed <= synchronised;
            count   <= '0;
        end else begin
            count <= count + 1'b1;
        end
    end
endmodule

`default_nettype wire
