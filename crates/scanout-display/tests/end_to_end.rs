//! From a scene to the picture on the display: bands go through mipidsi or its interfaces into the display model, and what
//! the model shows is the frame, bit for bit, with its hash.

mod common;

use std::cell::RefCell;
use std::convert::Infallible;
use std::rc::Rc;

use common::{bands, whole, with_frame};
use embedded_hal::digital::{ErrorType, OutputPin};
use mipidsi::interface::{Interface, InterfaceKind, OutputBus, ParallelInterface, SpiInterface};
use mipidsi::models::ST7789;
use mipidsi::options::{ColorInversion, ColorOrder, Orientation, Rotation};
use mipidsi::{Builder, InitError};
use scanout::output::widen565;
use scanout_display::band::{self, SendError};
use scanout_display::init::Setup;
use scanout_display::model::{DisplayModel, Fault, Glass, NoDelay, PixelSize, Wires};
use scanout_display::spi::SpiLink;
use scanout_display::window::{Area, madctl};

/// All eight orientations.
fn orientations() -> impl Iterator<Item = Orientation> {
    let rotations = [Rotation::Deg0, Rotation::Deg90, Rotation::Deg180, Rotation::Deg270];
    let both = move |mirrored| rotations.map(|rotation| Orientation { rotation, mirrored });
    [false, true].into_iter().flat_map(both)
}

fn size(orientation: Orientation) -> (u16, u16) {
    if orientation.rotation.is_vertical() { (320, 240) } else { (240, 320) }
}

/// The model shows this frame and nothing else, in this orientation.
fn assert_shows(model: &DisplayModel, orientation: Orientation, colour: &[u16], hash: u64) {
    let picture = model.picture().unwrap().upright(orientation);
    assert_eq!((picture.width, picture.height), size(orientation));
    assert!(picture.pixels == colour, "{orientation:?}: pixels differ");
    assert_eq!(picture.hash(), hash);
    let seen = model.seen().unwrap().upright(orientation);
    assert!(seen.pixels.iter().zip(colour).all(|(&rgb, &pixel)| rgb == widen565(pixel)));
    assert_eq!(model.untouched(), 0);
    assert_eq!(model.counts().wrapped_pixels, 0);
}

#[test]
fn through_mipidsi_in_every_orientation_and_band() {
    for orientation in orientations() {
        let (width, height) = size(orientation);
        with_frame(width, height, |frame| {
            let (colour, hash) = whole(frame);
            for lines in [1, 7, 16, 240, height] {
                let wires = Wires::default();
                let mut display = Builder::new(ST7789, wires.interface())
                    .orientation(orientation)
                    .reset_pin(wires.reset())
                    .init(&mut NoDelay)
                    .unwrap();
                let before = wires.model().counts();
                bands(frame, lines, |b| band::show(&mut display, &b));
                let (model, n) = (wires.model(), height.div_ceil(lines) as u64);
                assert_shows(&model, orientation, &colour, hash);
                let counts = model.counts();
                assert_eq!(counts.bytes - before.bytes, 2 * 76_800 + 11 * n);
                assert_eq!(counts.commands - before.commands, 3 * n);
                assert_eq!((counts.writes, counts.windows_filled, counts.resets), (n, n, 1));
            }
        });
    }
}

/// The byte stream itself: each byte with the level of D/C, through mipidsi's SPI interface and through our own.
#[test]
fn through_spi_with_a_data_command_pin() {
    with_frame(320, 240, |frame| {
        let (colour, hash) = whole(frame);
        let turned = Orientation::new().rotate(Rotation::Deg90);
        let (wires, mut buffer) = (Wires::default(), [0; 512]);
        let spi = SpiInterface::new(wires.spi(), wires.dc(), &mut buffer);
        let builder = Builder::new(ST7789, spi).orientation(turned).reset_pin(wires.reset());
        let mut display = builder.init(&mut NoDelay).unwrap();
        bands(frame, 16, |b| band::show(&mut display, &b));
        assert_shows(&wires.model(), turned, &colour, hash);

        // Again with the interface beneath, and with ours.
        wires.model_mut().forget();
        let mut spi = display.release().0;
        bands(frame, 7, |b| band::write(&mut spi, Area::LANDSCAPE, &b));
        assert_shows(&wires.model(), turned, &colour, hash);

        let wires = Wires::default();
        let link = SpiLink::new(wires.spi(), wires.dc());
        let mut display =
            Builder::new(ST7789, link).orientation(turned).init(&mut NoDelay).unwrap();
        bands(frame, 16, |b| band::show(&mut display, &b));
        assert_shows(&wires.model(), turned, &colour, hash);
    });
    // Upright, a band of odd height is no multiple of what our link gathers on the stack.
    with_frame(240, 320, |frame| {
        let (colour, hash) = whole(frame);
        let wires = Wires::default();
        let link = SpiLink::new(wires.spi(), wires.dc());
        let mut display = Builder::new(ST7789, link).init(&mut NoDelay).unwrap();
        bands(frame, 7, |b| band::show(&mut display, &b));
        assert_shows(&wires.model(), Orientation::new(), &colour, hash);
    });
}

