//! Clip: triangles and lines that cross the near plane, the far plane or the guard band.
//!
//! Most primitives never come here: what crosses the screen's edges is cut by the raster stage, exactly, and the guard band
//! reaches 8192 screens out. A new vertex on the edge from `a` (inside, distance `da >= 0`) to `b` (outside, `db < 0`) is
//!
//! ```text
//! v = a + (b - a) da / (da - db)        rounded to nearest, exact
//! ```
//!
//! always from the inside corner outwards: two triangles that share the edge get the same vertex, so no crack opens. As each
//! coordinate is rounded on its own, a new vertex may lie outside the guard band by a hair (its near and far planes it meets, as z and w
//! round alike); it is brought back to `|x|, |y| <= 8192 w`. What it will not do: clip against the screen's sides (that would move edges by rounding their ends).

use crate::features;
use crate::transform::GUARD_BITS;

/// The most corners a clipped triangle can have: one more for each of the six planes.
pub const MAX_CORNERS: usize = 9;

/// A corner with everything that is interpolated along an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Corner {
    /// Clip coordinates.
    pub clip: [i32; 4],
    /// Texture coordinates, Q16.16.
    pub uv: [i32; 2],
    /// Colour.
    pub rgb: [u8; 3],
    /// Normal for per-pixel lighting, Q2.14.
    pub normal: [i32; 3],
    /// Position for per-pixel lighting.
    pub position: [i32; 3],
}

/// Distance of a corner from plane 0 - 5 (near, far, left, right, bottom, top guard); inside when not negative.
fn distance(plane: usize, c: &[i32; 4]) -> i64 {
    let [x, y, z, w] = c.map(i64::from);
    match plane {
        // A corner with z = 0 and no w (a camera whose near plane is its eye) is outside too.
        0 => z.min(w - 1),
        1 => w - z,
        2 => (w << GUARD_BITS) + x,
        3 => (w << GUARD_BITS) - x,
        4 => (w << GUARD_BITS) + y,
        _ => (w << GUARD_BITS) - y,
    }
}

/// `a + (b - a) n / d` rounded to nearest, halves upwards, for 0 <= n <= d < 2^47.
///
/// A product of 79 bits over 47 bits, in two digits of 16 bits: no intermediate reaches 2^63.
#[inline(never)]
fn lerp(a: i32, b: i32, n: u64, d: u64) -> i32 {
    let size = b.abs_diff(a) as u64;
    let high = (size >> 16) * n;
    let low = ((high % d) << 16) + (size & 0xffff) * n;
    let (quotient, rest) = (((high / d) << 16) + low / d, low % d);
    // A half is rounded towards b when b is above, else towards a.
    if b >= a {
        (a as i64 + (quotient + (2 * rest >= d) as u64) as i64) as i32
    } else {
        (a as i64 - (quotient + (2 * rest > d) as u64) as i64) as i32
    }
}

/// The point of the edge from `a` (inside) to `b` (outside) on the plane.
#[inline(never)]
fn cross(a: &Corner, b: &Corner, da: i64, db: i64) -> Corner {
    let (n, d) = (da as u64, (da - db) as u64);
    let mix = |a: i32, b: i32| lerp(a, b, n, d);
    let mut corner = *a;
    for (out, &b) in corner.clip.iter_mut().zip(&b.clip) {
        *out = mix(*out, b);
    }
    for (out, &b) in corner.uv.iter_mut().zip(&b.uv) {
        *out = mix(*out, b);
    }
    for (out, &b) in corner.rgb.iter_mut().zip(&b.rgb) {
        *out = mix(*out as i32, b as i32) as u8;
    }
    if features::PHONG {
        for (out, &b) in corner.normal.iter_mut().zip(&b.normal) {
            *out = mix(*out, b);
        }
        for (out, &b) in corner.position.iter_mut().zip(&b.position) {
            *out = mix(*out, b);
        }
    }
    corner
}

/// The nearest coordinates within the guard band; w is 1 or more.
fn inside([x, y, z, w]: [i32; 4]) -> [i32; 4] {
    let guard = ((w as i64) << GUARD_BITS).clamp(0, i32::MAX as i64) as i32;
    [x.clamp(-guard, guard), y.clamp(-guard, guard), z, w]
}

/// A convex polygon left of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Polygon {
    corners: [Corner; MAX_CORNERS],
    len: usize,
}

impl Polygon {
    /// The corners, in the triangle's order; none when nothing is left.
    pub fn corners(&self) -> &[Corner] {
        &self.corners[..self.len]
    }
}

