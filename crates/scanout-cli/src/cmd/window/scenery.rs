//! What is behind the glass: system C's room, and in it C's cube or the user's model. Millimetres along the screen's own axes.

use std::fmt::Write as _;

use scanout_assets::{Format, LoadOptions, Model};
use scanout_head::room;

use crate::args::WindowArgs;
use crate::error::{Error, Result};
use crate::scene_builder::load_model;

/// Colours of the room's lines, and of the cube's front, back and other sides (C has three).
const LINES: [u8; 3] = [96, 112, 136];
const SIDES: [(&str, [u8; 3]); 3] =
    [("front", [240, 240, 240]), ("back", [230, 90, 70]), ("sides", [70, 150, 230])];

/// The models of a screen of this size.
pub fn models(args: &WindowArgs, size: [f64; 2]) -> Result<Vec<Model>> {
    let [low, high] = room::cube(size[1]);
    let mut models = Vec::new();
    if !args.no_room {
        models.push(read("room", &room_text(size))?);
    }
    let depth = args.depth.unwrap_or((low[2] + high[2]) / 2.0);
    let largest = args.size.unwrap_or(high[0] - low[0]);
    let mut model = match &args.model {
        Some(path) => load_model(path, args.input_format)?,
        None => read("cube", &cube_text())?,
    };
    let [least, most] = model.bounds();
    let side = (0..3).map(|i| most[i] - least[i]).fold(0.0, f64::max);
    let factor = if side > 0.0 { largest / side } else { 1.0 };
    let middle = [0.0, 0.0, depth];
    let placement = &mut model.placement;
    placement.offset = std::array::from_fn(|i| {
        middle[i] + (placement.offset[i] - (least[i] + most[i]) / 2.0) * factor
    });
    placement.scale *= factor;
    models.push(model);
    Ok(models)
}

/// The readers know shapes as OBJ; nothing here has a material file, so their warnings are no news.
fn read(name: &str, text: &str) -> Result<Model> {
    let loaded = scanout_assets::load_bytes(
        text.as_bytes(),
        Some(Format::Obj),
        name,
        None,
        &LoadOptions::default(),
    );
    let mut model = loaded.map_err(|error| Error::Failed(error.to_string()))?;
    for part in &mut model.parts {
        let own = SIDES.iter().find(|(name, _)| part.material.name == *name);
        part.material.colour = own.map_or(LINES, |(_, colour)| *colour);
        (part.material.ambient, part.material.diffuse) = (0.35, 0.65);
    }
    Ok(model)
}

fn room_text(size: [f64; 2]) -> String {
    let (mut points, mut lines) = (String::new(), String::new());
    room::walls(
        size,
        |[x, y, z]| _ = writeln!(points, "v {x} {y} {z}"),
        |[a, b]| _ = writeln!(lines, "l {} {}", a + 1, b + 1),
    );
    points + &lines
}

/// A cube whose corners are numbered by the bits x, y, z, from 1.
fn cube_text() -> String {
    let mut text = String::new();
    for corner in 0..8 {
        let _ = writeln!(text, "v {} {} {}", corner & 1, corner >> 1 & 1, corner >> 2);
    }
    text + "usemtl front\nf 5 6 8 7\nusemtl back\nf 2 1 3 4\nusemtl sides\n\
            f 1 5 7 3\nf 6 2 4 8\nf 7 8 4 3\nf 1 2 6 5\n"
}
