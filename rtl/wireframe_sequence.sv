// The order in which a wireframe is drawn: every vertex, then every edge.
//
//   vertices   s_vertex -> wireframe_vertices -> projected memory, until as many are stored as were sent
//   edges      edge word -> its ends from the projected memory -> drawn, or dropped, or
//              where an end is flagged: both ends through clip and projected again, then drawn or dropped
//
//   both ends before the near plane, or both beyond the far plane              dropped
//   an end flagged, not clipped yet                                            clipped
//   an end flagged although clipped: rounding left it just outside             dropped, as in the library
//   both ends beyond the same side of the screen                               dropped
//   else                                                                       drawn
//
//   | edge_word          | of the number `edge_number`, a clock later: b, a in the low 14 bits of each half, bits 31:30 the group |
//   | projected_vertex   | whose end comes from the projected memory a clock later; `take` is high while an end is there        |
//   | vertex, vertex_    | a vertex to be projected, its number there a clock before `vertex_valid`                             |
//   | clipping           | what is projected are an edge's ends, through the clip stage, and not vertices to be stored          |
//   | volume_idle        | the clip stage holds nothing; `volume_given`: a word of what is left of an edge leaves it            |
//   | flags, sides       | of the ends a and b that were taken, see wireframe_lines                                             |
//   | lost               | for a clock, with CLIP 0: an edge was dropped because an end is flagged                              |
//
// Clocks beside those of what it waits for: a vertex 2, an edge 8, or 7 where it is dropped.
`default_nettype none

module wireframe_sequence #(
    parameter int TAGGED   = 0,
    parameter int CLIP     = 1,
    parameter int W_VERTEX = 10,
    parameter int W_EDGE   = 11
) (
    input  wire logic                clk,
    input  wire logic                rst_n,
    input  wire logic [  W_VERTEX:0] vertices,
    input  wire logic [    W_EDGE:0] edges,
    input  wire logic                start,
    output logic                     swap,
    output logic                     busy,
    output logic                     done,
    output logic                     lost,
    // Vertices to be projected, and when one is.
    output logic      [W_VERTEX-1:0] vertex,
    output logic                     vertex_valid,
    input  wire logic                vertex_ready,
    input  wire logic                project_valid,
    output logic                     clipping,
    input  wire logic                volume_idle,
    input  wire logic                volume_given,
    // Edges and their ends.
    output logic      [  W_EDGE-1:0] edge_number,
    input  wire logic [        31:0] edge_word,
    output logic      [W_VERTEX-1:0] projected_vertex,
    output logic                     take,
    input  wire logic [         2:0] flags_a,
    input  wire logic [         2:0] flags_b,
    input  wire logic [         3:0] sides_a,
    input  wire logic [         3:0] sides_b,
    // An edge to be drawn.
    output logic                     line_valid,
    input  wire logic                line_ready,
    input  wire logic                line_busy,
    output logic                     on_screen,
    output logic      [         1:0] group
);
    typedef enum logic [3:0] {
        IDLE, VERTEX_READ, VERTEX_SEND, VERTEX_WAIT, EDGE_READ, EDGE_SEEN, END_A, END_B, TAKE_A, TAKE_B, DECIDE,
        CLIP_READ, CLIP_SEND, CLIP_WAIT, LINE, DRAIN
    } state_t;
    state_t state;

    logic [  W_VERTEX:0] sent;
    logic [  W_VERTEX:0] stored;
    logic [    W_EDGE:0] next_edge;
    logic [W_VERTEX-1:0] end_a;
    logic [W_VERTEX-1:0] end_b;
    logic                second;     // end b goes to be clipped
    logic                started;    // the clip stage has words of this edge
    logic                left_over;  // and it had words to give
    logic                landed;     // end a is projected again
    logic                clipped;    // both are

    assign swap         = state == IDLE && start;
    assign busy         = state != IDLE;
    assign vertex_valid = state == VERTEX_SEND || state == CLIP_SEND;
    assign take         = state == TAKE_A || state == TAKE_B || (clipping && project_valid);
    assign line_valid   = state == LINE;
    assign edge_number  = next_edge[W_EDGE-1:0];

    always_ff @(posedge clk) begin
        done <= 1'b0;
        lost <= 1'b0;
        if (project_valid && !clipping) stored <= stored + 1'b1;
        if (!volume_idle) started <= 1'b1;
        if (volume_given) left_over <= 1'b1;
        case (state)
            IDLE: begin
                vertex      <= '0;
                sent        <= '0;
                stored      <= '0;
                next_edge   <= '0;
                clipping    <= 1'b0;
                if (start) state <= vertices == '0 ? DRAIN : VERTEX_READ;
            end
            VERTEX_READ: state <= VERTEX_SEND;
            VERTEX_SEND: begin
                if (vertex_ready) begin
                    vertex <= vertex + 1'b1;
                    sent   <= sent + 1'b1;
                    state  <= sent + 1'b1 == vertices ? VERTEX_WAIT : VERTEX_READ;
                end
            end
            VERTEX_WAIT: if (stored == vertices) state <= EDGE_READ;
            EDGE_READ: state <= next_edge == edges ? DRAIN : EDGE_SEEN;
            EDGE_SEEN: begin
                end_a       <= edge_word[W_VERTEX-1:0];
                end_b       <= edge_word[16+:W_VERTEX];
                group       <= edge_word[31:30];
                next_edge   <= next_edge + 1'b1;
                state       <= END_A;
            end
            END_A: begin
                projected_vertex <= end_a;
                state            <= END_B;
            end
            END_B: begin
                projected_vertex <= end_b;
                state            <= TAKE_A;
            end
            TAKE_A: state <= TAKE_B;
            TAKE_B: begin
                clipped <= 1'b0;
                state   <= DECIDE;
            end
            DECIDE: begin
                vertex    <= end_a;
                second    <= 1'b0;
                landed    <= 1'b0;
                started   <= 1'b0;
                left_over <= 1'b0;
                on_screen <= (sides_a | sides_b) == '0;
                // Both ends before the near plane, or both beyond the far plane, or both beyond one side: nothing is seen.
                if (CLIP == 0 && (flags_a | flags_b) != '0) begin
                    lost  <= 1'b1;
                    state <= EDGE_READ;
                end else if ((flags_a[1:0] & flags_b[1:0]) != '0) begin
                    state <= EDGE_READ;
                end else if ((flags_a | flags_b) != '0) begin
                    // Rounding may leave a clipped end just outside: the library then draws nothing either.
                    clipping <= !clipped;
                    state    <= clipped ? EDGE_READ : CLIP_READ;
                end else if ((sides_a & sides_b) != '0) begin
                    state <= EDGE_READ;
                end else if (TAGGED == 0 || !line_busy) begin
                    state <= LINE;
                end
            end
            CLIP_READ: state <= CLIP_SEND;
            CLIP_SEND: begin
                if (vertex_ready) begin
                    vertex <= end_b;
                    second <= 1'b1;
                    state  <= second ? CLIP_WAIT : CLIP_READ;
                end
            end
            CLIP_WAIT: begin
                if (project_valid) begin
                    landed   <= 1'b1;
                    clipped  <= landed;
                    clipping <= !landed;
                    if (landed) state <= DECIDE;
                end else if (started && volume_idle && !left_over) begin
                    clipping <= 1'b0;
                    state    <= EDGE_READ;
                end
            end
            LINE: if (line_ready) state <= EDGE_READ;
            DRAIN: begin
                // A line that was just taken makes line_busy a clock later, and EDGE_READ lies between.
                if (!line_busy) begin
                    done  <= 1'b1;
                    state <= IDLE;
                end
            end
            default: state <= IDLE;
        endcase
        if (!rst_n) begin
            state <= IDLE;
            done  <= 1'b0;
        end
    end

    logic unused_word;
    assign unused_word = ^edge_word;
endmodule

`default_nettype wire
