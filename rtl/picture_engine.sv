// The drawing engine: whenever the screen takes a picture, each eye's matrix, then the model, as pixels.
//
//   picture_sequence -> matrix_source (spin_angle) -> wireframe -> m_
//          |                                             ^
//          +--------- right, stereo_size: width, height -+
//
//   | vertices, edges | of the model in the memories                                                                          |
//   | host_           | words for the memories: the matrix's and spin's by `host_address`, see matrix_source; a vertex is         |
//   |                 | `vertex_word` (z, y, x: Q1.15) at address[W_VERTEX:1], an edge at address[W_EDGE-1:0], see wireframe       |
//   | spinning        | the matrix comes from spin, and the angle goes on by `speed` after each picture                        |
//   | arrangement     | of two eyes, see stereo_place; 0: one eye, drawn once                                                  |
//   | m_              | pixels of the eye `m_right`: column, row; steep and group with TAGGED 1                                |
//   | draw_enable     | the screen takes a picture; `draw_done` for a clock after its last pixel was taken                       |
//   | lost            | for a clock: an edge could not be drawn (CLIP 0)                                                       |
//   | pictures, clocks| drawn since reset; of the last one, see picture_sequence                                               |
//
// What a host writes while `drawing` may be seen in that picture, except for matrices. Clocks: 19 an eye (1,045 with spin)
// before wireframe's.
`default_nettype none

module picture_engine #(
    parameter int WIDTH       = 640,
    parameter int HEIGHT      = 480,
    parameter int W_SCREEN    = 10,
    parameter int ALWAYS      = 0,
    parameter int TAGGED      = 0,
    parameter int MULTIPLIERS = 3,
    parameter int CLIP        = 1,
    parameter int VERTICES    = 1024,
    parameter int EDGES       = 2048,
    parameter int BUS         = 1,
    parameter int SPIN        = 1,
    parameter int BUTTONS     = 0,
    parameter int STABLE      = 1_000_000,
    parameter     VERTEX_HEX  = "",
    parameter     EDGE_HEX    = "",
    parameter     SPIN_HEX    = "",
    parameter int W_VERTEX    = $clog2(VERTICES),
    parameter int W_EDGE      = $clog2(EDGES)
) (
    input  wire logic                clk,
    input  wire logic                rst_n,
    input  wire logic [         2:0] buttons,
    // What a host asks for.
    input  wire logic                run,
    input  wire logic                commit,
    input  wire logic                spinning,
    input  wire logic [         2:0] arrangement,
    input  wire logic [         9:0] speed,
    input  wire logic [  W_VERTEX:0] vertices,
    input  wire logic [    W_EDGE:0] edges,
    input  wire logic                matrix_write,
    input  wire logic                spin_write,
    input  wire logic                vertex_write,
    input  wire logic                edge_write,
    input  wire logic [        11:0] host_address,
    input  wire logic [        31:0] host_word,
    input  wire logic [        47:0] vertex_word,
    // What it may know.
    output logic                     drawing,
    output logic                     committed,
    output logic                     lost,
    output logic      [         9:0] angle,
    output logic      [        31:0] pictures,
    output logic      [        31:0] clocks,
    // To the screen.
    input  wire logic                draw_enable,
    output logic                     draw_done,
    output logic                     m_valid,
    input  wire logic                m_ready,
    output logic      [W_SCREEN-1:0] m_x,
    output logic      [W_SCREEN-1:0] m_y,
    output logic                     m_steep,
    output logic      [         1:0] m_group,
    output logic                     m_right
);
    logic                bank;
    logic                matrix_start, matrix_fill, matrix_done;
    logic                draw_start, drawn;
    logic                word_write;
    logic [         3:0] word_address;
    logic [        31:0] word_data;
    logic [  W_SCREEN:0] width;
    logic [  W_SCREEN:0] height;
    logic                unused_busy;

    picture_sequence #(
        .ALWAYS(ALWAYS)
    ) i_sequence (
        .clk         (clk),
        .rst_n       (rst_n),
        .run         (run),
        .commit      (commit),
        .stereo      (arrangement != 3'd0),
        .drawing     (drawing),
        .committed   (committed),
        .pictures    (pictures),
        .clocks      (clocks),
        .bank        (bank),
        .right       (m_right),
        .matrix_start(matrix_start),
        .matrix_fill (matrix_fill),
        .matrix_done (matrix_done),
        .draw_start  (draw_start),
        .drawn       (drawn),
        .draw_enable (draw_enable),
        .draw_done   (draw_done)
    );

    spin_angle #(
        .BUTTONS(BUTTONS),
        .STABLE (STABLE)
    ) i_angle (
        .clk    (clk),
        .rst_n  (rst_n),
        .buttons(buttons),
        .speed  (speed),
        .step   (draw_done && spinning),
        .angle  (angle)
    );

    matrix_source #(
        .BUS     (BUS),
        .SPIN    (SPIN),
        .SPIN_HEX(SPIN_HEX)
    ) i_matrix (
        .clk          (clk),
        .rst_n        (rst_n),
        .matrix_write (matrix_write),
        .spin_write   (spin_write),
        .write_address(host_address[8:0]),
        .write_word   (host_word),
        .bank         (bank),
        .right        (m_right),
        .spinning     (spinning),
        .angle        (angle),
        .start        (matrix_start),
        .fill         (matrix_fill),
        .done         (matrix_done),
        .m_write      (word_write),
        .m_address    (word_address),
        .m_data       (word_data)
    );

    stereo_size #(
        .WIDTH (WIDTH),
        .HEIGHT(HEIGHT),
        .W_SIZE(W_SCREEN + 1)
    ) i_size (
        .arrangement(arrangement),
        .right      (m_right),
        .width      (width),
        .height     (height)
    );

    wireframe #(
        .W_SCREEN   (W_SCREEN),
        .VERTICES   (VERTICES),
        .EDGES      (EDGES),
        .MULTIPLIERS(MULTIPLIERS),
        .TAGGED     (TAGGED),
        .CLIP       (CLIP),
        .VERTEX_HEX (VERTEX_HEX),
        .EDGE_HEX   (EDGE_HEX)
    ) i_wireframe (
        .clk           (clk),
        .rst_n         (rst_n),
        .width         (width),
        .height        (height),
        .vertices      (vertices),
        .edges         (edges),
        .vertex_write  (vertex_write),
        .vertex_address(host_address[W_VERTEX:1]),
        .vertex_word   (vertex_word),
        .edge_write    (edge_write),
        .edge_address  (host_address[W_EDGE-1:0]),
        .edge_word     (host_word),
        .matrix_write  (word_write),
        .matrix_address(word_address),
        .matrix_word   (word_data),
        .start         (draw_start),
        .busy          (unused_busy),
        .done          (drawn),
        .lost          (lost),
        .m_valid       (m_valid),
        .m_ready       (m_ready),
        .m_x           (m_x),
        .m_y           (m_y),
        .m_steep       (m_steep),
        .m_group       (m_group)
    );

    logic unused_address;
    assign unused_address = ^host_address;
endmodule

`default_nettype wire
