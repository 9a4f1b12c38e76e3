//! Lines of one value: edges of a wireframe, eight at a time to the point where their pixels begin.
//!
//! The pixels are those of [`Field::line`](crate::raster::line::Field::line), by the same equation.
#![allow(unsafe_code)]

use core::arch::x86_64::*;

use super::memory::{all_below, gather, store};
use super::{EIGHT, Plain};
use crate::raster::line::{HALF, LONGEST};
use crate::transform::{CLIP, Vertex};

/// The ends of eight edges, or `None` when an index is out of range.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn ends(edges: &[[u16; 2]; EIGHT], vertices: &[Vertex]) -> Option<[__m256i; 2]> {
    // SAFETY: the array is the 32 bytes that are read; the instruction asks no alignment.
    let both = unsafe { _mm256_loadu_si256(edges.as_ptr().cast()) };
    let (a, b) = (_mm256_and_si256(both, _mm256_set1_epi32(0xffff)), _mm256_srli_epi32(both, 16));
    all_below(_mm256_max_epi32(a, b), vertices.len()).then_some([a, b])
}

/// Lanes of `v` (unsigned) that are above `most`.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn above(v: __m256i, most: u32) -> __m256i {
    let most = _mm256_set1_epi32(most as i32);
    let within = _mm256_cmpeq_epi32(_mm256_min_epu32(v, most), v);
    _mm256_xor_si256(within, _mm256_set1_epi32(-1))
}

/// See [`Avx2::heights`](super::Avx2::heights).
#[target_feature(enable = "avx2,fma")]
pub fn heights(
    groups: &[[[u16; 2]; EIGHT]],
    vertices: &[Vertex],
    size: [u32; 2],
) -> Option<(i32, i32)> {
    let (mut high, mut low) = (_mm256_set1_epi32(i32::MAX), _mm256_setzero_si256());
    let mut outside = _mm256_setzero_si256();
    for edges in groups {
        for index in ends(edges, vertices)? {
            // SAFETY: `ends` has tested them.
            let (x, y, flags) = unsafe {
                (
                    gather::<_, 0>(vertices, index),
                    gather::<_, 1>(vertices, index),
                    gather::<_, 4>(vertices, index),
                )
            };
            let clip = _mm256_and_si256(flags, _mm256_set1_epi32((CLIP as i32) << 24));
            let beyond = _mm256_or_si256(above(x, size[0] - 1), above(y, size[1] - 1));
            outside = _mm256_or_si256(outside, _mm256_or_si256(clip, beyond));
            (high, low) = (_mm256_min_epi32(high, y), _mm256_max_epi32(low, y));
        }
    }
    if _mm256_testz_si256(outside, outside) == 0 {
        return None;
    }
    let (mut highs, mut lows) = ([0; EIGHT], [0; EIGHT]);
    store(&mut highs, high);
    store(&mut lows, low);
    Some((highs.into_iter().fold(i32::MAX, i32::min), lows.into_iter().fold(0, i32::max)))
}

/// What eight lines are drawn from.
#[derive(Default)]
#[repr(C, align(32))]
struct Lines {
    /// Index of the first cell.
    index: [i32; EIGHT],
    /// Number of cells less one.
    steps: [i32; EIGHT],
    /// Steps sideways, a fraction of 2^32.
    slope: [i32; EIGHT],
    /// The fraction to begin with.
    fraction: [i32; EIGHT],
}

