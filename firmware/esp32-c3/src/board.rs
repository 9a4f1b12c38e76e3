//! Pins, the display, frames.

use core::cell::UnsafeCell;
use core::fmt::Write as _;

use embedded_hal_bus::spi::ExclusiveDevice;
use esp_hal::gpio::{Level, Output, OutputConfig};
use esp_hal::spi::Mode;
use esp_hal::spi::master::{Config, Spi};
use esp_hal::time::{Duration, Instant, Rate};
use esp_hal::uart::{self, Uart};
use mipidsi::Builder;
use mipidsi::models::ST7789;
use mipidsi::options::{Orientation, Rotation};
use player::scene::{self, HEIGHT, Model, Placement, TURN, WIDTH};
use scanout::frame::{Frame, ObjectState, Primitive, Settings, Store};
use scanout::math::Q16;
use scanout::transform::Vertex;
use scanout_assets::bake::{Aligned, BakeError, read};
use scanout_display::flush::show;
use scanout_display::spi::SpiLink;
use scanout_display::window::Area;

esp_bootloader_esp_idf::esp_app_desc!();

/// Lines of a band.
const LINES: usize = 16;

static MODELS: [(&Aligned<[u8]>, Q16); 2] = [
    (&Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/c.mesh"))), Q16::from_ratio(9, 10)),
    (&Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/a.mesh"))), Q16::from_ratio(35, 100)),
];

/// Model A's positions and triangles, and a band.
struct Memory {
    vertices: [Vertex; 400],
    primitives: [Primitive; 800],
    colour: [u16; WIDTH as usize * LINES],
    depth: [u16; WIDTH as usize * LINES],
}

struct Once(UnsafeCell<Memory>);

// SAFETY: `main` alone takes it, once, on the only core.
unsafe impl Sync for Once {}

static MEMORY: Once = Once(UnsafeCell::new(Memory {
    vertices: [Vertex::EMPTY; 400],
    primitives: [Primitive::EMPTY; 800],
    colour: [0; WIDTH as usize * LINES],
    depth: [0; WIDTH as usize * LINES],
}));

/// A delay by the system timer.
struct Timer;

impl embedded_hal::delay::DelayNs for Timer {
    fn delay_ns(&mut self, ns: u32) {
        let (start, wait) = (Instant::now(), Duration::from_micros(u64::from(ns).div_ceil(1000)));
        while start.elapsed() < wait {}
    }
}

#[esp_hal::main]
fn main() -> ! {
    let chip = esp_hal::init(esp_hal::Config::default());
    // SAFETY: taken here, the first time and the only one.
    let memory = unsafe { &mut *MEMORY.0.get() };
    let Ok(serial) = Uart::new(chip.UART0, uart::Config::default()) else { sleep() };
    let mut serial = serial.with_tx(chip.GPIO21);
    let clock = Config::default().with_frequency(Rate::from_mhz(40)).with_mode(Mode::_0);
    let Ok(bus) = Spi::new(chip.SPI2, clock) else {
        let _ = writeln!(serial, "fault: SPI2 takes no clock of 40 MHz");
        sleep()
    };
    let bus = bus.with_sck(chip.GPIO6).with_mosi(chip.GPIO7);
    let pin = OutputConfig::default();
    let Ok(device) = ExclusiveDevice::new_no_delay(bus, Output::new(chip.GPIO10, Level::High, pin));
    let link = SpiLink::new(device, Output::new(chip.GPIO4, Level::Low, pin));
    let display = Builder::new(ST7789, link)
        .reset_pin(Output::new(chip.GPIO5, Level::High, pin))
        .orientation(Orientation::new().rotate(Rotation::Deg90))
        .init(&mut Timer);
    let Ok(display) = display else {
        let _ = writeln!(serial, "fault: the display can't be started; check its wires");
        sleep()
    };
    let (mut link, ..) = display.release();
    loop {
        for (bytes, scale) in MODELS {
            let model = match baked(&bytes.0) {
                Ok(model) => model,
                Err(error) => {
                    let _ = writeln!(serial, "fault: {error}");
                    sleep()
                }
            };
            for number in 0..TURN {
                let shown = scene::with_scene(&model, scale, number, |scene| {
                    let mut objects = [ObjectState::default()];
                    let Memory { vertices, primitives, colour, depth } = &mut *memory;
                    let store = Store { vertices, primitives, objects: &mut objects };
                    let frame = Frame::prepare(scene, Settings::new(WIDTH, HEIGHT), store).ok()?;
                    show(&frame, &mut link, Area::LANDSCAPE, colour, depth, |_| ()).ok()
                });
                if shown.is_none() {
                    let _ = writeln!(serial, "fault: the frame could not be shown");
                }
            }
        }
    }
}

/// The model of baked bytes.
fn baked(bytes: &'static [u8]) -> Result<Model<'static>, BakeError> {
    let baked = read(bytes)?;
    let part = baked.part(0).ok_or(BakeError::Magic)?;
    let texture = part.texture.and_then(|index| baked.texture(index));
    let placement = Placement { scale: baked.scale(), offset: baked.offset() };
    Ok(Model { mesh: part.mesh, texture, placement })
}

fn sleep() -> ! {
    loop {
        core::hint::spin_loop();
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    sleep()
}
