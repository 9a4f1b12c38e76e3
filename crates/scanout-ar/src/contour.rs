//! Outlines of dark areas.
//!
//! An outline runs along the cracks between dark and light pixels, the dark on its right hand:
//!
//! ```text
//!        L | R          at each corner of pixels, look at the two pixels ahead:
//!       ---v---         L dark: turn left;  L light, R dark: straight on;  both light: turn right
//!          ^
//! ```
//!
//! So dark pixels that touch by a corner are together (8-connected): the border of a small, slanted marker holds. Each crack with light on its left and dark on its right
//! side belongs to one outline; a bit a pixel remembers those that were passed. Outlines around dark areas have positive area,
//! those around holes negative.
//!
//! Source: crack following after Rosenfeld, "Connectivity in digital pictures", 1970. Integers only. Nothing dark may touch the
//! picture's edge; [`crate::threshold`] sees to that.

use crate::threshold::words;

/// A corner of pixels: x to the right, y down, from the picture's outer corner.
pub type Point = [i16; 2];

/// What is known of an outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outline {
    /// Cracks: its length in the city-block metric. Those beyond the memory are counted, not kept.
    pub length: usize,
    /// Pixels inside, holes not taken away; negative for the outline of a hole.
    pub area: i64,
}

/// Follows every outline of the dark pixels in `bits` (as [`crate::threshold::adaptive`] writes them) and hands those that surround
/// dark areas to `each`, with as many of their corners as `points` holds.
///
/// `passed` is working memory as large as `bits`.
pub fn follow(
    bits: &[u32],
    (width, height): (usize, usize),
    passed: &mut [u32],
    points: &mut [Point],
    mut each: impl FnMut(Outline, &[Point]),
) {
    let row = words(width);
    let passed = &mut passed[..row * height];
    passed.fill(0);
    let area = Dark { bits: &bits[..row * height], row };
    for y in 1..height.saturating_sub(1) {
        let mut carry = 0;
        for word in 0..row {
            let dark = bits[y * row + word];
            // Dark with light on the left.
            let starts = dark & !(dark << 1 | carry);
            carry = dark >> 31;
            // Following one outline passes others of this word.
            loop {
                let left = starts & !passed[y * row + word];
                if left == 0 {
                    break;
                }
                let x = word * 32 + left.trailing_zeros() as usize;
                let outline = area.outline(x, y, passed, points);
                if outline.area > 0 {
                    each(outline, &points[..outline.length.min(points.len())]);
                }
            }
        }
    }
}

struct Dark<'a> {
    bits: &'a [u32],
    row: usize,
}

impl Dark<'_> {
    fn at(&self, x: i32, y: i32) -> bool {
        let (x, y) = (x as usize, y as usize);
        self.bits[y * self.row + x / 32] >> (x % 32) & 1 == 1
    }

    /// The outline through the left crack of pixel (x, y), from its lower end.
    fn outline(&self, x: usize, y: usize, passed: &mut [u32], points: &mut [Point]) -> Outline {
        // Directions clockwise from up: the step, then the pixels ahead on the left and on the right.
        const STEP: [(i32, i32); 4] = [(0, -1), (1, 0), (0, 1), (-1, 0)];
        const LEFT: [(i32, i32); 4] = [(-1, -1), (0, -1), (0, 0), (-1, 0)];
        const RIGHT: [(i32, i32); 4] = [(0, -1), (0, 0), (-1, 0), (-1, -1)];
        let start = (x as i32, y as i32 + 1);
        let (mut at, mut direction) = (start, 0);
        let (mut length, mut area) = (0, 0);
        loop {
            if let Some(point) = points.get_mut(length) {
                *point = [at.0 as i16, at.1 as i16];
            }
            length += 1;
            match direction {
                0 => {
                    let (x, y) = (at.0 as usize, at.1 as usize - 1);
                    passed[y * self.row + x / 32] |= 1 << (x % 32);
                    area -= i64::from(at.0);
                }
                2 => area += i64::from(at.0),
                _ => {}
            }
            at = (at.0 + STEP[direction].0, at.1 + STEP[direction].1);
            let ahead =
                |side: [(i32, i32); 4]| self.at(at.0 + side[direction].0, at.1 + side[direction].1);
            if ahead(LEFT) {
                direction = (direction + 3) % 4;
            } else if !ahead(RIGHT) {
                direction = (direction + 1) % 4;
            }
            if at == start && direction == 0 {
                return Outline { length, area };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec;
    use std::vec::Vec;

    fn outlines(picture: &str) -> Vec<(usize, i64)> {
        let lines: Vec<&str> = picture.split_whitespace().collect();
        let (width, height) = (lines[0].len(), lines.len());
        let mut bits = vec![0u32; words(width) * height];
        for (y, line) in lines.iter().enumerate() {
            for (x, _) in line.bytes().enumerate().filter(|(_, cell)| *cell == b'#') {
                bits[y * words(width) + x / 32] |= 1 << (x % 32);
            }
        }
        let mut found = vec![];
        follow(&bits, (width, height), &mut bits.clone(), &mut [[0; 2]; 9], |outline, points| {
            assert_eq!(points.len(), outline.length.min(9));
            found.push((outline.length, outline.area));
        });
        found
    }

    #[test]
    fn areas_and_lengths() {
        assert_eq!(outlines("... .#. ..."), [(4, 1)]);
        assert_eq!(outlines("..... .##.. .##.. ....."), [(8, 4)]);
        // A hole belongs to what is around it; what stands in the hole is an area of its own.
        assert_eq!(
            outlines("....... .#####. .#...#. .#.#.#. .#...#. .#####. ......."),
            [(20, 25), (4, 1)]
        );
        // By a corner: one area.
        assert_eq!(outlines(".... .#.. ..#. ...."), [(8, 2)]);
        assert_eq!(outlines("..... .#.#. .###. ....."), [(12, 5)]);
        assert_eq!(outlines("..... .#... ...#. ....."), [(4, 1), (4, 1)]);
    }

    #[test]
    fn outlines_cross_words() {
        let line = |inside: &str| std::format!(".{inside}. ");
        let picture = line(&".".repeat(70)) + &line(&"#".repeat(70)) + &line(&".".repeat(70));
        assert_eq!(outlines(&picture), [(142, 70)]);
    }
}
