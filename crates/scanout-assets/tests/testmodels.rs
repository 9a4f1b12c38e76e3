//! Every OBJ, STL, PLY and glTF of Debian's `assimp-testmodels`: well-formed ones load with the counts that another
//! library (trimesh 4) finds, malformed ones are an error of one line, and nothing panics. Skipped, with a word, where
//! the package is not installed (`apt-get install assimp-testmodels`).

use scanout::texture::Wrap;
use scanout_assets::{LoadOptions, Model, NormalSource, NormalsBuf, load};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const ROOT: &str = "/usr/share/assimp/models";

/// Files with the number of their triangles, those without area among them.
const COUNTS: [(&str, u64); 17] = [
    ("OBJ/box.obj", 12),
    ("OBJ/box_UTF16BE.obj", 12),
    ("OBJ/box_longline.obj", 944),
    ("OBJ/concave_polygon.obj", 64),
    ("OBJ/spider.obj", 1368),
    ("OBJ/WusonOBJ.obj", 3732),
    ("OBJ/cube_usemtl.obj", 12),
    ("PLY/cube.ply", 12),
    ("PLY/cube_binary.ply", 12),
    ("PLY/Wuson.ply", 3732),
    ("STL/Spider_ascii.stl", 1368),
    ("STL/Spider_binary.stl", 1368),
    ("STL/Wuson.stl", 3732),
    ("glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb", 121_496),
    ("glTF2/BoxTextured-glTF/BoxTextured.gltf", 12),
    ("glTF2/BoxTextured-glTF-Embedded/BoxTextured.gltf", 12),
    ("glTF2/BoxTextured-glTF-Binary/BoxTextured.glb", 12),
];

/// Files that must be refused.
const REFUSED: [&str; 9] = [
    "invalid/empty.obj",
    "invalid/malformed.obj",
    "PLY/issue623.ply",
    "PLY/pond.0.ply",
    "glTF/TwoBoxes/TwoBoxes.gltf",
    "glTF2/RecursiveNodes/RecursiveNodes.gltf",
    "glTF2/MissingBin/BoxTextured.gltf",
    "glTF2/IndexOutOfRange/IndexOutOfRange.gltf",
    "glTF2/draco/2CylinderEngine.gltf",
];

/// The package's folder, or `None` with a word.
fn installed() -> Option<&'static Path> {
    let root = Path::new(ROOT);
    if !root.is_dir() {
        eprintln!("SKIPPED: {ROOT} is not there; apt-get install assimp-testmodels");
        return None;
    }
    Some(root)
}

fn models(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        if path.is_dir() {
            models(&path, found);
        } else if extension
            .is_some_and(|e| ["obj", "stl", "ply", "gltf", "glb"].contains(&e.as_str()))
        {
            found.push(path);
        }
    }
}

fn check(model: &Model, file: &Path) {
    for part in &model.parts {
        let mesh = &part.mesh;
        let within =
            |indices: &[u16], count: usize| indices.iter().all(|&i| usize::from(i) < count);
        assert!(within(mesh.triangles.as_flattened(), mesh.positions.len()), "{}", file.display());
        assert!(within(mesh.uv_triangles.as_flattened(), mesh.uvs.len()), "{}", file.display());
        assert!(within(mesh.edges.as_flattened(), mesh.positions.len()), "{}", file.display());
        let normals = match &mesh.normals {
            NormalsBuf::None => continue,
            NormalsBuf::Vertex(n) | NormalsBuf::Face(n) => n,
        };
        for n in normals {
            let length2: i64 = n.iter().map(|&x| i64::from(x) * i64::from(x)).sum();
            let length = (length2 as f64).sqrt();
            assert!(
                (length - 16384.0).abs() < 2.0,
                "{}: a normal of length {length}",
                file.display()
            );
        }
    }
}

#[test]
fn every_file_loads_or_is_refused_in_one_line() {
    let Some(root) = installed() else { return };
    let mut files = Vec::new();
    models(root, &mut files);
    files.sort();
    let mut loaded = 0;
    for file in &files {
        // The largest take seconds without optimisation.
        let large = file.metadata().is_ok_and(|m| m.len() > 1_000_000);
        let all = [NormalSource::FromFile, NormalSource::Smooth, NormalSource::Flat];
        for normals in if large { &all[..1] } else { &all[..] } {
            let normals = *normals;
            let begin = Instant::now();
            match load(file, &LoadOptions { normals, ..LoadOptions::default() }) {
                Ok(model) => {
                    check(&model, file);
                    loaded += usize::from(normals == NormalSource::FromFile);
                }
                Err(error) => {
                    let text = error.to_string();
                    assert!(!text.contains('\n') && text.contains("; "), "{text}");
                }
            }
            assert!(begin.elapsed() < Duration::from_secs(20), "{} is slow", file.display());
        }
    }
    eprintln!("{} files, {} loaded", files.len(), loaded);
    assert!(loaded >= 66, "{} files, {} loaded", files.len(), loaded);
}

#[test]
fn counts_equal_those_of_another_library() {
    let Some(root) = installed() else { return };
    for (file, triangles) in COUNTS {
        let model =
            load(root.join(file), &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(model.stats.triangles + model.stats.degenerate, triangles, "{file}");
    }
}

#[test]
fn broken_files_are_refused() {
    let Some(root) = installed() else { return };
    for file in REFUSED {
        let error = load(root.join(file), &LoadOptions::default()).err();
        assert!(error.is_some(), "{file} should not load");
    }
}

#[test]
fn text_and_binary_of_one_model_are_equal() {
    let Some(root) = installed() else { return };
    let parts = |file| {
        load(root.join(file), &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}")).parts
    };
    let [text, binary] = ["STL/Spider_ascii.stl", "STL/Spider_binary.stl"].map(parts);
    assert_eq!(text[0].mesh.triangles.len(), binary[0].mesh.triangles.len());
    let boxes = [
        "glTF2/BoxTextured-glTF/BoxTextured.gltf",
        "glTF2/BoxTextured-glTF-Binary/BoxTextured.glb",
    ];
    let [text, mut binary] = boxes.map(parts);
    // Only the text has a sampler that mirrors and clamps.
    assert_eq!(text[0].material.wrap, [Wrap::Mirror, Wrap::Clamp]);
    assert_eq!(binary[0].material.wrap, [Wrap::Repeat; 2]);
    binary[0].material.wrap = text[0].material.wrap;
    assert_eq!(text, binary);
}
