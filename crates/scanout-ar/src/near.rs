//! A known marker near a known place, without its outline: in a film, where it was in the last frame.
//!
//! Its outline may be torn - by a finger on a corner, by motion that smears its cells - when its pattern can still be recognised,
//! since it is known which one it must be:
//!
//! ```text
//!  last corners -> moved to where cells and pattern correlate best -> pattern fitted on that level -> pattern fitted in the picture
//!                  (on the level on which cells are 2 to 4 pixels)
//! ```
//!
//! What comes out must explain the picture as well as a marker found by its outline, where half of its border's edges and half of those
//! inside are seen, which no other marker in its place has.

use crate::dictionary::Dictionary;
use crate::homography::Homography;
use crate::image::GreyImage;
use crate::pattern::{self, Fitted};
use crate::quad::{Corners, is_square_in_perspective, shortest_side, twice_area};
use libm::sqrt;

/// Cells of a marker in a row at most, with border and paper.
const MOST: usize = 10;
/// How far away it is looked for, cells.
const REACH: f64 = 4.0;
/// Steps between places, pixels of the level: half of what the fit takes in.
const STEP: f64 = 1.5;
/// Correlation of cells and pattern, at least.
const LEAST: f64 = 0.35;

/// What a marker that was found this way must have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// Part of its border's edges that must be seen, and of those inside, 0 - 1.
    pub seen: f64,
    /// Part of their contrast that the fitted pattern must explain, 0 - 1.
    pub agreement: f64,
}

/// Fits marker `code` to the picture near `corners`; `levels` are the picture and its halves. `None` when it isn't there.
pub fn find(
    levels: &[GreyImage],
    dictionary: &Dictionary,
    code: u64,
    corners: &Corners,
    wanted: &Wanted,
) -> Option<Fitted> {
    if !corners.as_flattened().iter().all(|x| x.is_finite()) || twice_area(corners) <= 0.0 {
        return None;
    }
    let mut cell = shortest_side(corners) / f64::from(dictionary.side + 2);
    let mut level = 0;
    while cell >= 4.0 && level + 1 < levels.len() {
        (level, cell) = (level + 1, cell / 2.0);
    }
    let scale = f64::from(1u32 << level);
    let small = corners.map(|corner| corner.map(|x| x / scale));
    let (moved, light) = best_place(&levels[level], dictionary, code, &small, cell)?;
    let full = |corners: Corners| corners.map(|corner| corner.map(|x| x * scale));
    // The picture itself takes in less.
    let start = if level == 0 {
        moved
    } else {
        pattern::refine(&levels[level], dictionary, code, &moved, light)?.corners
    };
    let fitted = pattern::refine(levels.first()?, dictionary, code, &full(start), light)?;
    let width = levels[0].width().max(levels[0].height());
    let area = twice_area(&fitted.corners) / twice_area(corners);
    let good = fitted.seen >= wanted.seen
        && fitted.agreement_seen >= wanted.agreement
        && (0.5..2.0).contains(&area)
        && is_square_in_perspective(&fitted.corners, width, 0.7);
    good.then_some(fitted)
}

/// The corners moved to where cells and pattern correlate best, and the levels of black and white there.
fn best_place(
    image: &GreyImage,
    dictionary: &Dictionary,
    code: u64,
    corners: &Corners,
    cell: f64,
) -> Option<(Corners, (f64, f64))> {
    let side = usize::from(dictionary.side);
    let all = side + 4;
    let map = Homography::from_unit_square(corners)?.over_side((side + 2) as f64);
    let (mut places, mut white) = ([[0.0; 2]; MOST * MOST], [false; MOST * MOST]);
    for i in 0..all * all {
        let (row, column) = (i / all, i % all);
        places[i] = map.map(column as f64 - 0.5, row as f64 - 0.5);
        let inside = (1..all - 1).contains(&row) && (1..all - 1).contains(&column);
        white[i] = !inside || dictionary.is_white(code, column - 1, row - 1);
    }
    let (places, white) = (&places[..all * all], &white[..all * all]);
    let steps = (REACH * cell / STEP) as i32;
    let mut best = (LEAST, [0.0; 2], (0.0, 0.0));
    for step in 0..(2 * steps + 1) * (2 * steps + 1) {
        let place = |i: i32| f64::from(i - steps) * STEP;
        let by = [place(step % (2 * steps + 1)), place(step / (2 * steps + 1))];
        let (correlation, light) = correlation(image, places, white, by);
        if correlation > best.0 {
            best = (correlation, by, light);
        }
    }
    let (found, by, light) = best;
    let moved = corners.map(|[x, y]| [x + by[0], y + by[1]]);
    (found > LEAST).then_some((moved, light))
}

/// Correlation of samples with white and black, and the means of the black and of the white ones.
fn correlation(
    image: &GreyImage,
    places: &[[f64; 2]],
    white: &[bool],
    [dx, dy]: [f64; 2],
) -> (f64, (f64, f64)) {
    let (mut sums, mut counts, mut squares) = ([0.0; 2], [0.0; 2], 0.0);
    for (&[x, y], &white) in places.iter().zip(white) {
        let value = image.sample(x + dx, y + dy);
        sums[usize::from(white)] += value;
        counts[usize::from(white)] += 1.0;
        squares += value * value;
    }
    let all = counts[0] + counts[1];
    let mean = (sums[0] + sums[1]) / all;
    let (black, white) = (sums[0] / counts[0], sums[1] / counts[1]);
    let spread = sqrt((squares / all - mean * mean).max(1e-9));
    // Of a quantity with one of two values: the difference of the means times the deviation of those values.
    ((white - black) * sqrt(counts[0] * counts[1]) / (all * spread), (black, white))
}
