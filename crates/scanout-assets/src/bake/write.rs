//! Writing baked models.

use super::{HEADER, MAGIC, NO_TEXTURE, PALETTE_4, PALETTE_8, PART, TEXTURE, VERSION};
use super::{VERSION_WITHOUT_PALETTES, crc32, hex, wrap_bits};
use crate::model::{Model, NormalsBuf, Part};
use crate::palette::TextureFormat;
use std::fs::File;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// The `.mesh` binary of a model; textures as RGB565, with the mip levels that the images have.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] when the model has more than 65,535 parts or textures or 4 GiB.
pub fn to_binary(model: &Model) -> io::Result<Vec<u8>> {
    to_binary_as(model, TextureFormat::Rgb565)
}

/// [`to_binary`] with its textures in a format of one's choice: version 1 of the file where that is RGB565, else 2.
///
/// # Errors
/// As [`to_binary`].
pub fn to_binary_as(model: &Model, format: TextureFormat) -> io::Result<Vec<u8>> {
    let too_many = || io::Error::new(ErrorKind::InvalidInput, "the model is too large for a .mesh");
    let parts = u16::try_from(model.parts.len()).map_err(|_| too_many())?;
    let textures = u16::try_from(model.images.len()).map_err(|_| too_many())?;
    let records = HEADER + usize::from(parts) * PART + usize::from(textures) * TEXTURE;
    let mut out = vec![0; records];
    out[..4].copy_from_slice(&MAGIC);
    // What needs no later version is readable by older firmware.
    let palette = format.colours().filter(|_| textures > 0);
    put16(&mut out, 4, if palette.is_some() { VERSION } else { VERSION_WITHOUT_PALETTES });
    put16(&mut out, 6, HEADER as u16);
    put16(&mut out, 16, parts);
    put16(&mut out, 18, textures);
    put32(&mut out, 20, HEADER as u32);
    put_q32(&mut out, 24, model.placement.scale);
    for (axis, &offset) in model.placement.offset.iter().enumerate() {
        put_q32(&mut out, 32 + 8 * axis, offset);
    }
    for (index, part) in model.parts.iter().enumerate() {
        put_part(&mut out, HEADER + index * PART, part, textures);
    }
    for (index, image) in model.images.iter().enumerate() {
        let at = HEADER + usize::from(parts) * PART + index * TEXTURE;
        put16(&mut out, at, image.width);
        put16(&mut out, at + 2, image.height);
        put16(&mut out, at + 4, image.levels.into());
        if let Some(colours) = palette {
            let paletted = image.to_palette(colours);
            let pairs = || paletted.indices.chunks(2).map(|p| p[0] | p.get(1).unwrap_or(&0) << 4);
            let indices = if colours == 16 { pairs().collect() } else { paletted.indices.clone() };
            put16(&mut out, at + 6, if colours == 16 { PALETTE_4 } else { PALETTE_8 });
            let palette = paletted.palette.iter().flat_map(|t| t.to_le_bytes());
            section(&mut out, at + 8, paletted.indices.len(), palette.chain(indices));
            continue;
        }
        let texels = image.to_rgb565();
        section(&mut out, at + 8, texels.len(), texels.iter().flat_map(|t| t.to_le_bytes()));
    }
    let size = u32::try_from(out.len()).map_err(|_| too_many())?;
    put32(&mut out, 8, size);
    let crc = crc32(&out[16..]);
    put32(&mut out, 12, crc);
    Ok(out)
}

/// Writes [`to_binary`] to a file. Models of any number of vertices fit: parts are split where 16-bit indices end.
///
/// # Errors
/// As [`to_binary`], and whatever the operating system says; an incomplete file is removed.
pub fn write_binary(model: &Model, path: impl AsRef<Path>) -> io::Result<()> {
    write_binary_as(model, TextureFormat::Rgb565, path)
}

/// Writes [`to_binary_as`] to a file.
///
/// # Errors
/// As [`write_binary`].
pub fn write_binary_as(
    model: &Model,
    format: TextureFormat,
    path: impl AsRef<Path>,
) -> io::Result<()> {
    write_file(path.as_ref(), &to_binary_as(model, format)?)
}

/// As `std::fs::write`, but leaves no part of a file when the disk is full.
fn write_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes).inspect_err(|_| {
        // Not a device.
        if path.is_file() {
            let _ = std::fs::remove_file(path);
        }
    })
}

