//! Setup: three screen vertices become edge functions and the constants of planes.
//!
//! Screen positions are Q28.4. With `d1 = v1 - v0`, `d2 = v2 - v0`, twice the area is `A = d1x d2y - d2x d1y` (1/256
//! pixel^2), positive when the corners run clockwise on the screen (y down). Everything below is multiplied by
//! the sign of `A`, so both windings are set up alike.
//!
//! **Edges.** For the edge from a to b, `E(p) = (b - a) x (p - a) >= 0` inside; zero counts on top and left edges only:
//!
//! ```text
//!        top: dy = 0, dx > 0                 At the pixel centre p = (16 x + 8, 16 y + 8) the
//!      a ----------> b                       test becomes, exactly,
//!       ^           /
//!  left |          / right                       a x + b y + k >= 0
//!  dy<0 |        v
//!       c <-----                             a = -dy, b = dx, k = floor((E(8, 8) - t) / 16),
//!         bottom                             t = 0 on top and left edges, 1 on others
//! ```
//!
//! **Planes.** `gx = 16 (da1 d2y - da2 d1y) / A`, `gy = 16 (d1x da2 - d2x da1) / A`, the exact quotients rounded to nearest;
//! `c = a0 + floor((gx (8 - x0) + gy (8 - y0)) / 16)`. For triangles that reach beyond 2048 pixels from the frame's
//! corner, both gradients get `e` more fraction bits before `c` is formed, `e = bits(max |coordinate| in pixels) - 11`, and
//! are rounded to the usual ones after; so a plane is as exact on the screen however far away its corners lie.
//!
//! | range of coordinates | arithmetic | bound |
//! |---|---|---|
//! | below 2^15 (2048 pixels) | i64 | numerators < 2^54 |
//! | below 2^29 | i64; quotients a bit a step, modulo 2^64 | edge values < 2^61 |
//!
//! What it will not do: triangles without area (there is nothing to draw).

use crate::interpolate::Plane;
use crate::math::{NARROW, NO_DIVISION, floor};

/// An edge: a pixel is inside where `a x + b y + k >= 0`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Edge {
    /// Change from one column to the next.
    pub a: i64,
    /// Change from one row to the next.
    pub b: i64,
    /// Value at pixel (0, 0).
    pub k: i64,
}

impl Edge {
    /// The edge whose inside is on the right of the direction (`dx`, `dy`), from its value `at_centre` of pixel (0, 0) times
    /// 16.
    #[inline(always)]
    fn new([dx, dy]: [i64; 2], at_centre: i64) -> Edge {
        let (a, b) = (-dy, dx);
        let top_left = a > 0 || (a == 0 && b > 0);
        Edge { a, b, k: (at_centre - !top_left as i64) >> 4 }
    }

    /// The value at pixel (x, y); inside where not negative.
    #[inline(always)]
    pub fn at(&self, x: i32, y: i32) -> i64 {
        self.a * x as i64 + self.b * y as i64 + self.k
    }
}

/// A triangle ready for the raster stage, and able to make planes.
#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    /// Q28.4.
    pub(crate) corners: [[i32; 2]; 3],
    /// The corners run counter-clockwise on the screen: the area is negative.
    pub(crate) turned: bool,
    /// |A|, 1/256 pixel^2.
    pub area: i64,
    /// Every coordinate is below 2^15 in size: edge values fit 32 bits inside the frame.
    pub small: bool,
}

/// Twice the area with its sign, 1/256 pixel^2: positive for clockwise corners on the screen. Coordinates within +-2^29.
#[inline(always)]
pub fn signed_area(v: &[[i32; 2]; 3]) -> i64 {
    if NO_DIVISION {
        // Where a product of 64 bits is a call: differences of 16 bits, as most are, need none.
        let [x1, y1] = [v[1][0] - v[0][0], v[1][1] - v[0][1]];
        let [x2, y2] = [v[2][0] - v[0][0], v[2][1] - v[0][1]];
        if [x1, y1, x2, y2].iter().fold(0, |all, &d| all | (d + (1 << 14)) as u32) >> 15 == 0 {
            return (x1 * y2 - x2 * y1) as i64;
        }
    }
    // Widened where that costs least.
    let minus = |a: i32, b: i32| if NARROW { (a - b) as i64 } else { a as i64 - b as i64 };
    let d1 = [minus(v[1][0], v[0][0]), minus(v[1][1], v[0][1])];
    let d2 = [minus(v[2][0], v[0][0]), minus(v[2][1], v[0][1])];
    d1[0] * d2[1] - d2[0] * d1[1]
}

