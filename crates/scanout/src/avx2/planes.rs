//! Setup, eight triangles at a time: edge functions in 32-bit lanes, planes in `f64` lanes, four and four.
#![allow(unsafe_code)]

use core::arch::x86_64::*;

use super::memory::{all_below, gather, gather_triangles, load, store};
use super::{EIGHT, Planes, STRIP, Source, Triangles};
use crate::texture::SUBTEXEL_BITS;

/// Eight numbers: lanes 0 - 3 and 4 - 7.
type Wide = [__m256d; 2];

/// The integers of eight lanes.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn wide(v: __m256i) -> Wide {
    [
        _mm256_cvtepi32_pd(_mm256_castsi256_si128(v)),
        _mm256_cvtepi32_pd(_mm256_extracti128_si256(v, 1)),
    ]
}

/// Whole numbers below 2^51 in size to eight lanes, modulo 2^32.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn narrow(v: Wide) -> __m256i {
    let magic = _mm256_set1_pd(1.5 * (1u64 << 52) as f64);
    let v = v.map(|v| _mm256_castpd_ps(_mm256_add_pd(v, magic)));
    let mixed = _mm256_castps_pd(_mm256_shuffle_ps(v[0], v[1], 0b10_00_10_00));
    _mm256_castpd_si256(_mm256_permute4x64_pd(mixed, 0b11_01_10_00))
}

/// Numbers below zero in lanes that hold a 64-bit mask each, to bits.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn bits(v: Wide) -> u32 {
    (_mm256_movemask_pd(v[0]) | _mm256_movemask_pd(v[1]) << 4) as u32
}

/// What all planes of eight triangles share.
struct Frame {
    /// `v1 - v0`, `v2 - v0` with the sign of the area, times 16.
    d1: [Wide; 2],
    d2: [Wide; 2],
    area: Wide,
    /// Half the area, rounded down.
    half: Wide,
    /// From the first corner to the first pixel's centre, in pixels.
    first: [Wide; 2],
    /// [`Triangle::lift`](crate::setup::Triangle::lift).
    lift: __m256i,
}

impl Frame {
    /// The planes through three values a triangle: from the pixel at which drawing begins; `base` are the first corners' values modulo
    /// 2^32. The bits returned are of lanes whose gradients are too steep for this.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn planes(&self, values: [Wide; 3], base: __m256i, out: &mut Planes) -> u32 {
        let (mut gx, mut gy) = ([_mm256_setzero_pd(); 2], [_mm256_setzero_pd(); 2]);
        let (mut start, mut steep) = (gx, gy);
        for i in 0..2 {
            let da1 = _mm256_sub_pd(values[1][i], values[0][i]);
            let da2 = _mm256_sub_pd(values[2][i], values[0][i]);
            let gradient = |plus: __m256d, with: __m256d, minus: __m256d, other: __m256d| {
                let n = _mm256_fmadd_pd(plus, with, self.half[i]);
                let n = _mm256_fnmadd_pd(minus, other, n);
                _mm256_floor_pd(_mm256_div_pd(n, self.area[i]))
            };
            gx[i] = gradient(da1, self.d2[1][i], da2, self.d1[1][i]);
            gy[i] = gradient(da2, self.d1[0][i], da1, self.d2[0][i]);
            let sum = _mm256_mul_pd(gy[i], self.first[1][i]);
            start[i] = _mm256_floor_pd(_mm256_fmadd_pd(gx[i], self.first[0][i], sum));
            // Below 2^40: exact products with up to 2^12 sixteenths of a pixel, and all below 2^51.
            let sign = _mm256_set1_pd(-0.0);
            let size = _mm256_max_pd(_mm256_andnot_pd(sign, gx[i]), _mm256_andnot_pd(sign, gy[i]));
            steep[i] = _mm256_cmp_pd::<_CMP_NLT_UQ>(size, _mm256_set1_pd((1u64 << 40) as f64));
        }
        store(&mut out.start, _mm256_add_epi32(narrow(start), base));
        store(&mut out.gx, narrow(gx));
        store(&mut out.gy, narrow(gy));
        bits(steep)
    }
}