/// Writes the `.hex` tables, `mesh.svh` and `README.md` into a folder, which is made when missing; returns the files.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] with [`super::HexError`]'s text and remedy, before anything is written, when the model
/// does not fit ([`super::check_hex`] says so without writing); whatever the operating system says, after removing what
/// was written.
pub fn write_hex(model: &Model, folder: impl AsRef<Path>) -> io::Result<Vec<PathBuf>> {
    let files =
        hex::hex_files(model).map_err(|error| io::Error::new(ErrorKind::InvalidInput, error))?;
    std::fs::create_dir_all(&folder)?;
    let mut written = Vec::new();
    for (name, text) in files {
        let path = folder.as_ref().join(name);
        if let Err(error) = write_file(&path, text.as_bytes()) {
            written.iter().for_each(|path| drop(std::fs::remove_file(path)));
            return Err(error);
        }
        written.push(path);
    }
    Ok(written)
}

fn put_part(out: &mut Vec<u8>, at: usize, part: &Part, textures: u16) {
    let (mesh, material) = (&part.mesh, &part.material);
    let (kind, normals): (u16, &[[i16; 3]]) = match &mesh.normals {
        NormalsBuf::None => (0, &[]),
        NormalsBuf::Vertex(n) => (1, n),
        NormalsBuf::Face(n) => (2, n),
    };
    let i16s =
        |v: &[[i16; 3]]| v.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
    let u16s = |v: &[u16]| v.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
    section(out, at, part.name.len(), part.name.bytes());
    section(out, at + 8, mesh.positions.len(), i16s(&mesh.positions));
    section(out, at + 16, normals.len(), i16s(normals));
    section(out, at + 24, mesh.colours.len(), mesh.colours.as_flattened().iter().copied());
    let uvs = mesh.uvs.as_flattened().iter().flat_map(|x| x.to_le_bytes());
    section(out, at + 32, mesh.uvs.len(), uvs);
    section(out, at + 40, mesh.triangles.len(), u16s(mesh.triangles.as_flattened()));
    let uv_triangles = u16s(mesh.uv_triangles.as_flattened());
    if !uv_triangles.is_empty() {
        align(out);
        let offset = out.len() as u32;
        put32(out, at + 48, offset);
        out.extend(uv_triangles);
    }
    section(out, at + 52, mesh.edges.len(), u16s(mesh.edges.as_flattened()));
    put16(out, at + 60, kind);
    let flags = u16::from(material.two_sided) | u16::from(mesh.bounds.is_some()) << 1;
    put16(out, at + 62, flags | u16::from(wrap_bits(material.wrap)) << 2);
    if let Some(bounds) = mesh.bounds {
        for axis in 0..3 {
            put16(out, at + 64 + 2 * axis, bounds.centre[axis] as u16);
        }
        put16(out, at + 70, bounds.radius);
    }
    out[at + 72..at + 75].copy_from_slice(&material.colour);
    for (i, weight) in
        [material.ambient, material.diffuse, material.specular].into_iter().enumerate()
    {
        put32(out, at + 76 + 4 * i, (weight * 65536.0).round() as i32 as u32);
    }
    put16(out, at + 88, material.shininess);
    let texture = material.texture.and_then(|t| u16::try_from(t).ok()).filter(|&t| t < textures);
    put16(out, at + 90, texture.unwrap_or(NO_TEXTURE));
}

/// Appends a section and notes its offset and count at `field`.
fn section(out: &mut Vec<u8>, field: usize, count: usize, bytes: impl IntoIterator<Item = u8>) {
    align(out);
    let offset = out.len() as u32;
    put32(out, field, offset);
    put32(out, field + 4, count as u32);
    out.extend(bytes);
    align(out);
}

fn align(out: &mut Vec<u8>) {
    out.resize(out.len().next_multiple_of(4), 0);
}

fn put16(out: &mut [u8], at: usize, value: u16) {
    out[at..at + 2].copy_from_slice(&value.to_le_bytes());
}

fn put32(out: &mut [u8], at: usize, value: u32) {
    out[at..at + 4].copy_from_slice(&value.to_le_bytes());
}

/// Q32.32, nearest; `as` saturates.
fn put_q32(out: &mut [u8], at: usize, value: f64) {
    let fixed = (value * 4_294_967_296.0).round() as i64;
    out[at..at + 8].copy_from_slice(&fixed.to_le_bytes());
}
