//! Clusters that are turned away: eight triangles dropped by four products, their vertices not even transformed.
//!
//! The pipeline decides which way a triangle faces by its corners' positions in 1/16 pixel. A cluster is dropped only where all its
//! triangles are certain to be dropped so; so with clusters or without, pixels and counts are the same.
//!
//! # Why it is certain
//!
//! The rounded [`ClipMatrix`] counts as exact. `L(P) = M P + 2^15 t` are clip coordinates in units of 2^-15: rows x, y and w of it, `M` their first
//! three columns, `D = det M`, and `E` the eye in the mesh, `M E = -2^15 t`. For a triangle with normal `N = (P1 - P0) x (P2 - P0) = n |N|`,
//!
//! ```text
//! det [L0 L1 L2] = D (P0 - E) . N                                        positive for front faces
//! A = hx hy |D| |N| g / (w0 w1 w2),   g = n . P0 - n . E                  where D < 0
//! ```
//!
//! `A` is twice the area on the screen before rounding, positive for back faces; hx, hy half the viewport in sub-pixels. With
//! `|N| = l h` (the longest edge, the least altitude), and all of the object's w (units of 2^-15) in [w, W],
//!
//! ```text
//! A >= hx hy |D| l h g / W^3
//! ```
//!
//! The box of its corners on the screen has width + height `B`. As `x1/w1 - x0/w0 = ((x1 - x0) - (x0/w0) (w1 - w0)) / w1` and |x|, |y| <= k w
//! for all of the object (k is 1 or 2, tested),
//!
//! ```text
//! B <= K l / w,   K = hx (|Mx| + k |Mw|) + hy (|My| + k |Mw|)             |Mx|: length of the row's three columns
//! ```
//!
//! Rounding moves each coordinate by at most `e = 0.571` sub-pixels, if w is 2^20 clip units or more: 0.5; the reciprocal and the ratio's floor, 1.5 units
//! of 2^-32 of W = w 2^lz, times half a viewport of up to 2^15, 0.024; clip coordinates to nearest, (0.5 + 0.5 k) 2^15 / 2^20 = 0.047. So A moves
//! by at most `2 e B + 4 e^2`: each corner by e times the opposite edge's width + height, which sum to 2 B; and twice the area of a triangle in a square of side 2 e.
//! Now let `A >= c B`. Since A <= B^2 / 4, too, B >= 4 c, and `2 e B + 4 e^2 <= (2 e + e^2 / c) B <= c B` when `c >= (1 + sqrt 2) e`.
//! This is 1.379; c = 1.4. What is certain, then, is that A is not negative after rounding where
//!
//! ```text
//! h g >= limit = 1.4 K W^3 / (hx hy |D| w)
//! ```
//!
//! A triangle with an altitude of less than 1.4 sub-pixels never passes. All of the object is inside near and far planes (tested), so no triangle of
//! it takes the clip stage, which decides by other roundings. Over a cluster, |n - a| <= s, so `g >= d - a . E - s |E|`. Where h g is not
//! as large as the object's limit, W and w of the cluster alone give a lower one.
//!
//! What it will not do: objects without bounding sphere, that reach out of the view by more than its width, or across the near or far plane;
//! orthographic cameras (D = 0); mirrored objects (D > 0).

use super::{Plane, row_length};
use crate::math::isqrt64;
use crate::mesh::Sphere;
use crate::mesh_clusters::Cluster;
use crate::transform::{ClipMatrix, Viewport};

/// Where an object's clusters are seen from.
#[derive(Clone, Copy, Debug)]
pub struct ClusterView {
    /// The eye, in units of a position; below [`FAR_EYE`].
    eye: [i64; 3],
    /// |eye|, rounded up.
    eye_distance: i64,
    /// The least `h g` that suffices wherever in the object: 2^-14 of a position's unit, squared.
    limit: u64,
    depth: Depth,
}

/// w as a part of the object's greatest, Q.16.
#[derive(Clone, Copy, Debug)]
struct Depth {
    /// Of a position: 2^-24 of that.
    row: [i64; 4],
    /// Length of the row's first three, rounded up.
    length: i64,
    /// The object's least, rounded down.
    least: u64,
}

