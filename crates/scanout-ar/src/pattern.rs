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
//! planes over the marker. Blur may be wider in one direction, as motion makes it. An edge whose profile doesn't fit - covered, in a shadow's edge - weighs less.

use crate::dictionary::Dictionary;
use crate::homography::Homography;
use crate::image::GreyImage;
use crate::quad::{Corners, is_convex, twice_area};
use crate::solve::solve;
use libm::sqrt;

/// Samples of a profile, the middle one on the edge.
const SAMPLES: usize = 7;
/// Rounds at most.
const ROUNDS: usize = 8;
/// Cells in a row at most, the border included.
const MOST_CELLS: usize = 8;

/// What was fitted.
#[derive(Clone, Copy, Debug)]
pub struct Fitted {
    /// The corners, in the order of those that were given.
    pub corners: Corners,
    /// Standard deviation of the blur, the mean of all directions, pixels.
    pub blur: f64,
    /// How much of the profiles' contrast the model explains, 0 - 1.
    pub agreement: f64,
    /// The part of the edges that is seen, of whose contrast the model explains more than half: the smaller part of the border's edges and
    /// of those inside, which tell the marker from others.
    pub seen: f64,
    /// How much of the contrast of those it explains.
    pub agreement_seen: f64,
}

/// Black and white, each a plane over the unit square: `[black, across, down, white, across, down]`.
type Light = [f64; 6];

/// Fits the marker `code` of a dictionary to the picture. `corners` are those of the black border, the marker's own top left
/// first, clockwise, at most about a pixel and a half off; `black` and `white` its levels. `None` when it doesn't settle.
pub fn refine(
    image: &GreyImage,
    dictionary: &Dictionary,
    code: u64,
    corners: &Corners,
    (black, white): (f64, f64),
) -> Option<Fitted> {
    let edges = Edges::new(dictionary, code);
    let size = sqrt(twice_area(corners) / 2.0);
    let centre = [0, 1].map(|axis| corners.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0);
    let cell = size / edges.cells as f64;
    // Pixels relative to the marker, so that the equations are well scaled.
    let relative = corners.map(|[x, y]| [(x - centre[0]) / size, (y - centre[1]) / size]);
    let mut map = Homography::from_unit_square(&relative)?;
    let round_blur = (cell * 0.3).clamp(0.6, 1.2);
    let mut blur = Blur {
        square: [round_blur * round_blur, 0.0, round_blur * round_blur],
        most: cell.max(0.7),
    };
    let mut light = [black, 0.0, 0.0, white, 0.0, 0.0];
    let mut usual = f64::INFINITY;
    let (mut agreement, mut seen, mut agreement_seen) = (0.0, 0.0, 0.0);
    let per_edge = ((cell / 6.0) as usize).clamp(1, 2);
    for round in 0..ROUNDS {
        let cells = edges.cells as f64;
        let view = View { image, map: &map, centre, size, cells, blur, light, usual };
        let mut sums = Sums::default();
        edges.each(|across, line, k, row| {
            for step in 0..per_edge {
                let along = 0.25 + 0.5 * (step as f64 + 0.5) / per_edge as f64;
                sums.inside = (1..edges.cells).contains(&line);
                view.profile(across, line as f64, k as f64 + along, row, &mut sums);
            }
        });
        let step = sums.map_step()?;
        let before = corners_of(&map);
        map.0.iter_mut().zip(step).for_each(|(entry, step)| *entry += step);
        let after = corners_of(&map);
        let far =
            |i: usize| (after[i][0] - before[i][0]).abs() + (after[i][1] - before[i][1]).abs();
        let moved = (0..4).map(far).fold(0.0, f64::max) * size;
        if !moved.is_finite() || moved > 0.75 * size {
            return None;
        }
        if let Some(solved) = sums.light() {
            light = solved;
        }
        blur.improve(&sums);
        usual = (sums.off.0 / sums.off.1.max(1.0)).max(0.02);
        agreement = 1.0 - sums.misfit.0 / sums.misfit.1.max(1e-9);
        seen = sums.part_seen();
        agreement_seen = 1.0 - sums.misfit_seen.0 / sums.misfit_seen.1.max(1e-9);
        if round > 0 && moved < 0.05 {
            break;
        }
    }
    let corners = corners_of(&map).map(|[x, y]| [x * size + centre[0], y * size + centre[1]]);
    is_convex(&corners).then_some(Fitted {
        corners,
        blur: blur.mean(),
        agreement,
        seen,
        agreement_seen,
    })
}

