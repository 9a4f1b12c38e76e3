//! glTF 2.0: `.gltf` with files, embedded data or none, and `.glb`; uncompressed.
//!
//! Read: the default scene's nodes with their transforms, triangles (lists, strips, fans), lines, points, with or without
//! indices, any component type, sparse accessors, `POSITION`, `NORMAL`, `TEXCOORD_n`, `COLOR_0`, `baseColorFactor`,
//! `baseColorTexture`, `doubleSided`, `wrapS`, `wrapT`, `KHR_texture_transform`. Linear colours are encoded as sRGB, since the pipeline
//! multiplies encoded colours. A rough surface is matt; a smooth one gets a highlight.
//!
//! Ignored with a warning: skins (the rest pose is shown), morph targets, transparency, optional extensions of materials.
//! Refused: compression and other required extensions that change the geometry, files that are not local.

mod access;
mod container;
mod schema;
#[cfg(test)]
mod tests;

use self::access::Access;
use self::schema::{Document, Node, Primitive, Sampler};
use super::Source;
use crate::error::{At, LoadError};
use crate::image::load_image;
use crate::model::{Image, MaterialBuf};
use crate::raw::{Corner, NONE, Raw, SMOOTHING_UNSPECIFIED, usable};
use scanout::texture::Wrap;

/// Column-major, as in the file.
type Matrix = [f64; 16];

const IDENTITY: Matrix = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];

/// Required extensions that are read, or that only change how a surface shines.
fn is_known(extension: &str) -> bool {
    matches!(extension, "KHR_mesh_quantization" | "KHR_texture_transform" | "KHR_lights_punctual")
        || extension.starts_with("KHR_materials_")
        || extension.starts_with("KHR_technique")
}

pub(crate) fn read(source: &Source<'_>) -> Result<Raw, LoadError> {
    let (document, binary) = container::parse(source)?;
    if let Some(extension) = document.extensions_required.iter().find(|e| !is_known(e)) {
        let extension: String = extension.chars().take(60).collect();
        return Err(LoadError::unsupported(
            source.name,
            At::File,
            format!("needs the extension {extension}; export without it (without compression)"),
        ));
    }
    let buffers = container::buffers(&document, binary, source)?;
    let access = Access { document: &document, buffers: &buffers, source };
    let mut reader = Reader { raw: Raw::default(), source, document: &document, access };
    reader.materials();
    reader.scene()?;
    let Reader { mut raw, .. } = reader;
    if !raw.colours.is_empty() {
        raw.colours.resize(raw.positions.len(), [255; 3]);
    }
    Ok(raw)
}

struct Reader<'a> {
    raw: Raw,
    source: &'a Source<'a>,
    document: &'a Document,
    access: Access<'a>,
}

