//! Look-up tables for hardware: text files for `$readmemh`, one memory word a line.

use crate::model::{Model, NormalsBuf};
use std::collections::HashMap;
use std::fmt::{self, Write};

/// The format document that is written beside the tables.
pub const HEX_README: &str = include_str!("hex_readme.md");

/// The model does not fit into the tables, whose indices are 16 bits wide, 8 bits for materials and textures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HexError {
    /// What there is too much of.
    pub what: &'static str,
    /// How many there are.
    pub count: usize,
    /// How many the tables hold.
    pub limit: usize,
}

impl fmt::Display for HexError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, count, limit } = self;
        let remedy = match *what {
            "materials" => "join materials",
            "textures" => "join textures",
            _ => "simplify the mesh",
        };
        write!(f, "{count} {what}, and the .hex tables hold at most {limit}; {remedy}")
    }
}

impl std::error::Error for HexError {}

/// All parts of a model in one set of tables.
#[derive(Default)]
struct Tables {
    vertices: Vec<[i16; 3]>,
    normals: Vec<[i16; 3]>,
    colours: Vec<[u8; 3]>,
    uvs: Vec<[i32; 2]>,
    triangles: Vec<[usize; 3]>,
    uv_triangles: Vec<[usize; 3]>,
    materials: Vec<usize>,
    edges: Vec<[usize; 2]>,
}

/// Whether [`hex_files`] will succeed: for a word before anything is written.
///
/// # Errors
/// As [`hex_files`].
pub fn check_hex(model: &Model) -> Result<(), HexError> {
    collect(model).map(drop)
}

/// The tables as file names and contents, `README.md` and `mesh.svh` among them. Tables that would be empty are left out.
///
/// # Errors
/// [`HexError`] when vertices, texture coordinates, materials (one a part) or textures exceed their index.
pub fn hex_files(model: &Model) -> Result<Vec<(String, String)>, HexError> {
    let tables = collect(model)?;
    let per_triangle = one_a_triangle(model);
    let mut files = vec![("README.md".to_string(), HEX_README.to_string())];
    let mut add = |name: &str, lines: Vec<String>| {
        if !lines.is_empty() {
            let mut text = lines.join("\n");
            text.push('\n');
            files.push((format!("{name}.hex"), text));
        }
    };
    let vector = |v: &[i16; 3]| format!("{:04x}{:04x}{:04x}", v[2], v[1], v[0]);
    let indices = |t: &[usize; 3]| format!("{:04x}{:04x}{:04x}", t[2], t[1], t[0]);
    add("vertices", tables.vertices.iter().map(vector).collect());
    add("normals", tables.normals.iter().map(vector).collect());
    add("colours", tables.colours.iter().map(|c| rgb(*c)).collect());
    add("triangles", tables.triangles.iter().map(indices).collect());
    add("triangle_materials", tables.materials.iter().map(|m| format!("{m:02x}")).collect());
    add("edges", tables.edges.iter().map(|e| format!("{:04x}{:04x}", e[1], e[0])).collect());
    add("uvs", tables.uvs.iter().map(|uv| format!("{:08x}{:08x}", uv[1], uv[0])).collect());
    add("uv_triangles", tables.uv_triangles.iter().map(indices).collect());
    add("materials", model.parts.iter().map(|p| material(&p.material)).collect());
    let mut header = String::from("// Made by `scanout bake`; see README.md.\n");
    let mut parameter = |name: &str, value: i64| {
        // Writing to a string can't fail.
        let _ = writeln!(header, "localparam longint {name} = {value};");
    };
    let q16 = |x: f64| (x * 65536.0).round() as i32;
    parameter("MESH_VERTICES", tables.vertices.len() as i64);
    parameter("MESH_NORMALS", tables.normals.len() as i64);
    parameter("MESH_NORMALS_PER_TRIANGLE", per_triangle.into());
    parameter("MESH_TRIANGLES", tables.triangles.len() as i64);
    parameter("MESH_EDGES", tables.edges.len() as i64);
    parameter("MESH_UVS", tables.uvs.len() as i64);
    parameter("MESH_MATERIALS", model.parts.len() as i64);
    parameter("MESH_TEXTURES", model.images.len() as i64);
    parameter("MESH_SCALE_Q16", q16(model.placement.scale).into());
    for (axis, offset) in ["X", "Y", "Z"].iter().zip(model.placement.offset) {
        parameter(&format!("MESH_OFFSET_{axis}_Q16"), q16(offset).into());
    }
    for (index, image) in model.images.iter().enumerate() {
        add(
            &format!("texture{index}"),
            image.to_rgb565().iter().map(|t| format!("{t:04x}")).collect(),
        );
        parameter(&format!("MESH_TEXTURE{index}_WIDTH"), image.width.into());
        parameter(&format!("MESH_TEXTURE{index}_HEIGHT"), image.height.into());
        parameter(&format!("MESH_TEXTURE{index}_LEVELS"), image.levels.into());
    }
    files.push(("mesh.svh".into(), header));
    Ok(files)
}

