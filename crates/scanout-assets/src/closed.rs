//! Whether a surface is closed, so that its back faces need not be drawn.

use crate::model::Part;

/// True when every edge of all parts' triangles, by position, belongs to exactly two triangles that run along it in
/// opposite directions. O(n log n); 24 bytes a triangle and 12 a vertex while it runs.
pub(crate) fn is_closed(parts: &[Part]) -> bool {
    let triangles: usize = parts.iter().map(|part| part.mesh.triangles.len()).sum();
    // Every triangle has three edges, every edge two triangles.
    if triangles == 0 || !triangles.is_multiple_of(2) {
        return false;
    }
    let vertices = || parts.iter().flat_map(|part| &part.mesh.positions).map(|&p| packed(p));
    let mut places: Vec<u64> = vertices().collect();
    places.sort_unstable();
    places.dedup();
    // Place and direction share 32 bits.
    if places.len() > 1 << 31 {
        return false;
    }
    let place: Vec<u32> =
        vertices().map(|p| places.partition_point(|&other| other < p) as u32).collect();
    drop(places);
    // The lesser end, the greater end, and whether the triangle runs from the greater to the lesser.
    let mut edges: Vec<u64> = Vec::with_capacity(3 * triangles);
    let mut first = 0;
    for part in parts {
        for triangle in &part.mesh.triangles {
            let [a, b, c] = triangle.map(|i| u64::from(place[first + usize::from(i)]));
            let edge = |a: u64, b: u64| a.min(b) << 32 | a.max(b) << 1 | u64::from(b < a);
            edges.extend([edge(a, b), edge(b, c), edge(c, a)]);
        }
        first += part.mesh.positions.len();
    }
    edges.sort_unstable();
    let (pairs, []) = edges.as_chunks::<2>() else { return false };
    // There and back; and no other pair of the same edge.
    pairs.iter().all(|[there, back]| there & 1 == 0 && there ^ back == 1)
        && pairs.windows(2).all(|two| two[0][0] != two[1][0])
}

fn packed(p: [i16; 3]) -> u64 {
    p.into_iter().fold(0, |sum, x| sum << 16 | u64::from(x as u16))
}

#[cfg(test)]
mod tests {
    use crate::load::{Format, LoadOptions, load, load_bytes};
    use crate::model::Model;
    use std::path::Path;

    fn obj(text: &str) -> Model {
        let options = LoadOptions::default();
        load_bytes(text.as_bytes(), Some(Format::Obj), "t", None, &options).unwrap()
    }

    const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 0 0\nv 0 -0 1e-9\nv 1 1 1\n";

    #[test]
    fn a_surface_is_closed_when_all_edges_have_two_triangles() {
        for (faces, closed) in [
            ("f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", true),
            // Corners of equal position are one corner, across materials too.
            ("f 1 3 2\nusemtl b\nf 5 2 4\nf 6 4 3\nusemtl c\nf 2 3 4\n", true),
            // A hole; a sheet; nothing but lines.
            ("f 1 3 2\nf 1 2 4\nf 1 4 3\n", false),
            ("f 1 2 7 3\n", false),
            ("l 1 2 3 1\n", false),
            // A sheet with a back is closed; three sheets on one edge are not.
            ("f 1 2 3\nf 3 2 1\n", true),
            ("f 1 2 3\nf 3 2 1\nf 1 2 4\nf 4 2 1\n", false),
            // One face turned.
            ("f 1 2 3\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", false),
        ] {
            assert_eq!(obj(&format!("{CORNERS}{faces}")).closed, closed, "{faces}");
        }
    }

    #[test]
    fn shipped_models() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models");
        for (file, closed) in [
            ("cube.obj", true),
            ("torus.obj", true),
            ("sphere.obj", true),
            ("earth.obj", true),
            ("teapot.obj", false),
            ("hand.glb", true),
        ] {
            let model = load(folder.join(file), &LoadOptions::default()).unwrap();
            assert_eq!(model.closed, closed, "{file}");
        }
    }
}
