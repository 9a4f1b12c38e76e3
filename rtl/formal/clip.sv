// clip: each word stays until it is taken, whatever the program, and whatever the arithmetic gives while it runs.
`default_nettype none

module clip_properties (
    input wire logic        clk,
    input wire logic        s_screen,
    input wire logic        s_valid,
    input wire logic [31:0] s_data,
    input wire logic        m_ready
);
    logic        rst_n, s_ready, m_screen, m_valid, m_steep, m_back, idle;
    logic [2:0]  s_word, m_word;
    logic [31:0] m_data;
    clip i_clip (
        .s_screen(s_screen),
        .s_word  (s_word),
        .m_screen(m_screen),
        .m_word  (m_word),
        .m_steep (m_steep),
        .m_back  (m_back),
        .clk    (clk),
        .rst_n  (rst_n),
        .s_valid(s_valid),
        .s_ready(s_ready),
        .s_data (s_data),
        .m_valid(m_valid),
        .m_ready(m_ready),
        .m_data (m_data),
        .idle   (idle)
    );
    logic [37:0] word, before;
    assign word = {m_screen, m_word, m_steep, m_back, m_data};
    `include "stream.svh"
endmodule

module clip_program #(
    parameter int W_CODE = 29
) (
    input  wire logic              clk,
    input  wire logic [7:0]        address,
    output logic      [W_CODE-1:0] code
);
    (* anyseq *) logic [W_CODE-1:0] any;
    assign code = any;
    logic unused;
    assign unused = ^{clk, address};
endmodule

// The accumulator stays where nothing runs: see clip_alu's properties.
module clip_alu #(
    parameter int W     = 47,
    parameter int W_Q   = 32,
    parameter int SHIFT = 13
) (
    input  wire logic                  clk,
    input  wire logic                  prepare,
    input  wire logic                  run,
    input  wire logic                  load,
    input  wire logic                  accumulate,
    input  wire logic                  twice,
    input  wire logic                  use_word,
    input  wire logic                  invert,
    input  wire logic                  carry,
    input  wire logic                  quotient,
    input  wire logic                  use_input,
    input  wire logic                  divide,
    input  wire logic                  shift,
    input  wire logic signed [W-1:0]   word,
    input  wire logic signed [W_Q-1:0] s_data,
    output logic                       other,
    output logic                       last,
    output logic                       negative,
    output logic signed [W-1:0]        accumulator
);
    (* anyseq *) logic signed [W-1:0] any;
    (* anyseq *) logic                any_other, any_last;
    assign {other, last, negative} = {any_other, any_last, accumulator[W-1]};
    always_ff @(posedge clk) if (prepare || run) accumulator <= any;
endmodule

`default_nettype wire
