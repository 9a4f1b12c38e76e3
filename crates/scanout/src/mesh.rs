//! Meshes as the pipeline reads them: borrowed slices of small integers, so that a mesh can lie in flash.
//!
//! | slice | element | format |
//! |---|---|---|
//! | `positions` | `[i16; 3]` | Q1.15, in [-1, 1) of the mesh's own unit |
//! | `normals` | `[i16; 3]` | Q2.14, unit length = 16384 |
//! | `colours` | `[u8; 3]` | R, G, B a position |
//! | `uvs` | `[i32; 2]` | Q16.16, u right, v down, 1.0 = one repeat |
//! | `triangles` | `[u16; 3]` | indices into `positions`, counter-clockwise seen from outside |
//! | `uv_triangles` | `[u16; 3]` | indices into `uvs`, parallel to `triangles` |
//! | `edges` | `[u16; 2]` | indices into `positions`; each edge once |
//! | `clusters` | [`Cluster`] | one for every eight of `triangles`, in order |
//!
//! Positions and texture coordinates have indices of their own (as in OBJ), so a vertex on a texture seam is still
//! transformed once. What a mesh will not do: more than 65,536 positions or texture coordinates (split it).

pub use crate::mesh_clusters::Cluster;

/// Normals of a mesh, one a position or one a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Normals<'a> {
    /// No normals: faces are lit by the geometric normal of each triangle.
    #[default]
    None,
    /// One normal a position (smooth): `[i16; 3]` in Q2.14, parallel to `positions`.
    Vertex(&'a [[i16; 3]]),
    /// One normal a triangle (flat): `[i16; 3]` in Q2.14, parallel to `triangles`.
    Face(&'a [[i16; 3]]),
}

/// A bounding sphere in the mesh's own coordinates (Q1.15; the radius may reach sqrt(3) = 56756).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sphere {
    /// Centre, Q1.15.
    pub centre: [i16; 3],
    /// Radius, U1.15, rounded up.
    pub radius: u16,
}

/// A mesh of triangles, edges and points over one set of positions. See the module for formats.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mesh<'a> {
    /// Positions, Q1.15.
    pub positions: &'a [[i16; 3]],
    /// Normals, Q2.14.
    pub normals: Normals<'a>,
    /// Colours a position, or empty: the material's colour then serves.
    pub colours: &'a [[u8; 3]],
    /// Texture coordinates, Q16.16, or empty.
    pub uvs: &'a [[i32; 2]],
    /// Triangles as indices into `positions`.
    pub triangles: &'a [[u16; 3]],
    /// The same triangles as indices into `uvs`, or empty.
    pub uv_triangles: &'a [[u16; 3]],
    /// Edges for wireframes (the outlines of the file's polygons, each once), or empty.
    pub edges: &'a [[u16; 2]],
    /// Bounding sphere for whole-mesh culling, or `None` to never cull the mesh as a whole.
    pub bounds: Option<Sphere>,
    /// Bounds of every eight triangles ([`mesh_clusters::clusters`](crate::mesh_clusters::clusters) makes them), or empty. Filled
    /// modes drop what is turned away by them, faster and with the same pixels; they serve a mesh with `bounds` whose material has one
    /// side, and need the feature `clusters`. They must have been made from these `positions` and `triangles`: others drop what is seen.
    pub clusters: &'a [Cluster],
}
