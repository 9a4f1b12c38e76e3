use super::container::data_uri;
use crate::load::{Format, LoadOptions, load_bytes};
use crate::model::{Model, NormalsBuf};
use crate::{LoadError, LoadErrorKind};
use scanout::texture::Wrap;

fn load(bytes: &[u8]) -> Result<Model, LoadError> {
    load_bytes(bytes, Some(Format::Gltf), "t.gltf", None, &LoadOptions::default())
}

fn base64(bytes: &[u8]) -> String {
    let letters = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::new();
    for chunk in bytes.chunks(3) {
        let word =
            chunk.iter().fold(0u32, |w, &b| w << 8 | u32::from(b)) << (8 * (3 - chunk.len()));
        for i in 0..=chunk.len() {
            out.push(letters[(word >> (18 - 6 * i)) as usize & 63] as char);
        }
    }
    out + &"=".repeat((3 - chunk_rest(bytes.len())) % 3)
}

fn chunk_rest(length: usize) -> usize {
    length % 3
}

/// Four corners of a unit square in z = 0 (48 bytes), texture coordinates (u8, normalised, stride 4), colours (f32 x 3),
/// six indices (u16).
fn buffer() -> Vec<u8> {
    let mut bytes = Vec::new();
    for p in [[0f32, 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 0.]] {
        p.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    }
    bytes.extend([0, 255, 9, 9, 255, 255, 9, 9, 0, 0, 9, 9, 255, 0, 9, 9]);
    for c in [[1f32, 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 1., 1.]] {
        c.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
    }
    [0u16, 1, 2, 2, 1, 3].iter().for_each(|i| bytes.extend(i.to_le_bytes()));
    bytes
}

const SHAPE: &str = r#"
    "accessors": [
        {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC2"},
        {"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC3"},
        {"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"}],
    "bufferViews": [
        {"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 16, "byteStride": 4},
        {"buffer": 0, "byteOffset": 64, "byteLength": 48}, {"buffer": 0, "byteOffset": 112, "byteLength": 12}],
    "materials": [{"name": "red", "doubleSided": true,
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0.2158605, 0, 1], "roughnessFactor": 0.5}}]"#;

fn file(primitive: &str, nodes: &str) -> String {
    format!(
        r#"{{"asset": {{"version": "2.0"}}, {SHAPE}, "meshes": [{{"primitives": [{primitive}]}}], "nodes": {nodes},
        "buffers": [{{"byteLength": 124, "uri": "data:application/octet-stream;base64,{}"}}]}}"#,
        base64(&buffer())
    )
}

const INDEXED: &str = r#"{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2}, "indices": 3, "material": 0}"#;
const ONE: &str = r#"[{"mesh": 0}]"#;

#[test]
fn base64_round_trip() {
    for length in 0..20u8 {
        let bytes: Vec<u8> = (0..length).map(|i| i.wrapping_mul(77)).collect();
        assert_eq!(data_uri(&format!("data:;base64,{}", base64(&bytes))), Some(bytes));
    }
    assert_eq!(data_uri("data:text/plain,hello"), None);
}