impl Reader<'_> {
    fn fail(&self, what: impl Into<String>) -> LoadError {
        malformed(self.source, what)
    }

    /// Material 0 is glTF's default; the file's material i is i + 1.
    fn materials(&mut self) {
        self.raw.materials.push(MaterialBuf { colour: [255; 3], ..MaterialBuf::default() });
        let mut images: Vec<Option<Option<usize>>> = vec![None; self.document.images.len()];
        for (index, material) in self.document.materials.iter().enumerate() {
            let pbr = &material.pbr_metallic_roughness;
            let rough =
                if pbr.metallic_roughness_texture.is_some() { 1.0 } else { pbr.roughness_factor };
            let rough = rough.clamp(0.0, 1.0);
            let specular = 0.3 * (1.0 - rough);
            let factor = pbr.base_color_factor;
            let texture = pbr.base_color_texture.as_ref().and_then(|reference| {
                let texture = self.document.textures.get(reference.index)?;
                let image = texture.source?;
                // Each image is decoded at most once.
                if images.get(image)?.is_none() {
                    images[image] = Some(self.image(image));
                }
                images[image].flatten()
            });
            let sampler = pbr.base_color_texture.as_ref().and_then(|reference| {
                self.document.samplers.get(self.document.textures.get(reference.index)?.sampler?)
            });
            if pbr.base_color_texture.is_some() && texture.is_none() {
                self.raw.texture_named = true;
                self.raw.warnings.warn(format!("material {index}: its texture is not usable"));
            }
            if material.alpha_mode.as_deref().is_some_and(|mode| mode != "OPAQUE") {
                self.raw.warnings.warn("transparency (alphaMode) is ignored");
            }
            let name = material.name.clone().unwrap_or_else(|| format!("material {index}"));
            self.raw.materials.push(MaterialBuf {
                name: name.chars().take(200).collect(),
                colour: [0, 1, 2].map(|i| srgb(factor[i])),
                ambient: 0.2,
                diffuse: (0.8 - specular) as f32,
                specular: specular as f32,
                // The exponent whose highlight is as wide as a GGX lobe of that roughness.
                shininess: (2.0 / rough.powi(4).max(0.002) - 2.0).clamp(1.0, 1024.0) as u16,
                texture,
                wrap: sampler.map_or([Wrap::Repeat; 2], Sampler::wrap),
                two_sided: material.double_sided,
            });
        }
    }

    /// Decodes an image of the document; its index in the model, or `None` with a warning.
    fn image(&mut self, index: usize) -> Option<usize> {
        let image = self.document.images.get(index)?;
        let name = format!("{} image {index}", self.source.name);
        let decoded = match (&image.uri, image.buffer_view) {
            (Some(uri), _) if uri.starts_with("data:") => match container::data_uri(uri) {
                Some(bytes) => Image::decode(&bytes, &name),
                None => Err(self.fail(format!("image {index}: not a base64 data URI"))),
            },
            (Some(uri), _) => container::local_file(uri, self.source)
                .and_then(|path| load_image(path, self.source.limits)),
            (None, Some(view)) => {
                self.access.view(view).and_then(|bytes| Image::decode(bytes, &name))
            }
            (None, None) => Err(self.fail(format!("image {index} has no data"))),
        };
        match decoded {
            Ok((image, warnings)) => {
                warnings.into_iter().for_each(|w| self.raw.warnings.warn(w.text));
                self.raw.images.push(image);
                Some(self.raw.images.len() - 1)
            }
            Err(error) => {
                self.raw.warnings.warn(error.to_string());
                None
            }
        }
    }

    /// All meshes of the default scene. No recursion; a node is visited once.
    fn scene(&mut self) -> Result<(), LoadError> {
        let document = self.document;
        let nodes = &document.nodes;
        let mut visited = vec![false; nodes.len()];
        let roots: Vec<usize> = match document.scenes.get(document.scene.unwrap_or(0)) {
            Some(scene) => scene.nodes.clone(),
            None => {
                let mut child = vec![false; nodes.len()];
                for &index in nodes.iter().flat_map(|node| &node.children) {
                    child.get_mut(index).into_iter().for_each(|c| *c = true);
                }
                (0..nodes.len()).filter(|&index| !child[index]).collect()
            }
        };
        if nodes.is_empty() {
            for mesh in 0..document.meshes.len() {
                self.mesh(mesh, &IDENTITY)?;
            }
        }
        let mut stack: Vec<(usize, Matrix)> =
            roots.iter().rev().map(|&root| (root, IDENTITY)).collect();
        while let Some((index, parent)) = stack.pop() {
            let Some(node) = nodes.get(index) else {
                return Err(self.fail(format!("node {index} of {} is asked for", nodes.len())));
            };
            if std::mem::replace(&mut visited[index], true) {
                return Err(
                    self.fail(format!("node {index} has two parents; export the file again"))
                );
            }
            let matrix = multiply(&parent, &local(node));
            if let Some(mesh) = node.mesh {
                if node.skin.is_some() {
                    self.raw.warnings.warn("skins are ignored; the rest pose is shown");
                }
                self.mesh(mesh, &matrix)?;
            }
            stack.extend(node.children.iter().rev().map(|&child| (child, matrix)));
        }
        Ok(())
    }

    fn mesh(&mut self, index: usize, matrix: &Matrix) -> Result<(), LoadError> {
        let Some(mesh) = self.document.meshes.get(index) else {
            return Err(self.fail(format!("mesh {index} is asked for and missing")));
        };
        for primitive in &mesh.primitives {
            self.primitive(primitive, matrix)?;
        }
        Ok(())
    }

    fn primitive(&mut self, primitive: &Primitive, matrix: &Matrix) -> Result<(), LoadError> {
        let attribute = |name: &str| primitive.attributes.get(name).copied();
        let Some(positions) = attribute("POSITION") else {
            self.raw.warnings.warn("primitives without POSITION are skipped");
            return Ok(());
        };
        if !primitive.targets.is_empty() {
            self.raw.warnings.warn("morph targets are ignored");
        }
        let material = primitive.material.map_or(0, |m| m.saturating_add(1));
        if material >= self.raw.materials.len() {
            return Err(self.fail(format!("material {} is asked for and missing", material - 1)));
        }
        let texture = material.checked_sub(1).and_then(|m| {
            self.document.materials[m].pbr_metallic_roughness.base_color_texture.as_ref()
        });
        let first = self.raw.positions.len() as u32;
        let positions = self.access.vectors(positions, 3)?;
        let count = positions.len();
        for p in &positions {
            let world = transform(matrix, [p[0], p[1], p[2]]);
            if !usable(&world) {
                return Err(self.fail("a position is not finite or beyond 1e30; mend the mesh"));
            }
            self.raw.positions.push(world);
        }
        self.raw.check(self.source.name, self.source.limits)?;
        let parallel =
            |reader: &Self, name: &str, width| -> Result<Option<Vec<[f64; 4]>>, LoadError> {
                let Some(accessor) = attribute(name) else { return Ok(None) };
                let values = reader.access.vectors(accessor, width)?;
                if values.len() == count {
                    return Ok(Some(values));
                }
                Err(reader
                    .fail(format!("{name} has {} entries for {count} positions", values.len())))
            };
        let normals = parallel(self, "NORMAL", 3)?;
        let uvs = parallel(self, &format!("TEXCOORD_{}", texture.map_or(0, |t| t.set())), 2)?;
        let colours = parallel(self, "COLOR_0", 3)?;
        let uv_first = self.raw.uvs.len() as u32;
        let normal_first = self.raw.normals.len() as u32;
        let (cofactors, determinant) = cofactors(matrix);
        for n in normals.iter().flatten() {
            let n = [0, 1, 2].map(|row: usize| {
                (0..3).map(|column| cofactors[3 * column + row] * n[column]).sum::<f64>()
            });
            let n = if determinant < 0.0 { n.map(|x| -x) } else { n };
            self.raw.normals.push(crate::normals::unit(n).unwrap_or([0.0; 3]).map(|x| x as f32));
        }
        for uv in uvs.iter().flatten() {
            let uv = texture.map_or([uv[0], uv[1]], |t| t.transform([uv[0], uv[1]]));
            self.raw.uvs.push(if usable(&uv) { uv } else { [0.0; 2] });
        }
        if let Some(colours) = &colours {
            self.raw.colours.resize(first as usize, [255; 3]);
            self.raw.colours.extend(colours.iter().map(|c| [srgb(c[0]), srgb(c[1]), srgb(c[2])]));
        }
        self.raw.check(self.source.name, self.source.limits)?;
        let indices = match primitive.indices {
            Some(accessor) => self.access.indices(accessor, count)?,
            None => (0..count as u32).collect(),
        };
        let corner = |index: u32| Corner {
            position: first + index,
            uv: if uvs.is_some() { uv_first + index } else { NONE },
            normal: if normals.is_some() { normal_first + index } else { NONE },
        };
        self.elements(primitive.mode, &indices, &corner, material as u32, determinant < 0.0)
    }

    /// Faces, lines or points of a primitive; a mirroring transform turns the faces' winding.
    fn elements(
        &mut self,
        mode: u32,
        indices: &[u32],
        corner: &dyn Fn(u32) -> Corner,
        material: u32,
        mirrored: bool,
    ) -> Result<(), LoadError> {
        let raw = &mut self.raw;
        let line = |a: u32, b: u32| [corner(a).position, corner(b).position, material];
        let mut triangle = |[a, b, c]: [u32; 3]| {
            let order = if mirrored { [a, c, b] } else { [a, b, c] };
            raw.corners.extend(order.map(corner));
            raw.end_face(material, SMOOTHING_UNSPECIFIED);
        };
        match mode {
            0 => raw.points.extend(indices.iter().map(|&i| [corner(i).position, material])),
            1 => raw.lines.extend(indices.chunks_exact(2).map(|l| line(l[0], l[1]))),
            2 | 3 => {
                raw.lines.extend(indices.windows(2).map(|l| line(l[0], l[1])));
                if let (2, [first, .., last]) = (mode, indices) {
                    raw.lines.push(line(*last, *first));
                }
            }
            4 => indices.chunks_exact(3).for_each(|t| triangle([t[0], t[1], t[2]])),
            5 => indices.windows(3).enumerate().for_each(|(i, t)| {
                triangle(if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] });
            }),
            6 => indices.windows(2).skip(1).for_each(|t| triangle([indices[0], t[0], t[1]])),
            _ => return Err(self.fail(format!("primitive mode {mode} does not exist"))),
        }
        self.raw.check(self.source.name, self.source.limits)
    }
}

