//! Reading `.mesh` in place: no allocator, no copy, no `unsafe`.

use super::{HEADER, MAGIC, NO_TEXTURE, PALETTE_4, PALETTE_8, PART, TEXTURE, VERSION};
use super::{VERSION_WITHOUT_PALETTES, WRAPS, crc32};
use crate::text::{self, Sink, Value};
use bytemuck::AnyBitPattern;
use core::fmt;
use scanout::mesh::{Mesh, Normals, Sphere};
use scanout::texture::{Filter, Texels, Texture, Wrap};

/// Bytes at an address divisible by 4, which `include_bytes!` alone does not promise.
///
/// ```
/// use scanout_assets::bake::Aligned;
/// static MESH: &Aligned<[u8]> = &Aligned(*b"in firmware: *include_bytes!(\"teapot.mesh\")");
/// # assert_eq!(MESH.0.as_ptr() as usize % 4, 0);
/// ```
#[derive(Clone, Copy, Debug)]
#[repr(C, align(4))]
pub struct Aligned<B: ?Sized>(pub B);

/// Why bytes are not a usable `.mesh`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BakeError {
    /// The first bytes are not those of a `.mesh`.
    Magic,
    /// Another version of the format.
    Version(u16),
    /// The file is shorter than it says.
    Truncated {
        /// Bytes that the header promises.
        need: u32,
    },
    /// The bytes lie at an address that is not divisible by 4; wrap them in [`Aligned`].
    Misaligned,
    /// A section does not lie in the file, or its offset is not divisible by 4.
    Section {
        /// Byte of the record's field.
        at: u32,
    },
    /// An index refers to nothing, or a count contradicts another.
    Inconsistent {
        /// Byte of the record's field.
        at: u32,
    },
    /// The checksum differs.
    Checksum,
    /// This machine is big-endian; the tables are little-endian.
    Endian,
}

impl BakeError {
    /// What `Display` writes, for machines without room for `core::fmt`.
    pub fn tell(&self, to: Sink<'_>) {
        let (what, number) = match *self {
            Self::Magic => ("not a .mesh file; make one with `scanout bake`", 0),
            Self::Version(v) => {
                (".mesh version %, not up to %; bake it again, or update", v.into())
            }
            Self::Truncated { need } => ("shorter than its % bytes; copy it again", need),
            Self::Misaligned => ("not at an address divisible by 4; use bake::Aligned", 0),
            Self::Section { at } => ("byte %: a section lies outside; bake it again", at),
            Self::Inconsistent { at } => ("byte %: indices or counts disagree; bake it again", at),
            Self::Checksum => ("checksum differs; copy it again", 0),
            Self::Endian => ("a .mesh is read in place on little-endian machines only", 0),
        };
        let values = [Value::Number(number as usize), Value::Number(VERSION.into())];
        text::fill(what, &values, to);
    }
}

impl fmt::Display for BakeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        text::display(f, |to| self.tell(to))
    }
}

impl core::error::Error for BakeError {}

/// A baked model over borrowed bytes, checked once by [`read`].
#[derive(Clone, Copy, Debug)]
pub struct BakedMesh<'a> {
    bytes: &'a [u8],
    parts: usize,
    textures: usize,
    records: usize,
}

/// One part of a [`BakedMesh`].
#[derive(Clone, Copy, Debug)]
pub struct BakedPart<'a> {
    /// Name.
    pub name: &'a str,
    /// The mesh, in place.
    pub mesh: Mesh<'a>,
    /// Colour R, G, B.
    pub colour: [u8; 3],
    /// Weight of ambient light, Q16.16.
    pub ambient: i32,
    /// Weight of diffuse reflection, Q16.16.
    pub diffuse: i32,
    /// Weight of specular reflection, Q16.16.
    pub specular: i32,
    /// Exponent of the specular term.
    pub shininess: u16,
    /// Index for [`BakedMesh::texture`].
    pub texture: Option<usize>,
    /// What lies outside [0, 1) of the texture, for u and v: for the field of the same name of [`BakedMesh::texture`].
    pub wrap: [Wrap; 2],
    /// Draw back faces too.
    pub two_sided: bool,
}