/// See [`Avx2::set_up`](super::Avx2::set_up).
#[target_feature(enable = "avx2,fma")]
pub fn set_up(source: &Source, indices: &[u32; EIGHT], out: &mut Triangles) {
    out.ready = 0;
    let triangle = load(&indices.map(|i| i as i32));
    // Three words a triangle must fit a signed index.
    if source.triangles.len() > 1 << 29 || !all_below(triangle, source.triangles.len()) {
        return;
    }
    // SAFETY: just tested.
    let index = unsafe { gather_triangles(source.triangles, triangle) };
    let most = _mm256_max_epi32(_mm256_max_epi32(index[0], index[1]), index[2]);
    if !all_below(most, source.vertices.len()) {
        return;
    }
    // SAFETY: just tested.
    let (x, y, z) = unsafe {
        (
            index.map(|i| gather::<_, 0>(source.vertices, i)),
            index.map(|i| gather::<_, 1>(source.vertices, i)),
            index.map(|i| gather::<_, 2>(source.vertices, i)),
        )
    };
    let number = |v: i32| _mm256_set1_epi32(v);
    let least = |v: [__m256i; 3]| _mm256_min_epi32(_mm256_min_epi32(v[0], v[1]), v[2]);
    let greatest = |v: [__m256i; 3]| _mm256_max_epi32(_mm256_max_epi32(v[0], v[1]), v[2]);
    let first_pixel = |v: __m256i| _mm256_srai_epi32(_mm256_add_epi32(v, number(7)), 4);
    let (x_low, x_high, y_low, y_high) = (least(x), greatest(x), least(y), greatest(y));
    let (left, right) = (first_pixel(x_low), first_pixel(x_high));
    let (top, bottom) = (first_pixel(y_low), first_pixel(y_high));

    // As `Triangle::is_tiny`, for strips of sixteen columns: small, and (h + 1) (2 (w + 1) + 16) < 2047.
    let above = |v: __m256i, most: i32| _mm256_cmpgt_epi32(v, number(most));
    let (w, h) = (_mm256_sub_epi32(right, left), _mm256_sub_epi32(bottom, top));
    let rows = _mm256_add_epi32(h, number(1));
    let columns = _mm256_add_epi32(_mm256_add_epi32(w, w), number(2 + STRIP as i32));
    let reach = |low: __m256i, high: __m256i| {
        _mm256_max_epi32(_mm256_sub_epi32(_mm256_setzero_si256(), low), high)
    };
    let far = above(_mm256_max_epi32(reach(x_low, x_high), reach(y_low, y_high)), (1 << 15) - 1);
    // What is not far is at most 4096 pixels high: the product fits.
    let large = _mm256_or_si256(far, above(_mm256_mullo_epi32(rows, columns), 2046));

    // Where drawing begins.
    let from = _mm256_max_epi32(left, _mm256_setzero_si256());
    let to = _mm256_min_epi32(right, number(source.width));
    let first_row = _mm256_max_epi32(top, number(source.rows.0));
    let last_row = _mm256_min_epi32(bottom, number(source.rows.1));
    let column = _mm256_min_epi32(from, number(source.width - STRIP as i32));
    store(&mut out.x, column);
    store(&mut out.left, from);
    store(&mut out.right, to);
    store(&mut out.top, first_row);
    store(&mut out.rows, _mm256_sub_epi32(last_row, first_row));

    let difference = |v: [__m256i; 3], i: usize, j: usize| _mm256_sub_epi32(v[i], v[j]);
    let (d1x, d1y) = (difference(x, 1, 0), difference(y, 1, 0));
    let (d2x, d2y) = (difference(x, 2, 0), difference(y, 2, 0));
    let area = _mm256_sub_epi32(_mm256_mullo_epi32(d1x, d2y), _mm256_mullo_epi32(d2x, d1y));
    let flat = _mm256_cmpeq_epi32(area, _mm256_setzero_si256());
    let signed = |v: __m256i| _mm256_sign_epi32(v, area);
    let sides = [
        [signed(d1x), signed(d1y)],
        [signed(difference(x, 2, 1)), signed(difference(y, 2, 1))],
        [signed(difference(x, 0, 2)), signed(difference(y, 0, 2))],
    ];
    // Centre of the first pixel.
    let centre = |pixel: __m256i| _mm256_add_epi32(_mm256_slli_epi32(pixel, 4), number(8));
    let (px, py) = (centre(column), centre(first_row));
    for (i, [dx, dy]) in sides.into_iter().enumerate() {
        // a = -dy, b = dx; zero counts where a > 0, or a = 0 and b > 0.
        let zero = _mm256_setzero_si256();
        let a = _mm256_sub_epi32(zero, dy);
        let top_edge = _mm256_and_si256(_mm256_cmpeq_epi32(dy, zero), _mm256_cmpgt_epi32(dx, zero));
        let top_left = _mm256_or_si256(_mm256_cmpgt_epi32(zero, dy), top_edge);
        let at = _mm256_add_epi32(
            _mm256_mullo_epi32(a, _mm256_sub_epi32(px, x[i])),
            _mm256_mullo_epi32(dx, _mm256_sub_epi32(py, y[i])),
        );
        // Less one unless top or left: all ones are -1.
        let at = _mm256_add_epi32(at, _mm256_andnot_si256(top_left, number(-1)));
        store(&mut out.edges[i].start, _mm256_srai_epi32(at, 4));
        store(&mut out.edges[i].gx, a);
        store(&mut out.edges[i].gy, dx);
    }

    let sixteen = _mm256_set1_pd(16.0);
    let times16 = |v: Wide| v.map(|v| _mm256_mul_pd(v, sixteen));
    let size = _mm256_abs_epi32(area);
    let sixteenth = _mm256_set1_pd(1.0 / 16.0);
    let pixels = |v: __m256i| wide(v).map(|v| _mm256_mul_pd(v, sixteenth));
    let extent = |a: __m256i, b: __m256i| _mm256_or_si256(_mm256_abs_epi32(a), _mm256_abs_epi32(b));
    let extents = _mm256_add_epi32(extent(d1x, d2x), extent(d1y, d2y));
    let frame = Frame {
        d1: [times16(wide(signed(d1x))), times16(wide(signed(d1y)))],
        d2: [times16(wide(signed(d2x))), times16(wide(signed(d2y)))],
        area: wide(size),
        half: wide(_mm256_srli_epi32(size, 1)),
        first: [pixels(_mm256_sub_epi32(px, x[0])), pixels(_mm256_sub_epi32(py, y[0]))],
        lift: _mm256_add_epi32(_mm256_srli_epi32(extents, 5), number(2)),
    };
    // U16.16 less 2^31: a difference of depths is the same.
    let biased = z.map(|z| wide(_mm256_xor_si256(z, number(i32::MIN))));
    let half = number(0x8000);
    let mut odd = frame.planes(biased, _mm256_add_epi32(z[0], half), &mut out.depth);
    if source.gouraud {
        // SAFETY: tested above.
        let rgb = index.map(|i| unsafe { gather::<_, 4>(source.vertices, i) });
        let byte = number(0xff << 16);
        let red = rgb.map(|v| _mm256_and_si256(_mm256_slli_epi32(v, 16), byte));
        let green = rgb.map(|v| _mm256_and_si256(_mm256_slli_epi32(v, 8), byte));
        let blue = rgb.map(|v| _mm256_and_si256(v, byte));
        for (channel, out) in [red, green, blue].into_iter().zip(&mut out.colour) {
            odd |= frame.planes(channel.map(|v| wide(v)), _mm256_add_epi32(channel[0], half), out);
        }
    }
    if source.texture.is_some() {
        odd |= texture(source, triangle, index, &frame, out);
    }
    let odd = odd | {
        let large = _mm256_castsi256_ps(_mm256_or_si256(large, flat));
        _mm256_movemask_ps(large) as u32
    };
    out.ready = !odd & 0xff;
}

