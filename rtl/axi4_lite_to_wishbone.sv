// Control: AXI4-Lite on one side, Wishbone (B4, classic) on the other, 32 bits.
//
// AXI's byte addresses become word addresses. One access at a time; a write when both its address and its data are there, and
// before a read that comes in the same clock. An error on Wishbone is SLVERR on AXI. Protection bits are ignored.
// Five clocks a write, five a read, with a Wishbone that answers in one.
`default_nettype none

module axi4_lite_to_wishbone #(
    parameter int W_ADR = 13
) (
    input  wire logic             clk,
    input  wire logic             rst_n,
    input  wire logic             s_axi_awvalid,
    output logic                  s_axi_awready,
    input  wire logic [W_ADR+1:0] s_axi_awaddr,
    input  wire logic             s_axi_wvalid,
    output logic                  s_axi_wready,
    input  wire logic [     31:0] s_axi_wdata,
    input  wire logic [      3:0] s_axi_wstrb,
    output logic                  s_axi_bvalid,
    input  wire logic             s_axi_bready,
    output logic      [      1:0] s_axi_bresp,
    input  wire logic             s_axi_arvalid,
    output logic                  s_axi_arready,
    input  wire logic [W_ADR+1:0] s_axi_araddr,
    output logic                  s_axi_rvalid,
    input  wire logic             s_axi_rready,
    output logic      [     31:0] s_axi_rdata,
    output logic      [      1:0] s_axi_rresp,
    output logic                  wb_cyc,
    output logic                  wb_stb,
    output logic                  wb_we,
    output logic      [W_ADR-1:0] wb_adr,
    output logic      [      3:0] wb_sel,
    output logic      [     31:0] wb_dat_w,
    input  wire logic [     31:0] wb_dat_r,
    input  wire logic             wb_ack,
    input  wire logic             wb_err
);
    logic idle;
    logic write;
    logic read;

    assign idle          = !wb_cyc && !s_axi_bvalid && !s_axi_rvalid;
    assign write         = idle && s_axi_awvalid && s_axi_wvalid;
    assign read          = idle && s_axi_arvalid && !write;
    assign s_axi_awready = write;
    assign s_axi_wready  = write;
    assign s_axi_arready = read;
    assign wb_stb        = wb_cyc;

    always_ff @(posedge clk) begin
        if (write) begin
            wb_adr   <= s_axi_awaddr[W_ADR+1:2];
            wb_dat_w <= s_axi_wdata;
        end else if (read) begin
            wb_adr <= s_axi_araddr[W_ADR+1:2];
        end
        if (write || read) begin
            wb_cyc <= 1'b1;
            wb_we  <= write;
            wb_sel <= write ? s_axi_wstrb : 4'hf;
        end
        if (wb_cyc && (wb_ack || wb_err)) begin
            wb_cyc       <= 1'b0;
            s_axi_bvalid <= wb_we;
            s_axi_rvalid <= !wb_we;
            s_axi_bresp  <= {wb_err, 1'b0};
            s_axi_rresp  <= {wb_err, 1'b0};
            s_axi_rdata  <= wb_dat_r;
        end
        if (s_axi_bvalid && s_axi_bready) s_axi_bvalid <= 1'b0;
        if (s_axi_rvalid && s_axi_rready) s_axi_rvalid <= 1'b0;
        if (!rst_n) begin
            wb_cyc       <= 1'b0;
            s_axi_bvalid <= 1'b0;
            s_axi_rvalid <= 1'b0;
        end
    end

    // A word's bytes are chosen by s_axi_wstrb.
    logic unused_bytes;
    assign unused_bytes = ^{s_axi_awaddr[1:0], s_axi_araddr[1:0]};
endmodule

`default_nettype wire
