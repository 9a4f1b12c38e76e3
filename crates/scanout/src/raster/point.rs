//! Points: squares of 1 to 64 pixels a side.
//!
//! With `h = floor(s / 2)`, a point of size `s` at pixel (x, y) covers columns `x - h .. x - h + s`
//! and rows `y - h .. y - h + s`: centred for odd sizes; for even ones the spare column and row are
//! to the left and above. That is the top-left rule for a square about the pixel's centre:
//!
//! ```text
//!   size 1    size 2    size 3          @ the pixel (x, y)
//!              # #       # # #
//!     @        # @       # @ #
//!                        # # #
//! ```
//!
//! No round points, no perspective size. Nothing here panics, at any coordinate.

use super::line::ClipRect;

/// The largest side of a point, in pixels.
pub const MAX_POINT_SIZE: u32 = 64;

/// The pixels inside `clip` of the point at pixel (x, y) with side `size` (limited to
/// `1..=`[`MAX_POINT_SIZE`]), or `None` when there are none. Cost: a dozen operations.
#[must_use]
pub fn square(x: i32, y: i32, size: u32, clip: ClipRect) -> Option<ClipRect> {
    let size = size.clamp(1, MAX_POINT_SIZE) as i32;
    // Saturation only moves edges that no clip rectangle reaches.
    let (left, top) = (x.saturating_sub(size / 2), y.saturating_sub(size / 2));
    let (right, bottom) = (x.saturating_add(size - size / 2), y.saturating_add(size - size / 2));
    let out = ClipRect {
        x0: left.max(clip.x0),
        y0: top.max(clip.y0),
        x1: right.min(clip.x1),
        y1: bottom.min(clip.y1),
    };
    (out.x0 < out.x1 && out.y0 < out.y1).then_some(out)
}

/// Calls `plot(x, y)` for each pixel of [`square`], rows top to bottom, each left to right.
#[inline]
pub fn draw_point(x: i32, y: i32, size: u32, clip: ClipRect, mut plot: impl FnMut(i32, i32)) {
    let Some(area) = square(x, y, size, clip) else { return };
    for y in area.y0..area.y1 {
        for x in area.x0..area.x1 {
            plot(x, y);
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::{string::String, vec::Vec};

    fn picture(x: i32, y: i32, size: u32) -> String {
        let mut cells = [b'.'; 5 * 4];
        draw_point(x, y, size, ClipRect { x0: 0, y0: 0, x1: 5, y1: 4 }, |x, y| {
            let cell = &mut cells[y as usize * 5 + x as usize];
            assert_eq!(*cell, b'.', "a pixel drawn twice at {x}, {y}");
            *cell = b'#';
        });
        cells.chunks(5).map(|row| std::str::from_utf8(row).unwrap()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn pictures() {
        assert_eq!(picture(2, 2, 1), "..... ..... ..#.. .....");
        assert_eq!(picture(2, 2, 2), "..... .##.. .##.. .....");
        assert_eq!(picture(2, 2, 3), "..... .###. .###. .###.");
        assert_eq!(picture(2, 2, 4), "####. ####. ####. ####.");
        assert_eq!(picture(0, 0, 3), "##... ##... ..... .....");
        assert_eq!(picture(6, 3, 3), "..... ..... ..... .....");
        assert_eq!(picture(6, 3, 4), "..... ....# ....# ....#");
        assert_eq!(picture(2, 2, 64), "##### ##### ##### #####");
    }

    #[test]
    fn sizes_and_extremes() {
        let all = ClipRect { x0: i32::MIN, y0: i32::MIN, x1: i32::MAX, y1: i32::MAX };
        for size in 0..70 {
            let mut count = 0;
            draw_point(-7, 1000, size, all, |_, _| count += 1);
            assert_eq!(count, size.clamp(1, 64).pow(2));
        }
        assert_eq!(square(i32::MIN, 0, 64, all).map(|a| a.x1 - a.x0), Some(32));
        // The last column of all lies outside every half-open rectangle.
        assert_eq!(square(i32::MAX, 0, 1, all), None);
        assert_eq!(square(0, 0, 9, ClipRect { x0: 5, y0: 0, x1: 5, y1: 9 }), None);
        assert_eq!(square(0, 0, 9, ClipRect { x0: i32::MAX, y0: 0, x1: i32::MIN, y1: 9 }), None);
    }
}
