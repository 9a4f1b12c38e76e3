//! From floating-point polygons to fixed-point parts: one quantisation grid, triangles, deduplicated vertices, edges.

use crate::closed;
use crate::error::{At, LoadError, LoadErrorKind, Warnings};
use crate::load::{LoadOptions, NormalSource};
use crate::model::{Image, MeshBuf, Model, NormalsBuf, Part, Placement, Stats};
use crate::normals::{corner_normals, to_q14, unit};
use crate::raw::{NONE, Raw};
use crate::triangulate::triangulate;
use scanout::mesh::Sphere;
use scanout::mesh_clusters::clusters;
use std::collections::{HashMap, HashSet};

/// Greatest magnitude of a position: a small margin remains to 32767.
const RANGE: f64 = 32760.0;
/// Entries that 16-bit indices reach.
const INDEXED: usize = 65_536;

/// Two positions, the lesser first.
type Edge = ([i16; 3], [i16; 3]);
/// Position, normal and colour: what makes a vertex.
type VertexKey = ([i16; 3], [i16; 3], [u8; 3]);

/// Makes the model. Positions keep the file's axes and winding.
pub(crate) fn assemble(raw: Raw, file: &str, options: &LoadOptions) -> Result<Model, LoadError> {
    let cloud = raw.faces.is_empty() && raw.lines.is_empty() && raw.points.is_empty();
    if raw.positions.is_empty() {
        return Err(LoadError {
            kind: LoadErrorKind::Empty,
            file: file.into(),
            at: At::File,
            what: "no vertices found; is this the right file?".into(),
        });
    }
    let placement = place(&raw, cloud);
    let grid: Vec<[i16; 3]> = raw.positions.iter().map(|&p| quantise(p, &placement)).collect();
    let normals = corner_normals(&raw, options);
    let mut stats = Stats {
        positions: raw.positions.len() as u64,
        uvs: raw.uvs.len() as u64,
        normals: raw.normals.len() as u64,
        polygons: raw.faces.len() as u64,
        ..Stats::default()
    };
    let mut by_material: Vec<Vec<u32>> = vec![Vec::new(); raw.materials.len()];
    for (index, face) in raw.faces.iter().enumerate() {
        by_material[face.material as usize].push(index as u32);
    }
    let mut parts = Parts {
        raw: &raw,
        grid: &grid,
        seen: HashSet::new(),
        parts: Vec::new(),
        names: HashMap::new(),
        tangled: 0,
        empty: 0,
        lost: 0,
    };
    for (material, faces) in by_material.iter().enumerate() {
        parts.faces(material, faces, &normals, &mut stats);
        parts.lines_and_points(material);
    }
    if cloud {
        parts.cloud(options);
    }
    let Parts { parts, tangled, empty, lost, .. } = parts;
    drop((grid, normals));
    let (mut warnings, images) = leftovers(raw);
    warnings.counted(empty, "triangles without area were dropped");
    warnings.counted(
        lost,
        "triangles lost their area: finer than 1/65520 of the model's size; split the model into several",
    );
    warnings.counted(tangled, "polygons that cross themselves were cut as well as possible");
    stats.triangles = parts.iter().map(|p| p.mesh.triangles.len() as u64).sum();
    stats.edges = parts.iter().map(|p| p.mesh.edges.len() as u64).sum();
    if parts.is_empty() {
        return Err(LoadError {
            kind: LoadErrorKind::Empty,
            file: file.into(),
            at: At::File,
            what: "nothing to draw: every face is degenerate; check the export".into(),
        });
    }
    let closed = closed::is_closed(&parts);
    Ok(Model { parts, images, placement, closed, warnings: warnings.0, stats })
}

/// Frees the rest.
fn leftovers(raw: Raw) -> (Warnings, Vec<Image>) {
    (raw.warnings, raw.images)
}

