//! A UV sphere of radius 1 in a chosen number of triangles, and the picture on it.

use std::f64::consts::{PI, TAU};

use scanout::mesh::Sphere;
use scanout::mesh_clusters::clusters;
use scanout::mesh_edges::unique_edges;
use scanout_assets::{MeshBuf, NormalsBuf};

/// Side of the texture.
pub const TEXTURE_SIDE: u16 = 256;

/// Segments and bands of latitude of the sphere with this many triangles (`2 * segments * (bands - 1)`).
///
/// # Panics
/// When it is none of 400, 5,000 and 70,000.
pub fn tessellation(triangles: usize) -> (usize, usize) {
    match triangles {
        400 => (20, 11),
        5_000 => (50, 51),
        70_000 => (250, 141),
        _ => panic!("no sphere of {triangles} triangles; take 400, 5000 or 70000"),
    }
}

/// A UV sphere of radius 1: its positions are shared across the seam and at the poles, its texture coordinates not.
pub fn sphere(triangles: usize) -> MeshBuf {
    let (segments, bands) = tessellation(triangles);
    let mut mesh = MeshBuf::default();
    let mut normals = Vec::new();
    let mut add = |u: f64, v: f64| {
        let (theta, phi) = (u * TAU, v * PI);
        let n = [phi.sin() * theta.cos(), phi.cos(), -phi.sin() * theta.sin()];
        mesh.positions.push(n.map(|v| (v * 32767.0).round() as i16));
        normals.push(n.map(|v| (v * 16384.0).round() as i16));
    };
    add(0.0, 0.0);
    for r in 1..bands {
        (0..segments).for_each(|k| add(k as f64 / segments as f64, r as f64 / bands as f64));
    }
    add(0.0, 1.0);
    for r in 0..=bands {
        for k in 0..=segments {
            // A pole has a texture coordinate a triangle, in its middle.
            let shift = if r == 0 || r == bands { 0.5 } else { 0.0 };
            let (u, v) = ((k as f64 + shift) / segments as f64, r as f64 / bands as f64);
            mesh.uvs.push([(u * 65536.0).round() as i32, (v * 65536.0).round() as i32]);
        }
    }
    let position = |r: usize, k: usize| match r {
        0 => 0,
        r if r == bands => (1 + (bands - 1) * segments) as u16,
        r => (1 + (r - 1) * segments + k % segments) as u16,
    };
    let uv = |r: usize, k: usize| (r * (segments + 1) + k) as u16;
    for r in 0..bands {
        for k in 0..segments {
            let (a, b, c, d) = ((r, k), (r, k + 1), (r + 1, k), (r + 1, k + 1));
            let upper = (r > 0).then_some([a, c, b]);
            let lower = (r + 1 < bands).then_some(if r == 0 { [a, c, d] } else { [b, c, d] });
            for corners in [upper, lower].into_iter().flatten() {
                mesh.triangles.push(corners.map(|(r, k)| position(r, k)));
                mesh.uv_triangles.push(corners.map(|(r, k)| uv(r, k)));
            }
        }
    }
    assert_eq!(mesh.triangles.len(), triangles);
    mesh.normals = NormalsBuf::Vertex(normals);
    mesh.edges = edges_of(&mesh.triangles);
    mesh.bounds = Some(Sphere { centre: [0; 3], radius: 32768 });
    mesh.clusters = clusters(&mesh.positions, &mesh.triangles).collect();
    mesh
}

/// Each edge of the triangles once.
pub(crate) fn edges_of(triangles: &[[u16; 3]]) -> Vec<[u16; 2]> {
    let mut edges = vec![[0; 2]; 3 * triangles.len()];
    let count = unique_edges(triangles, &mut edges).expect("three a triangle suffice");
    edges.truncate(count);
    edges
}

/// A texture of light and dark squares with a gradient, RGB565.
pub fn texels() -> Vec<u16> {
    let side = TEXTURE_SIDE as usize;
    let texel = |i: usize| {
        let (x, y) = (i % side, i / side);
        let light = if (x / 16 + y / 16) % 2 == 0 { 255 } else { 150 };
        let [r, g, b] = [light, light * (255 - y / 2) / 255, light * (128 + x / 2) / 255];
        (r >> 3 << 11 | g >> 2 << 5 | b >> 3) as u16
    };
    (0..side * side).map(texel).collect()
}
