// Control: fills the transform's hidden bank with an eye's clip matrix, from the matrix memory or from spin.
//
//   matrix memory   two banks of 16 words an eye, the right eye's after the left's; a host writes the bank that is not in use
//   spin            the matrix of a turning model (spinning 1); the right eye's words are at 320 of its table instead of 256
//
//   | matrix_write   | a word of the host's into `!bank`; spin_write: into spin's table. `write_address` counts words in each     |
//   | start          | for a clock; then `fill` is high until `done`                                                             |
//   | m_             | the 16 words with their numbers, i32, as transform takes them                                             |
//
// Clocks, `start` and `done` among them: 19 from the memory, 1,045 from spin. BUS 0 leaves the matrix memory away, SPIN 0 spin.
`default_nettype none

module matrix_source #(
    parameter int BUS      = 1,
    parameter int SPIN     = 1,
    parameter     SPIN_HEX = ""
) (
    input  wire logic        clk,
    input  wire logic        rst_n,
    input  wire logic        matrix_write,
    input  wire logic        spin_write,
    input  wire logic [ 8:0] write_address,
    input  wire logic [31:0] write_word,
    input  wire logic        bank,
    input  wire logic        right,
    input  wire logic        spinning,
    input  wire logic [ 9:0] angle,
    input  wire logic        start,
    input  wire logic        fill,
    output logic             done,
    output logic             m_write,
    output logic      [ 3:0] m_address,
    output logic      [31:0] m_data
);
    // --------------------------------------------------------------------------------------------------------- matrix memory
    // Bank, eye, word.
    logic [ 5:0] matrix_read_address;
    logic [31:0] matrix_read;
    logic [ 5:0] matrix_write_address;
    logic [ 4:0] word;
    logic        fill_valid;
    logic [ 3:0] fill_address;
    assign matrix_read_address  = {bank, right, word[3:0]};
    assign matrix_write_address = {!bank, write_address[4:0]};

    generate
        if (BUS != 0) begin : g_matrix
            model_memory #(
                .W_WORD(32),
                .WORDS (64)
            ) i_matrix (
                .clk          (clk),
                .write        (matrix_write),
                .write_address(matrix_write_address),
                .write_word   (write_word),
                .read_address (matrix_read_address),
                .read_word    (matrix_read)
            );
        end else begin : g_no_matrix
            logic unused_matrix;
            assign unused_matrix = ^{matrix_read_address, matrix_write_address, matrix_write};
            assign matrix_read   = '0;
        end
    endgenerate

    always_ff @(posedge clk) begin
        if (start) word <= '0;
        else if (fill && !spinning) word <= word + 1'b1;
        fill_valid   <= fill && !spinning && !word[4];
        fill_address <= word[3:0];
    end

    // ------------------------------------------------------------------------------------------------------------------ spin
    logic        spin_start;
    logic        spin_done;
    logic        spin_valid;
    logic [ 3:0] spin_address;
    logic [31:0] spin_word;
    assign spin_start = start && spinning;

    generate
        if (SPIN != 0) begin : g_spin
            spin #(
                .HEX(SPIN_HEX)
            ) i_spin (
                .clk          (clk),
                .rst_n        (rst_n),
                .write        (spin_write),
                .write_address(write_address),
                .write_word   (write_word),
                .start        (spin_start),
                .angle        (angle),
                .right        (right),
                .m_write      (spin_valid),
                .m_address    (spin_address),
                .m_data       (spin_word),
                .done         (spin_done)
            );
        end else begin : g_no_spin
            logic unused_spin;
            assign unused_spin = ^{spin_write, spin_start, angle, write_address, rst_n};
            assign {spin_valid, spin_address, spin_word, spin_done} = '0;
        end
    endgenerate

    // Words of the memory come a clock after their address, so the last one is written when word is 17.
    assign done      = spinning ? spin_done : word == 5'd17;
    assign m_write   = spin_valid || fill_valid;
    assign m_address = spin_valid ? spin_address : fill_address;
    assign m_data    = spin_valid ? spin_word : matrix_read;
endmodule

`default_nettype wire