/// Every coordinate is below 2^15 in size.
#[cold]
#[inline(never)]
fn is_small(v: &[[i32; 2]; 3]) -> bool {
    v.as_flattened().iter().all(|v| v.unsigned_abs() < 1 << 15)
}

/// First pixel whose centre is not before a Q28.4 coordinate: `ceil((v - 8) / 16)`.
#[inline(always)]
pub fn first_pixel(v: i32) -> i32 {
    (v + 7) >> 4
}

impl Triangle {
    /// Sets up a triangle from its corners, Q28.4, each |coordinate| <= 2^29; `None` when it has no area.
    // On Armv6-M, where 64 bits are many instructions, a call instead of copies of them.
    #[cfg_attr(not(all(target_arch = "arm", not(target_has_atomic = "32"))), inline(always))]
    #[cfg_attr(all(target_arch = "arm", not(target_has_atomic = "32")), inline(never))]
    pub fn new(v: [[i32; 2]; 3]) -> Option<Triangle> {
        let area = signed_area(&v);
        if area == 0 {
            return None;
        }
        // Most are within half of that, which one test tells.
        let near = v.as_flattened().iter().fold(0, |all, &v| all | (v + (1 << 14)) as u32);
        let small = near >> 15 == 0 || is_small(&v);
        Some(Triangle { corners: v, turned: area < 0, area: area.abs(), small })
    }

    /// First column and first row whose centres may be covered.
    #[inline(always)]
    pub fn min(&self) -> [i32; 2] {
        let [a, b, c] = self.corners;
        [0, 1].map(|i: usize| first_pixel(a[i].min(b[i]).min(c[i])))
    }

    /// One past the last column and the last row.
    #[inline(always)]
    pub fn max(&self) -> [i32; 2] {
        let [a, b, c] = self.corners;
        [0, 1].map(|i: usize| first_pixel(a[i].max(b[i]).max(c[i])))
    }

    /// What planes that must not fall below 0 are lifted by: no less than their rounding can take away at a covered pixel.
    ///
    /// Gradients err by half a unit a column and a row, from corner 0 on, and `c` by less than one: together by at most half the sum of the
    /// sides' reach in x and in y, and one. Nothing beyond [`small`](Self::small): rounding may err by 2^12 there, and lifting all by so much would
    /// move more texels than it mends.
    #[inline(always)]
    pub(crate) fn lift(&self) -> u32 {
        if !self.small {
            return 0;
        }
        let [d1, d2] = self.sides();
        let reach = |i: usize| d1[i].unsigned_abs() | d2[i].unsigned_abs();
        ((reach(0) + reach(1)) >> 5) + 2
    }

    /// The largest size of a coordinate.
    fn reach(&self) -> i32 {
        self.corners.as_flattened().iter().fold(0, |most, v| most.max(v.abs()))
    }

    /// The three edges.
    #[inline(always)]
    pub fn edges(&self) -> [Edge; 3] {
        let ([d1, d2], o) = (self.wide_sides(), self.offset());
        // The three edge functions add up to the area everywhere.
        let first = d1[0] * o[1] - d1[1] * o[0];
        let last = d2[1] * o[0] - d2[0] * o[1];
        [
            Edge::new(d1, first),
            Edge::new([d2[0] - d1[0], d2[1] - d1[1]], self.area - first - last),
            Edge::new([-d2[0], -d2[1]], last),
        ]
    }

    /// The three edges, by a call: for what is rarely done.
    #[inline(never)]
    pub(crate) fn edges_by_call(&self) -> [Edge; 3] {
        self.edges()
    }

    /// The three edges as a, b and the value at pixel (x, y), by 32-bit arithmetic: for triangles whose box, and the pixel
    /// in it, is at most 64 pixels wide and high.
    #[inline]
    pub(crate) fn near_edges(&self, x: i32, y: i32) -> [[i32; 3]; 3] {
        let ([d1, d2], origin) = (self.sides(), self.corners[0]);
        let (ox, oy) = (16 * x + 8 - origin[0], 16 * y + 8 - origin[1]);
        let edge = |[dx, dy]: [i32; 2], at_centre: i32| {
            let top_left = dy < 0 || (dy == 0 && dx > 0);
            [-dy, dx, (at_centre - !top_left as i32) >> 4]
        };
        let (first, last) = (d1[0] * oy - d1[1] * ox, d2[1] * ox - d2[0] * oy);
        [
            edge(d1, first),
            edge([d2[0] - d1[0], d2[1] - d1[1]], self.area as i32 - first - last),
            edge([-d2[0], -d2[1]], last),
        ]
    }

