// Scan-out: counts pixels and lines, and makes the sync pulses.
//
//   x = 0 .. H_ACTIVE-1 | front porch | sync | back porch       one step a clock
//   y = 0 .. V_ACTIVE-1 | front porch | sync | back porch       one step a line
//
// The defaults are 640x480 at 60 Hz with a pixel clock of 25.175 MHz: 800 x 525 clocks, both syncs negative (system C,
// table 3.1). 800x600 at 60 Hz is 40 MHz, 40/128/88 and 1/4/23, both positive. Both porches of a
// frame are whole lines: the vertical sync changes where a line begins, at x = 0.
//
// All outputs are registers and belong to the same clock. `blank_start` is one clock long: the first clock of line V_ACTIVE, from
// which nothing is shown until line 0.
//
// What it will not do: change its mode while it runs; interlace.
`default_nettype none

module video_timing #(
    parameter int H_ACTIVE   = 640,
    parameter int H_FRONT    = 16,
    parameter int H_SYNC     = 96,
    parameter int H_BACK     = 48,
    parameter int V_ACTIVE   = 480,
    parameter int V_FRONT    = 10,
    parameter int V_SYNC     = 2,
    parameter int V_BACK     = 33,
    parameter int H_POSITIVE = 0,
    parameter int V_POSITIVE = 0,
    parameter int W_X        = 11,
    parameter int W_Y        = 10
) (
    input  wire logic           clk,
    input  wire logic           rst_n,
    output logic      [W_X-1:0] x,
    output logic      [W_Y-1:0] y,
    output logic                active,
    output logic                hsync,
    output logic                vsync,
    output logic                blank_start
);
    localparam int H_TOTAL = H_ACTIVE + H_FRONT + H_SYNC + H_BACK;
    localparam int V_TOTAL = V_ACTIVE + V_FRONT + V_SYNC + V_BACK;
    localparam logic [W_X-1:0] X_LAST = W_X'(H_TOTAL - 1);
    localparam logic [W_X-1:0] X_SHOWN = W_X'(H_ACTIVE - 1);
    localparam logic [W_X-1:0] X_SYNC = W_X'(H_ACTIVE + H_FRONT - 1);
    localparam logic [W_X-1:0] X_SYNC_END = W_X'(H_ACTIVE + H_FRONT + H_SYNC - 1);
    localparam logic [W_Y-1:0] Y_LAST = W_Y'(V_TOTAL - 1);
    localparam logic [W_Y-1:0] Y_SHOWN = W_Y'(V_ACTIVE - 1);
    localparam logic [W_Y-1:0] Y_SYNC = W_Y'(V_ACTIVE + V_FRONT - 1);
    localparam logic [W_Y-1:0] Y_SYNC_END = W_Y'(V_ACTIVE + V_FRONT + V_SYNC - 1);

    logic line_shown;

    always_ff @(posedge clk) begin
        if (!rst_n) begin
            // The last line before the picture, so that the first frame begins a line after reset.
            x           <= '0;
            y           <= Y_LAST;
            active      <= 1'b0;
            line_shown  <= 1'b0;
            hsync       <= (H_POSITIVE == 0);
            vsync       <= (V_POSITIVE == 0);
            blank_start <= 1'b0;
        end else begin
            x           <= x + 1'b1;
            blank_start <= 1'b0;
            if (x == X_SHOWN) active <= 1'b0;
            if (x == X_SYNC) hsync <= (H_POSITIVE != 0);
            if (x == X_SYNC_END) hsync <= (H_POSITIVE == 0);
            if (x == X_LAST) begin
                x      <= '0;
                y      <= y + 1'b1;
                active <= line_shown;
                if (y == Y_SYNC) vsync <= (V_POSITIVE != 0);
                if (y == Y_SYNC_END) vsync <= (V_POSITIVE == 0);
                if (y == Y_LAST) begin
                    y          <= '0;
                    active     <= 1'b1;
                    line_shown <= 1'b1;
                end
                if (y == Y_SHOWN) begin
                    active      <= 1'b0;
                    line_shown  <= 1'b0;
                    blank_start <= 1'b1;
                end
            end
        end
    end
endmodule

`default_nettype wire
