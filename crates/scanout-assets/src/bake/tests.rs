use super::*;
use crate::load::{Format, LoadOptions, load_bytes};
use crate::model::{Image, Model};
use crate::palette::TextureFormat;
use scanout::texture::Texels;

/// Two parts: one with a texture and flat, one smooth, with colours; and a loose line.
fn model() -> Model {
    let text = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 1 1 1\nv 0 0 -1 1 1 0\nv 0 1 -1 0 1 1\n\
        vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl flat\ns off\nf 1/1 2/2 3/3 4/4\nusemtl smooth\ns 1\n\
        f 1 4 6 5\nf 4 3 6\nl 2 6\n";
    let mut model =
        load_bytes(text.as_bytes(), Some(Format::Obj), "t", None, &LoadOptions::default()).unwrap();
    let rgb = (0..6).map(|i| [i * 40, 255 - i * 40, 7]).collect();
    model.images.push(Image { name: "t".into(), width: 3, height: 2, levels: 1, rgb }.with_mips());
    model.parts[0].material.texture = Some(0);
    model.parts[1].material.two_sided = true;
    model.parts[1].material.wrap = [Wrap::Mirror, Wrap::Clamp];
    model
}

/// The bytes at an address divisible by 4.
fn aligned(bytes: &[u8]) -> (Vec<u32>, usize) {
    let mut words = vec![0u32; bytes.len().div_ceil(4) + 1];
    bytemuck::cast_slice_mut::<u32, u8>(&mut words)[..bytes.len()].copy_from_slice(bytes);
    (words, bytes.len())
}

fn with<R>(bytes: &[u8], f: impl FnOnce(Result<BakedMesh<'_>, BakeError>) -> R) -> R {
    let (words, length) = aligned(bytes);
    f(read(&bytemuck::cast_slice::<u32, u8>(&words)[..length]))
}

#[test]
fn a_round_trip_keeps_everything() {
    let model = model();
    assert_eq!(model.parts.len(), 3);
    let bytes = to_binary(&model).unwrap();
    with(&bytes, |baked| {
        let baked = baked.unwrap();
        baked.verify().unwrap();
        assert_eq!((baked.part_count(), baked.texture_count()), (3, 1));
        assert_eq!(baked.scale(), (model.placement.scale * 4_294_967_296.0).round() as i64);
        assert_eq!(baked.offset(), [1 << 31, 1 << 31, -(1 << 31)]);
        for (part, ours) in baked.parts().zip(&model.parts) {
            assert_eq!(part.name, ours.name);
            // All but the clusters, which the file doesn't hold.
            let expected = scanout::mesh::Mesh { clusters: &[], ..ours.mesh.as_mesh() };
            assert_eq!(format!("{:?}", part.mesh), format!("{expected:?}"));
            assert_eq!(part.colour, ours.material.colour);
            assert_eq!((part.ambient, part.diffuse, part.specular), (13107, 52429, 0));
            assert_eq!(part.texture, ours.material.texture);
            assert_eq!(part.wrap, ours.material.wrap);
            assert_eq!(part.two_sided, ours.material.two_sided);
            assert_eq!(part.shininess, 32);
        }
        assert!(baked.part(3).is_none() && baked.texture(1).is_none());
        let texture = baked.texture(0).unwrap();
        assert_eq!((texture.width, texture.height, texture.levels), (3, 2, 2));
        assert_eq!(texture.texels, Texels::Rgb565(&model.images[0].to_rgb565()));
    });
}

/// Palettes in place, of files of their own version; files without stay as they were.
#[test]
fn palettes_make_a_round_trip() {
    let mut model = model();
    assert_eq!(to_binary(&model).unwrap()[4], 1);
    // An odd number of texels over all levels.
    let image = model.images[0].clone();
    assert_eq!(image.rgb.len() % 2, 1);
    for (format, colours) in [(TextureFormat::Palette256, 256), (TextureFormat::Palette16, 16)] {
        let bytes = to_binary_as(&model, format).unwrap();
        assert_eq!(bytes[4], 2);
        with(&bytes, |baked| {
            let texture = baked.unwrap().texture(0).unwrap();
            assert_eq!(texture.check(), Ok(()));
            let expected = image.to_palette(colours);
            match texture.texels {
                Texels::Palette8 { indices, palette } => {
                    assert_eq!((indices, palette), (&expected.indices[..], &expected.palette[..]));
                    assert_eq!(colours, 256);
                }
                Texels::Palette4 { indices, palette } => {
                    assert_eq!((palette, colours), (&expected.palette[..], 16));
                    let of = |i: usize| indices[i / 2] >> (4 * (i % 2)) & 15;
                    assert!((0..image.rgb.len()).all(|i| of(i) == expected.indices[i]));
                }
                other => panic!("{other:?}"),
            }
        });
        // A format that nobody knows.
        let mut other = bytes.clone();
        let at = HEADER + model.parts.len() * PART + 6;
        other[at] = 3;
        with(&other, |baked| assert!(matches!(baked, Err(BakeError::Inconsistent { .. }))));
    }
    model.images.clear();
    assert_eq!(to_binary_as(&model, TextureFormat::Palette16).unwrap()[4], 1);
}

#[test]
fn every_flipped_byte_and_every_cut_is_survived() {
    for format in [TextureFormat::Rgb565, TextureFormat::Palette256, TextureFormat::Palette16] {
        survived(&to_binary_as(&model(), format).unwrap());
    }
}

fn survived(bytes: &[u8]) {
    for end in 0..bytes.len() {
        with(&bytes[..end], |baked| assert!(baked.is_err()));
    }
    let mut accepted = 0;
    for at in 0..bytes.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut broken = bytes.to_vec();
            broken[at] ^= flip;
            with(&broken, |baked| {
                let Ok(baked) = baked else { return };
                accepted += 1;
                assert!(at < 16 || baked.verify() == Err(BakeError::Checksum));
                for part in baked.parts() {
                    let count = part.mesh.positions.len();
                    assert!(
                        part.mesh.triangles.as_flattened().iter().all(|&i| usize::from(i) < count)
                    );
                }
            });
        }
    }
    assert!(accepted > 100, "a changed coordinate is still a mesh");
}

