use super::*;
use crate::load::{Format, load_bytes};

fn load(obj: &str) -> Model {
    load_bytes(obj.as_bytes(), Some(Format::Obj), "t.obj", None, &LoadOptions::default()).unwrap()
}

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n\
    f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";

#[test]
fn a_cube_keeps_its_eight_corners() {
    let model = load(CUBE);
    let mesh = &model.parts[0].mesh;
    assert_eq!((mesh.positions.len(), mesh.triangles.len(), mesh.edges.len()), (8, 12, 12));
    let NormalsBuf::Face(normals) = &mesh.normals else { panic!("{:?}", mesh.normals) };
    assert_eq!(normals[..4], [[0, 0, -16384], [0, 0, -16384], [0, 0, 16384], [0, 0, 16384]]);
    assert!(mesh.uvs.is_empty() && mesh.uv_triangles.is_empty() && mesh.colours.is_empty());
    assert_eq!(mesh.positions[0], [-32760, 32760, -32760]);
    assert_eq!(mesh.as_mesh().positions.len(), 8);
}

#[test]
fn the_grid_fills_the_range_and_leads_back() {
    let text = "v 1000000.5 2 3\nv 1000002.5 2 3\nv 1000000.5 2.5 3\nv 5 5 5\nf 1 2 3\n";
    let model = load(text);
    let placement = model.placement;
    assert!((placement.scale - 32768.0 / 32760.0).abs() < 1e-12);
    assert_eq!(placement.offset, [1000001.5, 2.25, 3.0], "vertices without a face don't count");
    let mesh = &model.parts[0].mesh;
    let want = [[1000000.5, 2.0, 3.0], [1000002.5, 2.0, 3.0], [1000000.5, 2.5, 3.0]];
    for (p, want) in mesh.positions.iter().zip(want) {
        let back = placement.to_world(*p);
        assert!(back.iter().zip(want).all(|(a, b)| (a - b).abs() <= placement.scale / 65536.0));
    }
    assert_eq!(model.bounds()[1][1], placement.to_world(mesh.positions[2])[1]);
    for tiny in ["1e-30", "1e29"] {
        let model = load(&format!("v 0 0 0\nv {tiny} 0 0\nv 0 {tiny} 0\nf 1 2 3"));
        assert_eq!(model.stats.triangles, 1);
    }
}

#[test]
fn parts_share_the_grid_and_edges_are_drawn_once() {
    let text =
        format!("{}usemtl a\nf 1 2 3 4\nusemtl b\nf 4 3 7 8\n", CUBE.split_once('f').unwrap().0);
    let model = load(&text);
    assert_eq!(model.parts.len(), 2);
    assert_eq!((model.parts[0].name.as_str(), model.parts[1].name.as_str()), ("a", "b"));
    assert_eq!(model.stats.edges, 7, "the shared edge is in one part only");
    assert_eq!(model.parts[0].mesh.positions[2], model.parts[1].mesh.positions[1]);
}

#[test]
fn smooth_and_flat_faces_share_positions_as_they_can() {
    // A roof of 90 degrees, smoothed by its group: the ridge's two positions have one normal each.
    let text =
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 -1\nv 0 1 -1\ns 1\nf 1 2 3 4\nf 1 4 6 5\n";
    let mesh = load(text).parts.remove(0).mesh;
    assert_eq!(mesh.positions.len(), 6);
    assert!(matches!(&mesh.normals, NormalsBuf::Vertex(n) if n.len() == 6));
    // With a second, flat face at the first corner that corner is doubled, and edges still refer to one of the two.
    let mesh = load(&format!("{text}s off\nf 1 5 2")).parts.remove(0).mesh;
    assert_eq!((mesh.positions.len(), mesh.edges.len()), (9, 8));
}

#[test]
fn degenerate_faces_are_dropped_and_counted() {
    let model = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nf 1 2 3\nf 1 1 2\nf 1 4 3\nf 1 2\nf 3\n");
    assert_eq!((model.stats.triangles, model.stats.degenerate), (1, 2));
    let texts: Vec<_> = model.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        texts,
        [
            "faces of fewer than three corners were dropped (2 times)",
            "triangles without area were dropped (2 times)"
        ]
    );
    let error =
        load_bytes(b"v 0 0 0\nf 1 1 1", None, "t", None, &LoadOptions::default()).unwrap_err();
    assert_eq!(error.to_string(), "t: nothing to draw: every face is degenerate; check the export");
}

