//! Where in a box about an eye is its pupil? Trees whose nodes compare two pixels vote for a step towards it, the box shrinks, and
//! so on.
//!
//! ```text
//!  stage:  step = sum of the trees' leaves (x, y; Q.16 of the box's side);  middle += step side;  side *= shrink
//!  tree:   node 1;  node = 2 node + (pixel(first) > pixel(second))
//!  pixel of a code (r, c), turned by the head's lean, rounded down and kept in the picture; middle and side in 1/256 pixel:
//!    column = (256 x + c side cos - r side sin) / 65536,   row = (256 y + c side sin + r side cos) / 65536
//! ```
//!
//! One run is right within a pixel or two. Many, each from a box that is moved and scaled a little, are run instead, and the mean of
//! the middle half along each axis taken: outliers move nothing, and the rest average out.
//!
//! Source: Markus, Frljak, Pandzic, Ahlberg, Forchheimer, "Eye pupil localization with an ensemble of randomized trees", Pattern
//! Recognition 47, 2014; the file is that of their program: stages, shrink (f32), trees a stage, depth, and each tree's comparisons
//! (four signed bytes) and leaves (two f32: down, right), little-endian. The boxes are moved along a fixed sequence
//! (Roberts' R3) instead of at random, so every run and machine finds the same.

use super::grey::Grey;
use super::lean::Lean;
use super::model::{Bytes, Comparison, ModelError};

/// The sequence's steps, 1/65536: powers of the inverse of the root of x^4 = x + 1.
const STEPS: [u32; 3] = [53_685, 43_978, 36_026];

/// How far boxes are moved, each way, and scaled, 1/256 of their side.
const REACH: [i32; 3] = [20, 20, 20];

/// Trees that together find a pupil.
#[derive(Clone, Debug)]
pub struct Localiser {
    stages: usize,
    trees: usize,
    depth: u32,
    /// Q.16.
    shrink: i32,
    comparisons: Vec<Comparison>,
    /// Down and right.
    leaves: Vec<[i32; 2]>,
}

/// A cosine or sine of Q.8 times a side, rounded down.
fn scaled(of: i32, side: i32) -> i32 {
    ((i64::from(of) * i64::from(side)) >> 8) as i32
}

/// The row and column of a code's pixel in a box about a middle (1/256 pixel), of the side times the lean's cosine and sine.
#[inline(always)]
fn place([x, y]: [i32; 2], [cos, sin]: [i32; 2], row: i8, column: i8) -> [i32; 2] {
    let (r, c) = (i32::from(row), i32::from(column));
    [(256 * y + c * sin + r * cos) >> 16, (256 * x + c * cos - r * sin) >> 16]
}

/// A square about an eye: its middle and its side, 1/256 pixel; the first pixel's centre is (128, 128).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EyeBox {
    /// Its middle: column, row.
    pub middle: [i32; 2],
    /// Its side.
    pub side: i32,
    /// Its lean.
    pub lean: Lean,
}

