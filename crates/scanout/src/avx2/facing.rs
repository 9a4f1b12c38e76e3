//! Cull, eight triangles at a time.
#![allow(unsafe_code)]

use core::arch::x86_64::*;

use super::memory::{all_below, gather, store, triangles};
use super::{EIGHT, Seen};
use crate::transform::{CLIP, Vertex};

/// See [`Avx2::facing`](super::Avx2::facing).
#[target_feature(enable = "avx2,fma,popcnt")]
pub fn facing(
    groups: &[[[u16; 3]; EIGHT]],
    vertices: &[Vertex],
    size: [i32; 2],
    one_sided: bool,
    seen: &mut Seen,
) -> Option<usize> {
    (seen.turned, seen.outside) = (0, 0);
    groups.iter().position(|group| {
        seen.plain = eight(group, vertices, size, one_sided, seen);
        !seen.plain || seen.kept != 0
    })
}

/// Tests one group; false when it is not of the plain kind.
#[inline]
#[target_feature(enable = "avx2,fma,popcnt")]
fn eight(
    group: &[[u16; 3]; EIGHT],
    vertices: &[Vertex],
    size: [i32; 2],
    one_sided: bool,
    seen: &mut Seen,
) -> bool {
    let index = triangles(group);
    let most = _mm256_max_epi32(_mm256_max_epi32(index[0], index[1]), index[2]);
    if !all_below(most, vertices.len()) {
        return false;
    }
    // SAFETY: just tested.
    let (x, y, flags) = unsafe {
        (
            index.map(|i| gather::<_, 0>(vertices, i)),
            index.map(|i| gather::<_, 1>(vertices, i)),
            index.map(|i| gather::<_, 4>(vertices, i)),
        )
    };
    let flags = _mm256_or_si256(_mm256_or_si256(flags[0], flags[1]), flags[2]);
    let low = |v: [__m256i; 3]| _mm256_min_epi32(_mm256_min_epi32(v[0], v[1]), v[2]);
    let high = |v: [__m256i; 3]| _mm256_max_epi32(_mm256_max_epi32(v[0], v[1]), v[2]);
    let (x_low, x_high, y_low, y_high) = (low(x), high(x), low(y), high(y));
    // Sides below 2^15: twice the area fits 31 bits.
    let side = _mm256_or_si256(_mm256_sub_epi32(x_high, x_low), _mm256_sub_epi32(y_high, y_low));
    let clip = _mm256_and_si256(flags, _mm256_set1_epi32((CLIP as i32) << 24));
    let wide = _mm256_andnot_si256(_mm256_set1_epi32(0x7fff), side);
    let odd = _mm256_or_si256(clip, wide);
    if _mm256_testz_si256(odd, odd) == 0 {
        return false;
    }
    let difference = |v: [__m256i; 3], i: usize| _mm256_sub_epi32(v[i], v[0]);
    let area = _mm256_sub_epi32(
        _mm256_mullo_epi32(difference(x, 1), difference(y, 2)),
        _mm256_mullo_epi32(difference(x, 2), difference(y, 1)),
    );
    let zero = _mm256_setzero_si256();
    let back = _mm256_cmpgt_epi32(area, zero);
    let none = _mm256_cmpeq_epi32(area, zero);
    let turned = if one_sided { _mm256_or_si256(back, none) } else { none };
    // Pixel centres from `ceil((v - 8) / 16)` on.
    let first = |v: __m256i| _mm256_srai_epi32(_mm256_add_epi32(v, _mm256_set1_epi32(7)), 4);
    let from = |v: __m256i| _mm256_max_epi32(first(v), zero);
    let to = |v: __m256i, end: i32| _mm256_min_epi32(first(v), _mm256_set1_epi32(end));
    let (top, bottom) = (from(y_low), to(y_high, size[1]));
    let inside = _mm256_and_si256(
        _mm256_cmpgt_epi32(to(x_high, size[0]), from(x_low)),
        _mm256_cmpgt_epi32(bottom, top),
    );
    let bits = |v: __m256i| _mm256_movemask_ps(_mm256_castsi256_ps(v)) as u32;
    let (turned, inside) = (bits(turned), bits(inside));
    seen.turned += turned.count_ones();
    seen.outside += 8 - (inside | turned).count_ones();
    seen.kept = inside & !turned;
    if seen.kept != 0 {
        seen.back = bits(back);
        store(&mut seen.top, top);
        store(&mut seen.bottom, bottom);
    }
    true
}

