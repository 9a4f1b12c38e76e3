// Clip: a line against the near plane, the far plane and the guard band, as the library's `clip::line`.
//
//   distance from plane 0 ... 5:  min(z, w - 1),  w - z,  2^13 w + x,  2^13 w - x,  2^13 w + y,  2^13 w - y      inside: >= 0
//   v = v_in + (v_out - v_in) d_in / (d_in - d_out)        each coordinate, rounded to nearest, exact
//
// Planes come in this order, each seeing what the one before left; a line whose ends are both outside of one vanishes. Rounding may
// leave a new end's x or y beyond 2^13 w by a hair; it goes out as that.
//
//   | s_data, m_data | clip coordinates of one end, then of the other: w, x, y, z each; 32 bits with sign, below 2^30 + 4  |
//   | idle           | no line is in here                                                                                 |
//
// The eight words stay in a small memory; one adder finds the distances, and muldiv the new end. Few lines need it, so it is small
// and takes its time: 8 words in, 6 clocks a plane, about 300 a new end (4 x (W_B to 3 W_B) + 5), 16 for 8 words out.
`default_nettype none

module clip (
    input  wire logic               clk,
    input  wire logic               rst_n,
    input  wire logic               s_valid,
    output logic                    s_ready,
    input  wire logic signed [31:0] s_data,
    output logic                    m_valid,
    input  wire logic               m_ready,
    output logic signed [31:0]      m_data,
    output logic                    idle
);
    localparam int V = 46;
    localparam logic [1:0] AT_W = 2'd0;

    typedef enum logic [2:0] {LOAD, DISTANCE, JUDGE, FETCH, CROSS, ROUND, STORE, UNLOAD} state_t;
    state_t             state;
    logic [2:0]         count, plane;
    logic [1:0]         axis;
    logic               a_outside;
    logic [2:0]         read_address, write_address, unload;
    logic               write;
    logic signed [31:0] words[8];
    logic signed [31:0] word, write_data;
    assign s_ready = state == LOAD;
    assign m_valid = state == UNLOAD && count[0];
    // An end's w goes out first, then its x and y. From 2^18 on w bounds nothing.
    logic signed [31:0] last_w, bound;
    logic               on_axis, beyond;
    assign bound   = {1'b0, last_w[17:0], 13'b0};
    assign on_axis = (unload[1:0] == 2'd2 || unload[1:0] == 2'd3) && last_w[31:18] == '0;
    assign beyond  = word[31] ? word < -bound : word > bound;
    always_ff @(posedge clk) if (state == UNLOAD && count[0] && unload[1:0] == 2'd1) last_w <= word;
    always_comb begin
        m_data = word;
        if (on_axis && beyond) m_data = word[31] ? -bound : bound;
    end
    assign idle    = state == LOAD && count == '0;

    // What the next state needs is read one clock before.
    logic [1:0] other;
    assign other = plane[2:1] == 2'd0 ? 2'd3 : plane[2:1];
    always_comb begin
        case (state)
            DISTANCE: read_address = {count[1], count[0] ? other : AT_W};
            FETCH: read_address = {count[0] ^ a_outside, axis};
            default: read_address = unload;
        endcase
    end
    assign write         = (state == LOAD && s_valid) || state == STORE;
    assign write_address = state == LOAD ? count : {!a_outside, axis};
    always_ff @(posedge clk) begin
        if (write) words[write_address] <= write_data;
        if (state != UNLOAD || !count[0]) word <= words[read_address];
    end

    // Distances: w, or 2^13 w, or w - 1; then the other coordinate is added, taken away, or taken instead where it is less.
    logic signed [V-1:0] distance, distance_a, first, second, sum;
    logic                guard, minus;
    assign guard = plane[2:1] != 2'd0;
    assign minus = plane[0] || plane == 3'd0;
    assign first = count[0] ? {V{plane == 3'd0}} : distance;
    always_comb begin
        if (count[0]) second = guard ? {word[31], word, 13'b0} : V'(word);
        else second = V'(word) ^ {V{minus}};
    end
    assign sum = first + second + V'(signed'({1'b0, !count[0] && minus}));

    // The new end: b n / d with n the inside end's distance.
    logic                start, busy, fall, up;
    logic signed [31:0]  base;
    logic signed [32:0]  delta;
    logic [31:0]         b, q;
    logic [V-2:0]        n, d, r;
    logic signed [V:0]   twice;
    assign delta = 33'(word) - 33'(base);
    // Up by half of d and more, where the coordinate falls only by more than that.
    assign twice = $signed({1'b0, r, 1'b0}) + $signed(~{2'b0, d}) + $signed({{V{1'b0}}, !fall});
    always_ff @(posedge clk) up <= twice >= 0;
    muldiv #(
        .W_B(32),
        .W_D(V - 1)
    ) i_muldiv (
        .clk  (clk),
        .rst_n(rst_n),
        .start(start),
        .b    (b),
        .n    (n),
        .d    (d),
        .busy (busy),
        .q    (q),
        .r    (r)
    );
    // base + q + up, or base - q - up.
    logic carry;
    assign carry      = up ^ fall;
    assign write_data = state == LOAD ? s_data : base + (q ^ {32{fall}}) + 32'(carry);

    always_ff @(posedge clk) begin
        start <= 1'b0;
        case (state)
            LOAD: if (s_valid) begin
                count <= count + 1'b1;
                plane <= '0;
                if (count == '1) state <= DISTANCE;
            end
            // count 0: nothing read yet; 1 and 2: first end; 3 and 4: second end.
            DISTANCE: begin
                count <= count + 1'b1;
                if (count == 3'd3) distance_a <= distance;
                if (plane == 3'd0 && !count[0]) distance <= sum[V-1] ? distance : V'(word);
                else distance <= sum;
                if (count == 3'd4) state <= JUDGE;
            end
            JUDGE: begin
                count     <= '0;
                axis      <= '0;
                plane     <= plane + 1'b1;
                a_outside <= distance_a[V-1];
                n         <= (V - 1)'(distance_a[V-1] ? distance : distance_a);
                d         <= (V - 1)'(distance_a[V-1] ? distance - distance_a : distance_a - distance);
                unload    <= '0;
                if (distance_a[V-1] && distance[V-1]) state <= LOAD;
                else if (distance_a[V-1] || distance[V-1]) state <= FETCH;
                else state <= plane == 3'd5 ? UNLOAD : DISTANCE;
            end
            // count 0: nothing read yet; 1: the inside end's coordinate; 2: the outside end's.
            FETCH: begin
                count <= count + 1'b1;
                base  <= count == 3'd1 ? word : base;
                fall  <= delta[32];
                if (count == 3'd2) begin
                    b     <= 32'(delta[32] ? -delta : delta);
                    start <= 1'b1;
                    state <= CROSS;
                end
            end
            CROSS: if (!start && !busy) state <= ROUND;
            // `up` is known one clock after the remainder.
            ROUND: state <= STORE;
            STORE: begin
                count <= '0;
                axis  <= axis + 1'b1;
                if (axis != 2'd3) state <= FETCH;
                else state <= plane == 3'd6 ? UNLOAD : DISTANCE;
            end
            default: begin
                // count[0]: the word is there.
                if (!count[0]) begin
                    count  <= 3'd1;
                    unload <= unload + 1'b1;
                end else if (m_ready) begin
                    count <= '0;
                    if (unload == '0) state <= LOAD;
                end
            end
        endcase
        if (!rst_n) begin
            state <= LOAD;
            count <= '0;
        end
    end
endmodule

`default_nettype wire
