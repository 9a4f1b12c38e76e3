//! Flushing a band's own memory: blocking, asynchronous, and with two buffers, where one is sent while the next is drawn.

mod common;

use std::cell::RefCell;
use std::pin::Pin;
use std::rc::Rc;
use std::task::{Context, Poll};

use common::{whole, with_frame};
use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::ascii::FONT_10X20;
use embedded_graphics::pixelcolor::Rgb565 as Colour;
use embedded_graphics::prelude::*;
use embedded_graphics::text::Text;
use mipidsi::options::{Orientation, Rotation};
use scanout::frame::{BandError, DrawError};
use scanout_display::band::SendError;
use scanout_display::flush::{AsyncInterface, DoubleBuffer, block_on, flush, flush_async, show};
use scanout_display::init::Setup;
use scanout_display::model::{DisplayModel, ModelError, NoDelay, Wires};
use scanout_display::spi::SpiLink;
use scanout_display::target::BandTarget;
use scanout_display::window::Area;

const TURNED: Orientation = Orientation { rotation: Rotation::Deg90, mirrored: false };
const SETUP: Setup = Setup {
    orientation: TURNED,
    order: mipidsi::options::ColorOrder::Rgb,
    inversion: mipidsi::options::ColorInversion::Normal,
};

fn assert_shows(model: &DisplayModel, colour: &[u16], hash: u64) {
    let picture = model.picture().unwrap().upright(TURNED);
    assert!(picture.pixels == colour, "pixels differ");
    assert_eq!(picture.hash(), hash);
    assert_eq!((model.untouched(), model.counts().wrapped_pixels), (0, 0));
}

/// Writes across band borders and over all of the frame's edges.
fn text(target: &mut BandTarget<'_>) {
    let style = MonoTextStyle::new(&FONT_10X20, Colour::WHITE);
    for (x, y) in [(-7, 12), (90, 118), (250, 245)] {
        Text::new("scan-out 60/s", Point::new(x, y), style).draw(target).unwrap();
    }
}

#[test]
fn blocking_with_text_on_top() {
    with_frame(320, 240, |frame| {
        let (plain, plain_hash) = whole(frame);
        let mut lettered = plain.clone();
        text(&mut BandTarget::new(&mut lettered, (320, 240), 0));
        assert!(lettered != plain);
        for lines in [1, 7, 16, 240] {
            let wires = Wires::default();
            let mut link = SpiLink::new(wires.spi(), wires.dc());
            SETUP.start(&mut link, &mut NoDelay).unwrap();
            let (mut colour, mut depth) = (vec![0; 320 * lines], vec![0; 320 * lines]);
            let (area, mut none) = (Area::LANDSCAPE, |_: &mut BandTarget| ());
            show(frame, &mut link, area, &mut colour, &mut depth, &mut none).unwrap();
            assert_shows(&wires.model(), &plain, plain_hash);
            wires.model_mut().forget();
            show(frame, &mut link, area, &mut colour, &mut depth, text).unwrap();
            let picture = wires.model().picture().unwrap().upright(TURNED);
            assert!(picture.pixels == lettered, "text in bands of {lines} lines");

            let bytes = wires.model().counts().bytes;
            let narrow = Area { width: 319, ..area };
            let error = show(frame, &mut link, narrow, &mut colour, &mut depth, &mut none);
            assert!(matches!(error, Err(DrawError::Sink(SendError::Outside(_)))));
            let wide = Area { width: 321, ..area };
            let error = show(frame, &mut link, wide, &mut colour, &mut depth, &mut none);
            let length = SendError::Length { needed: 321, given: 320 };
            assert_eq!(error, Err(DrawError::Sink(length)));
            let error = show(frame, &mut link, area, &mut colour[1..320], &mut depth, &mut none);
            let memory = BandError::Memory { colour: 320, depth: 320 };
            assert_eq!(error, Err(DrawError::Band(memory)));
            assert_eq!(wires.model().counts().bytes, bytes, "nothing was sent");
        }
    });
}

