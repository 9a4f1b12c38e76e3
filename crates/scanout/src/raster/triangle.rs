//! Triangles to pixels: two traversals of the same exact edges.
//!
//! [`Runs::spans`] solves each row's ends. With the corners sorted from the top, the rows between two of them lie between the same two
//! edges: a slab.
//!
//! ```text
//!      top  .            An edge that begins at (x0, y0), in 1/16 pixel, crosses the centres of row y at
//!          / \  slab
//!         /   . middle      X(y) = (x0 - 8) / 16 + (16 y + 8 - y0) / 16 * dx / dy
//!        / .     slab
//!  low  .                and the row's run is, by the top-left rule, from ceil(X) of the left edge up to ceil(X) of the right.
//! ```
//!
//! [`Runs::tested`] tests the edges at every pixel, [`tiles`] column after column. Both give the same pixels; `rows` and `width` only
//! cut.
//!
//! Cost of a row: two additions and two comparisons; at most three divisions a triangle.

use crate::features;
use crate::math::{NO_DIVISION, at_least, at_most, floor};
use crate::setup::{Triangle, first_pixel};
use core::ops::Range;

/// A run of covered pixels in one row: columns `x0..x1`; none where `x0 >= x1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Run {
    /// Row.
    pub y: usize,
    /// First column.
    pub x0: usize,
    /// One past the last column.
    pub x1: usize,
}

/// Where an edge crosses a row, with 32 fraction bits, and how much further right the next; a little less than one is added, so that the
/// whole part is rounded upwards.
///
/// Edges at most [`STEEPEST`] high cross a row on a whole pixel or at least `1 / (16 dy) >= 2^-19` away from it. Their step is cut off
/// to 32 bits and added in at most 2^11 rows, so what is here strays by less than 2^-21 + 2^-32; with `1 - 2^-20` added the
/// whole part is exact.
#[derive(Clone, Copy, Default)]
struct Side {
    x: i64,
    step: i64,
}

/// The greatest height, in 1/16 pixel, of a triangle whose ends are solved.
const STEEPEST: i32 = 1 << 15;

impl Side {
    /// Of an edge down to another corner, at a row between both.
    #[inline(always)]
    fn new([x, y]: [i32; 2], to: [i32; 2], row: i32) -> Side {
        const ALMOST_ONE: i64 = (1 << 32) - (1 << 12);
        let step = floor(((to[0] - x) as i64) << 32, (to[1] - y) as u32 as i64);
        let down = (16 * row + 8 - y) as i64;
        Side { x: (((x - 8) as i64) << 28) + ((down * step) >> 4) + ALMOST_ONE, step }
    }
}

/// The runs of a triangle, one for each row from the top.
pub struct Runs<'t> {
    triangle: &'t Triangle,
    way: Way,
    /// Columns that are asked for.
    columns: [i32; 2],
    /// How many slabs there are, two at most.
    slabs: usize,
    /// The first row of either slab, one past the last of the second.
    rows: [usize; 3],
    /// The edge from the top corner to the lowest, at the first row.
    long: Side,
    /// It is the left one.
    long_left: bool,
    /// The other edge of either slab, at the slab's first row.
    short: [Side; 2],
    /// Rows that follow.
    rest: Range<i32>,
    /// For [`Way::Stepped`].
    steps: [Steps; NO_DIVISION as usize],
}

/// How a row's ends are found.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    /// From the edges' places, which go from row to row.
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
    let (first, end) = (t.min()[0].max(0), t.max()[0].min(width));
    let columns = (first & !(SIDE - 1)..end).step_by(SIDE as usize);
    columns.map(move |left| left.max(first)..end.min(left + SIDE))
}

