// The way to the screen without a framebuffer (system C): for each column the row, or for each row the column, that a line
// occupies. A pixel is lit where one of the memories names it.
//
//   flat line:   memory[x] = y       steep line:  memory[y] = x       empty = all ones, which no pixel is
//
//        x   0 1 2 3 4 5
//       y 0  #                       memory[0..5] = 0 1 1 2 2 3
//         1    # #
//         2        # #
//         3            #
//
// System C gave each of its 12 lines a memory of its own. Here a pixel goes into the first memory whose word at that
// index is empty, flat ones counted from memory 0 up, steep ones from the last down. So MEMORIES lines always fit, and
// any number does as long as no column crosses more flat lines than there are flat memories, and no row more steep
// ones: `needed flat + needed steep <= MEMORIES`. Pixels that find no place, or come when the beam is already in the picture,
// are counted in `dropped`; software reads it as "this picture is not complete".
//
// A word also holds the line's group. Where lines of different groups cross, the higher group is seen: groups are numbered in the
// order of drawing, and the picture is the painter's. A group has one colour: no interpolation along the line.
//
// Clocks: when a blank begins and `draw_want` says that there is a new picture, all memories are cleared at once (2^W_INDEX clocks),
// then draw_enable rises; without it the old picture stays; a pixel a clock, two
// clocks more where two lines in a row meet in one index. Everything must be drawn in the blank, 45 lines of 800 clocks at
// 640x480. `scan_hit` and `scan_group` are three clocks behind `scan_x` and `scan_y`.
`default_nettype none

module line_memories #(
    parameter int MEMORIES = 12,
    parameter int W_X      = 10,
    parameter int W_Y      = 9,
    parameter int W_GROUP  = 2
) (
    input  wire logic               clk,
    input  wire logic               rst_n,
    input  wire logic               draw_want,
    output logic                    draw_enable,
    input  wire logic               draw_done,
    input  wire logic               s_valid,
    output logic                    s_ready,
    input  wire logic [    W_X-1:0] s_x,
    input  wire logic [    W_Y-1:0] s_y,
    input  wire logic               s_steep,
    input  wire logic [W_GROUP-1:0] s_group,
    input  wire logic               scan_blank,
    input  wire logic [    W_X-1:0] scan_x,
    input  wire logic [    W_Y-1:0] scan_y,
    output logic                    scan_hit,
    output logic      [W_GROUP-1:0] scan_group,
    output logic      [       15:0] dropped
);
    localparam int W_INDEX = W_X > W_Y ? W_X : W_Y;
    localparam int W_WORD = W_GROUP + W_INDEX;
    localparam logic [W_INDEX-1:0] EMPTY = '1;

    // What a pixel is stored as.
    logic [ W_INDEX-1:0] s_index;
    logic [ W_INDEX-1:0] s_minor;
    assign s_index = s_steep ? W_INDEX'(s_y) : W_INDEX'(s_x);
    assign s_minor = s_steep ? W_INDEX'(s_x) : W_INDEX'(s_y);

    // Fill stage 1: the words at the index have been read. Stage 2: the memory is chosen and written.
    logic                fill;
    logic                fill_steep;
    logic [ W_INDEX-1:0] fill_index;
    logic [  W_WORD-1:0] fill_word;
    logic [MEMORIES-1:0] write;
    logic [ W_INDEX-1:0] write_index;
    logic [  W_WORD-1:0] write_word;

    logic [MEMORIES-1:0] used;  // this memory holds lines,
    logic [MEMORIES-1:0] steep;  // and of this kind
    logic [MEMORIES-1:0] empty;
    logic [MEMORIES-1:0] chosen;
    logic [MEMORIES-1:0][W_WORD-1:0] read_word;

    logic                was_blank;
    logic                clearing;
    logic                started;  // the power-up content has been cleared
    logic                meets;

    // The word that is about to be written cannot be read.
    assign meets   = (fill && fill_index == s_index) || (write != '0 && write_index == s_index);
    assign s_ready = draw_enable && (!scan_blank || !meets);

    always_comb begin
        chosen = '0;
        for (int m = 0; m < MEMORIES; m++) begin
            empty[m] = read_word[m][W_INDEX-1:0] == EMPTY && (!used[m] || steep[m] == fill_steep);
        end
        if (fill_steep) begin
            for (int m = 0; m < MEMORIES; m++) if (empty[m]) chosen = MEMORIES'(1) << m;
        end else begin
            for (int m = MEMORIES - 1; m >= 0; m--) if (empty[m]) chosen = MEMORIES'(1) << m;
        end
        if (!fill) chosen = '0;
    end

    always_ff @(posedge clk) begin
        was_blank   <= scan_blank;
        fill        <= s_valid && s_ready && scan_blank;
        fill_steep  <= s_steep;
        fill_index  <= s_index;
        fill_word   <= {s_group, s_minor};
        write       <= chosen;
        write_index <= fill_index;
        write_word  <= fill_word;
        used        <= used | chosen;
        for (int m = 0; m < MEMORIES; m++) if (chosen[m]) steep[m] <= fill_steep;
        if ((fill && chosen == '0) || (s_valid && s_ready && !scan_blank)) begin
            if (dropped != '1) dropped <= dropped + 1'b1;
        end
        if (clearing) begin
            write       <= '1;
            write_index <= write_index + 1'b1;
            write_word  <= '1;
            if (write_index == '1 && write != '0) begin
                write       <= '0;
                clearing    <= 1'b0;
                draw_enable <= 1'b1;
            end
        end
        if (draw_done) draw_enable <= 1'b0;
        if (scan_blank && !was_blank && !draw_enable && draw_want) begin
            clearing    <= 1'b1;
            started     <= 1'b1;
            write       <= '0;
            write_index <= '1;
            used        <= '0;
            dropped     <= '0;
        end
        if (!rst_n) begin
            // Reset may end too late in a blank, so the first one that begins is waited for.
            was_blank   <= 1'b1;
            clearing    <= 1'b0;
            started     <= 1'b0;
            write       <= '0;
            fill        <= 1'b0;
            draw_enable <= 1'b0;
            dropped     <= '0;
        end
    end

    // Scan stage 0: the memories are read. 1: compared. 2: the highest group.
    logic [    W_X-1:0]              x1;
    logic [    W_Y-1:0]              y1;
    logic [MEMORIES-1:0]             hit;
    logic [MEMORIES-1:0][W_GROUP-1:0] group;
    logic [W_GROUP-1:0]              highest;

    generate
        for (genvar m = 0; m < MEMORIES; m++) begin : g_memory
            logic [W_INDEX-1:0] scan_index;
            assign scan_index = steep[m] ? W_INDEX'(scan_y) : W_INDEX'(scan_x);
            line_memory #(
                .W_INDEX(W_INDEX),
                .W_WORD (W_WORD)
            ) i_memory (
                .clk        (clk),
                .write      (write[m]),
                .write_index(write_index),
                .write_word (write_word),
                .read_index (scan_blank ? s_index : scan_index),
                .read_word  (read_word[m])
            );
            always_ff @(posedge clk) begin
                hit[m]   <= read_word[m][W_INDEX-1:0] == (steep[m] ? W_INDEX'(x1) : W_INDEX'(y1));
                group[m] <= read_word[m][W_WORD-1:W_INDEX];
            end
        end
    endgenerate

    always_comb begin
        highest = '0;
        for (int g = 0; g < 1 << W_GROUP; g++) begin
            for (int m = 0; m < MEMORIES; m++) if (hit[m] && group[m] == W_GROUP'(g)) highest = W_GROUP'(g);
        end
    end

    always_ff @(posedge clk) begin
        x1         <= scan_x;
        y1         <= scan_y;
        scan_hit   <= started && hit != '0;
        scan_group <= highest;
    end
endmodule

`default_nettype wire
