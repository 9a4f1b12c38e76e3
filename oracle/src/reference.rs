//! The definition of the right picture, in exact rationals.
//!
//! Written from the conventions alone and independent of the library: every number is an `i128` numerator over an `i128`
//! denominator, nothing is rounded. A pixel's centre is `(16 px + 8, 16 py + 8)` in 1/16 pixel. With y down,
//!
//! ```text
//!   E_ab(p) = (bx - ax)(py - ay) - (by - ay)(px - ax)      twice the area of a, b, p
//!
//!        a ------> b     E_ab > 0 below the edge: a -> b rightwards is a top edge  (dy = 0, dx > 0)
//!          \  +  /
//!           \  /         E_ca > 0 right of the edge: upwards is a left edge        (dy < 0)
//!            c
//! ```
//!
//! A centre is covered when all three are positive, or zero on a top or left edge. An attribute `f` at `p` is
//! `(E_bc f_a + E_ca f_b + E_ab f_c) / (E_bc + E_ca + E_ab)`: the plane through the three corners.

use crate::triangle::{Coverage, Picture, Texel, Texture, Triangle, Vertex, Wrap};

/// A rational number; the denominator is positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ratio {
    /// Numerator.
    pub num: i128,
    /// Denominator, positive.
    pub den: i128,
}

impl Ratio {
    /// The value as a float, for messages and error measures.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        // Integer and fraction apart, so that large values keep their fraction.
        let whole = self.num.div_euclid(self.den);
        whole as f64 + self.num.rem_euclid(self.den) as f64 / self.den as f64
    }

    /// `self - integer` as a float: the distance is exact before the one conversion.
    #[must_use]
    pub fn minus(self, integer: i128) -> f64 {
        Ratio { num: self.num - integer * self.den, den: self.den }.to_f64()
    }
}

/// What the three planes say at one covered pixel centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exact {
    /// Red, green, blue in units of 1/255.
    pub colour: [Ratio; 3],
    /// Depth in U16.16 units (65535 * 65536 is the far plane).
    pub depth: Ratio,
    /// Perspective-correct texture coordinates, in Q16.16 units.
    pub uv: [Ratio; 2],
    /// 1/w in the corners' unit.
    pub q: Ratio,
}

/// Twice the area of `a, b, p`; positive when the three turn clockwise on the screen.
fn edge(a: &Vertex, b: &Vertex, (px, py): (i128, i128)) -> i128 {
    let (ax, ay, bx, by) = (i128::from(a.x), i128::from(a.y), i128::from(b.x), i128::from(b.y));
    (bx - ax) * (py - ay) - (by - ay) * (px - ax)
}

/// True on edges whose own centres belong to the triangle.
fn is_top_or_left(a: &Vertex, b: &Vertex) -> bool {
    b.y < a.y || (b.y == a.y && b.x > a.x)
}

/// The corners in clockwise screen order, or `None` for a triangle without area.
fn clockwise(triangle: &Triangle) -> Option<[Vertex; 3]> {
    let [a, b, c] = triangle.0;
    match edge(&a, &b, (c.x.into(), c.y.into())).signum() {
        1 => Some([a, b, c]),
        -1 => Some([a, c, b]),
        _ => None,
    }
}

/// True for triangles whose corners turn counter-clockwise on the screen: front faces.
#[must_use]
pub fn is_counter_clockwise(triangle: &Triangle) -> bool {
    let [a, b, c] = &triangle.0;
    edge(a, b, (c.x.into(), c.y.into())) < 0
}

/// Calls `visit` with the weights of the corners `[a, b, c]` (in the given clockwise order) at each covered pixel.
fn for_each_pixel(
    corners: &[Vertex; 3],
    (width, height): (u32, u32),
    mut visit: impl FnMut(usize, [i128; 3]),
) {
    let [a, b, c] = corners;
    // Pixels outside the box have no covered centre; the box only saves time.
    let range = |values: [i32; 3], limit: u32| {
        let low = values.iter().min().map_or(0, |v| v.div_euclid(16)).clamp(0, limit as i32);
        let high = values.iter().max().map_or(0, |v| v.div_euclid(16) + 1).clamp(0, limit as i32);
        low..high
    };
    for y in range([a.y, b.y, c.y], height) {
        for x in range([a.x, b.x, c.x], width) {
            let p = (i128::from(16 * x + 8), i128::from(16 * y + 8));
            let weights = [edge(b, c, p), edge(c, a, p), edge(a, b, p)];
            let inside = |w: i128, from, to| w > 0 || (w == 0 && is_top_or_left(from, to));
            if inside(weights[0], b, c) && inside(weights[1], c, a) && inside(weights[2], a, b) {
                visit(y as usize * width as usize + x as usize, weights);
            }
        }
    }
}

