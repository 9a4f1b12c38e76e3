//! The detector: a grey picture to markers.
//!
//! ```text
//!  picture ---------> 1/2 ---------> 1/4 -------> 1/8  integers: threshold, contours
//!     |   .------------'|  .----------'| .---------'
//!  threshold        threshold     threshold            each from the next level's means: noise and blur that hide a marker's
//!     |                |              |                cells in the picture are averaged away in the halves
//!  contours -> quadrilaterals -> edges -> decode       floating point, only for the few quadrilaterals
//!                                           |
//!                                    pattern in the picture -> corners
//! ```
//!
//! Coarse levels go first; what is found there is not looked for again below.

use crate::contour::{Point, follow};
use crate::decode::{self, Limits, Reading};
use crate::dictionary::Dictionary;
use crate::edges;
use crate::homography::Homography;
use crate::image::{GreyImage, halve};
use crate::near::{self, Wanted};
use crate::pattern;
use crate::quad::{
    Corners, from_outline, is_plausible, is_square_in_perspective, shortest_side, twice_area,
};
use crate::threshold::{adaptive, columns, margin, words};
use libm::sqrt;

/// A marker that was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Detection {
    /// Which of the dictionaries looked for, counted from 0.
    pub dictionary: u8,
    /// Its number.
    pub id: u16,
    /// Bits that differed from its pattern.
    pub wrong: u8,
    /// The outer corners of its black border: top left, top right, bottom right, bottom left of the upright marker. Pixels, the
    /// first pixel's centre at (0.5, 0.5).
    pub corners: Corners,
    /// How well picture and pattern agree: the part of the edges' contrast that the fitted pattern explains, up to 1.
    pub agreement: f64,
    /// Standard deviation of the blur across edges, pixels.
    pub blur: f64,
}

impl Default for Detection {
    fn default() -> Self {
        let corners = [[0.0; 2]; 4];
        Self { dictionary: 0, id: 0, wrong: 0, corners, agreement: 0.0, blur: 0.0 }
    }
}

/// What the detector looks for and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// Levels of the pyramid: 1 the picture only, 3 down to a quarter. At most 3.
    pub levels: usize,
    /// How much darker than its surroundings black must be, grey levels; by the picture's noise when `None`.
    pub margin: Option<u8>,
    /// Shortest side of a marker, pixels of its level.
    pub least_side: usize,
    /// Wrong bits that are put right, at most; never more than 3/5 of what the dictionary could correct, as in OpenCV.
    pub wrong: u8,
    /// Least agreement of the cells with the pattern, 0 - 1.
    pub agreement: f64,
    /// Part of the edges' contrast that the fitted pattern must explain, 0 - 1: for a pattern without wrong bits, and for one with wrong
    /// bits or of few bits.
    pub fit: (f64, f64),
    /// What markers must have that are found near their last place.
    pub near: Wanted,
}

impl Default for Parameters {
    fn default() -> Self {
        Self {
            levels: 3,
            margin: None,
            least_side: 8,
            wrong: 3,
            agreement: 0.8,
            fit: (0.7, 0.9),
            near: Wanted { seen: 0.5, agreement: 0.9 },
        }
    }
}

/// Working memory for pictures up to a size, in the caller's hands.
#[derive(Debug)]
pub struct Memory<'m> {
    /// [`Needed::sums`] entries.
    pub sums: &'m mut [u16],
    /// [`Needed::bits`] words.
    pub bits: &'m mut [u32],
    /// [`Needed::bits`] words.
    pub passed: &'m mut [u32],
    /// [`Needed::halves`] bytes.
    pub halves: &'m mut [u8],
    /// [`Needed::points`] corners; longer outlines are left out.
    pub points: &'m mut [Point],
}

/// How much memory a picture needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Needed {
    /// Entries of [`Memory::sums`].
    pub sums: usize,
    /// Words of [`Memory::bits`] and of [`Memory::passed`].
    pub bits: usize,
    /// Bytes of [`Memory::halves`].
    pub halves: usize,
    /// Entries of [`Memory::points`], enough for a marker that fills the picture.
    pub points: usize,
}

impl Needed {
    /// For pictures of `width` x `height` pixels.
    pub const fn for_size(width: usize, height: usize) -> Self {
        Self {
            sums: columns(width),
            bits: words(width) * height,
            halves: (width / 2) * (height / 2)
                + (width / 4) * (height / 4)
                + (width / 8) * (height / 8),
            points: 3 * (width + height),
        }
    }