/// The planes of 1/w, s/w and t/w, as `common_inverse_w` and `TextureSetup::new` make them of triangles whose `index` are in range; bits
/// of lanes for which this does not do.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn texture(
    source: &Source,
    triangle: __m256i,
    index: [__m256i; 3],
    frame: &Frame,
    out: &mut Triangles,
) -> u32 {
    const ALL: u32 = 0xff;
    let Some(texture) = source.texture else { return ALL };
    if !all_below(triangle, source.uv_triangles.len()) {
        return ALL;
    }
    // SAFETY: just tested.
    let uv_index = unsafe { gather_triangles(source.uv_triangles, triangle) };
    let most = _mm256_max_epi32(_mm256_max_epi32(uv_index[0], uv_index[1]), uv_index[2]);
    if !all_below(most, source.uvs.len()) {
        return ALL;
    }
    let number = |v: i32| _mm256_set1_epi32(v);
    // SAFETY: both indices were tested.
    let (mantissa, flags, uvs) = unsafe {
        (
            index.map(|i| gather::<_, 3>(source.vertices, i)),
            index.map(|i| gather::<_, 4>(source.vertices, i)),
            [
                uv_index.map(|i| gather::<_, 0>(source.uvs, i)),
                uv_index.map(|i| gather::<_, 1>(source.uvs, i)),
            ],
        )
    };
    let exponent = flags.map(|f| _mm256_and_si256(_mm256_srli_epi32(f, 24), number(31)));
    let common = _mm256_max_epi32(_mm256_max_epi32(exponent[0], exponent[1]), exponent[2]);
    let common = _mm256_add_epi32(common, number(9));
    let q = [0, 1, 2].map(|i| {
        let shifted = _mm256_srlv_epi32(mantissa[i], _mm256_sub_epi32(common, exponent[i]));
        _mm256_max_epi32(shifted, number(1))
    });
    let q_wide = q.map(|q| wide(q));
    let shifted = q.map(|q| _mm256_slli_epi32(q, 8));
    let mut odd = frame.planes(shifted.map(|q| wide(q)), shifted[0], &mut out.q);
    // Reciprocals of everything between are below 2^31; the plane errs by far less than what this leaves.
    let least = _mm256_min_epi32(_mm256_min_epi32(q[0], q[1]), q[2]);
    let far = _mm256_cmpgt_epi32(number(1 << 17), least);
    odd |= _mm256_movemask_ps(_mm256_castsi256_ps(far)) as u32;
    for (axis, uv) in uvs.into_iter().enumerate() {
        let low = _mm256_min_epi32(_mm256_min_epi32(uv[0], uv[1]), uv[2]);
        let repeats = _mm256_andnot_si256(number(0xffff), low);
        let uv = uv.map(|v| _mm256_sub_epi32(v, repeats));
        // At most 16 repeats within a triangle.
        let all = _mm256_or_si256(_mm256_or_si256(uv[0], uv[1]), uv[2]);
        let many = _mm256_cmpeq_epi32(_mm256_srli_epi32(all, 20), _mm256_setzero_si256());
        odd |= !_mm256_movemask_ps(_mm256_castsi256_ps(many)) as u32 & ALL;
        // As `local`: twice 1/4096 texel and one, times 1/w: below 2^27 2^23.
        let scale = texture.size[axis] as f64 / (1u32 << (16 - SUBTEXEL_BITS)) as f64;
        let mut products = [[_mm256_setzero_pd(); 2]; 3];
        for k in 0..3 {
            let uv = wide(uv[k]);
            for i in 0..2 {
                let nearest = _mm256_fmadd_pd(uv[i], _mm256_set1_pd(scale), _mm256_set1_pd(0.5));
                let nearest = _mm256_floor_pd(nearest);
                let local = _mm256_add_pd(_mm256_add_pd(nearest, nearest), _mm256_set1_pd(1.0));
                products[k][i] = _mm256_mul_pd(local, q_wide[k][i]);
            }
        }
        // Down to 31 bits, by the exponent of the largest.
        let mut drops = [_mm256_setzero_pd(); 2];
        for i in 0..2 {
            let largest =
                _mm256_max_pd(_mm256_max_pd(products[0][i], products[1][i]), products[2][i]);
            let field = _mm256_srli_epi64(_mm256_castpd_si256(largest), 52);
            let drop = _mm256_sub_epi32(field, _mm256_set1_epi64x(1023 + 30));
            let drop = _mm256_max_epi32(drop, _mm256_setzero_si256());
            let unit = _mm256_slli_epi64(_mm256_sub_epi64(_mm256_set1_epi64x(1023), drop), 52);
            drops[i] = _mm256_castsi256_pd(drop);
            for product in &mut products {
                let v = _mm256_fmadd_pd(product[i], _mm256_castsi256_pd(unit), _mm256_set1_pd(0.5));
                product[i] = _mm256_floor_pd(v);
            }
        }
        let drops = drops.map(|v| _mm256_castpd_ps(v));
        let mixed = _mm256_castps_pd(_mm256_shuffle_ps(drops[0], drops[1], 0b10_00_10_00));
        let drop = _mm256_castpd_si256(_mm256_permute4x64_pd(mixed, 0b11_01_10_00));
        let shift = _mm256_sub_epi32(number(48 + SUBTEXEL_BITS as i32), drop);
        store(&mut out.shift[axis], shift);
        let base = _mm256_add_epi32(narrow(products[0]), frame.lift);
        odd |= frame.planes(products, base, &mut out.st[axis]);
    }
    odd
}

