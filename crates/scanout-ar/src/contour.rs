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
    let mut area = Dark { bits: &bits[..row * height], passed, row };
    for y in 1..height.saturating_sub(1) {
        let mut carry = 0;
        for word in y * row..(y + 1) * row {
            let dark = area.bits[word];
            if dark == 0 {
                carry = 0;
                continue;
            }
            // Dark with light on the left.
            let starts = dark & !(dark << 1 | carry);
            carry = dark >> 31;
            // Following one outline passes others of this word.
            loop {
                let left = starts & !area.passed[word];
                if left == 0 {
                    break;
                }
                let x = (word - y * row) * 32 + left.trailing_zeros() as usize;
                let outline = area.outline(x, y, points);
                if outline.area > 0 {
                    each(outline, &points[..outline.length.min(points.len())]);
                }
            }
        }
    }
}

struct Dark<'a> {
    bits: &'a [u32],
    passed: &'a mut [u32],
    /// Words in a row.
    row: usize,
}

impl Dark<'_> {
    /// The outline through the left crack of pixel (x, y), from its lower end.
    fn outline(&mut self, x: usize, y: usize, points: &mut [Point]) -> Outline {
        let row = self.row * 32;
        // The number of the pixel right and below of where the walk stands; those of the three others around are known from it.
        let start = (y + 1) * row + x;
        let mut here = start;
        let (mut x, mut y) = (x as i32, y as i32 + 1);
        // At most 2 to the 28th in the end, whatever it is on the way.
        let (mut length, mut area) = (0, 0i32);
        let mut direction = Direction::Up;
        loop {
            if let Some(point) = points.get_mut(length) {
                *point = [x as i16, y as i16];
            }
            length += 1;
            match direction {
                Direction::Up => {
                    here -= row;
                    self.passed[here / 32] |= 1 << (here % 32);
                    area = area.wrapping_sub(x);
                    y -= 1;
                    if self.at(here - row - 1) {
                        direction = Direction::Left;
                    } else if !self.at(here - row) {
                        direction = Direction::Right;
                    }
                }
                Direction::Right => {
                    here += 1;
                    x += 1;
                    if self.at(here - row) {
                        direction = Direction::Up;
                    } else if !self.at(here) {
                        direction = Direction::Down;
                    }
                }
                Direction::Down => {
                    here += row;
                    area = area.wrapping_add(x);
                    y += 1;
                    if self.at(here) {
                        direction = Direction::Right;
                    } else if !self.at(here - 1) {
                        direction = Direction::Left;
                    }
                }
                Direction::Left => {
                    here -= 1;
                    x -= 1;
                    if self.at(here - 1) {
                        direction = Direction::Down;
                    } else if !self.at(here - row - 1) {
                        direction = Direction::Up;
                    }
                }
            }
            if here == start && direction == Direction::Up {
                return Outline { length, area: area.into() };
            }
        }
    }

    fn at(&self, pixel: usize) -> bool {
        self.bits[pixel / 32] >> (pixel % 32) & 1 == 1
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Direction {
    Up,
    Right,
    Down,
    Left,
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