fn corners_of(map: &Homography) -> Corners {
    [map.map(0.0, 0.0), map.map(1.0, 0.0), map.map(1.0, 1.0), map.map(0.0, 1.0)]
}

/// The edges between black and white cells.
struct Edges {
    /// Cells in a row, the border included.
    cells: usize,
    /// For each row and for each column the white cells from the lowest bit on, with two cells of paper before and behind.
    white: [[u16; MOST_CELLS]; 2],
}

impl Edges {
    fn new(dictionary: &Dictionary, code: u64) -> Self {
        let cells = usize::from(dictionary.side) + 2;
        let paper = 3 | 3 << (cells + 2);
        let mut white = [[paper; MOST_CELLS]; 2];
        for (row, column) in (0..cells).flat_map(|row| (0..cells).map(move |column| (row, column)))
        {
            if dictionary.is_white(code, column, row) {
                white[0][row] |= 4 << column;
                white[1][column] |= 4 << row;
            }
        }
        Self { cells, white }
    }

    /// Calls `each` for every edge: does it lie across the rows, before which cell of a row or column, in which, and which of the four
    /// cells around it are white, two before it in the lower bits.
    fn each(&self, mut each: impl FnMut(bool, usize, usize, u16)) {
        for (across, white) in [false, true].into_iter().zip(&self.white) {
            for line in 0..=self.cells {
                for (k, white) in white[..self.cells].iter().enumerate() {
                    let row = white >> line & 15;
                    if (row >> 1 ^ row >> 2) & 1 == 1 {
                        each(across, line, k, row);
                    }
                }
            }
        }
    }
}

/// Blur in every direction, as motion makes it: its variance along a unit vector n is n^T B n.
#[derive(Clone, Copy)]
struct Blur {
    /// B: xx, xy, yy, squared pixels.
    square: [f64; 3],
    /// Greatest standard deviation, pixels.
    most: f64,
}

impl Blur {
    fn along(&self, [x, y]: [f64; 2]) -> f64 {
        let [xx, xy, yy] = self.square;
        let least = 0.35;
        let variance = xx * x * x + 2.0 * xy * x * y + yy * y * y;
        sqrt(variance.max(least * least)).min(self.most)
    }

    fn mean(&self) -> f64 {
        (self.along([1.0, 0.0]) + self.along([0.0, 1.0])) / 2.0
    }

    /// One step of Gauss and Newton, by at most what is there. Edges of two directions don't tell three entries: those that they leave open
    /// stay.
    fn improve(&mut self, sums: &Sums) {
        let mut matrix = sums.blur;
        let damping = 1e-3 * (0..3).map(|i| matrix[i][i]).sum::<f64>();
        (0..3).for_each(|i| matrix[i][i] += damping);
        let Some(step) = solve(matrix, sums.blur_right) else { return };
        let size = |square: &[f64; 3]| sqrt(square.iter().map(|entry| entry * entry).sum());
        let part = (0.6 * size(&self.square) / size(&step).max(1e-9)).min(1.0);
        self.square = core::array::from_fn(|i| self.square[i] + part * step[i]);
    }
}

/// The state that profiles are compared with.
struct View<'a> {
    image: &'a GreyImage<'a>,
    map: &'a Homography,
    centre: [f64; 2],
    size: f64,
    cells: f64,
    blur: Blur,
    light: Light,
    /// Usual distance of an edge from the model, pixels.
    usual: f64,
}