/// Bound of the eye's coordinates: what `h g` is made of stays below 2^62.
const FAR_EYE: u128 = 1 << 27;
/// Bound of the limit.
const GREAT_LIMIT: u128 = 1 << 46;
/// The least w, clip units.
const LEAST_W: i64 = 1 << 20;

impl ClusterView {
    /// What is needed of an object with these bounds; `None` where its clusters can't be judged.
    #[inline(never)]
    pub fn new(m: &ClipMatrix, viewport: &Viewport, bounds: &Sphere) -> Option<ClusterView> {
        let centre = m.apply_one(bounds.centre);
        let plane = |i, a, b| Plane::new(m, &centre, bounds.radius, i, a, b);
        let inside = |i, a, b| plane(i, a, b).inside();
        if !inside(2, 1, 0) || !inside(2, -1, 1) {
            return None;
        }
        let sides = |k| [0, 1].iter().all(|&i| inside(i, 1, k) && inside(i, -1, k));
        let k = [1, 2].into_iter().find(|&k| sides(k))?;
        let w = plane(3, 0, 1);
        let (least, most) = (w.at_centre - w.reach, w.at_centre + w.reach);
        if least < LEAST_W {
            return None;
        }
        let rows = [0, 1, 3].map(|i| m.m[i].map(i128::from));
        let cross = |a: [i128; 4], b: [i128; 4]| {
            [(1, 2), (2, 0), (0, 1)].map(|(i, j): (usize, usize)| a[i] * b[j] - a[j] * b[i])
        };
        let [x, y, w] = rows;
        let cofactors = [cross(y, w), cross(w, x), cross(x, y)];
        let determinant: i128 = (0..3).map(|i| x[i] * cofactors[0][i]).sum();
        if determinant >= 0 {
            return None;
        }
        // To nearest; the numerator is below 2^109.
        let size = determinant.unsigned_abs() as i128;
        let eye = [0, 1, 2].map(|i| {
            let sum: i128 = (0..3).map(|r| rows[r][3] * cofactors[r][i]).sum();
            ((sum << 16) + size).div_euclid(2 * size)
        });
        if eye.iter().any(|v| v.unsigned_abs() >= FAR_EYE) {
            return None;
        }
        let eye = eye.map(|v| v as i64);
        let squares = eye.iter().map(|v| v.unsigned_abs().pow(2)).sum();
        let eye_distance = isqrt64(squares) as i64 + 1;
        // K, below 2^49; limit 2^-14 = 1.4 K 2^30 W^3 / (hx hy |D| w) with w and W in clip units.
        let length = |i: usize| row_length(m, i, 1, 0);
        let [hx, hy] = viewport.half().map(|v| v as u128);
        let [lx, ly, lw] = [length(0), length(1), length(3)].map(|v| v as u128);
        let sum = hx * (lx + k as u128 * lw) + hy * (ly + k as u128 * lw);
        let [least_w, most_w] = [least, most].map(|v| v as u128);
        let numerator = (sum * 7).div_ceil(5) * (most_w * (most_w * most_w).div_ceil(least_w));
        let denominator = (hx * hy * size as u128) >> 44;
        let limit = numerator.checked_div(denominator)? + 1;
        if limit >= GREAT_LIMIT {
            return None;
        }
        let row = m.m[3].map(i64::from);
        let along = |v: i64| (v << 25).div_euclid(most);
        let depth = Depth {
            row: [
                along(row[0]),
                along(row[1]),
                along(row[2]),
                ((row[3] << 30).div_euclid(most)) << 10,
            ],
            length: ((lw as i64) << 25) / most + 1,
            least: ((least << 16) / most) as u64,
        };
        Some(ClusterView { eye, eye_distance, limit: limit as u64, depth })
    }

    /// Whether all of a cluster's triangles are certain to be dropped as back faces. Cost: four products for most.
    #[inline(always)]
    pub fn turned_away(&self, c: &Cluster) -> bool {
        let along = |k: usize| c.axis[k] as i64 * self.eye[k];
        let at_eye = along(0) + along(1) + along(2) + c.spread as i64 * self.eye_distance;
        // The eye's rounding is below one unit.
        let height = c.distance as i64 - (1 << 14) - at_eye;
        if height <= 0 {
            return false;
        }
        let product = height as u64 * c.altitude as u64;
        product >= self.limit || self.depth.turned_away(c, product, self.limit)
    }
}

