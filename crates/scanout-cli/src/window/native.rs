//! The window itself: winit's events, softbuffer's pixels.

use std::num::NonZeroU32;
use std::rc::Rc;
use std::time::{Duration, Instant};

use softbuffer::{Context, Surface};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::keyboard::{Key, ModifiersState, NamedKey};
use winit::window::{Fullscreen, Window, WindowId};

use super::{Content, Input, NoWindow, Setting};
use crate::error::Result;
use crate::image_out::Picture;
use crate::values::MAX_SIDE;

/// The least time between two frames that nobody asked for: 60 a second.
const PACE: Duration = Duration::from_micros(16_667);

/// How often the frame rate is told.
const REPORT: Duration = Duration::from_millis(500);

/// See [`super::run`].
pub fn run(
    content: &mut dyn Content,
    setting: Setting,
) -> std::result::Result<Result<()>, NoWindow> {
    let events = EventLoop::new().map_err(|error| no_window(&error))?;
    let mut app = App {
        content,
        setting,
        shown: None,
        outcome: Ok(Ok(())),
        cursor: None,
        dragging: None,
        modifiers: ModifiersState::empty(),
        clock: Clock::new(),
    };
    events.run_app(&mut app).map_err(|error| no_window(&error))?;
    app.outcome
}

fn no_window(error: &dyn std::fmt::Display) -> NoWindow {
    let text = error.to_string();
    NoWindow(plain(text.lines().next().unwrap_or_default()).into())
}

/// A library's error without the `os error at FILE.rs:LINE: ` in front and without the full stop.
fn plain(text: &str) -> &str {
    let text = text.rsplit_once(".rs:").map_or(text, |(_, rest)| rest);
    let text = match text.split_once(':') {
        Some((line, rest)) if line.bytes().all(|byte| byte.is_ascii_digit()) => rest,
        _ => text,
    };
    text.trim().trim_end_matches('.')
}

struct Shown {
    window: Rc<Window>,
    surface: Surface<Rc<Window>, Rc<Window>>,
}

/// Frames counted since the last report.
struct Clock {
    frames: u32,
    total: u32,
    drawing: Duration,
    since: Instant,
    last: Instant,
}

impl Clock {
    fn new() -> Self {
        let now = Instant::now();
        Self { frames: 0, total: 0, drawing: Duration::ZERO, since: now, last: now }
    }
}

struct App<'a> {
    content: &'a mut dyn Content,
    setting: Setting,
    shown: Option<Shown>,
    outcome: std::result::Result<Result<()>, NoWindow>,
    cursor: Option<(f64, f64)>,
    dragging: Option<MouseButton>,
    modifiers: ModifiersState,
    clock: Clock,
}

