//! Polygons to triangles, without new vertices and without panicking, whatever the polygon looks like.
//!
//! A quad is cut along its shorter valid diagonal (a valid one lies inside), the first when they are about equal, so that
//! the regular quads of a sphere or torus are all cut alike. A convex polygon becomes a fan. Any other polygon is
//! projected along the greatest component of its normal and loses ears (Meisters 1975), O(n^2) for n corners and a few
//! reflex ones among them.

/// Concave polygons of more corners than this become a fan, since ear clipping takes quadratic time.
const EARS_LIMIT: usize = 4096;

/// Newell's normal: twice the polygon's area long, any number of corners; not normalised.
pub(crate) fn newell(points: &[[f64; 3]]) -> [f64; 3] {
    let mut n = [0.0; 3];
    let Some(&origin) = points.first() else { return n };
    // Relative to the first corner, so that a small polygon far from the origin keeps its digits.
    let mut a = sub(points[points.len() - 1], origin);
    for &point in points {
        let b = sub(point, origin);
        let c = cross(a, b);
        n = [n[0] + c[0], n[1] + c[1], n[2] + c[2]];
        a = b;
    }
    n
}

pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Appends the triangles of a polygon of at least three corners as indices of its corners, `n - 2` of them, in the
/// polygon's own winding. Returns false when the polygon crosses itself (the triangles then are a guess).
pub(crate) fn triangulate(points: &[[f64; 3]], out: &mut Vec<[u32; 3]>) -> bool {
    match points.len() {
        0..=2 => false,
        3 => {
            out.push([0, 1, 2]);
            true
        }
        4 => quad(points, out),
        _ => polygon(points, out),
    }
}

fn quad(p: &[[f64; 3]], out: &mut Vec<[u32; 3]>) -> bool {
    let n = newell(p);
    let turns =
        |a: usize, b: usize, c: usize| dot(cross(sub(p[b], p[a]), sub(p[c], p[a])), n) > 0.0;
    let first = turns(0, 1, 2) && turns(0, 2, 3);
    let second = turns(0, 1, 3) && turns(1, 2, 3);
    let length = |a: usize, b: usize| dot(sub(p[b], p[a]), sub(p[b], p[a]));
    let take_second = match (first, second) {
        (true, false) => false,
        (false, true) => true,
        _ => length(1, 3) < 0.998 * length(0, 2),
    };
    out.extend(if take_second { [[0, 1, 3], [1, 2, 3]] } else { [[0, 1, 2], [0, 2, 3]] });
    first || second
}

fn polygon(points: &[[f64; 3]], out: &mut Vec<[u32; 3]>) -> bool {
    let n = newell(points);
    let axis = (0..3).max_by(|&a, &b| n[a].abs().total_cmp(&n[b].abs())).unwrap_or(2);
    // Two of the axes, ordered so that the projected polygon runs counter-clockwise.
    let (u, v) = [(1, 2), (2, 0), (0, 1)][axis];
    let (u, v) = if n[axis] < 0.0 { (v, u) } else { (u, v) };
    let flat: Vec<[f64; 2]> = points.iter().map(|p| [p[u], p[v]]).collect();
    let count = flat.len();
    let convex =
        (0..count).all(|i| area(flat[i], flat[(i + 1) % count], flat[(i + 2) % count]) >= 0.0);
    if convex || count > EARS_LIMIT {
        out.extend((1..count as u32 - 1).map(|i| [0, i, i + 1]));
        return convex;
    }
    clip_ears(&flat, out)
}

