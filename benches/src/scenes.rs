//! Scenes: a UV sphere of a chosen number of triangles, or a model's file, in each way of drawing.
//!
//! The sphere has radius 1 and covers 43 % of a 4:3 picture: the camera is 3 away, looks along -z, vertical field of
//! view 45 degrees, near 1, far 10. One directional light and 0.2 ambient, back faces culled, a texture of 256 x 256
//! RGB565 texels. A model is scaled so that its farthest position is 1 from the centre of its box, and seen likewise.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use scanout::camera::{Camera, projection};
use scanout::frame::{Frame, Needed, ObjectState, Primitive, Settings, Store};
use scanout::math::{Angle, Mat4, Q16, Vec3};
use scanout::mesh::Mesh;
use scanout::mesh_edges::unique_edges;
use scanout::output::Rgb565;
use scanout::scene::{Background, Light, LightKind, Material, Mode, Object, Scene};
use scanout::texture::{Texels, Texture};
use scanout::transform::Vertex;
use scanout_assets::{Image, LoadOptions, MeshBuf, NormalsBuf, load};

/// Side of the texture.
pub const TEXTURE_SIDE: u16 = 256;

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

/// Segments and bands of latitude of the sphere with this many triangles (`2 * segments * (bands - 1)`).
///
/// # Panics
/// When it is none of 400, 5,000 and 70,000.
pub fn tessellation(triangles: usize) -> (usize, usize) {
    match triangles {
        400 => (20, 11),
        5_000 => (50, 51),
        70_000 => (250, 141),
        _ => panic!("no sphere of {triangles} triangles; take 400, 5000 or 70000"),
    }
}

/// A UV sphere of radius 1: its positions are shared across the seam and at the poles, its texture coordinates not.
pub fn sphere(triangles: usize) -> MeshBuf {
    let (segments, bands) = tessellation(triangles);
    let mut mesh = MeshBuf::default();
    let mut normals = Vec::new();
    let mut add = |u: f64, v: f64| {
        let (theta, phi) = (u * TAU, v * PI);
        let n = [phi.sin() * theta.cos(), phi.cos(), -phi.sin() * theta.sin()];
        mesh.positions.push(n.map(|v| (v * 32767.0).round() as i16));
        normals.push(n.map(|v| (v * 16384.0).round() as i16));
    };
    add(0.0, 0.0);
    for r in 1..bands {
        (0..segments).for_each(|k| add(k as f64 / segments as f64, r as f64 / bands as f64));
    }
    add(0.0, 1.0);
    for r in 0..=bands {
        for k in 0..=segments {
            // A pole has a texture coordinate a triangle, in its middle.
            let shift = if r == 0 || r == bands { 0.5 } else { 0.0 };
            let (u, v) = ((k as f64 + shift) / segments as f64, r as f64 / bands as f64);
            mesh.uvs.push([(u * 65536.0).round() as i32, (v * 65536.0).round() as i32]);
        }
    }
    let position = |r: usize, k: usize| match r {
        0 => 0,
        r if r == bands => (1 + (bands - 1) * segments) as u16,
        r => (1 + (r - 1) * segments + k % segments) as u16,
    };
    let uv = |r: usize, k: usize| (r * (segments + 1) + k) as u16;
    for r in 0..bands {
        for k in 0..segments {
            let (a, b, c, d) = ((r, k), (r, k + 1), (r + 1, k), (r + 1, k + 1));
            let upper = (r > 0).then_some([a, c, b]);
            let lower = (r + 1 < bands).then_some(if r == 0 { [a, c, d] } else { [b, c, d] });
            for corners in [upper, lower].into_iter().flatten() {
                mesh.triangles.push(corners.map(|(r, k)| position(r, k)));
                mesh.uv_triangles.push(corners.map(|(r, k)| uv(r, k)));
            }
        }
    }
    assert_eq!(mesh.triangles.len(), triangles);
    mesh.normals = NormalsBuf::Vertex(normals);
    mesh.edges = edges_of(&mesh.triangles);
    mesh
}

/// Each edge of the triangles once.
fn edges_of(triangles: &[[u16; 3]]) -> Vec<[u16; 2]> {
    let mut edges = vec![[0; 2]; 3 * triangles.len()];
    let count = unique_edges(triangles, &mut edges).expect("three a triangle suffice");
    edges.truncate(count);
    edges
}

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

/// A texture of light and dark squares with a gradient, RGB565.
pub fn texels() -> Vec<u16> {
    let side = TEXTURE_SIDE as usize;
    let texel = |i: usize| {
        let (x, y) = (i % side, i / side);
        let light = if (x / 16 + y / 16) % 2 == 0 { 255 } else { 150 };
        let [r, g, b] = [light, light * (255 - y / 2) / 255, light * (128 + x / 2) / 255];
        (r >> 3 << 11 | g >> 2 << 5 | b >> 3) as u16
    };
    (0..side * side).map(texel).collect()
}

