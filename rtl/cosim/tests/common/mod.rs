//! A screen beside its monitor: pictures go in as pixels, frames come out of the pins.
#![allow(dead_code, reason = "each test uses its part")]

use std::collections::VecDeque;

use scanout::raster::line::{self, ClipRect, LineEnd};
use scanout_cosim::monitor::{Mode, Monitor, Seen};
use scanout_cosim::{Model, Port, Random};
use scanout_head::stereo::Arrangement;

/// The codes of the RTL (see `stereo_place.sv`) and what they are to the library; `None` is one eye.
pub const ARRANGEMENTS: [(u32, Option<Arrangement>); 10] = [
    (0, None),
    (1, Some(Arrangement::Anaglyph)),
    (2, Some(Arrangement::SideBySide)),
    (2, Some(Arrangement::SideBySideHalf)),
    (3, Some(Arrangement::Interlaced)),
    (4, Some(Arrangement::TopBottom)),
    (4, Some(Arrangement::TopBottomHalf)),
    (5, Some(Arrangement::AnaglyphGrey)),
    (6, Some(Arrangement::AnaglyphHalfColour)),
    (7, Some(Arrangement::AnaglyphDubois)),
];

/// A pixel on its way to the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pixel {
    pub x: i32,
    pub y: i32,
    pub rgb: [u8; 3],
    pub steep: bool,
    pub group: u8,
    pub right: bool,
}

/// Whether only modules that have a netlist are tested again; whole screens have none.
pub fn netlists_only() -> bool {
    std::env::var_os("SCANOUT_SHORT").is_some_and(|v| !v.is_empty())
}

pub fn pack(rgb: [u8; 3]) -> u32 {
    u32::from_be_bytes([0, rgb[0], rgb[1], rgb[2]])
}

/// The pixels of a line inside a picture.
pub fn line(a: LineEnd, b: LineEnd, size: (i32, i32), group: u8) -> Vec<Pixel> {
    let clip = ClipRect { x0: 0, y0: 0, x1: size.0, y1: size.1 };
    let steep = a.y.abs_diff(b.y) > a.x.abs_diff(b.x);
    let mut pixels = Vec::new();
    line::walk(&a, &b, clip, |x, y, _, rgb| {
        pixels.push(Pixel { x, y, rgb, steep, group, right: false });
    });
    pixels
}

pub fn any_end(random: &mut Random, size: (i32, i32)) -> LineEnd {
    LineEnd {
        x: random.below(size.0 as u64) as i32,
        y: random.below(size.1 as u64) as i32,
        z: 0,
        rgb: [0; 3].map(|_: u8| random.below(256) as u8),
    }
}

/// A screen with the ports of `screen.sv`.
pub struct Screen {
    pub model: Model,
    pub random: Random,
    monitor: Monitor,
    clk: Port,
    draw_clk: Port,
    want: Port,
    enable: Port,
    done: Port,
    valid: Port,
    ready: Port,
    pixel: [Port; 6],
    syncs: [Port; 2],
    rgb: [Port; 3],
    camera: Option<Camera>,
    /// Clocks of the drawing side for each pixel clock, in quarters; `None`: one clock for both.
    pub draw_quarters: Option<u64>,
    /// How often the drawing side has no pixel, in percent.
    pub stalls: u64,
    queue: VecDeque<Vec<Pixel>>,
    next: usize,
    offered: bool,
    quarters: u64,
}

/// A camera that delivers a frame again and again.
pub struct Camera {
    ports: [Port; 4],
    pub frame: Vec<[u8; 3]>,
    at: usize,
    /// How often it has no pixel, in percent.
    pub stalls: u64,
    fifo: VecDeque<(bool, [u8; 3])>,
}

impl Screen {
    pub fn new(name: &str, mode: Mode, seed: u64) -> Screen {
        let mut model = Model::new(name);
        let port = |name: &str| model.port(name);
        let mut screen = Screen {
            monitor: Monitor::new(mode),
            random: Random::new(seed),
            clk: port("clk"),
            draw_clk: port("draw_clk"),
            want: port("draw_want"),
            enable: port("draw_enable"),
            done: port("draw_done"),
            valid: port("s_valid"),
            ready: port("s_ready"),
            pixel: ["s_x", "s_y", "s_rgb", "s_steep", "s_group", "s_right"].map(port),
            syncs: ["hsync", "vsync"].map(port),
            rgb: ["r", "g", "b"].map(port),
            camera: None,
            draw_quarters: None,
            stalls: 0,
            queue: VecDeque::new(),
            next: 0,
            offered: false,
            quarters: 0,
            model,
        };
        let (rst_n, draw_rst_n) = (screen.model.port("rst_n"), screen.model.port("draw_rst_n"));
        for _ in 0..8 {
            screen.draw_edge();
            screen.pixel_edge();
        }
        model = screen.model;
        model.set(rst_n, 1);
        model.set(draw_rst_n, 1);
        model.eval();
        screen.model = model;
        screen
    }

    pub fn set(&mut self, name: &str, value: u32) {
        let port = self.model.port(name);
        self.model.set(port, value);
    }

    pub fn attach_camera(&mut self, frame: Vec<[u8; 3]>) {
        let ports =
            ["valid", "ready", "first", "rgb"].map(|n| self.model.port(&format!("s_camera_{n}")));
        self.camera = Some(Camera { ports, frame, at: 0, stalls: 0, fifo: VecDeque::new() });
        self.set("camera_enable", 1);
    }

