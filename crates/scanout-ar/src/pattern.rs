//! Corners from the whole known pattern: every edge between a black and a white cell says where the marker lies.
//!
//! Once it is known which marker it is, the picture of each of its cells' edges is known too, but for blur, light and the
//! homography, which are fitted together (Gauss and Newton, all edges at once):
//!
//! ```text
//!  grey(t) = black(u, v) + (white(u, v) - black(u, v)) P(t),     P(t) = sum over the edges e of +-F((t - e) / blur)
//!
//!       white ____                       t: pixels along a cell's row across its edge
//!                 \          ____        F: the integral of a quadratic B-spline, whose standard deviation is half its width;
//!                  \________/               so close to a Gaussian that it doesn't matter, and a polynomial
//! ```
//!
//! Neighbouring edges are part of the model, so that cells as narrow as the blur don't pull their border aside. black and white are
//! planes over the marker. An edge whose profile doesn't fit - covered, in a shadow's edge - weighs less.

use crate::dictionary::Dictionary;
use crate::homography::Homography;
use crate::image::GreyImage;
use crate::quad::{Corners, is_convex, twice_area};
use crate::solve::solve;
use libm::sqrt;

/// Samples of a profile.
const SAMPLES: usize = 7;
/// Rounds at most.
const ROUNDS: usize = 5;

/// What was fitted.
#[derive(Clone, Copy, Debug)]
pub struct Fitted {
    /// The corners, in the order of those that were given.
    pub corners: Corners,
    /// Standard deviation of the blur across edges, pixels.
    pub blur: f64,
    /// How much of the profiles' contrast the model explains, 0 - 1.
    pub agreement: f64,
}

/// Black and white, each a plane over the unit square: `[black, across, down, white, across, down]`.
type Light = [f64; 6];

struct Fit {
    light: Light,
    /// Samples' normal equations of the light.
    light_sums: ([[f64; 6]; 6], [f64; 6]),
    map_sums: ([[f64; 8]; 8], [f64; 8]),
    blur_sums: (f64, f64),
    /// Sum of the distances, of the weights, and how many.
    off: (f64, f64),
    /// Squared residuals and squared contrast.
    misfit: (f64, f64),
}

/// Fits the marker `code` of a dictionary to the picture. `corners` are those of the black border, the marker's own top left
/// first, clockwise, at most about a pixel and a half off; `black` and `white` its levels. `None` when it doesn't settle.
pub fn refine(
    image: &GreyImage,
    dictionary: &Dictionary,
    code: u64,
    corners: &Corners,
    (black, white): (f64, f64),
) -> Option<Fitted> {
    let cells = usize::from(dictionary.side) + 2;
    let size = sqrt(twice_area(corners) / 2.0);
    let centre = [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0);
    let cell = size / cells as f64;
    // Pixels relative to the marker, so that the equations are well scaled.
    let relative = corners.map(|[x, y]| [(x - centre[0]) / size, (y - centre[1]) / size]);
    let mut map = Homography::from_unit_square(&relative)?;
    let mut blur = (cell * 0.3).clamp(0.6, 1.2);
    let mut light = [black, 0.0, 0.0, white, 0.0, 0.0];
    let mut usual = f64::INFINITY;
    let mut agreement = 0.0;
    let per_edge = ((cell / 6.0) as usize).clamp(1, 2);
    for round in 0..ROUNDS {
        let mut fit = Fit {
            light,
            light_sums: Default::default(),
            map_sums: Default::default(),
            blur_sums: (0.0, 0.0),
            off: (0.0, 0.0),
            misfit: (0.0, 0.0),
        };
        let view = View { image, map: &map, centre, size, cells: cells as f64, blur, usual };
        for across in [false, true] {
            for line in 0..=cells {
                for k in 0..cells {
                    let white = |i: isize| {
                        // Paper around the marker.
                        let inside = (0..cells as isize).contains(&i);
                        let (column, row) = if across { (k, i as usize) } else { (i as usize, k) };
                        !inside || dictionary.is_white(code, column, row)
                    };
                    let i = line as isize;
                    if white(i - 1) == white(i) {
                        continue;
                    }
                    let row = core::array::from_fn(|j| white(i + j as isize - 2));
                    for step in 0..per_edge {
                        let along = 0.25 + 0.5 * (step as f64 + 0.5) / per_edge as f64;
                        view.profile(across, line as f64, k as f64 + along, row, &mut fit);
                    }
                }
            }
        }
        let moved = {
            let (mut matrix, right) = fit.map_sums;
            for (i, row) in matrix.iter_mut().enumerate() {
                row[i] *= 1.0 + 1e-9;
            }
            let step = solve(matrix, right)?;
            let before = corners_of(&map);
            map.0.iter_mut().zip(step).for_each(|(entry, step)| *entry += step);
            let after = corners_of(&map);
            let far =
                |i: usize| (after[i][0] - before[i][0]).abs() + (after[i][1] - before[i][1]).abs();
            (0..4).map(far).fold(0.0, f64::max) * size
        };
        if !moved.is_finite() || moved > 0.75 * size {
            return None;
        }
        if let Some(solved) = solve(fit.light_sums.0, fit.light_sums.1) {
            light = solved;
        }
        if fit.blur_sums.1 > 0.0 {
            let change = (fit.blur_sums.0 / fit.blur_sums.1).clamp(-0.4 * blur, 0.4 * blur);
            blur = (blur + change).clamp(0.35, (0.6 * cell).max(0.7));
        }
        usual = (fit.off.0 / fit.off.1.max(1.0)).max(0.02);
        agreement = 1.0 - fit.misfit.0 / fit.misfit.1.max(1e-9);
        if round > 0 && moved < 0.02 {
            break;
        }
    }
    let corners = corners_of(&map).map(|[x, y]| [x * size + centre[0], y * size + centre[1]]);
    is_convex(&corners).then_some(Fitted { corners, blur, agreement })
}

