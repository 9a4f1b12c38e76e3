//! Drawing: the prepared primitives become the pixels of some rows.
//!
//! [`alike`] draws objects whose triangles are all made alike; what else there is goes through a [`Painter`].

mod alike;

use core::ops::Range;

use self::alike::{by_rows, shortest};
use super::fragment::{Flat, Fogged, Gouraud, Phong, Shader, Signed, Textured, Tinted};
use super::prepare::{geometric_normal, lighting, surface_colour};
use super::target::Target;
use super::{BACK, Band, BandError, CLIPPED, DrawError, Frame, Kind, Primitive};
use crate::clip::{self, Corner};
use crate::depth;
use crate::features;
use crate::interpolate::Plane;
use crate::light::Lighting;
use crate::mesh::Normals;
use crate::output::{PixelFormat, Rgb565};
use crate::raster::line::{LineEnd, walk};
use crate::raster::point::draw_point;
use crate::raster::smooth_line::{SmoothEnd, walk_smooth};
use crate::scene::{Mode, Object};
use crate::setup::Triangle;
use crate::shade::Factors;
use crate::texture::{General, Repeat565, RepeatPalette, Texture};
use crate::transform::{Vertex, Viewport, common_inverse_w};

impl<'a> Frame<'a> {
    /// Draws rows into the caller's memory: `colour` holds `F::words(width)` words a row, `depth` `width` words.
    ///
    /// # Errors
    /// When the rows are not in the frame or the memory is too small for them.
    pub fn draw_rows<F: PixelFormat>(
        &self,
        rows: Range<u16>,
        colour: &mut [F::Word],
        depth: &mut [u16],
    ) -> Result<(), BandError> {
        let width = self.settings.width as usize;
        if rows.end > self.settings.height || rows.start > rows.end {
            return Err(BandError::Rows { height: self.settings.height });
        }
        let count = rows.len();
        let needed = (count * F::words(width), count * width);
        if colour.len() < needed.0 || depth.len() < needed.1 {
            return Err(BandError::Memory { colour: needed.0, depth: needed.1 });
        }
        let mut target = Target::<F> {
            rows: rows.start as i32..rows.end as i32,
            width,
            dither: features::DITHER && self.settings.dither,
            traversal: self.settings.traversal,
            colour: &mut colour[..needed.0],
            depth: &mut depth[..needed.1],
        };
        target.clear(&self.scene.background);
        let mut lights = None;
        for list in self.lists() {
            self.draw_list(list, &mut lights, &mut target);
        }
        Ok(())
    }

    /// Draws primitives in their order, those of one object after another.
    fn draw_list<F: PixelFormat>(
        &self,
        list: &[Primitive],
        lights: &mut Option<(u16, Lighting)>,
        target: &mut Target<F>,
    ) {
        let mut rest = list;
        while let Some(first) = rest.first() {
            let same = |p: &&Primitive| p.object == first.object;
            let (run, others) = rest.split_at(rest.iter().take_while(same).count());
            rest = others;
            match self.source(first.object, target) {
                Some(source) if target.pixels().is_some() => {
                    self.draw_groups(&source, run, lights, target);
                }
                Some(source) => self.draw_plain(&source, run, lights, target),
                None if ALIKE => {}
                None => {
                    let rows = target.rows.clone();
                    for primitive in run.iter().filter(|p| p.touches(&rows)) {
                        self.draw_primitive(primitive, lights, target);
                    }
                }
            }
        }
    }

    /// [`draw_rows`](Self::draw_rows) for RGB565, compiled with this crate instead of with its caller: so a program that is
    /// optimised for size can have it fast, by its profile for the package `scanout`.
    ///
    /// # Errors
    /// As [`draw_rows`](Self::draw_rows).
    pub fn draw_rows_rgb565(
        &self,
        rows: Range<u16>,
        colour: &mut [u16],
        depth: &mut [u16],
    ) -> Result<(), BandError> {
        self.draw_rows::<Rgb565>(rows, colour, depth)
    }

    /// Draws the frame from the top in bands of `lines` lines and hands each to `sink`.
    ///
    /// # Errors
    /// When the memory is too small for `lines` lines, or what the sink returns.
    pub fn draw_bands<F: PixelFormat, E>(
        &self,
        lines: u16,
        colour: &mut [F::Word],
        depth: &mut [u16],
        mut sink: impl FnMut(Band<F>) -> Result<(), E>,
    ) -> Result<(), DrawError<E>> {
        let (width, height) = (self.settings.width, self.settings.height);
        let mut top = 0;
        while top < height {
            let bottom = height.min(top.saturating_add(lines.max(1)));
            self.draw_rows::<F>(top..bottom, colour, depth).map_err(DrawError::Band)?;
            let rows = bottom - top;
            let band = Band {
                top,
                rows,
                width,
                colour: &colour[..rows as usize * F::words(width as usize)],
                depth: &depth[..rows as usize * width as usize],
            };
            sink(band).map_err(DrawError::Sink)?;
            top = bottom;
        }
        Ok(())
    }