/// Checks a `.mesh` and gives access to it. Every offset, count and index is checked here, so that what the
/// accessors return can be drawn without fear; O(triangles + edges). The checksum is checked only by
/// [`BakedMesh::verify`]. Bytes after the file's end are ignored.
///
/// # Errors
/// [`BakeError`]; the first thing found wrong.
pub fn read(bytes: &[u8]) -> Result<BakedMesh<'_>, BakeError> {
    if cfg!(target_endian = "big") {
        return Err(BakeError::Endian);
    }
    if !bytes.starts_with(&MAGIC) {
        return Err(BakeError::Magic);
    }
    if bytes.len() < HEADER {
        return Err(BakeError::Truncated { need: HEADER as u32 });
    }
    let version = u16_at(bytes, 4);
    let known = VERSION_WITHOUT_PALETTES..=VERSION;
    if !known.contains(&version) || usize::from(u16_at(bytes, 6)) != HEADER {
        return Err(BakeError::Version(version));
    }
    let need = u32_at(bytes, 8);
    let bytes = bytes.get(..need as usize).ok_or(BakeError::Truncated { need })?;
    if bytes.len() < HEADER {
        return Err(BakeError::Truncated { need: HEADER as u32 });
    }
    if bytes.as_ptr().align_offset(4) != 0 {
        return Err(BakeError::Misaligned);
    }
    let model = BakedMesh {
        bytes,
        parts: u16_at(bytes, 16).into(),
        textures: u16_at(bytes, 18).into(),
        records: u32_at(bytes, 20) as usize,
    };
    let size = model.parts * PART + model.textures * TEXTURE;
    slice::<u8>(bytes, model.records, size).ok_or(BakeError::Section { at: 20 })?;
    for index in 0..model.textures {
        model.checked_texture(index)?;
    }
    for index in 0..model.parts {
        model.check_part(index)?;
    }
    Ok(model)
}

impl<'a> BakedMesh<'a> {
    /// Number of parts.
    pub fn part_count(&self) -> usize {
        self.parts
    }

    /// Number of textures.
    pub fn texture_count(&self) -> usize {
        self.textures
    }

    /// Scale of the mesh grid, Q32.32: world units that a mesh position of 1.0 stands for.
    pub fn scale(&self) -> i64 {
        i64_at(self.bytes, 24)
    }

    /// World position of the mesh grid's origin, Q32.32.
    pub fn offset(&self) -> [i64; 3] {
        [32, 40, 48].map(|at| i64_at(self.bytes, at))
    }

