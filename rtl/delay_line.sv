// A shift register: `m` is `s` of STAGES clocks ago. STAGES 0 is a wire. It has no reset, so that it costs no more than its
// registers.
`default_nettype none

module delay_line #(
    parameter int W      = 1,
    parameter int STAGES = 1
) (
    input  wire logic         clk,
    input  wire logic [W-1:0] s,
    output logic      [W-1:0] m
);
    generate
        if (STAGES == 0) begin : g_wire
            logic unused_clk;
            assign unused_clk = clk;
            assign m = s;
        end else begin : g_registers
            logic [W*STAGES-1:0] stages;
            always_ff @(posedge clk) stages <= (W * STAGES)'({stages, s});
            assign m = stages[W*STAGES-1-:W];
        end
    endgenerate
endmodule

`default_nettype wire