#[test]
fn asynchronous_is_blocking_byte_for_byte() {
    let (blocking, asynchronous) = (Wires::default(), Wires::default());
    let mut pixels: Vec<u16> = (0..320 * 3).map(|i| (i * 40503) as u16).collect();
    let mut link = SpiLink::new(blocking.spi(), blocking.dc());
    SETUP.start(&mut link, &mut NoDelay).unwrap();
    flush(&mut link, Area::LANDSCAPE, 200, &mut pixels.clone()).unwrap();
    let mut link = SpiLink::new(asynchronous.spi(), asynchronous.dc());
    block_on(async {
        SETUP.start_async(&mut link, &mut NoDelay).await.unwrap();
        flush_async(&mut link, Area::LANDSCAPE, 200, &mut pixels).await.unwrap();
    });
    let (a, b) = (blocking.model(), asynchronous.model());
    assert_eq!((a.counts(), a.registers()), (b.counts(), b.registers()));
    assert_eq!(a.picture(), b.picture());
    assert_eq!(a.untouched(), 76_800 - 960);
}

/// What happens on the bus and beside it, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Event {
    Window,
    Started(usize),
    Drawn(u16),
    Sent,
}

/// A bus with DMA: a transfer starts when first polled, and is seen to be done at the third poll. The bytes go out only then,
/// so that drawing into memory that is being sent would be seen in the picture.
struct Dma {
    wires: Wires,
    events: Rc<RefCell<Vec<Event>>>,
    /// Bands until the bus fails.
    fails_after: Option<usize>,
}

struct Transfer<'t> {
    dma: &'t mut Dma,
    bytes: &'t [u8],
    polls: u8,
}

#[derive(Debug, PartialEq)]
enum BusError {
    Model(ModelError),
    Torn,
}

impl Future for Transfer<'_> {
    type Output = Result<(), BusError>;

    fn poll(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Self::Output> {
        let length = self.bytes.len();
        self.polls += 1;
        match self.polls {
            1 => self.dma.events.borrow_mut().push(Event::Started(length)),
            3 => {
                self.dma.events.borrow_mut().push(Event::Sent);
                if let Some(bands) = &mut self.dma.fails_after {
                    if *bands == 0 {
                        return Poll::Ready(Err(BusError::Torn));
                    }
                    *bands -= 1;
                }
                let sent = self.dma.wires.model_mut().feed_all(self.bytes, true);
                return Poll::Ready(sent.map_err(BusError::Model));
            }
            _ => {}
        }
        context.waker().wake_by_ref();
        Poll::Pending
    }
}

impl AsyncInterface for Dma {
    type Error = BusError;

    async fn command(&mut self, command: u8, parameters: &[u8]) -> Result<(), BusError> {
        if command == 0x2a {
            self.events.borrow_mut().push(Event::Window);
        }
        let mut model = self.wires.model_mut();
        model.feed(command, false).map_err(BusError::Model)?;
        model.feed_all(parameters, true).map_err(BusError::Model)
    }

    async fn data(&mut self, bytes: &[u8]) -> Result<(), BusError> {
        Transfer { dma: self, bytes, polls: 0 }.await
    }
}

fn dma() -> Dma {
    let wires = Wires::default();
    let mut dma = Dma { wires, events: Rc::default(), fails_after: None };
    block_on(SETUP.start_async(&mut dma, &mut NoDelay)).unwrap();
    dma
}

