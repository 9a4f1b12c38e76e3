//! The header of a PLY file: its elements and their properties.

use super::values::Values;
use crate::error::{At, LoadError};
use crate::reader::Source;

/// A number's type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    fn parse(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }

    /// Bytes in a binary file.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// One property; a list has a type for its length.
#[derive(Debug)]
pub(super) struct Property {
    pub name: String,
    pub kind: Kind,
    pub list: Option<Kind>,
}

/// One kind of element.
#[derive(Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

#[derive(Debug, Default)]
pub(super) struct Header {
    pub elements: Vec<Element>,
    /// From `comment TextureFile NAME`.
    pub texture: Option<String>,
    /// Lines that are not understood.
    pub unknown: u64,
}

/// Lines that a header may have.
const LINES: u32 = 10_000;

/// Splits the file into its header and its body.
pub(super) fn parse<'a>(source: &'a Source<'a>) -> Result<(Header, Values<'a>), LoadError> {
    let mut header = Header::default();
    let mut format = None;
    let mut begin = 0;
    for line_number in 1..=LINES {
        let fail =
            |what: String| Err(LoadError::malformed(source.name, At::Line(line_number), what));
        let rest = &source.bytes[begin..];
        let Some(length) = rest.iter().position(|&b| b == b'\n' || b == b'\r') else {
            return fail("the header has no end_header; copy the file again".into());
        };
        let two = rest[length..].starts_with(b"\r\n");
        let line = String::from_utf8_lossy(rest[..length].trim_ascii());
        begin += length + 1 + usize::from(two);
        let words: Vec<_> = line.split_whitespace().collect();
        if line_number == 1 {
            if words != ["ply"] {
                return fail("the first line is not 'ply'; is this a PLY file?".into());
            }
            continue;
        }
        match words[..] {
            ["format", "ascii", ..] => format = Some(None),
            ["format", "binary_little_endian", ..] => format = Some(Some(false)),
            ["format", "binary_big_endian", ..] => format = Some(Some(true)),
            ["format", ..] => {
                return fail(format!("unknown '{line}'; export as ascii or binary_little_endian"));
            }
            ["element", name, count] => {
                let Ok(count) = count.parse() else {
                    return fail(format!("'{count}' is not a number of elements; mend the header"));
                };
                header.elements.push(Element { name: name.into(), count, properties: Vec::new() });
            }
            ["property", ref property @ ..] => {
                let Some(element) = header.elements.last_mut() else {
                    return fail("a property before the first element; mend the header".into());
                };
                match parse_property(property) {
                    Some(property) => element.properties.push(property),
                    None => {
                        return fail(format!("'{line}' is no property of PLY 1.0; export again"));
                    }
                }
            }
            ["comment", "TextureFile", ..] => {
                let name = line.split_once("TextureFile").map_or("", |(_, name)| name.trim());
                header.texture = Some(name.into());
            }
            ["end_header"] => {
                let Some(big_endian) = format else {
                    return fail("the header has no format line; export again".into());
                };
                check_sizes(&header, source, &source.bytes[begin..], big_endian.is_some())?;
                let values = Values::new(source.bytes, begin, line_number + 1, big_endian);
                return Ok((header, values));
            }
            [] | ["comment" | "obj_info", ..] => {}
            // Some exporters break their comments over several lines.
            _ => header.unknown += 1,
        }
    }
    Err(LoadError::malformed(
        source.name,
        At::Line(LINES),
        "the header does not end; is this a PLY file?",
    ))
}

fn parse_property(words: &[&str]) -> Option<Property> {
    match *words {
        ["list", length, kind, name] => {
            let list = Some(Kind::parse(length)?);
            Some(Property { name: name.into(), kind: Kind::parse(kind)?, list })
        }
        [kind, name] => Some(Property { name: name.into(), kind: Kind::parse(kind)?, list: None }),
        _ => None,
    }
}

/// Refuses counts that the remaining bytes can't hold, before anything is read or allocated.
fn check_sizes(
    header: &Header,
    source: &Source<'_>,
    body: &[u8],
    binary: bool,
) -> Result<(), LoadError> {
    for element in &header.elements {
        // At least the length of each list and each scalar; in text a digit and a space, but the last.
        let least: u64 = element
            .properties
            .iter()
            .map(|p| if binary { p.list.unwrap_or(p.kind).size() as u64 } else { 2 })
            .sum();
        if element.count.saturating_mul(least) > body.len() as u64 + 1 {
            return Err(LoadError::malformed(
                source.name,
                At::File,
                format!(
                    "{} '{}' elements don't fit into the {} bytes that follow; copy it again",
                    element.count,
                    element.name,
                    body.len()
                ),
            ));
        }
        if least == 0 && matches!(element.name.as_str(), "vertex" | "face") && element.count > 0 {
            return Err(LoadError::malformed(
                source.name,
                At::File,
                format!("'{}' elements have no properties; export again", element.name),
            ));
        }
    }
    Ok(())
}
