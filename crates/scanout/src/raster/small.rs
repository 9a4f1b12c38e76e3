//! Small triangles to pixels, in 32 bits: the runs of [`Runs::spans`](super::triangle::Runs::spans) for boxes of at most 32 pixels.
//!
//! An edge's place in a row is kept from the box's first column on, with 20 fraction bits. Edges at most 2^9 high cross a row on a
//! whole pixel or at least `1 / (16 dy) >= 2^-13` away from it. Their step is cut off to 20 bits and added in at most 32 rows, so
//! a place strays by less than 2^-15 + 2^-20; with `1 - 2^-14` added the whole part is exact.

use core::ops::Range;

use super::triangle::Run;
use crate::math::{at_least, at_most, quotient};
use crate::setup::{Triangle, first_pixel};

/// The widest and highest box, 1/16 pixel.
pub const LARGEST: i32 = 32 * 16;

/// Fraction bits of a place.
const FRACTION: u32 = 20;

/// Where an edge crosses a row, a little less than one added, and how much further right the next.
#[derive(Clone, Copy, Default)]
struct Side {
    x: i32,
    step: i32,
}

impl Side {
    /// Of an edge down to another corner, at a row between both.
    #[inline(always)]
    fn new([x, y]: [i32; 2], to: [i32; 2], row: i32) -> Side {
        const ALMOST_ONE: i32 = (1 << FRACTION) - (1 << (FRACTION - 14));
        let (dx, dy) = ((to[0] - x) << FRACTION, to[1] - y);
        // floor(dx / dy)
        let sign = dx >> 31;
        let step = quotient((dx ^ sign) as u32, dy as u32) as i32 ^ sign;
        let down = 16 * row + 8 - y;
        Side { x: ((x - 8) << (FRACTION - 4)) + ((down * step) >> 4) + ALMOST_ONE, step }
    }
}

/// Gives each run of a triangle, whose box is at most [`LARGEST`], between some rows and columns to `draw`, from the top.
#[inline(always)]
pub fn for_each(t: &Triangle, rows: Range<i32>, columns: Range<i32>, mut draw: impl FnMut(Run)) {
    let Slabs { slabs, base } = &Slabs::new(t, rows);
    let [first, end] = [columns.start - base, columns.end - base];
    let mut slab = 0;
    // Written so that the compiler doesn't write what follows twice.
    while slab < 2 {
        let Slab { mut sides, rows: [top, below] } = slabs[slab & 1];
        for y in top..below {
            let [x0, x1] = sides.map(|side| side.x >> FRACTION);
            sides = sides.map(|side| Side { x: side.x.wrapping_add(side.step), ..side });
            let (x0, x1) = (at_least(x0, first), at_most(x1, end));
            if x0 < x1 {
                draw(Run { y: y as usize, x0: (base + x0) as usize, x1: (base + x1) as usize });
            }
        }
        slab += 1;
    }
}

/// Rows between the same two edges.
#[derive(Clone, Copy, Default)]
struct Slab {
    /// Left and right, at the first row.
    sides: [Side; 2],
    rows: [i32; 2],
}

/// The slabs of a triangle and the column from which they count.
struct Slabs {
    slabs: [Slab; 2],
    base: i32,
}

impl Slabs {
    #[inline(never)]
    fn new(t: &Triangle, rows: Range<i32>) -> Slabs {
        let base = t.min()[0];
        let ([a, b, c], mut turned) = (t.corners.map(|[x, y]| [x - 16 * base, y]), t.turned);
        let mut sort = |[a, b]: [[i32; 2]; 2]| {
            let swap = b[1] < a[1];
            turned ^= swap;
            if swap { [b, a] } else { [a, b] }
        };
        let [a, b] = sort([a, b]);
        let [b, c] = sort([b, c]);
        let [a, b] = sort([a, b]);
        let first = first_pixel(a[1]).max(rows.start);
        let end = first_pixel(c[1]).min(rows.end).max(first);
        let turn = first_pixel(b[1]).clamp(first, end);
        let mut slabs = [Slab::default(); 2];
        let mut long = if first < end { Side::new(a, c, first) } else { Side::default() };
        for (slab, (from, to, top, below)) in
            slabs.iter_mut().zip([(a, b, first, turn), (b, c, turn, end)])
        {
            if top < below {
                let short = Side::new(from, to, top);
                slab.sides = if turned { [short, long] } else { [long, short] };
                slab.rows = [top, below];
                long.x = long.x.wrapping_add(long.step.wrapping_mul(below - top));
            }
        }
        Slabs { slabs, base }
    }
}
