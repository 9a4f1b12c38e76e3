// Raster, lines: the part of a path that lies on the screen, as the library's `Path::clip`. Visible pixels never move.
//
// Pixel i of 0..=n lies at major + i, minor +- q(i), with q(i) = floor((2 m i + n) / (2 n)), which never falls: what is visible is one
// interval of i. With lo and hi the values of q that lie on the screen,
//
//   first = max(0, -major, ceil(n (2 lo - 1) / (2 m)) if lo > 0)
//   last  = min(n, size - 1 - major, ceil(n (2 hi + 1) / (2 m)) - 1 if hi < m)
//   q(first) = floor(v / (2 n)),  error = v mod 2 n - 2 n + 2 m,  v = 2 m first + n       exact
//
//   | s_x, s_y      | first pixel of the path, W bits with sign                                                       |
//   | s_n, s_m      | steps along the major axis, and the rise: unsigned, W bits                                      |
//   | width, height | of the screen: 1 to 2^W_SCREEN                                                                   |
//   | m_            | the visible path for line_walk; a line without a visible pixel vanishes                         |
//
// Clocks: 4 for a path on the screen; 8 to 12 and up to three products' quotients (muldiv, W + 1 to 3 W + 1 clocks each) for one
// that leaves it. One line at a time.
`default_nettype none

module line_clip #(
    parameter int W        = 23,
    parameter int W_SCREEN = 10
) (
    input  wire logic                    clk,
    input  wire logic                    rst_n,
    input  wire logic [W_SCREEN:0]       width,
    input  wire logic [W_SCREEN:0]       height,
    input  wire logic                    s_valid,
    output logic                         s_ready,
    input  wire logic signed [W-1:0]     s_x,
    input  wire logic signed [W-1:0]     s_y,
    input  wire logic                    s_steep,
    input  wire logic                    s_back,
    input  wire logic [W-1:0]            s_n,
    input  wire logic [W-1:0]            s_m,
    output logic                         m_valid,
    input  wire logic                    m_ready,
    output logic [W_SCREEN-1:0]          m_x,
    output logic [W_SCREEN-1:0]          m_y,
    output logic                         m_steep,
    output logic                         m_back,
    output logic [W-1:0]                 m_steps,
    output logic [W-1:0]                 m_rise,
    output logic signed [W:0]            m_turn,
    output logic signed [W+1:0]          m_error
);
    // Wide enough for every sum of two coordinates.
    localparam int V = W + 2;

    typedef enum logic [3:0] {
        EMPTY, BOUNDS, INSIDE, ENTER, ENTERED, LEAVE, LEFT, EMPTY_OR_FIRST, ADVANCE, SETTLE, FULL
    } state_t;
    state_t state;

    logic signed [V-1:0] major, minor, last_major, last_minor, lowest, highest;
    logic [W-1:0]        n, m;
    logic                steep, back;
    logic signed [V-1:0] first, last;
    logic signed [V-1:0] major_end, minor_end, n_signed, m_signed;
    assign n_signed = $signed({2'b0, n});
    assign m_signed = $signed({2'b0, m});
    assign s_ready  = state == EMPTY;

    // The one divider: b n' / d.
    logic         start, busy;
    logic [W:0]   b, q;
    logic [W+1:0] part, whole, rest;
    muldiv #(
        .W_B(W + 1),
        .W_D(W + 2)
    ) i_muldiv (
        .n(part),
        .d(whole),
        .r(rest),
        .clk(clk),
        .rst_n(rst_n),
        .start(start),
        .b(b),
        .busy(busy),
        .q(q)
    );
    // Its results are used a clock after it has them: `settled`, and the quotient rounded up in a register.
    logic                settled, reach;
    logic signed [V-1:0] quotient_up;
    always_ff @(posedge clk) begin
        settled     <= (state == ENTERED || state == LEFT || state == ADVANCE) && !start && !busy;
        quotient_up <= $signed({1'b0, q}) + V'(signed'({1'b0, rest != '0}));
        reach       <= $signed(rest) >= n_signed;
    end

    // What is loaded into the divider: entering, leaving, and the error where the line enters.
    logic signed [V-1:0] odd;
    assign odd = state == ENTER ? (lowest <<< 1) - 1 : (highest <<< 1) + 1;

    // From EMPTY: the screen along each axis of the path.
    logic signed [W-1:0] s_major, s_minor;
    logic signed [V-1:0] x_last, y_last;
    assign s_major = s_steep ? s_y : s_x;
    assign s_minor = s_steep ? s_x : s_y;
    assign x_last = V'(signed'({1'b0, width})) - 1;
    assign y_last = V'(signed'({1'b0, height})) - 1;

    logic signed [V-1:0] rest_signed;
    assign rest_signed = $signed(rest);
    logic signed [V-1:0] advance;
    assign advance = $signed({1'b0, q}) + V'(signed'({1'b0, reach}));

    always_ff @(posedge clk) begin
        start <= 1'b0;
        case (state)
            EMPTY: begin
                if (s_valid) state <= BOUNDS;
                major      <= V'(s_major);
                minor      <= V'(s_minor);
                last_major <= s_steep ? y_last : x_last;
                last_minor <= s_steep ? x_last : y_last;
                {n, m, steep, back} <= {s_n, s_m, s_steep, s_back};
            end
            BOUNDS: begin
                state     <= INSIDE;
                major_end <= major + n_signed;
                minor_end <= back ? minor - m_signed : minor + m_signed;
                lowest    <= back ? minor - last_minor : -minor;
                highest   <= back ? minor : last_minor - minor;
                m_error   <= (m_signed <<< 1) - n_signed;
                m_turn    <= (W + 1)'(m_signed - n_signed);
                m_steps   <= n;
                first     <= major < 0 ? -major : '0;
                last      <= last_major - major;
            end
            INSIDE: begin
                if (last > n_signed) last <= n_signed;
                if (major < 0 || minor < 0 || minor_end < 0 || major_end > last_major || minor > last_minor
                        || minor_end > last_minor) begin
                    state <= lowest > m_signed || highest < 0 || major > last_major || major_end < 0 ? EMPTY : ENTER;
                end else begin
                    state <= FULL;
                end
            end
            ENTER, LEAVE: begin
                b     <= {1'b0, n};
                part  <= odd;
                whole <= {1'b0, m, 1'b0};
                if (state == ENTER) begin
                    start <= lowest > 0;
                    state <= lowest > 0 ? ENTERED : LEAVE;
                end else begin
                    start <= highest < m_signed;
                    state <= highest < m_signed ? LEFT : EMPTY_OR_FIRST;
                end
            end
            ENTERED: if (settled) begin
                if (quotient_up > first) first <= quotient_up;
                state <= LEAVE;
            end
            LEFT: if (settled) begin
                if (quotient_up <= last) last <= quotient_up - 1;
                state <= EMPTY_OR_FIRST;
            end
            EMPTY_OR_FIRST: begin
                b       <= (W + 1)'(first);
                part    <= {1'b0, m, 1'b0};
                whole   <= {1'b0, n, 1'b0};
                start   <= first != 0 && first <= last;
                m_steps <= W'(last - first);
                major   <= major + first;
                state   <= first > last ? EMPTY : first == 0 ? FULL : ADVANCE;
            end
            ADVANCE: if (settled) begin
                // v = q 2 n + rest + n.
                m_error <= reach ? rest_signed - n_signed : rest_signed + n_signed;
                minor   <= back ? minor - advance : minor + advance;
                state   <= SETTLE;
            end
            SETTLE: begin
                m_error <= m_error + (V'(m_turn) <<< 1);
                state   <= FULL;
            end
            default: if (m_ready) state <= EMPTY;
        endcase
        if (!rst_n) begin
            state <= EMPTY;
            start <= 1'b0;
        end
    end

    assign m_valid = state == FULL;
    assign m_x     = W_SCREEN'(steep ? minor : major);
    assign m_y     = W_SCREEN'(steep ? major : minor);
    assign m_steep = steep;
    assign m_back  = back;
    assign m_rise  = m;
endmodule

`default_nettype wire