/// The covered pixels of a picture of `size` (width, height).
#[must_use]
pub fn coverage(triangle: &Triangle, size: (u32, u32)) -> Coverage {
    let mut picture = Picture::empty(size.0, size.1);
    if let Some(corners) = clockwise(triangle) {
        for_each_pixel(&corners, size, |i, _| picture.pixels[i] = Some(()));
    }
    picture
}

/// The exact attributes of each covered pixel.
#[must_use]
pub fn exact(triangle: &Triangle, size: (u32, u32)) -> Picture<Exact> {
    let mut picture = Picture::empty(size.0, size.1);
    for_each_exact(triangle, size, |i, exact| picture.pixels[i] = Some(exact));
    picture
}

/// Calls `visit` with the index (row by row) and the exact attributes of each covered pixel.
pub fn for_each_exact(triangle: &Triangle, size: (u32, u32), mut visit: impl FnMut(usize, Exact)) {
    let Some(corners) = clockwise(triangle) else { return };
    for_each_pixel(&corners, size, |i, weights| {
        let area: i128 = weights.iter().sum();
        let sum = |value: &dyn Fn(&Vertex) -> i128| -> i128 {
            weights.iter().zip(&corners).map(|(w, v)| w * value(v)).sum()
        };
        let plane = |value: &dyn Fn(&Vertex) -> i128| Ratio { num: sum(value), den: area };
        let q = plane(&|v| v.q.into());
        let uvq = |n: usize| sum(&|v| i128::from(v.uv[n]) * i128::from(v.q));
        let exact = Exact {
            colour: [0, 1, 2].map(|n| plane(&|v| v.colour[n].into())),
            depth: plane(&|v| v.z.into()),
            uv: [0, 1].map(|n| Ratio { num: uvq(n), den: q.num }),
            q,
        };
        visit(i, exact);
    });
}

/// Index of the nearest texel along one direction of `size` texels, and how far (in texels, at most 0.5) the coordinate is
/// from the nearest border between two texels.
#[must_use]
pub fn texel_index(coordinate: Ratio, size: u32, wrap: Wrap) -> (u8, f64) {
    let n = i128::from(size);
    let (num, den) = (coordinate.num * n, coordinate.den << 16);
    let position = num.div_euclid(den);
    let fraction = num.rem_euclid(den) as f64 / den as f64;
    let index = match wrap {
        Wrap::Repeat => position.rem_euclid(n),
        Wrap::Clamp => position.clamp(0, n - 1),
        Wrap::Mirror => {
            let folded = position.rem_euclid(2 * n);
            if folded < n { folded } else { 2 * n - 1 - folded }
        }
    };
    (index as u8, fraction.min(1.0 - fraction))
}

/// The nearest texel of an exact coordinate, and for each direction the distance to a border between texels.
#[must_use]
pub fn texel(exact: &Exact, texture: &Texture) -> (Texel, [f64; 2]) {
    let (column, dx) = texel_index(exact.uv[0], texture.width, texture.wrap);
    let (row, dy) = texel_index(exact.uv[1], texture.height, texture.wrap);
    (Texel { column, row }, [dx, dy])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(corners: [(i32, i32); 3], size: (u32, u32)) -> Vec<String> {
        let v = |(x, y)| Vertex { x, y, z: 0, colour: [0; 3], uv: [0; 2], q: 1 };
        let mask = coverage(&Triangle(corners.map(v)), size);
        let row =
            |r: &[Option<()>]| r.iter().map(|p| if p.is_some() { '#' } else { '.' }).collect();
        mask.pixels.chunks(size.0 as usize).map(row).collect()
    }

    #[test]
    fn edges_through_centres_follow_the_top_left_rule() {
        // Corners on the centres of pixels (1, 1), (4, 1) and (1, 4): top and left edges drawn, the diagonal not.
        let corners = [(24, 24), (72, 24), (24, 72)];
        let expected = ["......", ".###..", ".##...", ".#....", "......"];
        assert_eq!(picture(corners, (6, 5)), expected);
        // The other half of the square takes the diagonal, neither the right nor the bottom edge.
        let other = [(72, 24), (72, 72), (24, 72)];
        let expected = ["......", "......", "...#..", "..##..", "......"];
        assert_eq!(picture(other, (6, 5)), expected);
        // Orientation does not matter.
        let turned = [corners[0], corners[2], corners[1]];
        assert_eq!(picture(turned, (6, 5)), picture(corners, (6, 5)));
    }

    #[test]
    fn wraps_fold_as_named() {
        let at = |texels: i128, wrap| texel_index(Ratio { num: texels << 16, den: 4 }, 4, wrap).0;
        let all = |wrap| [-5, -4, -1, 0, 3, 4, 7, 8].map(|t| at(t, wrap));
        assert_eq!(all(Wrap::Repeat), [3, 0, 3, 0, 3, 0, 3, 0]);
        assert_eq!(all(Wrap::Clamp), [0, 0, 0, 0, 3, 3, 3, 3]);
        assert_eq!(all(Wrap::Mirror), [3, 3, 0, 0, 3, 3, 0, 0]);
    }
}
