//! The board: registers, time, memory, and the player's `Board`.

use core::cell::UnsafeCell;

use embedded_hal::delay::DelayNs;
use mipidsi::options::{Orientation, Rotation};
use player::fault::Fault;
use player::pair::Mailbox;
use player::play::{Board, Storage, play};
use player::spi_card::{SpiCard, Traffic};
use scanout_assets::text::{Value, fill};
use scanout_display::init::Setup;
use scanout_display::spi::{SpiError, SpiLink};

use crate::display::{DataCommand, Wire};
use crate::sd::Qspi2;
use crate::semihosting::{Stuck, exit};
use crate::start::stack_left;
use crate::uart::Console;

/// A register of 32 bits.
#[derive(Clone, Copy)]
pub struct Register(pub usize);

impl Register {
    /// Reads it.
    pub fn read(self) -> u32 {
        // SAFETY: the addresses in this crate are registers of the machine, see `main`.
        unsafe { (self.0 as *const u32).read_volatile() }
    }

    /// Writes it.
    pub fn write(self, value: u32) {
        // SAFETY: as above.
        unsafe { (self.0 as *mut u32).write_volatile(value) }
    }
}

/// Time.
#[derive(Clone, Copy)]
pub struct Clock;

impl Clock {
    /// Microseconds since reset: the CLINT's mtime.
    pub fn now() -> u64 {
        // SAFETY: as for `Register`; 64 bits at once on this machine.
        unsafe { (0x0200_bff8 as *const u64).read_volatile() }
    }
}

impl DelayNs for Clock {
    fn delay_ns(&mut self, ns: u32) {
        let end = Self::now() + u64::from(ns).div_ceil(1000);
        while Self::now() < end {
            core::hint::spin_loop();
        }
    }
}

/// The second hart.
pub static HARTS: Mailbox = Mailbox::new();

/// Memory for system B's largest models: 500 positions, 500 quads, 250 x 250 texels; bands of 6 lines.
type Memory = Storage<500, 1000, 62_500, 1920>;

struct Once(UnsafeCell<Memory>);

// SAFETY: `run` alone takes it, once, on the first hart.
unsafe impl Sync for Once {}

static MEMORY: Once = Once(UnsafeCell::new(Memory::new()));

type Display = SpiLink<Wire, DataCommand>;

struct SifiveU {
    card: SpiCard<Qspi2, Clock>,
    display: Display,
    console: Console,
    traffic: Traffic,
    faults: u32,
}

impl Board for SifiveU {
    type Card = SpiCard<Qspi2, Clock>;
    type Bus = Display;
    type Harts = Mailbox;

    fn parts(&mut self) -> (&Self::Card, &mut Display, &Mailbox) {
        (&self.card, &mut self.display, &HARTS)
    }

    fn start_display(&mut self) -> Result<(), SpiError<Stuck, core::convert::Infallible>> {
        let orientation = Orientation::new().rotate(Rotation::Deg90);
        Setup { orientation, ..Setup::default() }.start(&mut self.display, &mut Clock)
    }

    fn say(&mut self, text: &[u8]) {
        self.console.write(text);
    }

    fn frame_sent(&mut self, number: u32) {
        // When nobody takes it, the next transfer tells.
        let _ = Wire.end_frame();
        if number == 1 {
            self.traffic = self.card.traffic();
            let Traffic { bytes, commands } = self.traffic;
            fill(
                "card until the first frame: % bytes on the wires, % commands\n",
                &[Value::Number(bytes as usize), Value::Number(commands as usize)],
                &mut |text| self.say(text),
            );
        }
    }

    fn again(&mut self, _fault: &Fault) -> bool {
        Clock.delay_ms(1000);
        self.faults += 1;
        // A machine in a box would try for ever; one in a test must end.
        self.faults < 5
    }
}

/// Everything, on the first hart.
pub fn run() -> ! {
    let mut board = SifiveU {
        card: SpiCard::new(Qspi2::new(), Clock),
        display: SpiLink::new(Wire, DataCommand::new()),
        console: Console::start(),
        traffic: Traffic::default(),
        faults: 0,
    };
    fill(
        "scanout on sifive_u: % bytes of memory and % for texels\n",
        &[Value::Number(Memory::BYTES), Value::Number(size_of::<Memory>() - Memory::BYTES)],
        &mut |text| board.say(text),
    );
    // SAFETY: `start` calls this once, on one hart; nothing else touches the cell.
    let memory = unsafe { &mut *MEMORY.0.get() };
    let result = play(&mut board, &mut memory.lend());
    fill("stack never used: % and % bytes\n", &stack_left().map(Value::Number), &mut |text| {
        board.say(text)
    });
    board.say(if result.is_ok() { b"done\n" } else { b"given up\n" });
    exit(result.is_err().into())
}
