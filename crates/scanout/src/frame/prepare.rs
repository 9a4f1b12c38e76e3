//! Preparing: transform and light every vertex once, list what can be seen.

use core::ops::Range;

use super::{
    BACK, CLIPPED, Frame, Kind, MAX_SIDE, Needed, ObjectState, PrepareError, Primitive, Settings,
};
use super::{Stats, Store, Traversal, UNSEEN};
use crate::avx2::{Avx2, EIGHT, Seen};
use crate::clip::{self, Corner};
use crate::cull::{Facing, facing, facing_in_clip_space, sphere_outside};
use crate::features;
use crate::light::{Lighting, MAX_LIGHTS, plainly_lit};
use crate::math::normalise_q14;
use crate::mesh::{Mesh, Normals};
use crate::scene::{Background, Light, Mode, Object, Scene};
use crate::setup::{first_pixel, signed_area};
use crate::shade::{FogWeights, modulate};
use crate::texture::{Repeat565, RepeatPalette, Texture};
use crate::transform::{CLIP, ClipMatrix, FAR, NEAR, Vertex, Viewport};

/// The most primitives that an object can make.
pub(super) fn most_primitives(object: &Object) -> usize {
    let mesh = object.mesh;
    match object.mode {
        Mode::Points => mesh.positions.len(),
        Mode::Wire => mesh.edges.len(),
        Mode::Hidden => mesh.triangles.len() + mesh.edges.len(),
        Mode::Flat | Mode::Gouraud | Mode::Phong => mesh.triangles.len(),
    }
}

/// The surface's own colour at a position.
#[inline]
pub(super) fn surface_colour(object: &Object, position: u16) -> [u8; 3] {
    match object.mesh.colours.get(position as usize) {
        Some(&c) => modulate(c, object.material.colour),
        None => object.material.colour,
    }
}

/// The unit normal of a triangle from its corners, Q2.14; zero without area. The cross product (35 bits) is cut to 31
/// bits before it is normalised.
pub(super) fn geometric_normal(mesh: &Mesh, triangle: [u16; 3]) -> [i16; 3] {
    let [a, b, c] = triangle.map(|i| mesh.positions[i as usize].map(i64::from));
    let (d, e) = ([0, 1, 2].map(|i| b[i] - a[i]), [0, 1, 2].map(|i| c[i] - a[i]));
    let cross = [d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2], d[0] * e[1] - d[1] * e[0]];
    let size = cross.iter().fold(0, |bits, v| bits | v.unsigned_abs());
    let drop = (64 - size.leading_zeros()).saturating_sub(31);
    normalise_q14(cross.map(|v| (v >> drop) as i32)).map(|v| v as i16)
}

impl<'a> Frame<'a> {
    /// Prepares a scene: transforms, lights and culls into the caller's memory.
    ///
    /// # Errors
    /// As [`PrepareError`] lists; a store that is too small is told how much is needed, and nothing is drawn with
    /// less.
    pub fn prepare(
        scene: &'a Scene<'a>,
        settings: Settings,
        store: Store<'a>,
    ) -> Result<Frame<'a>, PrepareError> {
        check(scene, &settings)?;
        let given = Needed {
            vertices: store.vertices.len(),
            primitives: store.primitives.len(),
            objects: store.objects.len(),
        };
        if given.objects < scene.objects.len() {
            return Err(PrepareError::Store { needed: Needed::at_most(scene), given });
        }
        let Store { vertices, primitives, objects } = store;
        let avx2 = if settings.traversal == Traversal::Spans { Avx2::detect() } else { None };
        let world_to_clip = scene.camera.projection.mul(&scene.camera.view);
        let mut list = List { primitives, len: 0, stats: Stats::default() };
        let mut vertices_needed = 0;
        // First how many vertices are needed, so that the error can name it.
        for (state, object) in objects.iter_mut().zip(scene.objects) {
            let clip = ClipMatrix::new(&world_to_clip.mul(&object.transform));
            let seen = !object.mesh.bounds.is_some_and(|sphere| sphere_outside(&clip, &sphere));
            let first_vertex = if seen { vertices_needed as u32 } else { UNSEEN };
            *state = ObjectState { first_vertex, clip };
            if seen {
                vertices_needed += object.mesh.positions.len();
            }
        }
        if given.vertices < vertices_needed {
            let needed = Needed { vertices: vertices_needed, ..Needed::at_most(scene) };
            return Err(PrepareError::Store { needed, given });
        }
        for (index, object) in scene.objects.iter().enumerate() {
            let state = objects[index];
            if state.first_vertex == UNSEEN {
                list.stats.objects_culled += 1;
                continue;
            }
            let first = state.first_vertex as usize;
            let own = &mut vertices[first..first + object.mesh.positions.len()];
            ObjectPass {
                scene,
                settings: &settings,
                viewport: Viewport::new(settings.width, settings.height),
                object,
                index,
                clip: &state.clip,
                avx2,
                whole: match (object.mode, object.mesh.normals) {
                    (Mode::Flat, _) => true,
                    (Mode::Gouraud, normals) => !matches!(normals, Normals::Vertex(_)),
                    _ => false,
                },
            }
            .run(own, &mut list)?;
        }
        let List { primitives, len, mut stats } = list;
        if len > primitives.len() {
            let needed =
                Needed { vertices: vertices_needed, primitives: len, objects: scene.objects.len() };
            return Err(PrepareError::Store { needed, given });
        }
        stats.vertices = vertices_needed as u32;
        stats.primitives = len as u32;
        Ok(Frame {
            scene,
            settings,
            vertices: &vertices[..vertices_needed],
            primitives: &primitives[..len],
            objects: &objects[..scene.objects.len()],
            fog: scene.fog.as_ref().filter(|_| features::FOG).map(FogWeights::new),
            stats,
        })
    }
}

