//! Surfaces: the file's materials under the options.

use scanout::math::Q16;
use scanout::scene::Material;
use scanout::texture::{Filter, Texels, Texture, Wrap};
use scanout_assets::{Image, MaterialBuf};

use crate::args::{LightArgs, SceneArgs, TextureFilter, TextureWrap};
use crate::values::LightAt;

/// Which faces are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sides {
    /// As the material says; both of models that are not closed.
    Own,
    Front,
    Both,
}

/// What the options say about surfaces and light.
#[derive(Clone, Debug)]
pub struct Surface {
    colour: Option<[u8; 3]>,
    weights: [Option<f64>; 3],
    shininess: Option<u16>,
    sides: Sides,
    filter: Filter,
    wrap: Option<Wrap>,
    /// Lights.
    pub lights: Vec<LightAt>,
    /// L_min.
    pub light_floor: Q16,
    /// Where fog begins and where it is complete, in the file's units.
    pub fog: Option<[f64; 2]>,
    /// Anti-aliased lines.
    pub smooth_lines: bool,
    /// Side of a point, pixels.
    pub point_size: u8,
}

impl Surface {
    /// From the command line.
    pub fn new(args: &SceneArgs) -> Self {
        let LightArgs { ambient, diffuse, specular, .. } = args.light;
        Self {
            colour: args.color.map(|colour| colour.0),
            weights: [ambient, diffuse, specular],
            shininess: args.light.shininess.map(|s| s.round() as u16),
            sides: match (args.two_sided, args.one_sided) {
                (true, _) => Sides::Both,
                (_, true) => Sides::Front,
                _ => Sides::Own,
            },
            filter: match args.texture_filter {
                Some(TextureFilter::Nearest) => Filter::Nearest,
                _ => Filter::Bilinear,
            },
            wrap: args.texture_wrap.map(|wrap| match wrap {
                TextureWrap::Repeat => Wrap::Repeat,
                TextureWrap::Mirror => Wrap::Mirror,
                TextureWrap::Clamp => Wrap::Clamp,
                TextureWrap::Border => Wrap::Border,
            }),
            lights: args.light.light.clone(),
            light_floor: Q16::from_f64(args.light.light_floor),
            fog: args.light.fog.map(|fog| fog.0),
            smooth_lines: args.smooth_lines,
            point_size: args.point_size,
        }
    }

    /// An image as the pipeline reads it; `own` is what the model wants outside it.
    pub fn texture<'a>(&self, image: &'a Image, own: [Wrap; 2]) -> Texture<'a> {
        Texture {
            width: image.width,
            height: image.height,
            levels: image.levels,
            texels: Texels::Rgb888(&image.rgb),
            wrap: self.wrap.map_or(own, |wrap| [wrap; 2]),
            filter: self.filter,
            border: [0; 3],
        }
    }

    /// A material of the file, on a closed or an open model, with what the options replace.
    pub fn material<'a>(
        &self,
        own: &MaterialBuf,
        closed: bool,
        texture: Option<&'a Texture<'a>>,
    ) -> Material<'a> {
        let weight = |i: usize, own: f32| Q16::from_f64(self.weights[i].unwrap_or(own.into()));
        Material {
            colour: self.colour.unwrap_or(own.colour),
            ambient: weight(0, own.ambient),
            diffuse: weight(1, own.diffuse),
            specular: weight(2, own.specular),
            shininess: self.shininess.unwrap_or(own.shininess),
            texture,
            two_sided: match self.sides {
                Sides::Both => true,
                Sides::Front => false,
                // From outside no back face of a closed model is seen.
                Sides::Own => own.two_sided || !closed,
            },
        }
    }
}