    /// `v1 - v0` and `v2 - v0`, times the sign of the area.
    #[inline(always)]
    pub(crate) fn sides(&self) -> [[i32; 2]; 2] {
        let ([from, a, b], sign) = (self.corners, -(self.turned as i32));
        [a, b].map(|to| [0, 1].map(|i: usize| ((to[i] - from[i]) ^ sign) - sign))
    }

    #[inline(always)]
    fn wide_sides(&self) -> [[i64; 2]; 2] {
        self.sides().map(|d| d.map(i64::from))
    }

    /// From the first corner to the centre of pixel (0, 0).
    #[inline(always)]
    fn offset(&self) -> [i64; 2] {
        self.corners[0].map(|v| 8 - v as i64)
    }

    /// The plane through three values, one a corner, in the attribute's own format; see
    /// [`interpolate`](crate::interpolate).
    ///
    /// Cost: two 64-bit divisions and eight multiplications where [`small`](Self::small).
    #[inline]
    pub fn plane(&self, a: [u32; 3]) -> Plane {
        let [plane] = self.planes([a]);
        plane
    }

    /// The planes of several attributes: what they share is computed once.
    #[inline(always)]
    pub fn planes<const N: usize>(&self, values: [[u32; 3]; N]) -> [Plane; N] {
        self.planes_and_fit(values).0
    }

    /// The same, and whether all changes a column fit 32 bits with a sign, so that nothing wraps from one covered pixel to the
    /// next but a value just below 0.
    #[inline(always)]
    pub fn planes_and_fit<const N: usize>(&self, values: [[u32; 3]; N]) -> ([Plane; N], bool) {
        if !self.small {
            return (values.map(|a| self.wide_plane(a)), false);
        }
        let planes = self.exact_planes(values);
        let fit = planes.iter().all(|&[_, gx, _]| gx == gx as i32 as i64);
        (planes.map(|[c, gx, gy]| Plane { c: c as u32, gx: gx as u32, gy: gy as u32 }), fit)
    }

    /// `c`, `gx` and `gy` of the planes of a [`small`](Self::small) triangle before they are taken modulo 2^32; `c` modulo 2^60, and exact where the
    /// area is at least 2^8.
    #[inline(always)]
    pub(crate) fn exact_planes<const N: usize>(&self, values: [[u32; 3]; N]) -> [[i64; 3]; N] {
        let ([d1, d2], [ox, oy]) = (self.wide_sides(), self.offset());
        let half = self.area >> 1;
        let mut planes = [[0; 3]; N];
        for (plane, a) in planes.iter_mut().zip(&values) {
            let (da1, da2) = (a[1] as i64 - a[0] as i64, a[2] as i64 - a[0] as i64);
            let gx = floor((da1 * d2[1] - da2 * d1[1]) * 16 + half, self.area);
            let gy = floor((d1[0] * da2 - d2[0] * da1) * 16 + half, self.area);
            let offset = gx.wrapping_mul(ox).wrapping_add(gy.wrapping_mul(oy));
            *plane = [(offset >> 4).wrapping_add(a[0] as i64), gx, gy];
        }
        planes
    }

    /// The same for corners far outside the screen.
    #[cold]
    #[inline(never)]
    fn wide_plane(&self, a: [u32; 3]) -> Plane {
        let e = (32 - (self.reach() >> 4).leading_zeros()).saturating_sub(11);
        let ([d1, d2], [ox, oy]) = (self.wide_sides(), self.offset());
        let (da1, da2) = (a[1] as i64 - a[0] as i64, a[2] as i64 - a[0] as i64);
        let gx = self.long_quotient(da1 * d2[1] - da2 * d1[1], 4 + e);
        let gy = self.long_quotient(d1[0] * da2 - d2[0] * da1, 4 + e);
        // All that is asked for lies within the lowest 64 bits.
        let offset = gx.wrapping_mul(ox).wrapping_add(gy.wrapping_mul(oy));
        let half = (1i64 << e) >> 1;
        Plane {
            c: a[0].wrapping_add((offset >> (4 + e)) as u32),
            gx: (gx.wrapping_add(half) >> e) as u32,
            gy: (gy.wrapping_add(half) >> e) as u32,
        }
    }