    pub fn camera(&mut self) -> &mut Camera {
        self.camera.as_mut().expect("a camera is attached")
    }

    /// Pictures to be drawn one after the other.
    pub fn draw(&mut self, pictures: impl IntoIterator<Item = Vec<Pixel>>) {
        self.queue.extend(pictures);
    }

    /// Pictures that are not yet finished.
    pub fn waiting(&self) -> usize {
        self.queue.len()
    }

    fn edge(&mut self, clocks: &[Port]) {
        for &clk in clocks {
            self.model.set(clk, 0);
        }
        self.model.eval();
        for &clk in clocks {
            self.model.set(clk, 1);
        }
        self.model.eval();
    }

    fn pixel_edge(&mut self) {
        self.edge(&[self.clk]);
    }

    fn draw_edge(&mut self) {
        self.edge(&[self.draw_clk]);
    }

    /// What the drawing side offers before its next edge; whether something is taken with it.
    fn offer(&mut self) -> bool {
        let model = &mut self.model;
        model.set(self.done, 0);
        model.set(self.want, u8::from(!self.queue.is_empty()));
        let Some(picture) = self.queue.front() else {
            model.set(self.valid, 0);
            model.eval();
            return false;
        };
        if let Some(p) = picture.get(self.next) {
            self.offered = self.offered || !self.random.percent(self.stalls);
            let values =
                [p.x, p.y, pack(p.rgb) as i32, p.steep.into(), p.group.into(), p.right.into()];
            for (port, value) in self.pixel.into_iter().zip(values) {
                model.set(port, value);
            }
            model.set(self.valid, u8::from(self.offered));
            model.eval();
            self.offered && model.get(self.ready) == 1
        } else {
            model.set(self.valid, 0);
            model.eval();
            let enabled = model.get(self.enable);
            model.set(self.done, enabled);
            enabled == 1
        }
    }

    fn taken(&mut self) {
        self.offered = false;
        if self.next < self.queue[0].len() {
            self.next += 1;
        } else {
            self.queue.pop_front();
            self.next = 0;
        }
    }

    fn offer_camera(&mut self) -> bool {
        let Some(camera) = &mut self.camera else { return false };
        // A FIFO of 16 pixels is behind the sensor.
        if camera.fifo.len() < 16 && !self.random.percent(camera.stalls) && !camera.frame.is_empty()
        {
            camera.fifo.push_back((camera.at == 0, camera.frame[camera.at]));
            camera.at = (camera.at + 1) % camera.frame.len();
        }
        let head = camera.fifo.front().copied();
        let [valid, ready, first, rgb] = camera.ports;
        self.model.set(valid, u8::from(head.is_some()));
        self.model.set(first, u8::from(head.is_some_and(|h| h.0)));
        self.model.set(rgb, head.map_or(0, |h| pack(h.1)));
        self.model.eval();
        head.is_some() && self.model.get(ready) == 1
    }

    /// One pixel clock and what the drawing side does in that time.
    pub fn clock(&mut self) -> Option<Seen> {
        let camera_taken = self.offer_camera();
        match self.draw_quarters {
            None => {
                let taken = self.offer();
                self.edge(&[self.clk, self.draw_clk]);
                if taken {
                    self.taken();
                }
            }
            Some(quarters) => {
                self.quarters += quarters;
                while self.quarters >= 4 {
                    self.quarters -= 4;
                    let taken = self.offer();
                    self.draw_edge();
                    if taken {
                        self.taken();
                    }
                }
                self.pixel_edge();
            }
        }
        if camera_taken {
            self.camera().fifo.pop_front();
        }
        let [hsync, vsync] = self.syncs.map(|p| self.model.get(p) == 1);
        let rgb = self.rgb.map(|p| self.model.get(p) as u8);
        self.monitor.clock(hsync, vsync, rgb)
    }

    /// Runs until the monitor has seen so many more frames.
    pub fn frames(&mut self, count: usize) -> Vec<Seen> {
        let mut seen = Vec::new();
        let mut clocks = 0u64;
        while seen.len() < count {
            seen.extend(self.clock());
            clocks += 1;
            assert!(clocks < 1_000_000 * (count as u64 + 3), "the monitor sees no frames");
        }
        seen
    }
}

/// Doubles a picture in both directions.
pub fn doubled(picture: &[[u8; 3]], width: usize) -> Vec<[u8; 3]> {
    let line = |row: &[[u8; 3]]| row.iter().flat_map(|&p| [p, p]).collect::<Vec<_>>();
    picture.chunks(width).flat_map(|row| [line(row), line(row)].concat()).collect()
}

/// What the pins of widths `bits` show of a colour.
pub fn pins(rgb: [u8; 3], bits: [u32; 3]) -> [u8; 3] {
    [0, 1, 2].map(|c| rgb[c] >> (8 - bits[c]))
}

/// Where two pictures differ, as a text.
pub fn difference(got: &[[u8; 3]], wanted: &[[u8; 3]], width: usize) -> Option<String> {
    assert_eq!(got.len(), wanted.len());
    let wrong: Vec<usize> = (0..got.len()).filter(|&i| got[i] != wanted[i]).collect();
    let &first = wrong.first()?;
    let (x, y) = (first % width, first / width);
    let n = wrong.len();
    Some(format!(
        "{n} pixels differ, first ({x}, {y}): got {:?}, wanted {:?}",
        got[first], wanted[first]
    ))
}
