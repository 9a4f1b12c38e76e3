//! What the chip needs before anything else: clocks, pins, time, the serial port.

use embedded_hal::delay::DelayNs;
use rv64::clint;
use rv64::register::Register;
use rv64::uart::Uart;

const SYSCTL: usize = 0x5044_0000;
const PLL0: Register = Register(SYSCTL + 0x08);
const PLL_LOCK: Register = Register(SYSCTL + 0x18);
const CLK_SEL0: Register = Register(SYSCTL + 0x20);
const CLK_EN_CENT: Register = Register(SYSCTL + 0x28);
const CLK_EN_PERI: Register = Register(SYSCTL + 0x2c);
/// Dividers of the SPIs' clocks: SPI0 in bits 7 to 0, SPI1 in bits 15 to 8.
const CLK_TH1: Register = Register(SYSCTL + 0x3c);
const MISC: Register = Register(SYSCTL + 0x54);
const POWER_SEL: Register = Register(SYSCTL + 0x6c);
const FPIOA: usize = 0x502b_0000;
const GPIOHS: usize = 0x3800_1000;
/// UARTHS: messages.
pub const CONSOLE: Uart = Uart(0x3800_0000);

/// The processor's clock and that of the SPIs before their dividers, Hz: half of PLL0.
pub const CLOCK: u32 = 390_000_000;
/// Time: mtime takes a step in 50 of the processor's clock.
pub type Clock = clint::Clock<{ CLOCK as u64 / 50 / 100_000 }>;

/// FPIOA: an output with the strongest drive that is not slow, an input through a Schmitt trigger.
const OUTPUT: u32 = 0xf << 8 | 1 << 12;
const INPUT: u32 = 1 << 20 | 1 << 23;

/// Connects a pin with one of the 256 functions.
fn connect(pin: usize, function: u32, way: u32) {
    Register(FPIOA + 4 * pin).write(function | way);
}

/// Functions of the FPIOA.
const SPI0_SS3: u32 = 15;
const SPI0_SCLK: u32 = 17;
const UARTHS_TX: u32 = 19;
const GPIOHS0: u32 = 24;
const SPI1_D0: u32 = 70;
const SPI1_D1: u32 = 71;
const SPI1_SCLK: u32 = 83;

/// A pin of GPIOHS as an output.
#[derive(Clone, Copy)]
pub struct Pin(u32);

/// The display's D/C.
pub const DATA_COMMAND: Pin = Pin(0);
/// The display's reset, low when active.
pub const RESET: Pin = Pin(1);
/// The card's chip select, low when active.
pub const CARD_SELECT: Pin = Pin(2);

impl Pin {
    /// High or low.
    pub fn set(self, high: bool) {
        Register(GPIOHS + 0x0c).change(1 << self.0, u32::from(high) << self.0);
    }

    fn output(self, io: usize) {
        self.set(true);
        Register(GPIOHS + 0x08).change(0, 1 << self.0);
        connect(io, GPIOHS0 + self.0, OUTPUT);
    }
}

/// Clocks and pins. The first hart calls it once.
pub fn start() {
    // While the PLL changes, the processor runs from the 26 MHz of the crystal.
    CLK_SEL0.change(1, 0);
    // 26 MHz x 60 / 2 = 780 MHz: R 0, F 59, OD 1, bandwidth as F; powered (bit 21), output on (bit 25).
    let set = 59 << 4 | 1 << 10 | 59 << 14 | 1 << 21;
    PLL0.write(set);
    PLL0.write(set | 1 << 20);
    Clock {}.delay_us(10);
    PLL0.write(set);
    while PLL_LOCK.read() & 3 != 3 {
        PLL_LOCK.change(0, 1 << 2);
    }
    PLL0.write(set | 1 << 25);
    // The processor from PLL0 / 2.
    CLK_SEL0.change(0b111, 1);
    // The buses; GPIO, both SPIs, FPIOA.
    CLK_EN_CENT.change(0, 0b11_1111);
    CLK_EN_PERI.change(0, 1 << 5 | 1 << 6 | 1 << 7 | 1 << 20);
    CLK_TH1.change(0xffff, 0);
    // IO36 - IO47, where the display is, have 1.8 V; SPI0's data go to the display instead of the camera's port.
    POWER_SEL.change(0, 0b1100_0000);
    MISC.change(0, 1 << 10);

    connect(5, UARTHS_TX, OUTPUT);
    connect(36, SPI0_SS3, OUTPUT);
    connect(39, SPI0_SCLK, OUTPUT);
    RESET.output(37);
    DATA_COMMAND.output(38);
    connect(27, SPI1_SCLK, OUTPUT);
    connect(28, SPI1_D0, OUTPUT);
    // With a pull-up: a slot without a card must read as silence.
    connect(26, SPI1_D1, INPUT | 1 << 16);
    CARD_SELECT.output(29);

    CONSOLE.start(CLOCK / 115_200);
}