/// The grid: the centre of the bounding box at 0, the longest half side at [`RANGE`].
fn place(raw: &Raw, cloud: bool) -> Placement {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    let mut grow = |index: u32| {
        let p = raw.positions[index as usize];
        for axis in 0..3 {
            low[axis] = low[axis].min(p[axis]);
            high[axis] = high[axis].max(p[axis]);
        }
    };
    // Positions that nothing refers to don't count: stray ones would shrink the model.
    raw.corners.iter().for_each(|c| grow(c.position));
    raw.lines.iter().for_each(|&[a, b, _]| (grow(a), grow(b)).0);
    raw.points.iter().for_each(|&[p, _]| grow(p));
    if cloud {
        (0..raw.positions.len() as u32).for_each(&mut grow);
    }
    let half = (0..3).map(|i| (high[i] - low[i]) / 2.0).fold(0.0, f64::max);
    let scale = if half > f64::MIN_POSITIVE * 1e20 { half * (32768.0 / RANGE) } else { 1.0 };
    Placement { scale, offset: std::array::from_fn(|i| low[i] / 2.0 + high[i] / 2.0) }
}

fn quantise(p: [f64; 3], placement: &Placement) -> [i16; 3] {
    std::array::from_fn(|i| {
        let q = ((p[i] - placement.offset[i]) / placement.scale * 32768.0).round();
        q.clamp(-32767.0, 32767.0) as i16
    })
}

/// True when the grid leaves no area to a triangle.
fn flat_on_grid([a, b, c]: [[i16; 3]; 3]) -> bool {
    let minus = |p: [i16; 3]| [0, 1, 2].map(|i: usize| i64::from(p[i]) - i64::from(a[i]));
    let (e, f) = (minus(b), minus(c));
    (0..3).all(|i| e[i] * f[(i + 1) % 3] == e[(i + 1) % 3] * f[i])
}

/// True for a triangle that is more than a needle: its height exceeds 1/100 of its longest side.
fn has_area([a, b, c]: [[f64; 3]; 3]) -> bool {
    let minus = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|i: usize| p[i] - q[i]);
    let (e, f, g) = (minus(b, a), minus(c, a), minus(c, b));
    let square = |v: [f64; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    let cross = [0, 1, 2].map(|i| e[i] * f[(i + 1) % 3] - e[(i + 1) % 3] * f[i]);
    // Twice the area is the longest side times its height.
    square(cross).sqrt() > square(e).max(square(f)).max(square(g)) / 100.0
}

/// Q16.16, nearest; `as` saturates.
fn quantise_uv(uv: [f64; 2]) -> [i32; 2] {
    uv.map(|x| (x * 65536.0).round() as i32)
}

struct Parts<'a> {
    raw: &'a Raw,
    grid: &'a [[i16; 3]],
    /// Edges already drawn in some part.
    seen: HashSet<Edge>,
    parts: Vec<Part>,
    /// How many parts have a name already.
    names: HashMap<String, u32>,
    tangled: u64,
    /// Triangles dropped that have no area in the file either.
    empty: u64,
    /// Triangles that have an area in the file and none on the grid.
    lost: u64,
}

#[derive(Default)]
struct Builder {
    mesh: MeshBuf,
    vertex_normals: Vec<[i16; 3]>,
    face_normals: Vec<[i16; 3]>,
    vertices: HashMap<VertexKey, u16>,
    uvs: HashMap<[i32; 2], u16>,
    /// The first vertex at a place; edges refer to it.
    places: HashMap<[i16; 3], u16>,
}

impl Builder {
    fn has_room_for(&self, corners: usize) -> bool {
        self.mesh.positions.len() + corners <= INDEXED && self.mesh.uvs.len() + corners <= INDEXED
    }

    fn vertex(&mut self, at: [i16; 3], normal: [i16; 3], colour: [u8; 3]) -> u16 {
        *self.vertices.entry((at, normal, colour)).or_insert_with(|| {
            let index = self.mesh.positions.len() as u16;
            self.mesh.positions.push(at);
            self.vertex_normals.push(normal);
            self.mesh.colours.push(colour);
            self.places.entry(at).or_insert(index);
            index
        })
    }

    fn uv(&mut self, uv: [i32; 2]) -> u16 {
        *self.uvs.entry(uv).or_insert_with(|| {
            self.mesh.uvs.push(uv);
            (self.mesh.uvs.len() - 1) as u16
        })
    }

    fn edge(&mut self, a: [i16; 3], b: [i16; 3], seen: &mut HashSet<Edge>) {
        let (Some(&i), Some(&j)) = (self.places.get(&a), self.places.get(&b)) else { return };
        if a != b && seen.insert((a.min(b), a.max(b))) {
            self.mesh.edges.push([i, j]);
        }
    }
}

