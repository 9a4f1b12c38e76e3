//! Is this box a face? A cascade of trees whose nodes compare two pixels.
//!
//! ```text
//!  tree:     node 1;  node = 2 node + (pixel(first) <= pixel(second));  after `depth` steps a leaf, Q.16
//!  cascade:  score += leaf;  at or below the tree's threshold: no face
//!  pixel of a code (r, c) in a box of `side` about a middle, turned by a head's lean, Q.8, rounded down:
//!    column = (65536 x + c side cos - r side sin) / 65536,   row = (65536 y + c side sin + r side cos) / 65536
//! ```
//!
//! Nothing is computed from grey levels, they are only compared, so brightness and contrast change nothing.
//!
//! Source: Markus, Frljak, Pandzic, Ahlberg, Forchheimer, "Object detection with pixel intensity comparisons organized in
//! decision trees", 2013; the file is that of their program: version (3), four bytes that tell the box's shape, depth, number of
//! trees, and each tree's comparisons (four signed bytes), leaves (f32) and threshold (f32), little-endian. Leaves and thresholds
//! are rounded to Q.16 here, so every machine finds the same.

use super::grey::Grey;
use super::lean::Lean;
use super::model::{Bytes, Comparison, ModelError};

/// The version of the file.
const VERSION: i32 = 3;

/// Trees that together tell faces.
#[derive(Clone, Debug)]
pub struct Cascade {
    depth: u32,
    comparisons: Vec<Comparison>,
    leaves: Vec<i32>,
    thresholds: Vec<i32>,
}

impl Cascade {
    /// Reads a model.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(bytes: &[u8]) -> Result<Self, ModelError> {
        let mut from = Bytes::new(bytes);
        let version = from.int()?;
        if version != VERSION {
            return Err(ModelError::new(format_args!(
                "no cascade of faces: it begins with {version} instead of {VERSION}"
            )));
        }
        from.int()?; // the box's shape: always a square
        let (depth, trees) = (from.depth()?, from.trees()?);
        let nodes = 1usize << depth;
        from.exactly(trees * (4 * (nodes - 1) + 4 * nodes + 4))?;
        let mut cascade =
            Self { depth, comparisons: Vec::new(), leaves: Vec::new(), thresholds: Vec::new() };
        for _ in 0..trees {
            from.comparisons(depth, &mut cascade.comparisons)?;
            for _ in 0..nodes {
                cascade.leaves.push(from.fixed(7.0)?);
            }
            cascade.thresholds.push(from.fixed(32_767.0)?);
        }
        Ok(cascade)
    }

    /// How sure it is that the box of `side` pixels about (`x`, `y`), which leans so, is a face, Q.16 above 0; `None` when it is
    /// none, or when the box is not wholly in the picture.
    pub fn score(&self, grey: &Grey<'_>, [x, y]: [i32; 2], side: i32, lean: Lean) -> Option<i32> {
        if !(1..=8192).contains(&side) {
            return None;
        }
        let (cos, sin) = (lean.cos * side, lean.sin * side);
        let reach = lean.reach(side);
        let inside = |at: i32, size: usize| at >= reach && at + reach <= size as i32;
        if !inside(x, grey.width) || !inside(y, grey.height) {
            return None;
        }
        let pixel = |row: i8, column: i8| {
            let (r, c) = (i32::from(row), i32::from(column));
            let row = (65_536 * y + c * sin + r * cos) >> 16;
            let column = (65_536 * x + c * cos - r * sin) >> 16;
            grey.levels[row as usize * grey.width + column as usize]
        };
        let nodes = 1usize << self.depth;
        let trees = self.comparisons.chunks_exact(nodes).zip(self.leaves.chunks_exact(nodes));
        let mut score = 0;
        for ((comparisons, leaves), &threshold) in trees.zip(&self.thresholds) {
            let mut node = 1;
            for _ in 0..self.depth {
                let [a, b, c, d] = comparisons[node];
                node = 2 * node + usize::from(pixel(a, b) <= pixel(c, d));
            }
            score += leaves[node - nodes];
            if score <= threshold {
                return None;
            }
        }
        let last = self.thresholds.last().copied().unwrap_or(0);
        Some(score - last)
    }
}