/// A parallel bus of 8 or 16 wires: a word is taken when WR rises.
#[derive(Clone, Default)]
struct Parallel(Rc<RefCell<Lines>>);

#[derive(Default)]
struct Lines {
    model: DisplayModel,
    bus: u16,
    wide: bool,
    data: bool,
    write_low: bool,
    command: u16,
}

struct Bus<W>(Parallel, std::marker::PhantomData<W>);
struct DataCommand(Parallel);
struct Write(Parallel);

macro_rules! bus {
    ($word:ty, $kind:ident) => {
        impl OutputBus for Bus<$word> {
            type Word = $word;
            type Error = Infallible;
            const KIND: InterfaceKind = InterfaceKind::$kind;
            fn set_value(&mut self, value: $word) -> Result<(), Infallible> {
                self.0.0.borrow_mut().bus = value as u16;
                Ok(())
            }
        }
    };
}
bus!(u8, Parallel8Bit);
bus!(u16, Parallel16Bit);

impl ErrorType for DataCommand {
    type Error = Infallible;
}
impl ErrorType for Write {
    type Error = Infallible;
}
impl OutputPin for DataCommand {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.0.borrow_mut().data = false;
        Ok(())
    }
    fn set_high(&mut self) -> Result<(), Infallible> {
        self.0.0.borrow_mut().data = true;
        Ok(())
    }
}
impl OutputPin for Write {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.0.0.borrow_mut().write_low = true;
        Ok(())
    }
    fn set_high(&mut self) -> Result<(), Infallible> {
        let lines = &mut *self.0.0.borrow_mut();
        if std::mem::take(&mut lines.write_low) {
            let [high, low] = lines.bus.to_be_bytes();
            // With 16 wires a pixel is one word; commands and parameters use the lower eight.
            if lines.wide && lines.data && lines.command == 0x2c {
                lines.model.feed(high, true).unwrap();
            }
            lines.model.feed(low, lines.data).unwrap();
            if !lines.data {
                lines.command = lines.bus;
            }
        }
        Ok(())
    }
}

fn parallel<W: Copy + From<u8> + Eq + band::Word>(wide: bool)
where
    Bus<W>: OutputBus<Word = W, Error = Infallible>,
    mipidsi::models::ST7789:
        mipidsi::models::Model<ColorFormat: mipidsi::interface::InterfacePixelFormat<W>>,
{
    let turned = Orientation::new().rotate(Rotation::Deg270);
    with_frame(320, 240, |frame| {
        let (colour, hash) = whole(frame);
        let wires = Parallel::default();
        wires.0.borrow_mut().wide = wide;
        let bus = Bus::<W>(wires.clone(), std::marker::PhantomData);
        let bus = ParallelInterface::new(bus, DataCommand(wires.clone()), Write(wires.clone()));
        let mut display = Builder::new(ST7789, bus).orientation(turned).init(&mut NoDelay).unwrap();
        bands(frame, 16, |b| band::show(&mut display, &b));
        assert_shows(&wires.0.borrow().model, turned, &colour, hash);
        wires.0.borrow_mut().model.forget();
        let mut bus = display.release().0;
        bands(frame, 7, |b| band::write(&mut bus, Area::LANDSCAPE, &b));
        assert_shows(&wires.0.borrow().model, turned, &colour, hash);
    });
}

#[test]
fn through_parallel_wires() {
    parallel::<u8>(false);
    parallel::<u16>(true);
}

/// Small glass in the large memory: mipidsi's offset and ours are the same addresses.
#[test]
fn glass_with_an_offset() {
    for orientation in orientations() {
        let (memory, glass, offset) = ((240, 320), (135, 240), (52, 30));
        let area = Area::of_glass(memory, glass, offset, orientation).unwrap();
        with_frame(area.width, area.height, |frame| {
            let (colour, hash) = whole(frame);
            let wires = Wires::default();
            let mut display = Builder::new(ST7789, wires.interface())
                .display_size(glass.0, glass.1)
                .display_offset(offset.0, offset.1)
                .orientation(orientation)
                .init(&mut NoDelay)
                .unwrap();
            let check = || {
                let picture = wires.model().picture().unwrap().crop(52, 30, 135, 240).unwrap();
                let picture = picture.upright(orientation);
                assert!(picture.pixels == colour, "{orientation:?}");
                assert_eq!(picture.hash(), hash);
                assert_eq!(wires.model().untouched(), 76_800 - 135 * 240);
            };
            bands(frame, 16, |b| band::show(&mut display, &b));
            check();
            wires.model_mut().forget();
            let mut interface = display.release().0;
            bands(frame, 16, |b| band::write(&mut interface, area, &b));
            check();
        });
    }
}

