//! Triangles to pixels: two traversals of the same exact edge functions.
//!
//! [`Runs::spans`] solves each row's ends. The edge `a x + b y + k >= 0` crosses row y at `X(y) = -(b y + k) / a`:
//!
//! ```text
//!   a > 0 (left edge):   x >= X(y)             first column = max of ceil(X) over left edges
//!   a < 0 (right edge):  x <= X(y)             last column  = min of floor(X) over right edges
//!   a = 0:               decided by the box
//! ```
//!
//! `X` is carried from row to row exactly, so a band may begin at any row. [`Runs::tested`] tests the edges at every pixel, [`tiles`]
//! column after column. Both give the same pixels; `rows` and `width` only cut.
//!
//! Cost of a row: three additions and five comparisons; six divisions a triangle.

use crate::math::{NO_DIVISION, fraction};
use crate::setup::{Edge, Triangle};
use core::ops::Range;

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

/// Where an edge of a [`small`](Triangle::small) triangle crosses a row, `-(b y + k) / a`, from row to row, with 32 fraction bits.
///
/// Over at most 2^12 rows quotients that were cut off stray by less than 2^-19, so with a bias of 2^-18 the sum lies to the wanted
/// side of the true place by at most 2^-17; and a place that is not a pixel's stays at least `1 / |a| >= 2^-16` away from the
/// next. So what is rounded is exact.
#[derive(Clone, Copy)]
struct Crossing {
    x: i64,
    step: i64,
    /// The covered pixels lie to the right.
    left: bool,
}

impl Crossing {
    #[inline(always)]
    fn new(edge: &Edge, y: i32) -> Self {
        const BIAS: i64 = 1 << 14;
        // What a horizontal edge gives is not used.
        let (d, left) = (edge.a + (edge.a == 0) as i64, edge.a > 0);
        let n = edge.b * y as i64 + edge.k;
        // The whole part of the sum is the first column of the run, or the one past the last.
        let round = if left { (1 << 32) - 1 - BIAS } else { (1 << 32) + BIAS };
        Crossing { x: round - fraction(n, d), step: -fraction(edge.b, d), left }
    }
}

/// The runs of a triangle, one for each row from the top.
pub struct Runs<'t> {
    triangle: &'t Triangle,
    /// Of the edge that is alone on its side, then of the two of the other side.
    crossings: [Crossing; 3],
    steps: Steps,
    way: Way,
    /// The next row.
    y: i32,
    bottom: i32,
    left: i32,
    right: i32,
}

/// How a row's ends are found.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    /// By crossings that go from row to row.
    Solved,
    /// By divisions.
    Divided,
    /// By a test at every pixel.
    Tested,
    /// The same by additions: for boxes of few pixels where divisions are dear.
    Stepped,
}

/// The largest box in pixels, and side, that is [`Way::Stepped`].
const FEW: i32 = 64;

/// Edges on their way through a small box.
#[derive(Clone, Copy, Default)]
struct Steps {
    /// Values at the first column of the next row.
    at: [i32; 3],
    /// Changes a column and a row.
    across: [i32; 3],
    down: [i32; 3],
}

impl Steps {
    fn new(t: &Triangle, x: i32, y: i32) -> Steps {
        let [[a0, b0, k0], [a1, b1, k1], [a2, b2, k2]] = t.near_edges(x, y);
        Steps { at: [k0, k1, k2], across: [a0, a1, a2], down: [b0, b1, b2] }
    }

    /// The row's run between two columns, the first of which `at` is for; then the next row.
    #[inline(never)]
    fn next(&mut self, left: i32, right: i32) -> [i32; 2] {
        let ([mut e, mut f, mut g], [a, b, c]) = (self.at, self.across);
        let mut x0 = left;
        while x0 < right && (e | f | g) < 0 {
            (e, f, g, x0) = (e + a, f + b, g + c, x0 + 1);
        }
        let mut x1 = x0;
        while x1 < right && (e | f | g) >= 0 {
            (e, f, g, x1) = (e + a, f + b, g + c, x1 + 1);
        }
        for (at, down) in self.at.iter_mut().zip(self.down) {
            *at += down;
        }
        [x0, x1]
    }
}

/// The side of a tile.
const SIDE: i32 = 8;

/// The columns of the tiles that a triangle touches, from the left, between columns 0 and `width`.
pub fn tiles(t: &Triangle, width: i32) -> impl Iterator<Item = Range<i32>> + use<> {
    let (first, end) = (t.min[0].max(0), t.max[0].min(width));
    let columns = (first & !(SIDE - 1)..end).step_by(SIDE as usize);
    columns.map(move |left| left.max(first)..end.min(left + SIDE))
}

