//! Draws the quadrilateral of the no_std probe in each drawing mode and at several distances, and prints the frames' hashes: on a
//! microcontroller (QEMU's) by semihosting, on a PC as a program. Where the lines are equal, the pixels are.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod board;
#[path = "../../no-std-probe/src/frame.rs"]
mod frame;

use scanout::math::Q16;

/// Number of drawing modes that [`frame::hash`] knows.
const MODES: u8 = 6;

/// Calls `print` with a line for each frame: mode, distance, hash.
fn run(mut print: impl FnMut(&str)) {
    for mode in 0..MODES {
        // Within 1 of the near plane the corners are clipped; at 9 the pixels are few.
        for distance in [2, 3, 9] {
            let hash = frame::hash(Q16::from_int(distance), mode).unwrap_or(0);
            let mut line = *b"mode 0 distance 0: 0000000000000000\n";
            line[5] = b'0' + mode;
            line[16] = b'0' + distance as u8;
            for (i, digit) in line[19..35].iter_mut().enumerate() {
                *digit = b"0123456789abcdef"[(hash >> (60 - 4 * i)) as usize & 15];
            }
            print(str::from_utf8(&line).unwrap_or("not UTF-8\n"));
        }
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    run(|line| print!("{line}"));
}
