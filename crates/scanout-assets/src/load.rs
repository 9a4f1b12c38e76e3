//! The front door: a path or bytes in, a [`Model`] out.

use crate::assemble::assemble;
use crate::error::{At, LoadError, LoadErrorKind};
use crate::image::load_image;
use crate::model::Model;
use crate::raw::Raw;
use crate::reader::{self, Source};
use crate::sniff::mistaken;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// A model's file format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ with its MTL files.
    Obj,
    /// STL, text or binary.
    Stl,
    /// PLY, text or binary of either byte order.
    Ply,
    /// glTF 2.0, JSON or GLB.
    Gltf,
}

impl Format {
    /// The format that a file's extension names (`.gz` aside), or `None`.
    pub fn from_path(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
        let name = name.strip_suffix(".gz").unwrap_or(&name);
        match name.rsplit_once('.')?.1 {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "ply" => Some(Self::Ply),
            "gltf" | "glb" => Some(Self::Gltf),
            _ => None,
        }
    }

    /// The format that the content suggests. OBJ has no signature: text that is nothing else may be OBJ.
    pub fn from_content(bytes: &[u8]) -> Option<Self> {
        let head = bytes.trim_ascii_start();
        if bytes.starts_with(b"glTF") || head.starts_with(b"{") {
            Some(Self::Gltf)
        } else if bytes.starts_with(b"ply") {
            Some(Self::Ply)
        } else if reader::stl::looks_binary(bytes) || head.starts_with(b"solid") {
            Some(Self::Stl)
        } else {
            let text = !bytes.is_empty() && !bytes[..bytes.len().min(4096)].contains(&0);
            text.then_some(Self::Obj)
        }
    }
}

/// Where normals come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum NormalSource {
    /// The file's; computed as `Smooth` where it has none.
    #[default]
    FromFile,
    /// Computed: smooth, except across creases.
    Smooth,
    /// Computed: one a polygon.
    Flat,
}

/// What a file may cost at most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of one file (after `.gz` is unpacked), model or texture.
    pub file_bytes: u64,
    /// Positions, texture coordinates, normals, corners or lines of a model; each costs up to 100 bytes while loading.
    pub elements: u32,
}

impl Default for Limits {
    /// 512 MiB a file, 32 million elements.
    fn default() -> Self {
        Self { file_bytes: 512 << 20, elements: 32 << 20 }
    }
}

/// How to load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadOptions {
    /// Where normals come from.
    pub normals: NormalSource,
    /// Computed normals do not smooth across edges sharper than this, in degrees, 0 to 180 (angle between the normals).
    pub crease_degrees: f64,
    /// When no material names a texture, use the picture of the model's own name that lies beside it.
    pub texture_beside: bool,
    /// What a file may cost at most.
    pub limits: Limits,
}

impl Default for LoadOptions {
    /// The file's normals, a crease at 60 degrees, a texture of the same name.
    fn default() -> Self {
        Self {
            normals: NormalSource::FromFile,
            crease_degrees: 60.0,
            texture_beside: true,
            limits: Limits::default(),
        }
    }
}

/// Extensions of a picture beside the model, in the order they are tried.
const BESIDE: [&str; 6] = ["png", "ppm", "jpg", "jpeg", "pgm", "pnm"];

/// Loads a model from a file, with the materials and textures it refers to.
///
/// The format follows the extension, or else the content; `.gz` is unpacked. When no material names a texture, the mesh
/// has texture coordinates, and a picture of the same name lies beside the file (`torus.obj`, `torus.ppm`), that picture
/// is used and a note says so.
///
/// # Errors
/// [`LoadError`], one line with place and remedy. Missing materials and textures are warnings.
pub fn load(path: impl AsRef<Path>, options: &LoadOptions) -> Result<Model, LoadError> {
    let path = path.as_ref();
    let name = path.display().to_string();
    let bytes = read_file(path, options.limits.file_bytes)?;
    let base = path.parent().map(|p| if p.as_os_str().is_empty() { Path::new(".") } else { p });
    let mut raw_model = read(&bytes, Format::from_path(path), &name, base, options)?;
    if options.texture_beside {
        texture_beside(&mut raw_model, path, options);
    }
    let mut model = assemble(raw_model, &name, options)?;
    model.stats.file_bytes = bytes.len() as u64;
    Ok(model)
}

/// Loads a model from bytes, for example from standard input. `format` overrules what the content suggests; `name` stands
/// in messages; files that the model refers to are looked for in `base`, or are missing (a warning) without it.
///
/// # Errors
/// As [`load`].
pub fn load_bytes(
    bytes: &[u8],
    format: Option<Format>,
    name: &str,
    base: Option<&Path>,
    options: &LoadOptions,
) -> Result<Model, LoadError> {
    let raw = read(bytes, format, name, base, options)?;
    let mut model = assemble(raw, name, options)?;
    model.stats.file_bytes = bytes.len() as u64;
    Ok(model)
}

