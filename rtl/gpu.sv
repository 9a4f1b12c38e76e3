// The whole wireframe GPU: a model's vertices to the monitor's pins, without a processor.
//
//   Wishbone -> control_registers -+-> matrix memory or spin -> wireframe -> screen -> pins
//   buttons  -> debounce ----------+
//
// A picture: wait until the screen takes one; for each eye fill the transform's hidden bank, from the matrix memory (control.spin 0)
// or from spin (control.spin 1, stand-alone), and draw the model; tell the screen. The matrix memory has two banks of 16 words an
// eye; `commit` exchanges them before the next picture. With STEREO the right eye's words follow the left's (word 16 on), and those of
// spin are at 320 instead of 256.
//
//   | BUS 0    | no registers: everything has its value after reset, and the model comes from the HEX files               |
//   | WAY      | to the screen, see screen; colours of ways 1 and 2 are `palette` by the edge's group                  |
//   | STEREO   | 1: arrangements 0 to 3, 2: to 6, 3: all (stereo_place has the table); one that is not there, and any  |
//   |          | with WAY 2, shows one eye                                                                             |
//   | SPIN 0   | no stand-alone mode                                                                                   |
//   | BUTTONS  | 1: `buttons[0]` turns faster, `buttons[1]` slower, `buttons[2]` stops and goes on (spin only)          |
//
// Everything but the screen's pixel side runs at `clk`; `clk_pixel` may be another clock, except for WAY 2. Colours and arrangement
// cross as they are: change them while `control.run` is 0, or accept one mixed frame.
`default_nettype none

module gpu #(
    parameter int WAY             = 0,
    parameter int H_ACTIVE        = 640,
    parameter int H_FRONT         = 16,
    parameter int H_SYNC          = 96,
    parameter int H_BACK          = 48,
    parameter int V_ACTIVE        = 480,
    parameter int V_FRONT         = 10,
    parameter int V_SYNC          = 2,
    parameter int V_BACK          = 33,
    parameter int SCALE_BITS      = 0,
    parameter int STRIDE_BITS     = 5,
    parameter int SPRAM           = 0,
    parameter int FORMAT          = 3,
    parameter int DITHER          = 0,
    parameter int MEMORIES        = 12,
    parameter int STEREO          = 0,
    parameter int OVERLAY         = 0,
    parameter int MULTIPLIERS     = 3,
    parameter int CLIP            = 1,
    parameter int VERTICES        = 1024,
    parameter int EDGES           = 2048,
    parameter int BUS             = 1,
    parameter int SPIN            = 1,
    parameter int BUTTONS         = 0,
    parameter int STABLE          = 1_000_000,
    parameter int MODEL_VERTICES  = 0,
    parameter int MODEL_EDGES     = 0,
    parameter     VERTEX_HEX      = "",
    parameter     EDGE_HEX        = "",
    parameter     SPIN_HEX        = "",
    parameter int W_R             = 8,
    parameter int W_G             = 8,
    parameter int W_B             = 8
) (
    input  wire logic           clk,
    input  wire logic           rst_n,
    input  wire logic           clk_pixel,
    input  wire logic           pixel_rst_n,
    input  wire logic [    2:0] buttons,
    input  wire logic           wb_cyc,
    input  wire logic           wb_stb,
    input  wire logic           wb_we,
    input  wire logic [   12:0] wb_adr,
    input  wire logic [    3:0] wb_sel,
    input  wire logic [   31:0] wb_dat_w,
    output logic      [   31:0] wb_dat_r,
    output logic                wb_ack,
    output logic                wb_err,
    // The camera, at clk_pixel.
    input  wire logic           s_camera_valid,
    output logic                s_camera_ready,
    input  wire logic           s_camera_first,
    input  wire logic [   23:0] s_camera_rgb,
    // The monitor, at clk_pixel.
    output logic      [W_R-1:0] r,
    output logic      [W_G-1:0] g,
    output logic      [W_B-1:0] b,
    output logic                active,
    output logic                hsync,
    output logic                vsync
);
    localparam int WIDTH = H_ACTIVE >> SCALE_BITS;
    localparam int HEIGHT = V_ACTIVE >> SCALE_BITS;
    localparam logic [15:0] SIZE_WIDTH = 16'(WIDTH);
    localparam logic [15:0] SIZE_HEIGHT = 16'(HEIGHT);
    localparam int W_X = $clog2(WIDTH);
    localparam int W_Y = $clog2(HEIGHT);
    localparam int W_SCREEN = W_X > W_Y ? W_X : W_Y;
    localparam int W_VERTEX = $clog2(VERTICES);
    localparam int W_EDGE = $clog2(EDGES);
    localparam int W_ARRANGED = STEREO > 1 ? 3 : 2;
    localparam logic [1:0] FEATURES_WAY = 2'(WAY);
    localparam logic [1:0] FEATURES_STEREO = WAY != 2 ? 2'(STEREO) : 2'd0;

    // ----------------------------------------------------------------------------------------------------------- registers
    logic        run, use_spin, camera, commit;
    logic [ 2:0] chosen, arrangement;
    logic [23:0] ink, background;
    logic [95:0] palette;
    logic [15:0] vertices, edges;
    logic [ 9:0] speed;
    logic [11:0] window_index;
    logic [31:0] window_data;
    logic        matrix_write, spin_write, vertex_write, edge_write;

    logic        drawing, committed, late, incomplete;
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
                wb_cyc, wb_stb, wb_we, wb_adr, wb_sel, wb_dat_w, drawing, committed, late, incomplete, pictures, clocks
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

    assign arrangement = WAY != 2 && (STEREO > 1 || (STEREO == 1 && !chosen[2])) ? chosen : 3'd0;

    // -------------------------------------------------------------------------------------------------------------- buttons
    logic       paused;
    logic [9:0] faster;

    generate
        if (BUTTONS != 0) begin : g_buttons
            logic [2:0] pressed;
            logic [2:0] unused_level;
            for (genvar i = 0; i < 3; i++) begin : g_button
                debounce #(
                    .STABLE(STABLE)
                ) i_debounce (
                    .clk    (clk),
                    .rst_n  (rst_n),
                    .pin    (buttons[i]),
                    .level  (unused_level[i]),
                    .pressed(pressed[i])
                );
            end
            always_ff @(posedge clk) begin
                faster <= faster + 10'(pressed[0]) - 10'(pressed[1]);
                paused <= paused ^ pressed[2];
                if (!rst_n) {faster, paused} <= '0;
            end
        end else begin : g_no_buttons
            logic unused_buttons;
            assign unused_buttons = ^buttons;
            assign {faster, paused} = '0;
        end
    endgenerate

    // ------------------------------------------------------------------------------------------------------------- sequence
    typedef enum logic [2:0] {WAIT, FILL, FILLED, BEGIN, DRAW, FINISH, RELEASE} state_t;
    state_t      state;
    logic        draw_enable;
    logic        right;
    logic        bank;  // of the matrix memory: the one that is used
    logic        spin_done;
    logic        wireframe_done;
    logic [ 4:0] word;
    logic [31:0] clocks_now;

    assign drawing = state != WAIT;

    // The matrix memory: bank, eye, word.
    logic [5:0]  matrix_read_address;
    logic [31:0] matrix_read;
    logic [ 5:0] matrix_write_address;
    assign matrix_read_address  = {bank, right, word[3:0]};
    assign matrix_write_address = {!bank, window_index[4:0]};

    generate
        if (BUS != 0) begin : g_matrix
            model_memory #(
                .W_WORD(32),
                .WORDS (64)
            ) i_matrix (
                .clk          (clk),
                .write        (matrix_write),
                .write_address(matrix_write_address),
                .write_word   (window_data),
                .read_address (matrix_read_address),
                .read_word    (matrix_read)
            );
        end else begin : g_no_matrix
            logic unused_matrix;
            assign unused_matrix = ^{matrix_read_address, matrix_write_address, matrix_write};
            assign matrix_read   = '0;
        end
    endgenerate

    logic        spin_valid;
    logic [ 3:0] spin_address;
    logic [31:0] spin_word;
    logic        spinning;
    logic        spin_start;
    assign spin_start = state == FILL && spinning;
    assign spinning = SPIN != 0 && (BUS == 0 || use_spin);

    generate
        if (SPIN != 0) begin : g_spin
            spin #(
                .HEX(SPIN_HEX)
            ) i_spin (
                .clk          (clk),
                .rst_n        (rst_n),
                .write        (spin_write),
                .write_address(window_index[8:0]),
                .write_word   (window_data),
                .start        (spin_start),
                .angle        (angle),
                .right        (right),
                .m_write      (spin_valid),
                .m_address    (spin_address),
                .m_data       (spin_word),
                .done         (spin_done)
            );
        end else begin : g_no_spin
            logic unused_spin;
            assign unused_spin = ^{spin_write, spin_start};
            assign {spin_valid, spin_address, spin_word, spin_done} = '0;
        end
    endgenerate

    logic        fill_valid;
    logic [ 3:0] fill_address;
    always_ff @(posedge clk) begin
        fill_valid   <= state == FILLED && !spinning && !word[4];
        fill_address <= word[3:0];
    end

    always_ff @(posedge clk) begin
        if (commit) committed <= 1'b1;
        clocks_now <= clocks_now + 1'b1;
        case (state)
            WAIT: begin
                clocks_now <= '0;
                right      <= 1'b0;
                // Line memories are cleared for a picture that was wanted, so it must come.
                if (draw_enable && (run || WAY == 2)) begin
                    state <= FILL;
                    // Run and commit may be written at once.
                    if (committed || commit) bank <= !bank;
                    committed <= 1'b0;
                end
            end
            FILL: begin
                word  <= '0;
                state <= FILLED;
            end
            FILLED: begin
                // Words of the memory come a clock after their address, so the last one is written when word is 17.
                if (!spinning) word <= word + 1'b1;
                if (spinning ? spin_done : word == 5'd17) state <= BEGIN;
            end
            BEGIN: state <= DRAW;
            DRAW: begin
                if (wireframe_done) begin
                    state <= FINISH;
                    if (arrangement != 3'd0 && !right) begin
                        right <= 1'b1;
                        state <= FILL;
                    end
                end
            end
            FINISH: begin
                clocks   <= clocks_now;
                pictures <= pictures + 1'b1;
                if (spinning && !paused) angle <= angle + speed + faster;
                state    <= RELEASE;
            end
            RELEASE: if (!draw_enable) state <= WAIT;
            default: state <= WAIT;
        endcase
        if (!rst_n) begin
            state     <= WAIT;
            bank      <= 1'b0;
            committed <= 1'b0;
            pictures  <= '0;
            clocks    <= '0;
            angle     <= '0;
        end
    end

    // -------------------------------------------------------------------------------------------------------- pixels to pins
    localparam logic [W_SCREEN:0] ALL_WIDTH = (W_SCREEN + 1)'(WIDTH);
    localparam logic [W_SCREEN:0] HALF_WIDTH = (W_SCREEN + 1)'(WIDTH / 2);
    localparam logic [W_SCREEN:0] ALL_HEIGHT = (W_SCREEN + 1)'(HEIGHT);
    localparam logic [W_SCREEN:0] HALF_HEIGHT = (W_SCREEN + 1)'(HEIGHT / 2);
    logic                pixel_valid;
    logic                pixel_ready;
    logic [W_SCREEN-1:0] pixel_x;
    logic [W_SCREEN-1:0] pixel_y;
    logic                pixel_steep;
    logic [         1:0] pixel_group;
    logic                busy;
    logic [  W_SCREEN:0] eye_width;
    logic [  W_SCREEN:0] eye_height;

    // Halves: when the side is odd, the right eye has the larger one.
    always_comb begin
        eye_width  = ALL_WIDTH;
        eye_height = ALL_HEIGHT;
        if (arrangement == 3'd2) eye_width = right ? ALL_WIDTH - HALF_WIDTH : HALF_WIDTH;
        if (arrangement == 3'd4) eye_height = right ? ALL_HEIGHT - HALF_HEIGHT : HALF_HEIGHT;
    end

    // A vertex's x, y wait for its z, which is written first.
    logic [15:0] z;
    always_ff @(posedge clk) if (vertex_write && window_index[0]) z <= window_data[15:0];

    localparam int TAGGED = WAY != 0 ? 1 : 0;
    logic                wireframe_start;
    logic                edge_lost;
    logic                screen_done;
    logic [  W_VERTEX:0] vertex_count;
    logic [    W_EDGE:0] edge_count;
    logic                xy_write;
    logic [        47:0] vertex_word;
    logic                word_write;
    logic [         3:0] word_address;
    logic [        31:0] word_data;
    logic [        23:0] group_rgb;

    assign wireframe_start = state == BEGIN;
    assign screen_done     = state == FINISH;
    assign vertex_count    = vertices == '0 ? (W_VERTEX + 1)'(MODEL_VERTICES) : vertices[W_VERTEX:0];
    assign edge_count      = edges == '0 ? (W_EDGE + 1)'(MODEL_EDGES) : edges[W_EDGE:0];
    assign xy_write        = vertex_write && !window_index[0];
    assign vertex_word     = {z, window_data};
    assign word_write      = spin_valid || fill_valid;
    assign word_address    = spin_valid ? spin_address : fill_address;
    assign word_data       = spin_valid ? spin_word : matrix_read;
    assign group_rgb       = palette[24*pixel_group+:24];

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
        .width         (eye_width),
        .height        (eye_height),
        .vertices      (vertex_count),
        .edges         (edge_count),
        .vertex_write  (xy_write),
        .vertex_address(window_index[W_VERTEX:1]),
        .vertex_word   (vertex_word),
        .edge_write    (edge_write),
        .edge_address  (window_index[W_EDGE-1:0]),
        .edge_word     (window_data),
        .matrix_write  (word_write),
        .matrix_address(word_address),
        .matrix_word   (word_data),
        .start         (wireframe_start),
        .busy          (busy),
        .done          (wireframe_done),
        .lost          (edge_lost),
        .m_valid       (pixel_valid),
        .m_ready       (pixel_ready),
        .m_x           (pixel_x),
        .m_y           (pixel_y),
        .m_steep       (pixel_steep),
        .m_group       (pixel_group)
    );

    logic [15:0] dropped;
    logic        camera_late;
    logic        blank_start;

    screen #(
        .WAY        (WAY),
        .H_ACTIVE   (H_ACTIVE),
        .H_FRONT    (H_FRONT),
        .H_SYNC     (H_SYNC),
        .H_BACK     (H_BACK),
        .V_ACTIVE   (V_ACTIVE),
        .V_FRONT    (V_FRONT),
        .V_SYNC     (V_SYNC),
        .V_BACK     (V_BACK),
        .SCALE_BITS (SCALE_BITS),
        .STRIDE_BITS(STRIDE_BITS),
        .SPRAM      (SPRAM),
        .FORMAT     (FORMAT),
        .DITHER     (DITHER),
        .MEMORIES   (MEMORIES),
        .STEREO     (STEREO),
        .OVERLAY    (OVERLAY),
        .W_R        (W_R),
        .W_G        (W_G),
        .W_B        (W_B)
    ) i_screen (
        .clk           (clk_pixel),
        .rst_n         (pixel_rst_n),
        .arrangement   (arrangement[W_ARRANGED-1:0]),
        .camera_enable (camera),
        .ink           (ink),
        .background    (background),
        .palette       (palette),
        .draw_clk      (clk),
        .draw_rst_n    (rst_n),
        .draw_want     (run),
        .draw_enable   (draw_enable),
        .draw_done     (screen_done),
        .s_valid       (pixel_valid),
        .s_ready       (pixel_ready),
        .s_x           (pixel_x[W_X-1:0]),
        .s_y           (pixel_y[W_Y-1:0]),
        .s_rgb         (group_rgb),
        .s_steep       (pixel_steep),
        .s_group       (pixel_group),
        .s_right       (right),
        .s_camera_valid(s_camera_valid),
        .s_camera_ready(s_camera_ready),
        .s_camera_first(s_camera_first),
        .s_camera_rgb  (s_camera_rgb),
        .dropped       (dropped),
        .camera_late   (camera_late),
        .blank_start   (blank_start),
        .r             (r),
        .g             (g),
        .b             (b),
        .active        (active),
        .hsync         (hsync),
        .vsync         (vsync)
    );

    // A late pixel turns a level over, which crosses; way 2 has one clock.
    logic late_level, late_here, late_before;
    always_ff @(posedge clk_pixel) begin
        if (camera_late) late_level <= !late_level;
        if (!pixel_rst_n) late_level <= 1'b0;
    end
    synchronise i_late (
        .clk  (clk),
        .rst_n(rst_n),
        .s    (late_level),
        .m    (late_here)
    );
    always_ff @(posedge clk) begin
        late_before <= late_here;
        late        <= rst_n && late_here != late_before;
        incomplete  <= dropped != '0 || edge_lost;
    end

    logic unused_gpu;
    assign unused_gpu = ^{busy, blank_start, pixel_x, pixel_y, window_index, vertices, edges, word, use_spin, arrangement};
endmodule

`default_nettype wire
