// Registers to pixels: what a host asks for, or what holds without one, drawn picture after picture. All of it runs at `clk`.
//
//   Wishbone -> control_registers -> picture_engine -> m_      pixels for the screen
//   buttons  --------------------------^          |
//                                                 +-> m_rgb    colour of the pixel's group, from `palette`
//
//   | BUS 0    | no registers: everything has its value after reset, and the model comes from the HEX files                  |
//   | SPIN 0   | no stand-alone mode                                                                                      |
//   | STEREO   | 1: arrangements 0 to 3, 2: to 6, 3: all; one that is not there, and any with WAY 2, is 0                 |
//   | WAY      | to the screen, see screen; with 2 a picture is drawn whenever the screen takes one, even if `run` is 0   |
//   | wb_      | Wishbone B4, classic; registers and memories as in registers.md                                          |
//   | colours  | U8.0 a channel, red in the top bits; `palette` has four, group 0's in the lowest bits                    |
//   | m_, draw_| pixels of the eye `m_right`, and the screen's rhythm, see screen                                         |
//   | late     | for a clock: the camera came too late; `dropped`: pixels of the picture that found no line memory        |
`default_nettype none

module gpu_draw #(
    parameter int WAY            = 0,
    parameter int STEREO         = 0,
    parameter int WIDTH          = 640,
    parameter int HEIGHT         = 480,
    parameter int W_SCREEN       = 10,
    parameter int MULTIPLIERS    = 3,
    parameter int CLIP           = 1,
    parameter int VERTICES       = 1024,
    parameter int EDGES          = 2048,
    parameter int BUS            = 1,
    parameter int SPIN           = 1,
    parameter int BUTTONS        = 0,
    parameter int STABLE         = 1_000_000,
    parameter int MODEL_VERTICES = 0,
    parameter int MODEL_EDGES    = 0,
    parameter     VERTEX_HEX     = "",
    parameter     EDGE_HEX       = "",
    parameter     SPIN_HEX       = "",
    parameter int W_ARRANGED     = STEREO > 1 ? 3 : 2
) (
    input  wire logic                  clk,
    input  wire logic                  rst_n,
    input  wire logic [           2:0] buttons,
    input  wire logic                  wb_cyc,
    input  wire logic                  wb_stb,
    input  wire logic                  wb_we,
    input  wire logic [          12:0] wb_adr,
    input  wire logic [           3:0] wb_sel,
    input  wire logic [          31:0] wb_dat_w,
    output logic      [          31:0] wb_dat_r,
    output logic                       wb_ack,
    output logic                       wb_err,
    // To the screen, and what it reports.
    output logic                       run,
    output logic                       camera,
    output logic      [W_ARRANGED-1:0] arrangement,
    output logic      [          23:0] ink,
    output logic      [          23:0] background,
    output logic      [          95:0] palette,
    input  wire logic                  draw_enable,
    output logic                       draw_done,
    output logic                       m_valid,
    input  wire logic                  m_ready,
    output logic      [  W_SCREEN-1:0] m_x,
    output logic      [  W_SCREEN-1:0] m_y,
    output logic      [          23:0] m_rgb,
    output logic                       m_steep,
    output logic      [           1:0] m_group,
    output logic                       m_right,
    input  wire logic                  late,
    input  wire logic [          15:0] dropped
);
    localparam int W_VERTEX = $clog2(VERTICES);
    localparam int W_EDGE = $clog2(EDGES);
    localparam int TAGGED = WAY != 0 ? 1 : 0;
    localparam int ALWAYS = WAY == 2 ? 1 : 0;  // line memories are cleared for a picture that was wanted, so it must come
    localparam logic [15:0] SIZE_WIDTH = 16'(WIDTH);
    localparam logic [15:0] SIZE_HEIGHT = 16'(HEIGHT);
    localparam logic [1:0] FEATURES_WAY = 2'(WAY);
    localparam logic [1:0] FEATURES_STEREO = WAY != 2 ? 2'(STEREO) : 2'd0;

    // ----------------------------------------------------------------------------------------------------------- registers
    logic        use_spin, commit;
    logic [ 2:0] chosen, arranged;
    logic [15:0] vertices, edges;
    logic [ 9:0] speed;
    logic [11:0] window_index;
    logic [31:0] window_data;
    logic        matrix_write, spin_write, vertex_write, edge_write;

    logic        drawing, committed, incomplete, lost;
    logic [31:0] pictures, clocks;
    logic [ 9:0] angle;

    generate
        if (BUS != 0) begin : g_bus
            control_registers i_registers (
                .clk                (clk),
                .rst_n              (rst_n),
                .wb_cyc             (wb_cyc),
                .wb_stb             (wb_stb),
                .wb_we              (wb_we),
                .wb_adr             (wb_adr),
                .wb_sel             (wb_sel),
                .wb_dat_w           (wb_dat_w),
                .wb_dat_r           (wb_dat_r),
                .wb_ack             (wb_ack),
                .wb_err             (wb_err),
                .size_width         (SIZE_WIDTH),
                .size_height        (SIZE_HEIGHT),
                .control_run        (run),
                .control_spin       (use_spin),
                .control_camera     (camera),
                .control_arrangement(chosen),
                .control_commit     (commit),
                .status_drawing     (drawing),
                .status_committed   (committed),
                .status_late        (late),
                .status_incomplete  (incomplete),
                .pictures           (pictures),
                .clocks             (clocks),
                .ink                (ink),
                .background         (background),
                .model_vertices     (vertices),
                .model_edges        (edges),
                .speed              (speed),
                .angle              (angle),
                .features_way       (FEATURES_WAY),
                .features_stereo    (FEATURES_STEREO),
                .palette0           (palette[23:0]),
                .palette1           (palette[47:24]),
                .palette2           (palette[71:48]),
                .palette3           (palette[95:72]),
                .window_index       (window_index),
                .window_data        (window_data),
                .matrix_write       (matrix_write),
                .spin_write         (spin_write),
                .vertex_write       (vertex_write),
                .edge_write         (edge_write)
            );
        end else begin : g_alone
            logic unused_bus;
            assign unused_bus = ^{
                wb_cyc, wb_stb, wb_we, wb_adr, wb_sel, wb_dat_w, drawing, committed, late, incomplete, angle, pictures, clocks
            };
            assign wb_dat_r = '0;
            assign wb_ack   = 1'b0;
            assign wb_err   = wb_cyc && wb_stb;
            assign {run, use_spin, camera, commit, chosen} = 7'b1100000;
            assign ink        = 24'hffffff;
            assign background = '0;
            assign palette    = 96'h0000ff_00ff00_ff0000_ffffff;
            assign {vertices, edges} = '0;
            assign speed      = 10'd4;
            assign {window_index, window_data, matrix_write, spin_write, vertex_write, edge_write} = '0;
        end
    endgenerate

    assign arranged    = WAY != 2 && (STEREO > 1 || (STEREO == 1 && !chosen[2])) ? chosen : 3'd0;
    assign arrangement = arranged[W_ARRANGED-1:0];

    always_ff @(posedge clk) incomplete <= dropped != '0 || lost;

    // -------------------------------------------------------------------------------------------------------------- pictures
    logic              spinning;
    logic [W_VERTEX:0] vertex_count;
    logic [  W_EDGE:0] edge_count;
    logic [      47:0] vertex_word;
    assign spinning     = SPIN != 0 && (BUS == 0 || use_spin);
    assign vertex_count = vertices == '0 ? (W_VERTEX + 1)'(MODEL_VERTICES) : vertices[W_VERTEX:0];
    assign edge_count   = edges == '0 ? (W_EDGE + 1)'(MODEL_EDGES) : edges[W_EDGE:0];
    assign m_rgb        = palette[24*m_group+:24];

    // A vertex's x, y wait for its z, which is written first.
    logic [15:0] z;
    always_ff @(posedge clk) if (vertex_write && window_index[0]) z <= window_data[15:0];
    assign vertex_word = {z, window_data};

    picture_engine #(
        .WIDTH      (WIDTH),
        .HEIGHT     (HEIGHT),
        .W_SCREEN   (W_SCREEN),
        .ALWAYS     (ALWAYS),
        .TAGGED     (TAGGED),
        .MULTIPLIERS(MULTIPLIERS),
        .CLIP       (CLIP),
        .VERTICES   (VERTICES),
        .EDGES      (EDGES),
        .BUS        (BUS),
        .SPIN       (SPIN),
        .BUTTONS    (BUTTONS),
        .STABLE     (STABLE),
        .VERTEX_HEX (VERTEX_HEX),
        .EDGE_HEX   (EDGE_HEX),
        .SPIN_HEX   (SPIN_HEX)
    ) i_engine (
        .clk         (clk),
        .rst_n       (rst_n),
        .buttons     (buttons),
        .run         (run),
        .commit      (commit),
        .spinning    (spinning),
        .arrangement (arranged),
        .speed       (speed),
        .vertices    (vertex_count),
        .edges       (edge_count),
        .matrix_write(matrix_write),
        .spin_write  (spin_write),
        .vertex_write(vertex_write && !window_index[0]),
        .edge_write  (edge_write),
        .host_address(window_index),
        .host_word   (window_data),
        .vertex_word (vertex_word),
        .drawing     (drawing),
        .committed   (committed),
        .lost        (lost),
        .angle       (angle),
        .pictures    (pictures),
        .clocks      (clocks),
        .draw_enable (draw_enable),
        .draw_done   (draw_done),
        .m_valid     (m_valid),
        .m_ready     (m_ready),
        .m_x         (m_x),
        .m_y         (m_y),
        .m_steep     (m_steep),
        .m_group     (m_group),
        .m_right     (m_right)
    );

    logic unused_draw;
    assign unused_draw = ^{vertices, edges, use_spin, arranged};
endmodule

`default_nettype wire
