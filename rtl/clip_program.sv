// The clip unit's two programs, a word an operation: which word at an address comes out a clock later. clip.sv carries them out.
//
//   0x00 - 0x7f   volume: clip_volume.svh        written in the words of clip_operations.svh
//   0x80 - 0xff   screen: clip_screen.svh
//
// Of both: the divisor at register 12, the factor at 14. An address that no program has holds STOP.
`default_nettype none

module clip_program #(
    parameter int W_CODE = 29
) (
    input  wire logic              clk,
    input  wire logic [7:0]        address,
    output logic      [W_CODE-1:0] code
);
    typedef logic [W_CODE-1:0] code_t;
    `include "clip_operations.svh"
    `include "clip_volume.svh"
    `include "clip_screen.svh"

    code_t words[0:255];
    generate
        for (genvar i = 0; i < 256; i++) begin : g_word
            localparam code_t CODE = i < 128 ? volume(8'(i)) : screen(8'(i));
            initial words[i] = CODE;
        end
    endgenerate

    always_ff @(posedge clk) code <= words[address];
endmodule

`default_nettype wire
