// framebuffer: a picture is drawn only into a clear plane that is not shown, and no pixel of the shown picture is read after it was
// cleared. Pictures of 3 rows of 4 pixels, any drawing, any beam that goes down the rows; one clock on both sides.
//
// One address of the planes, any, is watched: what holds for it holds for all.
`default_nettype none

module framebuffer_properties (
    input wire logic       clk,
    input wire logic       draw_done,
    input wire logic       s_valid,
    input wire logic [1:0] s_x,
    input wire logic [1:0] s_y,
    input wire logic       scan_read,
    input wire logic       scan_blank,
    input wire logic [1:0] scan_x,
    input wire logic [1:0] scan_y
);
    logic rst_n, draw_enable, s_ready, scan_pixel, scan_swapped;
    framebuffer #(
        .COLUMNS    (2),
        .STRIDE_BITS(1),
        .HEIGHT     (3)
    ) fb (
        .draw_clk    (clk),
        .draw_rst_n  (rst_n),
        .draw_enable (draw_enable),
        .draw_done   (draw_done),
        .s_valid     (s_valid),
        .s_ready     (s_ready),
        .s_x         (s_x),
        .s_y         (s_y),
        .s_pixel     (1'b1),
        .s_mask      (1'b1),
        .scan_clk    (clk),
        .scan_rst_n  (rst_n),
        .scan_read   (scan_read),
        .scan_blank  (scan_blank),
        .scan_x      (scan_x),
        .scan_y      (scan_y),
        .scan_pixel  (scan_pixel),
        .scan_swapped(scan_swapped)
    );
    // Registers and wires inside, by their names after flattening.
    (* hierconn *) wire logic       \fb.front ;
    (* hierconn *) wire logic       \fb.shown ;
    (* hierconn *) wire logic       \fb.granted ;
    (* hierconn *) wire logic       \fb.drawn ;
    (* hierconn *) wire logic       \fb.i_granted.first ;
    (* hierconn *) wire logic       \fb.granted_here ;
    (* hierconn *) wire logic       \fb.i_drawn.first ;
    (* hierconn *) wire logic       \fb.drawn_here ;
    (* hierconn *) wire logic       \fb.finished ;
    (* hierconn *) wire logic       \fb.swapped ;
    (* hierconn *) wire logic       \fb.cleared ;
    (* hierconn *) wire logic       \fb.scanned ;
    (* hierconn *) wire logic       \fb.started ;
    (* hierconn *) wire logic       \fb.begun ;
    (* hierconn *) wire logic       \fb.target ;
    (* hierconn *) wire logic [2:0] \fb.clear_address ;
    (* hierconn *) wire logic [1:0] \fb.write ;
    (* hierconn *) wire logic [2:0] \fb.write_address ;
    (* hierconn *) wire logic [1:0] \fb.plane_clear ;
    (* hierconn *) wire logic [5:0] \fb.plane_address ;

    (* anyconst *) logic [2:0] watched;
    logic       front, back, enabled_before, front_before, read_before, blank_before;
    logic [1:0] x_before;
    logic [1:0] y_before;
    logic [1:0] clean = '0;  // the watched address has been cleared, and not written since
    logic       hole = 1'b0;  // it has been cleared in the picture that is shown
    logic       touched = 1'b0;  // something was drawn since a picture was handed over
    logic [1:0] clears;
    logic       began = 1'b0;
    logic       ran = 1'b0;
    assign rst_n  = began;
    assign front  = \fb.front ;
    assign back   = !front;
    assign clears = \fb.plane_clear & {\fb.plane_address [5:3] == watched, \fb.plane_address [2:0] == watched};

    // The handshake on its way around: granted to drawn and back.
    logic [5:0] way;
    assign way = {\fb.granted , \fb.i_granted.first , \fb.granted_here , \fb.drawn , \fb.i_drawn.first , \fb.drawn_here };

    always_ff @(posedge clk) begin
        began          <= 1'b1;
        ran            <= began;
        enabled_before <= draw_enable;
        front_before   <= front;
        read_before    <= scan_read;
        blank_before   <= scan_blank;
        x_before       <= scan_x;
        y_before       <= scan_y;
        for (int i = 0; i < 2; i++) begin
            if (clears[i]) clean[i] <= 1'b1;
            if (\fb.write [i] && \fb.write_address == watched) clean[i] <= 1'b0;
        end
        if (clears[front]) hole <= 1'b1;
        if (\fb.finished && !\fb.swapped && ((scan_blank && \fb.scanned ) || !\fb.started )) hole <= 1'b0;
        if (s_valid && s_ready) touched <= 1'b1;
        if (\fb.finished && \fb.swapped && \fb.cleared ) touched <= 1'b0;

        assume (watched < 3'd6);
        // The beam: nothing is read in the blank or next to it; outside of it rows come in order.
        if (scan_read) assume (!scan_blank && scan_y < 2'd3);
        if (!began) assume (scan_blank);
        if (ran && read_before) assume (!scan_blank);
        if (ran && !blank_before && !scan_blank) assume (scan_y >= y_before);

        if (ran) begin
            // Nobody draws into what is shown, or into what is being cleared.
            assert (!\fb.write [front]);
            assert ((\fb.write & \fb.plane_clear ) == '0);
            // Pictures are exchanged in the blank, while nothing is drawn.
            if (front != front_before) assert (!draw_enable && !enabled_before && (blank_before || !\fb.shown ));
            // What is handed over is clear.
            if (draw_enable && !touched) assert (clean[back]);
            // A clock of clearing is no clock of reading, and nothing is read after it was cleared.
            if (read_before) assert (!\fb.plane_clear [front]);
            if (read_before && \fb.shown && {y_before, x_before[0]} == watched) assert (!hole);

            // What the induction needs to know: one change at a time goes around;
            assert (((way[5:1] ^ way[4:0]) & ((way[5:1] ^ way[4:0]) - 5'd1)) == '0);
            // clearing counts from 0 to the last address, first in what was shown, then behind;
            assert (\fb.cleared ? \fb.clear_address == 3'd6 : \fb.clear_address < 3'd6);
            if (!\fb.finished ) assert (!\fb.swapped && !\fb.cleared && \fb.clear_address == '0);
            if (\fb.finished && watched < \fb.clear_address ) assert (clean[\fb.target ] || clears[\fb.target ]);
            // it stays behind the beam until the pictures are exchanged;
            if (hole || clears[front]) begin
                assert (\fb.finished && !\fb.swapped && \fb.scanned && \fb.begun );
                assert (watched[2:1] < y_before);
            end
            // and what was cleared stays clear until it is drawn.
            if (!\fb.finished && !touched) assert (clean[back]);
        end
    end
endmodule

// What the cells hold does not matter.
module plane_memory #(
    parameter int SPRAM       = 0,
    parameter int W_PIXEL     = 1,
    parameter int COLUMNS     = 20,
    parameter int STRIDE_BITS = 5,
    parameter int HEIGHT      = 480,
    parameter int W_COLUMN    = $clog2(COLUMNS),
    parameter int W_ADDRESS   = $clog2(HEIGHT) + STRIDE_BITS
) (
    input  wire logic                 draw_clk,
    input  wire logic                 draw_write,
    input  wire logic [ W_COLUMN-1:0] draw_column,
    input  wire logic [W_ADDRESS-1:0] draw_address,
    input  wire logic [  W_PIXEL-1:0] draw_pixel,
    input  wire logic [  W_PIXEL-1:0] draw_mask,
    input  wire logic                 scan_clk,
    input  wire logic                 scan_clear,
    input  wire logic [ W_COLUMN-1:0] scan_column,
    input  wire logic [W_ADDRESS-1:0] scan_address,
    output logic      [  W_PIXEL-1:0] scan_pixel
);
    (* anyseq *) logic [W_PIXEL-1:0] any;
    assign scan_pixel = any;
    logic unused;
    assign unused = ^{draw_clk, draw_write, draw_column, draw_address, draw_pixel, draw_mask, scan_clk, scan_clear, scan_column,
                      scan_address};
endmodule

`default_nettype wire
