// Scan-out: words of 10 bits on `lanes` leave as two bits a clock of five times the pixel clock, the first one in bit 0 of
// a lane's pair. The board's top level turns a pair into one pin with the family's double-data-rate register (ECP5: ODDRX1F).
//
//   clk        |‾‾‾‾‾‾‾‾‾|_________|        s_words change here
//   clk_5x     |‾|_|‾|_|‾|_|‾|_|‾|_|
//   m_pairs      8 9 0 1 2 3 4 5 6 7        two bits each, 3 clocks of clk_5x after the word
//
// Both clocks must come from one PLL. A word is taken two fast clocks after it changed, so no path is shorter than that.
`default_nettype none

module tmds_serialise #(
    parameter int LANES = 4
) (
    input  wire logic                clk,
    input  wire logic                rst_n,
    input  wire logic                clk_5x,
    input  wire logic [10*LANES-1:0] s_words,
    output logic      [ 2*LANES-1:0] m_pairs
);
    logic                change;  // every pixel clock
    logic [         2:0] seen;
    logic [10*LANES-1:0] shift;

    always_ff @(posedge clk) change <= rst_n && !change;

    always_ff @(posedge clk_5x) begin
        seen <= {seen[1:0], change};
        for (int i = 0; i < LANES; i++) begin
            if (seen[2] != seen[1]) shift[10*i+:10] <= s_words[10*i+:10];
            else shift[10*i+:10] <= {2'b00, shift[10*i+2+:8]};
            m_pairs[2*i+:2] <= shift[10*i+:2];
        end
    end
endmodule

`default_nettype wire