    /// `n 2^bits / area`, nearest, halves upwards, modulo 2^64: a division, then a bit a step.
    #[inline(never)]
    fn long_quotient(&self, n: i64, bits: u32) -> i64 {
        let (mut quotient, mut rest) = (n.div_euclid(self.area), n.rem_euclid(self.area));
        for _ in 0..bits {
            let next = (2 * rest >= self.area) as i64;
            rest = 2 * rest - next * self.area;
            quotient = quotient << 1 | next;
        }
        quotient.wrapping_add((rest + (self.area >> 1) >= self.area) as i64)
    }

    /// Whether edge values fit 16 bits at every pixel of the box and up to eight columns beside it.
    ///
    /// With a box of w x h pixels, |a| <= 16 (h + 1) and |b| <= 16 (w + 1), and every edge is zero somewhere in the box, so
    /// |value| <= 16 (h + 1) (w + 9) + 16 (w + 1) (h + 1) + 1.
    #[inline]
    pub fn is_tiny(&self) -> bool {
        let (min, max) = (self.min(), self.max());
        let [w, h] = [0, 1].map(|i| (max[i] - min[i]) as i64 + 1);
        self.small && h * (2 * w + 8) < 2047
    }

    /// Whether the box has at most so many pixels and is no wider or higher than that.
    #[inline(always)]
    pub(crate) fn has_few(&self, pixels: i32) -> bool {
        let (min, max) = (self.min(), self.max());
        let (w, h) = (max[0] - min[0], max[1] - min[1]);
        self.small && w <= pixels && h <= pixels && w * h <= pixels
    }

    /// Whether the centre of pixel (x, y) is covered.
    #[inline]
    pub fn covers(&self, x: i32, y: i32) -> bool {
        self.edges().iter().all(|edge| edge.at(x, y) >= 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Random(u64);
    impl Random {
        fn next(&mut self, n: i64) -> i64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 33) as i64 % n
        }
        fn corners(&mut self, low: i64, size: i64) -> [[i32; 2]; 3] {
            [(); 3].map(|()| [(low + self.next(size)) as i32, (low + self.next(size)) as i32])
        }
    }

    /// Coverage from the definition: exact cross products, centre at .5, top-left rule.
    fn covered(v: &[[i32; 2]; 3], x: i32, y: i32) -> bool {
        let sign = signed_area(v).signum() as i128;
        (0..3).all(|i| {
            let (p, q) = (v[i].map(i128::from), v[(i + 1) % 3].map(i128::from));
            let (dx, dy) = ((q[0] - p[0]) * sign, (q[1] - p[1]) * sign);
            let e = dx * (16 * y as i128 + 8 - p[1]) - dy * (16 * x as i128 + 8 - p[0]);
            e > 0 || (e == 0 && (dy < 0 || (dy == 0 && dx > 0)))
        })
    }

    #[test]
    fn edges_equal_the_definition() {
        let mut random = Random(1);
        for i in 0..3000 {
            let size = [64, 512, 1 << 15][i % 3];
            let v = random.corners(if i % 3 == 2 { -(1 << 14) } else { 0 }, size);
            let Some(t) = Triangle::new(v) else { continue };
            for y in -2..34 {
                for x in -2..34 {
                    assert_eq!(t.covers(x, y), covered(&v, x, y), "{v:?} at {x},{y}");
                    let boxed = (t.min()[0]..t.max()[0]).contains(&x)
                        && (t.min()[1]..t.max()[1]).contains(&y);
                    assert!(boxed || !t.covers(x, y), "{v:?}: {x},{y} lies outside the box");
                }
            }
        }
    }

    #[test]
    fn small_ends_at_2_to_the_15() {
        for (v, small) in [(32_767, true), (32_768, false), (-32_767, true), (-32_768, false)] {
            for i in 0..6 {
                let mut corners = [[3, 5], [400, 9], [70, 800]];
                corners[i / 2][i % 2] = v;
                let t = Triangle::new(corners).unwrap();
                assert_eq!(t.small, small, "{corners:?}");
            }
        }
    }

    #[test]
    fn wide_edges_equal_the_definition() {
        let mut random = Random(2);
        for _ in 0..2000 {
            let v = random.corners(-(1 << 28), 1 << 29);
            let Some(t) = Triangle::new(v) else { continue };
            for i in 0..50 {
                let (x, y) = (i * 37 % 640, i * 91 % 480);
                assert_eq!(t.covers(x, y), covered(&v, x, y), "{v:?} at {x},{y}");
            }
        }
    }

