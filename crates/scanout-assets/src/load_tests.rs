use super::*;
use crate::model::NormalsBuf;
use scanout::texture::Wrap;

/// A folder of its own that is removed afterwards.
struct Folder(std::path::PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path =
            std::env::temp_dir().join(format!("scanout-assets-{}-{name}", std::process::id()));
        std::fs::create_dir_all(path.join("textures")).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, content: &[u8]) -> std::path::PathBuf {
        let path = self.0.join(name);
        std::fs::write(&path, content).unwrap();
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";
const PICTURE: &[u8] = b"P6 1 1 255 abc";

fn messages(model: &Model) -> Vec<String> {
    model.warnings.iter().map(ToString::to_string).collect()
}

#[test]
fn textures_are_found_however_they_are_named() {
    let folder = Folder::new("names");
    folder.write("textures/My Brick.ppm", PICTURE);
    folder.write("beside.ppm", PICTURE);
    for (line, found) in [
        ("textures/My Brick.ppm", true),
        ("textures\\My Brick.ppm", true),
        ("-s 1 1 1 -clamp on textures/My Brick.ppm", true),
        ("textures/MY BRICK.PPM", false),
        ("C:\\Users\\somebody\\beside.ppm", true),
        ("/home/somebody/BESIDE.ppm", true),
        ("gone.png", false),
    ] {
        folder.write("my materials.mtl", format!("newmtl a\nKd 1 1 1\nmap_Kd {line}\n").as_bytes());
        let text = format!("mtllib my materials.mtl\n{TRIANGLE}usemtl a\nf 1/1 2/2 3/3");
        let model = load(folder.write("m.obj", text.as_bytes()), &LoadOptions::default()).unwrap();
        assert_eq!(model.parts[0].material.texture.is_some(), found, "{line}");
        assert_eq!(model.warnings.is_empty(), found, "{line}: {:?}", messages(&model));
        if found {
            assert_eq!(model.images[0].rgb, [*b"abc"]);
        }
    }
}

#[test]
fn a_texture_is_clamped_scaled_and_moved() {
    let folder = Folder::new("options");
    folder.write("t.ppm", PICTURE);
    folder.write(
        "m.mtl",
        b"newmtl a\nmap_Kd -clamp on t.ppm\nnewmtl b\nmap_Kd -s 2 4 1 -o 0.5 0.25 0 t.ppm\n",
    );
    let faces = "usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 2/2 3/3\n";
    let text = format!("mtllib m.mtl\n{TRIANGLE}{faces}");
    let model = load(folder.write("m.obj", text.as_bytes()), &LoadOptions::default()).unwrap();
    let [a, b] = model.parts.as_slice() else { panic!("{}", model.parts.len()) };
    assert_eq!((a.material.wrap, b.material.wrap), ([Wrap::Clamp; 2], [Wrap::Repeat; 2]));
    let one = 65536;
    assert_eq!(a.mesh.uvs, [[0, one], [one, one], [0, 0]]);
    // (u, v) = (0, 0), (1, 0), (0, 1) upwards lie at (0.5, 0.25), (2.5, 0.25), (0.5, 4.25).
    let below = one * 3 / 4;
    assert_eq!(b.mesh.uvs, [[one / 2, below], [one * 5 / 2, below], [one / 2, below - 4 * one]]);
}

#[test]
fn a_shared_texture_is_loaded_once() {
    let folder = Folder::new("shared");
    folder.write("t.ppm", PICTURE);
    folder.write(
        "m.mtl",
        b"newmtl a\nmap_Kd t.ppm\nnewmtl b\nmap_Kd ./t.ppm\nnewmtl c\nmap_Kd t.ppm\n",
    );
    let text =
        format!("mtllib m.mtl\n{TRIANGLE}usemtl a\nf 1/1 2/2 3/3\nusemtl c\nf 1/1 3/3 2/2\n");
    let model = load(folder.write("m.obj", text.as_bytes()), &LoadOptions::default()).unwrap();
    assert_eq!((model.parts.len(), model.images.len()), (2, 1));
}

#[test]
fn missing_files_are_warnings() {
    let folder = Folder::new("missing");
    let text = format!("mtllib gone.mtl\n{TRIANGLE}usemtl a\nf 1 2 3");
    let model = load(folder.write("m.obj", text.as_bytes()), &LoadOptions::default()).unwrap();
    assert_eq!(
        messages(&model),
        [
            "material file 'gone.mtl' not found; put it beside the model",
            "material 'a' is not defined; grey is used"
        ]
    );
    folder.write("gone.mtl", b"newmtl a\nmap_Kd broken.png\n");
    folder.write("broken.png", b"\x89PNG\r\n\x1a\nxx");
    let model = load(folder.0.join("m.obj"), &LoadOptions::default()).unwrap();
    assert_eq!(model.warnings.len(), 1);
    assert!(messages(&model)[0].ends_with("broken.png: PNG: it ends early; copy the file again"));
}

#[test]
fn a_picture_of_the_same_name_is_the_texture() {
    let folder = Folder::new("beside");
    let path = folder.write("m.obj", format!("{TRIANGLE}f 1/1 2/2 3/3").as_bytes());
    assert!(load(&path, &LoadOptions::default()).unwrap().images.is_empty());
    folder.write("m.ppm", PICTURE);
    let model = load(&path, &LoadOptions::default()).unwrap();
    assert_eq!(model.parts[0].material.texture, Some(0));
    assert_eq!(model.parts[0].material.colour, [255; 3]);
    assert_eq!(model.warnings[0].level, crate::WarningLevel::Note);
    assert!(messages(&model)[0].contains("m.ppm beside the model is used"));
    let options = LoadOptions { texture_beside: false, ..LoadOptions::default() };
    assert!(load(&path, &options).unwrap().images.is_empty());
}

#[test]
fn formats_are_recognised() {
    assert_eq!(Format::from_path(Path::new("a/B.OBJ")), Some(Format::Obj));
    assert_eq!(Format::from_path(Path::new("b.ply.gz")), Some(Format::Ply));
    assert_eq!(Format::from_path(Path::new("b.glb")), Some(Format::Gltf));
    assert_eq!(Format::from_path(Path::new("obj")), None);
    assert_eq!(Format::from_content(b"  {\"asset\""), Some(Format::Gltf));
    assert_eq!(Format::from_content(b"solid x"), Some(Format::Stl));
    assert_eq!(Format::from_content(b"# text"), Some(Format::Obj));
    assert_eq!(Format::from_content(b"\0\0"), None);
}

#[test]
fn a_file_of_another_format_is_named() {
    let options = LoadOptions::default();
    let obj = format!("# a comment\n{TRIANGLE}f 1/1 2/2 3/3");
    let mut binary = vec![b' '; 84];
    binary[80..].copy_from_slice(&1u32.to_le_bytes());
    binary.resize(134, 0);
    let looks = |name: &str, option: &str| {
        format!("t: this looks like {name}; rename it or use --input-format {option}")
    };
    let picture = |name: &str| {
        format!("t: a {name} picture, not a model; name an OBJ, STL, PLY, glTF or GLB file")
    };
    for (bytes, format, message) in [
        (obj.as_bytes(), Some(Format::Stl), looks("OBJ", "obj")),
        (obj.as_bytes(), Some(Format::Ply), looks("OBJ", "obj")),
        (obj.as_bytes(), Some(Format::Gltf), looks("OBJ", "obj")),
        (b"glTF\x02\0\0\0", Some(Format::Obj), looks("GLB", "glb")),
        (b"  {\"asset\"", Some(Format::Obj), looks("glTF", "gltf")),
        (b"ply\r\nformat", Some(Format::Stl), looks("PLY", "ply")),
        (b"solid x\nfacet", Some(Format::Obj), looks("STL", "stl")),
        (&binary, Some(Format::Gltf), looks("STL", "stl")),
        (b"\x89PNG\r\n", None, picture("PNG")),
        (b"\xff\xd8\xff\xe0", Some(Format::Obj), picture("JPEG")),
    ] {
        let error = load_bytes(bytes, format, "t", None, &options).unwrap_err();
        assert_eq!(error.to_string(), message);
        assert_eq!(error.kind, LoadErrorKind::Unsupported);
    }
}

#[test]
fn data_without_a_folder_says_so() {
    let text = format!("mtllib teapot.mtl\n{TRIANGLE}usemtl a\nf 1 2 3");
    let model =
        load_bytes(text.as_bytes(), None, "standard input", None, &LoadOptions::default()).unwrap();
    assert_eq!(
        messages(&model)[0],
        "material file 'teapot.mtl' is not read: standard input has no folder to look in; \
            name the model's file"
    );
}

#[test]
fn bad_input_is_one_line() {
    let options = LoadOptions::default();
    for (bytes, message) in [
        (b"".as_slice(), "-: the file is empty; export it again"),
        (b"\0\0\0", "-: not recognised; models are OBJ, STL, PLY, glTF or GLB"),
        (b"v 1 2 3\nf 1 1 1x", "-:2: '1x' is not a corner; write v, v/t, v//n or v/t/n"),
        (
            b"v 1 2 3\nf 1 2 3\nf 9 1 1",
            "-:3: asks for number 9 of 1 positions; is the file complete?",
        ),
        (
            b"v 1 2 3\rf 1/2 1 1\r",
            "-:2: asks for number 2 of 0 texture coordinates; is the file complete?",
        ),
        (b"v 1e31 0 0\nf 1 1 1", "-:1: a coordinate is beyond 1e30; mend the vertex"),
        (b"# nothing", "-: no vertices found; is this the right file?"),
        (b"\x1f\x8b\x08", "-: gzip: "),
    ] {
        let error = load_bytes(bytes, None, "-", None, &options).unwrap_err().to_string();
        assert!(error.starts_with(message) && !error.contains('\n'), "{error}");
    }
    let error = load("/nonexistent.obj", &options).unwrap_err().to_string();
    assert_eq!(error, "/nonexistent.obj: no such file; check the path");
    let error = load("/", &options).unwrap_err().to_string();
    assert_eq!(error, "/: is a directory; name a file in it");
}

#[test]
fn limits_hold() {
    let mut options = LoadOptions::default();
    options.limits.elements = 2;
    let error = load_bytes(TRIANGLE.as_bytes(), None, "-", None, &options).unwrap_err();
    assert_eq!(error.kind, LoadErrorKind::TooLarge);
    let folder = Folder::new("limits");
    let path = folder.write("m.obj", TRIANGLE.as_bytes());
    options = LoadOptions::default();
    options.limits.file_bytes = 10;
    let error = load(path, &options).unwrap_err().to_string();
    assert!(error.ends_with("m.obj: larger than 10 bytes; simplify it"), "{error}");
}

#[test]
fn utf16_and_marks_are_understood() {
    let text = format!("{TRIANGLE}f 1 2 3");
    let plain = load_bytes(text.as_bytes(), None, "-", None, &LoadOptions::default()).unwrap();
    let mut utf16 = vec![0xff, 0xfe];
    utf16.extend(text.encode_utf16().flat_map(u16::to_le_bytes));
    let mut marked = b"\xef\xbb\xbf".to_vec();
    marked.extend(text.as_bytes());
    for bytes in [utf16, marked] {
        let model =
            load_bytes(&bytes, Some(Format::Obj), "-", None, &LoadOptions::default()).unwrap();
        assert_eq!(model.parts, plain.parts);
    }
}

/// The shipped models, which other tests and the documentation rely on.
#[test]
fn shipped_models_load_without_a_warning() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
    // File, polygons, triangles, edges, side of the texture, smooth.
    for (file, polygons, triangles, edges, texture, smooth) in [
        ("torus.obj", 400, 800, 800, Some((250, 250)), false),
        ("sphere.obj", 64, 112, 120, Some((100, 78)), false),
        ("cube.obj", 6, 12, 12, Some((8, 8)), false),
        ("earth.obj", 2048, 3968, 4032, Some((1024, 512)), true),
        ("teapot.obj", 992, 992, 1520, None, true),
    ] {
        let model = load(folder.join(file), &LoadOptions::default()).unwrap();
        assert_eq!(messages(&model), [""; 0], "{file}");
        let stats = &model.stats;
        assert_eq!(
            (stats.polygons, stats.triangles, stats.edges),
            (polygons, triangles, edges),
            "{file}"
        );
        let size = model.parts[0]
            .material
            .texture
            .map(|i| (model.images[i].width, model.images[i].height));
        assert_eq!(size, texture, "{file}");
        let vertex = matches!(model.parts[0].mesh.normals, NormalsBuf::Vertex(_));
        assert_eq!(vertex, smooth, "{file}");
    }
    // Nothing of the south at the north pole: the picture does not repeat, and needs not.
    let earth = load(folder.join("earth.obj"), &LoadOptions::default()).unwrap();
    assert_eq!(earth.parts[0].material.wrap, [Wrap::Clamp; 2]);
    assert!(earth.parts[0].mesh.uvs.as_flattened().iter().all(|x| (0..=65_536).contains(x)));
    let hand = load(folder.join("hand.glb"), &LoadOptions::default()).unwrap();
    assert_eq!(hand.stats.triangles, 2314);
    assert_eq!(messages(&hand), ["skins are ignored; the rest pose is shown"]);
    let note = load(folder.join("system-b/a.obj"), &LoadOptions::default()).unwrap();
    let torus = load(folder.join("torus.obj"), &LoadOptions::default()).unwrap();
    assert_eq!(note.parts[0].mesh, torus.parts[0].mesh);
    assert_eq!(note.images[0].rgb, torus.images[0].rgb);
    assert_eq!(note.warnings.len(), 1);
}
