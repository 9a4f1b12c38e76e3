//! Whole models: a frame of `scanout`, from camera to depth buffer, against the same screen triangles in exact rationals and in
//! llvmpipe.
//!
//! What is judged is everything after the vertices: the frame's own screen positions, colours and 1/w (read from its store
//! after preparing) go to the judges as triangles. Culling of back faces and the depth test are the judges' own.
//!
//! Where two triangles lie within two steps of depth, their order may be rounded either way: there the depth is judged, but
//! not whose colour shows.

use std::path::{Path, PathBuf};

use scanout::camera::{Camera, projection};
use scanout::frame::{Frame, Needed, ObjectState, Primitive, Settings, Store};
use scanout::math::{Angle, Q16, Vec3};
use scanout::mesh::{Mesh, Normals};
use scanout::output::Rgb888;
use scanout::scene::{Light, LightKind, Material, Mode, Object, Scene};
use scanout::texture::{Texels, Texture as CoreTexture};
use scanout::transform;
use scanout_assets::{Format, LoadOptions, Model};

use crate::judge::{Report, at_border};
use crate::llvmpipe::Llvmpipe;
use crate::pipeline::Pipeline;
use crate::reference::{self, Exact};
use crate::triangle::{Fragment, Renderer, Texel, Texture, Triangle, Vertex};

/// Rows in a band of the frame: any number gives the same pixels.
const ROWS: u16 = 37;

/// A frame of a model and the triangles that it was drawn from.
pub struct Shot {
    size: (u32, u32),
    /// Front faces, in order.
    triangles: Vec<Triangle>,
    /// Colour and depth (16 bits) of each pixel.
    pixels: Vec<([u8; 3], u16)>,
    /// The texture, if the model was drawn with one instead of light.
    texture: Option<Texture>,
}

/// What the exact depth test leaves at a pixel.
#[derive(Clone, Copy)]
struct Nearest {
    triangle: usize,
    exact: Exact,
    /// Depth of the nearest and of the second triangle, in steps of 1/65535.
    depths: [f64; 2],
}

/// Reads a model.
///
/// # Errors
/// The reader's message.
pub fn load(path: &Path) -> Result<Model, String> {
    scanout_assets::load(path, &LoadOptions::default()).map_err(|error| error.to_string())
}

/// The shipped models, in order: files in `models/` and the folders in it that a reader takes for a model.
///
/// # Errors
/// When there is no such folder.
pub fn shipped() -> std::io::Result<Vec<PathBuf>> {
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("../models")];
    let mut models = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if Format::from_path(&path).is_some() {
                models.push(path);
            }
        }
    }
    models.sort();
    Ok(models)
}

/// Whether every part of a model can be textured.
#[must_use]
pub fn has_texture_coordinates(model: &Model) -> bool {
    model.parts.iter().all(|part| part.mesh.uv_triangles.len() == part.mesh.triangles.len())
}

/// Draws a model from a point at `turn` (in 1/64 of a turn about it, a little above), lit and Gouraud-shaded, or with `texture`
/// and no light.
///
/// # Panics
/// If the frame cannot be prepared, or a part of the model leaves the view (the judges do not clip).
#[must_use]
pub fn shoot(model: &Model, turn: i32, texture: Option<Texture>, size: (u32, u32)) -> Shot {
    let rgba = texture.map(|texture| texture.rgba()).unwrap_or_default();
    let texels: Vec<[u8; 3]> = rgba.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect();
    let core_texture = texture.map(|texture| {
        let (width, height) = (texture.width as u16, texture.height as u16);
        let core = CoreTexture::new(width, height, Texels::Rgb888(&texels));
        core.expect("sizes from 1 to 256")
    });
    let mut material = Material::default();
    if let Some(core) = &core_texture {
        // White light on white: the frame shows the texels themselves.
        (material.ambient, material.diffuse) = (Q16::ONE, Q16::ZERO);
        material.texture = Some(core);
    }
    let meshes: Vec<Mesh> = model.parts.iter().map(|part| part.mesh.as_mesh()).collect();
    // Light at the vertices is what the store shows, so every mesh is lit there.
    let outwards: Vec<Vec<[i16; 3]>> = meshes.iter().map(outward_normals).collect();
    let lit_at_vertices = meshes.into_iter().zip(&outwards).map(|(mesh, outwards)| {
        let normals = match mesh.normals {
            Normals::Vertex(own) => own,
            _ => outwards,
        };
        Mesh { normals: Normals::Vertex(normals), ..mesh }
    });
    let meshes: Vec<Mesh> = lit_at_vertices.collect();
    let objects: Vec<Object> =
        meshes.iter().map(|mesh| Object::new(mesh, &material, Mode::Gouraud)).collect();
    let mut scene = Scene::new(camera(turn, size), &objects);
    let towards = LightKind::Directional(Vec3::from_f64([0.5, 1.0, 0.7]));
    let lights = [Light { kind: towards, colour: [255, 230, 200] }];
    if texture.is_none() {
        scene.lights = &lights;
    }
    draw(&scene, texture, size)
}