impl View<'_> {
    /// Compares one profile across the edge `line`, at `along` on it (cells), with the model. `row` tells which of the four cells
    /// around the edge are white: two before it, two behind.
    fn profile(&self, across: bool, line: f64, along: f64, row: u16, sums: &mut Sums) {
        sums.all[usize::from(sums.inside)] += 1.0;
        let (u, v) = if across { (along, line) } else { (line, along) };
        let (u, v) = (u / self.cells, v / self.cells);
        let (at, d) = self.map.map_with_derivatives(u, v);
        // Pixels a cell, across the edge and along it.
        let scale = self.size / self.cells;
        let (over, tangent) = ([d[0] * scale, d[2] * scale], [d[1] * scale, d[3] * scale]);
        let (over, tangent) = if across { (tangent, over) } else { (over, tangent) };
        let length = 1.0 / sqrt(tangent[0] * tangent[0] + tangent[1] * tangent[1]).max(1e-9);
        let mut normal = [tangent[1] * length, -tangent[0] * length];
        let mut cell = over[0] * normal[0] + over[1] * normal[1];
        if cell < 0.0 {
            (normal, cell) = ([-normal[0], -normal[1]], -cell);
        }
        if cell < 0.8 {
            return;
        }
        // Half the profile: to the middles of the neighbouring cells, but not far beyond the blur.
        let blur = self.blur.along(normal);
        let reach = (0.6 * cell).min(2.5 * blur + 1.0);
        let [x, y] = [0, 1].map(|i| at[i] * self.size + self.centre[i]);
        let [black, black_across, black_down, white, white_across, white_down] = self.light;
        let black = black + black_across * u + black_down * v;
        let contrast = white + white_across * u + white_down * v - black;
        if contrast < 1.0 {
            return;
        }
        let spacing = 2.0 * reach / (SAMPLES - 1) as f64;
        let part = reach / cell;
        let start = [x - over[0] * part, y - over[1] * part];
        let part = spacing / cell;
        let samples = self.image.line::<SAMPLES>(start, [over[0] * part, over[1] * part]);
        let mut values = [0.0; LANES];
        values[..SAMPLES].copy_from_slice(&samples);
        let model = Profile::new(row, reach as f32, cell as f32, blur as f32);
        let fitted = model.compare(&values, black as f32, contrast as f32);
        if fitted.gg < 1e-6 {
            return;
        }
        // Moving the edge by `off` along the normal changes the profile by -g off.
        let off = (-fitted.rg / fitted.gg).clamp(-reach, reach);
        let misfit = fitted.rr + off * (2.0 * fitted.rg + off * fitted.gg);
        let energy = SAMPLES as f64 * contrast * contrast / 4.0;
        sums.misfit.0 += misfit;
        sums.misfit.1 += energy;
        if misfit < 0.5 * energy {
            sums.misfit_seen.0 += misfit;
            sums.misfit_seen.1 += energy;
            sums.seen[usize::from(sums.inside)] += 1.0;
        }
        sums.off.0 += off.abs();
        sums.off.1 += 1.0;
        let fits = 1.0 / (1.0 + misfit / (0.15 * energy));
        let near = if off.abs() > 2.5 * self.usual { 2.5 * self.usual / off.abs() } else { 1.0 };
        let robust = fits * fits * near;
        let weight = robust * fitted.gg / (contrast * contrast);
        let w = 1.0 / (self.map.0[6] * u + self.map.0[7] * v + 1.0);
        let (nx, ny) = (normal[0] * w, normal[1] * w);
        let depth = -(at[0] * nx + at[1] * ny);
        sums.add_edge([nx, ny, depth], [u, v], off / self.size, weight);
        sums.add_light(&fitted, [u, v], robust);
        sums.add_blur(&fitted, normal, blur, robust);
    }
}

