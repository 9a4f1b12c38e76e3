// The line half of the pipeline: a model's vertices and edges become pixels.
//
//   vertex pass   vertex memory -> transform -> project -> projected memory (flags, row, column)
//   edge pass     edge memory -> projected memory, twice -> line_clipped -> pixels
//                 where an end is flagged: vertex memory, twice -> transform -> clip -> project, twice -> line_clipped
//
//   | vertex memory    | z, y, x: Q1.15 each: `vertices.hex` of `scanout bake`                                          |
//   | edge memory      | b, a: vertex numbers, 14 bits each in 16; bits 31:30 are the edge's group: `edges.hex`         |
//   | matrix           | 16 words into the transform's hidden bank; they take effect with `start`                       |
//   | width, height    | of the picture, at most 2^W_SCREEN each; `vertices` and `edges` are counts                     |
//   | m_               | pixels on the picture: column, row; whether the line is steep, and its group (TAGGED 1)        |
//
// `start` begins a picture, `done` is one clock long after its last pixel was taken. Model and counts must not change in between.
// CLIP 0 leaves the clip stages away, for a model that is always in view: an edge with an end off the screen is not drawn, and `lost`
// is high for a clock.
// With TAGGED an edge begins when the last one's pixels are out, because the tags belong to whole lines.
//
// Clocks: a vertex costs what the slower of transform and project does (about 80), an edge 8 or its pixels, and clip's where it leaves
// the screen or the view volume.
`default_nettype none

module wireframe #(
    parameter int W_SCREEN    = 10,
    parameter int VERTICES    = 1024,
    parameter int EDGES       = 2048,
    parameter int MULTIPLIERS = 3,
    parameter int TAGGED      = 0,
    parameter int CLIP        = 1,
    parameter     VERTEX_HEX  = "",
    parameter     EDGE_HEX    = "",
    parameter int W_VERTEX    = $clog2(VERTICES),
    parameter int W_EDGE      = $clog2(EDGES)
) (
    input  wire logic                clk,
    input  wire logic                rst_n,
    input  wire logic [  W_SCREEN:0] width,
    input  wire logic [  W_SCREEN:0] height,
    input  wire logic [  W_VERTEX:0] vertices,
    input  wire logic [    W_EDGE:0] edges,
    input  wire logic                vertex_write,
    input  wire logic [W_VERTEX-1:0] vertex_address,
    input  wire logic [        47:0] vertex_word,
    input  wire logic                edge_write,
    input  wire logic [  W_EDGE-1:0] edge_address,
    input  wire logic [        31:0] edge_word,
    input  wire logic                matrix_write,
    input  wire logic [         3:0] matrix_address,
    input  wire logic [        31:0] matrix_word,
    input  wire logic                start,
    output logic                     busy,
    output logic                     done,
    output logic                     lost,
    output logic                     m_valid,
    input  wire logic                m_ready,
    output logic      [W_SCREEN-1:0] m_x,
    output logic      [W_SCREEN-1:0] m_y,
    output logic                     m_steep,
    output logic      [         1:0] m_group
);
    // A column or row of the guard band.
    localparam int W = CLIP != 0 ? W_SCREEN + 13 : W_SCREEN + 2;
    localparam int W_PROJECTED = 2 * W + 3;
    // What goes through the transform: a vertex of the first pass, or an end of an edge that must be clipped.
    localparam int W_TAG = W_VERTEX;

    typedef enum logic [3:0] {
        IDLE, VERTEX_READ, VERTEX_SEND, VERTEX_WAIT, EDGE_READ, EDGE_SEEN, END_A, END_B, TAKE_A, TAKE_B, DECIDE,
        CLIP_READ, CLIP_SEND, CLIP_WAIT, LINE, DRAIN
    } state_t;
    state_t state;

    // -------------------------------------------------------------------------------------------------------------- memories
    logic [W_VERTEX-1:0]    vertex;  // read address of the vertex memory
    logic [        47:0]    position;
    logic [  W_VERTEX:0]    sent;
    logic [  W_VERTEX:0]    stored;
    logic [    W_EDGE:0]    edge_number;
    logic [        31:0]    edge_read;
    logic [W_VERTEX-1:0]    end_a;
    logic [W_VERTEX-1:0]    end_b;
    logic                   project_valid;
    logic signed [31:0]     project_x;
    logic signed [31:0]     project_y;
    logic [         2:0]    project_flags;
    logic [   W_TAG-1:0]    project_tag;
    logic [W_VERTEX-1:0]    projected_address;
    logic [W_PROJECTED-1:0] projected;
    logic                   clipping;  // the transform's results are the ends of an edge

    // Without the clip stages a vertex must be on the screen.
    logic [         2:0]    vertex_flags;
    assign vertex_flags = CLIP != 0 ? project_flags : 3'(
        project_flags != '0 || project_x[31:4] >= 28'(width) || project_y[31:4] >= 28'(height));

    model_memory #(
        .W_WORD(48),
        .WORDS (VERTICES),
        .HEX   (VERTEX_HEX)
    ) i_vertices (
        .clk          (clk),
        .write        (vertex_write),
        .write_address(vertex_address),
        .write_word   (vertex_word),
        .read_address (vertex),
        .read_word    (position)
    );
    model_memory #(
        .W_WORD(32),
        .WORDS (EDGES),
        .HEX   (EDGE_HEX)
    ) i_edges (
        .clk          (clk),
        .write        (edge_write),
        .write_address(edge_address),
        .write_word   (edge_word),
        .read_address (edge_number[W_EDGE-1:0]),
        .read_word    (edge_read)
    );
    model_memory #(
        .W_WORD(W_PROJECTED),
        .WORDS (VERTICES)
    ) i_projected (
        .clk          (clk),
        .write        (project_valid && !clipping),
        .write_address(project_tag),
        .write_word   ({vertex_flags, project_y[4+:W], project_x[4+:W]}),
        .read_address (projected_address),
        .read_word    (projected)
    );

    // --------------------------------------------------------------------------------------------------- transform and project
    logic               transform_valid;
    logic               transform_ready;
    logic               clip_valid;  // clip coordinates from the transform
    logic               clip_ready;
    logic signed [31:0] clip_data;
    logic [W_TAG-1:0]   clip_tag;
    logic               scale_ready;
    // What is left of an edge: clip coordinates from the clip stage.
    logic               clip_stage_ready;
    logic               clip_stage_idle;
    logic               clipped_valid;
    logic signed [31:0] clipped_data;

    transform #(
        .MULTIPLIERS(MULTIPLIERS),
        .W_TAG      (W_TAG)
    ) i_transform (
        .clk          (clk),
        .rst_n        (rst_n),
        .write        (matrix_write),
        .write_address(matrix_address),
        .write_data   (matrix_word),
        .swap         (state == IDLE && start),
        .s_valid      (transform_valid),
        .s_ready      (transform_ready),
        .s_position   (position),
        .s_tag        (vertex),
        .m_valid      (clip_valid),
        .m_ready      (clip_ready),
        .m_data       (clip_data),
        .m_tag        (clip_tag)
    );
    assign transform_valid = state == VERTEX_SEND || state == CLIP_SEND;
    assign clip_ready      = clipping ? clip_stage_ready : scale_ready;

    logic [31:0] unused_z;
    logic [31:0] unused_inverse;
    logic [ 4:0] unused_exponent;
    project #(
        .DEPTH(0),
        .W_TAG(W_TAG)
    ) i_project (
        .clk       (clk),
        .rst_n     (rst_n),
        .width     (12'(width)),
        .height    (12'(height)),
        .s_valid   (clipping ? clipped_valid : clip_valid),
        .s_ready   (scale_ready),
        .s_data    (clipping ? clipped_data : clip_data),
        .s_tag     (clip_tag),
        .m_valid   (project_valid),
        .m_ready   (1'b1),
        .m_x       (project_x),
        .m_y       (project_y),
        .m_z       (unused_z),
        .m_flags   (project_flags),
        .m_inverse (unused_inverse),
        .m_exponent(unused_exponent),
        .m_tag     (project_tag)
    );

    // ------------------------------------------------------------------------------------------------------------ line stages
    // The ends of an edge come one after the other, from the projected memory or projected again: a, then b.
    logic signed [W-1:0] a_x, a_y, b_x, b_y;
    logic [         2:0] flags_a;
    logic [         2:0] flags_b;
    logic [         3:0] sides_a;  // of the screen that an end lies beyond
    logic [         3:0] sides_b;
    logic                take_end;
    logic                on_screen;
    logic                second;     // end b goes to be clipped
    logic                started;    // the clip stage has words of this edge
    logic                left_over;  // and it had words to give
    logic                landed;     // end a is projected again
    logic                clipped;    // both are
    logic                line_ready;
    logic                line_busy;
    logic                line_steep;
    logic                unused_last;
    logic [         1:0] group;

    assign take_end = state == TAKE_A || state == TAKE_B || (clipping && project_valid);
    always_ff @(posedge clk) begin
        if (take_end) begin
            {flags_a, sides_a, a_y, a_x} <= {flags_b, sides_b, b_y, b_x};
            {flags_b, b_y, b_x} <= clipping ? {project_flags, project_y[4+:W], project_x[4+:W]} : projected;
        end
    end

    logic line_valid;
    assign line_valid = state == LINE;
    generate
        if (CLIP != 0) begin : g_line_clipped
            assign sides_b[0] = b_x < 0;
            assign sides_b[1] = b_x >= $signed({{(W - W_SCREEN - 1) {1'b0}}, width});
            assign sides_b[2] = b_y < 0;
            assign sides_b[3] = b_y >= $signed({{(W - W_SCREEN - 1) {1'b0}}, height});
            line_clipped #(
                .W_SCREEN(W_SCREEN)
            ) i_line (
                .clk           (clk),
                .rst_n         (rst_n),
                .width         (width),
                .height        (height),
                .s_volume_valid(clip_valid && clipping),
                .s_volume_ready(clip_stage_ready),
                .s_volume_data (clip_data),
                .m_volume_valid(clipped_valid),
                .m_volume_ready(scale_ready),
                .m_volume_data (clipped_data),
                .idle          (clip_stage_idle),
                .s_valid       (line_valid),
                .s_ready       (line_ready),
                .s_on_screen   (on_screen),
                .s_a_x         (a_x),
                .s_a_y         (a_y),
                .s_b_x         (b_x),
                .s_b_y         (b_y),
                .m_valid       (m_valid),
                .m_ready       (m_ready),
                .m_x           (m_x),
                .m_y           (m_y),
                .m_steep       (line_steep),
                .m_last        (unused_last),
                .busy          (line_busy)
            );
        end else begin : g_line
            assign clip_stage_ready = 1'b1;
            assign clip_stage_idle  = 1'b1;
            assign clipped_valid    = 1'b0;
            assign clipped_data     = '0;
            assign sides_b          = '0;
            // Both ends are on the screen; two more bits keep line's sums from overflowing.
            logic [W-1:0] x, y;
            logic [      23:0] unused_rgb;
            logic [       2:0] lines;  // in here: at most four in the set-up and one that is walked
            logic              unused_top;
            line #(
                .W(W)
            ) i_line (
                .clk    (clk),
                .rst_n  (rst_n),
                .s_valid(line_valid),
                .s_ready(line_ready),
                .s_a_x  (a_x),
                .s_a_y  (a_y),
                .s_b_x  (b_x),
                .s_b_y  (b_y),
                .s_a_z  (1'b0),
                .s_b_z  (1'b0),
                .s_a_rgb(24'd0),
                .s_b_rgb(24'd0),
                .m_valid(m_valid),
                .m_ready(m_ready),
                .m_x    (x),
                .m_y    (y),
                .m_steep(line_steep),
                .m_rgb  (unused_rgb),
                .m_last (unused_last)
            );
            assign m_x        = x[W_SCREEN-1:0];
            assign m_y        = y[W_SCREEN-1:0];
            assign line_busy  = lines != '0;
            assign unused_top = ^{x, y, unused_rgb, on_screen};
            always_ff @(posedge clk) begin
                lines <= lines + 3'(line_valid && line_ready) - 3'(m_valid && m_ready && unused_last);
                if (!rst_n) lines <= '0;
            end
        end
    endgenerate

    generate
        if (TAGGED != 0) begin : g_tagged
            assign m_steep = line_steep;
            always_ff @(posedge clk) if (state == LINE) m_group <= group;
        end else begin : g_plain
            logic unused_group;
            assign m_steep      = 1'b0;
            assign m_group      = 2'd0;
            assign unused_group = ^{group, line_steep};
        end
    endgenerate

    // ------------------------------------------------------------------------------------------------------------ the sequence
    assign busy = state != IDLE;

    always_ff @(posedge clk) begin
        done <= 1'b0;
        lost <= 1'b0;
        if (project_valid && !clipping) stored <= stored + 1'b1;
        if (!clip_stage_idle) started <= 1'b1;
        if (clipped_valid) left_over <= 1'b1;
        case (state)
            IDLE: begin
                vertex      <= '0;
                sent        <= '0;
                stored      <= '0;
                edge_number <= '0;
                clipping    <= 1'b0;
                if (start) state <= vertices == '0 ? DRAIN : VERTEX_READ;
            end
            VERTEX_READ: state <= VERTEX_SEND;
            VERTEX_SEND: begin
                if (transform_ready) begin
                    vertex <= vertex + 1'b1;
                    sent   <= sent + 1'b1;
                    state  <= sent + 1'b1 == vertices ? VERTEX_WAIT : VERTEX_READ;
                end
            end
            VERTEX_WAIT: if (stored == vertices) state <= EDGE_READ;
            EDGE_READ: state <= edge_number == edges ? DRAIN : EDGE_SEEN;
            EDGE_SEEN: begin
                end_a       <= edge_read[W_VERTEX-1:0];
                end_b       <= edge_read[16+:W_VERTEX];
                group       <= edge_read[31:30];
                edge_number <= edge_number + 1'b1;
                state       <= END_A;
            end
            END_A: begin
                projected_address <= end_a;
                state             <= END_B;
            end
            END_B: begin
                projected_address <= end_b;
                state             <= TAKE_A;
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
                if (transform_ready) begin
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
                end else if (started && clip_stage_idle && !left_over) begin
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

    logic unused_bits;
    assign unused_bits = ^{project_x, project_y, edge_read, unused_z, unused_inverse, unused_exponent};
endmodule

`default_nettype wire
