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

    /// How sure it is that the box about (`x`, `y`) is a face, Q.16 above 0; `None` when it is none, when the box is not wholly in
    /// the picture, or when the picture has another width than these boxes are for.
    pub fn score(&self, boxes: &mut Boxes, grey: &Grey<'_>, middle: [i32; 2]) -> Option<i32> {
        self.score_of(self.thresholds.len(), boxes, grey, middle)
    }

    /// The same as far as the first `trees` can tell.
    pub fn score_of(
        &self,
        trees: usize,
        boxes: &mut Boxes,
        grey: &Grey<'_>,
        [x, y]: [i32; 2],
    ) -> Option<i32> {
        let reach = boxes.reach;
        let inside = |at: i32, size: usize| at >= reach && at + reach <= size as i32;
        if grey.width != boxes.width || !inside(x, grey.width) || !inside(y, grey.height) {
            return None;
        }
        let middle = y as usize * grey.width + x as usize;
        let nodes = 1usize << self.depth;
        let (mut score, mut above) = (0, 0);
        let leaves = self.leaves.chunks_exact(nodes).zip(&self.thresholds);
        for (tree, (leaves, &threshold)) in leaves.enumerate().take(trees) {
            if boxes.offsets.len() == tree * nodes {
                boxes.prepare(&self.comparisons[tree * nodes..][..nodes]);
            }
            let offsets = &boxes.offsets[tree * nodes..][..nodes];
            let node = match self.depth {
                // The depth of the known model: unrolled, a fifth less work.
                6 => walk(6, &offsets[..64], grey.levels, middle),
                depth => walk(depth, offsets, grey.levels, middle),
            };
            score += leaves[node - nodes];
            above = score - threshold;
            if above <= 0 {
                return None;
            }
        }
        Some(above)
    }
}

/// From a tree's root to its leaf.
#[inline(always)]
fn walk(depth: u32, offsets: &[[i32; 2]], levels: &[u8], middle: usize) -> usize {
    let mut node = 1;
    for _ in 0..depth {
        let [a, b] =
            offsets[node].map(|offset| levels[middle.wrapping_add_signed(offset as isize)]);
        node = 2 * node + usize::from(a <= b);
    }
    node
}

/// Boxes of one size and lean in pictures of one width: where from a box's middle each comparison's pixels are. For one cascade,
/// and worked out tree by tree, as the first box comes so far; most come no farther than a few trees.
#[derive(Clone, Debug)]
pub struct Boxes {
    /// Their side, pixels.
    pub side: i32,
    /// How they lean.
    pub lean: Lean,
    width: usize,
    reach: i32,
    /// Pixels from the middle's, both of a comparison.
    offsets: Vec<[i32; 2]>,
}

impl Boxes {
    /// Of `side` pixels, 1 to 8,192 (others are brought there).
    pub fn new(grey: &Grey<'_>, side: i32, lean: Lean) -> Self {
        let side = side.clamp(1, 8192);
        Self { side, lean, width: grey.width, reach: lean.reach(side), offsets: Vec::new() }
    }

    /// The offsets of one tree more.
    #[cold]
    fn prepare(&mut self, comparisons: &[Comparison]) {
        let [cos, sin] = [self.lean.cos, self.lean.sin].map(|of| of * self.side);
        let width = self.width as i32;
        // Middles are whole pixels, so rounding down doesn't depend on them.
        let offset = |row: i8, column: i8| {
            let (r, c) = (i32::from(row), i32::from(column));
            ((c * sin + r * cos) >> 16) * width + ((c * cos - r * sin) >> 16)
        };
        self.offsets.extend(comparisons.iter().map(|&[a, b, c, d]| [offset(a, b), offset(c, d)]));
    }
}
