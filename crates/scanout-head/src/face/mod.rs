//! A face and the pupils of its eyes in a grey picture: integers and comparisons only.
//!
//! ```text
//!  picture -> halved until 480 wide -> boxes -> cascade -> face -> two eye boxes -> localiser -> pupils, from them once more
//!                                               \__ near the face of the picture before, if there was one __/
//!
//!     +-----------------------+      the face's box, side s
//!     |      .175  .175       |
//!     |     <-----|----->     |
//!     |   (o)     |     (o)   |  -   eyes: .075 s above the middle; their boxes: .35 s
//!     |- - - - - -+- - - - - -|
//!     |                       |
//!     +-----------------------+
//! ```
//!
//! The models are files of other people (see README.md); this reads them and does what they say.
//!
//! Boxes lean with the head: at first upright or 25 degrees to a side, then as the eyes did.
//!
//! What it will not do: tell people apart, follow more than one, see faces from the side.

pub mod cascade;
mod grey;
mod lean;
pub mod model;
pub mod pupil;
mod search;

pub use cascade::{Boxes, Cascade};
pub use grey::Grey;
pub use lean::Lean;
pub use model::ModelError;
pub use pupil::Localiser;
pub use search::Face;

use pupil::EyeBox;
use search::{Lattice, search_near};

/// Widest picture in which faces are searched for, pixels.
const SEARCHED: usize = 480;

/// The least that boxes must add up to, Q.16: to be found, and to go on being seen. Pictures without a face reach 5 where eyes were
/// found in it, faces seen from the front 50 and more.
const LEAST: [i64; 2] = [12 << 16, 4 << 16];

/// Upright, to one side, to the other.
const LEANS: [Lean; 3] = [Lean::NONE, Lean::SIDES[0], Lean::SIDES[1]];

/// For so many pictures a face that isn't seen (a hand before it, a blurred turn) is awaited where it was.
const PATIENCE: u32 = 10;

/// Side of a face's box in eye distances.
pub const BOX: f64 = 1.0 / 0.35;

/// Boxes about each eye: to get there from the face, to get there from there, and to be exact.
const RUNS: [u32; 3] = [15, 15, 31];

/// Both pupils.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eyes {
    /// The one farther left in the picture and the other, pixels; the first pixel's centre is (0.5, 0.5).
    pub pupils: [[f64; 2]; 2],
    /// The face that they are in.
    pub face: Face,
}

/// Finds a face again and again.
#[derive(Clone, Debug)]
pub struct Finder {
    cascade: Cascade,
    localiser: Localiser,
    last: Option<Face>,
    /// Pictures since then.
    missed: u32,
    halves: Vec<Vec<u8>>,
    /// One a lean.
    lattices: [Option<Lattice>; 3],
}

impl Finder {
    /// With these models.
    pub fn new(cascade: Cascade, localiser: Localiser) -> Self {
        Self {
            cascade,
            localiser,
            last: None,
            missed: 0,
            halves: Vec::new(),
            lattices: [const { None }; 3],
        }
    }

    /// The eyes in the next picture, with faces whose boxes have sides from `least` to `greatest` pixels; a box is about
    /// [`BOX`] eye distances wide. The face seen before goes first; of new ones the surest is taken.
    ///
    /// Where nobody was, a quarter of all places is looked at more closely a picture, in turn, upright and leaning to one side; so one
    /// who is hard to see is found some pictures later.
    ///
    /// Cost at 400x300: some 14 million instructions where a face was, 22 million where it must be found, 19 million where nobody is;
    /// 10 million more for the first picture, and up to 17 MB that are kept.
    pub fn find(&mut self, grey: &Grey<'_>, [least, greatest]: [f64; 2]) -> Option<Eyes> {
        let mut halves = std::mem::take(&mut self.halves);
        let mut lattices = std::mem::take(&mut self.lattices);
        let eyes = self.look(grey, [least, greatest], &mut halves, &mut lattices);
        (self.halves, self.lattices) = (halves, lattices);
        match eyes {
            Some(eyes) => (self.last, self.missed) = (Some(eyes.face), 0),
            None => {
                self.missed = self.missed.wrapping_add(1);
                if self.missed == PATIENCE {
                    self.last = None;
                }
            }
        }
        eyes
    }