#[test]
fn errors_say_what_to_do() {
    let bytes = to_binary(&model()).unwrap();
    with(b"", |r| assert_eq!(r.unwrap_err(), BakeError::Magic));
    with(&bytes[..20], |r| assert_eq!(r.unwrap_err(), BakeError::Truncated { need: 64 }));
    let mut other = bytes.clone();
    other[4] = 3;
    with(&other, |r| {
        assert_eq!(
            r.unwrap_err().to_string(),
            ".mesh version 3, not up to 2; bake it again, or update"
        )
    });
    let (words, length) = aligned(&[&[0], bytes.as_slice()].concat());
    let shifted = &bytemuck::cast_slice::<u32, u8>(&words)[1..length];
    assert_eq!(read(shifted).unwrap_err(), BakeError::Misaligned);
    // The offset of the positions of part 0, beyond the end; then not divisible by 4.
    for value in [0xffff_fff0u32, 66] {
        let mut outside = bytes.clone();
        outside[72..76].copy_from_slice(&value.to_le_bytes());
        with(&outside, |r| assert_eq!(r.unwrap_err(), BakeError::Section { at: 72 }));
    }
    let mut index = bytes.clone();
    let triangles = u32::from_le_bytes([bytes[104], bytes[105], bytes[106], bytes[107]]) as usize;
    index[triangles] = 200;
    with(&index, |r| assert_eq!(r.unwrap_err(), BakeError::Inconsistent { at: 104 }));
}

#[test]
fn crc_is_the_one_of_png() {
    assert_eq!(crc32(b"123456789"), 0xcbf4_3926);
}

#[test]
fn tables_have_a_line_an_entry() {
    let model = model();
    let files = hex_files(&model).unwrap();
    let lines = |name: &str| -> Vec<&str> {
        files
            .iter()
            .find(|(n, _)| n == name)
            .map(|(_, text)| text.lines().collect())
            .unwrap_or_default()
    };
    // Part 0 has 4 vertices, part 1 its own, the line 2; all have a normal since some are smooth.
    let vertices: usize = model.parts.iter().map(|p| p.mesh.positions.len()).sum();
    assert_eq!((lines("vertices.hex").len(), lines("normals.hex").len()), (vertices, vertices));
    assert_eq!(lines("normals.hex")[0], "400000000000", "z = 1, y = 0, x = 0");
    let [x, y, z] = model.parts[0].mesh.positions[0];
    assert_eq!(lines("vertices.hex")[0], format!("{z:04x}{y:04x}{x:04x}"));
    assert_eq!(lines("triangles.hex").len(), 5);
    assert_eq!(lines("triangles.hex")[0], "000200010000");
    assert_eq!(lines("triangle_materials.hex"), ["00", "00", "01", "01", "01"]);
    assert_eq!(lines("uvs.hex")[0], "0001000000000000", "v down: 1.0, u 0");
    assert_eq!(lines("uv_triangles.hex").len(), 5);
    assert_eq!(lines("edges.hex").len() as u64, model.stats.edges);
    assert_eq!(lines("colours.hex")[0], "ff0000");
    assert_eq!(lines("texture0.hex").len(), 7);
    assert_eq!(lines("materials.hex").len(), 3);
    assert!(lines("materials.hex").iter().all(|line| line.len() == 30));
    assert_eq!(&lines("materials.hex")[0][..8], "00000020");
    assert_eq!(
        &lines("materials.hex")[1][..8],
        "25ff0020",
        "two-sided, mirrored in u, clamped in v"
    );
    assert!(lines("mesh.svh").contains(&"localparam longint MESH_TRIANGLES = 5;"));
    assert!(lines("mesh.svh").contains(&"localparam longint MESH_NORMALS_PER_TRIANGLE = 0;"));
    let vertex_count = lines("vertices.hex").len();
    for line in lines("triangles.hex") {
        for word in [&line[..4], &line[4..8], &line[8..]] {
            assert!(usize::from_str_radix(word, 16).unwrap() < vertex_count);
        }
    }
}

