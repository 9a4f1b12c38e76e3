//! Cull: what need not be drawn.
//!
//! | test | on | exact |
//! |---|---|---|
//! | back face | sign of twice the screen area (i64); of the clip-space determinant (i128) for what is clipped | yes |
//! | no area | the same | yes |
//! | view volume | bounding box of pixel centres against the frame | yes |
//! | eight triangles | a cone of normals and the eye, with a margin for what rounding can turn ([`ClusterView`]) | no |
//! | whole mesh | bounding sphere against the six planes, in clip units, rounded so that it never culls what is visible | no |

mod clusters;

pub use clusters::ClusterView;

use crate::math::add_product;
use crate::mesh::Sphere;
use crate::transform::ClipMatrix;

/// Which way a triangle's corners run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// Counter-clockwise seen by the camera.
    Front,
    /// Clockwise.
    Back,
    /// Seen from its edge, or without area.
    Edge,
}

/// Facing from the sign of twice the screen area (y down, so counter-clockwise is negative).
#[inline(always)]
pub fn facing(signed_area: i64) -> Facing {
    match signed_area {
        ..0 => Facing::Front,
        0 => Facing::Edge,
        1.. => Facing::Back,
    }
}

/// Facing of a triangle that may reach behind the camera, from its clip coordinates: the sign of the determinant of
/// (x, y, w), which is positive for a front face.
pub fn facing_in_clip_space(c: &[[i32; 4]; 3]) -> Facing {
    let [a, b, c] = c.map(|v| [v[0] as i64, v[1] as i64, v[3] as i64]);
    let mut determinant = 0;
    for (i, (j, k)) in [(1, 2), (2, 0), (0, 1)].into_iter().enumerate() {
        determinant = add_product(determinant, b[j] * c[k], a[i]);
        determinant = add_product(determinant, -(c[j] * b[k]), a[i]);
    }
    facing(-(determinant.signum() as i64))
}

/// Whether a bounding sphere lies wholly outside one of the view volume's planes.
pub fn sphere_outside(m: &ClipMatrix, sphere: &Sphere) -> bool {
    let centre = m.apply_one(sphere.centre);
    // Each plane is `row . p >= 0` with row = w + x, w - x, w + y, w - y, z, w - z; those that most often decide first.
    [(2, 1, 0), (0, 1, 1), (0, -1, 1), (1, 1, 1), (1, -1, 1), (2, -1, 1)]
        .iter()
        .any(|&(i, a, b)| Plane::new(m, &centre, sphere.radius, i, a, b).outside())
}

/// The plane `a row_i + b row_w >= 0` of a clip matrix, as a sphere sees it; clip units.
struct Plane {
    at_centre: i64,
    /// How much the sphere's points may differ from its centre, and rounding.
    reach: i64,
}

impl Plane {
    #[inline(never)]
    fn new(m: &ClipMatrix, centre: &[i32; 4], radius: u16, i: usize, a: i64, b: i64) -> Plane {
        let at_centre = a * centre[i] as i64 + b * centre[3] as i64;
        Plane { at_centre, reach: ((row_length(m, i, a, b) * radius as i64) >> 15) + 4 }
    }

    /// All of the sphere is outside.
    fn outside(&self) -> bool {
        self.at_centre + self.reach < 0
    }

    /// All of the sphere is inside.
    fn inside(&self) -> bool {
        self.at_centre > self.reach
    }
}

/// Length of the first three of `a row_i + b row_w`, rounded up; |a| + |b| at most 3.
fn row_length(m: &ClipMatrix, i: usize, a: i64, b: i64) -> i64 {
    // Components below 2^32, halved three times to fit.
    let squares: u64 = (0..3)
        .map(|k| a * m.m[i][k] as i64 + b * m.m[3][k] as i64)
        .map(|v| ((v.unsigned_abs() >> 3) + 1).pow(2))
        .sum();
    (crate::math::isqrt64(squares) as i64 + 1) << 3
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Mat4;

    #[test]
    fn determinant_and_area_agree() {
        // A triangle counter-clockwise in front of the camera, y up.
        let c = [[-10, -10, 5, 10], [10, -10, 5, 10], [0, 10, 5, 10]];
        assert_eq!(facing_in_clip_space(&c), Facing::Front);
        assert_eq!(facing_in_clip_space(&[c[0], c[2], c[1]]), Facing::Back);
        assert_eq!(facing_in_clip_space(&[c[0], c[1], c[1]]), Facing::Edge);
        let viewport = crate::transform::Viewport::new(64, 64);
        let v = c.map(|c| viewport.project(&c)).map(|v| [v.x, v.y]);
        assert_eq!(facing(crate::setup::signed_area(&v)), Facing::Front);
    }

    #[test]
    fn a_visible_sphere_is_never_culled() {
        let mut seed = 3u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 40) as f64 / (1u64 << 23) as f64 - 1.0
        };
        let (mut culled, mut kept) = (0, 0);
        for _ in 0..3000 {
            let mut m = [[0f64; 4]; 4];
            for v in m.iter_mut().flatten() {
                *v = random();
            }
            (m[0][3], m[1][3], m[2][3], m[3][3]) = (random() * 4.0, random() * 4.0, 1.0, 2.0);
            let matrix = ClipMatrix::new(&Mat4::from_f64(m));
            let sphere = Sphere { centre: [0; 3], radius: 8000 };
            if !sphere_outside(&matrix, &sphere) {
                kept += 1;
                continue;
            }
            culled += 1;
            for _ in 0..100 {
                let p = [random(), random(), random()];
                let length = p.iter().map(|v| v * v).sum::<f64>();
                if length > 1.0 {
                    continue;
                }
                let c = matrix.apply(p.map(|v| (v * 8000.0) as i16));
                let visible = c[0].abs() <= c[3] && c[1].abs() <= c[3] && c[2] >= 0 && c[2] <= c[3];
                assert!(!visible, "{c:?}");
            }
        }
        assert!(culled > 500 && kept > 500, "{culled} {kept}");
    }
}