impl Depth {
    /// The same, with the limit of this cluster's depths.
    #[inline(never)]
    fn turned_away(&self, c: &Cluster, product: u64, limit: u64) -> bool {
        let row = &self.row;
        let along = |k: usize| c.centre[k] as i64 * row[k];
        let (at_centre, reach) =
            (along(0) + along(1) + along(2) + row[3], c.radius as i64 * self.length);
        // What has been cut is below 2^17 units of 2^-24.
        let most = (((at_centre + reach) >> 24) + 2).clamp(0, 1 << 16) as u64;
        let least = (((at_centre - reach) >> 24) - 1).clamp(self.least as i64, 1 << 16) as u64;
        let times = |limit: u64| ((limit * most) >> 16) + 1;
        product * least >= times(times(times(limit))) * (self.least + 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    extern crate std;
    use crate::math::Mat4;
    use crate::setup::signed_area;
    use crate::transform::CLIP;

    struct Random(u64);

    impl Random {
        fn unit(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
        /// Any magnitude alike.
        fn between(&mut self, low: f64, high: f64) -> f64 {
            low * (high / low).powf((self.unit() + 1.0) / 2.0)
        }
        fn vector(&mut self) -> [f64; 3] {
            [self.unit(), self.unit(), self.unit()]
        }
        fn pick<T: Copy>(&mut self, of: &[T]) -> T {
            of[((self.unit() + 1.0) / 2.0 * of.len() as f64) as usize]
        }
    }

    fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }
    fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    }
    /// `a + b s`.
    fn add(a: [f64; 3], b: [f64; 3], s: f64) -> [f64; 3] {
        [0, 1, 2].map(|k| a[k] + b[k] * s)
    }
    fn unit(v: [f64; 3]) -> [f64; 3] {
        v.map(|x| x / dot(v, v).sqrt())
    }
    fn grid(v: [f64; 3]) -> [i16; 3] {
        v.map(|v| v.round().clamp(-32768.0, 32767.0) as i16)
    }

    /// The matrix of an eye that looks along `axis`, off the lens's own axis by `shift`.
    fn camera(eye: [f64; 3], axis: [f64; 3], lens: [f64; 2], shift: [f64; 2], size: f64) -> Mat4 {
        let side =
            unit(cross(axis, if axis[1].abs() < 0.9 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] }));
        let up = cross(side, axis);
        let row = |v: [f64; 3]| {
            [v[0] * 32768.0, v[1] * 32768.0, v[2] * 32768.0, -dot(v, eye)].map(|v| v * size)
        };
        let (x, y, w) = (
            add(side.map(|v| v * lens[0]), axis, shift[0]),
            add(up.map(|v| v * lens[1]), axis, shift[1]),
            row(axis),
        );
        let near = [0.0, 0.0, 0.0, -1e-3 * w[3].abs().max(size)];
        Mat4::from_f64([row(x), row(y), [0, 1, 2, 3].map(|k| w[k] * 0.999 + near[k]), w])
    }

    fn bounds(positions: &[[i16; 3]]) -> Sphere {
        let squared = |p: &[i16; 3]| p.iter().map(|&v| (v as i64).pow(2)).sum::<i64>();
        // About a centre that is not the origin's, like loaders' spheres.
        let sum = |k: usize| positions.iter().map(|p| p[k] as i64).sum::<i64>();
        let centre = [0, 1, 2].map(|k| (sum(k) / positions.len() as i64) as i16);
        let radius = positions
            .iter()
            .map(|p| isqrt64((0..3).map(|k| (p[k] as i64 - centre[k] as i64).pow(2) as u64).sum()))
            .max();
        assert!(positions.iter().all(|p| squared(p) <= 3 << 30));
        Sphere { centre, radius: radius.unwrap().min(65_534) as u16 + 1 }
    }

    /// Eight triangles each, of all sizes and shapes, nearly edge-on to eyes near and far: what is turned away would have been dropped.
    #[test]
    fn what_is_turned_away_would_be_dropped() {
        let mut random = Random(11);
        let (mut turned, mut kept, mut judged, mut grazing, mut dropped_all) = (0, 0, 0, 0, 0);
        for case in 0..300_000 {
            let eye = unit(random.vector()).map(|v| v * 1.0).map(|v| v * 32768.0);
            let eye = eye.map(|v| v * [1.2, 2.0, 3.0, 10.0, 100.0][case % 5]);
            let place = random.vector().map(|v| v * 24_000.0);
            let view = unit(add(place, eye, -1.0));
            // A normal along the view, turned away from the eye by a small angle.
            let across = unit(cross(view, random.vector()));
            let angle = random.between(1e-3, 1.0);
            let n = unit(add(across, view, angle));
            let (u, v) = (unit(cross(n, view)), unit(view));
            let size = random.between(2.0, 9_000.0);
            let (long, wide) = (random.between(0.3, 1.0), random.between(0.05, 1.0));
            let bend = random.pick(&[0.0, 0.01, 0.1, 0.3]) * angle;
            let mut positions = [[0; 3]; 24];
            for triangle in positions.as_chunks_mut::<3>().0 {
                let centre = add(add(place, u, random.unit() * size), v, random.unit() * size);
                let tilt = unit(add(n, random.vector(), bend));
                let turn = random.unit() * 3.2;
                let corners = [0.0, 2.1, 4.2].map(|at: f64| {
                    let (sin, cos) = (at + turn + random.unit() * 0.5).sin_cos();
                    let p = add(add(centre, u, cos * size * wide), v, sin * size * long);
                    grid(add(p, tilt, -dot(add(p, centre, -1.0), tilt)))
                });
                *triangle = corners;
                let [a, b, c] = corners.map(|p| p.map(f64::from));
                if dot(cross(add(b, a, -1.0), add(c, a, -1.0)), n) < 0.0 {
                    triangle.swap(1, 2);
                }
            }
            let triangles: [[u16; 3]; 8] =
                core::array::from_fn(|i| [0, 1, 2].map(|k| (3 * i + k) as u16));
            let lens = random.pick(&[0.5, 1.0, 2.4, 10.0, 100.0]);
            let lens = [lens, lens * random.between(0.5, 2.0)];
            let shift = [random.unit(), random.unit()].map(|v| if case % 3 == 0 { v } else { 0.0 });
            let axis =
                unit(add(view, random.vector(), random.pick(&[0.0, 0.2, 0.6]) / lens[0].max(1.0)));
            let m = camera(eye, axis, lens, shift, random.between(1e-7, 1e-3));
            let m = ClipMatrix::new(&m);
            let side = |random: &mut Random| {
                random.between(if case % 4 == 0 { 1.0 } else { 300.0 }, 4096.9) as u16
            };
            let viewport = Viewport::new(side(&mut random), side(&mut random));
            // Smaller than the object's, so that limits of a cluster are asked for, too.
            let own = bounds(&positions);
            let whole = if case % 2 == 0 {
                own
            } else {
                Sphere { radius: own.radius.saturating_add(own.radius / 2), ..own }
            };
            let Some(seen) = ClusterView::new(&m, &viewport, &whole) else { continue };
            judged += 1;
            let v = positions.map(|p| viewport.project(&m.apply(p)));
            let cluster = Cluster::new(&positions, &triangles);
            let drops = v.as_chunks::<3>().0.iter().all(|v| {
                v.iter().all(|v| v.flags & CLIP == 0) && signed_area(&v.map(|v| [v.x, v.y])) >= 0
            });
            dropped_all += drops as u32;
            if seen.turned_away(&cluster) {
                turned += 1;
                assert!(drops, "case {case}: {cluster:?} {seen:?} {viewport:?}");
                grazing += (angle < 0.03) as u32;
            } else {
                kept += 1;
            }
        }
        std::println!(
            "{judged} judged, {turned} turned away of {dropped_all}, {kept} kept, {grazing} grazing"
        );
        assert!(turned > 20_000 && kept > 20_000 && grazing > 2000, "{turned} {kept} {grazing}");
    }
}