impl<'t> Runs<'t> {
    /// By the edges' places; only `rows` and `columns`, which begin at 0 or after it.
    #[inline(never)]
    pub fn spans(t: &'t Triangle, rows: Range<i32>, columns: Range<i32>) -> Runs<'t> {
        let columns = [columns.start, columns.end];
        let ([a, b, c], mut turned) = (t.corners, t.turned);
        let mut sort = |[a, b]: [[i32; 2]; 2]| {
            let swap = b[1] < a[1];
            turned ^= swap;
            if swap { [b, a] } else { [a, b] }
        };
        let [a, b] = sort([a, b]);
        let [b, c] = sort([b, c]);
        let [a, b] = sort([a, b]);
        let (first, end) = (first_pixel(a[1]).max(rows.start), first_pixel(c[1]).min(rows.end));
        if !t.small || c[1] - a[1] > STEEPEST {
            return Runs::row_by_row(t, rows, columns, Way::Divided);
        }
        if NO_DIVISION && t.has_few(FEW) {
            return Runs::row_by_row(t, rows, columns, Way::Stepped);
        }
        let end = end.max(first);
        let turn = first_pixel(b[1]).clamp(first, end);
        let side = |from, to, first, end| {
            if first < end { Side::new(from, to, first) } else { Side::default() }
        };
        Runs {
            triangle: t,
            way: Way::Solved,
            columns,
            slabs: 2,
            rows: [first as usize, turn as usize, end as usize],
            long: side(a, c, first, end),
            long_left: !turned,
            short: [side(a, b, first, turn), side(b, c, turn, end)],
            rest: 0..0,
            steps: [Steps::default(); NO_DIVISION as usize],
        }
    }

    /// The same by a test at every pixel.
    pub fn tested(t: &'t Triangle, rows: Range<i32>, columns: Range<i32>) -> Runs<'t> {
        Runs::row_by_row(t, rows, [columns.start, columns.end], Way::Tested)
    }

    /// One or the other.
    #[inline(always)]
    pub(crate) fn either(
        t: &'t Triangle,
        rows: Range<i32>,
        columns: Range<i32>,
        tested: bool,
    ) -> Runs<'t> {
        if tested { Runs::tested(t, rows, columns) } else { Runs::spans(t, rows, columns) }
    }

    #[inline(never)]
    fn row_by_row(t: &'t Triangle, rows: Range<i32>, columns: [i32; 2], way: Way) -> Runs<'t> {
        let (min, max) = (t.min(), t.max());
        let (first, end) = (min[1].max(rows.start), max[1].min(rows.end));
        let columns = [columns[0].max(min[0]), columns[1].min(max[0])];
        let side = Side::default();
        Runs {
            triangle: t,
            way,
            columns,
            slabs: 0,
            rows: [0; 3],
            long: side,
            long_left: true,
            short: [side; 2],
            rest: if columns[0] < columns[1] { first..end } else { 0..0 },
            steps: [(); NO_DIVISION as usize].map(|()| match way {
                Way::Stepped => Steps::new(t, columns[0], first),
                _ => Steps::default(),
            }),
        }
    }

    /// The next of the rows whose ends are found one by one becomes a slab.
    #[inline(never)]
    fn next_row(&mut self) -> bool {
        let Some(y) = self.rest.next() else { return false };
        let [x0, x1] = self.columns;
        let ends = match (self.way, &mut self.steps[..]) {
            (Way::Stepped, [steps]) => steps.next(x0, x1),
            _ => ends(self.triangle, y, [x0, x1], self.way),
        };
        let [left, right] = ends.map(|x| Side { x: (x as i64) << 32, step: 0 });
        (self.long, self.short[0]) = (left, right);
        self.rows = [y as usize, y as usize + 1, 0];
        self.slabs = 1;
        true
    }

    /// Gives each run to `draw`.
    #[inline(always)]
    pub fn for_each(&mut self, mut draw: impl FnMut(Run)) {
        let [first, end] = self.columns.map(|x| x as isize);
        loop {
            let (mut long, mut slab) = (self.long, 0);
            // Written so that the compiler doesn't write what follows twice.
            while slab < self.slabs {
                let short = self.short[slab & 1];
                let [mut left, mut right] =
                    if self.long_left { [long, short] } else { [short, long] };
                for y in self.rows[slab & 1]..self.rows[(slab & 1) + 1] {
                    let x0 = at_least((left.x >> 32) as isize, first);
                    let x1 = at_most((right.x >> 32) as isize, end);
                    (left.x, right.x) = (left.x + left.step, right.x + right.step);
                    if x0 < x1 {
                        draw(Run { y, x0: x0 as usize, x1: x1 as usize });
                    }
                }
                long = if self.long_left { left } else { right };
                slab += 1;
            }
            if self.way == Way::Solved || !self.next_row() {
                return;
            }
        }
    }
}

/// The ends of row `y` between two columns, from the edges alone.
#[cold]
#[inline(never)]
fn ends(t: &Triangle, y: i32, [mut x0, mut x1]: [i32; 2], way: Way) -> [i32; 2] {
    let edges = t.edges_by_call();
    // By divisions it is the same, and little code.
    if way == Way::Tested && features::TILES {
        let covers = |x: i32| edges.iter().all(|edge| edge.at(x, y) >= 0);
        while x0 < x1 && !covers(x0) {
            x0 += 1;
        }
        x1 = (x0..x1).find(|&x| !covers(x)).unwrap_or(x1);
    } else {
        for edge in edges.iter().filter(|edge| edge.a != 0) {
            let f = (edge.b * y as i64 + edge.k).div_euclid(edge.a.abs()).clamp(-1 << 29, 1 << 29);
            if edge.a > 0 { x0 = x0.max(-f as i32) } else { x1 = x1.min(f as i32 + 1) }
        }
    }
    [x0, x1]
}

#[cfg(test)]
mod tests {
    use super::*;
    extern crate std;
    use crate::raster::small;
    use std::string::String;
    use std::vec;
    use std::vec::Vec;

    type Traversal = fn(&Triangle, Range<i32>, i32) -> Vec<Run>;
    const SPANS: Traversal = |t, rows, width| collect(Runs::spans(t, rows, 0..width));
    const STEPS: Traversal = |t, rows, width| {
        let (min, max) = (t.min(), t.max());
        let (left, right) = (min[0].max(0), max[0].min(width));
        let (top, bottom) = (min[1].max(rows.start), max[1].min(rows.end));
        if !t.has_few(FEW) || left >= right {
            return SPANS(t, rows, width);
        }
        let mut steps = Steps::new(t, left, top);
        let next = |y: i32| {
            let [x0, x1] = steps.next(left, right).map(|x| x as usize);
            Run { y: y as usize, x0, x1 }
        };
        (top..bottom).map(next).filter(|run| run.x0 < run.x1).collect()
    };
    const SMALL: Traversal = |t, rows, width| {
        let extent = |i: usize| {
            let [a, b, c] = t.corners.map(|v| v[i]);
            a.max(b).max(c) - a.min(b).min(c)
        };
        if extent(0).max(extent(1)) > small::LARGEST {
            return SPANS(t, rows, width);
        }
        let mut all = vec![];
        small::for_each(t, rows, 0..width, |run| all.push(run));
        all
    };
    const TILES: Traversal = |t, rows, width| {
        tiles(t, width)
            .flat_map(|columns| collect(Runs::tested(t, rows.clone(), columns)))
            .collect()
    };

    fn collect(mut runs: Runs) -> Vec<Run> {
        let mut all = vec![];
        runs.for_each(|run| all.push(run));
        all
    }

    fn count(v: [[i32; 2]; 3], size: i32, traverse: Traversal) -> Vec<u8> {
        let mut pixels = vec![0u8; (size * size) as usize];
        if let Some(t) = Triangle::new(v) {
            for run in traverse(&t, 0..size, size) {
                (run.x0..run.x1).for_each(|x| pixels[run.y * size as usize + x] += 1)
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
            assert!(count(v, 40, SMALL) == expected, "small: {v:?}");
        }
    }

    /// Every edge between corners of a small box, so that every place there can be is met.
    #[test]
    fn small_triangles_are_exact() {
        let mut seed = 3u64;
        let mut random = |n: i32| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) as i32 % n
        };
        let mut near = 0;
        for i in 0..40_000 {
            let from = [random(16) + 80, random(16) + 80];
            let size = [64, 200, small::LARGEST + 1][i % 3];
            let mut v = [(); 3].map(|()| from.map(|v| v + random(size)));
            if i % 2 == 0 {
                // As high as can be.
                (v[0][1], v[1][1]) = (from[1], from[1] + small::LARGEST);
            }
            let Some(t) = Triangle::new(v) else { continue };
            let (min, max) = (t.min(), t.max());
            small::for_each(&t, 0..100, 0..100, |Run { y, x0, x1 }| {
                let [x0, x1, y] = [x0, x1, y].map(|v| v as i32);
                let inside = |x: i32| t.covers(x, y);
                assert!(inside(x0) && inside(x1 - 1), "{v:?} row {y}: {x0}..{x1}");
                assert!(!inside(x0 - 1) && !inside(x1), "{v:?} row {y}: {x0}..{x1}");
                near += t.edges().iter().any(|e| e.at(x0, y) == 0) as u32;
            });
            let mut rows = 0;
            small::for_each(&t, 0..100, 0..100, |_| rows += 1);
            let expected =
                (min[1]..max[1]).filter(|&y| (min[0]..max[0]).any(|x| t.covers(x, y))).count();
            assert_eq!(rows, expected, "{v:?}");
        }
        assert!(near > 1000, "{near}");
    }

    /// Rows at whose centre an edge passes closest by a pixel's: there the last bit decides.
    #[test]
    fn spans_are_exact_where_edges_nearly_meet_centres() {
        let mut seed = 5u64;
        let mut random = |low: i32, high: i32| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            low + ((seed >> 33) as i64 % (high - low) as i64) as i32
        };
        let (mut near, mut rows_between) = (0, 0);
        for i in 0..4000 {
            // As high as can be, and as high as is solved.
            let (top, low) = if i % 2 == 0 { (-32_767, 32_767) } else { (-400, STEEPEST - 400) };
            let (top, low) = (top + random(0, 300), low - random(0, 300));
            let (x0, x1) = (random(-8000, 16_000), random(-8000, 16_000));
            let third = [if i % 4 < 2 { -30_000 } else { 30_000 }, random(top, low)];
            let Some(t) = Triangle::new([[x0, top], [x1, low], third]) else { continue };
            let (dx, dy) = ((x1 - x0) as i64, (low - top) as i64);
            for y in 0..2047 {
                let down = (16 * y + 8 - top) as i64;
                // The crossing's numerator over 16 dy.
                let rest = ((x0 - 8) as i64 * dy + down * dx).rem_euclid(16 * dy);
                rows_between += 1;
                if rest > 8 && rest < 16 * dy - 8 {
                    continue;
                }
                let column = ((x0 as i64 + down * dx / dy) >> 4) as i32;
                if !(2..1100).contains(&column) {
                    continue;
                }
                near += 1;
                let columns = column - 2..column + 3;
                let mut drawn = vec![];
                Runs::spans(&t, y..y + 1, columns.clone())
                    .for_each(|run| drawn.extend(run.x0..run.x1));
                let expected: Vec<usize> =
                    columns.filter(|&x| t.covers(x, y)).map(|x| x as usize).collect();
                assert_eq!(drawn, expected, "{t:?} row {y}");
            }
        }
        assert!(near > 40, "{near} of {rows_between}");
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
