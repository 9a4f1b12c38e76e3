//! What the loader hands back: owned meshes, materials and images, and how they lie in the world.

use crate::error::Warning;
use scanout::mesh::{Cluster, Mesh, Normals, Sphere};
use scanout::texture::Wrap;

/// Normals of a [`MeshBuf`], Q2.14, as `scanout::mesh::Normals`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub enum NormalsBuf {
    /// None: lines and points without any.
    #[default]
    None,
    /// One a position.
    Vertex(Vec<[i16; 3]>),
    /// One a triangle.
    Face(Vec<[i16; 3]>),
}

/// An owned mesh; the formats are those of `scanout::mesh`.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct MeshBuf {
    /// Positions, Q1.15, at most 65,536.
    pub positions: Vec<[i16; 3]>,
    /// Normals, Q2.14.
    pub normals: NormalsBuf,
    /// Colours parallel to `positions`, or empty.
    pub colours: Vec<[u8; 3]>,
    /// Texture coordinates, Q16.16, v down, at most 65,536; or empty.
    pub uvs: Vec<[i32; 2]>,
    /// Triangles as indices into `positions`, counter-clockwise as in the file.
    pub triangles: Vec<[u16; 3]>,
    /// Triangles as indices into `uvs`, or empty.
    pub uv_triangles: Vec<[u16; 3]>,
    /// Outlines of the file's polygons as indices into `positions`; each edge of the model once.
    pub edges: Vec<[u16; 2]>,
    /// Bounding sphere.
    pub bounds: Option<Sphere>,
    /// Bounds of every eight triangles, made from the positions and triangles as they are; or empty.
    pub clusters: Vec<Cluster>,
}

impl MeshBuf {
    /// The mesh as the pipeline reads it.
    pub fn as_mesh(&self) -> Mesh<'_> {
        Mesh {
            positions: &self.positions,
            normals: match &self.normals {
                NormalsBuf::None => Normals::None,
                NormalsBuf::Vertex(n) => Normals::Vertex(n),
                NormalsBuf::Face(n) => Normals::Face(n),
            },
            colours: &self.colours,
            uvs: &self.uvs,
            triangles: &self.triangles,
            uv_triangles: &self.uv_triangles,
            edges: &self.edges,
            bounds: self.bounds,
            clusters: &self.clusters,
        }
    }
}

/// A surface. The weights sum to at most 1, so that a fully lit surface just reaches its colour.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialBuf {
    /// Name in the file, or `default`.
    pub name: String,
    /// Colour R, G, B; multiplies vertex colours and texels.
    pub colour: [u8; 3],
    /// Weight of the ambient light, [0, 1].
    pub ambient: f32,
    /// Weight of diffuse reflection, [0, 1].
    pub diffuse: f32,
    /// Weight of specular reflection, [0, 1].
    pub specular: f32,
    /// Exponent of the specular term, 1 to 1024.
    pub shininess: u16,
    /// Index into [`Model::images`].
    pub texture: Option<usize>,
    /// What lies outside [0, 1) of the texture, for u and v (MTL's `-clamp on`, glTF's samplers).
    pub wrap: [Wrap; 2],
    /// The file asks for both sides (glTF's `doubleSided`).
    pub two_sided: bool,
}

impl Default for MaterialBuf {
    /// Light grey, matt.
    fn default() -> Self {
        Self {
            name: "default".into(),
            colour: [204; 3],
            ambient: 0.2,
            diffuse: 0.8,
            specular: 0.0,
            shininess: 32,
            texture: None,
            wrap: [Wrap::Repeat; 2],
            two_sided: false,
        }
    }
}

/// A mesh with one material.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The material's name, with a number from the second part of that name on.
    pub name: String,
    /// The mesh.
    pub mesh: MeshBuf,
    /// The material.
    pub material: MaterialBuf,
}

/// A picture of up to 1024 x 1024 texels, 8 bits a channel, with or without mip levels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Name of the file, or of the place in the file, that it comes from.
    pub name: String,
    /// Width of level 0.
    pub width: u16,
    /// Height of level 0.
    pub height: u16,
    /// Levels in `rgb`, at least 1.
    pub levels: u8,
    /// R, G, B row by row from the top; level k + 1 (max(1, size >> (k + 1))) follows level k.
    pub rgb: Vec<[u8; 3]>,
}

/// Where the mesh's grid lies: `world = position / 32768 * scale + offset`, in the file's coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// World units that a mesh position of 1.0 (= 32768) stands for, greater than 0.
    pub scale: f64,
    /// World position of the grid's origin: the centre of the bounding box.
    pub offset: [f64; 3],
}

impl Placement {
    /// World coordinates of a mesh position.
    pub fn to_world(&self, position: [i16; 3]) -> [f64; 3] {
        std::array::from_fn(|i| f64::from(position[i]) / 32768.0 * self.scale + self.offset[i])
    }
}

/// Counts of the file and of what was made of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Stats {
    /// Bytes of the model's file.
    pub file_bytes: u64,
    /// Positions in the file.
    pub positions: u64,
    /// Texture coordinates in the file.
    pub uvs: u64,
    /// Normals in the file.
    pub normals: u64,
    /// Polygons in the file.
    pub polygons: u64,
    /// Triangles in all parts.
    pub triangles: u64,
    /// Edges in all parts.
    pub edges: u64,
    /// Triangles dropped because corners coincide.
    pub degenerate: u64,
}

/// A loaded model.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Meshes with a material each, in the order of the file's materials.
    pub parts: Vec<Part>,
    /// Textures that the materials refer to.
    pub images: Vec<Image>,
    /// From mesh positions back to the file's coordinates, for all parts.
    pub placement: Placement,
    /// The triangles of all parts enclose a volume: each edge, by the positions of its ends, belongs to exactly two
    /// triangles, and these run along it in opposite directions. From outside no back face of such a model is seen; others
    /// (sheets, shells with holes, surfaces of mixed winding) need both sides drawn. False without triangles.
    pub closed: bool,
    /// Everything that was not as it should be.
    pub warnings: Vec<Warning>,
    /// Counts.
    pub stats: Stats,
}

impl Model {
    /// The bounding box in the file's coordinates, least and greatest corner; exact to the grid.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let mut low = [i16::MAX; 3];
        let mut high = [i16::MIN; 3];
        for position in self.parts.iter().flat_map(|part| &part.mesh.positions) {
            for axis in 0..3 {
                low[axis] = low[axis].min(position[axis]);
                high[axis] = high[axis].max(position[axis]);
            }
        }
        [self.placement.to_world(low), self.placement.to_world(high)]
    }
}
