//! The board: harts, time, memory, and the player's `Board`.

use core::cell::UnsafeCell;

use embedded_hal::delay::DelayNs;
use mipidsi::options::{Orientation, Rotation};
use player::fault::Fault;
use player::pair::Mailbox;
use player::play::{Board, Storage, play};
use player::spi_card::{SpiCard, Traffic};
use rv64::clint;
use rv64::start::stack_left;
use rv64::uart::Uart;
use scanout_assets::text::{Value, fill};
use scanout_display::init::Setup;
use scanout_display::spi::{SpiError, SpiLink};

use crate::display::{DataCommand, Wire};
use crate::sd::Qspi2;
use crate::semihosting::{Stuck, exit};

/// Time: mtime has 1 MHz.
pub type Clock = clint::Clock<10>;

/// UART0.
const CONSOLE: Uart = Uart(0x1001_0000);

rv64::start! {
    harts: 1, 2;
    main: run;
    second: serve;
    say: say;
    stop: stop;
}

/// The second hart.
static HARTS: Mailbox = Mailbox::new();

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
        Setup { orientation, ..Setup::default() }.start(&mut self.display, &mut Clock {})
    }

    fn say(&mut self, text: &[u8]) {
        CONSOLE.write(text);
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
        Clock {}.delay_ms(1000);
        self.faults += 1;
        // A machine in a box would try for ever; one in a test must end.
        self.faults < 5
    }
}

/// Everything, on the first hart.
fn run() -> ! {
    // 115,200 baud from 500 MHz; an emulator doesn't mind.
    CONSOLE.start(4341);
    let mut board = SifiveU {
        card: SpiCard::new(Qspi2::new(), Clock {}),
        display: SpiLink::new(Wire, DataCommand::new()),
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

fn serve() -> ! {
    HARTS.serve()
}

fn say(text: &[u8]) {
    CONSOLE.write(text);
}

fn stop() -> ! {
    exit(1)
}