fn read(
    bytes: &[u8],
    format: Option<Format>,
    name: &str,
    base: Option<&Path>,
    options: &LoadOptions,
) -> Result<Raw, LoadError> {
    let unpacked;
    let bytes = if bytes.starts_with(&[0x1f, 0x8b]) {
        unpacked = gunzip(bytes, name, options.limits.file_bytes)?;
        &unpacked
    } else {
        bytes
    };
    if bytes.is_empty() {
        return Err(LoadError {
            kind: LoadErrorKind::Empty,
            file: name.into(),
            at: At::File,
            what: "the file is empty; export it again".into(),
        });
    }
    if let Some(what) = mistaken(bytes, format) {
        return Err(LoadError::unsupported(name, At::File, what));
    }
    let Some(format) = format.or_else(|| Format::from_content(bytes)) else {
        return Err(LoadError::unsupported(
            name,
            At::File,
            "not recognised; models are OBJ, STL, PLY, glTF or GLB",
        ));
    };
    let source = Source { name, bytes, base, limits: &options.limits };
    match format {
        Format::Obj => match utf8(bytes) {
            Some(text) => reader::obj::read(&Source { bytes: &text, ..source }),
            None => reader::obj::read(&source),
        },
        Format::Stl => reader::stl::read(&source),
        Format::Ply => reader::ply::read(&source),
        Format::Gltf => reader::gltf::read(&source),
    }
}

/// Text that begins with a byte order mark, without it and as UTF-8; `None` for bytes without a mark.
fn utf8(bytes: &[u8]) -> Option<Vec<u8>> {
    let wide = |to_u16: fn([u8; 2]) -> u16| {
        let units = bytes[2..].chunks_exact(2).map(|pair| to_u16([pair[0], pair[1]]));
        let text: String =
            char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
        text.into_bytes()
    };
    match bytes {
        [0xef, 0xbb, 0xbf, text @ ..] => Some(text.to_vec()),
        [0xfe, 0xff, ..] => Some(wide(u16::from_be_bytes)),
        [0xff, 0xfe, ..] => Some(wide(u16::from_le_bytes)),
        _ => None,
    }
}

fn texture_beside(raw: &mut Raw, model: &Path, options: &LoadOptions) {
    // A texture that is named but missing was warned about; another picture would be a guess.
    if raw.uvs.is_empty() || !raw.images.is_empty() || raw.texture_named {
        return;
    }
    for extension in BESIDE {
        let path = model.with_extension(extension);
        if !path.is_file() {
            continue;
        }
        match load_image(&path, &options.limits) {
            Ok((image, warnings)) => {
                raw.warnings.note(format!(
                    "no material names a texture; {} beside the model is used",
                    path.display()
                ));
                warnings.into_iter().for_each(|w| raw.warnings.warn(w.text));
                raw.images.push(image);
                for material in &mut raw.materials {
                    if material.name == "default" {
                        material.colour = [255; 3];
                    }
                    material.texture = Some(0);
                }
            }
            Err(error) => raw.warnings.warn(error.to_string()),
        }
        return;
    }
}

/// A whole file, at most `limit` bytes of it.
pub(crate) fn read_file(path: &Path, limit: u64) -> Result<Vec<u8>, LoadError> {
    let fail = |error: std::io::Error| LoadError {
        kind: LoadErrorKind::Io,
        file: path.display().to_string(),
        at: At::File,
        what: io_text(&error),
    };
    let file = File::open(path).map_err(fail)?;
    let meta = file.metadata().map_err(fail)?;
    if meta.is_dir() {
        return Err(fail(std::io::Error::from(std::io::ErrorKind::IsADirectory)));
    }
    read_limited(file, limit).map_err(fail)?.ok_or_else(|| {
        LoadError::too_large(
            &path.display().to_string(),
            format!("larger than {limit} bytes; simplify it"),
        )
    })
}

/// Short reasons with a remedy for the frequent failures.
fn io_text(error: &std::io::Error) -> String {
    use std::io::ErrorKind;
    match error.kind() {
        ErrorKind::NotFound => "no such file; check the path".into(),
        ErrorKind::PermissionDenied => "permission denied; check the file's mode".into(),
        ErrorKind::IsADirectory => "is a directory; name a file in it".into(),
        _ => format!("{error}; try again"),
    }
}

/// All bytes of `from`, or `None` when there are more than `limit`.
fn read_limited(from: impl Read, limit: u64) -> std::io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    from.take(limit.saturating_add(1)).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= limit).then_some(bytes))
}

fn gunzip(bytes: &[u8], name: &str, limit: u64) -> Result<Vec<u8>, LoadError> {
    read_limited(flate2::read::MultiGzDecoder::new(bytes), limit)
        .map_err(|error| {
            LoadError::malformed(name, At::File, format!("gzip: {error}; copy the file again"))
        })?
        .ok_or_else(|| {
            LoadError::too_large(name, format!("unpacks to more than {limit} bytes; simplify it"))
        })
}

#[cfg(test)]
#[path = "load_tests.rs"]
mod tests;
