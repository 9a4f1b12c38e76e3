//! Light: ambient, diffuse and specular reflection (Phong 1975; system B's equations 3 to 5).
//!
//! ```text
//! I   = max(floor, KA + sum over lights c (KD max(0, N.L) + KE max(0, R.V)^n))      at most 1
//! R.V = 2 (N.L)(N.V) - L.V                        counts only where N.L > 0
//! rgb = floor(rgb I + 1/2)
//! ```
//!
//! | value | format |
//! |---|---|
//! | N, L, V | Q2.14 |
//! | dot products, powers | Q2.14, floor |
//! | KD c, KE c, I | Q.14 (1.0 = 16384) |
//! | colour | U8.0, rounded to nearest |
//!
//! Where the object's transform keeps angles (rotation, one scale for all axes, translation), lights and viewer are brought into
//! the object's own coordinates once, and normals and positions are used as they lie in the mesh: three
//! multiplications a light. Otherwise normals go through the inverse transpose and positions through the transform, and light is
//! computed in the world. What it will not do: shadows, attenuation with distance.

use crate::camera::Viewpoint;
use crate::features;
use crate::math::{Mat4, Q16, Vec3, normalise, normalise_q14};
use crate::scene::{Light, LightKind, Material, Object, Scene};

/// The most lights a scene may have.
pub const MAX_LIGHTS: usize = 8;

/// 1.0 in the format of intensities.
pub const ONE: i32 = 1 << 14;

/// A direction, or a point to take the direction to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Towards {
    Direction([i32; 3]),
    Point([i32; 3]),
}

impl Towards {
    #[inline(always)]
    fn from(&self, p: [i32; 3]) -> [i32; 3] {
        match *self {
            Towards::Direction(d) => d,
            Towards::Point(to) => normalise_q14([0, 1, 2].map(|i| to[i].saturating_sub(p[i]))),
        }
    }
}

#[derive(Clone, Copy, Debug)]
struct Lamp {
    towards: Towards,
    diffuse: [i32; 3],
    specular: [i32; 3],
}

/// Where lighting happens.
#[derive(Clone, Copy, Debug)]
enum Space {
    /// In the mesh's own coordinates.
    Object,
    /// In the world: inverse transpose for normals (16-bit entries, any scale), transform for positions (to Q16.16).
    World { normal: [[i32; 3]; 3], position: Mat4 },
}

/// The lights of a scene as one object sees them.
#[derive(Clone, Copy, Debug)]
pub struct Lighting {
    lamps: [Lamp; MAX_LIGHTS],
    count: usize,
    viewer: Towards,
    ambient: i32,
    floor: i32,
    shininess: u16,
    shines: bool,
    near: bool,
    /// Only diffuse white light from afar: one sum serves all channels.
    plain: bool,
    space: Space,
}

/// Diffuse white light from afar, for many normals; all Q.14.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlainLight {
    /// Where light comes from, each coordinate in [-1, 1], and its weight in [0, 1]; the first `count`.
    pub lamps: [([i32; 3], i32); MAX_LIGHTS],
    pub count: usize,
    pub ambient: i32,
    pub floor: i32,
}

impl PlainLight {
    /// As [`Lighting::lit_in_mesh`].
    #[inline(always)]
    pub fn lit(&self, rgb: [u8; 3], normal: [i16; 3]) -> [u8; 3] {
        let mut sum = self.ambient;
        for &(towards, weight) in &self.lamps[..self.count] {
            sum += (dot(normal.map(i32::from), towards).clamp(0, ONE) * weight) >> 14;
        }
        shaded(rgb, [sum.max(self.floor).min(ONE); 3])
    }
}

fn q14(v: Q16) -> i32 {
    v.0.clamp(0, 1 << 16) >> 2
}

fn saturate(v: i64) -> i32 {
    v.clamp(-(1 << 30), 1 << 30) as i32
}

fn dot(a: [i32; 3], b: [i32; 3]) -> i32 {
    (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) >> 14
}