#[test]
fn samplers_say_how_a_texture_goes_on() {
    let text = file(INDEXED, ONE)
        .replace(r#""roughnessFactor""#, r#""baseColorTexture": {"index": 0}, "roughnessFactor""#)
        .replace(
            r#""materials""#,
            r#""textures": [{"sampler": 0}], "samplers": [{"wrapS": 33071, "wrapT": 33648}], "materials""#,
        );
    let model = load_bytes(text.as_bytes(), None, "t", None, &LoadOptions::default()).unwrap();
    assert_eq!(model.parts[0].material.wrap, [Wrap::Clamp, Wrap::Mirror]);
}

#[test]
fn a_square_with_everything() {
    let model = load(file(INDEXED, ONE).as_bytes()).unwrap();
    let part = &model.parts[0];
    assert_eq!(
        (part.mesh.positions.len(), part.mesh.triangles.len(), part.mesh.edges.len()),
        (4, 2, 5)
    );
    assert_eq!(
        part.mesh.uvs,
        [[0, 65536], [65536, 65536], [0, 0], [65536, 0]],
        "v is down already"
    );
    assert_eq!(part.mesh.colours, [[255, 0, 0], [0, 255, 0], [0, 0, 255], [255; 3]]);
    assert_eq!(part.mesh.normals, NormalsBuf::Face(vec![[0, 0, 16384]; 2]));
    assert_eq!(part.material.colour, [255, 128, 0]);
    assert!(part.material.two_sided && part.material.specular > 0.1);
}

#[test]
fn glb_equals_gltf() {
    let text = file(INDEXED, ONE);
    let (head, _) = text.split_once(r#", "uri""#).unwrap();
    let mut json = format!("{head}}}]}}");
    while json.len() % 4 != 0 {
        json.push(' ');
    }
    let mut glb = b"glTF\x02\0\0\0".to_vec();
    glb.extend((12 + 8 + json.len() as u32 + 8 + 124).to_le_bytes());
    glb.extend((json.len() as u32).to_le_bytes());
    glb.extend(b"JSON");
    glb.extend(json.as_bytes());
    glb.extend(124u32.to_le_bytes());
    glb.extend(b"BIN\0");
    glb.extend(buffer());
    assert_eq!(load(&glb).unwrap().parts, load(text.as_bytes()).unwrap().parts);
    for end in 0..glb.len() {
        assert!(load(&glb[..end]).is_err());
    }
}

#[test]
fn strips_and_fans_agree_with_lists() {
    let list = load(file(INDEXED, ONE).as_bytes()).unwrap().parts;
    let strip = INDEXED.replace(r#""indices": 3"#, r#""mode": 5"#);
    let strip = load(file(&strip, ONE).as_bytes()).unwrap().parts;
    assert_eq!(strip[0].mesh.triangles, [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(strip[0].mesh.positions, list[0].mesh.positions);
    let fan = INDEXED.replace(r#""indices": 3"#, r#""mode": 6"#);
    let fan = load(file(&fan, ONE).as_bytes()).unwrap().parts;
    assert_eq!(fan[0].mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    let looped = INDEXED.replace(r#""indices": 3"#, r#""mode": 2"#);
    let looped = load(file(&looped, ONE).as_bytes()).unwrap().parts;
    assert_eq!((looped[0].mesh.edges.len(), looped[0].mesh.triangles.len()), (4, 0));
}

#[test]
fn transforms_move_and_mirrors_turn_faces() {
    let nodes = r#"[{"children": [1], "translation": [10, 0, 0], "scale": [2, 2, 2]},
        {"mesh": 0, "rotation": [0, 0, 0.70710678118654757, 0.70710678118654757]},
        {"mesh": 0, "matrix": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]"#;
    let model = load(file(INDEXED, nodes).as_bytes()).unwrap();
    let [low, high] = model.bounds();
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-3);
    assert!(near(low, [-1., 0., 0.]) && near(high, [10., 2., 0.]), "{low:?} {high:?}");
    let NormalsBuf::Face(normals) = &model.parts[0].mesh.normals else { panic!() };
    assert_eq!(normals[..], [[0, 0, 16384]; 4], "all faces still look towards +z");
}

#[test]
fn broken_files_are_one_line() {
    let good = file(INDEXED, ONE);
    let with = |from: &str, to: &str| good.replace(from, to);
    for (text, message) in [
        ("{".to_string(), "t.gltf:1: the JSON ends early; copy the file again"),
        ("{} x".into(), "t.gltf:1: not JSON from column 4; export it again"),
        ("junk".into(), "t.gltf: neither GLB ('glTF') nor glTF ('{'); export it again"),
        ("[1]".into(), "t.gltf: neither"),
        ("{}".into(), "t.gltf: no vertices"),
        (r#"{"asset": {"version": "1.0"}, "meshes": {}}"#.into(), "t.gltf: glTF 1.0 is not read"),
        (r#"{"meshes": 1}"#.into(), "t.gltf: glTF 1.0 is not read"),
        (with(r#""count": 4"#, r#""count": 5"#), "t.gltf: 5 elements don't fit"),
        (with(r#""count": 4"#, r#""count": 99999999999"#), "t.gltf: accessor 0 has 99999999999"),
        (
            with(r#""count": 4"#, r#""count": -4"#),
            "t.gltf:3: invalid value: integer `-4`, expected usize; is this glTF 2.0?",
        ),
        (
            with(r#""byteLength": 48"#, r#""byteLength": 18446744073709551615"#),
            "t.gltf: buffer view",
        ),
        (with(r#""byteLength": 124"#, r#""byteLength": 125"#), "t.gltf: buffer 0: 124 of its 125"),
        (with(r#""byteStride": 4"#, r#""byteStride": 0"#), "t.gltf: 4 elements don't fit"),
        (with(r#""mesh": 0"#, r#""mesh": 7"#), "t.gltf: mesh 7"),
        (with(r#""mesh": 0"#, r#""children": [0]"#), "t.gltf: no vertices"),
        (with(r#""material": 0"#, r#""material": 3"#), "t.gltf: material 3"),
        (with(r#""indices": 3"#, r#""indices": 0"#), "t.gltf: accessor 0: indices"),
        (with("5126", "5127"), "t.gltf: accessor 0 has an unknown"),
        (with("data:application", "http://application"), "t.gltf: 'http://application"),
        (with("data:application/octet-stream;base64,", "gone.bin?"), "t.gltf: 'gone.bin"),
    ] {
        let error = load(text.as_bytes()).unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
    let cycle = file(INDEXED, r#"[{"children": [1]}, {"children": [0]}]"#)
        .replace(r#""asset""#, r#""scenes": [{"nodes": [0]}], "asset""#);
    assert!(load(cycle.as_bytes()).unwrap_err().to_string().contains("two parents"));
}

#[test]
fn compression_is_refused_by_name() {
    let text = file(INDEXED, ONE)
        .replace(r#""asset""#, r#""extensionsRequired": ["KHR_draco_mesh_compression"], "asset""#);
    let error = load(text.as_bytes()).unwrap_err();
    assert_eq!(error.kind, LoadErrorKind::Unsupported);
    assert!(error.to_string().contains("KHR_draco_mesh_compression; export without it"));
}
