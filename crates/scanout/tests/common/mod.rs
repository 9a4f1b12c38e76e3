//! Scenes for tests: meshes built from formulas, drawn into memory that the test owns.
#![allow(dead_code)]

use scanout::camera::{Camera, projection};
use scanout::frame::{Frame, Needed, ObjectState, Primitive, Settings, Store};
use scanout::math::{Angle, Mat4, Q16, Vec3};
use scanout::mesh::{Mesh, Normals};
use scanout::output::PixelFormat;
use scanout::scene::{Background, Light, LightKind, Material, Mode, Object, Scene};
use scanout::transform::Vertex;

/// A mesh that owns its slices.
#[derive(Default, Clone)]
pub struct Owned {
    pub positions: Vec<[i16; 3]>,
    pub normals: Vec<[i16; 3]>,
    pub colours: Vec<[u8; 3]>,
    pub uvs: Vec<[i32; 2]>,
    pub triangles: Vec<[u16; 3]>,
    pub edges: Vec<[u16; 2]>,
}

impl Owned {
    pub fn mesh(&self) -> Mesh<'_> {
        Mesh {
            positions: &self.positions,
            normals: if self.normals.is_empty() {
                Normals::None
            } else {
                Normals::Vertex(&self.normals)
            },
            colours: &self.colours,
            uvs: &self.uvs,
            triangles: &self.triangles,
            uv_triangles: if self.uvs.is_empty() { &[] } else { &self.triangles },
            edges: &self.edges,
            ..Mesh::default()
        }
    }
}

fn q15(v: f64) -> i16 {
    (v * 32768.0).round().clamp(-32768.0, 32767.0) as i16
}

/// A UV sphere of radius 0.9.
pub fn sphere(segments: u16, rings: u16) -> Owned {
    let mut s = Owned::default();
    let width = segments + 1;
    for r in 0..=rings {
        for k in 0..=segments {
            let (u, v) = (k as f64 / segments as f64, r as f64 / rings as f64);
            let (theta, phi) = (u * std::f64::consts::TAU, v * std::f64::consts::PI);
            let n = [phi.sin() * theta.cos(), phi.cos(), -phi.sin() * theta.sin()];
            s.positions.push(n.map(|v| q15(v * 0.9)));
            s.normals.push(n.map(|v| (v * 16384.0).round() as i16));
            s.uvs.push([(u * 65536.0) as i32, (v * 65536.0) as i32]);
            s.colours.push([(u * 255.0) as u8, (v * 255.0) as u8, 200]);
        }
    }
    for r in 0..rings {
        for k in 0..segments {
            let a = r * width + k;
            let (b, c, d) = (a + 1, a + width, a + width + 1);
            if r > 0 {
                s.triangles.push([a, c, b]);
                s.edges.push([a, b]);
            }
            if r + 1 < rings {
                s.triangles.push([b, c, d]);
            }
            s.edges.push([a, c]);
        }
    }
    s
}

/// A camera at distance 3, 45 degrees, near 1, far 10.
pub fn camera(width: u16, height: u16) -> Camera {
    let aspect = Q16::from_ratio(width as i32, height as i32);
    let lens = projection::perspective(
        Angle::from_degrees(Q16::from_int(45)),
        aspect,
        Q16::from_int(1),
        Q16::from_int(10),
    )
    .unwrap();
    let eye = Vec3::from_f64([0.0, 0.5, 2.9]);
    Camera::look_at(eye, Vec3::ZERO, Vec3::Y, lens).unwrap()
}

pub const LIGHT: Light = Light {
    kind: LightKind::Directional(Vec3 { x: Q16(40_000), y: Q16(60_000), z: Q16(65_536) }),
    colour: [255; 3],
};

pub fn material() -> Material<'static> {
    Material {
        colour: [255; 3],
        ambient: Q16::from_f64(0.2),
        diffuse: Q16::from_f64(0.6),
        specular: Q16::from_f64(0.3),
        shininess: 16,
        texture: None,
        two_sided: false,
    }
}

pub fn object<'a>(mesh: &'a Mesh<'a>, material: &'a Material<'a>, mode: Mode) -> Object<'a> {
    Object { mesh, material, transform: Mat4::IDENTITY, mode, smooth_lines: false, point_size: 1 }
}

pub fn scene<'a>(camera: Camera, objects: &'a [Object<'a>]) -> Scene<'a> {
    Scene {
        camera,
        objects,
        lights: &[LIGHT],
        light_floor: Q16(0),
        fog: None,
        background: Background::Colour([16, 24, 40]),
    }
}

/// Memory for a frame.
pub struct Memory(Vec<Vertex>, Vec<Primitive>, Vec<ObjectState>);

impl Memory {
    pub fn new(needed: Needed) -> Memory {
        Memory(
            vec![Default::default(); needed.vertices],
            vec![Default::default(); needed.primitives],
            vec![Default::default(); needed.objects],
        )
    }
    pub fn store(&mut self) -> Store<'_> {
        Store { vertices: &mut self.0, primitives: &mut self.1, objects: &mut self.2 }
    }
}

/// A picture: colour words and depths.
pub struct Picture<F: PixelFormat> {
    pub colour: Vec<F::Word>,
    pub depth: Vec<u16>,
}

impl<F: PixelFormat> PartialEq for Picture<F> {
    fn eq(&self, other: &Self) -> bool {
        self.colour == other.colour && self.depth == other.depth
    }
}

/// Draws a scene in bands of `lines`, the bands in the order given by `backwards`.
pub fn draw<F: PixelFormat>(
    scene: &Scene,
    settings: Settings,
    lines: u16,
    backwards: bool,
) -> Picture<F> {
    let mut memory = Memory::new(Needed::at_most(scene));
    let frame = Frame::prepare(scene, settings, memory.store()).unwrap();
    let (width, height) = (settings.width as usize, settings.height);
    let words = F::words(width);
    let mut picture = Picture::<F> {
        colour: vec![F::Word::default(); words * height as usize],
        depth: vec![0; width * height as usize],
    };
    let mut bands: Vec<u16> = (0..height).step_by(lines as usize).collect();
    if backwards {
        bands.reverse();
    }
    for top in bands {
        let bottom = height.min(top + lines);
        let (from, to) = (top as usize, bottom as usize);
        frame
            .draw_rows::<F>(
                top..bottom,
                &mut picture.colour[from * words..to * words],
                &mut picture.depth[from * width..to * width],
            )
            .unwrap();
    }
    picture
}

/// Writes an RGB888 picture as PPM, for looking at.
pub fn save(picture: &Picture<scanout::output::Rgb888>, width: usize, path: &str) {
    let mut bytes = format!("P6\n{} {}\n255\n", width, picture.colour.len() / width).into_bytes();
    bytes.extend(picture.colour.iter().flatten());
    std::fs::write(path, bytes).unwrap();
}