/// Twice the signed area of a triangle; positive when counter-clockwise.
fn area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn clip_ears(p: &[[f64; 2]], out: &mut Vec<[u32; 3]>) -> bool {
    let count = p.len();
    let mut next: Vec<usize> = (0..count).map(|i| (i + 1) % count).collect();
    let mut previous: Vec<usize> = (0..count).map(|i| (i + count - 1) % count).collect();
    // Only reflex corners can lie in an ear. A corner that became convex stays convex.
    let mut reflex: Vec<usize> =
        (0..count).filter(|&i| area(p[previous[i]], p[i], p[next[i]]) <= 0.0).collect();
    let mut left = count;
    let mut at = 0;
    let mut tried = 0;
    let mut clean = true;
    // Tests of a corner against an ear. Honest polygons need a fraction of this; it bounds the time of hostile ones.
    let mut budget = 4 * count * count + 1000 * count;
    while left > 3 {
        let (a, c) = (previous[at], next[at]);
        let size = area(p[a], p[at], p[c]);
        let is_ear = size > 0.0
            && reflex.iter().all(|&r| {
                budget = budget.saturating_sub(1);
                let q = p[r];
                q == p[a]
                    || q == p[at]
                    || q == p[c]
                    || area(p[a], p[at], q) < 0.0
                    || area(p[at], p[c], q) < 0.0
                    || area(p[c], p[a], q) < 0.0
            });
        // After a whole round without an ear: a corner without area first, then whatever comes.
        let forced = budget == 0 || (tried > left && (size == 0.0 || tried > 2 * left));
        if is_ear || forced {
            clean &= is_ear || size == 0.0;
            out.push([a as u32, at as u32, c as u32]);
            next[a] = c;
            previous[c] = a;
            left -= 1;
            tried = 0;
            reflex.retain(|&r| r != at && area(p[previous[r]], p[r], p[next[r]]) <= 0.0);
            at = next[c];
        } else {
            tried += 1;
            at = c;
        }
    }
    out.push([previous[at] as u32, at as u32, next[at] as u32]);
    clean
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(points: &[[f64; 2]]) -> (Vec<[u32; 3]>, bool) {
        let points: Vec<_> = points.iter().map(|p| [p[0], p[1], 0.0]).collect();
        let mut out = Vec::new();
        let clean = triangulate(&points, &mut out);
        assert_eq!(out.len(), points.len() - 2);
        (out, clean)
    }

    /// Triangles cover the polygon exactly when no area is negative and the areas sum to the polygon's.
    fn covers(points: &[[f64; 2]]) {
        let (triangles, clean) = run(points);
        assert!(clean);
        let mut sum = 0.0;
        for [a, b, c] in triangles {
            let size = area(points[a as usize], points[b as usize], points[c as usize]);
            assert!(size >= 0.0);
            sum += size;
        }
        let p3: Vec<_> = points.iter().map(|p| [p[0], p[1], 0.0]).collect();
        assert!((sum - newell(&p3)[2]).abs() < 1e-9 * sum.abs(), "{sum}");
    }

    #[test]
    fn quads_take_the_valid_then_the_shorter_diagonal() {
        // An arrow head: only the diagonal through its notch (corner 2) is inside.
        assert_eq!(run(&[[0., 0.], [2., -1.], [1., 0.], [2., 1.]]).0, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(run(&[[2., -1.], [1., 0.], [2., 1.], [0., 0.]]).0, [[0, 1, 3], [1, 2, 3]]);
        // A rhombus.
        assert_eq!(run(&[[-2., 0.], [0., -1.], [2., 0.], [0., 1.]]).0, [[0, 1, 3], [1, 2, 3]]);
        // A trapezoid with a rounding error: still the first diagonal.
        assert_eq!(run(&[[0., 0.], [3., 0.], [2., 1.], [1.000001, 1.]]).0[0], [0, 1, 2]);
    }

    #[test]
    fn concave_polygons_are_covered() {
        // A comb, a star and a spiral.
        covers(&[[0., 0.], [5., 0.], [5., 3.], [4., 1.], [3., 3.], [2., 1.], [1., 3.]]);
        let star: Vec<_> = (0..20)
            .map(|i| {
                let (s, c) = (f64::from(i) * std::f64::consts::PI / 10.0).sin_cos();
                let r = if i % 2 == 0 { 3.0 } else { 1.0 };
                [r * c, r * s]
            })
            .collect();
        covers(&star);
        covers(&[
            [0., 0.],
            [6., 0.],
            [6., 6.],
            [1., 6.],
            [1., 2.],
            [4., 2.],
            [4., 4.],
            [3., 4.],
            [3., 3.],
            [2., 3.],
            [2., 5.],
            [5., 5.],
            [5., 1.],
            [0., 1.],
        ]);
        // A hole joined by a bridge that is walked twice.
        covers(&[
            [0., 0.],
            [4., 0.],
            [4., 4.],
            [0., 4.],
            [0., 0.],
            [1., 1.],
            [1., 3.],
            [3., 3.],
            [3., 1.],
            [1., 1.],
        ]);
    }

    #[test]
    fn hostile_polygons_give_their_count_and_no_panic() {
        run(&[[0.; 2]; 9]);
        run(&[[0., 0.], [1., 1.], [1., 0.], [0., 1.], [2., 2.]]);
        let zigzag: Vec<_> =
            (0..500).map(|i| [f64::from(i * 37 % 101), f64::from(i * 53 % 97)]).collect();
        assert!(!run(&zigzag).1);
        let many: Vec<_> = (0..5000).map(|i| [f64::from(i), f64::from(i % 2)]).collect();
        assert!(!run(&many).1);
    }
}
