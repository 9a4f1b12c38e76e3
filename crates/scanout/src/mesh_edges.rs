//! The edges of a triangle mesh, each once: what a wireframe draws.
//!
//! A closed mesh names each edge in two triangles, in opposite directions; drawn twice, it costs
//! twice and blends twice. Here an edge is the pair of its vertex numbers, the smaller first, and
//! the edges come sorted. Memory is the caller's. An edge from a vertex to itself (in a degenerate
//! triangle) isn't an edge.

/// `out` is too small; a slice of this many edges suffices (three a triangle).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NeededLen(pub usize);

impl core::fmt::Display for NeededLen {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "too little room for the edges; {} entries suffice", self.0)
    }
}

impl core::error::Error for NeededLen {}

/// Writes the undirected edges of `triangles` (three vertex numbers each) to the front of `out`,
/// `[smaller, larger]`, sorted, each once, and returns their number.
///
/// `out` needs as many entries as there are distinct edges (a closed mesh has 3/2 a triangle); when
/// it fills up, the repeated ones in it are removed. `3 * triangles.len()` entries always suffice
/// and are fastest: one sort, `O(n log n)`.
///
/// # Errors
///
/// [`NeededLen`] with a sufficient length when the distinct edges don't fit; the contents of `out`
/// are then unspecified.
///
/// ```
/// use scanout::mesh_edges::unique_edges;
/// let mut out = [[0; 2]; 6];
/// let count = unique_edges(&[[0, 1, 2], [2, 1, 3]], &mut out).unwrap();
/// assert_eq!(out[..count], [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]]);
/// ```
pub fn unique_edges(triangles: &[[u16; 3]], out: &mut [[u16; 2]]) -> Result<usize, NeededLen> {
    // out[..sorted] is sorted and distinct, out[sorted..len] holds edges that weren't in it.
    let (mut sorted, mut len) = (0, 0);
    for &[a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let edge = [from.min(to), from.max(to)];
            if from == to || out[..sorted].binary_search(&edge).is_ok() {
                continue;
            }
            if len == out.len() {
                sorted = sort_and_dedup(&mut out[..len]);
                len = sorted;
                if out[..sorted].binary_search(&edge).is_ok() {
                    continue;
                }
            }
            let room = out.get_mut(len).ok_or(NeededLen(3 * triangles.len()))?;
            *room = edge;
            len += 1;
        }
    }
    Ok(sort_and_dedup(&mut out[..len]))
}

/// Sorts, moves the distinct edges to the front, returns their number.
fn sort_and_dedup(edges: &mut [[u16; 2]]) -> usize {
    edges.sort_unstable();
    let mut count = 0;
    for i in 0..edges.len() {
        if count == 0 || edges[count - 1] != edges[i] {
            edges[count] = edges[i];
            count += 1;
        }
    }
    count
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::{collections::BTreeSet, format, vec, vec::Vec};

    const CUBE: [[u16; 3]; 12] = [
        [0, 1, 2],
        [0, 2, 3],
        [4, 6, 5],
        [4, 7, 6],
        [0, 4, 5],
        [0, 5, 1],
        [1, 5, 6],
        [1, 6, 2],
        [2, 6, 7],
        [2, 7, 3],
        [3, 7, 4],
        [3, 4, 0],
    ];

    #[test]
    fn a_cube_has_eighteen_edges() {
        // Twelve of the cube, six diagonals of its faces.
        let mut out = [[0; 2]; 36];
        assert_eq!(unique_edges(&CUBE, &mut out), Ok(18));
        assert!(out[..18].is_sorted_by(|a, b| a < b) && out[..18].iter().all(|e| e[0] < e[1]));
        let mut tight = [[0; 2]; 18];
        assert_eq!(unique_edges(&CUBE, &mut tight), Ok(18));
        assert_eq!(tight, out[..18]);
    }

    #[test]
    fn too_small_names_a_sufficient_length() {
        for len in 0..18 {
            let error = unique_edges(&CUBE, &mut vec![[0; 2]; len]);
            assert_eq!(error, Err(NeededLen(36)));
        }
        assert_eq!(
            format!("{}", NeededLen(36)),
            "too little room for the edges; 36 entries suffice"
        );
    }

    #[test]
    fn degenerate_triangles_and_none() {
        assert_eq!(unique_edges(&[], &mut []), Ok(0));
        assert_eq!(unique_edges(&[[7, 7, 7]], &mut []), Ok(0));
        let mut out = [[0; 2]; 1];
        assert_eq!(unique_edges(&[[9, 4, 9], [4, 9, 4]], &mut out), Ok(1));
        assert_eq!(out, [[4, 9]]);
    }

    #[test]
    fn random_meshes_in_any_sufficient_room() {
        let mut state = 1u32;
        let mut random = |n: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((state >> 8) % n) as u16
        };
        for round in 0..300 {
            let vertices = 2 + round % 20;
            let triangles: Vec<[u16; 3]> = (0..round)
                .map(|_| [random(vertices), random(vertices), random(vertices)])
                .collect();
            let mut expected = BTreeSet::new();
            for t in &triangles {
                for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                    if a != b {
                        expected.insert([a.min(b), a.max(b)]);
                    }
                }
            }
            let expected: Vec<[u16; 2]> = expected.into_iter().collect();
            for room in [expected.len(), expected.len() + 1, 3 * triangles.len()] {
                let mut out = vec![[0; 2]; room.max(expected.len())];
                assert_eq!(unique_edges(&triangles, &mut out), Ok(expected.len()));
                assert_eq!(out[..expected.len()], expected);
            }
        }
    }
}