    /// `lights` keeps the last object's lighting where drawing needs it.
    fn draw_primitive<F: PixelFormat>(
        &self,
        primitive: &Primitive,
        lights: &mut Option<(u16, Lighting)>,
        target: &mut Target<F>,
    ) {
        let object = &self.scene.objects[primitive.object as usize];
        let state = &self.objects[primitive.object as usize];
        let late_light = (features::PHONG && object.mode == Mode::Phong)
            || (features::GOURAUD
                && features::TWO_SIDED
                && object.mode == Mode::Gouraud
                && primitive.tag & BACK != 0);
        if LATE_LIGHT
            && late_light
            && !matches!(lights, Some((owner, _)) if *owner == primitive.object)
        {
            *lights = Some((primitive.object, lighting(self.scene, object)));
        }
        let painter = Painter {
            frame: self,
            object,
            vertices: &self.vertices[state.first_vertex as usize..],
            state,
            primitive,
            lighting: lights.as_ref().map(|(_, lighting)| lighting).filter(|_| late_light),
        };
        match primitive.kind() {
            Kind::Triangle | Kind::Mask => painter.triangle(target),
            Kind::Edge if features::LINES => painter.edge(target),
            Kind::Point if features::POINTS => painter.point(target),
            Kind::Edge | Kind::Point => {}
        }
    }
}

/// Whether anything may be lit while drawing.
const LATE_LIGHT: bool = features::PHONG || (features::GOURAUD && features::TWO_SIDED);

/// Whether all triangles are made alike but those that are clipped: [`Frame::prepare`] has refused what isn't.
const ALIKE: bool = !(LATE_LIGHT
    || features::ALL_TEXTURES
    || features::PALETTE_TEXTURES
    || features::FOG
    || features::LINES
    || features::POINTS);

/// Where a triangle's corners come from: most triangles need no more than their vertices, the rest is looked up where
/// it is used.
enum Corners<'c> {
    Mesh([u16; 3]),
    Clipped(&'c [Corner; 3]),
}

/// One primitive on its way through the last stages.
struct Painter<'f> {
    frame: &'f Frame<'f>,
    object: &'f Object<'f>,
    vertices: &'f [Vertex],
    state: &'f super::ObjectState,
    primitive: &'f Primitive,
    /// Present where corners or fragments are lit while drawing.
    lighting: Option<&'f Lighting>,
}

impl<'f> Painter<'f> {
    fn triangle<F: PixelFormat>(&self, target: &mut Target<F>) {
        let triangle = self.object.mesh.triangles[self.primitive.index as usize];
        if self.primitive.tag & CLIPPED != 0 {
            return self.clipped_triangle(triangle, target);
        }
        if ALIKE {
            return;
        }
        let vertices = triangle.map(|i| &self.vertices[i as usize]);
        let Some(t) = Triangle::new(vertices.map(|v| [v.x, v.y])) else { return };
        self.paint(&t, vertices, &Corners::Mesh(triangle), target);
    }

    fn clipped_triangle<F: PixelFormat>(&self, triangle: [u16; 3], target: &mut Target<F>) {
        let settings = self.frame.settings;
        let viewport = Viewport::new(settings.width, settings.height);
        // In place: a corner is many words, and `map` moves it about.
        let mut whole = [Corner::default(); 3];
        for (k, corner) in whole.iter_mut().enumerate() {
            *corner = self.corner(k, triangle[k]);
        }
        let polygon = clip::triangle(whole);
        let corners = polygon.corners();
        for i in 2..corners.len() {
            let fan = [corners[0], corners[i - 1], corners[i]];
            let vertices =
                fan.each_ref().map(|c| Vertex { rgb: c.rgb, ..viewport.project_one(&c.clip) });
            if let Some(t) = Triangle::new(vertices.each_ref().map(|v| [v.x, v.y])) {
                self.paint(&t, vertices.each_ref(), &Corners::Clipped(&fan), target);
            }
        }
    }

    fn full(&self, corners: &Corners, k: usize) -> Corner {
        match corners {
            Corners::Mesh(triangle) => self.corner(k, triangle[k]),
            Corners::Clipped(fan) => fan[k],
        }
    }

    fn uv(&self, corners: &Corners, k: usize) -> [i32; 2] {
        match corners {
            Corners::Mesh(_) => self.mesh_uv(k),
            Corners::Clipped(fan) => fan[k].uv,
        }
    }

