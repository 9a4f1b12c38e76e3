// Clip: a line against the view volume, as the library's `clip::line`, and a path against the screen, as its `Path::clip`.
//
// volume: the near plane, the far plane and the guard band.
//
//   distance from plane 0 ... 5:  min(z, w - 1),  w - z,  2^13 w + x,  2^13 w - x,  2^13 w + y,  2^13 w - y      inside: >= 0
//   v = v_in + (v_out - v_in) d_in / (d_in - d_out)        each coordinate, rounded to nearest, exact
//
// Planes come in this order, each seeing what the one before left; a line whose ends are both outside of one vanishes. Rounding may
// leave a new end's x or y beyond 2^13 w by a hair; it goes out as that.
//
// screen: the part of a line's path that lies on the screen; visible pixels never move. Pixel i of 0..=n lies at major + i, minor +- q(i),
// with q(i) = floor((2 m i + n) / (2 n)), which never falls: what is visible is one interval of i. With lo and hi the values of q
// that lie on the screen,
//
//   first = max(0, -major, ceil(n (2 lo - 1) / (2 m)) if lo > 0)
//   last  = min(n, size - 1 - major, ceil(n (2 hi + 1) / (2 m)) - 1 if hi < m)
//   q(first) = floor(v / (2 n)),  error = v mod 2 n - 2 n + 2 m,  v = 2 m first + n       exact
//
//   | s_screen | which; it counts with the first word                                                                   |
//   | s_data   | volume: clip coordinates of one end, then of the other: w, x, y, z each; 32 bits with sign, below 2^30 + 4   |
//   |          | screen: the word that s_word names: 0, 1 x, y of one end; 2, 3 of the other; 6, 7 the screen's width, height  |
//   | m_screen | which is at work                                                                                        |
//   | m_data   | volume: what is left, as it came in                                                                      |
//   |          | screen: the word that m_word names: 0, 1 first major and minor coordinate, 2 steps, 3 rise m, 4 turn m - n,  |
//   |          | 5 error; 1 is the last                                                                                  |
//   | m_steep, m_back | the path's major axis is y; its minor coordinate falls                                            |
//   | idle     | no line is in here                                                                                      |
//
// Few lines need this, so that one adder, sixteen registers and a program (clip_program) serve both: two clocks an operation, one to write,
// two to jump. Clocks: volume 513 for a line that stays whole, 330 to 560 more for a new end, 95 for a line before the near plane;
// screen 78 for a line beside it, 185 and up to three quotients (25, and 33 to 97) for one that is seen.
`default_nettype none

module clip (
    input  wire logic               clk,
    input  wire logic               rst_n,
    input  wire logic               s_screen,
    input  wire logic               s_valid,
    output logic                    s_ready,
    input  wire logic signed [31:0] s_data,
    output logic [2:0]              s_word,
    output logic                    m_screen,
    output logic                    m_valid,
    input  wire logic               m_ready,
    output logic signed [31:0]      m_data,
    output logic [2:0]              m_word,
    output logic                    m_steep,
    output logic                    m_back,
    output logic                    idle
);
    // Distances reach 2^43 + 2^31; the division needs four times their differences.
    localparam int W = 47;
    localparam int W_CODE = 29;

    // FETCH: the program's word is being read. DECODE: it becomes the operation. READ: the register that it names. PUT: it is written.
    typedef enum logic [2:0] {IDLE, FETCH, DECODE, READ, EXECUTE, PUT} state_t;
    state_t            state;
    logic [7:0]        counter, link;
    logic [W_CODE-1:0] fetched, code;
    clip_program #(
        .W_CODE(W_CODE)
    ) i_program (
        .clk    (clk),
        .address(counter),
        .code   (fetched)
    );

    logic [3:0] register;
    logic       flip_end, flip_axis, accumulate, twice, use_word, invert, carry, quotient, use_input, load, store, divide, shift;
    logic       give, take_end, take_axis, take_flag, next_axis, jump, call, back, stop;
    logic [2:0] condition;
    assign {condition, stop, back, call, jump, next_axis, take_flag, take_axis, take_end, give, shift, divide, store, load, use_input,
            quotient, carry, invert, use_word, twice, accumulate, flip_axis, flip_end, register} = code;

    // What the addresses are turned by, and what conditions ask for.
    logic       second, flag, negative, holds;
    logic [1:0] axis;
    always_comb begin
        case (condition)
            3'd0: holds = 1'b1;
            3'd1: holds = negative;
            3'd2: holds = !negative;
            3'd3: holds = flag;
            3'd4: holds = !flag;
            3'd5: holds = axis != 2'd0;
            default: holds = second;
        endcase
    end

    // An operation ends where its stream moves and its arithmetic is through.
    logic execute, last, other, done;
    assign execute = state == EXECUTE && !(use_input && !s_valid) && !(give && !m_ready);
    assign s_ready = state == EXECUTE && use_input;
    assign m_valid = state == EXECUTE && give;
    assign done    = execute && last;
    assign idle    = state == IDLE;

    logic [3:0]          address;
    logic signed [W-1:0] registers[16];
    logic signed [W-1:0] word, accumulator;
    always_comb begin
        address = register ^ {1'b0, axis & {2{flip_axis}}, second && flip_end};
        // The division's factor is two registers on.
        if (other) address[1] = 1'b1;
    end
    always_ff @(posedge clk) begin
        if (state == PUT) registers[address] <= accumulator;
        word <= registers[address];
    end

    logic prepare, loads;
    assign prepare = state == READ;
    assign loads   = load && holds;
    clip_alu #(
        .W    (W),
        .W_Q  (32),
        .SHIFT(13)
    ) i_alu (
        .clk        (clk),
        .prepare    (prepare),
        .run        (execute),
        .load       (loads),
        .accumulate (accumulate),
        .twice      (twice),
        .use_word   (use_word),
        .invert     (invert),
        .carry      (carry),
        .quotient   (quotient),
        .use_input  (use_input),
        .divide     (divide),
        .shift      (shift),
        .word       (word),
        .s_data     (s_data),
        .other      (other),
        .last       (last),
        .negative   (negative),
        .accumulator(accumulator)
    );

    always_ff @(posedge clk) begin
        case (state)
            IDLE: begin
                m_screen       <= s_screen;
                counter        <= {s_screen, 7'd0};
                {second, axis} <= '0;
                if (s_valid) state <= FETCH;
            end
            FETCH: state <= DECODE;
            DECODE: begin
                code    <= fetched;
                counter <= counter + 1'b1;
                state   <= READ;
            end
            READ: state <= EXECUTE;
            EXECUTE: if (done) begin
                if (take_end) second <= negative;
                if (take_axis) axis[0] <= negative;
                if (next_axis) axis <= axis + 1'b1;
                if (take_flag) flag <= negative;
                if (holds && call) link <= counter;
                if (store) begin
                    state <= PUT;
                end else begin
                    code    <= fetched;
                    counter <= counter + 1'b1;
                    state   <= READ;
                    if (holds && (jump || back)) begin
                        counter <= back ? link : code[7:0];
                        state   <= FETCH;
                    end
                    if (holds && stop) state <= IDLE;
                end
            end
            default: begin
                code    <= fetched;
                counter <= counter + 1'b1;
                state   <= READ;
            end
        endcase
        if (!rst_n) state <= IDLE;
    end

    assign s_word  = register[2:0];
    assign m_word  = register[2:0];
    assign m_data  = accumulator[31:0];
    assign m_steep = second;
    assign m_back  = flag;
    logic unused_top;
    assign unused_top = ^accumulator[W-1:32];
endmodule

`default_nettype wire
