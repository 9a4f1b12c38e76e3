// The whole wireframe GPU: a model's vertices to the monitor's pins, without a processor.
//
//   Wishbone -> gpu_draw: control_registers -> picture_engine: matrix memory or spin -> wireframe
//   buttons  --------------------------------------^                                         |
//                                                                            pixels -> screen -> pins
//
// A picture: wait until the screen takes one; for each eye fill the transform's hidden bank, from the matrix memory (control.spin 0)
// or from spin (control.spin 1, stand-alone), and draw the model; tell the screen. `commit` exchanges the matrix memory's banks
// before the next picture.
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
    localparam int W_X = $clog2(WIDTH);
    localparam int W_Y = $clog2(HEIGHT);
    localparam int W_SCREEN = W_X > W_Y ? W_X : W_Y;
    localparam int W_ARRANGED = STEREO > 1 ? 3 : 2;

    logic                  run, camera;
    logic [W_ARRANGED-1:0] arrangement;
    logic [          23:0] ink, background;
    logic [          95:0] palette;
    logic                  draw_enable, draw_done;
    logic                  pixel_valid, pixel_ready;
    logic [  W_SCREEN-1:0] pixel_x, pixel_y;
    logic [          23:0] pixel_rgb;
    logic                  pixel_steep;
    logic [           1:0] pixel_group;
    logic                  pixel_right;
    logic                  late;
    logic [          15:0] dropped;

    gpu_draw #(
        .WAY           (WAY),
        .STEREO        (STEREO),
        .WIDTH         (WIDTH),
        .HEIGHT        (HEIGHT),
        .W_SCREEN      (W_SCREEN),
        .MULTIPLIERS   (MULTIPLIERS),
        .CLIP          (CLIP),
        .VERTICES      (VERTICES),
        .EDGES         (EDGES),
        .BUS           (BUS),
        .SPIN          (SPIN),
        .BUTTONS       (BUTTONS),
        .STABLE        (STABLE),
        .MODEL_VERTICES(MODEL_VERTICES),
        .MODEL_EDGES   (MODEL_EDGES),
        .VERTEX_HEX    (VERTEX_HEX),
        .EDGE_HEX      (EDGE_HEX),
        .SPIN_HEX      (SPIN_HEX)
    ) i_draw (
        .clk        (clk),
        .rst_n      (rst_n),
        .buttons    (buttons),
        .wb_cyc     (wb_cyc),
        .wb_stb     (wb_stb),
        .wb_we      (wb_we),
        .wb_adr     (wb_adr),
        .wb_sel     (wb_sel),
        .wb_dat_w   (wb_dat_w),
        .wb_dat_r   (wb_dat_r),
        .wb_ack     (wb_ack),
        .wb_err     (wb_err),
        .run        (run),
        .camera     (camera),
        .arrangement(arrangement),
        .ink        (ink),
        .background (background),
        .palette    (palette),
        .draw_enable(draw_enable),
        .draw_done  (draw_done),
        .m_valid    (pixel_valid),
        .m_ready    (pixel_ready),
        .m_x        (pixel_x),
        .m_y        (pixel_y),
        .m_rgb      (pixel_rgb),
        .m_steep    (pixel_steep),
        .m_group    (pixel_group),
        .m_right    (pixel_right),
        .late       (late),
        .dropped    (dropped)
    );

    logic camera_late;
    logic blank_start;
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
        .arrangement   (arrangement),
        .camera_enable (camera),
        .ink           (ink),
        .background    (background),
        .palette       (palette),
        .draw_clk      (clk),
        .draw_rst_n    (rst_n),
        .draw_want     (run),
        .draw_enable   (draw_enable),
        .draw_done     (draw_done),
        .s_valid       (pixel_valid),
        .s_ready       (pixel_ready),
        .s_x           (pixel_x[W_X-1:0]),
        .s_y           (pixel_y[W_Y-1:0]),
        .s_rgb         (pixel_rgb),
        .s_steep       (pixel_steep),
        .s_group       (pixel_group),
        .s_right       (pixel_right),
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
    end

    logic unused_gpu;
    assign unused_gpu = ^{blank_start, pixel_x, pixel_y};
endmodule

`default_nettype wire