/// Whether a transform keeps angles: columns of equal length at right angles, to one part in 512.
fn keeps_angles(m: &Mat4) -> bool {
    let rows = &m.m[..3];
    // All together have the bits of the largest.
    let all = rows
        .iter()
        .fold(0, |all, r| all | r[0].unsigned_abs() | r[1].unsigned_abs() | r[2].unsigned_abs());
    let shift = (64 - all.leading_zeros()).saturating_sub(20);
    let length = columns(rows, 0, 0, shift);
    let tolerance = length >> 9;
    [(1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].iter().all(|&(i, j)| {
        let wanted = if i == j { length } else { 0 };
        (columns(rows, i, j, shift) - wanted).abs() <= tolerance
    })
}

/// The inner product of two columns, their entries moved down.
#[inline(never)]
fn columns(rows: &[[i64; 4]], i: usize, j: usize, shift: u32) -> i64 {
    rows.iter().map(|row| (row[i] >> shift) * (row[j] >> shift)).sum()
}

/// Whether an object is lit so that the feature `all-lights` is not needed for it.
pub(crate) fn plainly_lit(scene: &Scene, object: &Object) -> bool {
    object.material.specular <= Q16::ZERO
        && (scene.lights.is_empty() || keeps_angles(&object.transform))
}

/// A direction through the linear part of a matrix, Q2.14; zero stays zero.
fn direction(m: &Mat4, d: Vec3) -> [i32; 3] {
    normalise(m.transform_direction(d)).map_or([0; 3], |d| d.map(|v| (v + (1 << 15)) >> 16))
}

/// The inverse transpose of a matrix, scaled so that its largest entry has 15 bits.
fn inverse_transpose(inverse: &Mat4) -> [[i32; 3]; 3] {
    let entries = |i: usize, j: usize| inverse.m[j][i];
    let largest =
        (0..9).map(|k| entries(k / 3, k % 3).unsigned_abs()).max().unwrap_or(0).leading_zeros();
    let shift = 49 - largest as i32;
    core::array::from_fn(|i| {
        core::array::from_fn(|j| {
            let v = entries(i, j);
            (if shift >= 0 { v >> shift } else { v << -shift }) as i32
        })
    })
}

impl Lighting {
    /// Prepares the lights for one object. More than [`MAX_LIGHTS`] lights are refused by the frame; here the rest
    /// is not looked at. A transform that has no inverse leaves ambient light only. Without the feature `all-lights` only white
    /// light from afar on objects whose transform keeps angles is looked at; the frame refuses others.
    pub fn new(
        lights: &[Light],
        floor: Q16,
        viewpoint: &Viewpoint,
        material: &Material,
        transform: &Mat4,
    ) -> Lighting {
        let inverse = transform.inverse_affine();
        let (space, to_space, bits) = match inverse {
            // Object coordinates are Q1.15 of the object's unit.
            Some(inverse) if !features::ALL_LIGHTS || keeps_angles(transform) => {
                (Space::Object, inverse, 17)
            }
            // Ambient light only, below.
            None if !features::ALL_LIGHTS => (Space::Object, Mat4::IDENTITY, 17),
            Some(inverse) => {
                let normal = inverse_transpose(&inverse);
                (Space::World { normal, position: *transform }, Mat4::IDENTITY, 16)
            }
            None => {
                (Space::World { normal: [[0; 3]; 3], position: *transform }, Mat4::IDENTITY, 16)
            }
        };
        let point = |p: Vec3| {
            let [x, y, z, _] = to_space.transform_point(p);
            Towards::Point([x, y, z].map(|v| saturate(v >> bits)))
        };
        let ray = |d: Vec3| Towards::Direction(direction(&to_space, d));
        let (diffuse, specular) = (q14(material.diffuse), q14(material.specular));
        let weight = |k: i32, c: [u8; 3]| c.map(|c| (k * c as i32 + 127) / 255);
        let none = Lamp { towards: Towards::Direction([0; 3]), diffuse: [0; 3], specular: [0; 3] };
        let mut lamps = [none; MAX_LIGHTS];
        for (lamp, light) in lamps.iter_mut().zip(lights) {
            *lamp = Lamp {
                towards: match light.kind {
                    LightKind::Directional(d) => ray(d),
                    LightKind::Point(p) if features::ALL_LIGHTS => point(p),
                    LightKind::Point(_) => none.towards,
                },
                diffuse: weight(diffuse, light.colour),
                specular: weight(specular, light.colour),
            };
        }
        let near = features::ALL_LIGHTS
            && (specular > 0 || lights.iter().any(|l| matches!(l.kind, LightKind::Point(_))));
        Lighting {
            lamps,
            count: if features::ALL_LIGHTS || inverse.is_some() {
                lights.len().min(MAX_LIGHTS)
            } else {
                0
            },
            viewer: match *viewpoint {
                _ if !features::ALL_LIGHTS => none.towards,
                Viewpoint::Point(p) => point(p),
                Viewpoint::Direction(d) => ray(d),
            },
            ambient: q14(material.ambient),
            floor: q14(floor),
            shininess: material.shininess.max(1),
            shines: features::ALL_LIGHTS && specular > 0,
            near,
            plain: !features::ALL_LIGHTS
                || !near && lights.iter().all(|l| l.colour == [l.colour[0]; 3]),
            space,
        }
    }

    /// The light, where it is white, from afar, and computed in the mesh's own coordinates.
    pub(crate) fn plain(&self) -> Option<PlainLight> {
        let lamp = |lamp: Lamp| match lamp.towards {
            Towards::Direction(d) => (d, lamp.diffuse[0]),
            Towards::Point(_) => ([0; 3], 0),
        };
        (self.plain && matches!(self.space, Space::Object)).then(|| PlainLight {
            lamps: self.lamps.map(lamp),
            count: self.count,
            ambient: self.ambient,
            floor: self.floor,
        })
    }

    /// Whether light depends on where it falls: there are point lights or there is a shine.
    pub fn needs_position(&self) -> bool {
        self.near
    }

    /// A mesh normal and position in the space where lighting happens, the normal of unit length (Q2.14).
    #[inline]
    pub fn local(&self, normal: [i16; 3], position: [i16; 3]) -> ([i32; 3], [i32; 3]) {
        match &self.space {
            _ if !features::ALL_LIGHTS => (normal.map(i32::from), position.map(i32::from)),
            Space::Object => (normal.map(i32::from), position.map(i32::from)),
            Space::World { normal: m, position: transform } => {
                let n = normal.map(i32::from);
                let n = m.map(|row| {
                    ((row[0] * n[0]) >> 2) + ((row[1] * n[1]) >> 2) + ((row[2] * n[2]) >> 2)
                });
                let p = position.map(i64::from);
                let p = [0, 1, 2].map(|i| {
                    let row = &transform.m[i];
                    let sum: i128 = (0..3).map(|k| row[k] as i128 * p[k] as i128).sum();
                    saturate(((sum >> 31) as i64).saturating_add(row[3] >> 16))
                });
                (normalise_q14(n), p)
            }
        }
    }

    /// Intensity of each channel, Q.14 in [floor, 1], at a point with a unit normal, both from
    /// [`local`](Self::local).
    #[inline]
    pub fn intensity(&self, n: [i32; 3], p: [i32; 3]) -> [i32; 3] {
        let mut sum = [self.ambient; 3];
        let v = if self.shines { self.viewer.from(p) } else { [0; 3] };
        for lamp in &self.lamps[..self.count] {
            let l = lamp.towards.from(p);
            let n_l = dot(n, l).min(ONE);
            if n_l <= 0 {
                continue;
            }
            for (sum, k) in sum.iter_mut().zip(lamp.diffuse) {
                *sum += (n_l * k) >> 14;
            }
            if self.shines {
                let r_v = (((2 * n_l * dot(n, v)) >> 14) - dot(l, v)).clamp(0, ONE);
                let shine = power(r_v, self.shininess);
                for (sum, k) in sum.iter_mut().zip(lamp.specular) {
                    *sum += (shine * k) >> 14;
                }
            }
        }
        sum.map(|i| i.clamp(self.floor, ONE))
    }

    /// The same where light is [`plain`](Self::plain).
    #[inline(always)]
    fn plain_intensity(&self, n: [i32; 3]) -> i32 {
        let mut sum = self.ambient;
        for lamp in &self.lamps[..self.count] {
            if let Towards::Direction(l) = lamp.towards {
                sum += (dot(n, l).clamp(0, ONE) * lamp.diffuse[0]) >> 14;
            }
        }
        sum.clamp(self.floor, ONE)
    }

    /// [`local`](Self::local) and [`lit`](Self::lit): a surface colour at a mesh's normal and position.
    #[inline(always)]
    pub fn lit_in_mesh(&self, rgb: [u8; 3], normal: [i16; 3], position: [i16; 3]) -> [u8; 3] {
        if !features::ALL_LIGHTS || (self.plain && matches!(self.space, Space::Object)) {
            shaded(rgb, [self.plain_intensity(normal.map(i32::from)); 3])
        } else {
            self.lit_anywhere(rgb, normal, position)
        }
    }

    #[inline(never)]
    fn lit_anywhere(&self, rgb: [u8; 3], normal: [i16; 3], position: [i16; 3]) -> [u8; 3] {
        let (n, p) = self.local(normal, position);
        self.lit(rgb, n, p)
    }

    /// A surface colour under the lights.
    #[inline]
    pub fn lit(&self, rgb: [u8; 3], n: [i32; 3], p: [i32; 3]) -> [u8; 3] {
        let intensity = if !features::ALL_LIGHTS || self.plain {
            [self.plain_intensity(n); 3]
        } else {
            self.intensity(n, p)
        };
        shaded(rgb, intensity)
    }
}

/// A colour times intensities, to nearest.
#[inline(always)]
fn shaded(rgb: [u8; 3], intensity: [i32; 3]) -> [u8; 3] {
    core::array::from_fn(|i| ((rgb[i] as i32 * intensity[i] + ONE / 2) >> 14) as u8)
}

/// `x^n` for x in [0, 1] (Q.14), by squaring in Q.30, floor; error below 2^-12 for n up to 1024.
fn power(x: i32, n: u16) -> i32 {
    let (mut base, mut result, mut n) = ((x as u64) << 16, 1u64 << 30, n);
    while n > 0 {
        if n & 1 == 1 {
            result = (result * base) >> 30;
        }
        base = (base * base) >> 30;
        n >>= 1;
    }
    (result >> 16) as i32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Angle, Quat};

    const WHITE: Light = Light { kind: LightKind::Directional(Vec3::ZERO), colour: [255; 3] };

    fn material(ka: f64, kd: f64, ke: f64, n: u16) -> Material<'static> {
        Material {
            colour: [255; 3],
            ambient: Q16::from_f64(ka),
            diffuse: Q16::from_f64(kd),
            specular: Q16::from_f64(ke),
            shininess: n,
            texture: None,
            two_sided: false,
        }
    }

    struct Random(u64);
    impl Random {
        fn unit(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
        }
        fn vector(&mut self, size: f64) -> [f64; 3] {
            [(); 3].map(|()| self.unit() * size)
        }
    }

    fn length(v: [f64; 3]) -> f64 {
        v.iter().map(|v| v * v).sum::<f64>().sqrt()
    }
    fn unit(v: [f64; 3]) -> [f64; 3] {
        let l = length(v);
        v.map(|x| x / l)
    }
    fn real_dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    /// B's equations 3 to 5 in real numbers, in the world.
    #[test]
    #[cfg_attr(not(feature = "all-lights"), ignore = "the feature all-lights is left out")]
    fn equations_3_to_5_of_system_b() {
        let mut random = Random(1);
        let mut worst = 0f64;
        for case in 0..4000 {
            let axis = Vec3::from_f64(random.vector(1.0));
            let Some(q) = Quat::from_axis_angle(axis, Angle(random.unit().to_bits() as u32)) else {
                continue;
            };
            let scale = if case % 2 == 0 { [1.5; 3] } else { [1.5, 0.75, 1.0] };
            let transform = Mat4::translation(Vec3::from_f64(random.vector(3.0)))
                .mul(&q.to_mat4())
                .mul(&Mat4::scaling(Vec3::from_f64(scale)));
            let (normal, position) = (unit(random.vector(1.0)), random.vector(0.9));
            let at = random.vector(10.0);
            let eye = random.vector(10.0);
            let (light, towards) = if case % 3 == 0 {
                (LightKind::Directional(Vec3::from_f64(at)), Some(at))
            } else {
                (LightKind::Point(Vec3::from_f64(at)), None)
            };
            let n_exponent = [1, 8, 32][case % 3];
            let m = material(0.1, 0.5, 0.4, n_exponent);
            let lighting = Lighting::new(
                &[Light { kind: light, ..WHITE }],
                Q16(0),
                &Viewpoint::Point(Vec3::from_f64(eye)),
                &m,
                &transform,
            );
            assert_eq!(matches!(lighting.space, Space::Object), case % 2 == 0);
            let n = normal.map(|v| (v * 16384.0).round() as i16);
            let p = position.map(|v| (v * 32768.0).round() as i16);
            let (n, p) = lighting.local(n, p);
            let got = lighting.intensity(n, p)[0] as f64 / 16384.0;

            let t = transform.to_f64();
            let world =
                [0, 1, 2].map(|i| (0..3).map(|k| t[i][k] * position[k]).sum::<f64>() + t[i][3]);
            // The inverse transpose of rotation x scale is rotation x 1/scale.
            let r = q.to_mat4().to_f64();
            let big_n =
                unit([0, 1, 2].map(|i| (0..3).map(|k| r[i][k] * normal[k] / scale[k]).sum()));
            let l = unit(towards.unwrap_or([0, 1, 2].map(|i| at[i] - world[i])));
            let v = unit([0, 1, 2].map(|i| eye[i] - world[i]));
            let n_l = real_dot(big_n, l);
            let mut exact = 0.1;
            if n_l > 0.0 {
                let r_v = 2.0 * n_l * real_dot(big_n, v) - real_dot(l, v);
                exact += 0.5 * n_l + 0.4 * r_v.max(0.0).powi(n_exponent as i32);
            }
            worst = worst.max((got - exact.min(1.0)).abs());
        }
        assert!(worst < 1.5 / 255.0, "off by {} levels", worst * 255.0);
    }

    #[test]
    #[cfg_attr(not(feature = "all-lights"), ignore = "the feature all-lights is left out")]
    fn the_floor_holds_and_colours_count() {
        let red = Light {
            kind: LightKind::Directional(Vec3::from_f64([0.0, 0.0, 2.0])),
            colour: [255, 0, 51],
        };
        let view = Viewpoint::Direction(Vec3::from_f64([0.0, 0.0, 1.0]));
        let m = material(0.0, 1.0, 0.0, 1);
        let lighting = Lighting::new(&[red], Q16::from_f64(0.2), &view, &m, &Mat4::IDENTITY);
        assert_eq!(lighting.lit([255; 3], [0, 0, ONE], [0; 3]), [255, 51, 51]);
        assert_eq!(lighting.lit([255; 3], [0, 0, -ONE], [0; 3]), [51; 3]);
    }

    /// The short way for white light from afar is the long one.
    #[test]
    fn plain_light_is_light() {
        let mut random = Random(3);
        for count in 0..=MAX_LIGHTS {
            let lights: [Light; MAX_LIGHTS] = core::array::from_fn(|i| Light {
                kind: LightKind::Directional(Vec3::from_f64(random.vector(1.0))),
                colour: [(40 * i) as u8; 3],
            });
            let view = Viewpoint::Direction(Vec3::Z);
            let m = material(0.1, 0.4, 0.0, 1);
            let lighting =
                Lighting::new(&lights[..count], Q16::from_f64(0.15), &view, &m, &Mat4::IDENTITY);
            assert!(lighting.plain);
            for _ in 0..500 {
                let n = unit(random.vector(1.0)).map(|v| (v * 16384.0).round() as i32);
                assert_eq!([lighting.plain_intensity(n); 3], lighting.intensity(n, [0; 3]));
            }
        }
    }

    #[test]
    fn powers() {
        for x in (0..=16384).step_by(97) {
            for n in [1u16, 2, 3, 10, 100, 1024] {
                let exact = (x as f64 / 16384.0).powi(n as i32);
                assert!((power(x, n) as f64 / 16384.0 - exact).abs() < 1.0 / 4096.0, "{x}^{n}");
            }
        }
        assert_eq!(power(ONE, 1024), ONE);
    }

    #[test]
    fn a_flat_transform_is_dark_and_does_not_fail() {
        let flat = Mat4::scaling(Vec3::from_f64([1.0, 0.0, 1.0]));
        let view = Viewpoint::Point(Vec3::from_f64([0.0, 0.0, 5.0]));
        let lighting = Lighting::new(&[WHITE], Q16(0), &view, &material(0.25, 0.5, 0.2, 8), &flat);
        let (n, p) = lighting.local([0, 16384, 0], [1, 2, 3]);
        assert_eq!(lighting.intensity(n, p), [ONE / 4; 3]);
    }
}