    /// The parts, in order.
    pub fn parts(self) -> impl Iterator<Item = BakedPart<'a>> {
        (0..self.parts).filter_map(move |index| self.checked_part(index).ok())
    }

    /// One part, or `None` beyond the last.
    pub fn part(&self, index: usize) -> Option<BakedPart<'a>> {
        (index < self.parts).then(|| self.checked_part(index).ok()).flatten()
    }

    /// One texture (nearest texel, black border, repeating: give it its part's [`BakedPart::wrap`]), or `None` beyond the
    /// last.
    pub fn texture(&self, index: usize) -> Option<Texture<'a>> {
        (index < self.textures).then(|| self.checked_texture(index).ok()).flatten()
    }

    /// Checks the checksum over the whole file, O(bytes).
    ///
    /// # Errors
    /// [`BakeError::Checksum`].
    pub fn verify(&self) -> Result<(), BakeError> {
        let good = crc32(&self.bytes[16..]) == u32_at(self.bytes, 12);
        if good { Ok(()) } else { Err(BakeError::Checksum) }
    }

    /// The section whose offset stands at `field` and whose count is `count`.
    fn section<T: AnyBitPattern>(&self, field: usize, count: usize) -> Result<&'a [T], BakeError> {
        if count == 0 {
            return Ok(&[]);
        }
        slice(self.bytes, u32_at(self.bytes, field) as usize, count)
            .ok_or(BakeError::Section { at: field as u32 })
    }

    /// A palette and the bytes of indices behind it.
    fn paletted(
        &self,
        field: usize,
        colours: usize,
        bytes: usize,
    ) -> Result<(&'a [u16], &'a [u8]), BakeError> {
        let whole: &[u8] = self.section(field, 2 * colours + bytes)?;
        let (palette, indices) = whole.split_at(2 * colours);
        // Sections lie at addresses divisible by 4.
        let palette = bytemuck::try_cast_slice(palette)
            .map_err(|_| BakeError::Section { at: field as u32 })?;
        Ok((palette, indices))
    }

    fn counted<T: AnyBitPattern>(&self, field: usize) -> Result<&'a [T], BakeError> {
        self.section(field, u32_at(self.bytes, field + 4) as usize)
    }

    fn checked_part(&self, index: usize) -> Result<BakedPart<'a>, BakeError> {
        let at = self.records + index * PART;
        let bytes = self.bytes;
        let disagree = |field: usize| BakeError::Inconsistent { at: (at + field) as u32 };
        let name = core::str::from_utf8(self.counted(at)?).map_err(|_| disagree(0))?;
        let positions: &[[i16; 3]] = self.counted(at + 8)?;
        let normals: &[[i16; 3]] = self.counted(at + 16)?;
        let colours: &[[u8; 3]] = self.counted(at + 24)?;
        let uvs: &[[i32; 2]] = self.counted(at + 32)?;
        let triangles: &[[u16; 3]] = self.counted(at + 40)?;
        let has_uv_triangles = u32_at(bytes, at + 48) != 0;
        let uv_triangles: &[[u16; 3]] =
            self.section(at + 48, if has_uv_triangles { triangles.len() } else { 0 })?;
        let edges: &[[u16; 2]] = self.counted(at + 52)?;
        if positions.len() > 65_536 {
            return Err(disagree(8));
        }
        if !colours.is_empty() && colours.len() != positions.len() {
            return Err(disagree(24));
        }
        if uvs.len() > 65_536 || uvs.is_empty() != uv_triangles.is_empty() {
            return Err(disagree(32));
        }
        let normals = match (u16_at(bytes, at + 60), normals.len()) {
            (0, 0) => Normals::None,
            (1, n) if n == positions.len() => Normals::Vertex(normals),
            (2, n) if n == triangles.len() => Normals::Face(normals),
            _ => return Err(disagree(60)),
        };
        let flags = u16_at(bytes, at + 62);
        let texture = u16_at(bytes, at + 90);
        if texture != NO_TEXTURE && usize::from(texture) >= self.textures {
            return Err(disagree(90));
        }
        let bounds = Sphere {
            centre: [64, 66, 68].map(|field| u16_at(bytes, at + field) as i16),
            radius: u16_at(bytes, at + 70),
        };
        Ok(BakedPart {
            name,
            mesh: Mesh {
                positions,
                normals,
                colours,
                uvs,
                triangles,
                uv_triangles,
                edges,
                bounds: (flags & 2 != 0).then_some(bounds),
                clusters: &[],
            },
            colour: [72, 73, 74].map(|field| bytes[at + field]),
            ambient: u32_at(bytes, at + 76) as i32,
            diffuse: u32_at(bytes, at + 80) as i32,
            specular: u32_at(bytes, at + 84) as i32,
            shininess: u16_at(bytes, at + 88),
            texture: (texture != NO_TEXTURE).then_some(texture.into()),
            wrap: [2, 4].map(|bit| WRAPS[usize::from(flags >> bit & 3)]),
            two_sided: flags & 1 != 0,
        })
    }

    /// The part and all its indices.
    fn check_part(&self, index: usize) -> Result<(), BakeError> {
        let mesh = self.checked_part(index)?.mesh;
        let at = self.records + index * PART;
        let within =
            |indices: &[u16], count: usize| indices.iter().all(|&i| usize::from(i) < count);
        let checks = [
            (40, within(mesh.triangles.as_flattened(), mesh.positions.len())),
            (48, within(mesh.uv_triangles.as_flattened(), mesh.uvs.len())),
            (52, within(mesh.edges.as_flattened(), mesh.positions.len())),
        ];
        match checks.iter().find(|(_, good)| !good) {
            Some((field, _)) => Err(BakeError::Inconsistent { at: (at + field) as u32 }),
            None => Ok(()),
        }
    }

    fn checked_texture(&self, index: usize) -> Result<Texture<'a>, BakeError> {
        let at = self.records + self.parts * PART + index * TEXTURE;
        let [width, height, levels] = [0, 2, 4].map(|field| u16_at(self.bytes, at + field));
        let disagree = BakeError::Inconsistent { at: at as u32 };
        if ![width, height].iter().all(|side| (1..=1024).contains(side))
            || !(1..=11).contains(&levels)
        {
            return Err(disagree);
        }
        let level = |k| usize::from(width >> k).max(1) * usize::from(height >> k).max(1);
        let count = (0..levels).map(level).sum::<usize>();
        if u32_at(self.bytes, at + 12) as usize != count {
            return Err(disagree);
        }
        let texels = match u16_at(self.bytes, at + 6) {
            // The field meant nothing then.
            _ if u16_at(self.bytes, 4) == VERSION_WITHOUT_PALETTES => {
                Texels::Rgb565(self.counted(at + 8)?)
            }
            0 => Texels::Rgb565(self.counted(at + 8)?),
            PALETTE_8 => {
                let (palette, indices) = self.paletted(at + 8, 256, count)?;
                Texels::Palette8 { indices, palette }
            }
            PALETTE_4 => {
                let (palette, indices) = self.paletted(at + 8, 16, count.div_ceil(2))?;
                Texels::Palette4 { indices, palette }
            }
            _ => return Err(disagree),
        };
        Ok(Texture {
            width,
            height,
            levels: levels as u8,
            texels,
            wrap: [Wrap::Repeat; 2],
            filter: Filter::Nearest,
            border: [0; 3],
        })
    }
}

/// `count` elements at byte `offset`, if they lie in `bytes` and are aligned.
fn slice<T: AnyBitPattern>(bytes: &[u8], offset: usize, count: usize) -> Option<&[T]> {
    bytemuck::try_cast_slice(range(bytes, offset, count, size_of::<T>())?).ok()
}

/// The bytes of `count` elements: one function for all types.
#[inline(never)]
fn range(bytes: &[u8], offset: usize, count: usize, size: usize) -> Option<&[u8]> {
    if !offset.is_multiple_of(4) {
        return None;
    }
    bytes.get(offset..offset.checked_add(count.checked_mul(size)?)?)
}

// The callers have checked that the field lies in the file.

fn u16_at(bytes: &[u8], at: usize) -> u16 {
    u16::from_le_bytes([bytes[at], bytes[at + 1]])
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from(u16_at(bytes, at)) | u32::from(u16_at(bytes, at + 2)) << 16
}

fn i64_at(bytes: &[u8], at: usize) -> i64 {
    (u64::from(u32_at(bytes, at)) | u64::from(u32_at(bytes, at + 4)) << 32) as i64
}