/// An error of the document; those that only an exporter can mend say so.
fn malformed(source: &Source<'_>, what: impl Into<String>) -> LoadError {
    let mut what = what.into();
    if !what.contains("; ") {
        what.push_str("; export the file again");
    }
    LoadError::malformed(source.name, At::File, what)
}

/// A linear channel in [0, 1] as an sRGB byte.
fn srgb(linear: f64) -> u8 {
    let encoded =
        if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round().clamp(0.0, 255.0) as u8
}

fn local(node: &Node) -> Matrix {
    if let Some(matrix) = node.matrix {
        return matrix;
    }
    let [x, y, z, w] = node.rotation;
    let s = node.scale;
    let t = node.translation;
    [
        s[0] * (1.0 - 2.0 * (y * y + z * z)),
        s[0] * 2.0 * (x * y + z * w),
        s[0] * 2.0 * (x * z - y * w),
        0.0,
        s[1] * 2.0 * (x * y - z * w),
        s[1] * (1.0 - 2.0 * (x * x + z * z)),
        s[1] * 2.0 * (y * z + x * w),
        0.0,
        s[2] * 2.0 * (x * z + y * w),
        s[2] * 2.0 * (y * z - x * w),
        s[2] * (1.0 - 2.0 * (x * x + y * y)),
        0.0,
        t[0],
        t[1],
        t[2],
        1.0,
    ]
}

fn multiply(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| (0..4).map(|k| a[4 * k + i % 4] * b[i - i % 4 + k]).sum())
}

fn transform(m: &Matrix, p: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|row| m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row])
}

/// Cofactors of the upper 3x3 (column-major), which transform normals, and its determinant.
fn cofactors(m: &Matrix) -> ([f64; 9], f64) {
    let at = |row: usize, column: usize| m[4 * (column % 3) + row % 3];
    let mut c = [0.0; 9];
    for column in 0..3 {
        for row in 0..3 {
            c[3 * column + row] = at(row + 1, column + 1) * at(row + 2, column + 2)
                - at(row + 1, column + 2) * at(row + 2, column + 1);
        }
    }
    let determinant = (0..3).map(|row| at(row, 0) * c[row]).sum();
    (c, determinant)
}