#[test]
fn detail_finer_than_the_grid_is_counted() {
    // A grid step is 200 / 65520 = 0.003: of the small tetrahedra one has a side of 10 steps, one of less than one.
    let mut text = String::from("v -100 0 0\nv 100 0 0\nv 0 100 0\nf 1 2 3\n");
    for side in [0.03, 0.001] {
        text += &format!("v 0 0 1\nv {side} 0 1\nv 0 {side} 1\nv 0 0 {}\n", 1.0 + side);
        text += "f -4 -2 -3\nf -4 -3 -1\nf -4 -1 -2\nf -3 -2 -1\n";
    }
    // Neither a point nor a needle has an area to lose; one that the grid flattens without joining its corners has.
    text += "v 0 0 5\nv 3 0 5\nv 1 0.0001 5\nf -3 -3 -3\nf -3 -2 -1\n";
    text += "v 0 0 7\nv 0.007 0 7\nv 0.0035 0.0014 7\nf -3 -2 -1\n";
    let model = load(&text);
    let texts: Vec<_> = model.warnings.iter().map(ToString::to_string).collect();
    assert_eq!(
        texts,
        [
            "triangles without area were dropped",
            "triangles lost their area: finer than 1/65520 of the model's size; split the model into several (5 times)"
        ]
    );
    assert_eq!((model.stats.triangles, model.stats.degenerate), (7, 5));
}

#[test]
fn lines_and_points_have_parts_of_their_own() {
    let model = load(&format!("{CUBE}l 1 7 2\np 4\n"));
    assert_eq!(model.parts.len(), 2);
    let lines = &model.parts[1].mesh;
    assert_eq!(
        (lines.positions.len(), lines.edges.len(), &lines.normals),
        (4, 2, &NormalsBuf::None)
    );
    let only = load("v 0 0 0\nv 1 1 1\nl 1 2\nl 2 1\n");
    assert_eq!(only.parts[0].mesh.edges, [[0, 1]]);
}

#[test]
fn a_large_part_is_split() {
    // 300 x 300 quads: 90,601 positions and as many texture coordinates.
    let side = 301;
    let mut text = String::new();
    for y in 0..side {
        for x in 0..side {
            text += &format!("v {x} {y} 0\nvt {} {}\n", f64::from(x) / 300.0, f64::from(y) / 300.0);
        }
    }
    for y in 0..side - 1 {
        for x in 0..side - 1 {
            let i = y * side + x + 1;
            let corner = |i: i32| format!("{i}/{i} ");
            text += &format!(
                "f {}{}{}{}\n",
                corner(i),
                corner(i + 1),
                corner(i + 1 + side),
                corner(i + side)
            );
        }
    }
    let model = load(&text);
    assert_eq!(model.parts.len(), 2);
    assert_eq!(
        (model.parts[0].name.as_str(), model.parts[1].name.as_str()),
        ("default", "default (2)")
    );
    assert_eq!((model.stats.triangles, model.stats.edges), (180_000, 2 * 300 * 301));
    for part in &model.parts {
        let mesh = &part.mesh;
        assert!(mesh.positions.len() <= 65_536 && mesh.uvs.len() <= 65_536);
        let most = mesh.triangles.as_flattened().iter().max().unwrap();
        assert!(usize::from(*most) < mesh.positions.len());
        assert_eq!(mesh.triangles.len(), mesh.uv_triangles.len());
    }
}

#[test]
fn v_goes_down() {
    let mesh = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1.5 0\nvt 0 1\nf 1/1 2/2 3/3")
        .parts
        .remove(0)
        .mesh;
    assert_eq!(mesh.uvs, [[0, 65536], [98304, 65536], [0, 0]]);
    assert_eq!(mesh.uv_triangles, [[0, 1, 2]]);
}

#[test]
fn spheres_hold_every_position_and_are_tight() {
    let cube: Vec<[i16; 3]> = (0..8)
        .map(|i| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 32767 } else { -32767 }))
        .collect();
    let sphere = bounding_sphere(&cube);
    assert_eq!((sphere.centre, sphere.radius), ([0; 3], 56755));
    let mut seed = 1u32;
    let mut random = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 16) as i16
    };
    for count in 1..200 {
        let points: Vec<[i16; 3]> =
            (0..count).map(|_| [random(), random(), random() / 4]).collect();
        let sphere = bounding_sphere(&points);
        let radius2 = u64::from(sphere.radius) * u64::from(sphere.radius);
        assert!(points.iter().all(|&p| distance2(p, sphere.centre) <= radius2));
    }
    assert_eq!(bounding_sphere(&[[5, 6, 7]]), Sphere { centre: [5, 6, 7], radius: 0 });
}