impl Localiser {
    /// Reads a model.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn read(bytes: &[u8]) -> Result<Self, ModelError> {
        let mut from = Bytes::new(bytes);
        let stages = from.count(16, "stages (is it a localiser of pupils?)")?;
        let shrink = from.fixed(1.0)?;
        if shrink < 6554 {
            return Err(ModelError::new("boxes that shrink below a tenth of their size"));
        }
        let trees = from.count(256, "trees a stage")?;
        let depth = from.depth()?;
        let nodes = 1usize << depth;
        from.exactly(stages * trees * (4 * (nodes - 1) + 8 * nodes))?;
        let (mut comparisons, mut leaves) = (Vec::new(), Vec::new());
        for _ in 0..stages * trees {
            from.comparisons(depth, &mut comparisons)?;
            for _ in 0..nodes {
                leaves.push([from.fixed(1.0)?, from.fixed(1.0)?]);
            }
        }
        Ok(Self { stages, trees, depth, shrink, comparisons, leaves })
    }

    /// The sum of a stage's trees: down and right.
    #[inline(always)]
    fn step<'a>(
        &self,
        trees: impl Iterator<Item = (&'a [Comparison], &'a [[i32; 2]])>,
        pixel: impl Fn(i8, i8) -> u8,
    ) -> [i64; 2] {
        let nodes = 1usize << self.depth;
        let mut step = [0i64; 2];
        for (comparisons, leaves) in trees {
            let mut node = 1;
            for _ in 0..self.depth {
                let [a, b, c, d] = comparisons[node];
                node = 2 * node + usize::from(pixel(a, b) > pixel(c, d));
            }
            let [down, right] = leaves[node - nodes];
            step = [step[0] + i64::from(down), step[1] + i64::from(right)];
        }
        step
    }

    /// The pupil in this box, 1/256 pixel, by one run.
    fn run(&self, grey: &Grey<'_>, from: EyeBox) -> [i32; 2] {
        let EyeBox { middle: [mut x, mut y], mut side, lean } = from;
        let [right, bottom] = [grey.width as i32 - 1, grey.height as i32 - 1];
        let nodes = 1usize << self.depth;
        let stage = nodes * self.trees;
        let stages = self.comparisons.chunks_exact(stage).zip(self.leaves.chunks_exact(stage));
        debug_assert_eq!(stages.len(), self.stages);
        for (comparisons, leaves) in stages {
            let turn = [scaled(lean.cos, side), scaled(lean.sin, side)];
            let trees = comparisons.chunks_exact(nodes).zip(leaves.chunks_exact(nodes));
            // Most boxes are far from the picture's edges, and clamping is a third of the work.
            let reach = 128 * (i64::from(turn[0].abs()) + i64::from(turn[1].abs())) + 65_536;
            let inside = |at: i32, last: i32| {
                let at = 256 * i64::from(at);
                at >= reach && at + reach <= 65_536 * i64::from(last)
            };
            let step = if inside(x, right) && inside(y, bottom) {
                self.step(trees, |row, column| {
                    let [row, column] = place([x, y], turn, row, column);
                    grey.levels[row as usize * grey.width + column as usize]
                })
            } else {
                self.step(trees, |row, column| {
                    let [row, column] = place([x, y], turn, row, column);
                    let (row, column) = (row.clamp(0, bottom), column.clamp(0, right));
                    grey.levels[row as usize * grey.width + column as usize]
                })
            };
            let [across, along] = lean.turned([step[1], step[0]]);
            let moved = |step: i64| ((step * i64::from(side) + (1 << 23)) >> 24) as i32;
            // Far outside there is nothing to see; kept near, nothing overflows.
            let keep = |at: i32, last: i32| at.clamp(-side, 256 * last + side);
            (x, y) = (keep(x + moved(across), right), keep(y + moved(along), bottom));
            side = ((i64::from(side) * i64::from(self.shrink)) >> 16) as i32;
        }
        [x, y]
    }

    /// The pupil in this box, 1/256 pixel: `runs` boxes about it, the mean of the middle half.
    ///
    /// A box must be smaller than the picture's larger side, and its middle in the picture; others are brought there.
    pub fn find(&self, grey: &Grey<'_>, from: EyeBox, runs: u32) -> [i32; 2] {
        let sides = [grey.width as i32 * 256, grey.height as i32 * 256];
        let side = from.side.clamp(1, sides[0].max(sides[1]));
        let middle = [0, 1].map(|i| from.middle[i].clamp(0, sides[i]));
        let runs = runs.max(1);
        let mut found = [Vec::new(), Vec::new()];
        for run in 0..runs {
            let [dx, dy, ds] = std::array::from_fn(|i| {
                let at = ((run + 1).wrapping_mul(STEPS[i]) & 0xffff) as i32 - 32_768;
                ((i64::from(at) * i64::from(REACH[i] * side)) >> 23) as i32
            });
            let middle = [middle[0] + dx, middle[1] + dy];
            let moved = EyeBox { middle, side: side + ds, lean: from.lean };
            let [x, y] = self.run(grey, moved);
            found[0].push(x);
            found[1].push(y);
        }
        found.map(|mut all| {
            all.sort_unstable();
            let quarter = all.len() / 4;
            let half = &all[quarter..all.len() - quarter];
            let sum: i64 = half.iter().map(|&x| i64::from(x)).sum();
            (sum / half.len() as i64) as i32
        })
    }
}
