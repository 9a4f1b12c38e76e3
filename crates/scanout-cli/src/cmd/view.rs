//! `scanout view`: models in a window.

use std::fs::File;
use std::io::BufWriter;
use std::path::PathBuf;

use crate::args::{DrawMode, Terminal, ViewArgs};
use crate::draw::{self, Options};
use crate::error::{Error, Result};
use crate::image_out::{self, Picture};
use crate::scene_builder::vector::{along, sin_cos};
use crate::scene_builder::view::Fit;
use crate::scene_builder::{Shot, Stage};
use crate::window::{self, Content, Input, NoWindow, Setting};
use crate::{blank, narrate, terminal};

/// Degrees that a pixel of dragging turns.
const DEGREES_A_PIXEL: f64 = 0.4;

/// Degrees a second of a model that turns by itself.
const SPIN: f64 = 30.0;

/// Opens the window; without a display, the picture goes to the terminal.
pub fn run(args: &ViewArgs) -> Result<()> {
    let picture = &args.scene.picture;
    let size = (picture.resolution.width, picture.resolution.height);
    let mut stage = Stage::load(&args.scene)?;
    let shot = stage.shot(&args.scene, size, Fit::Ball)?;
    blank::tell_first(&mut stage, &shot, &Options::new(picture), &args.scene.camera)?;
    let name =
        args.scene.models.iter().map(|path| {
            path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned()
        });
    let name = name.collect::<Vec<_>>().join(", ");
    let mut viewer = Viewer::new(stage, shot, Options::new(picture), name);
    viewer.stats = args.stats;
    let setting = Setting { size, frames: args.frames };
    match window::run(&mut viewer, setting) {
        Ok(outcome) => outcome,
        Err(NoWindow(why)) if terminal::will_show(Terminal::Auto) => {
            narrate!("scanout: no window ({why}), so the picture is in the terminal");
            terminal::show(&viewer.draw(size.0, size.1, 0.0)?, Terminal::Auto, 0).map(drop)
        }
        Err(NoWindow(why)) => Err(Error::failed(
            "window",
            why,
            "write a picture with 'scanout render MODEL -o OUT' instead",
        )),
    }
}

/// A stage that the mouse and the keys move.
pub struct Viewer {
    stage: Stage,
    shot: Shot,
    start: Shot,
    options: Options,
    name: String,
    spins: bool,
    /// Tell the frame rate on standard error.
    pub stats: bool,
    /// Tell the window's keys when the first picture is there.
    pub keys_when_shown: bool,
}

impl Viewer {
    /// A viewer that begins with this shot.
    pub fn new(stage: Stage, shot: Shot, options: Options, name: String) -> Self {
        let start = shot.clone();
        let (spins, stats, keys_when_shown) = (false, false, false);
        Self { stage, shot, start, options, name, spins, stats, keys_when_shown }
    }

    /// The same, turning by itself until the mouse takes over.
    pub fn spinning(self) -> Self {
        Self { spins: true, ..self }
    }

    /// Moves the focal point by pixels of the picture.
    fn pan(&mut self, dx: f64, dy: f64) {
        let view = &mut self.shot.view;
        let (sin, cos) = sin_cos(view.fovy / 2.0);
        let height = 2.0 * view.distance * sin / cos / view.zoom;
        let step = height / f64::from(self.shot.size.1.max(1));
        view.focal = along(view.focal, view.basis[0], -dx * step);
        view.focal = along(view.focal, view.basis[1], dy * step);
    }

    fn key(&mut self, key: char) {
        match key {
            '1'..='7' => self.stage.set_mode(DrawMode::ALL[key as usize - '1' as usize]),
            'r' => {
                let size = self.shot.size;
                self.shot = Shot { size, ..self.start.clone() };
            }
            ' ' => self.spins = !self.spins,
            's' => match self.screenshot() {
                Ok(path) => narrate!("scanout: wrote {}", path.display()),
                Err(error) => narrate!("scanout: {error}"),
            },
            _ => {}
        }
    }

    /// Writes the picture under the first free name of `scanout-0001.png`, `scanout-0002.png`, ... in this folder.
    fn screenshot(&self) -> Result<PathBuf> {
        let picture = draw::frame(&self.stage, &self.shot, &self.options)?.picture;
        for number in 1..10_000 {
            let path = PathBuf::from(format!("scanout-{number:04}.png"));
            match File::create_new(&path) {
                Ok(file) => {
                    image_out::png(&mut BufWriter::new(file), &picture)
                        .map_err(|error| Error::io(&path, &error))?;
                    return Ok(path);
                }
                Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(Error::io(&path, &error)),
            }
        }
        Err(Error::failed("scanout-9999.png", "all names are taken", "move some away"))
    }
}

impl Content for Viewer {
    fn draw(&mut self, width: u16, height: u16, seconds: f64) -> Result<Picture> {
        self.shot.size = (width, height);
        if std::mem::take(&mut self.keys_when_shown) {
            narrate!("{}", window::KEYS);
        }
        if self.spins {
            self.shot.turn = (self.shot.turn + SPIN * seconds.min(0.1)) % 360.0;
        }
        if self.options.format == crate::args::PixelFormat::Rgb888 {
            return draw::picture(&self.stage, &self.shot, &self.options);
        }
        Ok(draw::frame(&self.stage, &self.shot, &self.options)?.picture)
    }

    fn input(&mut self, input: Input) {
        match input {
            Input::Orbit(dx, dy) => {
                self.spins = false;
                let view = &mut self.shot.view;
                view.orbit(-dx * DEGREES_A_PIXEL, dy * DEGREES_A_PIXEL);
            }
            Input::Pan(dx, dy) => self.pan(dx, dy),
            Input::Zoom(notches) => {
                let radius = self.stage.subject.radius;
                let view = &mut self.shot.view;
                let factor = (0..notches.abs().ceil().min(20.0) as u32).fold(1.0, |f, _| f * 0.9);
                let factor = if notches > 0.0 { factor } else { 1.0 / factor };
                view.distance = (view.distance * factor).clamp(radius * 0.1, radius * 50.0);
            }
            Input::Key(key) => self.key(key),
            Input::Arrow(..) | Input::Cursor(..) => {}
        }
    }

    fn moves(&self) -> bool {
        self.spins
    }

    fn title(&self) -> String {
        format!("{} - {}", self.name, self.stage.mode().name())
    }

    fn rate(&mut self, rate: f64, milliseconds: f64) {
        if self.stats {
            let (width, height) = self.shot.size;
            narrate!("{width} x {height}: {rate:.1} frames/s, {milliseconds:.2} ms each");
        }
    }
}
