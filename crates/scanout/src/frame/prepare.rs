//! Preparing: transform and light every vertex once, list what can be seen.

mod lines;
mod triangles;

use core::ops::Range;

use super::check::check;
use super::{Frame, Kind, Needed, ObjectState, Part, PrepareError, Primitive};
use super::{Settings, Stats, Store, Traversal, UNSEEN};
use crate::avx2::Avx2;
use crate::clip::Corner;
use crate::cull::{ClusterView, sphere_outside};
use crate::features;
use crate::light::{Lighting, PlainLight};
use crate::math::{NARROW, normalise_q14};
use crate::mesh::{Mesh, Normals};
use crate::scene::{Mode, Object, Scene};
use crate::shade::{FogWeights, modulate};
use crate::transform::{ClipMatrix, HalvedMatrix, ManyPositions, PENDING, Vertex, Viewport};

/// Edges that may become one primitive.
pub(super) const TOGETHER: usize = 32;

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

/// Back faces are dropped.
fn one_sided(object: &Object) -> bool {
    !features::TWO_SIDED || !object.material.two_sided
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
    /// Prepares a scene: transforms, lights and culls into the caller's memory. [`Preparation`](super::Preparation) is
    /// the same in parts, for several threads.
    ///
    /// # Errors
    /// As [`PrepareError`] lists; a store that is too small is told how much is needed, and nothing is drawn with
    /// less.
    pub fn prepare(
        scene: &'a Scene<'a>,
        settings: Settings,
        store: Store<'a>,
    ) -> Result<Frame<'a>, PrepareError> {
        let (outline, vertices, primitives) = Outline::new(scene, settings, store)?;
        outline.prepare(vertices, primitives)
    }
}

/// What is known of a frame before its first vertex: the scene is in order, and which objects are seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline<'a> {
    pub scene: &'a Scene<'a>,
    pub settings: Settings,
    pub objects: &'a [ObjectState],
    /// Vertices of the objects that are seen.
    pub vertices: usize,
    given: Needed,
    avx2: Option<Avx2>,
}

impl<'a> Outline<'a> {
    /// Checks the scene and looks at its objects. The store's vertices suffice; its primitives may not.
    pub fn new(
        scene: &'a Scene<'a>,
        settings: Settings,
        store: Store<'a>,
    ) -> Result<(Outline<'a>, &'a mut [Vertex], &'a mut [Primitive]), PrepareError> {
        check(scene, &settings)?;
        let given = Needed {
            vertices: store.vertices.len(),
            primitives: store.primitives.len(),
            objects: store.objects.len(),
        };
        if given.objects < scene.objects.len() {
            return Err(PrepareError::Store { needed: Needed::at_most(scene), given });
        }
        let world_to_clip = scene.camera.projection.mul(&scene.camera.view);
        let mut vertices_needed = 0;
        for (state, object) in store.objects.iter_mut().zip(scene.objects) {
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
        let outline = Outline {
            scene,
            settings,
            objects: &store.objects[..scene.objects.len()],
            vertices: vertices_needed,
            given,
            avx2: if settings.traversal == Traversal::Spans { Avx2::detect() } else { None },
        };
        Ok((outline, store.vertices, store.primitives))
    }

    /// All that follows, by one thread.
    pub fn prepare(
        &self,
        vertices: &'a mut [Vertex],
        primitives: &'a mut [Primitive],
    ) -> Result<Frame<'a>, PrepareError> {
        let mut list = List { primitives, len: 0, stats: Stats::default() };
        for index in 0..self.objects.len() {
            let Some((pass, first)) = self.pass(index) else {
                list.stats.objects_culled += 1;
                continue;
            };
            let own = &mut vertices[first..first + pass.object.mesh.positions.len()];
            pass.run(own, &mut list)?;
        }
        let List { primitives, len, mut stats } = list;
        if len > primitives.len() {
            let needed =
                Needed { vertices: self.vertices, primitives: len, objects: self.objects.len() };
            return Err(PrepareError::Store { needed, given: self.given });
        }
        stats.primitives = len as u32;
        Ok(self.frame(vertices, &primitives[..len], &[], stats))
    }

    /// One object's way through the first stages, and the index of its first vertex; `None` when it is not seen.
    #[inline]
    pub fn pass(&self, index: usize) -> Option<(ObjectPass<'a>, usize)> {
        let (state, object) = (&self.objects[index], &self.scene.objects[index]);
        let viewport = Viewport::new(self.settings.width, self.settings.height);
        let pass = ObjectPass {
            scene: self.scene,
            settings: self.settings,
            viewport,
            object,
            index,
            clip: &state.clip,
            avx2: self.avx2,
            whole: match (object.mode, object.mesh.normals) {
                (Mode::Flat, _) => true,
                (Mode::Gouraud, normals) => !matches!(normals, Normals::Vertex(_)),
                _ => false,
            },
            clusters: self.clusters(object, &state.clip, &viewport),
        };
        (state.first_vertex != UNSEEN).then_some((pass, state.first_vertex as usize))
    }

