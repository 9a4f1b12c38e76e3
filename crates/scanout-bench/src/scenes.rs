//! Scenes: a UV sphere of a chosen number of triangles, a model, or sheets that fill the picture, in each way of drawing.
//!
//! The sphere has radius 1 and covers 43 % of a 4:3 picture: the camera is 3 away, looks along -z, vertical field of
//! view 45 degrees, near 1, far 10. One directional light and 0.2 ambient, back faces culled, a texture of 256 x 256
//! RGB565 texels. A model is scaled so that its farthest position is 1 from the centre of its box, and seen likewise.

use std::path::Path;

use scanout::camera::{Camera, projection};
use scanout::frame::{MAX_SIDE, Settings};
use scanout::math::{Angle, Mat4, Q16, Vec3};
use scanout::mesh::Mesh;
use scanout::scene::{Background, Light, LightKind, Material, Mode, Object, Scene};
use scanout::texture::{Texels, Texture};
use scanout_assets::{Image, LoadOptions, MeshBuf, Model, NormalsBuf, load};

use crate::layers;
use crate::memory::Memory;
use crate::sphere::{TEXTURE_SIDE, sphere, texels};

/// Towards the light, any length.
pub const LIGHT: [f64; 3] = [0.5, 0.8, 1.0];

/// Colour of a surface without texture.
pub const COLOUR: [u8; 3] = [230, 180, 120];

/// Colour of the background.
pub const BACKGROUND: [u8; 3] = [16, 24, 40];

/// Ways of drawing, by the name that the tables use.
pub const LOOKS: [&str; 9] = [
    "flat",
    "flat-face-normals",
    "gouraud",
    "textured",
    "flat-textured",
    "phong",
    "wire",
    "hidden",
    "points",
];

/// The normal of each triangle, Q2.14.
fn face_normals(mesh: &MeshBuf) -> Vec<[i16; 3]> {
    let normal = |t: &[u16; 3]| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize].map(f64::from));
        let (d, e) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
        let n = [d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2], d[0] * e[1] - d[1] * e[0]];
        let length = n.iter().map(|v| v * v).sum::<f64>().sqrt().max(1.0);
        n.map(|v| (v / length * 16384.0).round() as i16)
    };
    mesh.triangles.iter().map(normal).collect()
}

/// Where the meshes of a case come from, and how it is drawn: `SOURCE:LOOK:WIDTHxHEIGHT`, for example
/// `5000:gouraud:320x240` or `models/torus.obj:textured:640x480`; the source `empty` draws the background alone, `fill`
/// the sheets of [`layers`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Case {
    /// A number of triangles, `empty`, `fill`, or the path of a model.
    pub source: String,
    /// One of [`LOOKS`].
    pub look: String,
    /// Width and height in pixels.
    pub size: [u16; 2],
}

impl Case {
    /// Reads a case's name.
    ///
    /// # Errors
    /// A sentence that says what is missing.
    pub fn parse(name: &str) -> Result<Case, String> {
        let mut fields = name.rsplitn(3, ':');
        let (Some(size), Some(look), Some(source)) = (fields.next(), fields.next(), fields.next())
        else {
            return Err(format!("{name}: not SOURCE:LOOK:WIDTHxHEIGHT"));
        };
        let side = |s: &str| {
            let side = s.parse().ok().filter(|side| (1..=MAX_SIDE).contains(side));
            side.ok_or(format!("{name}: {size} is no size of two numbers from 1 to {MAX_SIDE}"))
        };
        let (width, height) = size.split_once('x').ok_or(format!("{name}: {size} is no size"))?;
        if !LOOKS.contains(&look) {
            return Err(format!("{name}: {look} is none of {}", LOOKS.join(", ")));
        }
        let size = [side(width)?, side(height)?];
        Ok(Case { source: source.into(), look: look.into(), size })
    }
}

/// A case's data, from which a scene borrows.
#[derive(Clone, Debug)]
pub struct Data {
    case: Case,
    meshes: Vec<MeshBuf>,
    /// What mesh position 1.0 measures in the world.
    scale: f64,
    pictures: Vec<Picture>,
    /// Index of each mesh's picture.
    of_mesh: Vec<Option<usize>>,
}