#[cfg(test)]
mod tests {
    use crate::avx2::{Avx2, EIGHT, Seen};
    use crate::setup::{first_pixel, signed_area};
    use crate::transform::{FAR, Vertex};

    /// Random triangles of all sizes: those of plain groups are what the definition says, and groups that are not plain have a reason.
    #[test]
    fn eight_are_one_at_a_time() {
        let Some(avx2) = Avx2::detect() else { return };
        let mut seed = 5u64;
        let mut random = |n: i32| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (((seed >> 32) * n as u64) >> 32) as i32
        };
        let (mut kept, mut odd) = (0, 0);
        for case in 0..20_000 {
            let size = [1 + random(640), 1 + random(480)];
            let reach = [20, 300, 5000, 40_000, 400_000, 1 << 29][case % 6];
            let mut vertices = [Vertex::default(); 3 * EIGHT];
            for triangle in vertices.chunks_exact_mut(3) {
                let centre =
                    [random(size[0] * 32) - size[0] * 8, random(size[1] * 32) - size[1] * 8];
                for v in triangle {
                    (v.x, v.y) = (centre[0] + random(reach) - reach / 2, centre[1] + random(reach));
                    v.flags = if random(200) == 0 { FAR } else { 31 };
                }
            }
            let one_sided = case % 2 == 0;
            let mut group: [[u16; 3]; EIGHT] =
                core::array::from_fn(|i| [0, 1, 2].map(|k| (3 * i + k) as u16));
            if case % 100 == 0 {
                group[7][2] = 3 * EIGHT as u16;
            }
            let mut seen = Seen::default();
            let found = avx2.facing(&[group], &vertices, size, one_sided, &mut seen);
            let mut want = Seen { plain: true, ..Seen::default() };
            for (i, triangle) in group.iter().enumerate() {
                let v = triangle.map(|k| vertices.get(k as usize).copied());
                let [Some(a), Some(b), Some(c)] = v else {
                    want.plain = false;
                    continue;
                };
                let low = [a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y)];
                let high = [a.x.max(b.x).max(c.x), a.y.max(b.y).max(c.y)];
                let wide = (0..2).any(|k| high[k] - low[k] >= 1 << 15);
                want.plain &= !wide && (a.flags | b.flags | c.flags) & FAR == 0;
                let area = signed_area(&[a, b, c].map(|v| [v.x, v.y]));
                let [first, last] = [low, high].map(|v| v.map(first_pixel));
                let (top, bottom) = (first[1].max(0), last[1].min(size[1]));
                let inside = first[0].max(0) < last[0].min(size[0]) && top < bottom;
                if area == 0 || (area > 0 && one_sided) {
                    want.turned += 1;
                } else if !inside {
                    want.outside += 1;
                } else {
                    want.kept |= 1 << i;
                    (want.top[i], want.bottom[i]) = (top, bottom);
                }
                want.back |= ((area > 0) as u32) << i;
            }
            assert_eq!(seen.plain, want.plain);
            assert_eq!(found.is_some(), !want.plain || want.kept != 0);
            if !want.plain {
                odd += 1;
                continue;
            }
            let counts = |s: &Seen| (s.kept, s.turned, s.outside);
            assert_eq!(counts(&seen), counts(&want), "{vertices:?}");
            for i in (0..EIGHT).filter(|i| want.kept >> i & 1 == 1) {
                kept += 1;
                assert_eq!((seen.top[i], seen.bottom[i]), (want.top[i], want.bottom[i]));
                assert_eq!(seen.back >> i & 1, want.back >> i & 1);
            }
        }
        assert!(kept > 10_000 && odd > 5000, "{kept} {odd}");
    }
}