    /// In bytes, all together.
    pub const fn bytes(&self) -> usize {
        self.sums * 2 + self.bits * 8 + self.halves + self.points * size_of::<Point>()
    }
}

/// Why a picture could not be searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DetectError {
    /// The memory is too small for the picture.
    Memory(Needed),
    /// A side of the picture is longer than 16,384 pixels.
    Size,
}

impl core::fmt::Display for DetectError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Memory(needed) => write!(
                f,
                "the detector's memory is too small for the picture: it needs {} bytes, see Needed::for_size",
                needed.bytes()
            ),
            Self::Size => f.write_str("the picture is larger than 16384 pixels; make it smaller"),
        }
    }
}

impl core::error::Error for DetectError {}

/// Finds markers of `dictionaries` in a picture and writes them to `found`; returns how many. Those that don't fit are left out.
///
/// Markers are dark on light paper; the paper must be seen all around, half a cell wide. A marker with a covered corner is not
/// found; in a film, see [`detect_again`].
///
/// # Errors
/// [`DetectError`].
pub fn detect(
    image: &GreyImage,
    dictionaries: &[Dictionary],
    parameters: &Parameters,
    memory: &mut Memory,
    found: &mut [Detection],
) -> Result<usize, DetectError> {
    detect_again(image, dictionaries, parameters, &[], memory, found)
}

/// [`detect`] in the next frame of a film: markers of `last` that aren't found by their outlines are looked for up to four cells from
/// where they were, and are found with a corner or a third covered, or smeared. Those that are found by their outlines are what
/// [`detect`] finds.
///
/// `last` holds what was found in the last frame, by the same dictionaries, or where it is expected to be now; there may be several places
/// for a marker, the likeliest first.
///
/// # Errors
/// [`DetectError`].
pub fn detect_again(
    image: &GreyImage,
    dictionaries: &[Dictionary],
    parameters: &Parameters,
    last: &[Detection],
    memory: &mut Memory,
    found: &mut [Detection],
) -> Result<usize, DetectError> {
    let (width, height) = (image.width(), image.height());
    if width.max(height) > 16384 {
        return Err(DetectError::Size);
    }
    let needed = Needed::for_size(width, height);
    let enough = memory.sums.len() >= needed.sums
        && memory.bits.len() >= needed.bits
        && memory.passed.len() >= needed.bits
        && memory.halves.len() >= needed.halves;
    if !enough {
        return Err(DetectError::Memory(needed));
    }
    // Each level's threshold comes from the next one.
    let mut halves = &mut memory.halves[..needed.halves];
    let mut levels = [*image; 4];
    for level in 1..4 {
        let (width, height) = (width >> level, height >> level);
        let (half, rest) = halves.split_at_mut(width * height);
        halve(&levels[level - 1], half);
        levels[level] = GreyImage::new(width, height, width, half).unwrap_or(*image);
        halves = rest;
    }
    let mut search = Search { levels, dictionaries, parameters, found, count: 0 };
    for level in (0..parameters.levels.clamp(1, 3)).rev() {
        let image = levels[level];
        let size = (image.width(), image.height());
        let bits = &mut memory.bits[..words(size.0) * size.1];
        let margin = parameters.margin.unwrap_or_else(|| margin(&image));
        // A window of 10 pixels finds the outlines of small markers, one of 18 those of blurred ones.
        let adaptive = if level == 0 { adaptive::<2> } else { adaptive::<4> };
        adaptive(&image, &levels[level + 1], margin, memory.sums, bits);
        follow(bits, size, memory.passed, memory.points, |outline, points| {
            if is_plausible(&outline, parameters.least_side)
                && let Some(corners) = from_outline(&outline, points)
            {
                search.quadrilateral(level, &corners);
            }
        });
    }
    last.iter().for_each(|last| search.near(last));
    Ok(search.count)
}

struct Search<'a> {
    /// The picture and its halves.
    levels: [GreyImage<'a>; 4],
    dictionaries: &'a [Dictionary],
    parameters: &'a Parameters,
    found: &'a mut [Detection],
    count: usize,
}