/// See [`Avx2::lines`](super::Avx2::lines).
#[target_feature(enable = "avx2,fma")]
pub fn lines(edges: &[[u16; 2]; EIGHT], vertices: &[Vertex], to: &mut Plain) -> u32 {
    const ALL: u32 = 0xff;
    let number = |v: i32| _mm256_set1_epi32(v);
    let zero = _mm256_setzero_si256();
    let Some([a, b]) = ends(edges, vertices) else { return 0 };
    let (columns, rows) = (to.width as u32, to.rows as u32);
    // The last cell of every row must be there, and its index fit.
    if columns == 0 || rows == 0 || to.cells.len() < to.width * to.rows || to.cells.len() > 1 << 30
    {
        return 0;
    }
    // SAFETY: `ends` has tested them.
    let [xa, ya, xb, yb] = unsafe {
        [
            gather::<_, 0>(vertices, a),
            gather::<_, 1>(vertices, a),
            gather::<_, 0>(vertices, b),
            gather::<_, 1>(vertices, b),
        ]
    };
    let [xa, ya, xb, yb] = [(xa, 0), (ya, to.top), (xb, 0), (yb, to.top)]
        .map(|(v, first)| _mm256_sub_epi32(_mm256_srai_epi32(v, 4), number(first)));
    let beyond = _mm256_or_si256(
        _mm256_or_si256(above(xa, columns - 1), above(xb, columns - 1)),
        _mm256_or_si256(above(ya, rows - 1), above(yb, rows - 1)),
    );
    // From the top down.
    let swap = _mm256_cmpgt_epi32(ya, yb);
    let (x, other) = (_mm256_blendv_epi8(xa, xb, swap), _mm256_blendv_epi8(xb, xa, swap));
    let y = _mm256_min_epi32(ya, yb);
    let dy = _mm256_abs_epi32(_mm256_sub_epi32(yb, ya));
    let right = _mm256_sub_epi32(other, x);
    let dx = _mm256_abs_epi32(right);
    let steep = _mm256_cmpgt_epi32(dy, dx);
    let (n, m) = (_mm256_max_epi32(dx, dy), _mm256_min_epi32(dx, dy));
    let beyond = _mm256_or_si256(beyond, _mm256_cmpgt_epi32(n, number(LONGEST as i32)));
    // floor((2^32 - 1) / n), the quotient exact as said in `avx2`.
    let n1 = _mm256_max_epi32(n, number(1));
    let inverse = |n: __m128i| {
        let whole = _mm256_div_pd(_mm256_set1_pd(u32::MAX as f64), _mm256_cvtepi32_pd(n));
        let whole = _mm256_add_pd(_mm256_floor_pd(whole), _mm256_set1_pd((1u64 << 52) as f64));
        _mm256_castpd_ps(whole)
    };
    let (low, high) =
        (inverse(_mm256_castsi256_si128(n1)), inverse(_mm256_extracti128_si256(n1, 1)));
    let mixed = _mm256_castps_pd(_mm256_shuffle_ps(low, high, 0b10_00_10_00));
    let inverse = _mm256_castpd_si256(_mm256_permute4x64_pd(mixed, 0b11_01_10_00));
    let slope = _mm256_mullo_epi32(inverse, m);
    // To the left a steep line counts down from just below the next whole, another's halves round the other way.
    let left = _mm256_srai_epi32(right, 31);
    let half = number(HALF as i32);
    let back = _mm256_xor_si256(half, left);
    let less = _mm256_sub_epi32(half, _mm256_and_si256(_mm256_srli_epi32(inverse, 1), left));
    let mut lines = Lines::default();
    let index = _mm256_add_epi32(_mm256_mullo_epi32(y, number(to.width as i32)), x);
    store(&mut lines.index, index);
    store(&mut lines.steps, n);
    store(&mut lines.slope, slope);
    store(&mut lines.fraction, _mm256_blendv_epi8(less, back, steep));
    let bits = |v: __m256i| _mm256_movemask_ps(_mm256_castsi256_ps(v)) as u32;
    let (beyond, steep, left) = (bits(beyond), bits(steep), bits(_mm256_cmpgt_epi32(zero, right)));
    let cells = to.cells.as_mut_ptr();
    let mut rest = !beyond & ALL;
    while rest != 0 {
        let i = rest.trailing_zeros() as usize % EIGHT;
        rest &= rest - 1;
        // SAFETY: both ends are in the rows, which are in the slice as tested above, and a line stays in the box of its ends:
        // see the proof in `raster::line::fill`.
        unsafe {
            let first = cells.add(lines.index[i] as usize);
            let (steps, slope) = (lines.steps[i] as usize, lines.slope[i] as u32 as u64);
            let fraction = lines.fraction[i] as u32 as u64;
            match (steep >> i & 1, left >> i & 1) {
                (0, 0) => flat(first, 1, to.width as isize, fraction, slope, steps, to.value),
                (0, _) => flat(first, -1, to.width as isize, fraction, slope, steps, to.value),
                (_, 0) => {
                    let step = ((to.width as u64) << 32).wrapping_add(slope);
                    self::steep(first, fraction, step, steps, to.value);
                }
                _ => {
                    let step = ((to.width as u64) << 32).wrapping_sub(slope);
                    self::steep(first, fraction, step, steps, to.value);
                }
            }
        }
    }
    !beyond & ALL
}

/// Draws `steps + 1` cells, row by row; `at` is the index, counted from `first`, and its fraction.
///
/// # Safety
/// All of them can be written.
#[inline(always)]
unsafe fn steep(first: *mut u16, mut at: u64, step: u64, steps: usize, value: u16) {
    let mut rest = steps;
    loop {
        // SAFETY: as the caller says.
        unsafe { *first.offset(at as i64 as isize >> 32) = value };
        at = at.wrapping_add(step);
        if rest == 0 {
            return;
        }
        rest -= 1;
    }
}

/// Draws `steps + 1` cells, column by column.
///
/// # Safety
/// All of them can be written.
#[inline(always)]
unsafe fn flat(
    first: *mut u16,
    forward: isize,
    stride: isize,
    mut row: u64,
    slope: u64,
    steps: usize,
    value: u16,
) {
    let mut at = first;
    let mut rest = steps;
    loop {
        // SAFETY: as the caller says.
        unsafe { *at.offset((row >> 32) as isize * stride) = value };
        row = row.wrapping_add(slope);
        if rest == 0 {
            return;
        }
        rest -= 1;
        at = at.wrapping_offset(forward);
    }
}