#[derive(Clone, Debug)]
struct Picture {
    size: [u16; 2],
    texels: Vec<u16>,
}

impl Picture {
    fn new(image: &Image) -> Picture {
        let pixels = image.width as usize * image.height as usize;
        let pack = |&[r, g, b]: &[u8; 3]| {
            (r as u16 & 0xf8) << 8 | (g as u16 & 0xfc) << 3 | (b as u16) >> 3
        };
        Picture {
            size: [image.width, image.height],
            texels: image.rgb[..pixels].iter().map(pack).collect(),
        }
    }

    fn texture(&self) -> Texture<'_> {
        let [width, height] = self.size;
        Texture::new(width, height, Texels::Rgb565(&self.texels)).expect("a usable texture")
    }
}

impl Data {
    /// Makes or loads what a case draws.
    ///
    /// # Errors
    /// When the model cannot be loaded.
    pub fn new(case: Case) -> Result<Data, String> {
        let chequers = Picture { size: [TEXTURE_SIDE; 2], texels: texels() };
        let made = |mesh, scale| (vec![mesh], vec![chequers], vec![Some(0)], scale);
        let (meshes, pictures, of_mesh, scale) = match case.source.as_str() {
            "empty" => (Vec::new(), Vec::new(), Vec::new(), 1.0),
            "fill" => made(layers::sheets(), layers::SCALE),
            "400" => made(sphere(400), 32768.0 / 32767.0),
            "5000" => made(sphere(5_000), 32768.0 / 32767.0),
            "70000" => made(sphere(70_000), 32768.0 / 32767.0),
            path => {
                let path = Path::new(path);
                let model = load(path, &LoadOptions::default()).map_err(|e| e.to_string())?;
                return Ok(Data::of_model(case, model));
            }
        };
        Ok(Data { case, meshes, scale, pictures, of_mesh }.with_face_normals())
    }

    /// The data of a case whose model is already there; its source is a name.
    pub fn of_model(case: Case, model: Model) -> Data {
        let pictures = model.images.iter().map(Picture::new).collect();
        let of_mesh = model.parts.iter().map(|p| p.material.texture).collect();
        let meshes: Vec<MeshBuf> = model.parts.into_iter().map(|p| p.mesh).collect();
        let farthest = meshes
            .iter()
            .flat_map(|m| &m.positions)
            .map(|p| p.iter().map(|&v| f64::from(v).powi(2)).sum::<f64>())
            .fold(1.0, f64::max);
        let scale = 32768.0 / farthest.sqrt();
        Data { case, meshes, scale, pictures, of_mesh }.with_face_normals()
    }

    fn with_face_normals(mut self) -> Data {
        if self.case.look == "flat-face-normals" {
            for mesh in &mut self.meshes {
                mesh.normals = NormalsBuf::Face(face_normals(mesh));
            }
        }
        self
    }

    /// Pixels that a frame's rate is counted in: those of the picture, or all that the sheets of `fill` draw.
    pub fn pixels(&self) -> u64 {
        let [width, height] = self.case.size.map(u64::from);
        let layers = if self.case.source == "fill" { layers::COUNT as u64 } else { 1 };
        width * height * layers
    }

    /// The meshes.
    pub fn meshes(&self) -> &[MeshBuf] {
        &self.meshes
    }

    /// Leaves these triangles of the first mesh.
    #[cfg(test)]
    pub(crate) fn keep_triangles(&mut self, triangles: &[[u16; 3]]) {
        self.meshes[0].triangles = triangles.to_vec();
        self.meshes[0].uv_triangles = triangles.to_vec();
        self.meshes[0].clusters = Vec::new();
    }