#[cfg(test)]
mod tests {
    use crate::avx2::{Avx2, EIGHT, Planes, STRIP, Source, Triangles};
    use crate::interpolate::Plane;
    use crate::setup::Triangle;
    use crate::texture::{Repeat565, SUBTEXEL_BITS, Texels, Texture, TextureSetup};
    use crate::transform::{Vertex, common_inverse_w};

    const WIDTH: i32 = 640;
    const ROWS: (i32, i32) = (40, 400);

    struct Random(u64);
    impl Random {
        fn below(&mut self, n: u32) -> u32 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (((self.0 >> 32) * n as u64) >> 32) as u32
        }
        fn around(&mut self, centre: i32, reach: u32) -> i32 {
            centre + self.below(2 * reach + 1) as i32 - reach as i32
        }
    }

    fn same(planes: &Planes, i: usize, plane: &Plane, at: (i32, i32), plus: u32) {
        let want = [plane.at(at.0, at.1).wrapping_add(plus), plane.gx, plane.gy];
        assert_eq!([planes.start[i], planes.gx[i], planes.gy[i]].map(|v| v as u32), want);
    }

    /// Random triangles of all kinds, slivers and far ones among them: eight are what one at a time gives, or not ready.
    #[test]
    fn eight_are_one_at_a_time() {
        let Some(avx2) = Avx2::detect() else { return };
        let mut random = Random(11);
        let texels = [0u16; 250 * 125];
        let texture = Texture::new(250, 125, Texels::Rgb565(&texels)).unwrap();
        let (mut tiny, mut ready) = (0, 0);
        for case in 0..6000 {
            let reach = [8, 60, 200, 300, 1000, 40_000][case % 6];
            let mut vertices = [Vertex::default(); 3 * EIGHT];
            for triangle in vertices.chunks_exact_mut(3) {
                let centre = [random.around(5000, 6000), random.around(4000, 4500)];
                let depth = random.below(u32::MAX);
                for v in triangle {
                    (v.x, v.y) = (random.around(centre[0], reach), random.around(centre[1], reach));
                    v.z = if case % 2 == 0 {
                        depth ^ random.below(1 << 20)
                    } else {
                        random.below(65535 << 16)
                    };
                    v.inv_w = 1 << 31 | random.below(1 << 31);
                    v.flags = 10 + random.below(if case % 50 == 0 { 20 } else { 2 }) as u8;
                    v.rgb = [(); 3].map(|()| random.below(256) as u8);
                }
            }
            let spread = [1 << 12, 1 << 16, 1 << 22][case % 3];
            let uvs: [[i32; 2]; 3 * EIGHT] =
                core::array::from_fn(|_| [(); 2].map(|()| random.around(0, spread)));
            let triangles: [[u16; 3]; EIGHT] =
                core::array::from_fn(|i| [0, 1, 2].map(|k| (3 * i + k) as u16));
            let source = Source {
                triangles: &triangles,
                vertices: &vertices,
                uv_triangles: &triangles,
                uvs: &uvs,
                texture: Repeat565::new(&texture),
                gouraud: true,
                rows: ROWS,
                width: WIDTH,
            };
            let mut got = Triangles::default();
            avx2.set_up(&source, &core::array::from_fn(|i| i as u32), &mut got);
            for i in 0..EIGHT {
                let v = [0, 1, 2].map(|k| &vertices[3 * i + k]);
                let t = Triangle::new(v.map(|v| [v.x, v.y]));
                let Some(t) = t.filter(Triangle::is_tiny) else {
                    assert_eq!(got.ready >> i & 1, 0);
                    continue;
                };
                tiny += 1;
                if got.ready >> i & 1 == 0 {
                    continue;
                }
                ready += 1;
                let (left, right) = (t.min()[0].max(0), t.max()[0].min(WIDTH));
                let (top, bottom) = (t.min()[1].max(ROWS.0), t.max()[1].min(ROWS.1));
                assert_eq!([got.left[i], got.right[i]], [left, right]);
                assert_eq!([got.top[i], got.rows[i]], [top, bottom - top]);
                if left >= right || top >= bottom {
                    continue;
                }
                let at = (left.min(WIDTH - STRIP as i32), top);
                assert_eq!(got.x[i], at.0);
                for (edge, planes) in t.edges().iter().zip(&got.edges) {
                    assert_eq!(planes.start[i] as i64, edge.at(at.0, at.1));
                    assert_eq!([planes.gx[i], planes.gy[i]].map(i64::from), [edge.a, edge.b]);
                }
                same(&got.depth, i, &t.plane(v.map(|v| v.z)), at, 0x8000);
                for c in 0..3 {
                    let plane = t.plane(v.map(|v| (v.rgb[c] as u32) << 16));
                    same(&got.colour[c], i, &plane, at, 0x8000);
                }
                let (q, _) = common_inverse_w(v);
                assert!(q.iter().all(|&q| q >= 1 << 17));
                same(&got.q, i, &t.plane(q.map(|q| q << 8)), at, 0);
                let uv = [0, 1, 2].map(|k| uvs[3 * i + k]);
                let setup = TextureSetup::new(&t, &texture, uv, q);
                for axis in 0..2 {
                    same(&got.st[axis], i, &setup.perspective.st[axis], at, 0);
                    assert_eq!(
                        got.shift[axis][i] as u32,
                        setup.perspective.shift[axis] + SUBTEXEL_BITS
                    );
                }
            }
        }
        // Too steep are slivers, too many repeats are rare.
        assert!(tiny > 15_000 && ready > tiny * 6 / 10, "{tiny} {ready}");
    }
}