/// Clips a triangle.
pub fn triangle(corners: [Corner; 3]) -> Polygon {
    let mut polygon = Polygon { corners: [Corner::default(); MAX_CORNERS], len: 3 };
    polygon.corners[..3].copy_from_slice(&corners);
    for plane in 0..6 {
        let input = polygon;
        if input.corners().iter().all(|c| distance(plane, &c.clip) >= 0) {
            continue;
        }
        polygon.len = 0;
        for i in 0..input.len {
            let (a, b) = (&input.corners[i], &input.corners[(i + 1) % input.len]);
            let (da, db) = (distance(plane, &a.clip), distance(plane, &b.clip));
            if da >= 0 {
                polygon.push(*a);
            }
            if da >= 0 && db < 0 {
                polygon.push(cross(a, b, da, db));
            } else if da < 0 && db >= 0 {
                polygon.push(cross(b, a, db, da));
            }
        }
    }
    if polygon.len < 3 {
        polygon.len = 0;
    }
    for corner in &mut polygon.corners[..polygon.len] {
        corner.clip = inside(corner.clip);
    }
    polygon
}

impl Polygon {
    fn push(&mut self, corner: Corner) {
        if let Some(slot) = self.corners.get_mut(self.len) {
            *slot = corner;
            self.len += 1;
        }
    }
}

/// Clips a line; `None` when nothing is left.
pub fn line(mut a: Corner, mut b: Corner) -> Option<[Corner; 2]> {
    for plane in 0..6 {
        let (da, db) = (distance(plane, &a.clip), distance(plane, &b.clip));
        match (da >= 0, db >= 0) {
            (true, true) => {}
            (true, false) => b = cross(&a, &b, da, db),
            (false, true) => a = cross(&b, &a, db, da),
            (false, false) => return None,
        }
    }
    Some([a, b].map(|end| Corner { clip: inside(end.clip), ..end }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(clip: [i32; 4]) -> Corner {
        Corner { clip, ..Corner::default() }
    }

    /// The definition in 128 bits.
    fn lerp_exact(a: i32, b: i32, n: i64, d: i64) -> i32 {
        let (n, d) = (n as i128, d as i128);
        (a as i128 + ((b as i128 - a as i128) * n * 2 + d).div_euclid(2 * d)) as i32
    }

    #[test]
    fn a_new_coordinate_is_exact() {
        let mut seed = 8u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            seed >> 16
        };
        let ends = [i32::MIN, i32::MAX, 0, 1, -1];
        for i in 0..200_000usize {
            let end =
                |k: usize, r: u64| if i % 3 == 0 { ends[k % 5] } else { (r as i32) >> (r >> 43) };
            let (a, b) = (end(i / 3, random()), end(i / 15, random()));
            let d = ((random() & ((1 << 47) - 1)) >> (random() % 47)).max(1);
            // Halves, too.
            let d = if i % 4 == 0 { (d & !1).max(2) } else { d };
            let n = if i % 4 == 0 { d / 2 } else { random() % (d + 1) };
            assert_eq!(lerp(a, b, n, d), lerp_exact(a, b, n as i64, d as i64), "{a} {b} {n} / {d}");
        }
    }

    #[test]
    fn inside_passes_unchanged() {
        let c = [[0, 0, 1, 10], [5, 0, 10, 10], [0, 5, 3, 10]].map(corner);
        assert_eq!(triangle(c).corners(), &c);
        assert_eq!(line(c[0], c[1]), Some([c[0], c[1]]));
    }

    #[test]
    fn one_corner_behind_makes_a_quad() {
        let c = [[0, 0, -100, 100], [500, 0, 100, 300], [0, 500, 100, 300]].map(corner);
        let polygon = triangle(c);
        assert_eq!(polygon.corners().len(), 4);
        assert_eq!(polygon.corners()[0].clip, [250, 0, 0, 200]);
        assert_eq!(polygon.corners()[3].clip, [0, 250, 0, 200]);
        assert!(triangle(c.map(|c| corner([c.clip[0], c.clip[1], -5, 7]))).corners().is_empty());
    }

    #[test]
    fn a_shared_edge_gives_one_vertex() {
        let mut seed = 9u64;
        let mut random = |n: u64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) as i64 as i32 % n as i32 - n as i32 / 2
        };
        for _ in 0..2000 {
            let mut any = || corner([random(1 << 28), random(1 << 28), random(1 << 27), 1 << 27]);
            let (a, b) = (any(), any());
            assert_eq!(line(a, b).map(|[p, q]| [q, p]), line(b, a));
        }
    }

    #[test]
    fn clipped_corners_lie_inside() {
        let mut seed = 10u64;
        let mut random = |n: u64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((seed >> 33) % n) as i64 as i32 - (n / 2) as i32
        };
        for _ in 0..5000 {
            let c = [(); 3].map(|()| {
                corner([random(1 << 30), random(1 << 30), random(1 << 20), random(1 << 20)])
            });
            for corner in triangle(c).corners() {
                assert!((0..6).all(|plane| distance(plane, &corner.clip) >= 0), "{corner:?}");
            }
            for end in line(c[0], c[1]).iter().flatten() {
                assert!((0..6).all(|plane| distance(plane, &end.clip) >= 0), "{end:?}");
            }
        }
    }
}
