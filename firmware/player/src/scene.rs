//! System B's scene: one model on a turntable, one light, a camera at the origin.
//!
//! | | value |
//! |---|---|
//! | frame | 320 x 240, RGB565 |
//! | camera | at the origin, looks along -z; focal factor 2, aspect 3/4, near 1, far 5 |
//! | model | scaled, turned about y, then moved by (0, -0.1, -3.5) |
//! | turn | 48 degrees and 4 more each frame, so 90 frames a turn |
//! | light | travels along (0, 1, -1); diffuse, never below 0.2 |
//! | faces | one brightness each, textured perspective-correct, seen from outside only |
//!
//! The angle is set afresh from the frame's number modulo 90, so it never drifts: frame n + 90 is frame n, bit for bit.

use scanout::camera::{Camera, Viewpoint, projection};
use scanout::math::{Angle, Mat4, Q16, Quat, Vec3};
use scanout::mesh::Mesh;
use scanout::scene::{Light, LightKind, Material, Mode, Object, Scene};
use scanout::texture::Texture;

/// Width of a frame in pixels.
pub const WIDTH: u16 = 320;
/// Height of a frame in pixels.
pub const HEIGHT: u16 = 240;
/// Frames in a full turn.
pub const TURN: u32 = 90;

/// Where a mesh's grid lies in its file's coordinates, Q32.32: file = position * scale + offset, position in [-1, 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placement {
    /// What a mesh position of 1.0 stands for.
    pub scale: i64,
    /// Where the grid's origin lies.
    pub offset: [i64; 3],
}

/// A model that can be shown.
#[derive(Clone, Copy, Debug)]
pub struct Model<'m> {
    /// Its mesh.
    pub mesh: Mesh<'m>,
    /// Its texture, if it has one.
    pub texture: Option<Texture<'m>>,
    /// Its place.
    pub placement: Placement,
}

/// The turntable's angle in a frame.
pub fn angle(frame: u32) -> Angle {
    Angle::from_ratio(48 + 4 * (frame % TURN) as i32, 360)
}

/// Object to world: the grid's place, then scale, rotation about y, translation.
#[inline(never)]
pub fn transform(placement: &Placement, scale: Q16, frame: u32) -> Mat4 {
    let mut grid = Mat4::IDENTITY;
    for axis in 0..3 {
        grid.m[axis][axis] = placement.scale;
        grid.m[axis][3] = placement.offset[axis];
    }
    // The y axis is no zero vector, so there is a rotation.
    let turn = Quat::from_axis_angle(Vec3::Y, angle(frame)).unwrap_or(Quat::IDENTITY);
    let place = Vec3::new(Q16::ZERO, Q16::from_ratio(-1, 10), Q16::from_ratio(-7, 2));
    Mat4::translation(place).mul(&Mat4::rotation(&turn)).mul(&Mat4::uniform_scale(scale)).mul(&grid)
}

const LENS: Mat4 = match projection::perspective_focal(
    Q16::from_int(2),
    Q16::from_ratio(3, 4),
    Q16::ONE,
    Q16::from_int(5),
) {
    Ok(lens) => lens,
    Err(_) => panic!("system B's lens is one"),
};

/// The camera.
pub const CAMERA: Camera =
    Camera { view: Mat4::IDENTITY, projection: LENS, viewpoint: Viewpoint::Point(Vec3::ZERO) };

/// The light; the pipeline wants the direction towards it.
pub const LIGHTS: [Light; 1] = [Light {
    kind: LightKind::Directional(Vec3::new(Q16::ZERO, Q16::from_int(-1), Q16::ONE)),
    colour: [255; 3],
}];

/// Makes the scene of a frame and gives it to `with`.
pub fn with_scene<R>(
    model: &Model<'_>,
    scale: Q16,
    frame: u32,
    with: impl FnOnce(&Scene<'_>) -> R,
) -> R {
    let material = Material {
        ambient: Q16::ZERO,
        diffuse: Q16::ONE,
        texture: model.texture.as_ref(),
        ..Material::default()
    };
    let mut object = Object::new(&model.mesh, &material, Mode::Flat);
    object.transform = transform(&model.placement, scale, frame);
    let objects = [object];
    let mut scene = Scene::new(CAMERA, &objects);
    scene.lights = &LIGHTS;
    scene.light_floor = Q16::from_ratio(1, 5);
    with(&scene)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_angles_do_not_drift() {
        let placement = Placement { scale: 1 << 32, offset: [0; 3] };
        let at = |frame| transform(&placement, Q16::ONE, frame);
        for frame in 0..TURN {
            for turns in [1, 2, 1_000, 40_000_000] {
                assert_eq!(at(frame), at(frame + turns * TURN), "frame {frame}, {turns} turns");
            }
        }
        assert_ne!(at(0), at(1));
    }

    #[test]
    fn the_first_frame_stands_at_48_degrees() {
        let placement = Placement { scale: 1 << 32, offset: [0; 3] };
        let m = transform(&placement, Q16::from_ratio(35, 100), 0).to_f64();
        let (sin, cos) = 48f64.to_radians().sin_cos();
        for (got, want) in
            [(m[0][0], 0.35 * cos), (m[0][2], 0.35 * sin), (m[1][3], -0.1), (m[2][3], -3.5)]
        {
            assert!((got - want).abs() < 1e-4, "{got} {want}");
        }
    }
}