/// Normals that point away from the middle of the model, Q2.14: for meshes that have none at their vertices.
fn outward_normals(mesh: &Mesh) -> Vec<[i16; 3]> {
    let normal = |position: &[i16; 3]| {
        let p = position.map(f64::from);
        let length = p.iter().map(|c| c * c).sum::<f64>().sqrt().max(1.0);
        p.map(|c| (c / length * 16384.0) as i16)
    };
    mesh.positions.iter().map(normal).collect()
}

/// A camera that sees all of a model, which fills [-1, 1] on each axis.
fn camera(turn: i32, (width, height): (u32, u32)) -> Camera {
    let aspect = Q16::from_ratio(width as i32, height as i32);
    let (near, far) = (Q16::ONE, Q16::from_int(8));
    let lens = projection::perspective(Angle::from_degrees(Q16::from_int(50)), aspect, near, far);
    let angle = f64::from(turn) / 64.0 * std::f64::consts::TAU;
    let eye = Vec3::from_f64([4.0 * angle.sin(), 1.0, 4.0 * angle.cos()]);
    Camera::look_at(eye, Vec3::ZERO, Vec3::Y, lens.expect("a lens")).expect("a camera")
}

fn draw(scene: &Scene, texture: Option<Texture>, size: (u32, u32)) -> Shot {
    let (width, height) = (size.0 as u16, size.1 as u16);
    let needed = Needed::at_most(scene);
    let mut vertices = vec![transform::Vertex::default(); needed.vertices];
    let mut primitives = vec![Primitive::default(); needed.primitives];
    let mut states = vec![ObjectState::default(); needed.objects];
    let store =
        Store { vertices: &mut vertices, primitives: &mut primitives, objects: &mut states };
    let frame = Frame::prepare(scene, Settings::new(width, height), store).expect("a frame");
    assert_eq!(frame.stats().vertices as usize, needed.vertices, "a part lies outside the view");
    assert_eq!(frame.stats().clipped, 0, "a triangle crosses the view's border");

    let mut pixels = Vec::new();
    let mut colour = vec![[0; 3]; usize::from(width) * usize::from(ROWS)];
    let mut depth = vec![0; colour.len()];
    let drawn = frame.draw_bands::<Rgb888, ()>(ROWS, &mut colour, &mut depth, |band| {
        pixels.extend(band.colour.iter().copied().zip(band.depth.iter().copied()));
        Ok(())
    });
    drawn.expect("enough memory for a band");

    let mut triangles = Vec::new();
    let mut first = 0;
    for object in scene.objects {
        let mesh = object.mesh;
        let own = &vertices[first..first + mesh.positions.len()];
        first += own.len();
        for (i, corners) in mesh.triangles.iter().enumerate() {
            let uv = |k: usize| {
                let index = mesh.uv_triangles.get(i).map(|t| usize::from(t[k]));
                index.and_then(|index| mesh.uvs.get(index)).copied().unwrap_or([0; 2])
            };
            let triangle = screen_triangle(corners.map(|v| own[usize::from(v)]), [0, 1, 2].map(uv));
            if reference::is_counter_clockwise(&triangle) {
                triangles.push(triangle);
            }
        }
    }
    Shot { size, triangles, pixels, texture }
}

/// Three vertices of the frame's store as a triangle, their 1/w brought to 23 bits under the largest exponent.
fn screen_triangle(corners: [transform::Vertex; 3], uvs: [[i32; 2]; 3]) -> Triangle {
    let exponent = corners.iter().map(transform::Vertex::exponent).fold(0, u32::max);
    Triangle([0, 1, 2].map(|k| {
        let v = corners[k];
        let q = (v.inv_w >> 9) >> (exponent - v.exponent());
        Vertex { x: v.x, y: v.y, z: v.z, colour: v.rgb, uv: uvs[k], q }
    }))
}