    /// Forgets where the face was.
    pub fn forget(&mut self) {
        (self.last, self.missed) = (None, 0);
    }

    fn look(
        &self,
        grey: &Grey<'_>,
        sides: [f64; 2],
        halves: &mut Vec<Vec<u8>>,
        lattices: &mut [Option<Lattice>; 3],
    ) -> Option<Eyes> {
        let (mut small, mut shift) = (*grey, 0);
        halves.resize(5, Vec::new());
        for to in halves {
            if small.width <= SEARCHED {
                break;
            }
            let width = small.halved(to)?;
            (small, shift) = (Grey::new(to, width)?, shift + 1);
        }
        // Only where pupils are found is a face: a leaning one may look like one that is upright, until then.
        let eyes = |face: Face| {
            let [x, y, side] = [face.x, face.y, face.side].map(|at| at << shift);
            let face = Face { x, y, side, ..face };
            let pupils = self.pupils(grey, &face)?;
            let [[ax, ay], [bx, by]] = pupils;
            Some(Eyes { pupils, face: Face { lean: Lean::along(bx - ax, by - ay), ..face } })
        };
        let near = self.last.and_then(|last| {
            let [x, y, side] = [last.x, last.y, last.side].map(|at| at >> shift);
            search_near(&self.cascade, &small, &Face { x, y, side, ..last }, LEAST[1])
        });
        let sides = sides.map(|side| (side / f64::from(1 << shift)).clamp(20.0, 8192.0) as i32);
        // One side a picture: whoever leans is found a picture later, and an empty chair costs less.
        let leans = [(0, self.missed), (1 + self.missed as usize % 2, self.missed / 2)];
        near.and_then(eyes).or_else(|| {
            leans.into_iter().find_map(|(lean, turn)| {
                let lattice = &mut lattices[lean];
                if !lattice.as_ref().is_some_and(|lattice| lattice.fits(&small, sides)) {
                    *lattice = Some(Lattice::new(&small, sides, LEANS[lean]));
                }
                lattice.as_mut()?.search(&self.cascade, &small, turn, LEAST[0]).and_then(eyes)
            })
        })
    }

    /// The pupils in a face, from left to right; `None` when they are not where a face has them.
    fn pupils(&self, grey: &Grey<'_>, face: &Face) -> Option<[[f64; 2]; 2]> {
        // A thousandth of the box's side and Q.8, in 1/256 pixel.
        let part = |n: i64| (n * i64::from(face.side) / 1000) as i32;
        let middle = [face.x, face.y].map(|at| 256 * at + 128);
        let first = [-175, 175].map(|aside| {
            let [right, down] = face.lean.turned([aside, -75]).map(part);
            let middle = [middle[0] + right, middle[1] + down];
            let from = EyeBox { middle, side: part(350 * 256), lean: face.lean };
            self.localiser.find(grey, from, RUNS[0])
        });
        let between = |[a, b]: [[i32; 2]; 2]| [0, 1].map(|i| f64::from(b[i] - a[i]));
        // From where they were found again and again: so the face's box, which moves in steps, no longer matters.
        let mut pupils = first;
        for runs in [RUNS[1], RUNS[2]] {
            let [right, down] = between(pupils);
            let (side, lean) = (libm::hypot(right, down) as i32, Lean::along(right, down));
            pupils =
                pupils.map(|middle| self.localiser.find(grey, EyeBox { middle, side, lean }, runs));
        }
        let [right, down] = between(pupils);
        let apart = libm::hypot(right, down) / (256.0 * f64::from(face.side));
        // As far apart as in faces, and not turned far from the face's own lean.
        let (cos, sin) = (f64::from(face.lean.cos), f64::from(face.lean.sin));
        let (ahead, aside) = (right * cos + down * sin, down * cos - right * sin);
        let likely = (0.2..0.55).contains(&apart) && aside.abs() < 0.5 * ahead;
        likely.then(|| pupils.map(|pupil| pupil.map(|at| f64::from(at) / 256.0)))
    }
}
