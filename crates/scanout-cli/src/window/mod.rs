//! Pictures in a window, drawn by the processor.
//!
//! The windowing libraries are opened at run time. Where there is no display, or the program was built without the
//! feature `window`, [`run`] gives [`NoWindow`] and the caller falls back to the terminal.

#[cfg(feature = "window")]
mod native;

use crate::error::Result;
use crate::image_out::Picture;

/// What the window's keys do: the end of `scanout view --help`.
pub const KEYS: &str = "Keys: drag orbits, right or shift drag pans, the wheel zooms;\n  \
                        1 points, 2 wire, 3 hidden, 4 flat, 5 gouraud, 6 phong, 7 textured;\n  \
                        R resets the camera, S saves a picture, Space turns the model, Esc quits.";

/// Why there is no window: one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoWindow(pub String);

/// What happens between two frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Input {
    /// The mouse moved with the left button down; pixels to the right and down.
    Orbit(f64, f64),
    /// The same with the right button or shift.
    Pan(f64, f64),
    /// The wheel turned towards the picture; notches.
    Zoom(f64),
    /// A key's character, in lower case.
    Key(char),
    /// An arrow key: steps to the right and upwards.
    Arrow(i8, i8),
    /// The mouse is here, with or without a button: -1 to 1 from left to right and from bottom to top.
    Cursor(f64, f64),
}

/// What a window shows.
pub trait Content {
    /// The next picture, of this size. `seconds` have passed since the last one.
    ///
    /// # Errors
    /// Ends the window.
    fn draw(&mut self, width: u16, height: u16, seconds: f64) -> Result<Picture>;
    /// The last picture drawn has been handed to the screen.
    fn shown(&mut self) {}
    /// Reacts to the user.
    fn input(&mut self, input: Input);
    /// Does the picture change by itself?
    fn moves(&self) -> bool;
    /// Does the window cover the whole screen?
    fn fullscreen(&self) -> bool {
        false
    }
    /// The first part of the window's title.
    fn title(&self) -> String;
    /// Told twice a second: frames a second and milliseconds a frame's drawing.
    fn rate(&mut self, rate: f64, milliseconds: f64);
}

/// How a window begins and ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setting {
    /// Size of the picture at first, pixels.
    pub size: (u16, u16),
    /// Close after this many frames, drawn as fast as possible.
    pub frames: Option<u32>,
}

/// Shows a window until it is closed.
///
/// # Errors
/// Outer: there is no window. Inner: drawing failed.
#[cfg(feature = "window")]
pub fn run(
    content: &mut dyn Content,
    setting: Setting,
) -> std::result::Result<Result<()>, NoWindow> {
    native::run(content, setting)
}

/// Shows a window: never, in this build.
///
/// # Errors
/// Always.
#[cfg(not(feature = "window"))]
pub fn run(_: &mut dyn Content, _: Setting) -> std::result::Result<Result<()>, NoWindow> {
    Err(NoWindow("this scanout was built without windows (feature `window`)".into()))
}
