// Raster, lines: Bresenham's walk along a path, a pixel a clock and no bubble between lines.
//
//   pixel i of 0..steps:  major += 1;  minor += 1 (or -1 when `back`) where error >= 0
//   error += 2 rise where it was negative, 2 turn where not             turn = rise - n, so 2 turn = 2 m - 2 n
//
// Source: Bresenham 1965; a step when 2 e >= major. `error` is the decision of the step that comes next, so the sign bit of a
// register chooses the step: nothing is added and compared in one clock.
//
//   | s_x, s_y  | first pixel, W bits, modulo 2^W                                                                   |
//   | s_steps   | pixels - 1, unsigned                                                                              |
//   | s_rise    | m, unsigned, at most n                                                                            |
//   | s_turn    | m - n, signed                                                                                     |
//   | s_error   | (2 m i + n) mod 2 n - 2 n + 2 m at the first pixel: 2 m - n at the beginning of a line; signed    |
//   | s_now     | three colours with the half that rounds, {red, green, blue}, W_COLOUR bits each (8.20)            |
//   | s_step    | what a pixel adds to each: its bits when `s_fall` is 0, their complement when 1                   |
//   | m_        | column, row, whether the line is steep, colour, and whether it is the line's last pixel           |
//
// Latency 1 clock. s_ready depends on m_ready without a register between.
`default_nettype none

module line_walk #(
    parameter int W        = 12,
    parameter int W_N      = W,
    parameter int COLOUR   = 0,
    parameter int W_COLOUR = 28
) (
    input  wire logic                    clk,
    input  wire logic                    rst_n,
    input  wire logic                    s_valid,
    output logic                         s_ready,
    input  wire logic [W-1:0]            s_x,
    input  wire logic [W-1:0]            s_y,
    input  wire logic                    s_steep,
    input  wire logic                    s_back,
    input  wire logic [W_N-1:0]          s_steps,
    input  wire logic [W_N-1:0]          s_rise,
    input  wire logic signed [W_N:0]     s_turn,
    input  wire logic signed [W_N+1:0]   s_error,
    input  wire logic [3*W_COLOUR-1:0]   s_now,
    input  wire logic [3*W_COLOUR-1:0]   s_step,
    input  wire logic [2:0]              s_fall,
    output logic                         m_valid,
    input  wire logic                    m_ready,
    output logic [W-1:0]                 m_x,
    output logic [W-1:0]                 m_y,
    output logic                         m_steep,
    output logic [23:0]                  m_rgb,
    output logic                         m_last
);
    logic                    steep, back;
    assign m_steep = steep;
    logic [W_N-1:0]          left, rise;
    logic signed [W_N:0]     turn;
    logic signed [W_N+1:0]   error;

    logic load, step, sideways, x_moves, y_moves;
    assign s_ready  = !m_valid || (m_ready && m_last);
    assign load     = s_ready;
    assign step     = m_ready;
    assign sideways = !error[W_N+1];
    assign x_moves  = !steep || sideways;
    assign y_moves  = steep || sideways;

    logic signed [W_N+1:0] more;
    logic [W-1:0]          x_step, y_step;
    assign more   = {sideways ? turn : {1'b0, rise}, 1'b0};
    assign x_step = {{(W - 1){x_moves && steep && back}}, x_moves};
    assign y_step = {{(W - 1){y_moves && !steep && back}}, y_moves};

    always_ff @(posedge clk) begin
        if (!rst_n) m_valid <= 1'b0;
        else if (load) m_valid <= s_valid;
    end

    // While nothing is being walked the registers follow s_ whether or not it is valid.
    always_ff @(posedge clk) begin
        if (load) begin
            m_x    <= s_x;
            m_y    <= s_y;
            error  <= s_error;
            left   <= s_steps;
            m_last <= s_steps == '0;
            steep  <= s_steep;
            back   <= s_back;
            rise   <= s_rise;
            turn   <= s_turn;
        end else if (step) begin
            m_x    <= m_x + x_step;
            m_y    <= m_y + y_step;
            error  <= error + more;
            left   <= left - 1'b1;
            m_last <= left == W_N'(1);
        end
    end

    generate
        if (COLOUR != 0) begin : g_colour
            for (genvar c = 0; c < 3; c++) begin : g_channel
                logic [W_COLOUR-1:0] now, add;
                logic [W_COLOUR:0]   sum;
                logic                fall;
                // A falling colour adds the complement and one: the lowest bit carries it in.
                assign sum = {now, 1'b1} + {add, fall};
                always_ff @(posedge clk) begin
                    if (load) begin
                        now  <= s_now[c*W_COLOUR+:W_COLOUR];
                        add  <= s_step[c*W_COLOUR+:W_COLOUR];
                        fall <= s_fall[c];
                    end else if (step) begin
                        now  <= sum[W_COLOUR:1];
                    end
                end
                assign m_rgb[8*c+:8] = now[W_COLOUR-1-:8];
                logic unused_sum;
                assign unused_sum = sum[0];
            end
        end else begin : g_plain
            logic unused_colour;
            assign unused_colour = &{1'b0, s_now, s_step, s_fall};
            assign m_rgb = '0;
        end
    endgenerate
endmodule

`default_nettype wire
