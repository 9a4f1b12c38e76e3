//! A detector that owns its memory.

use crate::contour::Point;
use crate::detect::{DetectError, Detection, Memory, Needed, Parameters, detect_again};
use crate::dictionary::Dictionary;
use crate::image::GreyImage;
use crate::quad::Corners;

/// [`detect_again`] with memory that grows with the pictures.
#[derive(Clone, Debug, Default)]
pub struct Detector {
    /// What is looked for and how.
    pub parameters: Parameters,
    /// Are the pictures frames of a film? Then markers that were found in one of the last eight are looked for near that place, and near
    /// where their motion would have brought them. Off at first.
    pub film: bool,
    dictionaries: Vec<Dictionary>,
    sums: Vec<u16>,
    bits: Vec<u32>,
    passed: Vec<u32>,
    halves: Vec<u8>,
    points: Vec<Point>,
    found: Vec<Detection>,
    seen: Vec<Seen>,
}

/// A marker in the last frames.
#[derive(Clone, Debug)]
struct Seen {
    last: Detection,
    /// How its corners moved in the frame in which it was found last.
    motion: Corners,
    /// Frames since then.
    age: u8,
}

/// Frames after which a lost marker is forgotten.
const FORGOTTEN: u8 = 8;

/// Markers in a picture at most.
const MOST: usize = 256;

impl Detector {
    /// A detector for markers of these dictionaries.
    pub fn new(dictionaries: &[Dictionary]) -> Self {
        let mut dictionaries = dictionaries.to_vec();
        // Those of one size share a reading when they are neighbours.
        dictionaries.sort_by_key(|dictionary| dictionary.side);
        Self { dictionaries, ..Self::default() }
    }

    /// The dictionaries, in the order that [`Detection::dictionary`] counts.
    pub fn dictionaries(&self) -> &[Dictionary] {
        &self.dictionaries
    }

    /// The markers in a picture, up to 256.
    ///
    /// # Errors
    /// [`DetectError::Size`].
    pub fn detect(&mut self, image: &GreyImage) -> Result<&[Detection], DetectError> {
        let needed = Needed::for_size(image.width(), image.height());
        if image.width().max(image.height()) > 16384 {
            return Err(DetectError::Size);
        }
        self.sums.resize(needed.sums, 0);
        self.bits.resize(needed.bits, 0);
        self.passed.resize(needed.bits, 0);
        self.halves.resize(needed.halves, 0);
        self.points.resize(needed.points, [0; 2]);
        self.found.resize(MOST, Detection::default());
        let last = if self.film { self.expected() } else { Vec::new() };
        let mut memory = Memory {
            sums: &mut self.sums,
            bits: &mut self.bits,
            passed: &mut self.passed,
            halves: &mut self.halves,
            points: &mut self.points,
        };
        let count = detect_again(
            image,
            &self.dictionaries,
            &self.parameters,
            &last,
            &mut memory,
            &mut self.found,
        )?;
        if self.film {
            self.remember(count);
        }
        Ok(&self.found[..count])
    }

    /// Where markers may be now: moved on as they moved before, and where they were.
    fn expected(&self) -> Vec<Detection> {
        let places = self.seen.iter().flat_map(|seen| {
            let moved = core::array::from_fn(|i| {
                [0, 1].map(|axis| seen.last.corners[i][axis] + seen.motion[i][axis])
            });
            // Motion that is old tells nothing.
            let on = Detection { corners: moved, ..seen.last };
            [on, seen.last]
                .into_iter()
                .skip(usize::from(seen.age > 0 || seen.motion == [[0.0; 2]; 4]))
        });
        places.collect()
    }

    fn remember(&mut self, count: usize) {
        for seen in &mut self.seen {
            seen.age += 1;
        }
        for &found in &self.found[..count] {
            let same = |seen: &&mut Seen| {
                // One that is taken already is another copy's.
                seen.age > 0 && (seen.last.dictionary, seen.last.id) == (found.dictionary, found.id)
            };
            let far = |seen: &Seen| {
                let off =
                    |i: usize, axis: usize| seen.last.corners[i][axis] - found.corners[i][axis];
                (0..8).map(|i| off(i / 2, i % 2).powi(2)).sum::<f64>()
            };
            let nearest =
                self.seen.iter_mut().filter(same).min_by(|a, b| far(a).total_cmp(&far(b)));
            let motion = |from: &Corners| {
                core::array::from_fn(|i| [0, 1].map(|axis| found.corners[i][axis] - from[i][axis]))
            };
            match nearest {
                Some(seen) => {
                    let fresh = seen.age == 1;
                    let motion = if fresh { motion(&seen.last.corners) } else { [[0.0; 2]; 4] };
                    *seen = Seen { last: found, motion, age: 0 };
                }
                None => self.seen.push(Seen { last: found, motion: [[0.0; 2]; 4], age: 0 }),
            }
        }
        self.seen.retain(|seen| seen.age < FORGOTTEN);
    }
}