fn corners_of(map: &Homography) -> Corners {
    [map.map(0.0, 0.0), map.map(1.0, 0.0), map.map(1.0, 1.0), map.map(0.0, 1.0)]
}

/// The state that profiles are compared with.
struct View<'a> {
    image: &'a GreyImage<'a>,
    map: &'a Homography,
    centre: [f64; 2],
    size: f64,
    cells: f64,
    blur: f64,
    /// Usual distance of an edge from the model, pixels.
    usual: f64,
}

impl View<'_> {
    /// Compares one profile across the edge `line`, at `along` on it (cells), with the model. `row` tells which of the four cells
    /// around the edge are white: two before it, two behind.
    fn profile(&self, across: bool, line: f64, along: f64, row: [bool; 4], fit: &mut Fit) {
        let (u, v) = if across { (along, line) } else { (line, along) };
        let (u, v) = (u / self.cells, v / self.cells);
        let (at, d) = self.map.map_with_derivatives(u, v);
        // Pixels a cell, across the edge and along it.
        let scale = self.size / self.cells;
        let (over, tangent) = ([d[0] * scale, d[2] * scale], [d[1] * scale, d[3] * scale]);
        let (over, tangent) = if across { (tangent, over) } else { (over, tangent) };
        let length = sqrt(tangent[0] * tangent[0] + tangent[1] * tangent[1]).max(1e-9);
        let mut normal = [tangent[1] / length, -tangent[0] / length];
        let mut cell = over[0] * normal[0] + over[1] * normal[1];
        if cell < 0.0 {
            (normal, cell) = ([-normal[0], -normal[1]], -cell);
        }
        if cell < 0.8 {
            return;
        }
        // Half the profile: to the middles of the neighbouring cells, but not far beyond the blur.
        let reach = (0.6 * cell).min(2.5 * self.blur + 1.0);
        let [x, y] = [0, 1].map(|i| at[i] * self.size + self.centre[i]);
        let contrast = self.contrast(&fit.light, u, v);
        if contrast < 1.0 {
            return;
        }
        let sign = |white: bool| if white { 1.0 } else { 0.0 };
        let jumps = [1, 2, 3].map(|i| sign(row[i]) - sign(row[i - 1]));
        let mut g = [0.0; SAMPLES];
        let mut r = [0.0; SAMPLES];
        let (mut grg, mut ggg, mut blur) = (0.0, 0.0, (0.0, 0.0));
        let black = fit.light[0] + fit.light[1] * u + fit.light[2] * v;
        // An edge's width grows in pixels where the picture is stretched; the blur doesn't.
        let width = 2.0 * self.blur;
        let mut light = [([0.0; 6], 0.0); SAMPLES];
        for (i, j) in (-3i32..=3).enumerate() {
            let t = f64::from(j) * reach / 3.0;
            let part = t / cell;
            let value = self.image.sample(x + over[0] * part, y + over[1] * part);
            let (mut p, mut dp, mut db) = (sign(row[0]), 0.0, 0.0);
            for (edge, jump) in [-1.0, 0.0, 1.0].iter().zip(jumps) {
                if jump != 0.0 {
                    let z = (t - edge * cell) / width;
                    let (integral, density) = spline(z);
                    p += jump * integral;
                    dp += jump * density / width;
                    db -= jump * density * z / self.blur;
                }
            }
            r[i] = value - (black + contrast * p);
            g[i] = contrast * dp;
            grg += r[i] * g[i];
            ggg += g[i] * g[i];
            blur.0 += r[i] * contrast * db;
            blur.1 += contrast * contrast * db * db;
            let q = 1.0 - p;
            light[i] = ([q, q * u, q * v, p, p * u, p * v], value);
        }
        if ggg < 1e-6 {
            return;
        }
        // Moving the edge by `off` along the normal changes the profile by -g off.
        let off = (-grg / ggg).clamp(-reach, reach);
        let (mut misfit, mut energy) = (0.0, 0.0);
        for i in 0..SAMPLES {
            let rest = r[i] + g[i] * off;
            misfit += rest * rest;
            energy += contrast * contrast / 4.0;
        }
        fit.misfit.0 += misfit;
        fit.misfit.1 += energy;
        fit.off.0 += off.abs();
        fit.off.1 += 1.0;
        let fits = 1.0 / (1.0 + misfit / (0.15 * energy));
        let near = if off.abs() > 2.5 * self.usual { 2.5 * self.usual / off.abs() } else { 1.0 };
        let robust = fits * fits * near;
        let weight = robust * ggg / (contrast * contrast);
        let w = 1.0 / (self.map.0[6] * u + self.map.0[7] * v + 1.0);
        let (nx, ny) = (normal[0] * w, normal[1] * w);
        let depth = -(at[0] * nx + at[1] * ny);
        let j = [nx * u, nx * v, nx, ny * u, ny * v, ny, depth * u, depth * v];
        accumulate(&mut fit.map_sums, &j, off / self.size, weight);
        for (basis, value) in light {
            accumulate(&mut fit.light_sums, &basis, value, robust);
        }
        fit.blur_sums.0 += robust * blur.0;
        fit.blur_sums.1 += robust * blur.1;
    }

    fn contrast(&self, light: &Light, u: f64, v: f64) -> f64 {
        light[3] - light[0] + (light[4] - light[1]) * u + (light[5] - light[2]) * v
    }
}

/// Adds one weighted equation `row . x = right` to normal equations.
fn accumulate<const N: usize>(
    sums: &mut ([[f64; N]; N], [f64; N]),
    row: &[f64; N],
    right: f64,
    weight: f64,
) {
    for i in 0..N {
        let scaled = row[i] * weight;
        // The lower triangle is all that is read.
        for (to, value) in sums.0[i][..=i].iter_mut().zip(row) {
            *to += scaled * value;
        }
        sums.1[i] += scaled * right;
    }
}

/// Integral and value at z of the quadratic B-spline that reaches from -1.5 to 1.5.
fn spline(z: f64) -> (f64, f64) {
    let a = z.abs();
    let (beyond, density) = if a <= 0.5 {
        (0.5 - 0.75 * a + a * a * a / 3.0, 0.75 - a * a)
    } else if a < 1.5 {
        let rest = 1.5 - a;
        (rest * rest * rest / 6.0, rest * rest / 2.0)
    } else {
        (0.0, 0.0)
    };
    (if z > 0.0 { 1.0 - beyond } else { beyond }, density)
}