impl Parts<'_> {
    fn colour(&self, position: u32) -> [u8; 3] {
        self.raw.colours.get(position as usize).copied().unwrap_or([255; 3])
    }

    fn finish(&mut self, mut builder: Builder, material: usize, normals: NormalsBuf, uvs: bool) {
        if builder.mesh.positions.is_empty() {
            return;
        }
        builder.mesh.normals = normals;
        if self.raw.colours.is_empty() {
            builder.mesh.colours = Vec::new();
        }
        if !uvs {
            builder.mesh.uvs = Vec::new();
            builder.mesh.uv_triangles = Vec::new();
        }
        let mesh = &mut builder.mesh;
        mesh.bounds = Some(bounding_sphere(&mesh.positions));
        mesh.clusters = clusters(&mesh.positions, &mesh.triangles).collect();
        let material = self.raw.materials.get(material).cloned().unwrap_or_default();
        let count = self.names.entry(material.name.clone()).or_insert(0);
        *count += 1;
        let name = match *count {
            1 => material.name.clone(),
            count => format!("{} ({count})", material.name),
        };
        self.parts.push(Part { name, mesh: builder.mesh, material });
    }

    /// The parts of one material.
    fn faces(&mut self, material: usize, faces: &[u32], normals: &[[i16; 3]], stats: &mut Stats) {
        let raw = self.raw;
        let begin =
            |face: u32| if face == 0 { 0 } else { raw.faces[face as usize - 1].end as usize };
        let own = |face: u32| &normals[begin(face)..raw.faces[face as usize].end as usize];
        let flat = faces.iter().all(|&face| own(face).windows(2).all(|pair| pair[0] == pair[1]));
        let with_uvs = faces.iter().any(|&f| raw.face(f as usize).iter().any(|c| c.uv != NONE));
        let uv_map = raw.uv_maps.get(&(material as u32));
        let mut builder = Builder::default();
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for &face in faces {
            let corners = raw.face(face as usize);
            let corner_normals = own(face);
            points.clear();
            points.extend(corners.iter().map(|c| raw.positions[c.position as usize]));
            triangles.clear();
            self.tangled += u64::from(!triangulate(&points, &mut triangles));
            if !builder.has_room_for(corners.len()) {
                self.flush(&mut builder, material, flat, with_uvs);
            }
            for triangle in &triangles {
                let corner = triangle.map(|i| corners[i as usize]);
                let place = corner.map(|c| self.grid[c.position as usize]);
                let lost = flat_on_grid(place) && has_area(triangle.map(|i| points[i as usize]));
                self.lost += u64::from(lost);
                if place[0] == place[1] || place[1] == place[2] || place[2] == place[0] {
                    stats.degenerate += 1;
                    self.empty += u64::from(!lost);
                    continue;
                }
                if !builder.has_room_for(3) {
                    self.flush(&mut builder, material, flat, with_uvs);
                }
                let normal = triangle.map(|i| corner_normals[i as usize]);
                let vertices = std::array::from_fn(|i| {
                    let normal = if flat { [0; 3] } else { normal[i] };
                    builder.vertex(place[i], normal, self.colour(corner[i].position))
                });
                builder.mesh.triangles.push(vertices);
                builder.face_normals.push(normal[0]);
                if with_uvs {
                    let uvs = corner.map(|c| {
                        let uv = raw.uvs.get(c.uv as usize).copied().unwrap_or([0.0; 2]);
                        builder.uv(quantise_uv(uv_map.map_or(uv, |map| map.apply(uv))))
                    });
                    builder.mesh.uv_triangles.push(uvs);
                }
            }
            for (i, corner) in corners.iter().enumerate() {
                let next = &corners[(i + 1) % corners.len()];
                let [a, b] = [corner, next].map(|c| self.grid[c.position as usize]);
                builder.edge(a, b, &mut self.seen);
            }
        }
        self.flush(&mut builder, material, flat, with_uvs);
    }

    fn flush(&mut self, builder: &mut Builder, material: usize, flat: bool, uvs: bool) {
        let mut full = std::mem::take(builder);
        let normals = if flat {
            NormalsBuf::Face(std::mem::take(&mut full.face_normals))
        } else {
            NormalsBuf::Vertex(std::mem::take(&mut full.vertex_normals))
        };
        self.finish(full, material, normals, uvs);
    }

    fn lines_and_points(&mut self, material: usize) {
        let raw = self.raw;
        let mut builder = Builder::default();
        let lines = raw.lines.iter().filter(|line| line[2] as usize == material);
        let points = raw.points.iter().filter(|point| point[1] as usize == material);
        for ends in lines.map(|l| [l[0], l[1]]).chain(points.map(|p| [p[0], p[0]])) {
            if !builder.has_room_for(2) {
                self.finish(std::mem::take(&mut builder), material, NormalsBuf::None, false);
            }
            let [a, b] = ends.map(|p| {
                builder.vertex(self.grid[p as usize], [0; 3], self.colour(p));
                self.grid[p as usize]
            });
            builder.edge(a, b, &mut self.seen);
        }
        self.finish(builder, material, NormalsBuf::None, false);
    }

    /// A point cloud: every position, with its normal when there is one a position.
    fn cloud(&mut self, options: &LoadOptions) {
        let raw = self.raw;
        let given =
            options.normals == NormalSource::FromFile && raw.normals.len() == self.grid.len();
        let mut builder = Builder::default();
        for (index, &at) in self.grid.iter().enumerate() {
            if !builder.has_room_for(1) {
                self.finish_cloud(std::mem::take(&mut builder), given);
            }
            let normal = raw.normals.get(index).filter(|_| given);
            let normal = normal.and_then(|n| unit(n.map(f64::from))).map_or([0; 3], to_q14);
            builder.vertex(at, normal, self.colour(index as u32));
        }
        self.finish_cloud(builder, given);
    }

    fn finish_cloud(&mut self, mut builder: Builder, given: bool) {
        let normals = std::mem::take(&mut builder.vertex_normals);
        let normals = if given { NormalsBuf::Vertex(normals) } else { NormalsBuf::None };
        self.finish(builder, 0, normals, false);
    }
}