    /// Hands the scene and memory for it to `action`.
    pub fn with<R>(&self, action: impl FnOnce(&Scene, Settings, &mut Memory) -> R) -> R {
        let textured = self.case.look.contains("textured");
        let mode = match self.case.look.as_str() {
            "gouraud" | "textured" => Mode::Gouraud,
            "phong" => Mode::Phong,
            "wire" => Mode::Wire,
            "hidden" => Mode::Hidden,
            "points" => Mode::Points,
            _ => Mode::Flat,
        };
        let textures: Vec<Texture> = self.pictures.iter().map(Picture::texture).collect();
        let materials: Vec<Material> = self
            .of_mesh
            .iter()
            .map(|&picture| Material {
                colour: if textured { [255; 3] } else { COLOUR },
                ambient: Q16::from_f64(0.2),
                diffuse: Q16::from_f64(if mode == Mode::Phong { 0.6 } else { 0.8 }),
                specular: Q16::from_f64(if mode == Mode::Phong { 0.2 } else { 0.0 }),
                shininess: 16,
                texture: picture.filter(|_| textured).map(|i| &textures[i]),
                two_sided: false,
            })
            .collect();
        let meshes: Vec<Mesh> = self.meshes.iter().map(MeshBuf::as_mesh).collect();
        let objects: Vec<Object> = meshes
            .iter()
            .zip(&materials)
            .map(|(mesh, material)| Object {
                mesh,
                material,
                transform: Mat4::uniform_scale(Q16::from_f64(self.scale)),
                mode,
                smooth_lines: false,
                point_size: 1,
            })
            .collect();
        let [width, height] = self.case.size;
        let light = Light { kind: LightKind::Directional(Vec3::from_f64(LIGHT)), colour: [255; 3] };
        let scene = Scene {
            camera: camera(width, height),
            objects: &objects,
            lights: &[light],
            light_floor: Q16::ZERO,
            fog: None,
            background: Background::Colour(BACKGROUND),
        };
        let mut memory = Memory::new(&scene, width, height);
        action(&scene, Settings::new(width, height), &mut memory)
    }
}

/// Distance 3, 45 degrees, near 1, far 10.
pub fn camera(width: u16, height: u16) -> Camera {
    let aspect = Q16::from_ratio(width as i32, height as i32);
    let angle = Angle::from_degrees(Q16::from_int(45));
    let lens = projection::perspective(angle, aspect, Q16::from_int(1), Q16::from_int(10))
        .expect("a valid lens");
    let eye = Vec3::from_f64([0.0, 0.0, 3.0]);
    Camera::look_at(eye, Vec3::ZERO, Vec3::Y, lens).expect("a valid camera")
}

#[cfg(test)]
mod tests {
    use scanout::output::{PixelFormat, Rgb565};

    use super::*;

    /// Draws a case and tells how many of its pixels are not background, and the number of primitives.
    fn drawn(name: &str) -> (usize, u32) {
        Data::new(Case::parse(name).unwrap()).unwrap().with(|scene, settings, memory| {
            memory.draw(scene, settings);
            let clear = Rgb565::encode(BACKGROUND);
            let drawn = memory.colour.iter().filter(|&&pixel| pixel != clear).count();
            (drawn, memory.prepare(scene, settings).0.stats().primitives)
        })
    }

    #[test]
    fn the_sphere_covers_43_percent() {
        let (pixels, _) = drawn("5000:flat:320x240");
        assert!((0.425..0.435).contains(&(pixels as f64 / 76_800.0)), "{pixels}");
        assert_eq!(drawn("empty:flat:320x240"), (0, 0));
    }

    #[test]
    fn names_tell_what_is_wrong() {
        for (name, what) in [
            ("5000:flat", "not SOURCE:LOOK:WIDTHxHEIGHT"),
            ("5000:flatt:320x240", "flatt is none of flat, "),
            ("5000:flat:320", "320 is no size"),
            ("5000:flat:0x240", "0x240 is no size of two numbers from 1 to 4096"),
            ("5000:flat:320x5000", "320x5000 is no size"),
        ] {
            let error = Case::parse(name).unwrap_err();
            assert!(error.contains(what), "{error}");
        }
        assert_eq!(Case::parse("C:\\a.obj:flat:1x1").unwrap().source, "C:\\a.obj");
    }
}
