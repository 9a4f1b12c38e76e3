//! Models and options to a [`Scene`].
//!
//! [`Stage::load`] reads everything that lasts (models, textures, the picture behind); [`Stage::with_scenes`] puts it
//! before the cameras of one frame. The pipeline's world is the file's, moved and scaled by the view's
//! [`World`], so that models in micrometres and in kilometres use the same bits.

mod material;
pub mod placed;
pub mod vector;
pub mod view;

use std::io::Read;
use std::path::{Path, PathBuf};

use scanout::math::{Angle, Mat4, Quat, Vec3};
use scanout::mesh::Mesh;
use scanout::scene::{Background, Fog, Light, LightKind, Material, Mode, Object, Scene};
use scanout::texture::Texture;
use scanout_assets::{Format, Image, LoadOptions, MeshBuf, Model, Part};

use self::vector::{along, length, minus, normalised};
use self::view::{Fit, Subject, View, World};
use crate::args::{DrawMode, InputFormat, SceneArgs, TextureFilter};
use crate::compare;
use crate::error::{Error, Result};
use crate::image_out::{Picture, is_dash};
use crate::narrate;
use crate::values::{Backdrop, LightAt};

pub use material::Surface;

/// Everything that lasts from frame to frame.
pub struct Stage {
    /// The models.
    pub models: Vec<Model>,
    /// A picture that replaces the models' textures.
    texture: Option<Image>,
    /// A picture behind the models, in its own size.
    backdrop: Option<Picture>,
    /// What the camera must see.
    pub subject: Subject,
    /// How surfaces are drawn.
    mode: DrawMode,
    /// The user chose the mode, so that it is no other for parts that it shows nothing of.
    chosen: bool,
    /// What the next pictures do without.
    pub without: Option<Without>,
    surface: Surface,
    colour: [u8; 3],
}

/// What a picture can do without, to find out what hides the models.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Without {
    /// The models.
    Objects,
    /// Culling of back faces.
    Culling,
    /// Fog.
    Fog,
}

/// What changes from frame to frame.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The camera on its way.
    pub view: View,
    /// Turn of the models about [`View::turn_axis`] through the subject's middle, degrees.
    pub turn: f64,
    /// Size of the frame, pixels.
    pub size: (u16, u16),
}

/// Reads a model from a file or standard input.
pub fn load_model(path: &Path, format: Option<InputFormat>) -> Result<Model> {
    let options = LoadOptions::default();
    let format = format.map(|format| match format {
        InputFormat::Obj => Format::Obj,
        InputFormat::Stl => Format::Stl,
        InputFormat::Ply => Format::Ply,
        InputFormat::Gltf | InputFormat::Glb => Format::Gltf,
    });
    let loaded = if is_dash(path) {
        let name = Path::new("standard input");
        let bytes = slurp(std::io::stdin().lock(), &options).map_err(|e| Error::io(name, &e))?;
        scanout_assets::load_bytes(&bytes, format, "standard input", None, &options)
    } else if format.is_some() {
        let file = std::fs::File::open(path).and_then(|file| slurp(file, &options));
        let bytes = file.map_err(|error| Error::io(path, &error))?;
        let name = path.display().to_string();
        scanout_assets::load_bytes(&bytes, format, &name, path.parent(), &options)
    } else {
        scanout_assets::load(path, &options)
    };
    let model = loaded.map_err(|error| Error::Failed(error.to_string()))?;
    for warning in &model.warnings {
        narrate!("scanout: {warning}");
    }
    Ok(model)
}

