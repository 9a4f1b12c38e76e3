//! `scanout info`: what a model holds, and what it needs on a small machine.

use std::fmt::Write as _;
use std::io::{self, Write as _};

use clap::Parser;
use scanout_assets::{Model, NormalsBuf};
use serde_json::{Value, json};

use crate::args::{Cli, Command, DrawMode, InfoArgs, SceneArgs};
use crate::draw;
use crate::error::{Error, Result};
use crate::scene_builder::view::Fit;
use crate::scene_builder::{Stage, load_model};

/// The frame that memory is told for: a common SPI display.
const SCREEN: (u16, u16) = (320, 240);

/// Lines of the band that memory is told for.
const BAND: usize = 16;

/// Bytes of a pixel of RGB565 and its depth.
const PIXEL: usize = 4;

/// Tells about a model.
pub fn run(args: &InfoArgs) -> Result<()> {
    let model = load_model(&args.model, args.input_format)?;
    let value = describe(model, &args.model.display().to_string())?;
    let text = if args.json { format!("{value:#}\n") } else { table(&value) };
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|error| Error::stdout(&error))
}

/// The options of a scene when nobody gives any.
///
/// # Panics
/// Never with options that [`Cli`] knows; a test parses them.
pub fn scene_args(more: &[&str]) -> SceneArgs {
    let line = ["scanout", "render", "model"].iter().chain(more);
    match Cli::parse_from(line).command {
        Some(Command::Render(args)) => args.scene,
        _ => unreachable!("the line says render"),
    }
}

fn describe(model: Model, name: &str) -> Result<Value> {
    let parts: Vec<Value> = model.parts.iter().map(part).collect();
    let images: Vec<Value> = model
        .images
        .iter()
        .map(|i| json!({ "name": i.name, "width": i.width, "height": i.height }))
        .collect();
    let warnings: Vec<String> = model.warnings.iter().map(ToString::to_string).collect();
    let [low, high] = model.bounds();
    let (placement, stats, closed) = (model.placement, model.stats, model.closed);
    let flash = flash(&model);
    let args = scene_args(&[]);
    let mut stage = Stage::with_models(vec![model], &args)?;
    let shot = stage.shot(&args, SCREEN, Fit::Tight)?;
    let mut store = |mode| {
        stage.set_mode(mode);
        stage.with_scenes(&shot, |scene, _| Ok(draw::memory(scene))).map(|eyes| eyes[0])
    };
    let (surface, wire) = (store(DrawMode::Textured)?, store(DrawMode::Wire)?);
    let (width, height) = (usize::from(SCREEN.0), usize::from(SCREEN.1));
    Ok(json!({
        "model": name,
        "file": {
            "bytes": stats.file_bytes,
            "positions": stats.positions,
            "texture_coordinates": stats.uvs,
            "normals": stats.normals,
            "polygons": stats.polygons,
        },
        "triangles": stats.triangles,
        "edges": stats.edges,
        "degenerate": stats.degenerate,
        "closed": closed,
        "bounds": { "low": low, "high": high },
        "scale": placement.scale,
        "offset": placement.offset,
        "parts": parts,
        "textures": images,
        "memory": {
            "screen": [SCREEN.0, SCREEN.1],
            "mesh_bytes": flash,
            "store_bytes": surface,
            "store_wire_bytes": wire,
            "band_lines": BAND,
            "band_bytes": BAND * width * PIXEL,
            "frame_bytes": height * width * PIXEL,
        },
        "warnings": warnings,
    }))
}

fn part(part: &scanout_assets::Part) -> Value {
    let (mesh, material) = (&part.mesh, &part.material);
    json!({
        "name": part.name,
        "positions": mesh.positions.len(),
        "triangles": mesh.triangles.len(),
        "edges": mesh.edges.len(),
        "texture_coordinates": mesh.uvs.len(),
        "normals": match mesh.normals {
            NormalsBuf::None => "none",
            NormalsBuf::Vertex(_) => "smooth",
            NormalsBuf::Face(_) => "flat",
        },
        "colours": !mesh.colours.is_empty(),
        "material": {
            "name": material.name,
            "colour": material.colour,
            "ambient": material.ambient,
            "diffuse": material.diffuse,
            "specular": material.specular,
            "shininess": material.shininess,
            "texture": material.texture,
            "two_sided": material.two_sided,
        },
    })
}

