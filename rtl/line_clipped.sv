// Raster, lines: from two ends anywhere in the guard band to the pixels on the screen, of one colour.
//
//   line_setup -> path -> line_walk           a line that lies on the screen
//   clip       -> path                        one that leaves it
//
//   | s_a_, s_b_    | ends: column and row, W bits with sign; W = W_SCREEN + 13 holds the guard band                     |
//   | s_on_screen   | both lie on the screen                                                                             |
//   | width, height | of the screen, at most 2^W_SCREEN each                                                            |
//   | s_volume_, m_volume_ | clip's other use, between two lines: ends in clip coordinates, and what of them is in view  |
//   | m_            | visible pixels in order of the major axis: column, row, and whether it is the line's last one;     |
//   |               | `steep` is the line's                                                                            |
//   | idle          | clip has no line                                                                                   |
//   | busy          | a line is in here                                                                                  |
//
// Clocks: a pixel a clock; a line takes at least 1, or what clip needs where it leaves the screen, while the one before is walked.
`default_nettype none

module line_clipped #(
    parameter int W_SCREEN = 10,
    parameter int W        = W_SCREEN + 13
) (
    input  wire logic                clk,
    input  wire logic                rst_n,
    input  wire logic [W_SCREEN:0]   width,
    input  wire logic [W_SCREEN:0]   height,
    input  wire logic                s_volume_valid,
    output logic                     s_volume_ready,
    input  wire logic signed [31:0]  s_volume_data,
    output logic                     m_volume_valid,
    input  wire logic                m_volume_ready,
    output logic signed [31:0]       m_volume_data,
    output logic                     idle,
    input  wire logic                s_valid,
    output logic                     s_ready,
    input  wire logic                s_on_screen,
    input  wire logic signed [W-1:0] s_a_x,
    input  wire logic signed [W-1:0] s_a_y,
    input  wire logic signed [W-1:0] s_b_x,
    input  wire logic signed [W-1:0] s_b_y,
    output logic                     m_valid,
    input  wire logic                m_ready,
    output logic [W_SCREEN-1:0]      m_x,
    output logic [W_SCREEN-1:0]      m_y,
    output logic                     m_steep,
    output logic                     m_last,
    output logic                     busy
);
    localparam logic [2:0] LAST_END = 3'd3;
    localparam logic [2:0] LAST_WORD = 3'd1;

    // Lines keep their order: one that goes through clip waits until line_setup is empty, and the next one until clip is.
    logic [2:0] setting_up;
    logic       advance, path_valid, path_ready;
    logic       clip_wanted, clip_from_here, clip_valid, clip_ready, clip_screen;
    logic [2:0] clip_word;
    assign clip_wanted    = s_valid && !s_on_screen && setting_up == '0;
    assign clip_from_here = idle ? !s_volume_valid : clip_screen;
    assign clip_valid     = clip_from_here ? clip_wanted : s_volume_valid;
    assign advance        = !path_valid || path_ready;
    assign s_ready        = s_on_screen ? idle && advance : clip_ready && clip_screen && clip_word == LAST_END;
    assign s_volume_ready = clip_ready && !clip_screen;
    assign busy           = setting_up != '0 || !idle || path_valid || m_valid;
    always_ff @(posedge clk) begin
        if (!rst_n) setting_up <= '0;
        else if (advance) setting_up <= {setting_up[1:0], s_valid && s_on_screen && idle};
    end

    // Columns and rows of the screen, with a sign.
    localparam int W_ON = W_SCREEN + 1;
    logic signed [W_ON-1:0] a_x, a_y, b_x, b_y, x, y;
    logic [W_ON-1:0]        n, m;
    logic                   steep, back;
    logic [23:0]            unused_from, unused_to, unused_rgb;
    assign a_x = s_a_x[W_ON-1:0];
    assign a_y = s_a_y[W_ON-1:0];
    assign b_x = s_b_x[W_ON-1:0];
    assign b_y = s_b_y[W_ON-1:0];
    line_setup #(
        .W(W_ON)
    ) i_setup (
        .clk    (clk),
        .advance(advance),
        .s_a_x  (a_x),
        .s_a_y  (a_y),
        .s_b_x  (b_x),
        .s_b_y  (b_y),
        .s_a_z  (1'b0),
        .s_b_z  (1'b0),
        .s_a_rgb(24'd0),
        .s_b_rgb(24'd0),
        .m_x    (x),
        .m_y    (y),
        .m_steep(steep),
        .m_back (back),
        .m_n    (n),
        .m_m    (m),
        .m_from (unused_from),
        .m_to   (unused_to)
    );

    logic signed [31:0] clip_in, clip_out;
    logic               clip_out_valid, clip_out_ready, clip_steep, clip_back;
    logic [2:0]         clip_out_word;
    always_comb begin
        case (clip_word)
            3'd0: clip_in = 32'(s_a_x);
            3'd1: clip_in = 32'(s_a_y);
            3'd2: clip_in = 32'(s_b_x);
            3'd3: clip_in = 32'(s_b_y);
            3'd6: clip_in = 32'(width);
            default: clip_in = 32'(height);
        endcase
        if (!clip_from_here) clip_in = s_volume_data;
    end
    clip i_clip (
        .clk     (clk),
        .rst_n   (rst_n),
        .s_screen(clip_from_here),
        .s_valid (clip_valid),
        .s_ready (clip_ready),
        .s_data  (clip_in),
        .s_word  (clip_word),
        .m_screen(clip_screen),
        .m_valid (clip_out_valid),
        .m_ready (clip_out_ready),
        .m_data  (clip_out),
        .m_word  (clip_out_word),
        .m_steep (clip_steep),
        .m_back  (clip_back),
        .idle    (idle)
    );
    assign m_volume_valid = clip_out_valid && !clip_screen;
    assign m_volume_data  = clip_out;
    assign clip_out_ready = clip_screen ? !path_valid : m_volume_ready;

    // The path that is walked next: line_setup's, or clip's word by word.
    logic                clip_gives, clip_busy;
    logic [W-1:0]        n_wide, m_wide;
    logic                path_steep, path_back;
    logic [W_SCREEN-1:0] path_x, path_y;
    logic [W-1:0]        path_steps, path_rise;
    logic signed [W:0]   path_turn;
    logic signed [W+1:0] path_error;
    assign clip_busy  = clip_screen && !idle;
    assign clip_gives = clip_out_valid && clip_out_ready && clip_screen;
    assign {n_wide, m_wide} = {W'(n), W'(m)};
    always_ff @(posedge clk) begin
        if (clip_busy) begin
            if (clip_gives) begin
                case (clip_out_word)
                    3'd0, 3'd1: begin
                        if ((clip_out_word == LAST_WORD) == clip_steep) path_x <= clip_out[W_SCREEN-1:0];
                        else path_y <= clip_out[W_SCREEN-1:0];
                    end
                    3'd2: path_steps <= clip_out[W-1:0];
                    3'd3: path_rise <= clip_out[W-1:0];
                    3'd4: path_turn <= clip_out[W:0];
                    default: path_error <= clip_out[W+1:0];
                endcase
                path_steep <= clip_steep;
                path_back  <= clip_back;
            end
        end else if (advance) begin
            path_x     <= x[W_SCREEN-1:0];
            path_y     <= y[W_SCREEN-1:0];
            path_steep <= steep;
            path_back  <= back;
            path_steps <= n_wide;
            path_rise  <= m_wide;
            path_turn  <= $signed({1'b0, m_wide}) - $signed({1'b0, n_wide});
            path_error <= $signed({1'b0, m_wide, 1'b0}) - $signed({2'b0, n_wide});
        end
        if (advance) path_valid <= setting_up[2];
        if (clip_gives && clip_out_word == LAST_WORD) path_valid <= 1'b1;
        if (!rst_n) path_valid <= 1'b0;
    end

    line_walk #(
        .W  (W_SCREEN),
        .W_N(W)
    ) i_walk (
        .clk    (clk),
        .rst_n  (rst_n),
        .s_valid(path_valid),
        .s_ready(path_ready),
        .s_x    (path_x),
        .s_y    (path_y),
        .s_steep(path_steep),
        .s_back (path_back),
        .s_steps(path_steps),
        .s_rise (path_rise),
        .s_turn (path_turn),
        .s_error(path_error),
        .s_now  (84'd0),
        .s_step (84'd0),
        .s_fall (3'd0),
        .m_valid(m_valid),
        .m_ready(m_ready),
        .m_x    (m_x),
        .m_y    (m_y),
        .m_steep(m_steep),
        .m_rgb  (unused_rgb),
        .m_last (m_last)
    );

    logic unused_bits;
    assign unused_bits = ^{clip_out, x, y, unused_from, unused_to, unused_rgb};
endmodule

`default_nettype wire
