//! Transform, four positions at a time.
//!
//! A row of the clip matrix times a position is a sum of multiples of 2^-15 below 2^32: exact. So is the reciprocal, by its
//! remainder; the 63-bit products of coordinates and reciprocals are taken as a rounded product and its exact error.
#![allow(unsafe_code)]

use core::arch::x86_64::*;

use crate::transform::{ClipMatrix, GUARD_BITS, Vertex, Viewport};

/// How many at a time.
const FOUR: usize = 4;
/// Bytes of a position.
const BYTES: usize = size_of::<[i16; 3]>();

/// The matrix for coordinates that come as `p 2^16`: `floor(row . p + 1/2)` is the clip coordinate.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn rows(clip: &ClipMatrix) -> [[__m256d; 4]; 4] {
    const SCALE: f64 = 1.0 / (1u64 << 31) as f64;
    clip.m.map(|[a, b, c, d]| {
        [a as f64 * SCALE, b as f64 * SCALE, c as f64 * SCALE, d as f64 + 0.5]
            .map(|v| _mm256_set1_pd(v))
    })
}

/// `floor(v r 2^-31)` for |v| < 2^31, r < 2^32; `r` comes divided by 2^31.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn ratio(v: __m256d, r: __m256d) -> __m256d {
    let product = _mm256_mul_pd(v, r);
    let error = _mm256_fmsub_pd(v, r, product);
    let whole = _mm256_floor_pd(product);
    let rest = _mm256_add_pd(_mm256_sub_pd(product, whole), error);
    _mm256_add_pd(whole, _mm256_floor_pd(rest))
}

/// Integers below 2^51 in size as 64-bit lanes, modulo 2^32 in the low halves.
#[inline]
#[target_feature(enable = "avx2")]
fn words(v: __m256d) -> __m256i {
    _mm256_castpd_si256(_mm256_add_pd(v, _mm256_set1_pd(1.5 * (1u64 << 52) as f64)))
}

/// Clip coordinates x, y, z, w of the four positions in `bytes` (24, the first of 32).
#[inline]
#[target_feature(enable = "avx2,fma")]
fn clip_coordinates(four: &[[i16; 3]; FOUR], rows: &[[__m256d; 4]; 4]) -> [__m256d; 4] {
    let at = four.as_ptr().cast::<u8>();
    // SAFETY: bytes 0 - 15 and 8 - 23 of the array's 24.
    let p = unsafe { _mm256_loadu2_m128i(at.add(8).cast(), at.cast()) };
    const {
        assert!(FOUR * BYTES == 24);
    }
    const N: i8 = -1;
    // Words to the upper halves of 32 bits: x0 x1 y0 y1 | x2 x3 y2 y3, then z0 z1 . . | z2 z3 . .
    let xy = _mm256_setr_epi8(
        N, N, 0, 1, N, N, 6, 7, N, N, 2, 3, N, N, 8, 9, N, N, 4, 5, N, N, 10, 11, N, N, 6, 7, N, N,
        12, 13,
    );
    let z = _mm256_setr_epi8(
        N, N, 4, 5, N, N, 10, 11, N, N, N, N, N, N, N, N, N, N, 8, 9, N, N, 14, 15, N, N, N, N, N,
        N, N, N,
    );
    let xy = _mm256_permute4x64_epi64(_mm256_shuffle_epi8(p, xy), 0b11_01_10_00);
    let z = _mm256_permute4x64_epi64(_mm256_shuffle_epi8(p, z), 0b11_01_10_00);
    let x = _mm256_cvtepi32_pd(_mm256_castsi256_si128(xy));
    let y = _mm256_cvtepi32_pd(_mm256_extracti128_si256(xy, 1));
    let z = _mm256_cvtepi32_pd(_mm256_castsi256_si128(z));
    rows.map(|[a, b, c, d]| {
        let sum = _mm256_fmadd_pd(c, z, d);
        _mm256_floor_pd(_mm256_fmadd_pd(a, x, _mm256_fmadd_pd(b, y, sum)))
    })
}

