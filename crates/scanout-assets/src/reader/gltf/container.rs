//! Where the bytes are: GLB chunks, local files, data URIs.

use super::schema::{Document, Versioned};
use crate::error::{At, LoadError};
use crate::load::read_file;
use crate::reader::{Source, find_file};
use std::borrow::Cow;
use std::path::PathBuf;

const JSON: &[u8] = b"JSON";
const BIN: &[u8] = b"BIN\0";

/// The document and the binary chunk of a GLB.
pub(super) fn parse<'a>(source: &Source<'a>) -> Result<(Document, Option<&'a [u8]>), LoadError> {
    let bytes = source.bytes;
    if !bytes.starts_with(b"glTF") {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
        if !text.starts_with(b"{") {
            let what = "neither GLB ('glTF') nor glTF ('{'); export it again";
            return Err(LoadError::malformed(source.name, At::File, what));
        }
        return Ok((document(source, bytes)?, None));
    }
    let fail = |at: usize, what: &str| LoadError::malformed(source.name, At::Byte(at as u64), what);
    let word = |at: usize| {
        let b = bytes.get(at..at + 4)?;
        Some(u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
    };
    match word(4) {
        Some(2) => {}
        Some(_) => return Err(fail(4, "not version 2 of GLB; export as glTF 2.0")),
        None => return Err(fail(bytes.len(), "the header is cut short; copy the file again")),
    }
    let (mut json, mut binary) = (None, None);
    let mut at = 12;
    while at < bytes.len() {
        let length =
            word(at).ok_or_else(|| fail(at, "a chunk is cut short; copy the file again"))?;
        let body = (at + 8)
            .checked_add(length as usize)
            .and_then(|end| bytes.get(at + 8..end))
            .ok_or_else(|| fail(at, "a chunk is longer than the file; copy the file again"))?;
        match &bytes[at + 4..at + 8] {
            JSON => json = json.or(Some(body)),
            BIN => binary = binary.or(Some(body)),
            _ => {}
        }
        at += 8 + body.len();
    }
    let json = json.ok_or_else(|| fail(12, "no JSON chunk; export the file again"))?;
    Ok((document(source, json)?, binary))
}

fn document(source: &Source<'_>, json: &[u8]) -> Result<Document, LoadError> {
    let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    serde_json::from_slice(json).map_err(|error| {
        // Version 1 has objects where version 2 has arrays.
        let version = serde_json::from_slice::<Versioned>(json).map(|v| v.asset.version);
        if version.is_ok_and(|version| version.starts_with('1')) {
            let what = "glTF 1.0 is not read; convert it to glTF 2.0";
            return LoadError::unsupported(source.name, At::File, what);
        }
        let line = u32::try_from(error.line()).unwrap_or(u32::MAX);
        let at = At::Line(line);
        match error.classify() {
            serde_json::error::Category::Eof => {
                LoadError::malformed(source.name, at, "the JSON ends early; copy the file again")
            }
            serde_json::error::Category::Data => {
                let text = error.to_string();
                let text = text.rsplit_once(" at line ").map_or(text.as_str(), |(text, _)| text);
                let text: String = text.chars().take(160).collect();
                LoadError::malformed(source.name, at, format!("{text}; is this glTF 2.0?"))
            }
            _ => {
                let what = format!("not JSON from column {}; export it again", error.column());
                LoadError::malformed(source.name, at, what)
            }
        }
    })
}

/// All buffers; together at most the limit of a file.
pub(super) fn buffers<'a>(
    document: &Document,
    binary: Option<&'a [u8]>,
    source: &Source<'a>,
) -> Result<Vec<Cow<'a, [u8]>>, LoadError> {
    let mut buffers = Vec::new();
    let mut left = source.limits.file_bytes;
    for (index, buffer) in document.buffers.iter().enumerate() {
        let fail = |what: &str| super::malformed(source, format!("buffer {index}: {what}"));
        let bytes = match &buffer.uri {
            None if index == 0 => Cow::Borrowed(
                binary.ok_or_else(|| fail("it has no data; keep the .bin beside the file"))?,
            ),
            None => return Err(fail("it has no data; only the first may lie in the GLB")),
            Some(uri) if uri.starts_with("data:") => {
                Cow::Owned(data_uri(uri).ok_or_else(|| fail("not a base64 data URI"))?)
            }
            Some(uri) => Cow::Owned(read_file(&local_file(uri, source)?, left)?),
        };
        if bytes.len() < buffer.byte_length {
            return Err(fail(&format!(
                "{} of its {} bytes are there; copy it again",
                bytes.len(),
                buffer.byte_length
            )));
        }
        if let Cow::Owned(owned) = &bytes {
            left = left.saturating_sub(owned.len() as u64);
        }
        buffers.push(bytes);
    }
    Ok(buffers)
}

/// The local file that a URI names, relative to the document.
pub(super) fn local_file(uri: &str, source: &Source<'_>) -> Result<PathBuf, LoadError> {
    let shown: String = uri.chars().take(80).collect();
    // A drive letter is not a scheme.
    if uri.split_once(':').is_some_and(|(scheme, rest)| scheme.len() > 1 && rest.starts_with("//"))
    {
        let what = format!("'{shown}' is not a local file; download it beside the model");
        return Err(LoadError::unsupported(source.name, At::File, what));
    }
    let folders: Vec<_> = source.base.into_iter().collect();
    find_file(&percent_decoded(uri), &folders).or_else(|| find_file(uri, &folders)).ok_or_else(
        || {
            let what = format!("'{shown}' {}", source.missing(&folders));
            LoadError {
                kind: crate::LoadErrorKind::Io,
                file: source.name.into(),
                at: At::File,
                what,
            }
        },
    )
}

fn percent_decoded(uri: &str) -> String {
    let hex = |b: Option<&u8>| b.and_then(|&b| (b as char).to_digit(16));
    let bytes = uri.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        match (byte, hex(bytes.get(at + 1)), hex(bytes.get(at + 2))) {
            (b'%', Some(high), Some(low)) => {
                out.push((high * 16 + low) as u8);
                at += 3;
            }
            _ => {
                out.push(byte);
                at += 1;
            }
        }
    }
    String::from_utf8_lossy(&out).into_owned()
}

/// The bytes of `data:...;base64,...`.
pub(super) fn data_uri(uri: &str) -> Option<Vec<u8>> {
    let (head, body) = uri.split_once(',')?;
    if !head.ends_with(";base64") {
        return None;
    }
    let mut out = Vec::with_capacity(body.len() / 4 * 3);
    let (mut word, mut bits) = (0u32, 0);
    for byte in body.trim_end_matches('=').bytes() {
        let six = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            b if b.is_ascii_whitespace() => continue,
            _ => return None,
        };
        word = word << 6 | u32::from(six);
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            out.push((word >> bits) as u8);
            word &= (1 << bits) - 1;
        }
    }
    Some(out)
}
