//! The board: harts, memory and the player's `Board`.

use core::cell::UnsafeCell;
use core::convert::Infallible;

use embedded_hal::delay::DelayNs;
use mipidsi::options::{Orientation, Rotation};
use player::fault::Fault;
use player::pair::Mailbox;
use player::play::{Board, Storage, play};
use player::spi_card::{SpiCard, Traffic};
use scanout_assets::text::{Value, fill};
use scanout_display::init::Setup;
use scanout_display::spi::{SpiError, SpiLink};

use crate::chip::{self, CONSOLE, Clock, RESET};
use crate::spi::{CardSpi, DataCommand, DisplayBus};

rv64::start! {
    harts: 0, 1;
    main: run;
    second: serve;
    say: say;
    stop: stop;
}

/// The second hart.
static HARTS: Mailbox = Mailbox::new();

/// The chip has 6 MB: 4,000 positions, 8,000 triangles, the largest texture (1024 x 1024 texels); bands of 16 lines.
type Memory = Storage<4000, 8000, 1_048_576, 5120>;

struct Once(UnsafeCell<Memory>);

// SAFETY: `run` alone takes it, once, on the first hart.
unsafe impl Sync for Once {}

static MEMORY: Once = Once(UnsafeCell::new(Memory::new()));

type Display = SpiLink<DisplayBus, DataCommand>;

struct MaixDock {
    card: SpiCard<CardSpi, Clock>,
    display: Display,
}

impl Board for MaixDock {
    type Card = SpiCard<CardSpi, Clock>;
    type Bus = Display;
    type Harts = Mailbox;

    fn parts(&mut self) -> (&Self::Card, &mut Display, &Mailbox) {
        (&self.card, &mut self.display, &HARTS)
    }

    fn start_display(&mut self) -> Result<(), SpiError<Infallible, Infallible>> {
        RESET.set(false);
        Clock {}.delay_ms(10);
        RESET.set(true);
        Clock {}.delay_ms(120);
        let orientation = Orientation::new().rotate(Rotation::Deg90);
        Setup { orientation, ..Setup::default() }.start(&mut self.display, &mut Clock {})
    }

    fn say(&mut self, text: &[u8]) {
        CONSOLE.write(text);
    }

    fn frame_sent(&mut self, number: u32) {
        if number == 1 {
            let Traffic { bytes, commands } = self.card.traffic();
            fill(
                "card until the first frame: % bytes on the wires, % commands\n",
                &[Value::Number(bytes as usize), Value::Number(commands as usize)],
                &mut |text| self.say(text),
            );
        }
    }

    fn again(&mut self, _fault: &Fault) -> bool {
        Clock {}.delay_ms(1000);
        true
    }
}

/// Everything, on the first hart.
fn run() -> ! {
    chip::start();
    let mut board = MaixDock {
        card: SpiCard::new(CardSpi::new(), Clock {}),
        display: SpiLink::new(DisplayBus::new(), DataCommand),
    };
    board.say(b"scanout on Maix Dock\n");
    // SAFETY: `start` calls this once, on one hart; nothing else touches the cell.
    let memory = unsafe { &mut *MEMORY.0.get() };
    // Faults are tried again for ever, so this ends when the frames that were asked for are shown.
    let _ = play(&mut board, &mut memory.lend());
    board.say(b"done\n");
    stop()
}

fn serve() -> ! {
    HARTS.serve()
}

fn say(text: &[u8]) {
    CONSOLE.write(text);
}

fn stop() -> ! {
    loop {
        core::hint::spin_loop();
    }
}