#[test]
fn start_is_what_mipidsi_sends() {
    /// Bytes with D/C.
    #[derive(Default, PartialEq, Debug)]
    struct Log(Vec<(u8, bool)>);
    impl Interface for Log {
        type Word = u8;
        type Error = Infallible;
        const KIND: InterfaceKind = InterfaceKind::Serial4Line;
        fn send_command(&mut self, command: u8, args: &[u8]) -> Result<(), Infallible> {
            self.0.push((command, false));
            self.0.extend(args.iter().map(|&byte| (byte, true)));
            Ok(())
        }
        fn send_pixels<const N: usize>(
            &mut self,
            _: impl IntoIterator<Item = [u8; N]>,
        ) -> Result<(), Infallible> {
            unreachable!("no pixels are sent")
        }
        fn send_repeated_pixel<const N: usize>(
            &mut self,
            _: [u8; N],
            _: u32,
        ) -> Result<(), Infallible> {
            unreachable!("no pixels are sent")
        }
    }
    for orientation in orientations() {
        for (order, inversion) in
            [(ColorOrder::Rgb, ColorInversion::Normal), (ColorOrder::Bgr, ColorInversion::Inverted)]
        {
            let mut log = Log::default();
            let builder = Builder::new(ST7789, &mut log).orientation(orientation);
            builder.color_order(order).invert_colors(inversion).init(&mut NoDelay).unwrap();
            let setup = Setup { orientation, order, inversion };
            let ours = setup.steps().into_iter().flat_map(|step| {
                let parameter = step.parameter.map(|byte| (byte, true));
                std::iter::once((step.command, false)).chain(parameter)
            });
            assert_eq!(log.0, ours.collect::<Vec<_>>());

            let wires = Wires::new(DisplayModel::new(Glass { bgr: false, inverted: true }));
            setup.start(&mut SpiLink::new(wires.spi(), wires.dc()), &mut NoDelay).unwrap();
            let registers = wires.model().registers();
            assert!(registers.awake && registers.on && registers.pixel == PixelSize::Bits16);
            assert_eq!(registers.madctl, madctl(orientation, order));
            assert_eq!(registers.inverted, inversion == ColorInversion::Inverted);
        }
    }
}

#[test]
fn what_does_not_fit_is_said_before_anything_is_sent() {
    with_frame(320, 240, |frame| {
        let wires = Wires::default();
        // Upright: the frame is too wide.
        let mut display = Builder::new(ST7789, wires.interface()).init(&mut NoDelay).unwrap();
        let bytes = wires.model().counts().bytes;
        bands(frame, 16, |b| {
            let error = band::show(&mut display, &b).unwrap_err();
            let SendError::Outside(outside) = &error else { panic!("{error}") };
            assert_eq!((outside.width, outside.area), (320, (240, 320)));
            assert!(error.to_string().contains("320 x 16"), "{error}");
            let short = scanout::frame::Band { colour: &b.colour[1..], ..b };
            let error = band::write(&mut wires.interface(), Area::LANDSCAPE, &short).unwrap_err();
            assert_eq!(error, SendError::Length { needed: 5120, given: 5119 });
            Ok::<(), ()>(())
        });
        assert_eq!(wires.model().counts().bytes, bytes);
    });
}

/// A bus's error comes through with its own type.
#[test]
fn the_models_fault_is_the_drivers_error() {
    let wires = Wires::default();
    wires.model_mut().reset(false);
    let started = Builder::new(ST7789, wires.interface()).init(&mut NoDelay);
    let Err(InitError::Interface(error)) = started else { panic!("bytes in reset were taken") };
    assert_eq!((error.fault, error.at), (Fault::HeldInReset, 0));

    // Pixels to a display that nobody started.
    let wires = Wires::default();
    with_frame(320, 240, |frame| {
        let (mut link, mut errors) = (wires.interface(), 0);
        bands(frame, 240, |b| {
            let error = band::write(&mut link, Area::LANDSCAPE, &b).unwrap_err();
            let SendError::Bus(error) = error else { panic!("{error}") };
            assert!(matches!(error.fault, Fault::OutsideMemory { command: 0x2a, .. }), "{error}");
            errors += 1;
            Ok::<(), ()>(())
        });
        assert_eq!(errors, 1);
    });
}