#[cfg(test)]
mod tests {
    use crate::avx2::{Avx2, EIGHT, Plain};
    use crate::raster::line::{ClipRect, LineEnd, walk_cells};
    use crate::transform::{FAR, Vertex};

    const WIDTH: usize = 61;
    const ROWS: usize = 47;
    const TOP: i32 = 5;

    /// All lines between cells of a small field, those to cells around it left out, against the error term.
    #[test]
    fn eight_are_one_at_a_time() {
        let Some(avx2) = Avx2::detect() else { return };
        let mut seed = 2u64;
        let mut random = |n: usize| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (((seed >> 32) * n as u64) >> 32) as i32
        };
        let clip = ClipRect { x0: 0, y0: TOP, x1: WIDTH as i32, y1: TOP + ROWS as i32 };
        let mut drawn = 0;
        for _ in 0..30_000 {
            let vertices: [Vertex; 2 * EIGHT] = core::array::from_fn(|_| Vertex {
                x: 16 * random(WIDTH + 4) - 32 + random(16),
                y: 16 * (TOP + random(ROWS + 4) - 2) + random(16),
                ..Vertex::default()
            });
            let edges: [[u16; 2]; EIGHT] =
                core::array::from_fn(|i| [2 * i as u16, 2 * i as u16 + 1]);
            let (mut cells, mut want) = ([0u16; WIDTH * ROWS], [0u16; WIDTH * ROWS]);
            let mut plain =
                Plain { cells: &mut cells, width: WIDTH, rows: ROWS, top: TOP, value: 7 };
            let done = avx2.lines(&edges, &vertices, &mut plain);
            for (i, edge) in edges.iter().enumerate() {
                let end = |k: u16| {
                    let v = &vertices[k as usize];
                    LineEnd { x: v.x >> 4, y: v.y >> 4, ..LineEnd::default() }
                };
                let (a, b) = (end(edge[0]), end(edge[1]));
                let inside = clip.contains(a.x, a.y) && clip.contains(b.x, b.y);
                assert_eq!(done >> i & 1 == 1, inside);
                if inside {
                    drawn += 1;
                    walk_cells::<false, false>(&a, &b, clip, WIDTH, |at, _, _| want[at] = 7);
                }
            }
            assert_eq!(cells, want);
        }
        assert!(drawn > 100_000);
    }

    #[test]
    fn long_lines() {
        let Some(avx2) = Avx2::detect() else { return };
        extern crate std;
        let (width, rows) = (1300usize, 1100usize);
        let clip = ClipRect { x0: 0, y0: 0, x1: width as i32, y1: rows as i32 };
        let mut cells = std::vec![0u16; width * rows];
        for i in 0..200 {
            let at = |k: i32| Vertex {
                x: 16 * (k * 7919 % width as i32),
                y: 16 * (k * 4801 % rows as i32),
                ..Vertex::default()
            };
            let vertices: [Vertex; 16] = core::array::from_fn(|k| at(16 * i + k as i32));
            let edges: [[u16; 2]; EIGHT] =
                core::array::from_fn(|i| [2 * i as u16, 2 * i as u16 + 1]);
            let mut plain = Plain { cells: &mut cells, width, rows, top: 0, value: 7 };
            let done = avx2.lines(&edges, &vertices, &mut plain);
            let mut want = 0;
            for (i, [a, b]) in vertices.as_chunks::<2>().0.iter().enumerate() {
                let end = |v: &Vertex| LineEnd { x: v.x >> 4, y: v.y >> 4, ..LineEnd::default() };
                let (a, b) = (end(a), end(b));
                let long = a.x.abs_diff(b.x).max(a.y.abs_diff(b.y)) > 1024;
                assert_eq!(done >> i & 1 == 0, long);
                if !long {
                    walk_cells::<false, false>(&a, &b, clip, width, |at, _, _| {
                        want += (cells[at] == 7) as u32;
                        cells[at] = 0;
                    });
                }
            }
            assert!(want > 0 && cells.iter().all(|&c| c == 0));
        }
    }

    #[test]
    fn heights_are_those_of_edges_inside() {
        let Some(avx2) = Avx2::detect() else { return };
        let at = |x: i32, y: i32| Vertex { x, y, ..Vertex::default() };
        let mut vertices: [Vertex; 8] = core::array::from_fn(|i| at(100 + i as i32, 50 * i as i32));
        let edges: [[u16; 2]; EIGHT] = core::array::from_fn(|i| [i as u16, 7 - i as u16]);
        let size = [160, 400];
        assert_eq!(avx2.heights(&[edges], &vertices, size), Some((0, 350)));
        assert_eq!(avx2.heights(&[edges], &vertices, [107, 400]), None);
        assert_eq!(avx2.heights(&[edges], &vertices, [160, 350]), None);
        assert_eq!(avx2.heights(&[edges], &vertices[..7], size), None);
        vertices[3].x = -1;
        assert_eq!(avx2.heights(&[edges], &vertices, size), None);
        vertices[3] = Vertex { flags: FAR, ..at(0, 0) };
        assert_eq!(avx2.heights(&[edges], &vertices, size), None);
    }
}