    /// Largest difference between the plane and the exact rational over covered pixels, in units of the attribute.
    fn plane_error(v: [[i32; 2]; 3], a: [u32; 3], step: i32) -> f64 {
        let Some(t) = Triangle::new(v) else { return 0.0 };
        let plane = t.plane(a);
        let area = signed_area(&v) as i128;
        let mut worst = 0f64;
        for y in (t.min()[1].max(0)..t.max()[1].min(480)).step_by(step as usize) {
            for x in (t.min()[0].max(0)..t.max()[0].min(640)).step_by(step as usize) {
                if t.covers(x, y) {
                    let p = [16 * x as i128 + 8, 16 * y as i128 + 8];
                    let weight = |i: usize| {
                        let (b, c) =
                            (v[(i + 1) % 3].map(i128::from), v[(i + 2) % 3].map(i128::from));
                        (c[0] - b[0]) * (p[1] - b[1]) - (c[1] - b[1]) * (p[0] - b[0])
                    };
                    let exact: i128 = (0..3).map(|i| weight(i) * a[i] as i128).sum();
                    let got = plane.at(x, y) as i128;
                    worst = worst
                        .max((got * area - exact) as f64 / area as f64)
                        .max((exact - got * area) as f64 / area as f64);
                }
            }
        }
        worst
    }

    #[test]
    fn planes_are_exact_to_a_sixteenth_of_a_step() {
        let mut random = Random(3);
        let mut worst = 0f64;
        for i in 0..4000 {
            let size = [100, 1000, 10_000][i % 3];
            let v = random.corners(0, size);
            let a = [(); 3].map(|()| (random.next(65536) as u32) << 16);
            worst = worst.max(plane_error(v, a, 1 + size as i32 / 400));
        }
        assert!(worst < 4096.0, "{worst} / 65536 of a step");
    }

    #[test]
    fn slivers_and_far_corners_are_as_exact() {
        let mut random = Random(4);
        let mut worst = 0f64;
        for i in 0..4000 {
            let a = [(); 3].map(|()| (random.next(65536) as u32) << 16);
            let mut v = random.corners(0, 10_000);
            if i % 2 == 0 {
                // Nearly on a line.
                v[2] = [0, 1].map(|k| (v[0][k] + v[1][k]) / 2 + random.next(3) as i32);
            } else {
                v = random.corners(-(1 << 27), 1 << 28);
            }
            worst = worst.max(plane_error(v, a, 7));
        }
        assert!(worst < 4096.0 + 64.0, "{worst} / 65536 of a step");
    }

    /// The definition of a far triangle's gradients in 128 bits.
    #[test]
    fn far_gradients_are_exact() {
        let mut random = Random(6);
        for i in 0..20_000 {
            let mut v = random.corners(-(1 << 29), 1 << 30);
            if i % 3 == 0 {
                v[2] = [0, 1].map(|k| (v[0][k] + v[1][k]) / 2 + random.next(3) as i32);
            }
            let a = [(); 3].map(|()| (random.next(65536) << 16 | random.next(65536)) as u32);
            let Some(t) = Triangle::new(v) else { continue };
            if t.small {
                continue;
            }
            let e = (32 - (t.reach() >> 4).leading_zeros()).saturating_sub(11);
            let (area, sign) = (t.area as i128, signed_area(&v).signum() as i128);
            let d = |i: usize, k: usize| (v[i][k] - v[0][k]) as i128 * sign;
            let da = |i: usize| a[i] as i128 - a[0] as i128;
            let quotient = |n: i128| ((n << (4 + e)) + (area >> 1)).div_euclid(area);
            let gx = quotient(da(1) * d(2, 1) - da(2) * d(1, 1));
            let gy = quotient(d(1, 0) * da(2) - d(2, 0) * da(1));
            let offset = gx * (8 - v[0][0] as i128) + gy * (8 - v[0][1] as i128);
            let half = (1i128 << e) >> 1;
            let exact = Plane {
                c: a[0].wrapping_add((offset >> (4 + e)) as u32),
                gx: ((gx + half) >> e) as u32,
                gy: ((gy + half) >> e) as u32,
            };
            assert_eq!(t.plane(a), exact, "{v:?} {a:?}");
        }
    }

    #[test]
    fn both_windings_are_alike() {
        let mut random = Random(5);
        for _ in 0..1000 {
            let v = random.corners(0, 3000);
            let a = [(); 3].map(|()| random.next(1 << 24) as u32);
            if let (Some(s), Some(t)) = (Triangle::new(v), Triangle::new([v[0], v[2], v[1]])) {
                assert_eq!(s.plane(a), t.plane([a[0], a[2], a[1]]));
                assert_eq!((s.min(), s.max(), s.area), (t.min(), t.max(), t.area));
            }
        }
    }
}
