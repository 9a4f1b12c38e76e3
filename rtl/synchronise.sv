// Takes a level into another clock domain through two registers: it arrives two to three clocks later.
//
// One bit only: several bits that belong together need a handshake around them.
`default_nettype none

module synchronise #(
    parameter bit RESET = 1'b0
) (
    input  wire logic clk,
    input  wire logic rst_n,
    input  wire logic s,
    output logic      m
);
    (* async_reg = "true", keep *) logic first;

    always_ff @(posedge clk) begin
        if (!rst_n) {m, first} <= {RESET, RESET};
        else {m, first} <= {first, s};
    end
endmodule

`default_nettype wire
