//! One function a reader: it takes any bytes, and must neither panic nor use much time or memory.
//!
//! libFuzzer calls them from `fuzz_targets/` (nightly), the `smoke` program with bytes of its own (stable).

use scanout::mesh::Normals;
use scanout_assets::{Format, Image, Limits, LoadOptions, Model, NormalSource, bake, obj, ppm};
use scanout_head::face::{Cascade, Finder, Grey, Localiser};

/// A reader under test.
pub type Target = fn(&[u8]);

/// All targets by name.
pub const TARGETS: [(&str, Target); 9] = [
    ("obj", obj),
    ("mtl", mtl),
    ("stl", stl),
    ("ply", ply),
    ("gltf", gltf),
    ("ppm", ppm),
    ("texture", texture),
    ("bake", bake),
    ("face", face),
];

/// Small limits, so that a few bytes that claim much are refused and not merely slow.
fn options(bytes: &[u8]) -> LoadOptions {
    let normals = match bytes.len() % 3 {
        0 => NormalSource::FromFile,
        1 => NormalSource::Smooth,
        _ => NormalSource::Flat,
    };
    let limits = Limits { file_bytes: 1 << 22, elements: 1 << 18 };
    LoadOptions { normals, limits, ..LoadOptions::default() }
}

fn load(bytes: &[u8], format: Format) {
    if let Ok(model) =
        scanout_assets::load_bytes(bytes, Some(format), "fuzz", None, &options(bytes))
    {
        check(&model);
    }
}

/// What every loaded model promises.
fn check(model: &Model) {
    assert!(model.placement.scale > 0.0 && model.placement.scale.is_finite());
    assert!(model.placement.offset.iter().all(|x| x.is_finite()));
    for part in &model.parts {
        let mesh = part.mesh.as_mesh();
        let within =
            |indices: &[u16], count: usize| indices.iter().all(|&i| usize::from(i) < count);
        assert!(mesh.positions.len() <= 65_536 && mesh.uvs.len() <= 65_536);
        assert!(within(mesh.triangles.as_flattened(), mesh.positions.len()));
        assert!(within(mesh.uv_triangles.as_flattened(), mesh.uvs.len()));
        assert!(within(mesh.edges.as_flattened(), mesh.positions.len()));
        assert!(mesh.uvs.is_empty() || mesh.uv_triangles.len() == mesh.triangles.len());
        assert!(mesh.colours.is_empty() || mesh.colours.len() == mesh.positions.len());
        match mesh.normals {
            Normals::None => {}
            Normals::Vertex(n) => assert_eq!(n.len(), mesh.positions.len()),
            Normals::Face(n) => assert_eq!(n.len(), mesh.triangles.len()),
        }
        assert!(part.material.texture.is_none_or(|texture| texture < model.images.len()));
    }
    // What was loaded can be baked, and read again.
    let baked = bake::to_binary(model).expect("a model of this size can be baked");
    bake_checked(&baked);
    let _ = bake::hex_files(model);
}

/// OBJ, whole and in chunks.
pub fn obj(bytes: &[u8]) {
    load(bytes, Format::Obj);
    let count = |size: usize| {
        let mut parser = obj::Parser::new();
        let mut events = 0u64;
        let mut result = Ok(());
        for chunk in bytes.chunks(size) {
            result = result.and_then(|()| parser.feed(chunk, &mut |_| events += 1));
        }
        (result.and_then(|()| parser.finish(&mut |_| events += 1)), events)
    };
    assert_eq!(count(3), count(usize::MAX));
}

