// One of system C's line memories: a block RAM of 2^W_INDEX words, one port writes, one reads a clock later.
//
// Reading a word in the clock in which it is written gives no defined value; line_memories never does.
`default_nettype none

module line_memory #(
    parameter int W_INDEX = 10,
    parameter int W_WORD  = 12
) (
    input  wire logic               clk,
    input  wire logic               write,
    input  wire logic [W_INDEX-1:0] write_index,
    input  wire logic [ W_WORD-1:0] write_word,
    input  wire logic [W_INDEX-1:0] read_index,
    output logic      [ W_WORD-1:0] read_word
);
    (* no_rw_check, ram_style = "block" *) logic [W_WORD-1:0] words[0:(1<<W_INDEX)-1];

    always_ff @(posedge clk) begin
        if (write) words[write_index] <= write_word;
        read_word <= words[read_index];
    end
endmodule

`default_nettype wire