/// See [`Avx2::project`](super::Avx2::project).
#[target_feature(enable = "avx2,fma")]
pub fn project(
    viewport: &Viewport,
    clip: &ClipMatrix,
    positions: &[[i16; 3]],
    rgb: [u8; 3],
    vertices: &mut [Vertex],
) {
    let count = positions.len().min(vertices.len());
    let (fours, rest) = positions[..count].as_chunks::<FOUR>();
    let (vertex_fours, vertex_rest) = vertices[..count].as_chunks_mut::<FOUR>();
    let one = |position: &[i16; 3]| Vertex { rgb, ..viewport.project(&clip.apply(*position)) };
    let rows = rows(clip);
    let half = viewport.half().map(|v| v as f64);
    let (half_x, half_y) = (_mm256_set1_pd(half[0]), _mm256_set1_pd(half[1]));
    let zero = _mm256_setzero_pd();
    let rgb_word = u32::from_le_bytes([rgb[0], rgb[1], rgb[2], 0]) as i64;
    // Exponent field of w: 1023 + 31 - lz.
    let flags_from = _mm256_set1_epi64x((1054 << 24) + rgb_word);
    for (four, out) in fours.iter().zip(vertex_fours) {
        let [x, y, z, w] = clip_coordinates(four, &rows);
        let sign = _mm256_set1_pd(-0.0);
        let size = _mm256_max_pd(_mm256_andnot_pd(sign, x), _mm256_andnot_pd(sign, y));
        let guard = _mm256_mul_pd(w, _mm256_set1_pd((1 << GUARD_BITS) as f64));
        let near = _mm256_or_pd(
            _mm256_cmp_pd::<_CMP_LT_OQ>(z, zero),
            _mm256_cmp_pd::<_CMP_LE_OQ>(w, zero),
        );
        let far = _mm256_or_pd(
            _mm256_cmp_pd::<_CMP_GT_OQ>(z, w),
            _mm256_cmp_pd::<_CMP_GT_OQ>(size, guard),
        );
        if _mm256_movemask_pd(_mm256_or_pd(near, far)) != 0 {
            *out = four.each_ref().map(one);
            continue;
        }
        // W = w 2^lz in [2^31, 2^32), r = ceil(2^63 / W) - 1.
        let bits = _mm256_castpd_si256(w);
        let field = _mm256_and_si256(bits, _mm256_set1_epi64x(0x7ff << 52));
        let mantissa = _mm256_andnot_si256(_mm256_set1_epi64x(0x7ff << 52), bits);
        let top = _mm256_castsi256_pd(_mm256_or_si256(mantissa, _mm256_set1_epi64x(1054 << 52)));
        let all = _mm256_set1_pd((1u64 << 63) as f64);
        let quotient = _mm256_floor_pd(_mm256_div_pd(all, top));
        let remainder = _mm256_fnmadd_pd(quotient, top, all);
        let over = _mm256_cmp_pd::<_CMP_LE_OQ>(remainder, zero);
        let r = _mm256_sub_pd(quotient, _mm256_and_pd(over, _mm256_set1_pd(1.0)));
        let scaled = _mm256_mul_pd(r, _mm256_set1_pd(1.0 / (1u64 << 31) as f64));
        // 2^(lz - 32).
        let unit = _mm256_castsi256_pd(_mm256_sub_epi64(_mm256_set1_epi64x(2045 << 52), field));
        let screen = |v: __m256d, half: __m256d| {
            let v = _mm256_mul_pd(ratio(v, scaled), unit);
            _mm256_floor_pd(_mm256_fmadd_pd(v, half, _mm256_set1_pd(0.5)))
        };
        let column = words(_mm256_add_pd(half_x, screen(x, half_x)));
        let row = words(_mm256_sub_pd(half_y, screen(y, half_y)));
        let steps = _mm256_set1_pd(65535.0 * 65536.0);
        let deep = _mm256_floor_pd(_mm256_mul_pd(_mm256_mul_pd(ratio(z, scaled), unit), steps));
        let deep = words(_mm256_min_pd(deep, _mm256_set1_pd(crate::depth::MAX as f64)));
        let flags =
            _mm256_sub_epi64(flags_from, _mm256_slli_epi64(_mm256_srli_epi64(bits, 52), 24));
        // To memory: x y z r of each vertex, then colour and flags.
        let pair = |low, high| _mm256_blend_epi32(low, _mm256_slli_epi64(high, 32), 0b1010_1010);
        let (xy, zr) = (pair(column, row), pair(deep, words(r)));
        let (even, odd) = (_mm256_unpacklo_epi64(xy, zr), _mm256_unpackhi_epi64(xy, zr));
        let flags_high = _mm256_extracti128_si256(flags, 1);
        let flags = _mm256_castsi256_si128(flags);
        let quads = [
            (_mm256_castsi256_si128(even), _mm_extract_epi32(flags, 0)),
            (_mm256_castsi256_si128(odd), _mm_extract_epi32(flags, 2)),
            (_mm256_extracti128_si256(even, 1), _mm_extract_epi32(flags_high, 0)),
            (_mm256_extracti128_si256(odd, 1), _mm_extract_epi32(flags_high, 2)),
        ];
        for (vertex, (quad, last)) in out.iter_mut().zip(quads) {
            let at: *mut i32 = (vertex as *mut Vertex).cast();
            // SAFETY: a vertex is five words in this order (repr(C), asserted where it is declared), any bits are a value.
            unsafe {
                _mm_storeu_si128(at.cast(), quad);
                at.add(4).write(last);
            }
        }
    }
    for (position, vertex) in rest.iter().zip(vertex_rest) {
        *vertex = one(position);
    }
}

