//! A stage before a camera that something else has placed: models where a matrix puts them, over a picture.

use scanout::camera::Camera;
use scanout::math::Mat4;
use scanout::scene::{Background, Light, LightKind, Object, Scene};

use super::{Stage, direction};
use crate::error::Result;

/// Three rows of an affine matrix.
pub type Affine = [[f64; 4]; 3];

/// `a` after `b`.
pub fn compose(a: &Affine, b: &Affine) -> Affine {
    std::array::from_fn(|i| {
        std::array::from_fn(|k| {
            let moved = if k == 3 { a[i][3] } else { 0.0 };
            (0..3).map(|j| a[i][j] * b[j][k]).sum::<f64>() + moved
        })
    })
}

/// An affine matrix as the pipeline takes it.
pub fn matrix(a: &Affine) -> Mat4 {
    Mat4::from_f64([a[0], a[1], a[2], [0.0, 0.0, 0.0, 1.0]])
}

impl Stage {
    /// Draws the models with `to_world` taking the file's coordinates to the pipeline's world, behind `others`, over `background`. The
    /// camera stands at the world's origin and looks along -z; light falls over its left shoulder.
    pub fn with_scene_at<R>(
        &self,
        camera: Camera,
        to_world: &Affine,
        others: &[Object],
        background: &[[u8; 3]],
        draw: impl FnOnce(&Scene) -> Result<R>,
    ) -> Result<R> {
        let textures = self.textures();
        let materials = self.materials(&textures);
        let meshes: Vec<Vec<_>> = self
            .models
            .iter()
            .map(|model| model.parts.iter().map(|part| part.mesh.as_mesh()).collect())
            .collect();
        let mut objects = others.to_vec();
        for ((model, meshes), materials) in self.models.iter().zip(&meshes).zip(&materials) {
            let (scale, [x, y, z]) = (model.placement.scale, model.placement.offset);
            let place = [[scale, 0.0, 0.0, x], [0.0, scale, 0.0, y], [0.0, 0.0, scale, z]];
            let transform = matrix(&compose(to_world, &place));
            for (mesh, material) in meshes.iter().zip(materials) {
                objects.push(Object {
                    transform,
                    smooth_lines: self.surface.smooth_lines,
                    ..Object::new(mesh, material, self.pipeline_mode(mesh))
                });
            }
        }
        let light = |towards, strength| Light {
            kind: LightKind::Directional(direction(towards)),
            colour: [strength; 3],
        };
        let lights = [light([-0.4, 0.6, 0.7], 255), light([0.8, 0.0, 0.5], 72)];
        let scene = Scene {
            lights: &lights,
            background: Background::Image(background),
            ..Scene::new(camera, &objects)
        };
        draw(&scene)
    }
}
