//! The pattern inside a quadrilateral.
//!
//! Each cell is sampled in its middle, the border and a ring of the light paper around it too. Border and ring give the level of black
//! and of white as a plane each, so that light may fall unevenly:
//!
//! ```text
//!  threshold(u, v) = (black(u, v) + white(u, v)) / 2
//!  sharpened value = value + 1/4 (4 value - sum of its four neighbours)
//! ```
//!
//! Sharpening takes back what blur mixes from neighbouring cells. Source: AprilTag 2 (Wang and Olson, 2016).

use crate::dictionary::{Dictionary, Match};
use crate::homography::Homography;
use crate::image::GreyImage;

/// Cells in a row at most: 6, the border and the paper on both sides.
const MOST: usize = 10;

/// What was read inside a quadrilateral.
#[derive(Clone, Copy, Debug)]
pub struct Reading {
    /// The pattern, as [`Dictionary::code`] gives it, in the orientation in which it was seen.
    pub code: u64,
    /// Mean level of black, 0 - 255.
    pub black: f64,
    /// Mean level of white.
    pub white: f64,
    /// How clear the cells are: the mean distance from the threshold, 1 = as black and white as border and paper.
    pub clarity: f64,
    margins: [[f32; 6]; 6],
    side: u8,
}

/// What a quadrilateral must have to be read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// White minus black at least, grey levels.
    pub contrast: f64,
    /// Part of the border's cells that may be light, 0 - 1.
    pub border: f64,
    /// Part of the paper's cells that may be dark, 0 - 1.
    pub paper: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { contrast: 10.0, border: 0.2, paper: 0.35 }
    }
}

/// Level of black or white: a plane over the marker.
#[derive(Clone, Copy, Debug, Default)]
struct Plane {
    mean: f64,
    across: f64,
    down: f64,
    spread: f64,
    count: f64,
}

impl Plane {
    /// A value at a place of a ring around the middle; a ring is symmetrical, so the sums need no cross terms.
    fn add(&mut self, u: f64, v: f64, value: f64) {
        self.mean += value;
        self.across += u * value;
        self.down += v * value;
        self.spread += u * u;
        self.count += 1.0;
    }

    fn solved(mut self) -> Self {
        self.mean /= self.count;
        self.across /= self.spread;
        self.down /= self.spread;
        self
    }

    fn at(&self, u: f64, v: f64) -> f64 {
        self.mean + self.across * u + self.down * v
    }
}

/// Reads the cells of a marker with `side` x `side` cells; `map` goes from the unit square to the picture. Cells should be 2 to 6 pixels
/// wide: a sample is a mean of 2 x 2.
pub fn read(image: &GreyImage, map: &Homography, side: usize, limits: &Limits) -> Option<Reading> {
    // Cells with border and paper.
    let all = side + 4;
    let map = map.over_side((side + 2) as f64);
    if !looks_framed(image, &map, side, limits) {
        return None;
    }
    let mut cells = [[0.0f64; MOST]; MOST];
    for (row, line) in cells[..all].iter_mut().enumerate() {
        for (column, cell) in line[..all].iter_mut().enumerate() {
            // The paper only next to the border: there may not be more of it.
            let place = |index: usize| match index {
                0 => -0.4,
                _ if index == all - 1 => (side + 2) as f64 + 0.4,
                _ => index as f64 - 0.5,
            };
            let [x, y] = map.map(place(column), place(row));
            *cell = image.sample(x, y);
        }
    }
    let middle = (all - 1) as f64 / 2.0;
    let ring = |column: usize, row: usize| column.min(row).min(all - 1 - column).min(all - 1 - row);
    let places = || (0..all).flat_map(|row| (0..all).map(move |column| (column, row)));
    let (mut black, mut white) = (Plane::default(), Plane::default());
    for (column, row) in places() {
        let (u, v) = (column as f64 - middle, row as f64 - middle);
        match ring(column, row) {
            0 => white.add(u, v, cells[row][column]),
            1 => black.add(u, v, cells[row][column]),
            _ => {}
        }
    }
    let (black, white) = (black.solved(), white.solved());
    if white.mean - black.mean < limits.contrast {
        return None;
    }
    let threshold = |column: usize, row: usize| {
        let (u, v) = (column as f64 - middle, row as f64 - middle);
        (black.at(u, v) + white.at(u, v)) / 2.0
    };
    let (mut light_border, mut dark_paper) = (0, 0);
    for (column, row) in places() {
        let light = cells[row][column] > threshold(column, row);
        match ring(column, row) {
            0 => dark_paper += usize::from(!light),
            1 => light_border += usize::from(light),
            _ => {}
        }
    }
    let (border, paper) = ((4 * (side + 1)) as f64, (4 * (side + 3)) as f64);
    if light_border as f64 > limits.border * border || dark_paper as f64 > limits.paper * paper {
        return None;
    }
    let half = (white.mean - black.mean) / 2.0;
    let mut reading = Reading {
        code: 0,
        black: black.mean,
        white: white.mean,
        clarity: 0.0,
        margins: [[0.0; 6]; 6],
        side: side as u8,
    };
    for row in 0..side {
        for column in 0..side {
            let (c, r) = (column + 2, row + 2);
            let value = cells[r][c];
            let around = cells[r - 1][c] + cells[r + 1][c] + cells[r][c - 1] + cells[r][c + 1];
            let sharp = value + (4.0 * value - around) / 4.0;
            let margin = ((sharp - threshold(c, r)) / half).clamp(-1.5, 1.5);
            reading.code = reading.code << 1 | u64::from(margin > 0.0);
            reading.clarity += margin.abs() / (side * side) as f64;
            reading.margins[row][column] = margin as f32;
        }
    }
    Some(reading)
}