#[cfg(test)]
mod tests {
    use crate::avx2::Avx2;
    use crate::math::Mat4;
    use crate::transform::{CLIP, ClipMatrix, Vertex, Viewport};

    /// Random matrices of all sizes and positions, extremes among them, against one at a time.
    #[test]
    fn four_are_one_at_a_time() {
        let Some(avx2) = Avx2::detect() else { return };
        let mut seed = 7u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            seed >> 16
        };
        let (mut seen, mut clipped) = (0, 0);
        for case in 0..20_000 {
            let mut real = || (random() % (1 << 32)) as f64 / (1u64 << 31) as f64 - 1.0;
            let size = 2f64.powi(case % 40 - 20);
            let mut m = [(); 4].map(|()| [(); 4].map(|()| real() * size));
            m[3][3] = size * [1.0, 2.5, 4.0, 1.7][case as usize % 4];
            if case % 3 == 0 {
                // An orthographic camera: w is a power of two, or is not.
                m[3] = [0.0, 0.0, 0.0, m[3][3]];
            }
            let clip = ClipMatrix::new(&Mat4::from_f64(m));
            let positions: [[i16; 3]; 11] = core::array::from_fn(|_| {
                [(); 3].map(|()| {
                    let v = random();
                    let which = (v >> 16) as usize % 6;
                    [v as i16, v as i16, i16::MIN, i16::MAX, 0, (v % 5) as i16][which]
                })
            });
            let viewport =
                Viewport::new(1 + (random() % 4096) as u16, 1 + (random() % 4096) as u16);
            let mut got = [Vertex::default(); 11];
            avx2.project(&viewport, &clip, &positions, [1, 2, 3], &mut got);
            for (got, p) in got.iter().zip(positions) {
                let want = Vertex { rgb: [1, 2, 3], ..viewport.project(&clip.apply(p)) };
                assert_eq!(*got, want, "{p:?} {clip:?} {viewport:?}");
                if want.flags & CLIP == 0 { seen += 1 } else { clipped += 1 }
            }
        }
        assert!(seen > 20_000 && clipped > 20_000, "{seen} {clipped}");
    }
}