impl Shot {
    /// Front faces drawn.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.triangles.len()
    }

    /// The exact depth test: of the triangles that cover a pixel, the nearest.
    fn nearest(&self) -> Vec<Option<Nearest>> {
        let mut pixels: Vec<Option<Nearest>> = vec![None; (self.size.0 * self.size.1) as usize];
        for (triangle, corners) in self.triangles.iter().enumerate() {
            reference::for_each_exact(corners, self.size, |i, exact| {
                let depth = exact.depth.to_f64() / 65536.0;
                let pixel = &mut pixels[i];
                let second = match pixel {
                    Some(old) if old.depths[0] <= depth => {
                        old.depths[1] = old.depths[1].min(depth);
                        return;
                    }
                    Some(old) => old.depths[0],
                    None => f64::INFINITY,
                };
                *pixel = Some(Nearest { triangle, exact, depths: [depth, second] });
            });
        }
        pixels
    }

    /// The frame against the exact picture, and against llvmpipe's.
    ///
    /// # Panics
    /// If the sizes differ, or a textured frame shows a colour that is no texel.
    #[must_use]
    pub fn judge(&self, judge: Option<&mut Llvmpipe>) -> [Report; 2] {
        let nearest = self.nearest();
        let ours = Pipeline { width: self.size.0, height: self.size.1 };
        let mut by_exact = Report { triangles: self.triangles.len(), ..Report::default() };
        for (nearest, &(colour, depth)) in nearest.iter().zip(&self.pixels) {
            if !count_coverage(&mut by_exact, nearest.is_some(), depth) {
                continue;
            }
            let Some(nearest) = nearest else { continue };
            let got = Fragment { colour, depth: u32::from(depth) * 65537 };
            let rounding = ours.rounding(&self.triangles[nearest.triangle]);
            match (&self.texture, nearest.is_decided()) {
                (texture, false) => {
                    by_exact.depth_fragment(nearest.exact, got, &rounding);
                    by_exact.undecided(texture.is_some());
                }
                (None, true) => by_exact.fragment(nearest.exact, got, &rounding),
                (Some(texture), true) => {
                    by_exact.depth_fragment(nearest.exact, got, &rounding);
                    let texel = texel(texture, colour);
                    by_exact.texel(nearest.exact, texel, texture, &rounding);
                }
            }
        }
        let by_llvmpipe = judge.map(|judge| self.judge_by_llvmpipe(judge, &nearest));
        [by_exact, by_llvmpipe.unwrap_or_default()]
    }

    fn judge_by_llvmpipe(&self, judge: &mut Llvmpipe, nearest: &[Option<Nearest>]) -> Report {
        assert_eq!(judge.size(), self.size);
        judge.clear();
        judge.draw(&self.triangles, self.texture.as_ref(), true);
        let (colours, depths) = (judge.read_colours(), judge.read_depths());
        let ours = Pipeline { width: self.size.0, height: self.size.1 };
        let mut report = Report { triangles: self.triangles.len(), ..Report::default() };
        for (i, &(colour, depth)) in self.pixels.iter().enumerate() {
            let [r, g, b, alpha] = colours[i];
            if !count_coverage(&mut report, alpha != 0, depth) {
                continue;
            }
            let Some(nearest) = &nearest[i] else { continue };
            let triangle = &self.triangles[nearest.triangle];
            let roundings = [judge.rounding(triangle), ours.rounding(triangle)];
            let depth_error = f64::from((u32::from(depth) * 65537).abs_diff(depths[i])) / 65537.0;
            report.depth(depth_error, Report::is_steady(roundings[0].depth));
            if !nearest.is_decided() {
                report.undecided(self.texture.is_some());
            } else if let Some(texture) = &self.texture {
                let unsure = |rounding| at_border(&nearest.exact, texture, rounding);
                let differs = texel(texture, [r, g, b]) != texel(texture, colour);
                report.texel_verdict(differs, roundings.iter().any(unsure));
            } else {
                let error = [r, g, b].iter().zip(colour).map(|(a, b)| a.abs_diff(b)).max();
                let error = error.unwrap_or(0).into();
                report.colour(error, Report::is_steady(roundings[0].colour));
            }
        }
        report
    }
}

impl Nearest {
    /// True where rounding cannot change which triangle is the nearest.
    fn is_decided(&self) -> bool {
        self.depths[1] - self.depths[0] > 2.0
    }
}

/// Counts a pixel; true when both cover it.
fn count_coverage(report: &mut Report, expected: bool, depth: u16) -> bool {
    let drawn = depth != u16::MAX;
    report.pixels += usize::from(expected);
    report.coverage_differs += usize::from(expected != drawn);
    expected && drawn
}

fn texel(texture: &Texture, colour: [u8; 3]) -> Texel {
    texture.texel(colour).unwrap_or_else(|| panic!("{colour:?} is no texel"))
}
