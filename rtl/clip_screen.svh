// Clip's program `screen`: a path against the screen. The line's equations are in clip.sv.
//
// Registers: x and y of the ends at 0 to 3, |dx| and |dy| at 4 and 5, last column and row at 6 and 7. END flips bit 0 where the line is
// steep, AXIS bit 1 where it begins at end b: base 0 is the first pixel's major coordinate, 1 its minor one, 4 is n, 5 is m, 6 the last
// major coordinate on the screen, 7 the last minor one.

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

    localparam logic [7:0] SCREEN = 8'h80;
    localparam logic [7:0] ENTER = SCREEN + 8'h30;
    localparam logic [7:0] LEAVE = SCREEN + 8'h40;
    localparam logic [7:0] VISIBLE = SCREEN + 8'h4f;
    localparam logic [7:0] WHOLE = SCREEN + 8'h70;
    localparam logic [7:0] ERROR = WHOLE + 8'd2;

    function automatic code_t screen(input logic [7:0] at);
        case (at)
            SCREEN + 8'h00: screen = TAKE | code_t'(0);
            SCREEN + 8'h01: screen = TAKE | code_t'(1);
            SCREEN + 8'h02: screen = TAKE | code_t'(2);
            SCREEN + 8'h03: screen = TAKE | code_t'(6);
            SCREEN + 8'h04: screen = DECREASE | STORE | code_t'(6);
            SCREEN + 8'h05: screen = TAKE | code_t'(7);
            SCREEN + 8'h06: screen = DECREASE | STORE | code_t'(7);
            SCREEN + 8'h07: screen = TAKE | code_t'(3);
            SCREEN + 8'h08: screen = SUB | code_t'(1);
            SCREEN + 8'h09: screen = PUT | code_t'(5);
            SCREEN + 8'h0a: screen = NEG | code_t'(5) | NEGATIVE;
            SCREEN + 8'h0b: screen = PUT | code_t'(5);
            SCREEN + 8'h0c: screen = GET | code_t'(2);
            SCREEN + 8'h0d: screen = SUB | code_t'(0);
            SCREEN + 8'h0e: screen = PUT | code_t'(4);
            SCREEN + 8'h0f: screen = NEG | code_t'(4) | NEGATIVE;
            SCREEN + 8'h10: screen = PUT | code_t'(4);
            // Steep where |dx| < |dy|; from end b where the major coordinate falls; `flag` where the minor one does.
            SCREEN + 8'h11: screen = SUB | code_t'(5);
            SCREEN + 8'h12: screen = TAKE_END;
            SCREEN + 8'h13: screen = GET | code_t'(2) | END;
            SCREEN + 8'h14: screen = SUB | code_t'(0) | END;
            SCREEN + 8'h15: screen = TAKE_AXIS;
            SCREEN + 8'h16: screen = GET | LAST_MINOR_END;
            SCREEN + 8'h17: screen = SUB | MINOR;
            SCREEN + 8'h18: screen = TAKE_FLAG;
            // A falling line is turned upside down until the end, so that its minor coordinate rises.
            SCREEN + 8'h19: screen = GET | MINOR;
            SCREEN + 8'h1a: screen = NEG | MINOR | FLAG;
            SCREEN + 8'h1b: screen = ADD | SIZE_MINOR | FLAG;
            SCREEN + 8'h1c: screen = PUT | MINOR;
            SCREEN + 8'h1d: screen = ADD | M;
            SCREEN + 8'h1e: screen = STOP | NEGATIVE;
            SCREEN + 8'h1f: screen = GET | SIZE_MINOR;
            SCREEN + 8'h20: screen = SUB | MINOR;
            SCREEN + 8'h21: screen = STOP | NEGATIVE;
            SCREEN + 8'h22: screen = PUT | HIGHEST;
            SCREEN + 8'h23: screen = GET | MAJOR;
            SCREEN + 8'h24: screen = ADD | N;
            SCREEN + 8'h25: screen = STOP | NEGATIVE;
            // last = min(size - 1 - major, n), first = max(-major, 0).
            SCREEN + 8'h26: screen = GET | SIZE_MAJOR;
            SCREEN + 8'h27: screen = SUB | MAJOR;
            SCREEN + 8'h28: screen = STOP | NEGATIVE;
            SCREEN + 8'h29: screen = SUB | N;
            SCREEN + 8'h2a: screen = CLEAR | POSITIVE;
            SCREEN + 8'h2b: screen = ADD | N;
            SCREEN + 8'h2c: screen = PUT | LAST;
            SCREEN + 8'h2d: screen = NEG | MAJOR;
            SCREEN + 8'h2e: screen = CLEAR | NEGATIVE;
            SCREEN + 8'h2f: screen = PUT | FIRST;
            // lo = -minor > 0: first = max(first, ceil(n (2 lo - 1) / (2 m))); rounded up: one more where r - 1 >= 0.
            ENTER + 8'd0: screen = GET | M;
            ENTER + 8'd1: screen = ADD | M;
            ENTER + 8'd2: screen = PUT | DIVISOR;
            ENTER + 8'd3: screen = GET | MINOR;
            ENTER + 8'd4: screen = JUMP | to(LEAVE) | POSITIVE;
            ENTER + 8'd5: screen = NEG | MINOR;
            ENTER + 8'd6: screen = SUB_1 | MINOR;
            ENTER + 8'd7: screen = PUT | FACTOR;
            ENTER + 8'd8: screen = GET | N;
            ENTER + 8'd9: screen = DIVIDE_BY;
            ENTER + 8'd10: screen = DECREASE;
            ENTER + 8'd11: screen = ROUNDED;
            ENTER + 8'd12: screen = SUB | FIRST;
            ENTER + 8'd13: screen = CLEAR | NEGATIVE;
            ENTER + 8'd14: screen = ADD | FIRST;
            ENTER + 8'd15: screen = PUT | FIRST;
            // hi < m: last = min(last, ceil(n (2 hi + 1) / (2 m)) - 1).
            LEAVE + 8'd0: screen = GET | HIGHEST;
            LEAVE + 8'd1: screen = SUB | M;
            LEAVE + 8'd2: screen = JUMP | to(VISIBLE) | POSITIVE;
            LEAVE + 8'd3: screen = GET | HIGHEST;
            LEAVE + 8'd4: screen = ADD_1 | HIGHEST;
            LEAVE + 8'd5: screen = PUT | FACTOR;
            LEAVE + 8'd6: screen = GET | N;
            LEAVE + 8'd7: screen = DIVIDE_BY;
            LEAVE + 8'd8: screen = DECREASE;
            LEAVE + 8'd9: screen = ROUNDED;
            LEAVE + 8'd10: screen = DECREASE;
            LEAVE + 8'd11: screen = SUB | LAST;
            LEAVE + 8'd12: screen = CLEAR | POSITIVE;
            LEAVE + 8'd13: screen = ADD | LAST;
            LEAVE + 8'd14: screen = PUT | LAST;
            // What is visible: steps, rise, turn, the first major coordinate.
            VISIBLE + 8'h00: screen = GET | LAST;
            VISIBLE + 8'h01: screen = SUB | FIRST;
            VISIBLE + 8'h02: screen = STOP | NEGATIVE;
            VISIBLE + 8'h03: screen = OUTPUT | code_t'(2);
            VISIBLE + 8'h04: screen = GET | M;
            VISIBLE + 8'h05: screen = OUTPUT | code_t'(3);
            VISIBLE + 8'h06: screen = SUB | N;
            VISIBLE + 8'h07: screen = PUT | TURN;
            VISIBLE + 8'h08: screen = OUTPUT | code_t'(4);
            VISIBLE + 8'h09: screen = GET | MAJOR;
            VISIBLE + 8'h0a: screen = ADD | FIRST;
            VISIBLE + 8'h0b: screen = OUTPUT | code_t'(0);
            VISIBLE + 8'h0c: screen = GET | FIRST;
            VISIBLE + 8'h0d: screen = DECREASE;
            VISIBLE + 8'h0e: screen = JUMP | to(WHOLE) | NEGATIVE;
            // 2 m first = q 2 n + r; q rounded to nearest is how far the minor coordinate went.
            VISIBLE + 8'h0f: screen = GET | N;
            VISIBLE + 8'h10: screen = ADD | N;
            VISIBLE + 8'h11: screen = PUT | DIVISOR;
            VISIBLE + 8'h12: screen = GET | M;
            VISIBLE + 8'h13: screen = ADD | M;
            VISIBLE + 8'h14: screen = PUT | FACTOR;
            VISIBLE + 8'h15: screen = GET | FIRST;
            VISIBLE + 8'h16: screen = DIVIDE_BY;
            VISIBLE + 8'h17: screen = SUB | N;
            VISIBLE + 8'h18: screen = PUT | SPARE;
            VISIBLE + 8'h19: screen = ROUNDED;
            VISIBLE + 8'h1a: screen = ADD | MINOR;
            VISIBLE + 8'h1b: screen = PUT | MINOR;
            // error = v mod 2 n - 2 n + 2 m, where v mod 2 n is r - n, or r + n where that is negative.
            VISIBLE + 8'h1c: screen = GET | SPARE;
            VISIBLE + 8'h1d: screen = ADD | DIVISOR | NEGATIVE;
            VISIBLE + 8'h1e: screen = ADD | TURN;
            VISIBLE + 8'h1f: screen = ADD | TURN;
            VISIBLE + 8'h20: screen = JUMP | to(ERROR);
            // From the line's beginning: error = 2 m - n.
            WHOLE + 8'd0: screen = GET | M;
            WHOLE + 8'd1: screen = ADD | TURN;
            ERROR + 8'd0: screen = OUTPUT | code_t'(5);
            ERROR + 8'd1: screen = GET | MINOR;
            ERROR + 8'd2: screen = NEG | MINOR | FLAG;
            ERROR + 8'd3: screen = ADD | SIZE_MINOR | FLAG;
            ERROR + 8'd4: screen = OUTPUT | code_t'(1);
            ERROR + 8'd5: screen = STOP;
            default: screen = STOP;
        endcase
    endfunction