/// Checks everything that drawing relies on, so that drawing cannot fail.
fn check(scene: &Scene, settings: &Settings) -> Result<(), PrepareError> {
    let (width, height) = (settings.width, settings.height);
    if width == 0 || height == 0 || width > MAX_SIDE || height > MAX_SIDE {
        return Err(PrepareError::Size { width, height });
    }
    if scene.lights.len() > MAX_LIGHTS {
        return Err(PrepareError::Lights(scene.lights.len()));
    }
    if scene.objects.len() > 1 << 16 {
        return Err(PrepareError::Objects(scene.objects.len()));
    }
    if let Background::Image(pixels) = scene.background {
        let needed = width as usize * height as usize;
        if pixels.len() != needed {
            return Err(PrepareError::Background { needed, given: pixels.len() });
        }
    }
    for (index, object) in scene.objects.iter().enumerate() {
        let mesh = object.mesh;
        let parallel = |len: usize, with: usize| len == 0 || len == with;
        let normals_fit = match mesh.normals {
            Normals::None => true,
            Normals::Vertex(n) => n.len() == mesh.positions.len(),
            Normals::Face(n) => n.len() == mesh.triangles.len(),
        };
        if !normals_fit
            || !parallel(mesh.colours.len(), mesh.positions.len())
            || !parallel(mesh.uv_triangles.len(), mesh.triangles.len())
        {
            return Err(PrepareError::Lengths { object: index });
        }
        // The greatest first, which is quick; then, where that is too great, whose it is.
        let most = mesh.uv_triangles.as_flattened().iter().fold(0, |most, &t| t.max(most));
        if most as usize >= mesh.uvs.len() && !mesh.uv_triangles.is_empty() {
            let beyond = |uvs: &[u16; 3]| uvs.iter().any(|&t| t as usize >= mesh.uvs.len());
            let element = mesh.uv_triangles.iter().position(beyond).unwrap_or(0);
            return Err(PrepareError::Index { object: index, element });
        }
        if let Some(texture) = object.material.texture {
            texture.check().map_err(|error| PrepareError::Texture { object: index, error })?;
        }
    }
    compiled_in(scene, settings)
}