fn rgb([r, g, b]: [u8; 3]) -> String {
    format!("{r:02x}{g:02x}{b:02x}")
}

/// 120 bits: see `hex_readme.md`.
fn material(m: &crate::model::MaterialBuf) -> String {
    let q16 = |w: f32| (w * 65536.0).round().clamp(0.0, 65536.0) as u32;
    let texture = m.texture.map_or(0xff, |t| t.min(0xff));
    format!(
        "{:02x}{texture:02x}{:04x}{:05x}{:05x}{:05x}0{}",
        u8::from(m.two_sided) | super::wrap_bits(m.wrap) << 2,
        m.shininess,
        q16(m.specular),
        q16(m.diffuse),
        q16(m.ambient),
        rgb(m.colour)
    )
}

/// True when every part has one normal a triangle; otherwise the tables have one a vertex.
fn one_a_triangle(model: &Model) -> bool {
    model.parts.iter().all(|p| matches!(p.mesh.normals, NormalsBuf::Face(_)))
}

fn collect(model: &Model) -> Result<Tables, HexError> {
    let mut all = Tables::default();
    let per_triangle = one_a_triangle(model);
    let coloured = model.parts.iter().any(|p| !p.mesh.colours.is_empty());
    for (material, part) in model.parts.iter().enumerate() {
        let mesh = &part.mesh;
        let (first, first_uv) = (all.vertices.len(), all.uvs.len());
        let colour = |i: usize| mesh.colours.get(i).copied().unwrap_or([255; 3]);
        all.vertices.extend(&mesh.positions);
        if coloured {
            all.colours.extend((0..mesh.positions.len()).map(colour));
        }
        let mut triangles: Vec<[usize; 3]> =
            mesh.triangles.iter().map(|t| t.map(|i| first + usize::from(i))).collect();
        match &mesh.normals {
            NormalsBuf::Face(n) if per_triangle => all.normals.extend(n),
            NormalsBuf::Vertex(n) => all.normals.extend(n),
            NormalsBuf::None => all.normals.extend(mesh.positions.iter().map(|_| [0; 3])),
            NormalsBuf::Face(n) => {
                // Beside smooth parts: a vertex for every pair of position and face normal; the first pair takes the
                // vertex itself, so that edges keep theirs.
                all.normals.extend(mesh.positions.iter().map(|_| [0; 3]));
                let mut taken = vec![false; mesh.positions.len()];
                let mut known = HashMap::new();
                for (corners, &normal) in triangles.iter_mut().zip(n) {
                    for corner in corners {
                        let own = *corner - first;
                        *corner = *known.entry((own, normal)).or_insert_with(|| {
                            if !std::mem::replace(&mut taken[own], true) {
                                all.normals[first + own] = normal;
                                return first + own;
                            }
                            all.vertices.push(mesh.positions[own]);
                            all.normals.push(normal);
                            if coloured {
                                all.colours.push(colour(own));
                            }
                            all.vertices.len() - 1
                        });
                    }
                }
            }
        }
        all.triangles.extend(triangles);
        all.materials.extend(mesh.triangles.iter().map(|_| material));
        all.edges.extend(mesh.edges.iter().map(|e| e.map(|i| first + usize::from(i))));
        all.uvs.extend(&mesh.uvs);
        if mesh.uv_triangles.is_empty() {
            // Parallel to the triangles also where a part has none.
            all.uv_triangles.extend(mesh.triangles.iter().map(|_| [0; 3]));
        } else {
            all.uv_triangles
                .extend(mesh.uv_triangles.iter().map(|t| t.map(|i| first_uv + usize::from(i))));
        }
    }
    if all.uvs.is_empty() {
        all.uv_triangles.clear();
    }
    let limits = [
        ("vertices", all.vertices.len(), 65_536),
        ("texture coordinates", all.uvs.len(), 65_536),
        ("materials", model.parts.len(), 256),
        ("textures", model.images.len(), 255),
    ];
    match limits.into_iter().find(|(_, count, limit)| count > limit) {
        Some((what, count, limit)) => Err(HexError { what, count, limit }),
        None => Ok(all),
    }
}
