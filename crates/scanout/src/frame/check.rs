//! What must hold of a scene before it is prepared.

use super::{MAX_SIDE, PrepareError, Settings};
use crate::features;
use crate::light::{MAX_LIGHTS, plainly_lit};
use crate::mesh::{Cluster, Normals};
use crate::scene::{Background, Light, Mode, Scene};
use crate::texture::{Repeat565, RepeatPalette, Texture};

/// Checks everything that drawing relies on, so that drawing cannot fail.
pub(super) fn check(scene: &Scene, settings: &Settings) -> Result<(), PrepareError> {
    let (width, height) = (settings.width, settings.height);
    if width == 0 || height == 0 || width > MAX_SIDE || height > MAX_SIDE {
        return Err(PrepareError::Size { width, height });
    }
    if scene.lights.len() > MAX_LIGHTS {
        return Err(PrepareError::Lights(scene.lights.len()));
    }
    if scene.objects.len() > 1 << 16 {
        return Err(PrepareError::Objects(scene.objects.len()));
    }
    if let Background::Image(pixels) = scene.background {
        let needed = width as usize * height as usize;
        if pixels.len() != needed {
            return Err(PrepareError::Background { needed, given: pixels.len() });
        }
    }
    for (index, object) in scene.objects.iter().enumerate() {
        let mesh = object.mesh;
        let parallel = |len: usize, with: usize| len == 0 || len == with;
        let normals_fit = match mesh.normals {
            Normals::None => true,
            Normals::Vertex(n) => n.len() == mesh.positions.len(),
            Normals::Face(n) => n.len() == mesh.triangles.len(),
        };
        if !normals_fit
            || !parallel(mesh.colours.len(), mesh.positions.len())
            || !parallel(mesh.uv_triangles.len(), mesh.triangles.len())
            || !parallel(mesh.clusters.len(), mesh.triangles.len().div_ceil(Cluster::TRIANGLES))
        {
            return Err(PrepareError::Lengths { object: index });
        }
        // The greatest first, which is quick; then, where that is too great, whose it is.
        let most = mesh.uv_triangles.as_flattened().iter().fold(0, |most, &t| t.max(most));
        if most as usize >= mesh.uvs.len() && !mesh.uv_triangles.is_empty() {
            let beyond = |uvs: &[u16; 3]| uvs.iter().any(|&t| t as usize >= mesh.uvs.len());
            let element = mesh.uv_triangles.iter().position(beyond).unwrap_or(0);
            return Err(PrepareError::Index { object: index, element });
        }
        if let Some(texture) = object.material.texture {
            texture.check().map_err(|error| PrepareError::Texture { object: index, error })?;
        }
    }
    compiled_in(scene, settings)
}

/// Checks that nothing is asked for that the features leave out.
fn compiled_in(scene: &Scene, settings: &Settings) -> Result<(), PrepareError> {
    let refuse = |object, feature| Err(PrepareError::Feature { object, feature });
    if !features::DITHER && settings.dither {
        return refuse(None, "dither");
    }
    if !features::FOG && scene.fog.is_some() {
        return refuse(None, "fog");
    }
    if !features::BACKGROUND_IMAGES && matches!(scene.background, Background::Image(_)) {
        return refuse(None, "background-images");
    }
    if !features::ALL_LIGHTS && !scene.lights.iter().all(Light::is_plain) {
        return refuse(None, "all-lights");
    }
    for (index, object) in scene.objects.iter().enumerate() {
        let mode = match object.mode {
            Mode::Points if !features::POINTS => Some("points"),
            Mode::Wire | Mode::Hidden if !features::LINES => Some("lines"),
            Mode::Wire | Mode::Hidden if !features::SMOOTH_LINES && object.smooth_lines => {
                Some("smooth-lines")
            }
            Mode::Gouraud if !features::GOURAUD => Some("gouraud"),
            Mode::Phong if !features::PHONG => Some("phong"),
            _ => None,
        };
        let filled = matches!(object.mode, Mode::Flat | Mode::Gouraud | Mode::Phong);
        let (material, mesh) = (object.material, object.mesh);
        let feature = mode.or(if !features::TWO_SIDED && material.two_sided {
            Some("two-sided")
        } else if !features::VERTEX_COLOURS && !mesh.colours.is_empty() {
            Some("vertex-colours")
        } else if !features::ALL_LIGHTS && filled && !plainly_lit(scene, object) {
            Some("all-lights")
        } else if filled && !mesh.uv_triangles.is_empty() {
            material.texture.and_then(left_out)
        } else {
            None
        });
        if let Some(feature) = feature {
            return refuse(Some(index), feature);
        }
    }
    Ok(())
}

/// The feature that a texture needs and that is not there.
fn left_out(texture: &Texture) -> Option<&'static str> {
    if features::ALL_TEXTURES || Repeat565::new(texture).is_some() {
        return None;
    }
    match RepeatPalette::new(texture) {
        Some(_) if features::PALETTE_TEXTURES => None,
        Some(_) => Some("palette-textures"),
        None => Some("all-textures"),
    }
}
