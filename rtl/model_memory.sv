// A memory of the model in block RAM: a host writes it, the pipeline reads a word one clock after its address.
//
// HEX names a file for $readmemh, a table of `scanout bake`; "" leaves the memory to be written first.
`default_nettype none

module model_memory #(
    parameter int W_WORD    = 48,
    parameter int WORDS     = 1024,
    parameter     HEX       = "",
    parameter int W_ADDRESS = $clog2(WORDS)
) (
    input  wire logic                 clk,
    input  wire logic                 write,
    input  wire logic [W_ADDRESS-1:0] write_address,
    input  wire logic [   W_WORD-1:0] write_word,
    input  wire logic [W_ADDRESS-1:0] read_address,
    output logic      [   W_WORD-1:0] read_word
);
    (* no_rw_check, ram_style = "block" *) logic [W_WORD-1:0] words[0:WORDS-1];

    generate
        if (HEX != "") begin : g_hex
            initial $readmemh(HEX, words);
        end
    endgenerate

    always_ff @(posedge clk) begin
        if (write) words[write_address] <= write_word;
        read_word <= words[read_address];
    end
endmodule

`default_nettype wire
