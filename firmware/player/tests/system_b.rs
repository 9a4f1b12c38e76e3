//! The hidden faults of system B's own program, each with the file that shows it: here they don't happen.

use player::model::{ModelMemory, ObjReader, PpmReader};
use player::play::Storage;
use scanout::mesh::Normals;

type Memory = Storage<500, 1000, 62_500, 320>;

fn read<R>(text: &str, chunk: usize, with: impl FnOnce(&scanout::mesh::Mesh<'_>) -> R) -> R {
    let mut storage = Box::new(Memory::new());
    let mut memory = storage.lend();
    let mut reader = ObjReader::new(&mut memory.model);
    for chunk in text.as_bytes().chunks(chunk) {
        reader.feed(chunk).unwrap();
    }
    let built = reader.finish().unwrap();
    with(&built.model(&memory.model, None).mesh)
}

/// Its reader skipped white space behind the header, and so the first texels.
#[test]
fn the_first_texel_may_look_like_white_space_or_a_comment() {
    for first in [b' ', b'\n', b'#', b'\t', b'\r'] {
        for header in ["P6\n2 1\n255\n", "P6 2 1 255 ", "P6\n# made by hand\n2 1\n255\n"] {
            let file = [header.as_bytes(), &[first, 0x80, 0xff, 0, 0x10, 0]].concat();
            for chunk in [1, 3, 512] {
                let mut texels = [0; 2];
                let mut reader = PpmReader::new(&mut texels);
                for chunk in file.chunks(chunk) {
                    reader.feed(chunk).unwrap();
                }
                reader.finish().unwrap();
                let five = |c: u8| (u16::from(c) * 31 + 127) / 255;
                assert_eq!(
                    texels,
                    [five(first) << 11 | 32 << 5 | 31, 4 << 5],
                    "{first:02x} {header:?}"
                );
            }
        }
    }
}

/// It kept as many normals as there were texture coordinates.
#[test]
fn more_normals_than_texture_coordinates() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n\
                vn 0 0 1\nvn 0 0 -1\nvn 0 3 0\nf 1/1/1 2/1/1 3/1/1\nf 1/1/2 2/1/2 3/1/2\nf 1/1/3 2/1/3 3/1/3\n";
    read(text, 7, |mesh| {
        let Normals::Face(normals) = mesh.normals else { panic!("{:?}", mesh.normals) };
        assert_eq!(normals, [[0, 0, 16384], [0, 0, -16384], [0, 16384, 0]]);
    });
}

/// It read "1" as nothing and "1e-1" as 1.
#[test]
fn numbers_without_a_point_or_with_an_exponent() {
    let plain = "v -1.0 -1.0 0.5\nv 1.0 -1.0 0.0\nv 0.0 1.0 0.25\nvt 0.5 0.25\nf 1/1 2/1 3/1\n";
    let odd =
        "v -1 -1.0000000000 5e-1\nv +1. -.1e1 0\nv 0e9 1E+0 25e-2\nvt .5 2.5E-1\nf 1/1 2/1 3/1\n";
    let all = |mesh: &scanout::mesh::Mesh<'_>| (mesh.positions.to_vec(), mesh.uvs.to_vec());
    let want = read(plain, 512, all);
    assert_eq!(want.0, [[-32760, -32760, 8190], [32760, -32760, -8190], [0, 32760, 0]]);
    assert_eq!(want.1, [[32768, 49152]]);
    for chunk in [1, 2, 5, 512] {
        assert_eq!(read(odd, chunk, all), want);
    }
}

/// Polygons, missing and mixed attributes.
#[test]
fn faces_of_every_kind() {
    let text = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 2 5 0\nvt 1 1\n\
                f 1 2 3 4\nf 1/1 2/1 3/1 5/1 4/1\nf 1 2\nl 1 2\np 1\nf -5 -4 -1\n";
    read(text, 512, |mesh| {
        assert_eq!(
            mesh.triangles,
            [[0, 1, 2], [0, 2, 3], [0, 1, 2], [0, 2, 4], [0, 4, 3], [0, 1, 4]]
        );
        assert_eq!(mesh.normals, Normals::None);
        assert_eq!(mesh.uvs, [[65536, 0], [0, 0]]);
        assert_eq!(mesh.uv_triangles[..3], [[1, 1, 1], [1, 1, 1], [0, 0, 0]]);
    });
    // An arrow head is cut through its notch.
    let notch = "v 2 -1 0\nv 1 0 0\nv 2 1 0\nv 0 0 0\nf 1 2 3 4\nf 4 1 2 3\n";
    read(notch, 512, |mesh| {
        assert_eq!(mesh.triangles, [[0, 1, 3], [1, 2, 3], [3, 0, 1], [3, 1, 2]]);
    });
}

/// Every sort of bytes, cut anywhere, gives an answer.
#[test]
fn bytes_of_any_kind_do_not_panic() {
    let seeds: [&[u8]; 3] = [
        b"v 1 2 3\nv 4 5 6\nv 7 8 -9e9\nvt 0 1e30\nvn 1 0 0\nf 1/1/1 2/1/1 3/1/1 1 2 3\n",
        include_bytes!("../../../models/system-b/c.obj"),
        include_bytes!("../../../models/system-b/c.ppm"),
    ];
    let mut state = 1u64;
    let mut random = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize
    };
    let mut storage = Box::new(Memory::new());
    for _ in 0..4000 {
        let mut bytes = seeds[random() % 3].to_vec();
        for _ in 0..1 + random() % 4 {
            let at = random() % bytes.len();
            bytes[at] = b"\n 0123456789.e-/#vtnf\xff\0"[random() % 23];
        }
        let mut memory = storage.lend();
        let model: &mut ModelMemory<'_> = &mut memory.model;
        let mut reader = ObjReader::new(model);
        let fed = bytes.chunks(1 + random() % 600).try_for_each(|chunk| reader.feed(chunk));
        if fed.is_ok() {
            let _ = reader.finish();
        }
        let mut reader = PpmReader::new(model.texels);
        let fed = bytes.chunks(1 + random() % 600).try_for_each(|chunk| reader.feed(chunk));
        if fed.is_ok() {
            let _ = reader.finish();
        }
    }
}