impl Search<'_> {
    fn quadrilateral(&mut self, level: usize, corners: &Corners) {
        let scale = f64::from(1u32 << level);
        if self.is_known(&corners.map(|corner| corner.map(|x| x * scale))) {
            return;
        }
        let image = &self.levels[level];
        if !is_square_in_perspective(corners, image.width().max(image.height()), 2.0) {
            return;
        }
        let fine = edges::refine(&self.levels[level], corners).unwrap_or(*corners);
        let full = fine.map(|corner| corner.map(|x| x * scale));
        let Some((mut detection, reading)) = self.decode(level, &fine).or_else(|| {
            // Cells too small for this level may be read in the picture itself.
            if level > 0 { self.decode(0, &full) } else { None }
        }) else {
            return;
        };
        // Top left first: the marker's own first corner stands where the turns brought it.
        let turns = usize::from(detection.1);
        detection.0.corners = core::array::from_fn(|i| full[(i + turns) % 4]);
        let dictionary = &self.dictionaries[usize::from(detection.0.dictionary)];
        let Some(code) = dictionary.code(detection.0.id.into()) else { return };
        let fitted = pattern::refine(
            &self.levels[0],
            dictionary,
            code,
            &detection.0.corners,
            (reading.black, reading.white),
        );
        let Some(fitted) = fitted else { return };
        // Wrong bits and patterns of few bits ask for a clearer picture in return.
        let sure = detection.0.wrong == 0 && dictionary.bits_to_spare() >= 14;
        let least = if sure { self.parameters.fit.0 } else { self.parameters.fit.1 };
        let width = self.levels[0].width().max(self.levels[0].height());
        if fitted.agreement < least || !is_square_in_perspective(&fitted.corners, width, 0.7) {
            return;
        }
        detection.0.corners = fitted.corners;
        detection.0.agreement = fitted.agreement;
        detection.0.blur = fitted.blur;
        self.add(detection.0);
    }

    /// Looks for a marker where it was, unless it was found within a side of that.
    fn near(&mut self, last: &Detection) {
        let Some(dictionary) = self.dictionaries.get(usize::from(last.dictionary)) else { return };
        let Some(code) = dictionary.code(last.id.into()) else { return };
        let close = |known: &&Detection| {
            let far = distance(&known.corners, &last.corners);
            known.dictionary == last.dictionary
                && known.id == last.id
                && far < sqrt(twice_area(&last.corners).max(0.0) / 2.0)
        };
        if self.found[..self.count].iter().any(|known| close(&known)) {
            return;
        }
        let wanted = &self.parameters.near;
        if let Some(fitted) = near::find(&self.levels, dictionary, code, &last.corners, wanted) {
            let (corners, agreement) = (fitted.corners, fitted.agreement);
            // Another lies there.
            if self.is_known(&corners) {
                return;
            }
            self.add(Detection { corners, agreement, blur: fitted.blur, wrong: 0, ..*last });
        }
    }

    /// The best reading in any dictionary, and its turns.
    fn decode(&self, level: usize, corners: &Corners) -> Option<((Detection, u8), Reading)> {
        let mut best: Option<((Detection, u8), Reading)> = None;
        let mut read: Option<(u8, Option<Reading>)> = None;
        for (index, dictionary) in self.dictionaries.iter().enumerate() {
            let side = dictionary.side;
            // Dictionaries of one size share a reading.
            let reading = match read {
                Some((known, reading)) if known == side => reading,
                _ => {
                    let new = self.read(level, corners, side);
                    read = Some((side, new));
                    new
                }
            };
            let Some(reading) = reading else { continue };
            let tolerated = self.parameters.wrong.min(dictionary.correctable * 3 / 5);
            let Some((found, agreement)) = reading.find(dictionary, tolerated) else { continue };
            let better = best.as_ref().is_none_or(|best| agreement > best.0.0.agreement);
            if agreement >= self.parameters.agreement && better {
                let detection = Detection {
                    dictionary: index as u8,
                    id: found.id,
                    wrong: found.wrong,
                    agreement,
                    ..Detection::default()
                };
                best = Some(((detection, found.turns), reading));
            }
        }
        best
    }

    /// Reads cells where a sample is a good part of one: on a coarser level where they are large.
    fn read(&self, mut level: usize, corners: &Corners, side: u8) -> Option<Reading> {
        let mut cell = shortest_side(corners) / f64::from(side + 2);
        let mut corners = *corners;
        while cell >= LARGE && level + 1 < self.levels.len() {
            (level, cell) = (level + 1, cell / 2.0);
            corners = corners.map(|corner| corner.map(|x| x / 2.0));
        }
        let map = Homography::from_unit_square(&corners)?;
        decode::read(&self.levels[level], &map, side.into(), &Limits::default())
    }

    /// Is this the outline of a marker that was found already?
    fn is_known(&self, corners: &Corners) -> bool {
        self.found[..self.count].iter().any(|known| same_place(&known.corners, corners))
    }

    fn add(&mut self, detection: Detection) {
        let twin = self.found[..self.count].iter_mut().find(|known| {
            known.dictionary == detection.dictionary
                && known.id == detection.id
                && same_place(&known.corners, &detection.corners)
        });
        if let Some(twin) = twin {
            if detection.agreement > twin.agreement {
                *twin = detection;
            }
        } else if let Some(to) = self.found.get_mut(self.count) {
            *to = detection;
            self.count += 1;
        }
    }
}