/// A first look at few samples: is the border mostly darker than the paper beside it, in three of five places?
fn looks_framed(image: &GreyImage, map: &Homography, side: usize, limits: &Limits) -> bool {
    let cells = side + 2;
    let end = cells as f64;
    // In two of five places it may be lighter.
    let most = 4 * cells * 2 / 5;
    let mut light = 0;
    for i in 0..cells {
        let along = i as f64 + 0.5;
        for (border, paper) in [
            ([along, 0.5], [along, -0.4]),
            ([along, end - 0.5], [along, end + 0.4]),
            ([0.5, along], [-0.4, along]),
            ([end - 0.5, along], [end + 0.4, along]),
        ] {
            let at = |[u, v]: [f64; 2]| {
                let [x, y] = map.map(u, v);
                image.sample(x, y)
            };
            light += usize::from(at(paper) - at(border) <= limits.contrast / 2.0);
            if light > most {
                return false;
            }
        }
    }
    true
}

impl Reading {
    /// The marker of a dictionary that this is, with at most `tolerated` wrong bits, and how well it agrees: the correlation of the
    /// cells' distances from the threshold with the pattern, 1 = in every cell.
    pub fn find(&self, dictionary: &Dictionary, tolerated: u8) -> Option<(Match, f64)> {
        let found = dictionary.nearest(self.code, tolerated)?;
        let side = usize::from(self.side);
        let code = dictionary.code(found.id.into())?;
        let (mut agreement, mut sum) = (0.0, 0.0);
        for row in 0..side {
            for column in 0..side {
                let (c, r) = upright(column, row, side, found.turns);
                let margin = f64::from(self.margins[row][column]);
                let white = dictionary.is_white(code, c + 1, r + 1);
                agreement += if white { margin } else { -margin };
                sum += margin.abs();
            }
        }
        Some((found, agreement / sum.max(1e-9)))
    }
}

/// Where the cell seen at (column, row) stands in the upright marker, after `turns` clockwise quarter turns of it.
fn upright(column: usize, row: usize, side: usize, turns: u8) -> (usize, usize) {
    (0..turns).fold((column, row), |(column, row), _| (row, side - 1 - column))
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec;

    #[test]
    fn reads_a_drawn_marker_in_every_orientation() {
        for dictionary in
            [Dictionary::ARUCO_4X4_50, Dictionary::ARUCO_ORIGINAL, Dictionary::APRILTAG_36H11]
        {
            let side = usize::from(dictionary.side);
            let all = side + 4;
            let (id, scale) = (23, 4);
            let code = dictionary.code(id).unwrap();
            let width = all * scale;
            let mut pixels = vec![0; width * width];
            for (i, pixel) in pixels.iter_mut().enumerate() {
                let (c, r) = (i % width / scale, i / width / scale);
                let inside = (1..all - 1).contains(&c) && (1..all - 1).contains(&r);
                let white = !inside || dictionary.is_white(code, c - 1, r - 1);
                // Light that falls unevenly: twice as much at the right edge.
                let full = if white { 100 } else { 15 };
                *pixel = (full * (width + i % width) / width) as u8;
            }
            let image = GreyImage::new(width, width, width, &pixels).unwrap();
            let (a, b) = (scale as f64, (scale * (all - 1)) as f64);
            let corners = [[a, a], [b, a], [b, b], [a, b]];
            for turns in 0..4usize {
                // The quadrilateral begins at another corner: as if the marker were turned the other way.
                let turned = core::array::from_fn(|i| corners[(i + 4 - turns) % 4]);
                let map = Homography::from_unit_square(&turned).unwrap();
                let reading = read(&image, &map, side, &Limits::default()).unwrap();
                let (found, agreement) = reading.find(&dictionary, 0).unwrap();
                assert_eq!((usize::from(found.id), usize::from(found.turns)), (id, turns));
                assert!(agreement > 0.999);
            }
        }
    }
}