    /// Where an object's clusters are seen from, where they serve. (With AVX2, eight triangles are tested as quickly.)
    #[inline]
    fn clusters(
        &self,
        object: &Object,
        clip: &ClipMatrix,
        viewport: &Viewport,
    ) -> Option<ClusterView> {
        let filled = matches!(object.mode, Mode::Flat | Mode::Gouraud | Mode::Phong);
        let mesh = object.mesh;
        if !features::CLUSTERS
            || mesh.clusters.is_empty()
            || self.avx2.is_some()
            || !(filled && one_sided(object))
        {
            return None;
        }
        ClusterView::new(clip, viewport, mesh.bounds.as_ref()?)
    }

    /// The passes of the objects that are seen.
    pub fn passes(&self) -> impl Iterator<Item = (ObjectPass<'a>, usize)> {
        (0..self.objects.len()).filter_map(|index| self.pass(index))
    }

    /// The finished frame; `stats` lacks the vertices.
    pub fn frame(
        &self,
        vertices: &'a [Vertex],
        primitives: &'a [Primitive],
        parts: &'a [Part],
        stats: Stats,
    ) -> Frame<'a> {
        let scene = self.scene;
        Frame {
            scene,
            settings: self.settings,
            vertices: &vertices[..self.vertices],
            primitives,
            parts,
            objects: self.objects,
            fog: scene.fog.as_ref().filter(|_| features::FOG).map(FogWeights::new),
            stats: Stats { vertices: self.vertices as u32, ..stats },
        }
    }
}

/// The primitives so far; counts on when the memory is full.
#[derive(Debug)]
pub(super) struct List<'a> {
    pub primitives: &'a mut [Primitive],
    pub len: usize,
    pub stats: Stats,
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

/// An object's vertices while its triangles are culled.
pub(super) trait Transformed {
    fn vertices(&self) -> &[Vertex];
    /// Transforms those corners of some triangles that are pending.
    fn complete(&mut self, pass: &ObjectPass, triangles: &[[u16; 3]]);
    /// The triangle is kept.
    fn keep(&mut self, triangle: [u16; 3]);
}

/// Vertices that are lit already, or not at all: several threads may look at them.
impl Transformed for &[Vertex] {
    #[inline]
    fn vertices(&self) -> &[Vertex] {
        self
    }
    #[inline]
    fn complete(&mut self, _: &ObjectPass, _: &[[u16; 3]]) {}
    #[inline]
    fn keep(&mut self, _: [u16; 3]) {}
}

/// Vertices that are marked when they are needed, to be lit afterwards.
struct Marked<'v> {
    vertices: &'v mut [Vertex],
    lit_later: bool,
}

impl Transformed for Marked<'_> {
    #[inline]
    fn vertices(&self) -> &[Vertex] {
        self.vertices
    }
    #[inline]
    fn complete(&mut self, pass: &ObjectPass, triangles: &[[u16; 3]]) {
        pass.complete(self.vertices, triangles);
    }
    #[inline]
    fn keep(&mut self, triangle: [u16; 3]) {
        if self.lit_later {
            for i in triangle {
                self.vertices[i as usize].inv_w &= !UNMARKED;
            }
        }
    }
}

/// One object on its way through the first stages.
#[derive(Debug)]
pub(super) struct ObjectPass<'a> {
    scene: &'a Scene<'a>,
    settings: Settings,
    viewport: Viewport,
    pub object: &'a Object<'a>,
    index: usize,
    clip: &'a ClipMatrix,
    avx2: Option<Avx2>,
    /// Triangles are lit as a whole.
    whole: bool,
    /// Clusters are asked before triangles, and vertices wait until a triangle asks for them.
    clusters: Option<ClusterView>,
}

