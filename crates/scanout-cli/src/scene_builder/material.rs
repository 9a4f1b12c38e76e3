//! Surfaces: the file's materials under the options.

use scanout::math::Q16;
use scanout::scene::Material;
use scanout::texture::{Filter, Texels, Texture, Wrap};
use scanout_assets::{Image, MaterialBuf};

use crate::args::{LightArgs, SceneArgs, TextureFilter, TextureWrap};
use crate::values::LightAt;

/// What the options say about surfaces and light.
#[derive(Clone, Debug)]
pub struct Surface {
    colour: Option<[u8; 3]>,
    weights: [Option<f64>; 3],
    shininess: Option<u16>,
    two_sided: bool,
    filter: Filter,
    wrap: Wrap,
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
            two_sided: args.two_sided,
            filter: match args.texture_filter {
                Some(TextureFilter::Nearest) => Filter::Nearest,
                _ => Filter::Bilinear,
            },
            wrap: match args.texture_wrap {
                None | Some(TextureWrap::Repeat) => Wrap::Repeat,
                Some(TextureWrap::Mirror) => Wrap::Mirror,
                Some(TextureWrap::Clamp) => Wrap::Clamp,
                Some(TextureWrap::Border) => Wrap::Border,
            },
            lights: args.light.light.clone(),
            light_floor: Q16::from_f64(args.light.light_floor),
            fog: args.light.fog.map(|fog| fog.0),
            smooth_lines: args.smooth_lines,
            point_size: args.point_size,
        }
    }

    /// An image as the pipeline reads it.
    pub fn texture<'a>(&self, image: &'a Image) -> Texture<'a> {
        Texture {
            width: image.width,
            height: image.height,
            levels: image.levels,
            texels: Texels::Rgb888(&image.rgb),
            wrap: [self.wrap; 2],
            filter: self.filter,
            border: [0; 3],
        }
    }

    /// A material of the file with what the options replace.
    pub fn material<'a>(
        &self,
        own: &MaterialBuf,
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
            two_sided: self.two_sided || own.two_sided,
        }
    }
}
