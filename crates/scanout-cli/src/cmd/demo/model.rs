//! The models that travel inside the program, so that the demonstration needs no file.

use scanout::texture::Wrap;
use scanout_assets::{Format, Image, LoadOptions, Model};

use crate::error::{Error, Result};

/// The Earth with its texture (NASA's Blue Marble).
pub fn earth() -> Result<Model> {
    let picture = include_bytes!("../../../../../models/earth.jpg");
    let failed = |error: scanout_assets::LoadError| Error::Failed(error.to_string());
    let mut model = read(include_bytes!("../../../../../models/earth.obj"), "earth")?;
    model.images = vec![Image::decode(picture, "earth.jpg").map_err(failed)?.0];
    for part in &mut model.parts {
        part.material.texture = Some(0);
        part.material.wrap = [Wrap::Clamp; 2];
        part.material.colour = [255; 3];
        (part.material.ambient, part.material.diffuse) = (0.2, 0.8);
    }
    Ok(model)
}

/// Martin Newell's teapot.
pub fn teapot() -> Result<Model> {
    let mut model = read(include_bytes!("../../../../../models/teapot.obj"), "teapot")?;
    for part in &mut model.parts {
        part.material.colour = [222, 226, 232];
        (part.material.ambient, part.material.diffuse) = (0.15, 0.6);
        (part.material.specular, part.material.shininess) = (0.25, 60);
    }
    Ok(model)
}

/// The file's materials are not inside, so the loader's warnings about them are no news.
fn read(bytes: &[u8], name: &str) -> Result<Model> {
    let options = LoadOptions::default();
    scanout_assets::load_bytes(bytes, Some(Format::Obj), name, None, &options)
        .map_err(|error| Error::Failed(error.to_string()))
}

#[cfg(test)]
mod tests {
    use super::LoadOptions;

    #[test]
    fn both_load() {
        assert!(!super::earth().unwrap().parts[0].mesh.uvs.is_empty());
        // The poles would take texels of the opposite edge.
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models/earth.obj");
        let file =
            scanout_assets::load(std::path::Path::new(file), &LoadOptions::default()).unwrap();
        let inside = super::earth().unwrap();
        assert_eq!(inside.parts[0].material.wrap, file.parts[0].material.wrap);
        assert_eq!(super::teapot().unwrap().stats.triangles, 992);
    }
}
