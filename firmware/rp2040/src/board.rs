//! Clocks, pins, the display, frames: for the RP2040 and the RP2350, whose `chip` modules name what differs.

use core::cell::UnsafeCell;

use crate::chip::{hal, timer};
#[cfg(feature = "dma")]
use crate::dma::DmaBus;
use embedded_hal_bus::spi::ExclusiveDevice;
use hal::clocks::init_clocks_and_plls;
#[cfg(feature = "dma")]
use hal::dma::DMAExt;
use hal::fugit::RateExtU32;
use hal::gpio::{FunctionSpi, FunctionUart, Pins};
use hal::spi::Spi;
use hal::uart::{DataBits, StopBits, UartConfig, UartPeripheral};
use hal::{Clock, Sio, Watchdog, pac};
use mipidsi::Builder;
use mipidsi::models::ST7789;
use mipidsi::options::{Orientation, Rotation};
use player::scene::{self, HEIGHT, Model, Placement, WIDTH};
use scanout::frame::{Frame, ObjectState, Primitive, Settings, Store};
use scanout::math::Q16;
use scanout::transform::Vertex;
use scanout_assets::bake::{Aligned, BakeError, read};
#[cfg(feature = "dma")]
use scanout_display::flush::{AsyncInterface, DoubleBuffer, block_on};
#[cfg(not(feature = "dma"))]
use scanout_display::flush::{BlockingInterface, show};
use scanout_display::spi::SpiLink;
use scanout_display::window::Area;

/// The crystal of a Pico and a Pico 2, Hz.
const CRYSTAL: u32 = 12_000_000;
/// Frames of a model before the other one comes.
const FRAMES: u32 = if cfg!(feature = "short") { 2 } else { 90 };
/// Lines of a band.
const LINES: usize = if cfg!(feature = "dma") { 3 } else { 4 };
/// Bands of colour: with DMA one is sent while the other is drawn.
const BANDS: usize = if cfg!(feature = "dma") { 2 } else { 1 };
/// Model A's positions and triangles.
const MOST: (usize, usize) = (400, 800);

static MODELS: [(&Aligned<[u8]>, Q16); 2] = [
    (&Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/c.mesh"))), Q16::from_ratio(9, 10)),
    (&Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/a.mesh"))), Q16::from_ratio(35, 100)),
];

/// A band's colour or depth.
type Band = [u16; WIDTH as usize * LINES];

struct Memory {
    vertices: [Vertex; MOST.0],
    primitives: [Primitive; MOST.1],
    colour: [Band; BANDS],
    depth: Band,
}

struct Once(UnsafeCell<Memory>);

// SAFETY: `main` alone takes it, once; the second core sleeps.
unsafe impl Sync for Once {}

static MEMORY: Once = Once(UnsafeCell::new(Memory {
    vertices: [Vertex::EMPTY; MOST.0],
    primitives: [Primitive::EMPTY; MOST.1],
    colour: [[0; WIDTH as usize * LINES]; BANDS],
    depth: [0; WIDTH as usize * LINES],
}));

#[hal::entry]
fn main() -> ! {
    // SAFETY: taken here, the first time and the only one.
    let (mut chip, memory) = unsafe { (pac::Peripherals::steal(), &mut *MEMORY.0.get()) };
    let mut watchdog = Watchdog::new(chip.WATCHDOG);
    let clocks = init_clocks_and_plls(
        CRYSTAL,
        chip.XOSC,
        chip.CLOCKS,
        chip.PLL_SYS,
        chip.PLL_USB,
        &mut chip.RESETS,
        &mut watchdog,
    );
    // Without its crystal there is no UART to say so.
    let Ok(clocks) = clocks else { sleep() };
    let mut timer = timer!(chip, clocks);
    let sio = Sio::new(chip.SIO);
    let pins = Pins::new(chip.IO_BANK0, chip.PADS_BANK0, sio.gpio_bank0, &mut chip.RESETS);

    let wires =
        (pins.gpio0.into_function::<FunctionUart>(), pins.gpio1.into_function::<FunctionUart>());
    let uart = UartConfig::new(115_200.Hz(), DataBits::Eight, None, StopBits::One);
    let clock = clocks.peripheral_clock.freq();
    let Ok(serial) = UartPeripheral::new(chip.UART0, wires, &mut chip.RESETS).enable(uart, clock)
    else {
        sleep()
    };

    let wires =
        (pins.gpio19.into_function::<FunctionSpi>(), pins.gpio18.into_function::<FunctionSpi>());
    let bus = Spi::<_, _, _, 8>::new(chip.SPI0, wires).init(
        &mut chip.RESETS,
        clock,
        62_500_000.Hz(),
        embedded_hal::spi::MODE_0,
    );
    #[cfg(feature = "dma")]
    let bus = {
        let channel = chip.DMA.split(&mut chip.RESETS).ch0;
        // SAFETY: `show_bands` leaks nothing.
        unsafe { DmaBus::new(bus, channel, pins.gpio21.into_push_pull_output()) }
    };
    let Ok(device) = ExclusiveDevice::new_no_delay(bus, pins.gpio17.into_push_pull_output());
    let link = SpiLink::new(device, pins.gpio16.into_push_pull_output());
    let display = Builder::new(ST7789, link)
        .reset_pin(pins.gpio20.into_push_pull_output())
        .orientation(Orientation::new().rotate(Rotation::Deg90))
        .init(&mut timer);
    let Ok(display) = display else {
        serial.write_full_blocking(b"fault: the display can't be started; check its wires\n");
        sleep()
    };
    let (mut link, ..) = display.release();

    loop {
        for (bytes, scale) in MODELS {
            let model = match baked(&bytes.0) {
                Ok(model) => model,
                Err(error) => {
                    serial.write_full_blocking(b"fault: ");
                    error.tell(&mut |text| serial.write_full_blocking(text));
                    serial.write_full_blocking(b"\n");
                    sleep()
                }
            };
            for number in 0..FRAMES {
                let shown = scene::with_scene(&model, scale, number, |scene| {
                    let mut objects = [ObjectState::default()];
                    let Memory { vertices, primitives, colour, depth } = &mut *memory;
                    let store = Store { vertices, primitives, objects: &mut objects };
                    let frame = Frame::prepare(scene, Settings::new(WIDTH, HEIGHT), store).ok()?;
                    show_bands(&frame, &mut link, colour, depth)
                });
                let line: &[u8] = match shown {
                    Some(()) => b"frame\n",
                    None => b"fault: the frame could not be shown\n",
                };
                serial.write_full_blocking(line);
            }
        }
    }
}

/// Draws and sends band by band.
#[cfg(not(feature = "dma"))]
fn show_bands(
    frame: &Frame<'_>,
    link: &mut impl BlockingInterface,
    [colour]: &mut [Band; BANDS],
    depth: &mut Band,
) -> Option<()> {
    show(frame, link, Area::LANDSCAPE, colour, depth, |_| ()).ok()
}

/// Draws a band while the one before it is sent.
#[cfg(feature = "dma")]
fn show_bands(
    frame: &Frame<'_>,
    link: &mut impl AsyncInterface,
    [front, back]: &mut [Band; BANDS],
    depth: &mut Band,
) -> Option<()> {
    let mut bands = DoubleBuffer::new([front, back], depth);
    block_on(bands.show(frame, link, Area::LANDSCAPE, |_| ())).ok()
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
        hal::arch::wfi();
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    sleep()
}