/// Everything, but no more than one byte above the limit, so that the loader can complain.
fn slurp(from: impl Read, options: &LoadOptions) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(options.limits.file_bytes + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

impl Stage {
    /// Reads the models and pictures that the options name.
    pub fn load(args: &SceneArgs) -> Result<Self> {
        if args.models.iter().filter(|path| is_dash(path)).count() > 1 {
            return Err(Error::usage("standard input can be read once", "give one -"));
        }
        let read = |path: &PathBuf| load_model(path, args.input_format);
        let models = args.models.iter().map(read).collect::<Result<_>>()?;
        let stage = Self::with_models(models, args)?;
        if !stage.has_triangles() && args.mode.is_none() {
            narrate!("scanout: the model has no faces, so it is drawn as {}", stage.mode.name());
        }
        Ok(stage)
    }

    /// A stage for models that are already there.
    pub fn with_models(mut models: Vec<Model>, args: &SceneArgs) -> Result<Self> {
        let mips = args.texture_filter.is_none_or(|filter| filter == TextureFilter::Mipmap);
        let texture = args.texture.as_deref().map(load_texture).transpose()?;
        let texture = texture.map(|image| if mips { image.with_mips() } else { image });
        if mips {
            for image in models.iter_mut().flat_map(|model| &mut model.images) {
                let empty = Image { rgb: Vec::new(), name: String::new(), ..*image };
                *image = std::mem::replace(image, empty).with_mips();
            }
        }
        let parts = || models.iter().flat_map(|model| &model.parts);
        if texture.is_some() && parts().all(|part| part.mesh.uvs.is_empty()) {
            narrate!("scanout: --texture shows nothing: the model has no texture coordinates");
        }
        let (colour, backdrop) = match args.picture.backdrop() {
            Backdrop::Colour(rgb) => (rgb, None),
            Backdrop::Image(path) => ([0; 3], Some(load_backdrop(&path)?)),
        };
        let own = match (any(&models, |mesh| !mesh.triangles.is_empty()), any(&models, has_edges)) {
            (true, _) => DrawMode::default(),
            (false, true) => DrawMode::Wire,
            (false, false) => DrawMode::Points,
        };
        Ok(Self {
            subject: subject(&models)?,
            texture,
            backdrop,
            mode: args.mode.unwrap_or(own),
            chosen: args.mode.is_some(),
            without: None,
            surface: Surface::new(args),
            colour,
            models,
        })
    }

    /// How surfaces are drawn.
    pub fn mode(&self) -> DrawMode {
        self.mode
    }

    /// Draws everything this way from now on.
    pub fn set_mode(&mut self, mode: DrawMode) {
        (self.mode, self.chosen) = (mode, true);
    }

    /// Draws faces this way from now on, and what has none as lines or points.
    pub fn set_mode_of_faces(&mut self, mode: DrawMode) {
        (self.mode, self.chosen) = (mode, false);
    }

    /// Is there one colour behind the models, and no picture?
    pub fn background_is_plain(&self) -> bool {
        self.backdrop.is_none()
    }

    /// Has any model faces?
    pub fn has_triangles(&self) -> bool {
        any(&self.models, |mesh| !mesh.triangles.is_empty())
    }

    /// Has any model edges?
    pub fn has_edges(&self) -> bool {
        any(&self.models, has_edges)
    }

    /// The first shot that the options ask for, of a picture `size`.
    pub fn shot(&self, args: &SceneArgs, size: (u16, u16), fit: Fit) -> Result<Shot> {
        let fit = if args.camera.rotation_frame.is_some() { Fit::Turn } else { fit };
        let eye = match args.camera.stereo {
            Some(how) => {
                let eye = crate::stereo::eye_sizes(how, size.0, size.1)[0];
                crate::stereo::proportions(how, eye, size)
            }
            None => size,
        };
        let aspect = f64::from(eye.0.max(1)) / f64::from(eye.1.max(1));
        let view = View::new(&args.camera, &self.subject, aspect, fit)?;
        let turn = f64::from(args.camera.rotation_frame.unwrap_or(0)) * 4.0;
        Ok(Shot { view, turn, size })
    }

    /// Builds the scene of each eye and hands it over with the size of its picture.
    pub fn with_scenes<R>(
        &self,
        shot: &Shot,
        mut draw: impl FnMut(&Scene, (u16, u16)) -> Result<R>,
    ) -> Result<Vec<R>> {
        let world = shot.view.world();
        let lights = self.lights(&shot.view, &world);
        let fog = self.surface.fog.filter(|_| self.without != Some(Without::Fog));
        let fog = fog.map(|[start, end]| Fog::Linear {
            colour: self.colour,
            start: world.length(start),
            end: world.length(end),
        });
        let textures: Vec<Vec<Option<Texture>>> = self.textures();
        let materials: Vec<Vec<Material>> = self.materials(&textures);
        let meshes: Vec<Vec<Mesh>> = self
            .models
            .iter()
            .map(|model| model.parts.iter().map(|part| part.mesh.as_mesh()).collect())
            .collect();
        let mut objects = Vec::new();
        for ((model, meshes), materials) in self.models.iter().zip(&meshes).zip(&materials) {
            let transform = placed(model, &world, shot);
            let shown = if self.without == Some(Without::Objects) { &[][..] } else { &meshes[..] };
            for (mesh, material) in shown.iter().zip(materials) {
                objects.push(Object {
                    mesh,
                    material,
                    transform,
                    mode: self.pipeline_mode(mesh),
                    smooth_lines: self.surface.smooth_lines,
                    point_size: self.surface.point_size,
                });
            }
        }
        let mut results = Vec::new();
        for (camera, size) in shot.view.cameras(shot.size.0, shot.size.1)? {
            let picture = self.backdrop.as_ref().map(|p| p.stretched(size.0.into(), size.1.into()));
            let background = match &picture {
                Some(picture) => Background::Image(&picture.pixels),
                None => Background::Colour(self.colour),
            };
            let scene = Scene {
                camera,
                objects: &objects,
                lights: &lights,
                light_floor: self.surface.light_floor,
                fog,
                background,
            };
            results.push(draw(&scene, size)?);
        }
        Ok(results)
    }

    fn pipeline_mode(&self, mesh: &Mesh) -> Mode {
        let mode = match self.mode {
            mode if self.chosen || !mesh.triangles.is_empty() => mode,
            _ if !mesh.edges.is_empty() => DrawMode::Wire,
            _ => DrawMode::Points,
        };
        match mode {
            DrawMode::Points => Mode::Points,
            DrawMode::Wire => Mode::Wire,
            DrawMode::Hidden => Mode::Hidden,
            DrawMode::Flat => Mode::Flat,
            DrawMode::Gouraud | DrawMode::Textured => Mode::Gouraud,
            DrawMode::Phong => Mode::Phong,
        }
    }

    /// The lights of the options, or a strong one at the viewer's upper left and a weak one at the right.
    fn lights(&self, view: &View, world: &World) -> Vec<Light> {
        let light = |kind| Light { kind, colour: [255; 3] };
        if self.surface.lights.is_empty() {
            let [right, up, back] = view.basis;
            let from = |x, y, z| {
                let towards = along(along(back.map(|b| b * z), up, y), right, x);
                LightKind::Directional(direction(towards))
            };
            // A key light, and a weak one from the right so that its shadow side keeps its shape.
            let fill = Light { kind: from(0.8, 0.0, 0.5), colour: [72; 3] };
            return vec![light(from(-0.4, 0.6, 0.7)), fill];
        }
        let kind = |at: &LightAt| match *at {
            LightAt::Towards(towards) => LightKind::Directional(direction(towards)),
            LightAt::Point(place) => LightKind::Point(world.point(place)),
        };
        self.surface.lights.iter().map(|at| light(kind(at))).collect()
    }
}

/// A direction of length 256: finer than Q16.16 allows at length 1.
fn direction(v: [f64; 3]) -> Vec3 {
    Vec3::from_f64(normalised(v).unwrap_or([0.0, 0.0, 1.0]).map(|x| x * 256.0))
}

/// Object to world: the model's placement, then the turn about the subject's middle (the world's origin).
fn placed(model: &Model, world: &World, shot: &Shot) -> Mat4 {
    let scale = model.placement.scale * world.scale;
    let [x, y, z] = minus(model.placement.offset, world.origin).map(|v| v * world.scale);
    let place = Mat4::from_f64([
        [scale, 0.0, 0.0, x],
        [0.0, scale, 0.0, y],
        [0.0, 0.0, scale, z],
        [0.0, 0.0, 0.0, 1.0],
    ]);
    let turn =
        Quat::from_axis_angle(direction(shot.view.turn_axis), Angle::from_degrees_f64(shot.turn));
    match turn {
        Some(turn) if shot.turn != 0.0 => Mat4::rotation(&turn).mul(&place),
        _ => place,
    }
}

/// Is this so for any part of the models?
fn any(models: &[Model], so: impl Fn(&MeshBuf) -> bool) -> bool {
    models.iter().flat_map(|model| &model.parts).any(|part| so(&part.mesh))
}

fn has_edges(mesh: &MeshBuf) -> bool {
    !mesh.edges.is_empty()
}

/// The ball around all models.
fn subject(models: &[Model]) -> Result<Subject> {
    let mut points = Vec::new();
    for model in models {
        for part in &model.parts {
            points.extend(part.mesh.positions.iter().map(|p| model.placement.to_world(*p)));
        }
    }
    let [mut low, mut high] = [[f64::MAX; 3], [f64::MIN; 3]];
    for point in &points {
        low = std::array::from_fn(|i| low[i].min(point[i]));
        high = std::array::from_fn(|i| high[i].max(point[i]));
    }
    if points.is_empty() {
        return Err(Error::failed("scene", "there is nothing to draw", "give a model with faces"));
    }
    let centre = std::array::from_fn(|i| low[i] / 2.0 + high[i] / 2.0);
    let radius = points.iter().map(|p| length(minus(*p, centre))).fold(0.0, f64::max);
    let radius = if radius > 0.0 { radius } else { 1.0 };
    Ok(Subject { centre, radius, points })
}

fn load_texture(path: &Path) -> Result<Image> {
    let (image, warnings) = scanout_assets::load_image(path, &LoadOptions::default().limits)
        .map_err(|error| Error::Failed(error.to_string()))?;
    for warning in warnings {
        narrate!("scanout: {warning}");
    }
    Ok(image)
}

/// A picture behind the model: PNG and PPM in full size, others as textures are read.
fn load_backdrop(path: &Path) -> Result<Picture> {
    compare::read(path).or_else(|_| {
        let image = load_texture(path)?;
        let (width, height) = (image.width.into(), image.height.into());
        Ok(Picture { width, height, pixels: image.rgb })
    })
}

/// The borrowed halves of a scene.
impl Stage {
    /// The texture of each part.
    fn textures(&self) -> Vec<Vec<Option<Texture<'_>>>> {
        let of = |model| move |part| self.texture_of(model, part);
        self.models.iter().map(|model| model.parts.iter().map(of(model)).collect()).collect()
    }

    fn texture_of<'a>(&'a self, model: &'a Model, part: &Part) -> Option<Texture<'a>> {
        let image = match &self.texture {
            Some(image) => Some(image),
            None if self.mode != DrawMode::Textured => None,
            None => part.material.texture.and_then(|index| model.images.get(index)),
        };
        image.map(|image| self.surface.texture(image, part.material.wrap))
    }

    fn materials<'a>(&self, textures: &'a [Vec<Option<Texture<'a>>>]) -> Vec<Vec<Material<'a>>> {
        let of = |model: &Model, part: &Part, texture: &'a Option<Texture<'a>>| {
            let own = self.surface.material(&part.material, model.closed, texture.as_ref());
            Material { two_sided: own.two_sided || self.without == Some(Without::Culling), ..own }
        };
        self.models
            .iter()
            .zip(textures)
            .map(|(model, textures)| {
                model.parts.iter().zip(textures).map(|(part, t)| of(model, part, t)).collect()
            })
            .collect()
    }
}
