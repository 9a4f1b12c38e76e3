//! Frames in the window of the `scanout` program.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use scanout::output::widen565;
use scanout_cli::image_out::Picture as Shown;
use scanout_cli::window::{Content, Input, NoWindow, Setting, run};
use scanout_display::model::Picture;

/// The newest frame, between the thread that reads and the window.
pub struct Shared {
    frame: Mutex<Shown>,
    closed: AtomicBool,
}

impl Shared {
    /// Replaces the frame; false when the window is closed.
    pub fn put(&self, picture: &Picture<u16>) -> bool {
        let pixels = picture.pixels.iter().map(|&pixel| widen565(pixel)).collect();
        let (width, height) = (picture.width.into(), picture.height.into());
        if let Ok(mut frame) = self.frame.lock() {
            *frame = Shown { width, height, pixels };
        }
        !self.closed.load(Ordering::Relaxed)
    }
}

struct Frames(Arc<Shared>);

impl Content for Frames {
    fn draw(&mut self, width: u16, height: u16, _: f64) -> scanout_cli::error::Result<Shown> {
        let black = || Shown::filled(width.into(), height.into(), [0; 3]);
        let frame = self.0.frame.lock();
        Ok(frame.map_or_else(|_| black(), |frame| frame.stretched(width.into(), height.into())))
    }

    fn input(&mut self, _: Input) {}

    fn moves(&self) -> bool {
        true
    }

    fn title(&self) -> String {
        "the board's display".into()
    }

    fn rate(&mut self, _: f64, _: f64) {}
}

/// Runs `read` on another thread and the window on this one, until either ends.
pub fn main(
    read: impl FnOnce(Arc<Shared>) -> Result<(), String> + Send + 'static,
) -> Result<(), String> {
    let frame = Mutex::new(Shown::filled(320, 240, [0; 3]));
    let shared = Arc::new(Shared { frame, closed: AtomicBool::new(false) });
    let theirs = shared.clone();
    let reader = std::thread::spawn(move || read(theirs));
    let setting = Setting { size: (640, 480), frames: None };
    let window = run(&mut Frames(shared.clone()), setting);
    shared.closed.store(true, Ordering::Relaxed);
    match window {
        Err(NoWindow(why)) => Err(why),
        Ok(Err(error)) => Err(error.to_string()),
        // The reader may wait for bytes for ever; only what it has to say already counts.
        Ok(Ok(())) if reader.is_finished() => reader.join().unwrap_or(Ok(())),
        Ok(Ok(())) => Ok(()),
    }
}