/// Bytes of the meshes and of their textures as RGB565, which may stay in flash.
fn flash(model: &Model) -> usize {
    let mesh = |part: &scanout_assets::Part| {
        let mesh = &part.mesh;
        let normals = match &mesh.normals {
            NormalsBuf::None => 0,
            NormalsBuf::Vertex(list) | NormalsBuf::Face(list) => size_of_val(&list[..]),
        };
        size_of_val(&mesh.positions[..])
            + normals
            + size_of_val(&mesh.colours[..])
            + size_of_val(&mesh.uvs[..])
            + size_of_val(&mesh.triangles[..])
            + size_of_val(&mesh.uv_triangles[..])
            + size_of_val(&mesh.edges[..])
    };
    let texels: usize = model.images.iter().map(|image| image.rgb.len() * 2).sum();
    model.parts.iter().map(mesh).sum::<usize>() + texels
}

/// The same for people.
fn table(value: &Value) -> String {
    let mut text = String::new();
    let mut line = |name: &str, what: String| {
        let _ = writeln!(text, "{name:<12}{what}");
    };
    let vector = |v: &Value| {
        let numbers = v.as_array().into_iter().flatten().filter_map(Value::as_f64);
        numbers.map(|n| format!("{n:.6}")).collect::<Vec<_>>().join(", ")
    };
    let plain = |v: &Value| v.as_str().map_or_else(|| v.to_string(), str::to_string);
    let (file, memory) = (&value["file"], &value["memory"]);
    line("model", plain(&value["model"]));
    line(
        "file",
        format!(
            "{} bytes, {} positions, {} texture coordinates, {} normals, {} polygons",
            file["bytes"],
            file["positions"],
            file["texture_coordinates"],
            file["normals"],
            file["polygons"],
        ),
    );
    let surface = match (value["triangles"].as_u64(), value["closed"].as_bool()) {
        (Some(0), _) => "",
        (_, Some(true)) => ", closed",
        _ => ", not closed: drawn two-sided",
    };
    line("triangles", format!("{}{surface}", value["triangles"]));
    line("edges", plain(&value["edges"]));
    line("from", vector(&value["bounds"]["low"]));
    line("to", vector(&value["bounds"]["high"]));
    line("scale", format!("{} of the file's units are 1.0 in fixed point", value["scale"]));
    line("offset", vector(&value["offset"]));
    for part in value["parts"].as_array().into_iter().flatten() {
        line(
            "part",
            format!(
                "{}: {} positions, {} triangles, {} edges, {} normals, colour {}",
                plain(&part["name"]),
                part["positions"],
                part["triangles"],
                part["edges"],
                plain(&part["normals"]),
                part["material"]["colour"],
            ),
        );
    }
    for image in value["textures"].as_array().into_iter().flatten() {
        let (w, h) = (&image["width"], &image["height"]);
        line("texture", format!("{}: {w} x {h}", plain(&image["name"])));
    }
    line("flash", format!("{} bytes of meshes and RGB565 textures", memory["mesh_bytes"]));
    line(
        "RAM",
        format!(
            "{} bytes prepared ({} as wire), at most; 320 x 240 RGB565 with depth: {} bytes in bands of {} lines, {} whole",
            memory["store_bytes"],
            memory["store_wire_bytes"],
            memory["band_bytes"],
            memory["band_lines"],
            memory["frame_bytes"],
        ),
    );
    text
}

#[cfg(test)]
mod tests {
    #[test]
    fn default_options_parse() {
        assert_eq!(super::scene_args(&["--azimuth", "-3"]).camera.azimuth, Some(-3.0));
    }
}