impl App<'_> {
    fn open(&self, events: &ActiveEventLoop) -> std::result::Result<Shown, NoWindow> {
        let (width, height) = self.setting.size;
        let attributes = Window::default_attributes()
            .with_title(format!("scanout - {}", self.content.title()))
            .with_inner_size(PhysicalSize::new(u32::from(width), u32::from(height)))
            .with_fullscreen(self.content.fullscreen().then_some(Fullscreen::Borderless(None)));
        let window = Rc::new(events.create_window(attributes).map_err(|e| no_window(&e))?);
        let context = Context::new(window.clone()).map_err(|error| no_window(&error))?;
        let surface = Surface::new(&context, window.clone()).map_err(|error| no_window(&error))?;
        Ok(Shown { window, surface })
    }

    fn redraw(&self) {
        if let Some(shown) = &self.shown {
            shown.window.request_redraw();
        }
    }

    fn draw(&mut self, events: &ActiveEventLoop) {
        let Some(shown) = &mut self.shown else { return };
        let size = shown.window.inner_size();
        let side = |pixels: u32| pixels.min(MAX_SIDE.into()) as u16;
        let (width, height) = (side(size.width), side(size.height));
        let (Some(w), Some(h)) = (NonZeroU32::new(width.into()), NonZeroU32::new(height.into()))
        else {
            return; // minimised
        };
        let start = Instant::now();
        let seconds = (start - self.clock.last).as_secs_f64();
        self.clock.last = start;
        let picture = match self.content.draw(width, height, seconds) {
            Ok(picture) => picture,
            Err(error) => {
                self.outcome = Ok(Err(error));
                return events.exit();
            }
        };
        self.clock.drawing += start.elapsed();
        if let Err(error) = present(shown, w, h, &picture) {
            self.outcome = Err(error);
            return events.exit();
        }
        self.content.shown();
        self.clock.frames += 1;
        self.clock.total += 1;
        self.report();
        if self.setting.frames.is_some_and(|frames| self.clock.total >= frames) {
            events.exit();
        }
    }

    fn report(&mut self) {
        let passed = self.clock.since.elapsed();
        if passed < REPORT {
            return;
        }
        let frames = f64::from(self.clock.frames);
        let rate = frames / passed.as_secs_f64();
        let milliseconds = self.clock.drawing.as_secs_f64() * 1000.0 / frames;
        self.content.rate(rate, milliseconds);
        if let Some(shown) = &self.shown {
            let size = shown.window.inner_size();
            shown.window.set_title(&format!(
                "scanout - {} - {} x {} - {rate:.0} frames/s, {milliseconds:.1} ms each",
                self.content.title(),
                size.width,
                size.height,
            ));
        }
        self.clock = Clock { total: self.clock.total, last: self.clock.last, ..Clock::new() };
    }

    fn moved(&mut self, to: (f64, f64)) {
        let from = self.cursor.replace(to).unwrap_or(to);
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        if let Some(shown) = &self.shown {
            let size = shown.window.inner_size();
            let share = |at: f64, side: u32| at / f64::from(side.max(1)) * 2.0 - 1.0;
            self.content.input(Input::Cursor(share(to.0, size.width), -share(to.1, size.height)));
        }
        let Some(button) = self.dragging else { return };
        let pans = button != MouseButton::Left || self.modifiers.shift_key();
        self.content.input(if pans { Input::Pan(dx, dy) } else { Input::Orbit(dx, dy) });
        self.redraw();
    }

    fn pressed(&mut self, key: &Key, events: &ActiveEventLoop) {
        match key {
            Key::Named(NamedKey::Escape) => events.exit(),
            Key::Named(NamedKey::Space) => self.content.input(Input::Key(' ')),
            Key::Named(NamedKey::ArrowLeft) => self.content.input(Input::Arrow(-1, 0)),
            Key::Named(NamedKey::ArrowRight) => self.content.input(Input::Arrow(1, 0)),
            Key::Named(NamedKey::ArrowUp) => self.content.input(Input::Arrow(0, 1)),
            Key::Named(NamedKey::ArrowDown) => self.content.input(Input::Arrow(0, -1)),
            Key::Character(text) => {
                for character in text.chars().flat_map(char::to_lowercase) {
                    self.content.input(Input::Key(character));
                }
            }
            _ => {}
        }
        self.redraw();
    }
}

/// Copies a picture into the window.
fn present(
    shown: &mut Shown,
    width: NonZeroU32,
    height: NonZeroU32,
    picture: &Picture,
) -> std::result::Result<(), NoWindow> {
    shown.surface.resize(width, height).map_err(|error| no_window(&error))?;
    let mut buffer = shown.surface.buffer_mut().map_err(|error| no_window(&error))?;
    for (pixel, [r, g, b]) in buffer.iter_mut().zip(&picture.pixels) {
        *pixel = u32::from_be_bytes([0, *r, *g, *b]);
    }
    shown.window.pre_present_notify();
    buffer.present().map_err(|error| no_window(&error))
}

impl ApplicationHandler for App<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        match self.open(events) {
            Ok(shown) => self.shown = Some(shown),
            Err(error) => {
                self.outcome = Err(error);
                events.exit();
            }
        }
        self.redraw();
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::RedrawRequested => self.draw(events),
            WindowEvent::Resized(_) => self.redraw(),
            WindowEvent::ModifiersChanged(modifiers) => self.modifiers = modifiers.state(),
            WindowEvent::CursorMoved { position, .. } => self.moved((position.x, position.y)),
            WindowEvent::MouseInput { state, button, .. } => {
                self.dragging = (state == ElementState::Pressed).then_some(button);
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let notches = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => lines.into(),
                    MouseScrollDelta::PixelDelta(pixels) => pixels.y / 60.0,
                };
                self.content.input(Input::Zoom(notches));
                self.redraw();
            }
            WindowEvent::KeyboardInput { event, .. } if event.state == ElementState::Pressed => {
                self.pressed(&event.logical_key, events);
            }
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        if self.setting.frames.is_some() {
            events.set_control_flow(ControlFlow::Poll);
            self.redraw();
        } else if self.content.moves() {
            let next = self.clock.last + PACE;
            if Instant::now() >= next {
                self.redraw();
                events.set_control_flow(ControlFlow::WaitUntil(Instant::now() + PACE));
            } else {
                events.set_control_flow(ControlFlow::WaitUntil(next));
            }
        } else {
            events.set_control_flow(ControlFlow::Wait);
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn errors_without_source_lines() {
        let plain = super::plain;
        assert_eq!(
            plain("os error at /a/winit-0.30/src/linux/mod.rs:765: no display."),
            "no display"
        );
        assert_eq!(plain("no display: refused"), "no display: refused");
    }
}