/// Cells of as many pixels are read on the next coarser level.
const LARGE: f64 = 6.0;

/// Do two quadrilaterals cover nearly the same place: middles closer than a quarter of a side, areas within a factor of 2?
fn same_place(a: &Corners, b: &Corners) -> bool {
    let (p, q) = (twice_area(a), twice_area(b));
    distance(a, b) < 0.25 * sqrt(p / 2.0) && p < 2.0 * q && q < 2.0 * p
}

/// From middle to middle.
fn distance(a: &Corners, b: &Corners) -> f64 {
    let middle =
        |corners: &Corners, axis: usize| corners.iter().map(|c| c[axis]).sum::<f64>() / 4.0;
    let (dx, dy) = (middle(a, 0) - middle(b, 0), middle(a, 1) - middle(b, 1));
    sqrt(dx * dx + dy * dy)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec;
    use std::vec::Vec;

    fn search(image: &GreyImage, dictionary: Dictionary) -> Vec<Detection> {
        search_again(image, dictionary, &[])
    }

    /// Detects in memory of exactly the size that is asked for.
    fn search_again(
        image: &GreyImage,
        dictionary: Dictionary,
        last: &[Detection],
    ) -> Vec<Detection> {
        let needed = Needed::for_size(image.width(), image.height());
        let mut memory = Memory {
            sums: &mut vec![7; needed.sums],
            bits: &mut vec![7; needed.bits],
            passed: &mut vec![7; needed.bits],
            halves: &mut vec![7; needed.halves],
            points: &mut vec![[7; 2]; needed.points],
        };
        let mut found = [Detection::default(); 4];
        let (all, parameters) = ([dictionary], Parameters::default());
        let count = detect_again(image, &all, &parameters, last, &mut memory, &mut found).unwrap();
        found[..count].to_vec()
    }

    /// Marker 23 of a dictionary on grey: `cell` pixels a cell, its border's corner at `at`.
    fn drawn(dictionary: &Dictionary, cell: usize, at: usize) -> Vec<u8> {
        let code = dictionary.code(23).unwrap();
        let side = usize::from(dictionary.side) + 2;
        (0..320 * 240)
            .map(|i| {
                let place = |p: usize| (p + cell).checked_sub(at).map(|p| p / cell);
                match (place(i % 320), place(i / 320)) {
                    (Some(c), Some(r)) if c < side + 2 && r < side + 2 => {
                        let inside = (1..=side).contains(&c) && (1..=side).contains(&r);
                        let white = !inside || dictionary.is_white(code, c - 1, r - 1);
                        if white { 220 } else { 30 }
                    }
                    _ => 120,
                }
            })
            .collect()
    }

    #[test]
    fn corners_lie_where_the_marker_was_drawn() {
        for dictionary in Dictionary::ALL {
            for cell in [4, 9, 20] {
                let pixels = drawn(dictionary, cell, 40);
                let found = search(&GreyImage::new(320, 240, 320, &pixels).unwrap(), *dictionary);
                assert_eq!(found.len(), 1, "{} {cell}", dictionary.name);
                assert_eq!(found[0].id, 23);
                let far = 40.0 + (cell * (usize::from(dictionary.side) + 2)) as f64;
                let want = [[40.0, 40.0], [far, 40.0], [far, far], [40.0, far]];
                for (got, want) in found[0].corners.as_flattened().iter().zip(want.as_flattened()) {
                    assert!((got - want).abs() < 0.05, "{} {cell}: {found:?}", dictionary.name);
                }
            }
        }
    }

    #[test]
    fn tiny_and_empty_pictures_hold_nothing() {
        for (width, height) in [(0, 0), (1, 1), (2, 7), (3, 3), (5, 1), (31, 33)] {
            let pixels = vec![128; width * height];
            let image = GreyImage::new(width, height, width, &pixels).unwrap();
            assert_eq!(search(&image, Dictionary::ARUCO_4X4_50), []);
        }
    }

    #[test]
    fn a_covered_corner_does_not_lose_a_marker() {
        for dictionary in [Dictionary::ARUCO_4X4_50, Dictionary::APRILTAG_36H11] {
            let cell = 9;
            let before = drawn(&dictionary, cell, 40);
            let last = search(&GreyImage::new(320, 240, 320, &before).unwrap(), dictionary);
            // Moved by two cells and a half, and a finger of two cells over its first corner.
            let mut pixels = drawn(&dictionary, cell, 62);
            let image = GreyImage::new(320, 240, 320, &pixels).unwrap();
            let whole = search(&image, dictionary);
            assert_eq!(search_again(&image, dictionary, &last), whole, "as without the last frame");
            for (x, y) in (50..80).flat_map(|y| (50..80).map(move |x| (x, y))) {
                pixels[y * 320 + x] = 150;
            }
            let image = GreyImage::new(320, 240, 320, &pixels).unwrap();
            assert_eq!(search(&image, dictionary), [], "{}", dictionary.name);
            let found = search_again(&image, dictionary, &last);
            assert_eq!((found.len(), found[0].id), (1, 23), "{}", dictionary.name);
            let pairs = found[0].corners.as_flattened().iter().zip(whole[0].corners.as_flattened());
            for (got, want) in pairs {
                assert!((got - want).abs() < 0.1, "{}: {found:?}", dictionary.name);
            }
        }
    }

    #[test]
    fn a_marker_that_is_gone_is_not_found_again() {
        let dictionary = Dictionary::ARUCO_4X4_50;
        let marker = drawn(&dictionary, 9, 40);
        let last = search(&GreyImage::new(320, 240, 320, &marker).unwrap(), dictionary);
        let mut seed = 3u32;
        let noise: Vec<u8> = (0..320 * 240)
            .map(|_| {
                seed = seed.wrapping_mul(1664525).wrapping_add(1013904223);
                (seed >> 24) as u8
            })
            .collect();
        // Another one in its place.
        let other = drawn(&Dictionary::APRILTAG_36H11, 7, 40);
        let even = vec![128; 320 * 240];
        for pixels in [noise, other, even] {
            let image = GreyImage::new(320, 240, 320, &pixels).unwrap();
            assert_eq!(search_again(&image, dictionary, &last), []);
        }
        // Places that make no sense.
        let image = GreyImage::new(320, 240, 320, &marker).unwrap();
        for corners in [[[f64::NAN; 2]; 4], [[1e300; 2]; 4], [[5.0; 2]; 4]] {
            for (dictionary_number, id) in [(0, 23), (0, 60_000), (200, 23)] {
                let last = [Detection { dictionary: dictionary_number, id, corners, ..last[0] }];
                assert_eq!(search_again(&image, dictionary, &last).len(), 1);
            }
        }
    }

    #[test]
    fn memory_is_stated_and_too_little_is_told() {
        let needed = Needed::for_size(320, 240);
        assert_eq!(needed.bytes(), 51_468);
        let image = GreyImage::new(320, 240, 320, &[0; 320 * 240]).unwrap();
        let mut memory = Memory {
            sums: &mut [0; 1],
            bits: &mut [],
            passed: &mut [],
            halves: &mut [],
            points: &mut [],
        };
        let all = [Dictionary::ARUCO_4X4_50];
        let got = detect(&image, &all, &Parameters::default(), &mut memory, &mut []);
        assert_eq!(got, Err(DetectError::Memory(needed)));
        assert!(std::format!("{}", got.unwrap_err()).contains("51468 bytes"));
    }
}
