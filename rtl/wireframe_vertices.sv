// The vertices of a wireframe: from the vertex memory to columns and rows.
//
//   vertex memory -> transform -+------------------------------> project -> m_
//                               +-> m_volume (clip) s_volume ->+
//
// A vertex is read by its number, which stays for two clocks: one to read it, then `s_valid` until `s_ready`. Results come in the
// same order. Where `clipping` is high they go through the clip stage on their way, two vertices there, what is left of their edge
// back; it changes only while nothing is in here.
//
//   | vertex_word   | z, y, x: Q1.15 each                                                                                  |
//   | matrix_word   | i32, see transform: into the hidden bank, which takes effect with `swap`                             |
//   | m_volume_data | clip coordinates w, x, y, z of a vertex, a word each, as transform gives them; s_volume_data the same |
//   | m_x, m_y      | column and row, the Q28.4 of project without its fraction, W bits with sign                          |
//   | m_flags       | project's: before the near plane, beyond the far one, outside of the guard band. With CLIP 0 its     |
//   |               | lowest bit alone: not on the picture of `width` by `height`                                          |
//   | m_vertex      | the vertex's number (not where `clipping` is high)                                                   |
//
// Clocks: what the slower of transform and project takes a vertex, about 80. Results are never waited for.
`default_nettype none

module wireframe_vertices #(
    parameter int W_SCREEN    = 10,
    parameter int W           = 23,
    parameter int VERTICES    = 1024,
    parameter int MULTIPLIERS = 3,
    parameter int CLIP        = 1,
    parameter     HEX         = "",
    parameter int W_VERTEX    = $clog2(VERTICES)
) (
    input  wire logic                clk,
    input  wire logic                rst_n,
    input  wire logic [  W_SCREEN:0] width,
    input  wire logic [  W_SCREEN:0] height,
    input  wire logic                vertex_write,
    input  wire logic [W_VERTEX-1:0] vertex_address,
    input  wire logic [        47:0] vertex_word,
    input  wire logic                matrix_write,
    input  wire logic [         3:0] matrix_address,
    input  wire logic [        31:0] matrix_word,
    input  wire logic                swap,
    input  wire logic                s_valid,
    output logic                     s_ready,
    input  wire logic [W_VERTEX-1:0] s_vertex,
    // The clip stage.
    input  wire logic                clipping,
    output logic                     m_volume_valid,
    input  wire logic                m_volume_ready,
    output logic signed [31:0]       m_volume_data,
    input  wire logic                s_volume_valid,
    output logic                     s_volume_ready,
    input  wire logic signed [31:0]  s_volume_data,
    // What is projected.
    output logic                     m_valid,
    output logic signed [W-1:0]      m_x,
    output logic signed [W-1:0]      m_y,
    output logic [2:0]               m_flags,
    output logic      [W_VERTEX-1:0] m_vertex
);
    logic [        47:0] position;
    logic                clip_valid;  // clip coordinates from the transform
    logic                clip_ready;
    logic [W_VERTEX-1:0] clip_vertex;
    logic signed [31:0]  x;
    logic signed [31:0]  y;
    logic [         2:0] flags;

    model_memory #(
        .W_WORD(48),
        .WORDS (VERTICES),
        .HEX   (HEX)
    ) i_vertices (
        .clk          (clk),
        .write        (vertex_write),
        .write_address(vertex_address),
        .write_word   (vertex_word),
        .read_address (s_vertex),
        .read_word    (position)
    );

    transform #(
        .MULTIPLIERS(MULTIPLIERS),
        .W_TAG      (W_VERTEX)
    ) i_transform (
        .clk          (clk),
        .rst_n        (rst_n),
        .write        (matrix_write),
        .write_address(matrix_address),
        .write_data   (matrix_word),
        .swap         (swap),
        .s_valid      (s_valid),
        .s_ready      (s_ready),
        .s_position   (position),
        .s_tag        (s_vertex),
        .m_valid      (clip_valid),
        .m_ready      (clip_ready),
        .m_data       (m_volume_data),
        .m_tag        (clip_vertex)
    );
    assign clip_ready     = clipping ? m_volume_ready : s_volume_ready;
    assign m_volume_valid = clip_valid && clipping;

    logic [31:0] unused_z;
    logic [31:0] unused_inverse;
    logic [ 4:0] unused_exponent;
    project #(
        .DEPTH(0),
        .W_TAG(W_VERTEX)
    ) i_project (
        .clk       (clk),
        .rst_n     (rst_n),
        .width     (12'(width)),
        .height    (12'(height)),
        .s_valid   (clipping ? s_volume_valid : clip_valid),
        .s_ready   (s_volume_ready),
        .s_data    (clipping ? s_volume_data : m_volume_data),
        .s_tag     (clip_vertex),
        .m_valid   (m_valid),
        .m_ready   (1'b1),
        .m_x       (x),
        .m_y       (y),
        .m_z       (unused_z),
        .m_flags   (flags),
        .m_inverse (unused_inverse),
        .m_exponent(unused_exponent),
        .m_tag     (m_vertex)
    );
    assign m_x = x[4+:W];
    assign m_y = y[4+:W];
    // Without the clip stages a vertex must be on the screen.
    assign m_flags = CLIP != 0 ? flags : 3'(flags != '0 || x[31:4] >= 28'(width) || y[31:4] >= 28'(height));

    logic unused_bits;
    assign unused_bits = ^{x, y, unused_z, unused_inverse, unused_exponent};
endmodule

`default_nettype wire