    fn mesh_uv(&self, k: usize) -> [i32; 2] {
        let mesh = self.object.mesh;
        let triangle = mesh.uv_triangles.get(self.primitive.index as usize);
        triangle.map_or([0; 2], |t| mesh.uvs[t[k] as usize])
    }

    /// Everything about corner `k` of the primitive's triangle, whose position has index `i`.
    fn corner(&self, k: usize, i: u16) -> Corner {
        let (mesh, index) = (self.object.mesh, self.primitive.index as usize);
        let position = mesh.positions[i as usize];
        let mut corner = Corner {
            clip: self.state.clip.apply_one(position),
            rgb: self.vertices[i as usize].rgb,
            uv: self.mesh_uv(k),
            ..Corner::default()
        };
        if LATE_LIGHT && let Some(lighting) = self.lighting {
            let normal = match mesh.normals {
                Normals::Vertex(normals) => normals[i as usize],
                Normals::Face(normals) => normals[index],
                Normals::None => geometric_normal(mesh, mesh.triangles[index]),
            };
            let back = self.primitive.tag & BACK != 0;
            let normal = if back { normal.map(|v| v.saturating_neg()) } else { normal };
            let (n, p) = lighting.local(normal, position);
            (corner.normal, corner.position) = (n, p);
            if self.object.mode != Mode::Phong {
                corner.rgb = lighting.lit(surface_colour(self.object, i), n, p);
            }
        }
        corner
    }

    /// Chooses the fragments' shader by mode, texture and fog.
    fn paint<F: PixelFormat>(
        &self,
        t: &Triangle,
        v: [&Vertex; 3],
        corners: &Corners,
        target: &mut Target<F>,
    ) {
        let z = t.plane(v.map(|v| v.z));
        if features::LINES && self.primitive.kind() == Kind::Mask {
            return target.mask(t, &z);
        }
        let smooth = matches!(self.object.mesh.normals, Normals::Vertex(_));
        match (self.object.mode, self.lighting) {
            (Mode::Phong, Some(lighting)) if features::PHONG => {
                let full = [0, 1, 2].map(|k| self.full(corners, k));
                let (q, _) = common_inverse_w(v);
                let shader = Phong {
                    surface: Gouraud::new(t, v.map(|v| v.rgb)),
                    lighting,
                    normal: Signed::new(t, full.map(|c| c.normal), q),
                    position: Signed::new(t, full.map(|c| c.position), q),
                    q: t.plane(q.map(|q| q << 8)),
                };
                self.texture(t, v, &z, corners, shader, target);
            }
            (Mode::Gouraud, Some(_)) if smooth && features::GOURAUD && features::TWO_SIDED => {
                let shader = Gouraud::new(t, [0, 1, 2].map(|k| self.full(corners, k).rgb));
                self.texture(t, v, &z, corners, shader, target);
            }
            (Mode::Gouraud, None) if smooth && features::GOURAUD => {
                self.texture(t, v, &z, corners, Gouraud::new(t, v.map(|v| v.rgb)), target);
            }
            _ => self.texture(t, v, &z, corners, Flat(self.primitive.rgb), target),
        }
    }

    fn texture<F: PixelFormat, S: Shader>(
        &self,
        t: &Triangle,
        v: [&Vertex; 3],
        z: &Plane,
        corners: &Corners,
        shader: S,
        target: &mut Target<F>,
    ) {
        match self.used_texture() {
            Some(texture) => {
                let (q, _) = common_inverse_w(v);
                let uv = [0, 1, 2].map(|k| self.uv(corners, k));
                match Repeat565::new(texture) {
                    Some(sampler) if S::CONSTANT => {
                        let rgb = shader.colour(&shader.at(0, 0));
                        let inner = Tinted { rgb, tint: Factors::new(rgb) };
                        self.plain_texture(t, v, z, (sampler, uv, q), inner, target);
                    }
                    Some(sampler) => {
                        self.plain_texture(t, v, z, (sampler, uv, q), shader, target);
                    }
                    None => self.other_texture(texture, t, v, z, (uv, q), shader, target),
                }
            }
            None => self.fog(t, v, z, shader, target),
        }
    }

    fn plain_texture<F: PixelFormat, S: Shader>(
        &self,
        t: &Triangle,
        v: [&Vertex; 3],
        z: &Plane,
        (sampler, uv, q): (Repeat565, [[i32; 2]; 3], [u32; 3]),
        shader: S,
        target: &mut Target<F>,
    ) {
        if target.walks() && !(features::FOG && self.frame.fog.is_some()) {
            by_rows(target, t, z, shader, sampler, uv, q);
        } else {
            self.fog(t, v, z, Textured::new(t, shader, sampler, uv, q), target);
        }
    }

