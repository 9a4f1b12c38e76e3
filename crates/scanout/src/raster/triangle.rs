//! Triangles to pixels: two traversals of the same exact edge functions.
//!
//! [`spans`] solves each row's ends. For an edge `a x + b y + k >= 0` with `f(y) = floor((b y + k) / |a|)`:
//!
//! ```text
//!   a > 0 (left edge):   x >= -f(y)             first column = max of -f over left edges
//!   a < 0 (right edge):  x <=  f(y)             last column  = min of  f over right edges
//!   a = 0:               decided by the box
//! ```
//!
//! `f` is carried from row to row exactly, so a band may begin at any row. [`tiles`] walks 8 x 8 tiles and tests the edges at every
//! pixel. Both emit the same pixels; `rows` and `width` only cut.
//!
//! Cost of a row: three additions and five comparisons; six divisions a triangle.

use crate::setup::{Edge, Triangle};
use core::ops::Range;

/// `f(y) = floor((b y + k) / |a|)` of an edge, from row to row.
trait Bound: Copy {
    /// At row `y`.
    fn new(edge: &Edge, y: i32) -> Self;
    /// To the next row.
    fn advance(&mut self);
    /// The value, within +-2^29.
    fn floor(&self) -> i32;
}

/// For [`small`](Triangle::small) triangles: the quotient with 32 fraction bits, rounded down, and a bias of 2^-18.
///
/// Over at most 2^12 rows the rounded step falls behind by less than 2^-19, so the sum lies above the quotient by at most 2^-18; and a
/// quotient that is not an integer stays at least `1 / |a| >= 2^-16` below the next. So the integer part is exact.
#[derive(Clone, Copy)]
struct SmallBound {
    f: i64,
    step: i64,
}

impl Bound for SmallBound {
    #[inline(always)]
    fn new(edge: &Edge, y: i32) -> Self {
        let d = edge.a.abs();
        let n = edge.b * y as i64 + edge.k;
        // The remainder of a truncating division is made up for by one unit of 2^-32 less.
        let quotient = |n: i64| (n << 32) / d - (n < 0) as i64;
        SmallBound { f: quotient(n) + (1 << 14), step: quotient(edge.b) }
    }
    #[inline(always)]
    fn advance(&mut self) {
        self.f += self.step;
    }
    #[inline(always)]
    fn floor(&self) -> i32 {
        (self.f >> 32) as i32
    }
}

/// For any triangle: quotient and remainder.
#[derive(Clone, Copy)]
struct WideBound {
    f: i64,
    remainder: i64,
    step: i64,
    step_remainder: i64,
    d: i64,
}

impl Bound for WideBound {
    fn new(edge: &Edge, y: i32) -> Self {
        let d = edge.a.abs();
        let n = edge.b * y as i64 + edge.k;
        WideBound {
            f: n.div_euclid(d),
            remainder: n.rem_euclid(d),
            step: edge.b.div_euclid(d),
            step_remainder: edge.b.rem_euclid(d),
            d,
        }
    }
    fn advance(&mut self) {
        self.f += self.step;
        self.remainder += self.step_remainder;
        if self.remainder >= self.d {
            self.remainder -= self.d;
            self.f += 1;
        }
    }
    fn floor(&self) -> i32 {
        self.f.clamp(-(1 << 29), 1 << 29) as i32
    }
}

/// A run of covered pixels in one row: columns `x0..x1`; none where `x0 >= x1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Run {
    /// Row.
    pub y: i32,
    /// First column.
    pub x0: i32,
    /// One past the last column.
    pub x1: i32,
}

/// How many runs are handed over at once: enough for most triangles, small enough for a small stack.
pub const BATCH: usize = 16;

/// Gives the runs of a triangle row by row, from the top, in batches; only `rows` and columns `0..width`.
pub fn spans(t: &Triangle, rows: Range<i32>, width: i32, emit: &mut dyn FnMut(&[Run])) {
    if t.small {
        solve::<SmallBound>(t, rows, width, emit);
    } else {
        solve::<WideBound>(t, rows, width, emit);
    }
}

#[inline(always)]
fn solve<B: Bound>(t: &Triangle, rows: Range<i32>, width: i32, emit: &mut dyn FnMut(&[Run])) {
    let (top, bottom) = (t.min[1].max(rows.start), t.max[1].min(rows.end));
    if top >= bottom || t.max[0] <= 0 || t.min[0] >= width {
        return;
    }
    // A triangle with area has a left and a right edge and, unless one is horizontal, a second on one side.
    let [e, f, g] = &t.edges;
    let (lone, first, second) = if e.a == 0 {
        (f, g, g)
    } else if f.a == 0 {
        (g, e, e)
    } else if g.a == 0 {
        (e, f, f)
    } else if (f.a ^ g.a) >= 0 {
        (e, f, g)
    } else if (e.a ^ g.a) >= 0 {
        (f, g, e)
    } else {
        (g, e, f)
    };
    let pair_left = first.a > 0;
    let mut lone = B::new(lone, top);
    let mut first = B::new(first, top);
    let mut second = B::new(second, top);
    let mut runs = [Run::default(); BATCH];
    let mut y = top;
    while y < bottom {
        let mut count = 0;
        for slot in runs.iter_mut().take((bottom - y) as usize) {
            let (f, g) = (lone.floor(), first.floor().min(second.floor()));
            let (left, right) = if pair_left { (g, f) } else { (f, g) };
            *slot = Run { y, x0: (-left).max(0), x1: (right + 1).min(width) };
            count += 1;
            y += 1;
            lone.advance();
            first.advance();
            second.advance();
        }
        emit(&runs[..count]);
    }
}

