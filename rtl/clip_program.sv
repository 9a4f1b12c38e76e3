// The clip unit's two programs, a word an operation: which word at an address comes out a clock later. clip.sv carries them out.
//
// Registers of `volume`: w, x, y, z of end a at 0, 2, 4, 6 and of end b at 1, 3, 5, 7; distances of the ends from the plane, 8 and 9;
// 2^13 w of the ends, 10 and 11. END flips bit 0, so that base 0 is the end inside and base 1 the one outside; AXIS adds 0 to 3 for
// w, x, y, z.
// Registers of `screen`: x and y of the ends at 0 to 3, |dx| and |dy| at 4 and 5, last column and row at 6 and 7. END flips bit 0 where
// the line is steep, AXIS bit 1 where it begins at end b: base 0 is the first pixel's major coordinate, 1 its minor one, 4 is n, 5 is m,
// 6 the last major coordinate on the screen, 7 the last minor one. The line's equations are in clip.sv.
// Of both: the divisor at 12, the factor at 14.
`default_nettype none

module clip_program #(
    parameter int W_CODE = 29
) (
    input  wire logic              clk,
    input  wire logic [7:0]        address,
    output logic      [W_CODE-1:0] code
);
    typedef logic [W_CODE-1:0] code_t;

    // Bits 3:0 are a register's number. A jump's target lies in bits 7:0.
    localparam code_t END        = code_t'(1) << 4;
    localparam code_t AXIS       = code_t'(1) << 5;
    localparam code_t ACCUMULATE = code_t'(1) << 6;
    localparam code_t TWICE      = code_t'(1) << 7;
    localparam code_t WORD       = code_t'(1) << 8;
    localparam code_t INVERT     = code_t'(1) << 9;
    localparam code_t CARRY      = code_t'(1) << 10;
    localparam code_t QUOTIENT   = code_t'(1) << 11;
    localparam code_t INPUT      = code_t'(1) << 12;
    localparam code_t LOAD       = code_t'(1) << 13;
    localparam code_t STORE      = code_t'(1) << 14;
    localparam code_t DIVIDE     = code_t'(1) << 15;
    localparam code_t SHIFT      = code_t'(1) << 16;
    localparam code_t OUTPUT     = code_t'(1) << 17;
    localparam code_t TAKE_END   = code_t'(1) << 18;
    localparam code_t TAKE_AXIS  = code_t'(1) << 19;
    localparam code_t TAKE_FLAG  = code_t'(1) << 20;
    localparam code_t NEXT_AXIS  = code_t'(1) << 21;
    localparam code_t JUMP       = code_t'(1) << 22;
    localparam code_t CALL       = (code_t'(1) << 23) | JUMP;
    localparam code_t RETURN     = code_t'(1) << 24;
    localparam code_t STOP       = code_t'(1) << 25;
    // Conditions. The accumulator's sign, the flag, an axis other than the first, the second end.
    localparam code_t NEGATIVE   = code_t'(1) << 26;
    localparam code_t POSITIVE   = code_t'(2) << 26;
    localparam code_t FLAG       = code_t'(3) << 26;
    localparam code_t NO_FLAG    = code_t'(4) << 26;
    localparam code_t MORE_AXES  = code_t'(5) << 26;
    localparam code_t AT_END     = code_t'(6) << 26;

    // What the programs are written in; a is the accumulator, r a register.
    localparam code_t GET      = LOAD | WORD;                                // a = r
    localparam code_t ADD      = LOAD | ACCUMULATE | WORD;                   // a + r
    localparam code_t ADD_1    = ADD | CARRY;                                // a + r + 1
    localparam code_t SUB_1    = ADD | INVERT;                               // a - r - 1
    localparam code_t SUB      = SUB_1 | CARRY;                              // a - r
    localparam code_t NEG      = GET | INVERT | CARRY;                       // -r
    localparam code_t CLEAR    = LOAD;                                       // 0
    localparam code_t DECREASE = LOAD | ACCUMULATE | INVERT;                 // a - 1
    localparam code_t PUT      = STORE | ACCUMULATE;                         // r = a
    localparam code_t TAKE     = LOAD | INPUT | STORE;                       // a = r = s_data
    localparam code_t GUARD    = LOAD | TWICE | SHIFT | STORE;               // a = r = 2^13 a
    localparam code_t TWICE_SUB = LOAD | TWICE | WORD | INVERT | CARRY;      // 2 a - r
    localparam code_t ROUNDED  = LOAD | QUOTIENT;                            // q, and 1 where a >= 0

    localparam code_t DIVISOR = code_t'(12);
    localparam code_t FACTOR = code_t'(14);
    localparam code_t DIVIDE_BY = DIVIDE | WORD | DIVISOR;                    // q and a = r of a r14 / r12
    localparam code_t SPARE = code_t'(15);
    // volume
    localparam code_t W = code_t'(0);
    localparam code_t X = code_t'(2);
    localparam code_t Y = code_t'(4);
    localparam code_t Z = code_t'(6);
    localparam code_t B = code_t'(1);
    localparam code_t DISTANCE = code_t'(8);
    localparam code_t BOUND = code_t'(10);
    localparam code_t IN = END;
    localparam code_t OUT = B | END;
    // screen
    localparam code_t MAJOR = code_t'(0) | END | AXIS;
    localparam code_t MINOR = code_t'(1) | END | AXIS;
    localparam code_t LAST_MINOR_END = code_t'(3) | END | AXIS;
    localparam code_t N = code_t'(4) | END;
    localparam code_t M = code_t'(5) | END;
    localparam code_t SIZE_MAJOR = code_t'(6) | END;
    localparam code_t SIZE_MINOR = code_t'(7) | END;
    localparam code_t FIRST = code_t'(8);
    localparam code_t LAST = code_t'(9);
    localparam code_t HIGHEST = code_t'(10);
    localparam code_t TURN = code_t'(11);

    localparam logic [7:0] VOLUME = 8'h00;
    localparam logic [7:0] GIVE = 8'h3c;
    localparam logic [7:0] CUT = 8'h50;
    localparam logic [7:0] CUT_AXIS = CUT + 8'd9;
    localparam logic [7:0] SCREEN = 8'h80;
    localparam logic [7:0] ENTER = SCREEN + 8'h30;
    localparam logic [7:0] LEAVE = SCREEN + 8'h40;
    localparam logic [7:0] VISIBLE = SCREEN + 8'h4f;
    localparam logic [7:0] WHOLE = SCREEN + 8'h70;
    localparam logic [7:0] ERROR = WHOLE + 8'd2;

    function automatic code_t to(input logic [7:0] target);
        to = {{(W_CODE - 8) {1'b0}}, target};
    endfunction

    function automatic code_t operation(input logic [7:0] at);
        case (at)
            VOLUME + 8'h00: operation = TAKE | W;
            VOLUME + 8'h01: operation = TAKE | X;
            VOLUME + 8'h02: operation = TAKE | Y;
            VOLUME + 8'h03: operation = TAKE | Z;
            VOLUME + 8'h04: operation = TAKE | W | B;
            VOLUME + 8'h05: operation = TAKE | X | B;
            VOLUME + 8'h06: operation = TAKE | Y | B;
            VOLUME + 8'h07: operation = TAKE | Z | B;
            VOLUME + 8'h08: operation = GET | W;
            VOLUME + 8'h09: operation = GUARD | BOUND;
            VOLUME + 8'h0a: operation = GET | W | B;
            VOLUME + 8'h0b: operation = GUARD | BOUND | B;
            // Near: min(z, w - 1) = z + min(w - 1 - z, 0).
            VOLUME + 8'h0c: operation = GET | W;
            VOLUME + 8'h0d: operation = SUB_1 | Z;
            VOLUME + 8'h0e: operation = CLEAR | POSITIVE;
            VOLUME + 8'h0f: operation = ADD | Z;
            VOLUME + 8'h10: operation = PUT | DISTANCE;
            VOLUME + 8'h11: operation = GET | W | B;
            VOLUME + 8'h12: operation = SUB_1 | Z | B;
            VOLUME + 8'h13: operation = CLEAR | POSITIVE;
            VOLUME + 8'h14: operation = ADD | Z | B;
            VOLUME + 8'h15: operation = PUT | DISTANCE | B;
            VOLUME + 8'h16: operation = CALL | to(CUT);
            // Far: w - z.
            VOLUME + 8'h17: operation = GET | W;
            VOLUME + 8'h18: operation = SUB | Z;
            VOLUME + 8'h19: operation = PUT | DISTANCE;
            VOLUME + 8'h1a: operation = GET | W | B;
            VOLUME + 8'h1b: operation = SUB | Z | B;
            VOLUME + 8'h1c: operation = PUT | DISTANCE | B;
            VOLUME + 8'h1d: operation = CALL | to(CUT);
            // The guard band's four sides: 2^13 w + x, 2^13 w - x, and with y.
            VOLUME + 8'h1e: operation = GET | BOUND;
            VOLUME + 8'h1f: operation = ADD | X;
            VOLUME + 8'h20: operation = PUT | DISTANCE;
            VOLUME + 8'h21: operation = GET | BOUND | B;
            VOLUME + 8'h22: operation = ADD | X | B;
            VOLUME + 8'h23: operation = PUT | DISTANCE | B;
            VOLUME + 8'h24: operation = CALL | to(CUT);
            VOLUME + 8'h25: operation = GET | BOUND;
            VOLUME + 8'h26: operation = SUB | X;
            VOLUME + 8'h27: operation = PUT | DISTANCE;
            VOLUME + 8'h28: operation = GET | BOUND | B;
            VOLUME + 8'h29: operation = SUB | X | B;
            VOLUME + 8'h2a: operation = PUT | DISTANCE | B;
            VOLUME + 8'h2b: operation = CALL | to(CUT);
            VOLUME + 8'h2c: operation = GET | BOUND;
            VOLUME + 8'h2d: operation = ADD | Y;
            VOLUME + 8'h2e: operation = PUT | DISTANCE;
            VOLUME + 8'h2f: operation = GET | BOUND | B;
            VOLUME + 8'h30: operation = ADD | Y | B;
            VOLUME + 8'h31: operation = PUT | DISTANCE | B;
            VOLUME + 8'h32: operation = CALL | to(CUT);
            VOLUME + 8'h33: operation = GET | BOUND;
            VOLUME + 8'h34: operation = SUB | Y;
            VOLUME + 8'h35: operation = PUT | DISTANCE;
            VOLUME + 8'h36: operation = GET | BOUND | B;
            VOLUME + 8'h37: operation = SUB | Y | B;
            VOLUME + 8'h38: operation = PUT | DISTANCE | B;
            VOLUME + 8'h39: operation = CALL | to(CUT);
            // What is left: end a, whose w is 1 or more, as the near plane has seen to; then end b.
            VOLUME + 8'h3a: operation = GET | W;
            VOLUME + 8'h3b: operation = TAKE_END;
            // Coordinates within 2^13 w: v + min(2^13 w - v, 0), then v - min(v + 2^13 w, 0). w and z lie within anyway.
            GIVE + 8'd0: operation = GET | BOUND | END;
            GIVE + 8'd1: operation = SUB | IN | AXIS;
            GIVE + 8'd2: operation = CLEAR | POSITIVE;
            GIVE + 8'd3: operation = ADD | IN | AXIS;
            GIVE + 8'd4: operation = PUT | IN | AXIS;
            GIVE + 8'd5: operation = ADD | BOUND | END;
            GIVE + 8'd6: operation = CLEAR | POSITIVE;
            GIVE + 8'd7: operation = PUT | SPARE;
            GIVE + 8'd8: operation = GET | IN | AXIS;
            GIVE + 8'd9: operation = SUB | SPARE;
            GIVE + 8'd10: operation = OUTPUT;
            GIVE + 8'd11: operation = NEXT_AXIS;
            GIVE + 8'd12: operation = JUMP | to(GIVE) | MORE_AXES;
            GIVE + 8'd13: operation = STOP | AT_END;
            GIVE + 8'd14: operation = NEG | W;
            GIVE + 8'd15: operation = TAKE_END;
            GIVE + 8'd16: operation = JUMP | to(GIVE);

            // The ends against one plane.
            CUT + 8'd0: operation = GET | DISTANCE;
            CUT + 8'd1: operation = TAKE_END;
            CUT + 8'd2: operation = GET | DISTANCE | IN;
            CUT + 8'd3: operation = STOP | NEGATIVE;
            CUT + 8'd4: operation = GET | DISTANCE | OUT;
            CUT + 8'd5: operation = RETURN | POSITIVE;
            CUT + 8'd6: operation = GET | DISTANCE | IN;
            CUT + 8'd7: operation = SUB | DISTANCE | OUT;
            CUT + 8'd8: operation = PUT | DIVISOR;
            // From the lower coordinate upwards, as rounding to nearest is the same from both: the factor is that end's distance.
            CUT_AXIS + 8'd0: operation = GET | OUT | AXIS;
            CUT_AXIS + 8'd1: operation = SUB | IN | AXIS;
            CUT_AXIS + 8'd2: operation = TAKE_FLAG;
            CUT_AXIS + 8'd3: operation = GET | DISTANCE | IN;
            CUT_AXIS + 8'd4: operation = NEG | DISTANCE | OUT | FLAG;
            CUT_AXIS + 8'd5: operation = PUT | FACTOR;
            CUT_AXIS + 8'd6: operation = GET | OUT | AXIS;
            CUT_AXIS + 8'd7: operation = SUB | IN | AXIS;
            CUT_AXIS + 8'd8: operation = GET | IN | AXIS | FLAG;
            CUT_AXIS + 8'd9: operation = SUB | OUT | AXIS | FLAG;
            CUT_AXIS + 8'd10: operation = DIVIDE_BY;
            CUT_AXIS + 8'd11: operation = TWICE_SUB | DIVISOR;
            CUT_AXIS + 8'd12: operation = ROUNDED;
            CUT_AXIS + 8'd13: operation = ADD | IN | AXIS | NO_FLAG;
            CUT_AXIS + 8'd14: operation = ADD | OUT | AXIS | FLAG;
            CUT_AXIS + 8'd15: operation = PUT | OUT | AXIS;
            CUT_AXIS + 8'd16: operation = NEXT_AXIS;
            CUT_AXIS + 8'd17: operation = JUMP | to(CUT_AXIS) | MORE_AXES;
            CUT_AXIS + 8'd18: operation = GET | W | OUT;
            CUT_AXIS + 8'd19: operation = GUARD | BOUND | OUT;
            CUT_AXIS + 8'd20: operation = RETURN;

            SCREEN + 8'h00: operation = TAKE | code_t'(0);
            SCREEN + 8'h01: operation = TAKE | code_t'(1);
            SCREEN + 8'h02: operation = TAKE | code_t'(2);
            SCREEN + 8'h03: operation = TAKE | code_t'(6);
            SCREEN + 8'h04: operation = DECREASE | STORE | code_t'(6);
            SCREEN + 8'h05: operation = TAKE | code_t'(7);
            SCREEN + 8'h06: operation = DECREASE | STORE | code_t'(7);
            SCREEN + 8'h07: operation = TAKE | code_t'(3);
            SCREEN + 8'h08: operation = SUB | code_t'(1);
            SCREEN + 8'h09: operation = PUT | code_t'(5);
            SCREEN + 8'h0a: operation = NEG | code_t'(5) | NEGATIVE;
            SCREEN + 8'h0b: operation = PUT | code_t'(5);
            SCREEN + 8'h0c: operation = GET | code_t'(2);
            SCREEN + 8'h0d: operation = SUB | code_t'(0);
            SCREEN + 8'h0e: operation = PUT | code_t'(4);
            SCREEN + 8'h0f: operation = NEG | code_t'(4) | NEGATIVE;
            SCREEN + 8'h10: operation = PUT | code_t'(4);
            // Steep where |dx| < |dy|; from end b where the major coordinate falls; `flag` where the minor one does.
            SCREEN + 8'h11: operation = SUB | code_t'(5);
            SCREEN + 8'h12: operation = TAKE_END;
            SCREEN + 8'h13: operation = GET | code_t'(2) | END;
            SCREEN + 8'h14: operation = SUB | code_t'(0) | END;
            SCREEN + 8'h15: operation = TAKE_AXIS;
            SCREEN + 8'h16: operation = GET | LAST_MINOR_END;
            SCREEN + 8'h17: operation = SUB | MINOR;
            SCREEN + 8'h18: operation = TAKE_FLAG;
            // A falling line is turned upside down until the end, so that its minor coordinate rises.
            SCREEN + 8'h19: operation = GET | MINOR;
            SCREEN + 8'h1a: operation = NEG | MINOR | FLAG;
            SCREEN + 8'h1b: operation = ADD | SIZE_MINOR | FLAG;
            SCREEN + 8'h1c: operation = PUT | MINOR;
            SCREEN + 8'h1d: operation = ADD | M;
            SCREEN + 8'h1e: operation = STOP | NEGATIVE;
            SCREEN + 8'h1f: operation = GET | SIZE_MINOR;
            SCREEN + 8'h20: operation = SUB | MINOR;
            SCREEN + 8'h21: operation = STOP | NEGATIVE;
            SCREEN + 8'h22: operation = PUT | HIGHEST;
            SCREEN + 8'h23: operation = GET | MAJOR;
            SCREEN + 8'h24: operation = ADD | N;
            SCREEN + 8'h25: operation = STOP | NEGATIVE;
            // last = min(size - 1 - major, n), first = max(-major, 0).
            SCREEN + 8'h26: operation = GET | SIZE_MAJOR;
            SCREEN + 8'h27: operation = SUB | MAJOR;
            SCREEN + 8'h28: operation = STOP | NEGATIVE;
            SCREEN + 8'h29: operation = SUB | N;
            SCREEN + 8'h2a: operation = CLEAR | POSITIVE;
            SCREEN + 8'h2b: operation = ADD | N;
            SCREEN + 8'h2c: operation = PUT | LAST;
            SCREEN + 8'h2d: operation = NEG | MAJOR;
            SCREEN + 8'h2e: operation = CLEAR | NEGATIVE;
            SCREEN + 8'h2f: operation = PUT | FIRST;
            // lo = -minor > 0: first = max(first, ceil(n (2 lo - 1) / (2 m))); rounded up: one more where r - 1 >= 0.
            ENTER + 8'd0: operation = GET | M;
            ENTER + 8'd1: operation = ADD | M;
            ENTER + 8'd2: operation = PUT | DIVISOR;
            ENTER + 8'd3: operation = GET | MINOR;
            ENTER + 8'd4: operation = JUMP | to(LEAVE) | POSITIVE;
            ENTER + 8'd5: operation = NEG | MINOR;
            ENTER + 8'd6: operation = SUB_1 | MINOR;
            ENTER + 8'd7: operation = PUT | FACTOR;
            ENTER + 8'd8: operation = GET | N;
            ENTER + 8'd9: operation = DIVIDE_BY;
            ENTER + 8'd10: operation = DECREASE;
            ENTER + 8'd11: operation = ROUNDED;
            ENTER + 8'd12: operation = SUB | FIRST;
            ENTER + 8'd13: operation = CLEAR | NEGATIVE;
            ENTER + 8'd14: operation = ADD | FIRST;
            ENTER + 8'd15: operation = PUT | FIRST;
            // hi < m: last = min(last, ceil(n (2 hi + 1) / (2 m)) - 1).
            LEAVE + 8'd0: operation = GET | HIGHEST;
            LEAVE + 8'd1: operation = SUB | M;
            LEAVE + 8'd2: operation = JUMP | to(VISIBLE) | POSITIVE;
            LEAVE + 8'd3: operation = GET | HIGHEST;
            LEAVE + 8'd4: operation = ADD_1 | HIGHEST;
            LEAVE + 8'd5: operation = PUT | FACTOR;
            LEAVE + 8'd6: operation = GET | N;
            LEAVE + 8'd7: operation = DIVIDE_BY;
            LEAVE + 8'd8: operation = DECREASE;
            LEAVE + 8'd9: operation = ROUNDED;
            LEAVE + 8'd10: operation = DECREASE;
            LEAVE + 8'd11: operation = SUB | LAST;
            LEAVE + 8'd12: operation = CLEAR | POSITIVE;
            LEAVE + 8'd13: operation = ADD | LAST;
            LEAVE + 8'd14: operation = PUT | LAST;
            // What is visible: steps, rise, turn, the first major coordinate.
            VISIBLE + 8'h00: operation = GET | LAST;
            VISIBLE + 8'h01: operation = SUB | FIRST;
            VISIBLE + 8'h02: operation = STOP | NEGATIVE;
            VISIBLE + 8'h03: operation = OUTPUT | code_t'(2);
            VISIBLE + 8'h04: operation = GET | M;
            VISIBLE + 8'h05: operation = OUTPUT | code_t'(3);
            VISIBLE + 8'h06: operation = SUB | N;
            VISIBLE + 8'h07: operation = PUT | TURN;
            VISIBLE + 8'h08: operation = OUTPUT | code_t'(4);
            VISIBLE + 8'h09: operation = GET | MAJOR;
            VISIBLE + 8'h0a: operation = ADD | FIRST;
            VISIBLE + 8'h0b: operation = OUTPUT | code_t'(0);
            VISIBLE + 8'h0c: operation = GET | FIRST;
            VISIBLE + 8'h0d: operation = DECREASE;
            VISIBLE + 8'h0e: operation = JUMP | to(WHOLE) | NEGATIVE;
            // 2 m first = q 2 n + r; q rounded to nearest is how far the minor coordinate went.
            VISIBLE + 8'h0f: operation = GET | N;
            VISIBLE + 8'h10: operation = ADD | N;
            VISIBLE + 8'h11: operation = PUT | DIVISOR;
            VISIBLE + 8'h12: operation = GET | M;
            VISIBLE + 8'h13: operation = ADD | M;
            VISIBLE + 8'h14: operation = PUT | FACTOR;
            VISIBLE + 8'h15: operation = GET | FIRST;
            VISIBLE + 8'h16: operation = DIVIDE_BY;
            VISIBLE + 8'h17: operation = SUB | N;
            VISIBLE + 8'h18: operation = PUT | SPARE;
            VISIBLE + 8'h19: operation = ROUNDED;
            VISIBLE + 8'h1a: operation = ADD | MINOR;
            VISIBLE + 8'h1b: operation = PUT | MINOR;
            // error = v mod 2 n - 2 n + 2 m, where v mod 2 n is r - n, or r + n where that is negative.
            VISIBLE + 8'h1c: operation = GET | SPARE;
            VISIBLE + 8'h1d: operation = ADD | DIVISOR | NEGATIVE;
            VISIBLE + 8'h1e: operation = ADD | TURN;
            VISIBLE + 8'h1f: operation = ADD | TURN;
            VISIBLE + 8'h20: operation = JUMP | to(ERROR);
            // From the line's beginning: error = 2 m - n.
            WHOLE + 8'd0: operation = GET | M;
            WHOLE + 8'd1: operation = ADD | TURN;
            ERROR + 8'd0: operation = OUTPUT | code_t'(5);
            ERROR + 8'd1: operation = GET | MINOR;
            ERROR + 8'd2: operation = NEG | MINOR | FLAG;
            ERROR + 8'd3: operation = ADD | SIZE_MINOR | FLAG;
            ERROR + 8'd4: operation = OUTPUT | code_t'(1);
            ERROR + 8'd5: operation = STOP;
            default: operation = STOP;
        endcase
    endfunction

    always_ff @(posedge clk) code <= operation(address);
endmodule

`default_nettype wire