/// The smaller of Ritter's sphere (1990) and the sphere about the box's centre; the radius is rounded up.
fn bounding_sphere(positions: &[[i16; 3]]) -> Sphere {
    let far = |from: [i16; 3]| positions.iter().copied().max_by_key(|&p| distance2(p, from));
    let first = positions.first().copied().unwrap_or_default();
    let a = far(first).unwrap_or(first);
    let b = far(a).unwrap_or(a);
    let mut centre: [f64; 3] = std::array::from_fn(|i| (f64::from(a[i]) + f64::from(b[i])) / 2.0);
    let mut radius = (distance2(a, b) as f64).sqrt() / 2.0;
    for p in positions {
        let d: [f64; 3] = std::array::from_fn(|i| f64::from(p[i]) - centre[i]);
        let distance = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
        if distance > radius {
            let grown = (radius + distance) / 2.0;
            let step = (distance - grown) / distance;
            centre = std::array::from_fn(|i| centre[i] + d[i] * step);
            radius = grown;
        }
    }
    let mut low = first;
    let mut high = first;
    for p in positions {
        low = std::array::from_fn(|i| low[i].min(p[i]));
        high = std::array::from_fn(|i| high[i].max(p[i]));
    }
    let middle = std::array::from_fn(|i| ((i32::from(low[i]) + i32::from(high[i])) / 2) as i16);
    let ritter = centre.map(|x| x.round() as i16);
    let sphere = |centre: [i16; 3]| {
        let most = positions.iter().map(|&p| distance2(p, centre)).max().unwrap_or(0);
        let mut root = most.isqrt();
        root += u64::from(root * root < most);
        Sphere { centre, radius: root.min(65_535) as u16 }
    };
    let (one, other) = (sphere(ritter), sphere(middle));
    if one.radius < other.radius { one } else { other }
}

fn distance2(a: [i16; 3], b: [i16; 3]) -> u64 {
    (0..3).map(|i| i64::from(a[i]) - i64::from(b[i])).map(|d| (d * d) as u64).sum()
}

#[cfg(test)]
#[path = "assemble_tests.rs"]
mod tests;
