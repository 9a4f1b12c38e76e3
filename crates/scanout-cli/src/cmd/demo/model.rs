//! The model that travels inside the program, so that the demonstration needs no file.

use std::fmt::Write as _;

use scanout_assets::{Format, Image, LoadOptions, Model};

use crate::error::{Error, Result};
use crate::scene_builder::vector::sin_cos;

/// The model and its name.
pub fn load() -> Result<(Model, &'static str)> {
    let options = LoadOptions::default();
    let model =
        scanout_assets::load_bytes(torus().as_bytes(), Some(Format::Obj), "torus", None, &options);
    let mut model = model.map_err(|error| Error::Failed(error.to_string()))?;
    model.images = vec![checks()];
    for part in &mut model.parts {
        part.material.texture = Some(0);
        part.material.colour = [255; 3];
        (part.material.ambient, part.material.diffuse) = (0.15, 0.65);
        (part.material.specular, part.material.shininess) = (0.2, 32);
    }
    Ok((model, "torus"))
}

/// A torus of 48 x 24 quads as OBJ.
fn torus() -> String {
    const AROUND: i32 = 48;
    const ACROSS: i32 = 24;
    let mut text = String::new();
    for i in 0..=AROUND {
        for j in 0..=ACROSS {
            let (sin, cos) = sin_cos(f64::from(i % AROUND) * 360.0 / f64::from(AROUND));
            let (s, c) = sin_cos(f64::from(j % ACROSS) * 360.0 / f64::from(ACROSS));
            let r = 1.0 + 0.42 * c;
            let _ = writeln!(text, "v {} {} {}", r * sin, 0.42 * s, r * cos);
            let _ = writeln!(text, "vn {} {} {}", c * sin, s, c * cos);
            let _ = writeln!(text, "vt {} {}", f64::from(i) / 4.0, f64::from(j) / 12.0);
        }
    }
    let at = |i: i32, j: i32| {
        let position = (i % AROUND) * (ACROSS + 1) + j % ACROSS + 1;
        format!("{position}/{}/{position}", i * (ACROSS + 1) + j + 1)
    };
    for i in 0..AROUND {
        for j in 0..ACROSS {
            let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            let _ = writeln!(text, "f {}", corners.join(" "));
        }
    }
    text
}

/// A checkerboard with a gradient.
fn checks() -> Image {
    let texel = |x: u16, y: u16| match (x / 16 + y / 16) % 2 {
        0 => [230, 150 + (y * 2) as u8 / 2, 60],
        _ => [30, 90, 150 + x as u8],
    };
    let rgb = (0..64).flat_map(|y| (0..64).map(move |x| texel(x, y))).collect();
    Image { name: "checks".into(), width: 64, height: 64, levels: 1, rgb }
}