/// Two vectors of four; the last lane stays 0.
const LANES: usize = 8;
type Lanes = [f32; LANES];
/// 1 for each sample.
const ONE: Lanes = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0];

/// The model of one profile: the part of white at each sample, and how it changes.
struct Profile {
    part: Lanes,
    /// By pixels along the profile.
    slope: Lanes,
    /// By the blur.
    wider: Lanes,
}

impl Profile {
    fn new(row: u16, reach: f32, cell: f32, blur: f32) -> Self {
        let sign = |i: usize| f32::from(row >> i & 1);
        let mut profile =
            Self { part: ONE.map(|one| one * sign(0)), slope: [0.0; LANES], wider: [0.0; LANES] };
        // An edge's width grows in pixels where the picture is stretched; the blur doesn't.
        let narrow = 0.5 / blur;
        for edge in 0..3 {
            let jump = sign(edge + 1) - sign(edge);
            if jump == 0.0 {
                continue;
            }
            let place = (edge as f32 - 1.0) * cell;
            for (i, one) in ONE.into_iter().enumerate() {
                let t = (i as f32 * (2.0 / (SAMPLES - 1) as f32) - 1.0) * reach;
                let z = (t - place) * narrow;
                let (integral, density) = spline(z);
                let jump = jump * one;
                let slope = jump * density * narrow;
                profile.part[i] += jump * integral;
                profile.slope[i] += slope;
                profile.wider[i] -= 2.0 * slope * z;
            }
        }
        profile
    }

    fn compare(&self, values: &Lanes, black: f32, contrast: f32) -> Fit {
        let lanes = |f: &dyn Fn(usize) -> f32| -> Lanes { core::array::from_fn(f) };
        let r = lanes(&|i| values[i] - (black * ONE[i] + contrast * self.part[i]));
        let g = lanes(&|i| contrast * self.slope[i]);
        let b = lanes(&|i| contrast * self.wider[i]);
        let q = lanes(&|i| ONE[i] - self.part[i]);
        Fit {
            rr: dot(&r, &r),
            rg: dot(&r, &g),
            gg: dot(&g, &g),
            rb: dot(&r, &b),
            bb: dot(&b, &b),
            parts: [dot(&q, &q), dot(&q, &self.part), dot(&self.part, &self.part)],
            values: [dot(&q, values), dot(&self.part, values)],
        }
    }
}

/// A profile beside its model: sums over the samples of products of residuals r, derivatives by place g and by blur b, and of the parts
/// of black and white.
struct Fit {
    rr: f64,
    rg: f64,
    gg: f64,
    rb: f64,
    bb: f64,
    parts: [f64; 3],
    values: [f64; 2],
}

fn dot(a: &Lanes, b: &Lanes) -> f64 {
    let four: [f32; LANES / 2] = core::array::from_fn(|i| a[i] * b[i] + a[i + 4] * b[i + 4]);
    ((four[0] + four[2]) + (four[1] + four[3])).into()
}

/// Integral and value at z of the quadratic B-spline that reaches from -1.5 to 1.5: two truncated powers, without a branch.
fn spline(z: f32) -> (f32, f32) {
    let positive = |x: f32| if x > 0.0 { x } else { 0.0 };
    let (outer, inner) = (positive(1.5 - z.abs()), positive(0.5 - z.abs()));
    let (outer_2, inner_2) = (outer * outer, inner * inner);
    let beyond = outer_2 * outer * (1.0 / 6.0) - inner_2 * inner * 0.5;
    (0.5 + (0.5 - beyond).copysign(z), 0.5 * outer_2 - 1.5 * inner_2)
}

