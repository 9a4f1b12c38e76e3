// The line half of the pipeline: a model's vertices and edges become pixels.
//
//   vertices   wireframe_vertices: vertex memory -> transform -> project -> projected memory (flags, row, column)
//   edges      edge memory -> projected memory, twice -> wireframe_lines -> pixels
//              where an end is flagged: vertex memory, twice -> transform -> clip -> project, twice -> wireframe_lines
//
// wireframe_sequence says what comes next; the clip stage is in wireframe_lines and serves both.
//
//   | vertex memory    | z, y, x: Q1.15 each: `vertices.hex` of `scanout bake`                                          |
//   | edge memory      | b, a: vertex numbers, 14 bits each in 16; bits 31:30 are the edge's group: `edges.hex`         |
//   | matrix           | 16 words into the transform's hidden bank; they take effect with `start`                       |
//   | width, height    | of the picture, at most 2^W_SCREEN each; `vertices` and `edges` are counts                     |
//   | m_               | pixels on the picture: column, row; whether the line is steep, and its group (TAGGED 1)        |
//
// `start` begins a picture, `done` is one clock long after its last pixel was taken. Model and counts must not change in between.
// CLIP 0 leaves the clip stages away, for a model that is always in view: an edge with an end off the screen is not drawn, and `lost`
// is high for a clock.
// With TAGGED an edge begins when the last one's pixels are out, because the tags belong to whole lines.
//
// Clocks: a vertex costs what the slower of transform and project does (about 80), an edge 8 or its pixels, and clip's where it leaves
// the screen or the view volume.
`default_nettype none

module wireframe #(
    parameter int W_SCREEN    = 10,
    parameter int VERTICES    = 1024,
    parameter int EDGES       = 2048,
    parameter int MULTIPLIERS = 3,
    parameter int TAGGED      = 0,
    parameter int CLIP        = 1,
    parameter     VERTEX_HEX  = "",
    parameter     EDGE_HEX    = "",
    parameter int W_VERTEX    = $clog2(VERTICES),
    parameter int W_EDGE      = $clog2(EDGES)
) (
    input  wire logic                clk,
    input  wire logic                rst_n,
    input  wire logic [  W_SCREEN:0] width,
    input  wire logic [  W_SCREEN:0] height,
    input  wire logic [  W_VERTEX:0] vertices,
    input  wire logic [    W_EDGE:0] edges,
    input  wire logic                vertex_write,
    input  wire logic [W_VERTEX-1:0] vertex_address,
    input  wire logic [        47:0] vertex_word,
    input  wire logic                edge_write,
    input  wire logic [  W_EDGE-1:0] edge_address,
    input  wire logic [        31:0] edge_word,
    input  wire logic                matrix_write,
    input  wire logic [         3:0] matrix_address,
    input  wire logic [        31:0] matrix_word,
    input  wire logic                start,
    output logic                     busy,
    output logic                     done,
    output logic                     lost,
    output logic                     m_valid,
    input  wire logic                m_ready,
    output logic      [W_SCREEN-1:0] m_x,
    output logic      [W_SCREEN-1:0] m_y,
    output logic                     m_steep,
    output logic      [         1:0] m_group
);
    // A column or row of the guard band.
    localparam int W = CLIP != 0 ? W_SCREEN + 13 : W_SCREEN + 2;
    localparam int W_PROJECTED = 2 * W + 3;

    // -------------------------------------------------------------------------------------------------------------- sequence
    logic                swap;
    logic [W_VERTEX-1:0] vertex;
    logic                vertex_valid;
    logic                vertex_ready;
    logic                clipping;  // what is projected are the ends of an edge
    logic                volume_idle;
    logic [  W_EDGE-1:0] edge_number;
    logic [        31:0] edge_read;
    logic [W_VERTEX-1:0] projected_vertex;
    logic                take;
    logic [         2:0] flags_a, flags_b;
    logic [         3:0] sides_a, sides_b;
    logic                line_valid, line_ready, line_busy;
    logic                on_screen;
    logic [         1:0] group;

    logic                project_valid;
    logic [W_VERTEX-1:0] project_vertex;
    logic                left_valid;

    wireframe_sequence #(
        .TAGGED  (TAGGED),
        .CLIP    (CLIP),
        .W_VERTEX(W_VERTEX),
        .W_EDGE  (W_EDGE)
    ) i_sequence (
        .clk             (clk),
        .rst_n           (rst_n),
        .vertices        (vertices),
        .edges           (edges),
        .start           (start),
        .swap            (swap),
        .busy            (busy),
        .done            (done),
        .lost            (lost),
        .vertex          (vertex),
        .vertex_valid    (vertex_valid),
        .vertex_ready    (vertex_ready),
        .project_valid   (project_valid),
        .clipping        (clipping),
        .volume_idle     (volume_idle),
        .volume_given    (left_valid),
        .edge_number     (edge_number),
        .edge_word       (edge_read),
        .projected_vertex(projected_vertex),
        .take            (take),
        .flags_a         (flags_a),
        .flags_b         (flags_b),
        .sides_a         (sides_a),
        .sides_b         (sides_b),
        .line_valid      (line_valid),
        .line_ready      (line_ready),
        .line_busy       (line_busy),
        .on_screen       (on_screen),
        .group           (group)
    );

    // -------------------------------------------------------------------------------------------------------------- vertices
    // Clip coordinates of an edge's ends on their way to be clipped, and of what is left of it.
    logic                   ends_valid, ends_ready;
    logic signed [31:0]     ends_data;
    logic                   left_ready;
    logic signed [31:0]     left_data;
    // An end: flags, row, column.
    logic [W_PROJECTED-1:0] project_end;
    logic [W_PROJECTED-1:0] projected;
    logic [W_PROJECTED-1:0] taken;

    wireframe_vertices #(
        .W_SCREEN   (W_SCREEN),
        .W          (W),
        .VERTICES   (VERTICES),
        .MULTIPLIERS(MULTIPLIERS),
        .CLIP       (CLIP),
        .HEX        (VERTEX_HEX)
    ) i_vertices (
        .clk           (clk),
        .rst_n         (rst_n),
        .width         (width),
        .height        (height),
        .vertex_write  (vertex_write),
        .vertex_address(vertex_address),
        .vertex_word   (vertex_word),
        .matrix_write  (matrix_write),
        .matrix_address(matrix_address),
        .matrix_word   (matrix_word),
        .swap          (swap),
        .s_valid       (vertex_valid),
        .s_ready       (vertex_ready),
        .s_vertex      (vertex),
        .clipping      (clipping),
        .m_volume_valid(ends_valid),
        .m_volume_ready(ends_ready),
        .m_volume_data (ends_data),
        .s_volume_valid(left_valid),
        .s_volume_ready(left_ready),
        .s_volume_data (left_data),
        .m_valid       (project_valid),
        .m_x           (project_end[0+:W]),
        .m_y           (project_end[W+:W]),
        .m_flags       (project_end[2*W+:3]),
        .m_vertex      (project_vertex)
    );

    model_memory #(
        .W_WORD(W_PROJECTED),
        .WORDS (VERTICES)
    ) i_projected (
        .clk          (clk),
        .write        (project_valid && !clipping),
        .write_address(project_vertex),
        .write_word   (project_end),
        .read_address (projected_vertex),
        .read_word    (projected)
    );

    // ----------------------------------------------------------------------------------------------------------------- edges
    model_memory #(
        .W_WORD(32),
        .WORDS (EDGES),
        .HEX   (EDGE_HEX)
    ) i_edges (
        .clk          (clk),
        .write        (edge_write),
        .write_address(edge_address),
        .write_word   (edge_word),
        .read_address (edge_number),
        .read_word    (edge_read)
    );

    // From the projected memory, or projected again.
    assign taken = clipping ? project_end : projected;

    wireframe_lines #(
        .W_SCREEN(W_SCREEN),
        .W       (W),
        .TAGGED  (TAGGED),
        .CLIP    (CLIP)
    ) i_lines (
        .clk           (clk),
        .rst_n         (rst_n),
        .width         (width),
        .height        (height),
        .take          (take),
        .s_end_x       (taken[0+:W]),
        .s_end_y       (taken[W+:W]),
        .s_end_flags   (taken[2*W+:3]),
        .flags_a       (flags_a),
        .flags_b       (flags_b),
        .sides_a       (sides_a),
        .sides_b       (sides_b),
        .s_volume_valid(ends_valid),
        .s_volume_ready(ends_ready),
        .s_volume_data (ends_data),
        .m_volume_valid(left_valid),
        .m_volume_ready(left_ready),
        .m_volume_data (left_data),
        .volume_idle   (volume_idle),
        .s_valid       (line_valid),
        .s_ready       (line_ready),
        .s_on_screen   (on_screen),
        .s_group       (group),
        .busy          (line_busy),
        .m_valid       (m_valid),
        .m_ready       (m_ready),
        .m_x           (m_x),
        .m_y           (m_y),
        .m_steep       (m_steep),
        .m_group       (m_group)
    );
endmodule

`default_nettype wire