/// MTL, through a file beside an OBJ that uses it.
pub fn mtl(bytes: &[u8]) {
    let folder = std::env::temp_dir().join(format!("scanout-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for the material file");
    std::fs::write(folder.join("m.mtl"), bytes).expect("a material file");
    let model = b"mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    let options = options(bytes);
    let loaded = scanout_assets::load_bytes(model, None, "fuzz", Some(&folder), &options);
    check(&loaded.expect("material files never prevent loading"));
}

/// STL, text or binary.
pub fn stl(bytes: &[u8]) {
    load(bytes, Format::Stl);
}

/// PLY of any kind.
pub fn ply(bytes: &[u8]) {
    load(bytes, Format::Ply);
}

/// glTF and GLB.
pub fn gltf(bytes: &[u8]) {
    load(bytes, Format::Gltf);
}

/// PPM and PGM, whole and in chunks.
pub fn ppm(bytes: &[u8]) {
    let read = |size: usize| {
        let mut parser = ppm::Parser::new();
        let mut sum = 0u64;
        let mut sink = |event: ppm::Event| {
            if let ppm::Event::Texel([r, g, b]) = event {
                sum = sum.wrapping_mul(31)
                    + u64::from(r)
                    + u64::from(g) * 256
                    + u64::from(b) * 65_536;
            }
        };
        let mut result = Ok(());
        for chunk in bytes.chunks(size) {
            result = result.and_then(|()| parser.feed(chunk, &mut sink));
        }
        let result = result.and_then(|()| parser.finish(&mut sink));
        (result, sum)
    };
    assert_eq!(read(3), read(usize::MAX));
    texture(bytes);
}

/// Pictures of every kind.
pub fn texture(bytes: &[u8]) {
    if let Ok((image, _)) = Image::decode(bytes, "fuzz") {
        assert!((1..=1024).contains(&image.width) && (1..=1024).contains(&image.height));
        assert_eq!(image.rgb.len(), usize::from(image.width) * usize::from(image.height));
        let image = image.with_mips();
        assert_eq!(image.to_rgb565().len(), image.rgb.len());
    }
}

/// `.mesh` binaries.
pub fn bake(bytes: &[u8]) {
    bake_checked(bytes);
}

fn bake_checked(bytes: &[u8]) {
    // Words, so that the bytes are aligned.
    let mut words = vec![0u32; bytes.len().div_ceil(4)];
    for (word, chunk) in words.iter_mut().zip(bytes.chunks(4)) {
        let mut four = [0; 4];
        four[..chunk.len()].copy_from_slice(chunk);
        *word = u32::from_ne_bytes(four);
    }
    // A model's own file is a multiple of four bytes; any other is longer here by zeros.
    let Ok(baked) = bake::read(bytemuck::cast_slice(&words)) else { return };
    let _ = baked.verify();
    for part in baked.parts() {
        let count = part.mesh.positions.len();
        assert!(part.mesh.triangles.as_flattened().iter().all(|&i| usize::from(i) < count));
        assert!(part.texture.is_none_or(|texture| baked.texture(texture).is_some()));
    }
}

/// Models of faces and pupils: any bytes, and small good ones that the bytes' halves damage; what loads must find its way through any
/// picture.
pub fn face(bytes: &[u8]) {
    let (first, second) = bytes.split_at(bytes.len() / 2);
    let _ = (Cascade::read(bytes), Localiser::read(bytes));
    // A small model of each kind, damaged by what there is.
    let mut cascade = [3i32, 0x7f81_7f81, 1, 1].map(i32::to_le_bytes).concat();
    cascade.extend([0xc0, 0, 64, 0]);
    cascade.extend([-1.0f32, 1.0, 0.0].map(f32::to_le_bytes).concat());
    let mut localiser = [1i32.to_le_bytes(), 0.5f32.to_le_bytes()].concat();
    localiser.extend([1i32, 1].map(i32::to_le_bytes).concat());
    localiser.extend([0, 0xc0, 0, 64]);
    localiser.extend([0.0f32, 0.0, 0.125, -0.25].map(f32::to_le_bytes).concat());
    for (model, damage) in [(&mut cascade, first), (&mut localiser, second)] {
        for pair in damage.as_chunks::<2>().0.iter().take(4) {
            let at = usize::from(pair[0]) % model.len();
            model[at] ^= pair[1];
        }
    }
    let (Ok(cascade), Ok(localiser)) = (Cascade::read(&cascade), Localiser::read(&localiser))
    else {
        return;
    };
    let width = 1 + bytes.len() % 97;
    let Some(picture) = bytes.get(..bytes.len() / width * width) else { return };
    if let Some(grey) = Grey::new(picture, width) {
        let mut finder = Finder::new(cascade, localiser);
        for _ in 0..2 {
            if let Some(eyes) = finder.find(&grey, [20.0, 1e9]) {
                assert!(eyes.pupils.as_flattened().iter().all(|x| x.is_finite()));
            }
        }
    }
}