/// What the equations need of all profiles. Each row of the matrices is a product of one of a profile's own factors and one of 1, u, v;
/// so are their squares, of pairs of factors and of u u, u v, v v, u, v, 1.
#[derive(Default)]
struct Sums {
    map: [[f64; 6]; 6],
    map_right: [[f64; 3]; 3],
    light: [[f64; 6]; 3],
    light_right: [[f64; 3]; 2],
    blur: [[f64; 3]; 3],
    blur_right: [f64; 3],
    /// Sum of the distances, and how many.
    off: (f64, f64),
    /// Squared residuals and squared contrast.
    misfit: (f64, f64),
    /// The same of profiles that are seen.
    misfit_seen: (f64, f64),
    /// How many profiles there are at the border and inside, and how many of them are seen.
    all: [f64; 2],
    seen: [f64; 2],
    /// Is the next profile inside?
    inside: bool,
}

/// Where the product of two of u, v, 1 stands.
const PRODUCT: [[usize; 3]; 3] = [[0, 1, 3], [1, 2, 4], [3, 4, 5]];

impl Sums {
    /// An edge at (u, v) that lies off by `right` where `factors` tell how the map's rows move it.
    fn add_edge(&mut self, [x, y, w]: [f64; 3], [u, v]: [f64; 2], right: f64, weight: f64) {
        let places = [u * u, u * v, v * v, u, v, 1.0];
        let pairs = [x * x, x * y, y * y, x * w, y * w, w * w];
        for (sums, pair) in self.map.iter_mut().zip(pairs) {
            add_scaled(sums, &places, weight * pair);
        }
        for (sums, factor) in self.map_right.iter_mut().zip([x, y, w]) {
            add_scaled(sums, &[u, v, 1.0], weight * right * factor);
        }
    }

    fn add_light(&mut self, fit: &Fit, [u, v]: [f64; 2], weight: f64) {
        let places = [u * u, u * v, v * v, u, v, 1.0];
        for (sums, part) in self.light.iter_mut().zip(fit.parts) {
            add_scaled(sums, &places, weight * part);
        }
        for (sums, value) in self.light_right.iter_mut().zip(fit.values) {
            add_scaled(sums, &[u, v, 1.0], weight * value);
        }
    }

    fn part_seen(&self) -> f64 {
        let part = |i: usize| self.seen[i] / self.all[i].max(1.0);
        part(0).min(part(1))
    }

    fn add_blur(&mut self, fit: &Fit, [x, y]: [f64; 2], blur: f64, weight: f64) {
        // How the blur along a normal follows its squares.
        let row = [x * x, 2.0 * x * y, y * y].map(|part| part / (2.0 * blur));
        for (sums, factor) in self.blur.iter_mut().zip(row) {
            add_scaled(sums, &row, weight * fit.bb * factor);
        }
        add_scaled(&mut self.blur_right, &row, weight * fit.rb);
    }

    /// What is added to the map's entries.
    fn map_step(&self) -> Option<[f64; 8]> {
        const PAIR: [[usize; 3]; 3] = [[0, 1, 3], [1, 2, 4], [3, 4, 5]];
        let entry = |i: usize, j: usize| self.map[PAIR[i / 3][j / 3]][PRODUCT[i % 3][j % 3]];
        let matrix = core::array::from_fn(|i| {
            core::array::from_fn(|j| entry(i, j) * if i == j { 1.0 + 1e-9 } else { 1.0 })
        });
        solve(matrix, core::array::from_fn(|i| self.map_right[i / 3][i % 3]))
    }

    fn light(&self) -> Option<Light> {
        // 1, u, v where the map has u, v, 1.
        let turned = |i: usize| (i % 3 + 2) % 3;
        let entry = |i: usize, j: usize| self.light[i / 3 + j / 3][PRODUCT[turned(i)][turned(j)]];
        let matrix = core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)));
        solve(matrix, core::array::from_fn(|i| self.light_right[i / 3][turned(i)]))
    }
}

fn add_scaled<const N: usize>(sums: &mut [f64; N], values: &[f64; N], factor: f64) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += factor * value;
    }
}
