// Transform: mesh positions to clip coordinates, as the library's `ClipMatrix::apply`.
//
//   clip[row] = (m[row][0] px + m[row][1] py + m[row][2] pz + m[row][3] 2^15 + 2^14) >> 15
//
//   | s_position  | z, y, x: Q1.15 each, a word of `scanout bake`'s vertices.hex                            |
//   | m           | 16 words of 32 bits, one power of two in common; the sum of a row's sizes below 2^30 + 2  |
//   | m_data      | clip coordinates, a word each: w, x, y, z; 32 bits, signed, the same power of two          |
//   | s_tag, m_tag | whatever the caller wants to get back with each word of the result                       |
//
// A matrix entry is two signed digits, m = high 2^16 + low with high = (m >> 16) + m[15], so that every product is 16 x 16 bits with
// sign: one multiplier of any family.
//
//   | MULTIPLIERS | products at a time              | clocks a vertex |
//   | 1           | one                             | 28              |
//   | 3           | the three terms of a row        | 8               |
//   | 12          | the three terms of all rows     | 5: 4 words out  |
//
// The matrix has two banks. Words are written to the hidden one; `swap` exchanges them. Write all 16 words before each swap, and swap
// between frames: positions that are under way would see both. Words are read in the clock after their address, as block RAM does.
`default_nettype none

module transform #(
    parameter int MULTIPLIERS = 3,
    parameter int W_TAG       = 1
) (
    input  wire logic               clk,
    input  wire logic               rst_n,
    input  wire logic               write,
    input  wire logic [3:0]         write_address,
    input  wire logic [31:0]        write_data,
    input  wire logic               swap,
    input  wire logic               s_valid,
    output logic                    s_ready,
    input  wire logic [47:0]        s_position,
    input  wire logic [W_TAG-1:0]   s_tag,
    output logic                    m_valid,
    input  wire logic               m_ready,
    output logic signed [31:0]      m_data,
    output logic [W_TAG-1:0]        m_tag
);
    localparam int ROWS = MULTIPLIERS == 12 ? 4 : 1;
    localparam int TERMS = MULTIPLIERS == 1 ? 1 : 3;
    // Slots of a row: (term, digit) pairs and the translation one after the other, or both digits of all terms at once.
    localparam int SLOTS = TERMS == 1 ? 7 : 2;

    // Everything waits while a result isn't taken.
    logic       advance;
    logic [1:0] more;
    assign advance = !m_valid || (m_ready && more == '0);

    // Stage 0: which slot.
    logic             busy, bank;
    logic [1:0]       count, row;
    logic [2:0]       slot;
    logic [47:0]      position;
    logic [W_TAG-1:0] tag;
    logic             last_slot, last_row;
    assign last_slot = slot == 3'(SLOTS - 1);
    assign last_row  = ROWS == 4 || count == 2'd3;
    // w first.
    assign row       = count - 1'b1;
    assign s_ready   = advance && (!busy || (last_slot && last_row));

    always_ff @(posedge clk) begin
        if (!rst_n) begin
            busy <= 1'b0;
            bank <= 1'b0;
            count <= '0;
            slot <= '0;
        end else begin
            if (swap) bank <= !bank;
            if (s_ready) busy <= s_valid;
            if (advance && busy) begin
                slot <= last_slot ? '0 : slot + 1'b1;
                if (last_slot) count <= last_row ? '0 : count + 1'b1;
            end
        end
        if (s_ready) begin
            position <= s_position;
            tag      <= s_tag;
        end
    end

    // Stage 1: the matrix words, and the position's terms beside them. Stage 2: digits. Stage 3: products. Stage 4: their sum.
    // Stage 5: the row's sum.
    logic [1:0]         term;
    logic [2:0]         slot_1;
    logic               high_1, high_2, high_3, add_1, add_2;
    logic [4:1]         valid, last;
    logic [TERMS*16-1:0] terms_1, terms_2;
    assign term = TERMS == 1 ? slot[2:1] : 2'd0;

    always_ff @(posedge clk) begin
        if (!rst_n) valid <= '0;
        else if (advance) valid <= {valid[3:1], busy};
        if (advance) begin
            slot_1    <= slot;
            last      <= {last[3:1], last_slot};
            terms_1   <= TERMS == 1 ? (TERMS * 16)'(position[16*term+:16]) : (TERMS * 16)'(position);
            terms_2   <= terms_1;
            {high_3, high_2} <= {high_2, high_1};
            add_2     <= add_1;
        end
    end
    assign high_1 = !slot_1[0];
    // The slot of the translation; with three terms the low digits' slot has it too.
    assign add_1  = TERMS == 1 ? slot_1 == 3'd6 : slot_1[0];

    logic [32*ROWS-1:0] results;
    generate
        for (genvar r = 0; r < ROWS; r++) begin : g_row
            logic signed [47:0] sum_4, base, total;
            logic signed [47:0] shift_3;
            if (TERMS == 1) begin : g_one
                logic [31:0]        words[32];
                logic [31:0]        word_1;
                logic signed [15:0] digit_2;
                logic signed [31:0] product_3, offset_2, offset_3;
                logic               add_3;
                always_ff @(posedge clk) begin
                    if (write) words[{!bank, write_address}] <= write_data;
                    if (advance) begin
                        word_1    <= words[{bank, row, slot[2:1]}];
                        digit_2   <= high_1 ? word_1[31:16] + 16'(word_1[15]) : word_1[15:0];
                        offset_2  <= word_1;
                        product_3 <= digit_2 * $signed(terms_2);
                        offset_3  <= offset_2;
                        add_3     <= add_2;
                        sum_4     <= shift_3;
                    end
                end
                assign shift_3 = add_3 ? {offset_3[31], offset_3, 15'h4000}
                               : high_3 ? {product_3, 16'b0} : 48'(product_3);
            end else begin : g_three
                logic [95:0]        product_3;
                logic signed [31:0] x_3, y_3, z_3;
                assign {z_3, y_3, x_3} = product_3;
                logic signed [33:0] products;
                logic signed [31:0] offset_1, offset_2, offset_3;
                logic               add_3;
                for (genvar c = 0; c < 4; c++) begin : g_column
                    logic [31:0] word_1;
                    if (ROWS == 1) begin : g_memory
                        logic [31:0] words[8];
                        always_ff @(posedge clk) begin
                            if (write && write_address[1:0] == 2'(c)) words[{!bank, write_address[3:2]}] <= write_data;
                            if (advance) word_1 <= words[{bank, row}];
                        end
                    end else begin : g_registers
                        logic [31:0] even, odd;
                        always_ff @(posedge clk) begin
                            if (write && write_address == 4'(4 * r + c)) begin
                                if (bank) even <= write_data;
                                else odd <= write_data;
                            end
                            if (advance) word_1 <= bank ? odd : even;
                        end
                    end
                    if (c < 3) begin : g_product
                        logic signed [15:0] digit_2;
                        always_ff @(posedge clk) begin
                            if (advance) begin
                                digit_2             <= high_1 ? word_1[31:16] + 16'(word_1[15]) : word_1[15:0];
                                product_3[32*c+:32] <= digit_2 * $signed(terms_2[16*c+:16]);
                            end
                        end
                    end else begin : g_offset
                        assign offset_1 = word_1;
                    end
                end
                assign products = 34'(x_3) + 34'(y_3) + 34'(z_3);
                assign shift_3 = high_3 ? {products[31:0], 16'b0} : 48'(products) + {offset_3[31], offset_3, 15'h4000};
                always_ff @(posedge clk) begin
                    if (advance) begin
                        {offset_3, offset_2} <= {offset_2, offset_1};
                        add_3 <= add_2;
                        sum_4 <= shift_3;
                    end
                end
                logic unused_three;
                assign unused_three = &{1'b0, add_3, products[33:32]};
            end
            assign total = base + sum_4;
            always_ff @(posedge clk) begin
                if (advance && valid[4]) base <= last[4] ? '0 : total;
                if (!rst_n) base <= '0;
            end
            assign results[32*r+:32] = total[46:15];
            logic unused_total;
            assign unused_total = &{1'b0, total[47], total[14:0]};
        end
    endgenerate

    // Tags travel beside the rows; one vertex may be in stage 0 while another is still being summed.
    logic [W_TAG*4-1:0] tags;
    always_ff @(posedge clk) begin
        if (advance) tags <= (W_TAG * 4)'({tags, tag});
        if (advance && valid[4] && last[4]) m_tag <= tags[4*W_TAG-1-:W_TAG];
    end

    logic unused_row;
    assign unused_row = &{1'b0, row};

    generate
        if (ROWS == 1) begin : g_serial
            assign more = '0;
            always_ff @(posedge clk) begin
                if (!rst_n) m_valid <= 1'b0;
                else if (advance) m_valid <= valid[4] && last[4];
                if (advance && valid[4] && last[4]) m_data <= results;
            end
        end else begin : g_parallel
            // All rows at once: w goes out, the others follow.
            logic [95:0] waiting;
            always_ff @(posedge clk) begin
                if (advance) begin
                    m_valid <= valid[4] && last[4];
                    more    <= {2{valid[4] && last[4]}};
                    m_data  <= results[127:96];
                    waiting <= results[95:0];
                end else if (m_ready) begin
                    more    <= more - 1'b1;
                    m_data  <= waiting[31:0];
                    waiting <= waiting >> 32;
                end
                if (!rst_n) {m_valid, more} <= '0;
            end
        end
    endgenerate
endmodule

`default_nettype wire
