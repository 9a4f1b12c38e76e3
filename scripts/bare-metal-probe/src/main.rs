//! Draws the quadrilateral of the no_std probe in each drawing mode and at several distances, and the head-tracked window's room for
//! some places of the viewer in stereo, and prints the frames' hashes: on a microcontroller (QEMU's) by semihosting, on a PC as a
//! program. Where the lines are equal, the pixels are.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod board;
#[path = "../../no-std-probe/src/frame.rs"]
mod frame;
mod window;

use scanout::math::Q16;

/// Number of drawing modes that [`frame::hash`] knows.
const MODES: u8 = 6;

/// Calls `print` with the parts of a line for each frame: what it shows, its hash.
fn run(mut print: impl FnMut(&str)) {
    for mode in 0..MODES {
        // Within 1 of the near plane the corners are clipped; at 9 the pixels are few.
        for distance in [2, 3, 9] {
            let mut text = *b"mode 0 distance 0: ";
            (text[5], text[16]) = (b'0' + mode, b'0' + distance as u8);
            print(str::from_utf8(&text).unwrap_or_default());
            print_hash(&mut print, frame::hash(Q16::from_int(distance), mode));
        }
    }
    for (number, middle) in (b'0'..).zip(window::MIDDLES) {
        for (name, how) in window::ARRANGEMENTS {
            print("window, viewer ");
            print(str::from_utf8(&[number]).unwrap_or_default());
            print(", ");
            print(name);
            print(": ");
            print_hash(&mut print, window::hash(middle, how));
        }
    }
}

/// In hexadecimal; a frame that could not be drawn says so.
fn print_hash(print: &mut impl FnMut(&str), hash: Option<u64>) {
    let Some(hash) = hash else { return print("not drawn\n") };
    let mut line = *b"0000000000000000\n";
    for (i, digit) in line[..16].iter_mut().enumerate() {
        *digit = b"0123456789abcdef"[(hash >> (60 - 4 * i)) as usize & 15];
    }
    print(str::from_utf8(&line).unwrap_or_default());
}

#[cfg(not(target_os = "none"))]
fn main() {
    run(|line| print!("{line}"));
}
