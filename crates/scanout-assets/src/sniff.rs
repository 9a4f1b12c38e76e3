//! What a file is by its content, for messages about files with another format's name.

use crate::load::Format;
use crate::reader;

/// What content looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Looks {
    /// A model: its format, and the name that people and `--input-format` use.
    Model(Format, &'static str),
    /// A picture.
    Picture(&'static str),
}

/// Bytes that are searched for a line of OBJ.
const SEARCHED: usize = 1 << 16;

/// What the content looks like; `None` when it could be anything.
pub(crate) fn sniff(bytes: &[u8]) -> Option<Looks> {
    let head = bytes.trim_ascii_start();
    Some(if bytes.starts_with(b"glTF") {
        Looks::Model(Format::Gltf, "GLB")
    } else if bytes.starts_with(b"\x89PNG") {
        Looks::Picture("PNG")
    } else if bytes.starts_with(&[0xff, 0xd8, 0xff]) {
        Looks::Picture("JPEG")
    } else if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
        Looks::Model(Format::Ply, "PLY")
    } else if reader::stl::looks_binary(bytes) || head.starts_with(b"solid") {
        Looks::Model(Format::Stl, "STL")
    } else if head.starts_with(b"{") {
        Looks::Model(Format::Gltf, "glTF")
    } else if has_obj_vertex(bytes) {
        Looks::Model(Format::Obj, "OBJ")
    } else {
        return None;
    })
}

/// What is wrong when a file is read as `format` and its content looks like something else.
pub(crate) fn mistaken(bytes: &[u8], format: Option<Format>) -> Option<String> {
    match sniff(bytes)? {
        Looks::Picture(name) => {
            Some(format!("a {name} picture, not a model; name an OBJ, STL, PLY, glTF or GLB file"))
        }
        Looks::Model(looks, name) => format.filter(|&format| format != looks).map(|_| {
            let option = name.to_ascii_lowercase();
            format!("this looks like {name}; rename it or use --input-format {option}")
        }),
    }
}

/// A line `v` with a number, early in a text.
fn has_obj_vertex(bytes: &[u8]) -> bool {
    let searched = &bytes[..bytes.len().min(SEARCHED)];
    !searched.contains(&0)
        && searched.split(|&b| b == b'\n' || b == b'\r').any(|line| {
            let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
            words.next() == Some(b"v")
                && words.next().is_some_and(|word| crate::number::Number::parse(word).is_some())
        })
}
