//! Instructions a frame of system B's scene: models A at 0.35, B and C at 0.9, one turn of 90 frames, the mean; and a hash over
//! the frames' hashes, which is the PC's.
//!
//! Counted is all that a frame needs: preparing, clearing, drawing. Not counted is the hash. On RISC-V the counter is `minstret`; on
//! Cortex-M the SysTick, which under QEMU's `-icount shift=0` goes one step for 40 instructions. On a PC nothing is counted, and
//! the lines have the hashes alone.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../../../scripts/bare-metal-probe/src/board.rs"]
mod board;
mod counter;

use core::fmt::{self, Write as _};

use player::scene::{self, HEIGHT, Model, Placement, TURN, WIDTH};
use scanout::frame::{Frame, ObjectState, Primitive, Settings, Store};
use scanout::hash::{FORMAT_RGB565, FrameHash};
use scanout::math::Q16;
use scanout::transform::Vertex;
use scanout_assets::bake::{Aligned, read};

type Baked = (&'static str, &'static Aligned<[u8]>, Q16);

static MODELS: [Baked; 3] = [
    ("A", &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/a.mesh"))), Q16::from_ratio(35, 100)),
    ("B", &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/b.mesh"))), Q16::from_ratio(9, 10)),
    ("C", &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/c.mesh"))), Q16::from_ratio(9, 10)),
];

/// Memory of a frame: model A's vertices and triangles, colour and depth of the whole frame.
struct Memory {
    vertices: [Vertex; 400],
    primitives: [Primitive; 800],
    colour: [u16; WIDTH as usize * HEIGHT as usize],
    depth: [u16; WIDTH as usize * HEIGHT as usize],
}

/// Text of a bounded length.
struct Line {
    text: [u8; 96],
    length: usize,
}

impl fmt::Write for Line {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let end = self.length + text.len();
        self.text.get_mut(self.length..end).ok_or(fmt::Error)?.copy_from_slice(text.as_bytes());
        self.length = end;
        Ok(())
    }
}

/// Calls `print` with a line for each model and height of bands.
fn run(mut print: impl FnMut(&str)) {
    counter::start();
    let mut memory = Memory {
        vertices: [Vertex::default(); 400],
        primitives: [Primitive::default(); 800],
        colour: [0; WIDTH as usize * HEIGHT as usize],
        depth: [0; WIDTH as usize * HEIGHT as usize],
    };
    for (name, bytes, scale) in MODELS {
        for lines in [HEIGHT, 16, 4] {
            let mut line = Line { text: [0; 96], length: 0 };
            let _ = match turn(bytes, scale, lines, &mut memory) {
                Some((hash, mean)) => {
                    let _ = write!(line, "{name} {lines:3} {hash:016x}");
                    if mean > 0 { writeln!(line, " {mean}") } else { writeln!(line) }
                }
                None => writeln!(line, "{name} can't be drawn"),
            };
            print(core::str::from_utf8(&line.text[..line.length]).unwrap_or("not UTF-8\n"));
        }
    }
}

/// A turn: the hash of the frames' pixels one after another, and the mean of instructions a frame.
fn turn(
    bytes: &'static Aligned<[u8]>,
    scale: Q16,
    lines: u16,
    memory: &mut Memory,
) -> Option<(u64, u32)> {
    let baked = read(&bytes.0).ok()?;
    let part = baked.part(0)?;
    let texture = baked.texture(part.texture?);
    let placement = Placement { scale: baked.scale(), offset: baked.offset() };
    let model = Model { mesh: part.mesh, texture, placement };
    let mut hash = FrameHash::new(WIDTH, HEIGHT, FORMAT_RGB565);
    let mut count = 0;
    for number in 0..TURN {
        scene::with_scene(&model, scale, number, |scene| {
            let Memory { vertices, primitives, colour, depth } = &mut *memory;
            let mut objects = [ObjectState::default()];
            let store = Store { vertices, primitives, objects: &mut objects };
            let mut before = counter::now();
            let frame = Frame::prepare(scene, Settings::new(WIDTH, HEIGHT), store).ok()?;
            let size = usize::from(lines) * usize::from(WIDTH);
            let (colour, depth) = (&mut colour[..size], &mut depth[..size]);
            for top in (0..HEIGHT).step_by(lines.into()) {
                frame.draw_rows_rgb565(top..top + lines, colour, depth).ok()?;
                count += counter::since(before);
                for pixel in &*colour {
                    hash.update(&pixel.to_be_bytes());
                }
                before = counter::now();
            }
            Some(())
        })?;
    }
    Some((hash.finish(), counter::instructions(count / u64::from(TURN))))
}

#[cfg(not(target_os = "none"))]
fn main() {
    run(|line| print!("{line}"));
}
