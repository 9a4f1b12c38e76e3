// Control: the register file behind Wishbone. Written by rtl/cosim/examples/registers.rs from the description in
// rtl/cosim/src/registers.rs, which also gives rtl/registers.md: change that, not this.
//
// Wishbone B4, classic cycles, 32 bits, addresses in words. wb_ack or wb_err comes one clock after wb_stb; wb_err means that there
// is no register at this address, or that a window was read. wb_sel chooses bytes of registers; windows take whole words.
// A window's word is written with NAME_write, window_index and window_data, in the clock of wb_ack.
`default_nettype none

module control_registers (
    input  wire logic clk,
    input  wire logic rst_n,
    input  wire logic wb_cyc,
    input  wire logic wb_stb,
    input  wire logic wb_we,
    input  wire logic [12:0] wb_adr,
    input  wire logic [3:0] wb_sel,
    input  wire logic [31:0] wb_dat_w,
    output logic [31:0] wb_dat_r,
    output logic wb_ack,
    output logic wb_err,
    input  wire logic [15:0] size_width,
    input  wire logic [15:0] size_height,
    output logic control_run,
    output logic control_spin,
    output logic control_camera,
    output logic [2:0] control_arrangement,
    output logic control_commit,
    input  wire logic status_drawing,
    input  wire logic status_committed,
    input  wire logic status_late,
    input  wire logic status_incomplete,
    input  wire logic [31:0] pictures,
    input  wire logic [31:0] clocks,
    output logic [23:0] ink,
    output logic [23:0] background,
    output logic [15:0] model_vertices,
    output logic [15:0] model_edges,
    output logic [9:0] speed,
    input  wire logic [9:0] angle,
    input  wire logic [1:0] features_way,
    input  wire logic [1:0] features_stereo,
    output logic [23:0] palette0,
    output logic [23:0] palette1,
    output logic [23:0] palette2,
    output logic [23:0] palette3,
    output logic [11:0] window_index,
    output logic [31:0] window_data,
    output logic matrix_write,
    output logic spin_write,
    output logic vertex_write,
    output logic edge_write
);
    logic request;
    logic write;
    logic known;
    logic [31:0] mask;
    logic [31:0] read;
    logic status_late_seen;
    logic status_incomplete_seen;

    assign request = wb_cyc && wb_stb && !wb_ack && !wb_err;
    assign write   = request && wb_we;
    assign mask    = {{8{wb_sel[3]}}, {8{wb_sel[2]}}, {8{wb_sel[1]}}, {8{wb_sel[0]}}};

    always_comb begin
        known = 1'b1;
        read  = '0;
        case (wb_adr)
            13'h0000: begin
                read = 32'h53434f31;
            end
            13'h0001: begin
                read[0+:16] = size_width;
                read[16+:16] = size_height;
            end
            13'h0002: begin
                read[0+:1] = control_run;
                read[1+:1] = control_spin;
                read[2+:1] = control_camera;
                read[4+:3] = control_arrangement;
            end
            13'h0003: begin
                read[0+:1] = status_drawing;
                read[1+:1] = status_committed;
                read[2+:1] = status_late_seen;
                read[3+:1] = status_incomplete_seen;
            end
            13'h0004: begin
                read = pictures;
            end
            13'h0005: begin
                read = clocks;
            end
            13'h0006: begin
                read[0+:24] = ink;
            end
            13'h0007: begin
                read[0+:24] = background;
            end
            13'h0008: begin
                read[0+:16] = model_vertices;
                read[16+:16] = model_edges;
            end
            13'h0009: begin
                read[0+:10] = speed;
            end
            13'h000a: begin
                read[0+:10] = angle;
            end
            13'h000b: begin
                read[0+:2] = features_way;
                read[4+:2] = features_stereo;
            end
            13'h000c: begin
                read[0+:24] = palette0;
            end
            13'h000d: begin
                read[0+:24] = palette1;
            end
            13'h000e: begin
                read[0+:24] = palette2;
            end
            13'h000f: begin
                read[0+:24] = palette3;
            end
            default: known = 1'b0;
        endcase
        if (wb_adr[12:5] == 8'h8) known = wb_we;
        if (wb_adr[12:9] == 4'h1) known = wb_we;
        if (wb_adr[12:11] == 2'h1) known = wb_we;
        if (wb_adr[12:12] == 1'h1) known = wb_we;
    end

    always_ff @(posedge clk) begin
        wb_ack       <= request && known;
        wb_err       <= request && !known;
        wb_dat_r     <= read;
        window_index <= wb_adr[11:0];
        window_data  <= wb_dat_w;
        matrix_write <= write && wb_adr[12:5] == 8'h8;
        spin_write <= write && wb_adr[12:9] == 4'h1;
        vertex_write <= write && wb_adr[12:11] == 2'h1;
        edge_write <= write && wb_adr[12:12] == 1'h1;
        if (write && wb_adr == 13'h0002) control_run <= (control_run & ~mask[0+:1]) | (wb_dat_w[0+:1] & mask[0+:1]);
        if (write && wb_adr == 13'h0002) control_spin <= (control_spin & ~mask[1+:1]) | (wb_dat_w[1+:1] & mask[1+:1]);
        if (write && wb_adr == 13'h0002) control_camera <= (control_camera & ~mask[2+:1]) | (wb_dat_w[2+:1] & mask[2+:1]);
        if (write && wb_adr == 13'h0002) control_arrangement <= (control_arrangement & ~mask[4+:3]) | (wb_dat_w[4+:3] & mask[4+:3]);
        control_commit <= write && wb_adr == 13'h0002 && wb_dat_w[8] && mask[8];
        status_late_seen <= (status_late_seen & ~({1{write && wb_adr == 13'h0003}} & wb_dat_w[2+:1] & mask[2+:1])) | status_late;
        status_incomplete_seen <= (status_incomplete_seen & ~({1{write && wb_adr == 13'h0003}} & wb_dat_w[3+:1] & mask[3+:1])) | status_incomplete;
        if (write && wb_adr == 13'h0006) ink <= (ink & ~mask[0+:24]) | (wb_dat_w[0+:24] & mask[0+:24]);
        if (write && wb_adr == 13'h0007) background <= (background & ~mask[0+:24]) | (wb_dat_w[0+:24] & mask[0+:24]);
        if (write && wb_adr == 13'h0008) model_vertices <= (model_vertices & ~mask[0+:16]) | (wb_dat_w[0+:16] & mask[0+:16]);
        if (write && wb_adr == 13'h0008) model_edges <= (model_edges & ~mask[16+:16]) | (wb_dat_w[16+:16] & mask[16+:16]);
        if (write && wb_adr == 13'h0009) speed <= (speed & ~mask[0+:10]) | (wb_dat_w[0+:10] & mask[0+:10]);
        if (write && wb_adr == 13'h000c) palette0 <= (palette0 & ~mask[0+:24]) | (wb_dat_w[0+:24] & mask[0+:24]);
        if (write && wb_adr == 13'h000d) palette1 <= (palette1 & ~mask[0+:24]) | (wb_dat_w[0+:24] & mask[0+:24]);
        if (write && wb_adr == 13'h000e) palette2 <= (palette2 & ~mask[0+:24]) | (wb_dat_w[0+:24] & mask[0+:24]);
        if (write && wb_adr == 13'h000f) palette3 <= (palette3 & ~mask[0+:24]) | (wb_dat_w[0+:24] & mask[0+:24]);
        if (!rst_n) begin
            wb_ack <= 1'b0;
            wb_err <= 1'b0;
            control_run <= 1'h1;
            control_spin <= 1'h1;
            control_camera <= 1'h0;
            control_arrangement <= 3'h0;
            control_commit <= 1'h0;
            status_late_seen <= '0;
            status_incomplete_seen <= '0;
            ink <= 24'hffffff;
            background <= 24'h0;
            model_vertices <= 16'h0;
            model_edges <= 16'h0;
            speed <= 10'h4;
            palette0 <= 24'hffffff;
            palette1 <= 24'hff0000;
            palette2 <= 24'hff00;
            palette3 <= 24'hff;
            matrix_write <= 1'b0;
            spin_write <= 1'b0;
            vertex_write <= 1'b0;
            edge_write <= 1'b0;
        end
    end
endmodule

`default_nettype wire