/// Where the meshes of a case come from, and how it is drawn: `SOURCE:LOOK:WIDTHxHEIGHT`, for example
/// `5000:gouraud:320x240` or `models/torus.obj:textured:640x480`; the source `empty` draws the background alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Case {
    /// A number of triangles, `empty`, or the path of a model.
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
        let side = |s: &str| s.parse().map_err(|_| format!("{name}: {size} is no size"));
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
        let (side, mut pictures) = (TEXTURE_SIDE, Vec::new());
        let (mut meshes, of_mesh, scale) = match case.source.as_str() {
            "empty" => (Vec::new(), Vec::new(), 1.0),
            "400" | "5000" | "70000" => {
                let triangles = case.source.parse().expect("one of three numbers");
                pictures.push(Picture { size: [side; 2], texels: texels() });
                (vec![sphere(triangles)], vec![Some(0)], 32768.0 / 32767.0)
            }
            path => {
                let path = Path::new(path);
                let model = load(path, &LoadOptions::default()).map_err(|e| e.to_string())?;
                pictures.extend(model.images.iter().map(Picture::new));
                let of_mesh = model.parts.iter().map(|p| p.material.texture).collect();
                let meshes: Vec<MeshBuf> = model.parts.into_iter().map(|p| p.mesh).collect();
                let farthest = meshes
                    .iter()
                    .flat_map(|m| &m.positions)
                    .map(|p| p.iter().map(|&v| f64::from(v).powi(2)).sum::<f64>())
                    .fold(1.0, f64::max);
                (meshes, of_mesh, 32768.0 / farthest.sqrt())
            }
        };
        for mesh in &mut meshes {
            if case.look == "flat-face-normals" {
                mesh.normals = NormalsBuf::Face(face_normals(mesh));
            }
        }
        Ok(Data { case, meshes, scale, pictures, of_mesh })
    }

    /// The meshes.
    pub fn meshes(&self) -> &[MeshBuf] {
        &self.meshes
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

/// The caller's memory: the frame's store, colour and depth.
#[derive(Clone, Debug)]
pub struct Memory {
    vertices: Vec<Vertex>,
    primitives: Vec<Primitive>,
    objects: Vec<ObjectState>,
    /// RGB565, rows from the top.
    pub colour: Vec<u16>,
    /// 16 bits a pixel.
    pub depth: Vec<u16>,
}

impl Memory {
    /// Enough for a scene, and for a frame of this size in one band.
    pub fn new(scene: &Scene, width: u16, height: u16) -> Memory {
        let needed = Needed::at_most(scene);
        let pixels = width as usize * height as usize;
        Memory {
            vertices: vec![Default::default(); needed.vertices],
            primitives: vec![Default::default(); needed.primitives],
            objects: vec![Default::default(); needed.objects],
            colour: vec![0; pixels],
            depth: vec![0; pixels],
        }
    }

    /// Prepares a scene; the frame, colour and depth memory.
    ///
    /// # Panics
    /// When the scene cannot be prepared.
    pub fn prepare<'a>(
        &'a mut self,
        scene: &'a Scene<'a>,
        settings: Settings,
    ) -> (Frame<'a>, &'a mut [u16], &'a mut [u16]) {
        let store = Store {
            vertices: &mut self.vertices,
            primitives: &mut self.primitives,
            objects: &mut self.objects,
        };
        let frame = Frame::prepare(scene, settings, store).expect("a scene that can be drawn");
        (frame, &mut self.colour, &mut self.depth)
    }

    /// Prepares a scene and draws all of it, one thread, one band.
    ///
    /// # Panics
    /// When the scene cannot be prepared.
    #[inline(never)]
    pub fn draw(&mut self, scene: &Scene, settings: Settings) {
        let (frame, colour, depth) = self.prepare(scene, settings);
        frame.draw_rows::<Rgb565>(0..settings.height, colour, depth).expect("memory for all rows");
    }

    /// Prepares a scene and draws it in `threads` bands at once.
    ///
    /// # Panics
    /// When the scene cannot be prepared.
    pub fn draw_threads(&mut self, scene: &Scene, settings: Settings, threads: u16) {
        let (frame, colour, depth) = self.prepare(scene, settings);
        let rows = settings.height.div_ceil(threads);
        let pixels = rows as usize * settings.width as usize;
        std::thread::scope(|scope| {
            let bands = colour.chunks_mut(pixels).zip(depth.chunks_mut(pixels));
            for (i, (colour, depth)) in bands.enumerate() {
                let (frame, top) = (&frame, i as u16 * rows);
                let bottom = settings.height.min(top + rows);
                let mut band = move || {
                    frame.draw_rows::<Rgb565>(top..bottom, colour, depth).expect("a band's memory");
                };
                // The last band is this thread's own.
                if bottom == settings.height {
                    band();
                } else {
                    scope.spawn(band);
                }
            }
        });
    }
}