/// Checks that nothing is asked for that the features leave out.
fn compiled_in(scene: &Scene, settings: &Settings) -> Result<(), PrepareError> {
    let refuse = |object, feature| Err(PrepareError::Feature { object, feature });
    if !features::DITHER && settings.dither {
        return refuse(None, "dither");
    }
    if !features::FOG && scene.fog.is_some() {
        return refuse(None, "fog");
    }
    if !features::BACKGROUND_IMAGES && matches!(scene.background, Background::Image(_)) {
        return refuse(None, "background-images");
    }
    if !features::ALL_LIGHTS && !scene.lights.iter().all(Light::is_plain) {
        return refuse(None, "all-lights");
    }
    for (index, object) in scene.objects.iter().enumerate() {
        let mode = match object.mode {
            Mode::Points if !features::POINTS => Some("points"),
            Mode::Wire | Mode::Hidden if !features::LINES => Some("lines"),
            Mode::Wire | Mode::Hidden if !features::SMOOTH_LINES && object.smooth_lines => {
                Some("smooth-lines")
            }
            Mode::Gouraud if !features::GOURAUD => Some("gouraud"),
            Mode::Phong if !features::PHONG => Some("phong"),
            _ => None,
        };
        let filled = matches!(object.mode, Mode::Flat | Mode::Gouraud | Mode::Phong);
        let (material, mesh) = (object.material, object.mesh);
        let feature = mode.or(if !features::TWO_SIDED && material.two_sided {
            Some("two-sided")
        } else if !features::VERTEX_COLOURS && !mesh.colours.is_empty() {
            Some("vertex-colours")
        } else if !features::ALL_LIGHTS && filled && !plainly_lit(scene, object) {
            Some("all-lights")
        } else if filled && !mesh.uv_triangles.is_empty() {
            material.texture.and_then(left_out)
        } else {
            None
        });
        if let Some(feature) = feature {
            return refuse(Some(index), feature);
        }
    }
    Ok(())
}

/// The feature that a texture needs and that is not there.
fn left_out(texture: &Texture) -> Option<&'static str> {
    if features::ALL_TEXTURES || Repeat565::new(texture).is_some() {
        return None;
    }
    match RepeatPalette::new(texture) {
        Some(_) if features::PALETTE_TEXTURES => None,
        Some(_) => Some("palette-textures"),
        None => Some("all-textures"),
    }
}

/// The primitives so far; counts on when the memory is full.
struct List<'a> {
    primitives: &'a mut [Primitive],
    len: usize,
    stats: Stats,
}

impl List<'_> {
    #[inline]
    fn push(&mut self, primitive: Primitive) {
        if let Some(slot) = self.primitives.get_mut(self.len) {
            *slot = primitive;
        }
        self.len += 1;
    }
}

/// The top bit of a projected vertex's `inv_w`, which is always set; cleared it marks a vertex that must be lit.
const UNMARKED: u32 = 1 << 31;

/// Marks a triangle's vertices to be lit.
#[inline]
fn mark(vertices: &mut [Vertex], triangle: [u16; 3]) {
    for i in triangle {
        vertices[i as usize].inv_w &= !UNMARKED;
    }
}

/// One object on its way through the first stages.
struct ObjectPass<'a> {
    scene: &'a Scene<'a>,
    settings: &'a Settings,
    viewport: Viewport,
    object: &'a Object<'a>,
    index: usize,
    clip: &'a ClipMatrix,
    avx2: Option<Avx2>,
    /// Triangles are lit as a whole.
    whole: bool,
}

