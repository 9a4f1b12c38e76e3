//! A detector that owns its memory.

use crate::contour::Point;
use crate::detect::{DetectError, Detection, Memory, Needed, Parameters, detect};
use crate::dictionary::Dictionary;
use crate::image::GreyImage;

/// [`detect`] with memory that grows with the pictures.
#[derive(Clone, Debug, Default)]
pub struct Detector {
    /// What is looked for and how.
    pub parameters: Parameters,
    dictionaries: Vec<Dictionary>,
    sums: Vec<u16>,
    bits: Vec<u32>,
    passed: Vec<u32>,
    halves: Vec<u8>,
    points: Vec<Point>,
    found: Vec<Detection>,
}

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
        let mut memory = Memory {
            sums: &mut self.sums,
            bits: &mut self.bits,
            passed: &mut self.passed,
            halves: &mut self.halves,
            points: &mut self.points,
        };
        let count =
            detect(image, &self.dictionaries, &self.parameters, &mut memory, &mut self.found)?;
        Ok(&self.found[..count])
    }
}
