// The PLL of the ECP5: 25 MHz times 20 is 500 MHz, divided by 4, 20 and 5.
`default_nettype none

module ulx3s_clocks (
    input  wire logic clk_25mhz,
    output logic      clk_5x,
    output logic      clk_pixel,
    output logic      clk,
    output logic      locked
);
    (* FREQUENCY_PIN_CLKI = "25", FREQUENCY_PIN_CLKOP = "125", FREQUENCY_PIN_CLKOS = "25", FREQUENCY_PIN_CLKOS2 = "100",
       ICP_CURRENT = "12", LPF_RESISTOR = "8", MFG_ENABLE_FILTEROPAMP = "1", MFG_GMCREF_SEL = "2" *)
    EHXPLLL #(
        .PLLRST_ENA    ("DISABLED"),
        .INTFB_WAKE    ("DISABLED"),
        .STDBY_ENABLE  ("DISABLED"),
        .DPHASE_SOURCE ("DISABLED"),
        .OUTDIVIDER_MUXA("DIVA"),
        .OUTDIVIDER_MUXB("DIVB"),
        .OUTDIVIDER_MUXC("DIVC"),
        .OUTDIVIDER_MUXD("DIVD"),
        .CLKI_DIV      (1),
        .CLKFB_DIV     (5),
        .FEEDBK_PATH   ("CLKOP"),
        .CLKOP_ENABLE  ("ENABLED"),
        .CLKOP_DIV     (4),
        .CLKOP_CPHASE  (3),
        .CLKOP_FPHASE  (0),
        .CLKOS_ENABLE  ("ENABLED"),
        .CLKOS_DIV     (20),
        .CLKOS_CPHASE  (19),
        .CLKOS_FPHASE  (0),
        .CLKOS2_ENABLE ("ENABLED"),
        .CLKOS2_DIV    (5),
        .CLKOS2_CPHASE (4),
        .CLKOS2_FPHASE (0)
    ) i_pll (
        .RST         (1'b0),
        .STDBY       (1'b0),
        .CLKI        (clk_25mhz),
        .CLKFB       (clk_5x),
        .CLKOP       (clk_5x),
        .CLKOS       (clk_pixel),
        .CLKOS2      (clk),
        .PHASESEL0   (1'b0),
        .PHASESEL1   (1'b0),
        .PHASEDIR    (1'b1),
        .PHASESTEP   (1'b1),
        .PHASELOADREG(1'b1),
        .PLLWAKESYNC (1'b0),
        .ENCLKOP     (1'b0),
        .LOCK        (locked)
    );
endmodule

`default_nettype wire
