//! System A's whole purpose on system B's machine: finds a marker in stored frames of 320x240, and draws a cube's wireframe over them,
//! black where drawn and the camera elsewhere. Prints the corners and poses to the last bit and the hash of each frame as a display
//! takes it. On a microcontroller (QEMU's) by semihosting, on a PC as a program; where the lines are equal, so is everything.
//!
//! On a microcontroller each frame then goes to an ST7789, whose wires are lines of text; `marker-probe --shown` is that display: it
//! decodes such lines and prints the hash of each frame that is shown.
//!
//! Lines that begin with # are counts of this machine and may differ.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
#[path = "../../bare-metal-probe/src/board.rs"]
mod board;
mod display;
mod overlay;
#[cfg(not(target_os = "none"))]
mod shown;

use core::fmt::Write;

use scanout_ar::detect::{Detection, Memory, Needed, Parameters, detect};
use scanout_ar::pose::planar::solve_square;
use scanout_ar::{Dictionary, GreyImage, Lens};

/// Pixels in a row.
const WIDTH: usize = 320;
/// Rows.
const HEIGHT: usize = 240;
/// A marker's side, metres.
const SIZE: f64 = 0.08;

static FRAMES: [&[u8; WIDTH * HEIGHT]; 4] = [
    include_bytes!("../frames/0.grey"),
    include_bytes!("../frames/1.grey"),
    include_bytes!("../frames/2.grey"),
    include_bytes!("../frames/3.grey"),
];

/// A line of text.
struct Line {
    bytes: [u8; 200],
    length: usize,
}

impl Default for Line {
    fn default() -> Self {
        Self { bytes: [0; 200], length: 0 }
    }
}

impl Line {
    fn text(&self) -> &str {
        str::from_utf8(&self.bytes[..self.length]).unwrap_or_default()
    }
}

impl Write for Line {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        let to =
            self.bytes.get_mut(self.length..self.length + text.len()).ok_or(core::fmt::Error)?;
        to.copy_from_slice(text.as_bytes());
        self.length += text.len();
        Ok(())
    }
}

/// Instructions so far, or 0 where they aren't counted.
fn instructions() -> u64 {
    #[cfg(target_arch = "riscv64")]
    {
        let count: u64;
        // SAFETY: reading a counter changes nothing.
        unsafe { core::arch::asm!("csrr {}, minstret", out(reg) count) };
        count
    }
    #[cfg(not(target_arch = "riscv64"))]
    0
}

/// Says a line.
fn say(print: &mut impl FnMut(&str), text: core::fmt::Arguments) {
    let mut line = Line::default();
    match line.write_fmt(text).and_then(|()| line.write_char('\n')) {
        Ok(()) => print(line.text()),
        Err(_) => print("too long\n"),
    }
}

/// Calls `print` with lines for each frame; with `wired`, those of the display's wires too.
fn run_with(mut print: impl FnMut(&str), wired: bool) {
    const NEEDED: Needed = Needed::for_size(WIDTH, HEIGHT);
    let mut memory = Memory {
        sums: &mut [0; NEEDED.sums],
        bits: &mut [0; NEEDED.bits],
        passed: &mut [0; NEEDED.bits],
        halves: &mut [0; NEEDED.halves],
        points: &mut [[0; 2]; NEEDED.points],
    };
    say(&mut print, format_args!("# detector: {} bytes beside the picture", NEEDED.bytes()));
    let lens = Lens { focal: [300.0, 300.0], centre: [160.0, 120.0], distortion: [0.0; 5] };
    for (number, frame) in FRAMES.iter().enumerate() {
        let Some(image) = GreyImage::new(WIDTH, HEIGHT, WIDTH, *frame) else { return };
        let mut found = [Detection::default(); 8];
        let start = instructions();
        let count = detect(
            &image,
            &[Dictionary::ARUCO_4X4_50],
            &Parameters::default(),
            &mut memory,
            &mut found,
        );
        let detected = instructions();
        let found = &found[..count.unwrap_or(0)];
        let mut pose = None;
        for one in found {
            say(&mut print, format_args!("frame {number} marker {}", one.id));
            for [x, y] in one.corners {
                say(&mut print, format_args!("  corner {:016x} {:016x}", x.to_bits(), y.to_bits()));
            }
            pose = solve_square(&lens, SIZE, &one.corners).map(|both| both[0].pose);
        }
        let solved = instructions();
        if let Some(pose) = &pose {
            for (row, t) in pose.rotation.iter().zip(pose.translation) {
                let [a, b, c] = row.map(f64::to_bits);
                say(
                    &mut print,
                    format_args!("  pose {a:016x} {b:016x} {c:016x} {:016x}", t.to_bits()),
                );
            }
        }
        let before = instructions();
        let hash = overlay::hash(*frame, &lens, pose.as_ref(), SIZE).unwrap_or(0);
        let drawn = instructions();
        say(&mut print, format_args!("frame {number} hash {hash:016x}"));
        say(
            &mut print,
            format_args!(
                "# frame {number} instructions: detect {} pose {} overlay {}",
                detected - start,
                solved - detected,
                drawn - before
            ),
        );
        if wired && send(&mut print, *frame, &lens, pose.as_ref()).is_none() {
            say(&mut print, format_args!("frame {number} not sent"));
        }
    }
}

/// Draws a frame once more and sends it to a display.
fn send(
    print: &mut impl FnMut(&str),
    frame: &[u8],
    lens: &Lens,
    pose: Option<&scanout_ar::Pose>,
) -> Option<()> {
    let wires = display::Wires::new(print);
    let mut buffer = [0; 512];
    let mut display = wires.start(&mut buffer)?;
    overlay::draw(frame, lens, pose, SIZE, |band| {
        scanout_display::band::show(&mut display, band).ok()
    })
}

#[cfg(target_os = "none")]
fn run(print: impl FnMut(&str)) {
    run_with(print, true);
}

#[cfg(not(target_os = "none"))]
fn main() -> std::process::ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        [] => run_with(|line| print!("{line}"), false),
        ["--wired"] => run_with(|line| print!("{line}"), true),
        ["--shown"] => {
            if let Err(what) = shown::print(std::io::stdin().lock()) {
                eprintln!("marker-probe: {what}");
                return std::process::ExitCode::FAILURE;
            }
        }
        _ => {
            eprintln!("usage: marker-probe [--wired | --shown < LINES]");
            return std::process::ExitCode::from(2);
        }
    }
    std::process::ExitCode::SUCCESS
}