#[test]
fn flat_models_have_normals_per_triangle() {
    let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 4 3\n";
    let model = load_bytes(text, Some(Format::Obj), "t", None, &LoadOptions::default()).unwrap();
    let files = hex_files(&model).unwrap();
    let names: Vec<_> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names,
        [
            "README.md",
            "vertices.hex",
            "normals.hex",
            "triangles.hex",
            "triangle_materials.hex",
            "edges.hex",
            "materials.hex",
            "mesh.svh"
        ]
    );
    assert_eq!(files[2].1, "400000000000\n400000000000\n");
    assert!(files[7].1.contains("MESH_NORMALS_PER_TRIANGLE = 1;"));
}

#[test]
fn a_mixed_model_gets_a_vertex_for_every_normal() {
    // A flat box corner beside a smooth part: its three faces share a vertex in the file and not in the tables.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl a\ns off\nf 1 3 2\nf 1 2 4\nf 1 4 3\n\
        usemtl b\ns 1\nf 1 2 3\nf 2 4 3\n";
    let model =
        load_bytes(text.as_bytes(), Some(Format::Obj), "t", None, &LoadOptions::default()).unwrap();
    let files = hex_files(&model).unwrap();
    let normals: Vec<_> = files[2].1.lines().collect();
    let vertices: Vec<_> = files[1].1.lines().collect();
    assert_eq!(normals.len(), vertices.len());
    let triangles: Vec<_> =
        files.iter().find(|f| f.0 == "triangles.hex").unwrap().1.lines().collect();
    for (line, want) in triangles[..3].iter().zip(["c00000000000", "0000c0000000", "00000000c000"])
    {
        for word in [&line[..4], &line[4..8], &line[8..]] {
            assert_eq!(normals[usize::from_str_radix(word, 16).unwrap()], want);
        }
    }
}

#[test]
fn too_large_a_model_is_refused_with_its_own_limit_and_leaves_nothing() {
    let mut materials = model();
    materials.parts = vec![materials.parts[0].clone(); 257];
    let error = hex_files(&materials).unwrap_err();
    assert_eq!(
        error.to_string(),
        "257 materials, and the .hex tables hold at most 256; join materials"
    );
    assert_eq!(check_hex(&materials), Err(error));
    let mut vertices = model();
    let mut large = vertices.parts[1].clone();
    large.mesh.positions.resize(40_000, [0; 3]);
    large.mesh.colours.resize(40_000, [0; 3]);
    large.mesh.normals = crate::NormalsBuf::Vertex(vec![[0, 0, 16384]; 40_000]);
    vertices.parts = vec![large.clone(), large];
    let text = "80000 vertices, and the .hex tables hold at most 65536; simplify the mesh";
    assert_eq!(check_hex(&vertices).unwrap_err().to_string(), text);
    // The binary holds parts of its own.
    let binary = to_binary(&vertices).unwrap();
    with(&binary, |baked| assert_eq!(baked.unwrap().part_count(), 2));
    let folder = std::env::temp_dir().join(format!("scanout-bake-{}", std::process::id()));
    let error = write_hex(&vertices, &folder).unwrap_err();
    assert_eq!(
        (error.kind(), error.to_string().as_str()),
        (std::io::ErrorKind::InvalidInput, text)
    );
    assert!(!folder.exists());
    // A table that can't be written: those before it go.
    std::fs::create_dir_all(folder.join("triangles.hex")).unwrap();
    assert!(write_hex(&model(), &folder).is_err());
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
    std::fs::remove_dir_all(&folder).unwrap();
}