impl ObjectPass<'_> {
    fn run(&self, vertices: &mut [Vertex], list: &mut List) -> Result<(), PrepareError> {
        let lighting = lighting(self.scene, self.object);
        self.transform(vertices);
        match self.object.mode {
            Mode::Points if features::POINTS => self.points(vertices, list),
            Mode::Wire if features::LINES => self.edges(vertices, list)?,
            Mode::Hidden if features::LINES => {
                self.triangles(vertices, &lighting, Kind::Mask, list)?;
                self.edges(vertices, list)?;
            }
            _ => {
                self.triangles(vertices, &lighting, Kind::Triangle, list)?;
                if let Some(normals) = self.vertex_normals() {
                    self.light(vertices, normals, &lighting);
                }
            }
        }
        Ok(())
    }

    /// Transform: positions to screen vertices.
    fn transform(&self, vertices: &mut [Vertex]) {
        let mesh = self.object.mesh;
        let rgb = self.object.material.colour;
        if let Some(avx2) = self.avx2 {
            avx2.project(&self.viewport, self.clip, mesh.positions, rgb, vertices);
        } else {
            for (vertex, &position) in vertices.iter_mut().zip(mesh.positions) {
                *vertex = Vertex { rgb, ..self.viewport.project(&self.clip.apply(position)) };
            }
        }
        if !features::VERTEX_COLOURS {
            return;
        }
        for (vertex, &colour) in vertices.iter_mut().zip(mesh.colours) {
            vertex.rgb = modulate(colour, self.object.material.colour);
        }
    }

    /// Back faces are dropped.
    fn one_sided(&self) -> bool {
        !features::TWO_SIDED || !self.object.material.two_sided
    }

    /// The normals by which vertices are lit, where they are.
    fn vertex_normals(&self) -> Option<&[[i16; 3]]> {
        match (self.object.mode, self.object.mesh.normals) {
            (Mode::Gouraud, Normals::Vertex(normals)) if features::GOURAUD => Some(normals),
            _ => None,
        }
    }

    /// Light: the vertices that [`mark`] has marked, and those that could not be projected.
    fn light(&self, vertices: &mut [Vertex], normals: &[[i16; 3]], lighting: &Lighting) {
        for ((vertex, &normal), &position) in
            vertices.iter_mut().zip(normals).zip(self.object.mesh.positions)
        {
            if vertex.inv_w & UNMARKED == 0 {
                vertex.inv_w |= UNMARKED;
                vertex.rgb = lighting.lit_in_mesh(vertex.rgb, normal, position);
            }
        }
    }

    /// Cull: triangles that can be seen.
    fn triangles(
        &self,
        vertices: &mut [Vertex],
        lighting: &Lighting,
        kind: Kind,
        list: &mut List,
    ) -> Result<(), PrepareError> {
        let triangles = self.object.mesh.triangles;
        list.stats.triangles += triangles.len() as u32;
        let Some(avx2) = self.avx2 else {
            return self.one_by_one(0..triangles.len(), vertices, lighting, kind, list);
        };
        let one_sided = self.one_sided();
        let lit_later = self.vertex_normals().is_some();
        let size = [self.settings.width as i32, self.settings.height as i32];
        let (groups, _) = triangles.as_chunks::<EIGHT>();
        let (mut next, mut seen) = (0, Seen::default());
        while next < groups.len() {
            let found = avx2.facing(&groups[next..], vertices, size, one_sided, &mut seen);
            list.stats.back_facing += seen.turned;
            list.stats.outside += seen.outside;
            let Some(passed) = found else { break };
            let first = (next + passed) * EIGHT;
            next += passed + 1;
            if !seen.plain {
                self.one_by_one(first..first + EIGHT, vertices, lighting, kind, list)?;
                continue;
            }
            let mut rest = seen.kept;
            while rest != 0 {
                let k = rest.trailing_zeros() as usize & (EIGHT - 1);
                rest &= rest - 1;
                let rows = (seen.top[k] as i16, seen.bottom[k] as i16);
                let facing = if seen.back >> k & 1 == 0 { Facing::Front } else { Facing::Back };
                self.keep(first + k, kind as u8, rows, facing, lighting, list);
                if lit_later {
                    mark(vertices, triangles[first + k]);
                }
            }
        }
        self.one_by_one(groups.len() * EIGHT..triangles.len(), vertices, lighting, kind, list)
    }

    /// The same, one after another. Most are dropped here, so this loop holds nothing but the tests.
    #[inline(never)]
    fn one_by_one(
        &self,
        range: Range<usize>,
        vertices: &mut [Vertex],
        lighting: &Lighting,
        kind: Kind,
        list: &mut List,
    ) -> Result<(), PrepareError> {
        let one_sided = self.one_sided();
        let lit_later = self.vertex_normals().is_some();
        let mut back_facing = 0;
        for (i, &triangle) in range.clone().zip(&self.object.mesh.triangles[range]) {
            let [a, b, c] = triangle.map(usize::from);
            let (Some(a), Some(b), Some(c)) = (vertices.get(a), vertices.get(b), vertices.get(c))
            else {
                return Err(PrepareError::Index { object: self.index, element: i });
            };
            if (a.flags | b.flags | c.flags) & CLIP != 0 {
                self.keep_clipped(i, a.flags & b.flags & c.flags, kind, lighting, list);
                if lit_later {
                    mark(vertices, triangle);
                }
                continue;
            }
            let area = signed_area(&[[a.x, a.y], [b.x, b.y], [c.x, c.y]]);
            if area == 0 || (area > 0 && one_sided) {
                back_facing += 1;
                continue;
            }
            let low = [a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y)];
            let high = [a.x.max(b.x).max(c.x), a.y.max(b.y).max(c.y)];
            match self.rows(low, high) {
                Some(rows) => {
                    self.keep(i, kind as u8, rows, facing(area), lighting, list);
                    if lit_later {
                        mark(vertices, triangle);
                    }
                }
                None => list.stats.outside += 1,
            }
        }
        list.stats.back_facing += back_facing;
        Ok(())
    }

    /// The same tests for a triangle that the clip stage must cut; `all` are the flags that its corners share.
    #[inline(never)]
    fn keep_clipped(
        &self,
        index: usize,
        all: u8,
        kind: Kind,
        lighting: &Lighting,
        list: &mut List,
    ) {
        let mesh = self.object.mesh;
        let triangle = mesh.triangles[index];
        if all & (NEAR | FAR) != 0 {
            list.stats.outside += 1;
            return;
        }
        let corners = triangle.map(|c| self.clip.apply_one(mesh.positions[c as usize]));
        let facing = facing_in_clip_space(&corners);
        if facing == Facing::Edge || (facing == Facing::Back && self.one_sided()) {
            list.stats.back_facing += 1;
            return;
        }
        let Some(rows) = self.clipped_rows(triangle) else {
            list.stats.outside += 1;
            return;
        };
        list.stats.clipped += 1;
        self.keep(index, kind as u8 | CLIPPED, rows, facing, lighting, list);
    }

    /// Lists a triangle, lit if it is lit as a whole.
    #[inline]
    fn keep(
        &self,
        index: usize,
        tag: u8,
        (top, bottom): (i16, i16),
        facing: Facing,
        lighting: &Lighting,
        list: &mut List,
    ) {
        let back = facing == Facing::Back;
        let rgb = if self.whole { self.face_colour(index, back, lighting) } else { [0; 3] };
        let tag = tag | if back { BACK } else { 0 };
        let object = self.index as u16;
        list.push(Primitive { index: index as u32, top, bottom, object, rgb, tag });
    }

    /// The colour of a triangle that is lit as a whole: the mean of its corners' colours, lit at their centre.
    #[inline(never)]
    fn face_colour(&self, index: usize, back: bool, lighting: &Lighting) -> [u8; 3] {
        let mesh = self.object.mesh;
        let triangle = mesh.triangles[index];
        let normal = match mesh.normals {
            Normals::Face(normals) => normals[index],
            _ => geometric_normal(mesh, triangle),
        };
        let normal = if back { normal.map(|v| v.saturating_neg()) } else { normal };
        let mut colour = self.object.material.colour;
        if features::VERTEX_COLOURS && !mesh.colours.is_empty() {
            let colours = triangle.map(|c| surface_colour(self.object, c));
            colour = [0, 1, 2].map(|k| {
                let sum: u32 = colours.iter().map(|c| c[k] as u32).sum();
                ((sum + 1) / 3) as u8
            });
        }
        let mut centre = [0; 3];
        if lighting.needs_position() {
            let corners = triangle.map(|c| mesh.positions[c as usize]);
            centre = [0, 1, 2].map(|k| {
                let sum: i32 = corners.iter().map(|c| c[k] as i32).sum();
                sum.div_euclid(3) as i16
            });
        }
        lighting.lit_in_mesh(colour, normal, centre)
    }

    /// Edges with both ends in the frame are listed in runs of neighbours: `index` is the first, `rgb[0]` how many more
    /// there are.
    fn edges(&self, vertices: &[Vertex], list: &mut List) -> Result<(), PrepareError> {
        const LONGEST: usize = 32;
        let (width, height) = (self.settings.width as u32 * 16, self.settings.height as u32 * 16);
        let inside =
            |v: &Vertex| v.flags & CLIP == 0 && (v.x as u32) < width && (v.y as u32) < height;
        for (k, edges) in self.object.mesh.edges.chunks(LONGEST).enumerate() {
            let mut first = k * LONGEST;
            if let (Some(avx2), (groups, [])) = (self.avx2, edges.as_chunks::<EIGHT>())
                && let Some((high, low)) = avx2.heights(groups, vertices, [width, height])
            {
                self.edge_run(first, edges.len(), high, low, list);
                continue;
            }
            // The run's length, its highest and its lowest end.
            let (mut length, mut high, mut low) = (0, i32::MAX, 0);
            for (i, edge) in (k * LONGEST..).zip(edges) {
                let [Some(a), Some(b)] = edge.map(|c| vertices.get(c as usize)) else {
                    return Err(PrepareError::Index { object: self.index, element: i });
                };
                if inside(a) && inside(b) {
                    (length, high, low) =
                        (length + 1, high.min(a.y).min(b.y), low.max(a.y).max(b.y));
                    continue;
                }
                self.edge_run(first, length, high, low, list);
                (first, length, high, low) = (i + 1, 0, i32::MAX, 0);
                self.edge(i, [a, b], list);
            }
            self.edge_run(first, length, high, low, list);
        }
        Ok(())
    }

    /// Lists a run of edges between two heights, none when it is empty.
    fn edge_run(&self, first: usize, length: usize, high: i32, low: i32, list: &mut List) {
        let [a, b] = [high, low].map(|y| Vertex { y, ..Vertex::default() });
        if length > 0
            && let Some((top, bottom)) = self.line_rows(&a, &b, 2)
        {
            list.push(Primitive {
                index: first as u32,
                top,
                bottom,
                object: self.index as u16,
                rgb: [length as u8 - 1, 0, 0],
                tag: Kind::Edge as u8,
            });
        }
    }

    /// Lists an edge that leaves the frame or must be clipped, if it can be seen.
    #[inline(never)]
    fn edge(&self, index: usize, [a, b]: [&Vertex; 2], list: &mut List) {
        let edge = self.object.mesh.edges[index];
        let mut rows = None;
        let clipped = (a.flags | b.flags) & CLIP != 0;
        if a.flags & b.flags & (NEAR | FAR) == 0 {
            let ends = if clipped {
                clip::line(self.corner(edge[0]), self.corner(edge[1]))
                    .map(|ends| ends.map(|c| self.viewport.project_one(&c.clip)))
            } else {
                Some([*a, *b])
            };
            // An anti-aliased line reaches one pixel to each side.
            rows = ends.and_then(|[a, b]| self.line_rows(&a, &b, 2));
        }
        let Some((top, bottom)) = rows else {
            list.stats.outside += 1;
            return;
        };
        list.stats.clipped += clipped as u32;
        let tag = Kind::Edge as u8 | if clipped { CLIPPED } else { 0 };
        let object = self.index as u16;
        list.push(Primitive { index: index as u32, top, bottom, object, rgb: [0; 3], tag });
    }

    fn points(&self, vertices: &[Vertex], list: &mut List) {
        for (i, v) in vertices.iter().enumerate() {
            let reach = self.object.point_size as i32;
            let rows = if v.flags & CLIP != 0 { None } else { self.line_rows(v, v, reach) };
            let Some((top, bottom)) = rows else {
                list.stats.outside += 1;
                continue;
            };
            let (tag, object) = (Kind::Point as u8, self.index as u16);
            list.push(Primitive { index: i as u32, top, bottom, object, rgb: [0; 3], tag });
        }
    }

    fn corner(&self, index: u16) -> Corner {
        let clip = self.clip.apply_one(self.object.mesh.positions[index as usize]);
        Corner { clip, ..Corner::default() }
    }

    /// Rows of the frame that a clipped triangle may touch.
    fn clipped_rows(&self, triangle: [u16; 3]) -> Option<(i16, i16)> {
        let polygon = clip::triangle(triangle.map(|c| self.corner(c)));
        let corners = polygon.corners();
        if corners.is_empty() {
            return None;
        }
        let (mut low, mut high) = ([i32::MAX; 2], [i32::MIN; 2]);
        for corner in corners {
            let v = self.viewport.project_one(&corner.clip);
            low = [low[0].min(v.x), low[1].min(v.y)];
            high = [high[0].max(v.x), high[1].max(v.y)];
        }
        self.rows(low, high)
    }

    /// Rows of the frame with pixel centres in a box (Q28.4); `None` when the box holds no centre.
    #[inline(always)]
    fn rows(&self, low: [i32; 2], high: [i32; 2]) -> Option<(i16, i16)> {
        let (width, height) = (self.settings.width as i32, self.settings.height as i32);
        let (x0, x1) = (first_pixel(low[0]).max(0), first_pixel(high[0]).min(width));
        let (y0, y1) = (first_pixel(low[1]).max(0), first_pixel(high[1]).min(height));
        (x0 < x1 && y0 < y1).then_some((y0 as i16, y1 as i16))
    }

    /// Rows of the frame that a line or point may touch, `reach` pixels to each side.
    fn line_rows(&self, a: &Vertex, b: &Vertex, reach: i32) -> Option<(i16, i16)> {
        let (width, height) = (self.settings.width as i32, self.settings.height as i32);
        let x0 = (a.x.min(b.x) >> 4) - reach;
        let x1 = (a.x.max(b.x) >> 4) + reach;
        let y0 = ((a.y.min(b.y) >> 4) - reach).max(0);
        let y1 = ((a.y.max(b.y) >> 4) + reach + 1).min(height);
        (x0 < width && x1 >= 0 && y0 < y1).then_some((y0 as i16, y1 as i16))
    }
}

/// The lights as an object sees them.
pub(super) fn lighting(scene: &Scene, object: &Object) -> Lighting {
    Lighting::new(
        scene.lights,
        scene.light_floor,
        &scene.camera.viewpoint,
        object.material,
        &object.transform,
    )
}