/// Gives the same pixels tile by tile (8 x 8 pixels, rows of tiles from the top, tiles from the left).
pub fn tiles(t: &Triangle, rows: Range<i32>, width: i32, emit: &mut dyn FnMut(&[Run])) {
    const SIDE: i32 = 8;
    let (top, bottom) = (t.min[1].max(rows.start), t.max[1].min(rows.end));
    let (first, last) = (t.min[0].max(0), t.max[0].min(width));
    let align = |v: i32| v & !(SIDE - 1);
    for tile_y in (align(top)..bottom).step_by(SIDE as usize) {
        for tile_x in (align(first)..last).step_by(SIDE as usize) {
            for y in tile_y.max(top)..(tile_y + SIDE).min(bottom) {
                let inside = |x: &i32| t.covers(*x, y);
                let columns = tile_x.max(first)..(tile_x + SIDE).min(last);
                if let Some(x0) = columns.clone().find(inside) {
                    let x1 = (x0..columns.end).find(|x| !inside(x)).unwrap_or(columns.end);
                    emit(&[Run { y, x0, x1 }]);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    extern crate std;
    use std::string::String;
    use std::vec;
    use std::vec::Vec;

    type Traversal = fn(&Triangle, Range<i32>, i32, &mut dyn FnMut(&[Run]));
    const SPANS: Traversal = spans;
    const TILES: Traversal = tiles;

    fn count(v: [[i32; 2]; 3], size: i32, traverse: Traversal) -> Vec<u8> {
        let mut pixels = vec![0u8; (size * size) as usize];
        if let Some(t) = Triangle::new(v) {
            traverse(&t, 0..size, size, &mut |runs| {
                for run in runs {
                    (run.x0..run.x1).for_each(|x| pixels[(run.y * size + x) as usize] += 1)
                }
            });
        }
        pixels
    }

    fn picture(v: [[i32; 2]; 3], size: i32) -> String {
        let pixels = count(v, size, SPANS);
        pixels.chunks(size as usize).fold(String::new(), |text, row| {
            text + &row.iter().map(|&n| if n > 0 { '#' } else { '.' }).collect::<String>() + "\n"
        })
    }

    #[test]
    fn top_left_rule() {
        // Corners on pixel centres: the top and left edges count, the right and bottom ones do not.
        let c = |x: i32, y: i32| [16 * x + 8, 16 * y + 8];
        assert_eq!(
            picture([c(1, 1), c(4, 1), c(1, 4)], 6),
            "......\n.###..\n.##...\n.#....\n......\n......\n"
        );
        assert_eq!(
            picture([c(4, 1), c(4, 4), c(1, 4)], 6),
            "......\n......\n...#..\n..##..\n......\n......\n"
        );
    }

    #[test]
    fn spans_and_tiles_agree_with_the_edges() {
        let mut seed = 7u64;
        let mut random = |n: i32| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) as i32 % n
        };
        for i in 0..4000 {
            let (low, size) = [(-100, 900), (-3000, 6000), (0, 200), (-(1 << 24), 1 << 25)][i % 4];
            let v = [(); 3].map(|()| [low + random(size), low + random(size)]);
            let Some(t) = Triangle::new(v) else { continue };
            let expected: Vec<u8> = (0..40 * 40).map(|i| t.covers(i % 40, i / 40) as u8).collect();
            assert!(count(v, 40, SPANS) == expected, "spans of {v:?}");
            assert!(count(v, 40, TILES) == expected, "tiles of {v:?}");
        }
    }

    #[test]
    fn a_fan_covers_each_pixel_once() {
        let mut seed = 11u64;
        let mut random = |n: i32| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) as i32 % n
        };
        for _ in 0..300 {
            // A square split from a random inner point: every pixel of the square exactly once.
            let centre = [8 + random(480), 8 + random(480)];
            let ring = [[0, 0], [512, 0], [512, 512], [0, 512]];
            let mut total = vec![0u8; 32 * 32];
            for i in 0..4 {
                let pixels = count([centre, ring[i], ring[(i + 1) % 4]], 32, SPANS);
                total.iter_mut().zip(pixels).for_each(|(a, b)| *a += b);
            }
            assert!(total.iter().all(|&n| n == 1), "centre {centre:?}");
        }
    }

    #[test]
    fn whole_pixel_moves_move_the_pixels() {
        let v = [[13, 40], [300, 77], [120, 391]];
        let moved = v.map(|[x, y]| [x + 16 * 5, y + 16 * 3]);
        let (a, b) = (count(v, 40, SPANS), count(moved, 40, SPANS));
        for y in 0..37 {
            for x in 0..35 {
                assert_eq!(a[y * 40 + x], b[(y + 3) * 40 + x + 5]);
            }
        }
    }
}