impl ObjectPass<'_> {
    /// The whole object. Where lighting takes long, only vertices of triangles that are kept are lit.
    fn run(&self, vertices: &mut [Vertex], list: &mut List) -> Result<(), PrepareError> {
        let lighting = self.lighting();
        if self.clusters.is_some() {
            // Marked for no light.
            for vertex in &mut *vertices {
                (vertex.inv_w, vertex.flags) = (UNMARKED, PENDING);
            }
        } else {
            self.transform(0..vertices.len(), vertices);
        }
        let normals = self.vertex_normals();
        let plain = normals.and_then(|_| self.plain(&lighting));
        if let (Some(normals), Some((avx2, light))) = (normals, plain) {
            avx2.light(&light, normals, vertices);
        }
        let lit_later = normals.is_some() && plain.is_none();
        let mut marked = Marked { vertices, lit_later };
        self.list(0..most_primitives(self.object), &mut marked, &lighting, list)?;
        if let (Some(normals), true) = (normals, lit_later) {
            self.light_marked(marked.vertices, normals, &lighting);
        }
        Ok(())
    }

    /// Transform and light: vertices of some positions.
    pub fn run_vertices(&self, positions: Range<usize>, vertices: &mut [Vertex]) {
        self.transform(positions.clone(), vertices);
        let Some(normals) = self.vertex_normals() else { return };
        let normals = &normals[positions.clone()];
        let lighting = self.lighting();
        if let Some((avx2, light)) = self.plain(&lighting) {
            return avx2.light(&light, normals, vertices);
        }
        let positions = &self.object.mesh.positions[positions];
        for ((vertex, &normal), &position) in vertices.iter_mut().zip(normals).zip(positions) {
            vertex.rgb = lighting.lit_in_mesh(vertex.rgb, normal, position);
        }
    }

    /// Cull: primitives with these numbers, which [`most_primitives`] counts; `vertices` are all of the object's.
    pub fn run_primitives(
        &self,
        numbers: Range<usize>,
        mut vertices: &[Vertex],
        list: &mut List,
    ) -> Result<(), PrepareError> {
        self.list(numbers, &mut vertices, &self.lighting(), list)
    }

    /// The lights as the object sees them.
    fn lighting(&self) -> Lighting {
        lighting(self.scene, self.object)
    }

    /// Light that eight vertices at a time can be lit by.
    fn plain(&self, lighting: &Lighting) -> Option<(Avx2, PlainLight)> {
        self.avx2.zip(lighting.plain())
    }

    /// Transform: positions to screen vertices.
    fn transform(&self, positions: Range<usize>, vertices: &mut [Vertex]) {
        let mesh = self.object.mesh;
        let rgb = &self.object.material.colour;
        let some = &mesh.positions[positions.clone()];
        if let Some(avx2) = self.avx2 {
            avx2.project(&self.viewport, self.clip, some, *rgb, vertices);
        } else {
            let halves = HalvedMatrix::new(self.clip);
            for (vertex, &position) in vertices.iter_mut().zip(some) {
                let halved = NARROW.then(|| halves.apply(position));
                let clip = halved.unwrap_or_else(|| self.clip.apply(position));
                *vertex = self.viewport.project(&clip);
                vertex.rgb = *rgb;
            }
        }
        if !features::VERTEX_COLOURS || mesh.colours.is_empty() {
            return;
        }
        for (vertex, &colour) in vertices.iter_mut().zip(&mesh.colours[positions]) {
            vertex.rgb = modulate(colour, self.object.material.colour);
        }
    }

    /// Transforms those corners of some triangles that are pending.
    #[inline(never)]
    fn complete(&self, vertices: &mut [Vertex], triangles: &[[u16; 3]]) {
        let positions = self.object.mesh.positions;
        let coloured = features::VERTEX_COLOURS && !self.object.mesh.colours.is_empty();
        let matrix = ManyPositions::new(self.clip);
        // Of one length, so that one test is enough.
        let vertices = &mut vertices[..positions.len()];
        for &i in triangles.as_flattened() {
            // One that is missing is an error when its triangle's turn comes.
            let Some(vertex) = vertices.get_mut(i as usize) else { continue };
            if vertex.flags == PENDING {
                let position = positions[i as usize];
                *vertex = self.viewport.project(&matrix.apply(position));
                vertex.rgb = self.object.material.colour;
                if coloured {
                    vertex.rgb = surface_colour(self.object, i);
                }
            }
        }
    }

    /// Cull, by the object's mode.
    fn list(
        &self,
        numbers: Range<usize>,
        vertices: &mut impl Transformed,
        lighting: &Lighting,
        list: &mut List,
    ) -> Result<(), PrepareError> {
        match self.object.mode {
            Mode::Points if features::POINTS => self.points(numbers, vertices.vertices(), list),
            Mode::Wire if features::LINES => self.edges(numbers, vertices.vertices(), list)?,
            Mode::Hidden if features::LINES => {
                let triangles = self.object.mesh.triangles.len();
                let [start, end] = [numbers.start, numbers.end].map(|n| n.min(triangles));
                self.triangles(start..end, vertices, lighting, Kind::Mask, list)?;
                let rest = numbers.start - start..numbers.end - end;
                self.edges(rest, vertices.vertices(), list)?;
            }
            _ => self.triangles(numbers, vertices, lighting, Kind::Triangle, list)?,
        }
        Ok(())
    }

    /// Back faces are dropped.
    fn one_sided(&self) -> bool {
        one_sided(self.object)
    }

    /// The normals by which vertices are lit, where they are.
    fn vertex_normals(&self) -> Option<&[[i16; 3]]> {
        match (self.object.mode, self.object.mesh.normals) {
            (Mode::Gouraud, Normals::Vertex(normals)) if features::GOURAUD => Some(normals),
            _ => None,
        }
    }

    /// Light: the vertices that are marked, and those that could not be projected.
    fn light_marked(&self, vertices: &mut [Vertex], normals: &[[i16; 3]], lighting: &Lighting) {
        for ((vertex, &normal), &position) in
            vertices.iter_mut().zip(normals).zip(self.object.mesh.positions)
        {
            if vertex.inv_w & UNMARKED == 0 {
                vertex.inv_w |= UNMARKED;
                vertex.rgb = lighting.lit_in_mesh(vertex.rgb, normal, position);
            }
        }
    }

    fn corner(&self, index: u16) -> Corner {
        let clip = self.clip.apply_one(self.object.mesh.positions[index as usize]);
        Corner { clip, ..Corner::default() }
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
