// The words of clip's programs: what clip.sv decodes, and the names that clip_volume.svh and clip_screen.svh are written in.
// For clip_program.sv to include; `code_t` is W_CODE bits.

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

    // Where a jump goes.
    function automatic code_t to(input logic [7:0] target);
        to = {{(W_CODE - 8) {1'b0}}, target};
    endfunction
