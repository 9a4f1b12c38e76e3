use crate::load::{Format, LoadOptions, load_bytes};
use crate::model::{Model, NormalsBuf};
use crate::{LoadError, NormalSource};

fn load(bytes: &[u8]) -> Result<Model, LoadError> {
    let options = LoadOptions { normals: NormalSource::FromFile, ..LoadOptions::default() };
    load_bytes(bytes, Some(Format::Ply), "t.ply", None, &options)
}

const TEXT: &str = "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 5\n\
property float x\nproperty double y\nproperty float z\n\
property uchar red\nproperty uchar green\nproperty uchar blue\nproperty short quality\n\
property float s\nproperty float t\nelement other 2\nproperty list uchar int what\n\
element face 2\nproperty list uchar int vertex_indices\nproperty uchar flags\nend_header\n\
0 0 0 255 0 0 -7 0 0\n1 0 0 0 255 0 -7 1 0\n1 1 0 0 0 255 -7 1 1\n0 1 0 9 9 9 -7 0 1\n\
0.5 0.5 1.5 1 2 3 -7 .5 .5\n2 1 2\n0\n4 0 3 2 1 9\n3 0 1 4 9\n";

/// The same content in binary.
fn binary(big: bool) -> Vec<u8> {
    let (head, body) = TEXT.split_once("end_header\n").unwrap();
    let name = if big { "binary_big_endian" } else { "binary_little_endian" };
    let mut out = head.replace("ascii", name).into_bytes();
    out.extend(b"end_header\n");
    let mut put = |bytes: &mut [u8]| {
        if big {
            bytes.reverse();
        }
        out.extend_from_slice(bytes);
    };
    for (index, line) in body.lines().enumerate() {
        let words: Vec<f64> = line.split(' ').map(|w| w.parse().unwrap()).collect();
        for (i, &w) in words.iter().enumerate() {
            match (index, i) {
                (..5, 1) => put(&mut w.to_le_bytes()),
                (..5, 3..=5) => put(&mut [w as u8]),
                (..5, 6) => put(&mut (w as i16).to_le_bytes()),
                (..5, _) => put(&mut (w as f32).to_le_bytes()),
                (_, 0) => put(&mut [w as u8]),
                (7.., last) if last == words.len() - 1 => put(&mut [w as u8]),
                _ => put(&mut (w as i32).to_le_bytes()),
            }
        }
    }
    out
}

#[test]
fn text_and_both_binaries_agree() {
    let text = load(TEXT.as_bytes()).unwrap();
    let mesh = &text.parts[0].mesh;
    assert_eq!((mesh.positions.len(), mesh.triangles.len(), mesh.edges.len()), (5, 3, 6));
    assert_eq!(mesh.colours[0], [255, 0, 0]);
    assert!(mesh.uvs.contains(&[0, 65536]), "v is turned downwards");
    assert_eq!(text.parts[0].material.colour, [255; 3]);
    assert!(matches!(mesh.normals, NormalsBuf::Face(_)));
    for big in [false, true] {
        assert_eq!(load(&binary(big)).unwrap().parts, text.parts);
    }
    assert_eq!(load(TEXT.replace('\n', "\r\n").as_bytes()).unwrap().parts, text.parts);
    let stdin = load_bytes(TEXT.as_bytes(), None, "-", None, &LoadOptions::default()).unwrap();
    assert_eq!(stdin.parts, text.parts);
}

#[test]
fn gz_is_unpacked() {
    use std::io::Write;
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(TEXT.as_bytes()).unwrap();
    let packed = packer.finish().unwrap();
    assert_eq!(load(&packed).unwrap().parts, load(TEXT.as_bytes()).unwrap().parts);
    assert!(load(&packed[..packed.len() / 2]).unwrap_err().to_string().contains("gzip"));
    let mut options = LoadOptions::default();
    options.limits.file_bytes = 100;
    let error = load_bytes(&packed, None, "t.ply.gz", None, &options).unwrap_err();
    assert!(error.to_string().contains("unpacks to more"));
}

#[test]
fn strips_edges_and_clouds() {
    let head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
        property float z\nproperty float nx\nproperty float ny\nproperty float nz\n";
    let vertices = "0 0 0 0 0 2\n1 0 0 0 0 2\n0 1 0 0 0 2\n1 1 0 0 0 2\n";
    let strip = format!(
        "{head}element tristrips 1\nproperty list int int vertex_indices\nend_header\n{vertices}6 0 1 2 3 -1 0\n"
    );
    let mesh = load(strip.as_bytes()).unwrap().parts.remove(0).mesh;
    assert_eq!(mesh.triangles, [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(mesh.normals, NormalsBuf::Face(vec![[0, 0, 16384]; 2]));
    let edge = format!(
        "{head}element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n{vertices}0 3\n"
    );
    let mesh = load(edge.as_bytes()).unwrap().parts.remove(0).mesh;
    assert_eq!((mesh.edges.len(), mesh.positions.len()), (1, 2));
    let cloud = load(format!("{head}end_header\n{vertices}").as_bytes()).unwrap();
    assert_eq!(cloud.parts[0].mesh.positions.len(), 4);
    assert_eq!(cloud.parts[0].mesh.normals, NormalsBuf::Vertex(vec![[0, 0, 16384]; 4]));
}

#[test]
fn broken_files_are_one_line() {
    let with = |from: &str, to: &str| TEXT.replace(from, to).into_bytes();
    for (bytes, message) in [
        (b"".to_vec(), "t.ply: the file is empty"),
        (b"plx\n".to_vec(), "t.ply:1: the first line"),
        (b"ply\nformat ascii 1.0".to_vec(), "t.ply:2: the header has no end_header"),
        (b"ply\nend_header\n".to_vec(), "t.ply:2: the header has no format"),
        (b"ply\n\xff\xfe\n".to_vec(), "t.ply:3: the header has no end_header"),
        (with("ascii", "utf8"), "t.ply:2: unknown"),
        (with("vertex 5", "vertex five"), "t.ply:4: 'five'"),
        (with("vertex 5", "vertex 99999999999"), "t.ply: 99999999999 'vertex' elements"),
        (with("vertex 5", "vertex 6"), "t.ply:29: the file ends"),
        (with("float x", "float q"), "t.ply:20: vertices have no x"),
        (with("0.5 0.5 1.5", "0.5 nan 1.5"), "t.ply:24: the file ends, or is not numeric"),
        (with("0.5 0.5 1.5", "0.5 1e31 1.5"), "t.ply:24: a coordinate"),
        (with("4 0 3 2 1", "4 0 3 2 5"), "t.ply:27: vertex 5 of 5"),
        (with("4 0 3 2 1", "4 0 3 2 -1"), "t.ply:27: vertex -1 of 5"),
        (with("4 0 3 2 1", "-4 0 3 2 1"), "t.ply:27: a list of length -4"),
    ] {
        let error = load(&bytes).unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
}

#[test]
fn every_truncation_is_survived() {
    for bytes in [TEXT.as_bytes().to_vec(), binary(false), binary(true)] {
        for end in 0..bytes.len() - 2 {
            assert!(load(&bytes[..end]).is_err(), "{end}");
        }
    }
}