impl<'t> Runs<'t> {
    /// By crossings of the edges; only `rows` and `columns`.
    #[inline(always)]
    pub fn spans(t: &'t Triangle, rows: Range<i32>, columns: Range<i32>) -> Runs<'t> {
        Runs::new(t, rows, columns, if t.small { Way::Solved } else { Way::Divided })
    }

    /// The same by a test at every pixel.
    #[inline(always)]
    pub fn tested(t: &'t Triangle, rows: Range<i32>, columns: Range<i32>) -> Runs<'t> {
        Runs::new(t, rows, columns, Way::Tested)
    }

    /// One or the other.
    #[inline(always)]
    pub(crate) fn either(
        t: &'t Triangle,
        rows: Range<i32>,
        columns: Range<i32>,
        tested: bool,
    ) -> Runs<'t> {
        let spans = if t.small { Way::Solved } else { Way::Divided };
        Runs::new(t, rows, columns, if tested { Way::Tested } else { spans })
    }

    #[inline(always)]
    fn new(t: &'t Triangle, rows: Range<i32>, columns: Range<i32>, mut way: Way) -> Runs<'t> {
        let (top, bottom) = (t.min[1].max(rows.start), t.max[1].min(rows.end));
        let (left, right) = (t.min[0].max(columns.start), t.max[0].min(columns.end));
        if NO_DIVISION && way == Way::Solved && t.has_few(FEW) {
            way = Way::Stepped;
        }
        let mut steps = Steps::default();
        if way == Way::Stepped && left < right && top < bottom {
            steps = Steps::new(t, left, top);
        }
        let mut crossings = [Crossing { x: 0, step: 0, left: false }; 3];
        if way == Way::Solved {
            let [e, f, g] = t.edges();
            let all = [Crossing::new(&e, top), Crossing::new(&f, top), Crossing::new(&g, top)];
            // A triangle with area has a left and a right edge and, unless one is horizontal, a second on one side.
            let order: [usize; 3] = if e.a == 0 {
                [1, 2, 2]
            } else if f.a == 0 {
                [2, 0, 0]
            } else if g.a == 0 {
                [0, 1, 1]
            } else if (f.a ^ g.a) >= 0 {
                [0, 1, 2]
            } else if (e.a ^ g.a) >= 0 {
                [1, 2, 0]
            } else {
                [2, 0, 1]
            };
            crossings = [all[order[0]], all[order[1]], all[order[2]]];
        }
        let bottom = if left < right { bottom } else { top };
        Runs { triangle: t, crossings, steps, way, y: top, bottom, left, right }
    }
}

/// The ends of row `y` between two columns, from the edges alone.
#[cold]
#[inline(never)]
fn ends(t: &Triangle, y: i32, [mut x0, mut x1]: [i32; 2], way: Way) -> [i32; 2] {
    if way == Way::Tested {
        while x0 < x1 && !t.covers(x0, y) {
            x0 += 1;
        }
        x1 = (x0..x1).find(|&x| !t.covers(x, y)).unwrap_or(x1);
    } else {
        for edge in t.edges().iter().filter(|edge| edge.a != 0) {
            let f = (edge.b * y as i64 + edge.k).div_euclid(edge.a.abs()).clamp(-1 << 29, 1 << 29);
            if edge.a > 0 { x0 = x0.max(-f as i32) } else { x1 = x1.min(f as i32 + 1) }
        }
    }
    [x0, x1]
}

impl Iterator for Runs<'_> {
    type Item = Run;

    #[inline(always)]
    fn next(&mut self) -> Option<Run> {
        if self.y >= self.bottom {
            return None;
        }
        let y = self.y;
        let [x0, x1] = if self.way == Way::Solved {
            let [lone, first, second] = &mut self.crossings;
            let one = (lone.x >> 32) as i32;
            let [x0, x1] = if lone.left {
                [one, (first.x.min(second.x) >> 32) as i32]
            } else {
                [(first.x.max(second.x) >> 32) as i32, one]
            };
            for crossing in [lone, first, second] {
                crossing.x += crossing.step;
            }
            [x0.max(self.left), x1.min(self.right)]
        } else if self.way == Way::Stepped {
            self.steps.next(self.left, self.right)
        } else {
            ends(self.triangle, y, [self.left, self.right], self.way)
        };
        self.y = y + 1;
        Some(Run { y, x0, x1 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    extern crate std;
    use std::string::String;
    use std::vec;
    use std::vec::Vec;

    type Traversal = fn(&Triangle, Range<i32>, i32) -> Vec<Run>;
    const SPANS: Traversal = |t, rows, width| Runs::spans(t, rows, 0..width).collect();
    const STEPS: Traversal = |t, rows, width| {
        let way = if t.has_few(FEW) { Way::Stepped } else { Way::Tested };
        Runs::new(t, rows, 0..width, way).collect()
    };
    const TILES: Traversal = |t, rows, width| {
        tiles(t, width).flat_map(|columns| Runs::tested(t, rows.clone(), columns)).collect()
    };

    fn count(v: [[i32; 2]; 3], size: i32, traverse: Traversal) -> Vec<u8> {
        let mut pixels = vec![0u8; (size * size) as usize];
        if let Some(t) = Triangle::new(v) {
            for run in traverse(&t, 0..size, size) {
                (run.x0..run.x1).for_each(|x| pixels[(run.y * size + x) as usize] += 1)
            }
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
            let (low, size) =
                [(-100, 900), (-3000, 6000), (0, 200), (-(1 << 24), 1 << 25), (-40, 130)][i % 5];
            let v = [(); 3].map(|()| [low + random(size), low + random(size)]);
            let Some(t) = Triangle::new(v) else { continue };
            let expected: Vec<u8> = (0..40 * 40).map(|i| t.covers(i % 40, i / 40) as u8).collect();
            assert!(count(v, 40, SPANS) == expected, "spans of {v:?}");
            assert!(count(v, 40, TILES) == expected, "tiles of {v:?}");
            assert!(count(v, 40, STEPS) == expected, "steps of {v:?}");
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