    /// Textures that are not of the plain kind.
    #[allow(clippy::too_many_arguments)]
    fn other_texture<F: PixelFormat, S: Shader>(
        &self,
        texture: &Texture,
        t: &Triangle,
        v: [&Vertex; 3],
        z: &Plane,
        (uv, q): ([[i32; 2]; 3], [u32; 3]),
        shader: S,
        target: &mut Target<F>,
    ) {
        match RepeatPalette::new(texture) {
            Some(sampler) if features::PALETTE_TEXTURES => {
                if !target.walks() || (features::FOG && self.frame.fog.is_some()) {
                    self.fog(t, v, z, Textured::new(t, shader, sampler, uv, q), target);
                } else if S::CONSTANT {
                    let rgb = shader.colour(&shader.at(0, 0));
                    let inner = Tinted { rgb, tint: Factors::new(rgb) };
                    shortest(target, t, z, inner, sampler, uv, q);
                } else {
                    shortest(target, t, z, shader, sampler, uv, q);
                }
            }
            _ if features::ALL_TEXTURES => {
                let sampler = General(texture);
                self.fog(t, v, z, Textured::new(t, shader, sampler, uv, q), target);
            }
            _ => {}
        }
    }

    fn used_texture(&self) -> Option<&'f Texture<'f>> {
        self.object.material.texture.filter(|_| !self.object.mesh.uv_triangles.is_empty())
    }

    fn fog<F: PixelFormat, S: Shader>(
        &self,
        t: &Triangle,
        v: [&Vertex; 3],
        z: &Plane,
        shader: S,
        target: &mut Target<F>,
    ) {
        match &self.frame.fog {
            Some(fog) if features::FOG => {
                let (q, exponent) = common_inverse_w(v);
                let q = t.plane(q.map(|q| q << 8));
                // Clip units: w = 2^(54 - exponent) / q; world units: 2^(m - 32) times that.
                let shift = exponent as i32 + 9 - self.state.clip.exponent;
                target.fill(t, z, &Fogged { inner: shader, fog, q, shift });
            }
            _ => target.fill(t, z, &shader),
        }
    }

    /// A run of edges.
    fn edge<F: PixelFormat>(&self, target: &mut Target<F>) {
        let (first, more) = (self.primitive.index as usize, self.primitive.rgb[0] as usize);
        let edges = &self.object.mesh.edges[first..=first + more];
        let plain = self.object.mode != Mode::Hidden
            && !self.object.smooth_lines
            && self.object.mesh.colours.is_empty()
            && self.primitive.tag & CLIPPED == 0;
        if plain && target.draw_lines(edges, self.vertices, self.object.material.colour) {
            return;
        }
        for &edge in edges {
            self.one_edge(edge, target);
        }
    }

    fn one_edge<F: PixelFormat>(&self, edge: [u16; 2], target: &mut Target<F>) {
        let mut ends = edge.map(|i| self.vertices[i as usize]);
        if self.primitive.tag & CLIPPED != 0 {
            let settings = self.frame.settings;
            let viewport = Viewport::new(settings.width, settings.height);
            let corner = |i: u16| Corner {
                clip: self.state.clip.apply_one(self.object.mesh.positions[i as usize]),
                rgb: surface_colour(self.object, i),
                ..Corner::default()
            };
            let Some(clipped) = clip::line(corner(edge[0]), corner(edge[1])) else { return };
            ends = clipped.map(|c| Vertex { rgb: c.rgb, ..viewport.project_one(&c.clip) });
        }
        let hidden = self.object.mode == Mode::Hidden;
        let clip = target.clip_rect();
        if features::SMOOTH_LINES && self.object.smooth_lines {
            let [a, b] = ends.map(|v| SmoothEnd { x: v.x, y: v.y, z: v.z, rgb: v.rgb });
            walk_smooth(&a, &b, clip, |x, y, z, rgb, weight| {
                target.mix(x, y, hidden.then_some(z), rgb, weight)
            });
        } else {
            let [a, b] = ends.map(|v| LineEnd { x: v.x >> 4, y: v.y >> 4, z: v.z, rgb: v.rgb });
            if !hidden && a.rgb == b.rgb && target.draw_line(&a, &b) {
                return;
            }
            walk(&a, &b, clip, |x, y, z, rgb| target.plot(x, y, hidden.then_some(z), rgb));
        }
    }

    fn point<F: PixelFormat>(&self, target: &mut Target<F>) {
        let v = self.vertices[self.primitive.index as usize];
        let (size, z) = (self.object.point_size as u32, depth::round(v.z));
        draw_point(v.x >> 4, v.y >> 4, size, target.clip_rect(), |x, y| {
            target.plot(x, y, Some(z), v.rgb)
        });
    }
}
