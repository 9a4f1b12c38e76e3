//! Clusters: bounds of the planes of every eight consecutive triangles, by which [cull](crate::cull) drops those that are turned
//! away without looking at them or their vertices.
//!
//! | value | format |
//! |---|---|
//! | axis, spread | Q2.14, unit length = 16384 |
//! | distance | i32, 2^-14 of a position's unit |
//! | altitude, centre, radius | a position's unit (2^-15 of the mesh's) |
//!
//! For every triangle of the cluster, with unit normal `n` (counter-clockwise) and a corner `P`,
//!
//! ```text
//! |n - axis| <= spread      n . P >= distance      least altitude >= altitude      |P - centre| <= radius
//! ```
//!
//! each rounded to the safe side. A triangle without area, or with an index of no position, makes the altitude 0, and such
//! a cluster is never dropped. Integers only, so every machine makes the same bits. Cost: some hundred instructions a triangle, once a mesh.

use crate::math::isqrt64;

/// Bounds of some triangles: see the module. The default is never dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Cluster {
    pub(crate) axis: [i16; 3],
    pub(crate) spread: u16,
    pub(crate) distance: i32,
    pub(crate) altitude: u16,
    pub(crate) centre: [i16; 3],
    pub(crate) radius: u16,
}

/// The clusters of a mesh's triangles, for the field [`clusters`](crate::mesh::Mesh::clusters).
///
/// ```
/// use scanout::mesh_clusters::{Cluster, clusters};
/// let positions = [[0, 0, 0], [20000, 0, 0], [0, 20000, 0], [0, 0, 20000]];
/// let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let all: Vec<Cluster> = clusters(&positions, &triangles).collect();
/// assert_eq!(all.len(), triangles.len().div_ceil(Cluster::TRIANGLES));
/// ```
pub fn clusters(
    positions: &[[i16; 3]],
    triangles: &[[u16; 3]],
) -> impl ExactSizeIterator<Item = Cluster> {
    triangles.chunks(Cluster::TRIANGLES).map(|some| Cluster::new(positions, some))
}

impl Cluster {
    /// Triangles of a cluster; the last has what is left.
    pub const TRIANGLES: usize = 8;

    /// The bounds of some triangles.
    pub fn new(positions: &[[i16; 3]], triangles: &[[u16; 3]]) -> Cluster {
        let planes = || triangles.iter().map(|&triangle| Plane::new(positions, triangle));
        let (mut low, mut high) = ([i64::MAX; 3], [i64::MIN; 3]);
        let (mut first, mut last) = ([i16::MAX; 3], [i16::MIN; 3]);
        let (mut distance, mut altitude) = (i32::MAX, u16::MAX);
        for plane in planes() {
            let Some(plane) = plane else { return Cluster::default() };
            for k in 0..3 {
                (low[k], high[k]) = (low[k].min(plane.normal[k]), high[k].max(plane.normal[k]));
                for corner in &plane.corners {
                    (first[k], last[k]) = (first[k].min(corner[k]), last[k].max(corner[k]));
                }
            }
            (distance, altitude) = (distance.min(plane.distance), altitude.min(plane.altitude));
        }
        if triangles.is_empty() {
            return Cluster::default();
        }
        let axis = [0, 1, 2].map(|k: usize| ((low[k] + high[k]) >> (FINE + 1)) as i16);
        let centre = [0, 1, 2].map(|k: usize| ((first[k] as i32 + last[k] as i32) >> 1) as i16);
        let (mut spread, mut radius) = (0, 0);
        for plane in planes().flatten() {
            let [fine, middle] = [axis.map(|v| i64::from(v) << FINE), centre.map(i64::from)];
            spread = length_between(plane.normal, fine).max(spread);
            for corner in plane.corners {
                radius = length_between(corner.map(i64::from), middle).max(radius);
            }
        }
        // Four units in the last of the normal's places: its own error is below two in each coordinate.
        let spread = ((spread + 4) >> FINE) as u16 + 1;
        Cluster { axis, spread, distance, altitude, centre, radius: radius as u16 }
    }
}

/// Places of a normal beyond Q2.14 while its bounds are sought.
const FINE: u32 = 8;

/// The distance of two points, rounded up.
fn length_between(a: [i64; 3], b: [i64; 3]) -> u64 {
    let square = |k: usize| (a[k] - b[k]).unsigned_abs().pow(2);
    isqrt64(square(0) + square(1) + square(2)) as u64 + 1
}

/// What a cluster must know of a triangle.
struct Plane {
    corners: [[i16; 3]; 3],
    /// Unit normal, Q2.22, each coordinate within 2 of the true one.
    normal: [i64; 3],
    /// Not above the true one.
    distance: i32,
    /// Rounded down.
    altitude: u16,
}

impl Plane {
    /// `None` without area or where a corner is missing.
    fn new(positions: &[[i16; 3]], triangle: [u16; 3]) -> Option<Plane> {
        let [a, b, c] = triangle.map(|i| positions.get(i as usize).copied());
        let corners = [a?, b?, c?];
        let [a, b, c] = corners.map(|p| p.map(i64::from));
        let minus = |a: [i64; 3], b: [i64; 3]| [0, 1, 2].map(|k| a[k] - b[k]);
        let (d, e, f) = (minus(b, a), minus(c, a), minus(c, b));
        let n = [d[1] * e[2] - d[2] * e[1], d[2] * e[0] - d[0] * e[2], d[0] * e[1] - d[1] * e[0]];
        let most = n.iter().fold(0, |most, v| v.unsigned_abs().max(most));
        if most == 0 {
            return None;
        }
        // |N| / longest edge; the sum of squares is below 2^72.
        let square = n.iter().map(|v| v.unsigned_abs() as u128).map(|v| v * v).sum::<u128>();
        let edge = [d, e, f].iter().map(|v| v.iter().map(|v| v * v).sum::<i64>()).fold(1, i64::max);
        let altitude = isqrt64((square / edge as u128) as u64).min(u16::MAX.into()) as u16;
        // The normal with its largest coordinate in [2^29, 2^30]. What is cut turns it by at most 2^-27.2, and
        // its length is short by one at most: 2^-29.
        let shift = 34 - most.leading_zeros() as i32;
        let n = n.map(|v| if shift > 0 { v >> shift } else { v << -shift });
        let length = isqrt64(n.iter().map(|v| (v * v) as u64).sum()) as i64;
        let normal = n.map(|v| (v << (14 + FINE)) / length);
        // |P| 2^14 (2^-27.2 + 2^-29) is below 9.
        let along: i64 = n.iter().zip(a).map(|(n, a)| n * a).sum();
        let distance = ((along << 14).div_euclid(length) - 16) as i32;
        Some(Plane { corners, normal, distance, altitude })
    }
}
