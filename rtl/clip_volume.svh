// Clip's program `volume`: a line against the near plane, the far plane and the guard band. The equations are in clip.sv.
//
// Registers: w, x, y, z of end a at 0, 2, 4, 6 and of end b at 1, 3, 5, 7; distances of the ends from the plane, 8 and 9; 2^13 w of the
// ends, 10 and 11. END flips bit 0, so that base 0 is the end inside and base 1 the one outside; AXIS adds 0 to 3 for w, x, y, z.

    localparam code_t W = code_t'(0);
    localparam code_t X = code_t'(2);
    localparam code_t Y = code_t'(4);
    localparam code_t Z = code_t'(6);
    localparam code_t B = code_t'(1);
    localparam code_t DISTANCE = code_t'(8);
    localparam code_t BOUND = code_t'(10);
    localparam code_t IN = END;
    localparam code_t OUT = B | END;

    localparam logic [7:0] VOLUME = 8'h00;
    localparam logic [7:0] GIVE = 8'h3c;
    localparam logic [7:0] CUT = 8'h50;
    localparam logic [7:0] CUT_AXIS = CUT + 8'd9;

    function automatic code_t volume(input logic [7:0] at);
        case (at)
            VOLUME + 8'h00: volume = TAKE | W;
            VOLUME + 8'h01: volume = TAKE | X;
            VOLUME + 8'h02: volume = TAKE | Y;
            VOLUME + 8'h03: volume = TAKE | Z;
            VOLUME + 8'h04: volume = TAKE | W | B;
            VOLUME + 8'h05: volume = TAKE | X | B;
            VOLUME + 8'h06: volume = TAKE | Y | B;
            VOLUME + 8'h07: volume = TAKE | Z | B;
            VOLUME + 8'h08: volume = GET | W;
            VOLUME + 8'h09: volume = GUARD | BOUND;
            VOLUME + 8'h0a: volume = GET | W | B;
            VOLUME + 8'h0b: volume = GUARD | BOUND | B;
            // Near: min(z, w - 1) = z + min(w - 1 - z, 0).
            VOLUME + 8'h0c: volume = GET | W;
            VOLUME + 8'h0d: volume = SUB_1 | Z;
            VOLUME + 8'h0e: volume = CLEAR | POSITIVE;
            VOLUME + 8'h0f: volume = ADD | Z;
            VOLUME + 8'h10: volume = PUT | DISTANCE;
            VOLUME + 8'h11: volume = GET | W | B;
            VOLUME + 8'h12: volume = SUB_1 | Z | B;
            VOLUME + 8'h13: volume = CLEAR | POSITIVE;
            VOLUME + 8'h14: volume = ADD | Z | B;
            VOLUME + 8'h15: volume = PUT | DISTANCE | B;
            VOLUME + 8'h16: volume = CALL | to(CUT);
            // Far: w - z.
            VOLUME + 8'h17: volume = GET | W;
            VOLUME + 8'h18: volume = SUB | Z;
            VOLUME + 8'h19: volume = PUT | DISTANCE;
            VOLUME + 8'h1a: volume = GET | W | B;
            VOLUME + 8'h1b: volume = SUB | Z | B;
            VOLUME + 8'h1c: volume = PUT | DISTANCE | B;
            VOLUME + 8'h1d: volume = CALL | to(CUT);
            // The guard band's four sides: 2^13 w + x, 2^13 w - x, and with y.
            VOLUME + 8'h1e: volume = GET | BOUND;
            VOLUME + 8'h1f: volume = ADD | X;
            VOLUME + 8'h20: volume = PUT | DISTANCE;
            VOLUME + 8'h21: volume = GET | BOUND | B;
            VOLUME + 8'h22: volume = ADD | X | B;
            VOLUME + 8'h23: volume = PUT | DISTANCE | B;
            VOLUME + 8'h24: volume = CALL | to(CUT);
            VOLUME + 8'h25: volume = GET | BOUND;
            VOLUME + 8'h26: volume = SUB | X;
            VOLUME + 8'h27: volume = PUT | DISTANCE;
            VOLUME + 8'h28: volume = GET | BOUND | B;
            VOLUME + 8'h29: volume = SUB | X | B;
            VOLUME + 8'h2a: volume = PUT | DISTANCE | B;
            VOLUME + 8'h2b: volume = CALL | to(CUT);
            VOLUME + 8'h2c: volume = GET | BOUND;
            VOLUME + 8'h2d: volume = ADD | Y;
            VOLUME + 8'h2e: volume = PUT | DISTANCE;
            VOLUME + 8'h2f: volume = GET | BOUND | B;
            VOLUME + 8'h30: volume = ADD | Y | B;
            VOLUME + 8'h31: volume = PUT | DISTANCE | B;
            VOLUME + 8'h32: volume = CALL | to(CUT);
            VOLUME + 8'h33: volume = GET | BOUND;
            VOLUME + 8'h34: volume = SUB | Y;
            VOLUME + 8'h35: volume = PUT | DISTANCE;
            VOLUME + 8'h36: volume = GET | BOUND | B;
            VOLUME + 8'h37: volume = SUB | Y | B;
            VOLUME + 8'h38: volume = PUT | DISTANCE | B;
            VOLUME + 8'h39: volume = CALL | to(CUT);
            // What is left: end a, whose w is 1 or more, as the near plane has seen to; then end b.
            VOLUME + 8'h3a: volume = GET | W;
            VOLUME + 8'h3b: volume = TAKE_END;
            // Coordinates within 2^13 w: v + min(2^13 w - v, 0), then v - min(v + 2^13 w, 0). w and z lie within anyway.
            GIVE + 8'd0: volume = GET | BOUND | END;
            GIVE + 8'd1: volume = SUB | IN | AXIS;
            GIVE + 8'd2: volume = CLEAR | POSITIVE;
            GIVE + 8'd3: volume = ADD | IN | AXIS;
            GIVE + 8'd4: volume = PUT | IN | AXIS;
            GIVE + 8'd5: volume = ADD | BOUND | END;
            GIVE + 8'd6: volume = CLEAR | POSITIVE;
            GIVE + 8'd7: volume = PUT | SPARE;
            GIVE + 8'd8: volume = GET | IN | AXIS;
            GIVE + 8'd9: volume = SUB | SPARE;
            GIVE + 8'd10: volume = OUTPUT;
            GIVE + 8'd11: volume = NEXT_AXIS;
            GIVE + 8'd12: volume = JUMP | to(GIVE) | MORE_AXES;
            GIVE + 8'd13: volume = STOP | AT_END;
            GIVE + 8'd14: volume = NEG | W;
            GIVE + 8'd15: volume = TAKE_END;
            GIVE + 8'd16: volume = JUMP | to(GIVE);

            // The ends against one plane.
            CUT + 8'd0: volume = GET | DISTANCE;
            CUT + 8'd1: volume = TAKE_END;
            CUT + 8'd2: volume = GET | DISTANCE | IN;
            CUT + 8'd3: volume = STOP | NEGATIVE;
            CUT + 8'd4: volume = GET | DISTANCE | OUT;
            CUT + 8'd5: volume = RETURN | POSITIVE;
            CUT + 8'd6: volume = GET | DISTANCE | IN;
            CUT + 8'd7: volume = SUB | DISTANCE | OUT;
            CUT + 8'd8: volume = PUT | DIVISOR;
            // From the lower coordinate upwards, as rounding to nearest is the same from both: the factor is that end's distance.
            CUT_AXIS + 8'd0: volume = GET | OUT | AXIS;
            CUT_AXIS + 8'd1: volume = SUB | IN | AXIS;
            CUT_AXIS + 8'd2: volume = TAKE_FLAG;
            CUT_AXIS + 8'd3: volume = GET | DISTANCE | IN;
            CUT_AXIS + 8'd4: volume = NEG | DISTANCE | OUT | FLAG;
            CUT_AXIS + 8'd5: volume = PUT | FACTOR;
            CUT_AXIS + 8'd6: volume = GET | OUT | AXIS;
            CUT_AXIS + 8'd7: volume = SUB | IN | AXIS;
            CUT_AXIS + 8'd8: volume = GET | IN | AXIS | FLAG;
            CUT_AXIS + 8'd9: volume = SUB | OUT | AXIS | FLAG;
            CUT_AXIS + 8'd10: volume = DIVIDE_BY;
            CUT_AXIS + 8'd11: volume = TWICE_SUB | DIVISOR;
            CUT_AXIS + 8'd12: volume = ROUNDED;
            CUT_AXIS + 8'd13: volume = ADD | IN | AXIS | NO_FLAG;
            CUT_AXIS + 8'd14: volume = ADD | OUT | AXIS | FLAG;
            CUT_AXIS + 8'd15: volume = PUT | OUT | AXIS;
            CUT_AXIS + 8'd16: volume = NEXT_AXIS;
            CUT_AXIS + 8'd17: volume = JUMP | to(CUT_AXIS) | MORE_AXES;
            CUT_AXIS + 8'd18: volume = GET | W | OUT;
            CUT_AXIS + 8'd19: volume = GUARD | BOUND | OUT;
            CUT_AXIS + 8'd20: volume = RETURN;
            default: volume = STOP;
        endcase
    endfunction