#[test]
fn one_band_is_sent_while_the_next_is_drawn() {
    with_frame(320, 240, |frame| {
        let (colour, hash) = whole(frame);
        for lines in [1, 7, 16, 100, 240] {
            let mut dma = dma();
            let events = dma.events.clone();
            let mut memory = [vec![0; 320 * lines], vec![0; 320 * lines]];
            let [a, b] = &mut memory;
            let mut depth = vec![0; 320 * lines];
            let mut buffers = DoubleBuffer::new([a, b], &mut depth);
            for _ in 0..2 {
                dma.wires.model_mut().forget();
                events.borrow_mut().clear();
                let drawn = |target: &mut BandTarget<'_>| {
                    events.borrow_mut().push(Event::Drawn(target.rows().start));
                };
                block_on(buffers.show(frame, &mut dma, Area::LANDSCAPE, drawn)).unwrap();
                assert_shows(&dma.wires.model(), &colour, hash);

                // The next band is drawn after a transfer has started and before it is done.
                let tops: Vec<u16> = (0..240).step_by(lines).collect();
                let mut expected = vec![Event::Drawn(0)];
                for (i, &top) in tops.iter().enumerate() {
                    let rows = (240 - top as usize).min(lines);
                    expected.extend([Event::Window, Event::Started(rows * 640)]);
                    expected.extend(tops.get(i + 1).map(|&next| Event::Drawn(next)));
                    expected.push(Event::Sent);
                }
                assert_eq!(*events.borrow(), expected, "bands of {lines} lines");
            }
        }
    });
}

#[test]
fn two_buffers_over_spi_with_text() {
    with_frame(320, 240, |frame| {
        let mut lettered = whole(frame).0;
        text(&mut BandTarget::new(&mut lettered, (320, 240), 0));
        let wires = Wires::default();
        let mut link = SpiLink::new(wires.spi(), wires.dc());
        let (mut a, mut b, mut depth) = ([0; 320 * 13], [0; 320 * 11 + 3], [0; 320 * 12]);
        block_on(async {
            SETUP.start_async(&mut link, &mut NoDelay).await.unwrap();
            let mut buffers = DoubleBuffer::new([&mut a, &mut b], &mut depth);
            buffers.show(frame, &mut link, Area::LANDSCAPE, text).await.unwrap();
        });
        // The smallest memory decides: 11 lines, 22 bands.
        assert_eq!(wires.model().counts().writes, 22);
        assert!(wires.model().picture().unwrap().upright(TURNED).pixels == lettered);
    });
}

#[test]
fn errors_come_back_and_the_next_frame_recovers() {
    with_frame(320, 240, |frame| {
        let (colour, hash) = whole(frame);
        let mut dma = dma();
        dma.fails_after = Some(3);
        let (mut a, mut b, mut depth) = ([0; 320 * 16], [0; 320 * 16], [0; 320 * 16]);
        let mut buffers = DoubleBuffer::new([&mut a, &mut b], &mut depth);
        let mut show = |dma: &mut Dma, area| block_on(buffers.show(frame, dma, area, |_| ()));
        let error = show(&mut dma, Area::LANDSCAPE).unwrap_err();
        assert_eq!(error, DrawError::Sink(SendError::Bus(BusError::Torn)));
        assert!(error.to_string().ends_with("the display's bus failed: Torn"), "{error}");
        dma.fails_after = None;
        show(&mut dma, Area::LANDSCAPE).unwrap();
        assert_shows(&dma.wires.model(), &colour, hash);

        dma.events.borrow_mut().clear();
        let narrow = Area { width: 319, ..Area::LANDSCAPE };
        assert!(matches!(show(&mut dma, narrow), Err(DrawError::Sink(SendError::Outside(_)))));
        let wide = Area { width: 321, ..Area::LANDSCAPE };
        let length = SendError::Length { needed: 321, given: 320 };
        assert_eq!(show(&mut dma, wide), Err(DrawError::Sink(length)));
        assert_eq!(*dma.events.borrow(), [], "nothing was sent");

        let mut buffers = DoubleBuffer::new([&mut a[..319], &mut b], &mut depth);
        let shown = block_on(buffers.show(frame, &mut dma, Area::LANDSCAPE, |_| ()));
        let memory = BandError::Memory { colour: 320, depth: 320 };
        assert_eq!(shown, Err(DrawError::Band(memory)));
    });
}
