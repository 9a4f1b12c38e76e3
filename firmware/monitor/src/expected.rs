//! What the board should show: system B's scene with the model as the PC's own loader reads it, in floating point, drawn in one
//! band by one thread.

use std::path::Path;

use player::scene::{self, HEIGHT, Model, Placement, TURN, WIDTH};
use scanout::frame::{Frame, Needed, ObjectState, Primitive, Settings, Store};
use scanout::math::Q16;
use scanout::output::Rgb565;
use scanout::transform::Vertex;
use scanout_assets::{Limits, LoadOptions, load, load_image};

/// The hashes of a model's first frames; with `palette`, the picture is reduced to so many colours (1 to 256) first.
///
/// # Errors
/// When a file can't be read, in one line.
pub fn hashes(
    obj: &Path,
    picture: Option<&Path>,
    palette: Option<usize>,
    scale: Q16,
    frames: u32,
) -> Result<Vec<u64>, String> {
    let loaded = load(obj, &LoadOptions::default()).map_err(|error| error.to_string())?;
    let [part] = &loaded.parts[..] else {
        return Err(format!("{}: several materials; firmware knows one", obj.display()));
    };
    let picture = picture.map(|path| load_image(path, &Limits::default())).transpose();
    let picture = picture.map_err(|error| error.to_string())?.map(|(image, _)| image);
    // Colours one by one, not through the renderer's own look-up in a palette.
    let texels = picture.as_ref().map(|image| match palette {
        None => image.to_rgb565(),
        Some(most) => {
            let paletted = image.to_palette(most);
            paletted.indices.iter().map(|&index| paletted.palette[usize::from(index)]).collect()
        }
    });
    let texture = picture.as_ref().zip(texels.as_ref());
    let texture = texture.map(|(image, texels)| image.as_texture565(texels));
    let q32 = |x: f64| (x * 4_294_967_296.0).round() as i64;
    let placement =
        Placement { scale: q32(loaded.placement.scale), offset: loaded.placement.offset.map(q32) };
    let model = Model { mesh: part.mesh.as_mesh(), texture, placement };
    let turn: Vec<u64> = (0..frames.min(TURN))
        .map(|number| scene::with_scene(&model, scale, number, hash))
        .collect::<Result<_, _>>()?;
    Ok((0..frames as usize).map(|frame| turn[frame % TURN as usize]).collect())
}

fn hash(scene: &scanout::scene::Scene<'_>) -> Result<u64, String> {
    let needed = Needed::at_most(scene);
    let mut vertices = vec![Vertex::default(); needed.vertices];
    let mut primitives = vec![Primitive::default(); needed.primitives];
    let mut objects = vec![ObjectState::default(); needed.objects];
    let store =
        Store { vertices: &mut vertices, primitives: &mut primitives, objects: &mut objects };
    let frame = Frame::prepare(scene, Settings::new(WIDTH, HEIGHT), store);
    let frame = frame.map_err(|error| error.to_string())?;
    let size = usize::from(WIDTH) * usize::from(HEIGHT);
    let (mut colour, mut depth) = (vec![0; size], vec![0; size]);
    frame.hash::<Rgb565>(HEIGHT, &mut colour, &mut depth).map_err(|error| error.to_string())
}
