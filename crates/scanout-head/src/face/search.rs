//! Boxes of many sizes at many places: the face among them.

use super::cascade::{Boxes, Cascade};
use super::grey::Grey;
use super::lean::Lean;

/// A square about a face, pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// Column of its middle.
    pub x: i32,
    /// Row of its middle.
    pub y: i32,
    /// Its side.
    pub side: i32,
    /// How sure it is, Q.16: the sum over all boxes that agree.
    pub score: i64,
    /// How it leans.
    pub lean: Lean,
}

/// Where to look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Range {
    /// Columns of middles, first and last.
    x: [i32; 2],
    /// Rows of middles, first and last.
    y: [i32; 2],
    /// Sides, least and greatest.
    side: [i32; 2],
}

impl Range {
    /// The whole picture, all sides.
    const ALL: Self = Self { x: [0, 8192], y: [0, 8192], side: [0, 8192] };

    /// Places up to a fraction of a face's side away, each way; sides from some to some tenths of its own.
    fn about(face: &Face, [numerator, denominator]: [i32; 2], tenths: [i32; 2]) -> Self {
        let reach = face.side * numerator / denominator;
        let [x, y] = [face.x, face.y].map(|at| [at - reach, at + reach]);
        Self { x, y, side: tenths.map(|tenths| face.side * tenths / 10) }
    }
}

/// Trees that the first look asks: nearly all boxes fail at fewer, and whole faces pass them two steps away.
const FIRST_TREES: usize = 128;

/// More boxes than this are no faces but a model that sees one everywhere; a face has up to some hundred.
const MOST_HITS: usize = 2048;

/// Boxes of many sizes at places that depend on the picture's size alone: a tenth of their side apart, each size a tenth larger than
/// the one before.
#[derive(Clone, Debug)]
pub struct Lattice {
    width: usize,
    height: usize,
    sides: [i32; 2],
    /// Column and row of the first middles, where boxes about them are in the picture.
    origin: [i32; 2],
    sizes: Vec<Boxes>,
}

impl Lattice {
    /// For boxes from `least` to `greatest` which lean so.
    pub fn new(grey: &Grey<'_>, [least, greatest]: [i32; 2], lean: Lean) -> Self {
        let greatest_inside = greatest.min(grey.width.min(grey.height) as i32);
        let next = |&side: &i32| Some((side * 11 / 10).max(side + 1));
        let sides = std::iter::successors(Some(least.max(20)), next);
        let sizes = sides.take_while(|&side| side <= greatest_inside);
        let sizes = sizes.map(|side| Boxes::new(grey, side, lean)).collect();
        Self {
            width: grey.width,
            height: grey.height,
            sides: [least, greatest],
            origin: [0; 2],
            sizes,
        }
    }

    /// Is it one for this picture and these sides?
    pub fn fits(&self, grey: &Grey<'_>, sides: [i32; 2]) -> bool {
        (self.width, self.height, self.sides) == (grey.width, grey.height, sides)
    }

    /// The boxes of a range that `take` (size's number, column's, row's) wants and `score` lets pass; `None` when there are too many.
    fn scan(
        &mut self,
        range: Range,
        take: impl Fn(usize, usize, usize) -> bool,
        score: impl Fn(&mut Boxes, [i32; 2]) -> Option<i32>,
    ) -> Option<Vec<Face>> {
        let mut hits = Vec::new();
        for (number, boxes) in self.sizes.iter_mut().enumerate() {
            let (side, lean) = (boxes.side, boxes.lean);
            if side < range.side[0] || side > range.side[1] {
                continue;
            }
            let (step, reach) = ((side / 10).max(1), lean.reach(side));
            let places = |[from, to]: [i32; 2], size: usize, origin: i32| {
                let origin = origin.max(reach);
                let first = ((from - origin).max(0) + step - 1) / step;
                let last = (to.min(size as i32 - reach) - origin).div_euclid(step);
                (first..=last).map(move |index| (index as usize, origin + index * step))
            };
            for (row, y) in places(range.y, self.height, self.origin[1]) {
                for (column, x) in places(range.x, self.width, self.origin[0]) {
                    if !take(number, column, row) {
                        continue;
                    }
                    if let Some(score) = score(boxes, [x, y]) {
                        if hits.len() == MOST_HITS {
                            return None;
                        }
                        hits.push(Face { x, y, side, score: score.into(), lean });
                    }
                }
            }
        }
        Some(hits)
    }

    /// The boxes of a range that are faces.
    fn all(&mut self, cascade: &Cascade, grey: &Grey<'_>, range: Range) -> Option<Vec<Face>> {
        self.scan(range, |_, _, _| true, |boxes, at| cascade.score(boxes, grey, at))
    }

    /// The face that most boxes agree on; `None` when their sum is below `least`, Q.16.
    ///
    /// Only a quarter of the boxes is looked at first, and by the first trees alone, which mind less where exactly a face is; then all
    /// about those that passed. `turn` tells which quarter: pictures that follow one another look at different ones.
    pub fn search(
        &mut self,
        cascade: &Cascade,
        grey: &Grey<'_>,
        turn: u32,
        least: i64,
    ) -> Option<Face> {
        let turns = |size, column, row| quarter(size, column, row) == turn % 4;
        let first = |boxes: &mut Boxes, at| cascade.score_of(FIRST_TREES, boxes, grey, at);
        let places = groups(&self.scan(Range::ALL, turns, first)?);
        let mut best: Option<Face> = None;
        for place in places {
            // Most are none, and have no whole face beside them either.
            let beside = self.all(cascade, grey, Range::about(&place, [1, 3], [7, 14]))?;
            if !beside.is_empty() {
                let hits = self.all(cascade, grey, Range::about(&place, [1, 2], [7, 15]))?;
                let face = groups(&hits).into_iter().next();
                best = best.into_iter().chain(face).max_by_key(|face| face.score);
            }
        }
        best.filter(|face| face.score >= least)
    }
}

/// Which quarter of a lattice's boxes one is in: each second column and row, others in the next size.
fn quarter(size: usize, column: usize, row: usize) -> u32 {
    ((size + column) % 2 + 2 * ((size / 2 + row) % 2)) as u32
}

/// A face near the one of the picture before: at most a third of its side away, up to a quarter larger or smaller, leaning as that.
pub fn search_near(cascade: &Cascade, grey: &Grey<'_>, last: &Face, least: i64) -> Option<Face> {
    let range = Range::about(last, [1, 3], [8, 12]);
    let mut lattice = Lattice::new(grey, range.side, last.lean);
    lattice.origin = [range.x[0], range.y[0]];
    let hits = lattice.all(cascade, grey, range)?;
    groups(&hits).into_iter().next().filter(|face| face.score >= least)
}

/// Boxes that overlap the surest one of their group by 0.3 of their union are one face, in the middle of them, weighted; the group
/// with the greatest sum first.
fn groups(hits: &[Face]) -> Vec<Face> {
    let mut order: Vec<&Face> = hits.iter().collect();
    order.sort_by_key(|hit| (-hit.score, hit.y, hit.x, hit.side));
    let mut groups = Vec::new();
    while let Some(&first) = order.first() {
        let (mut score, mut sums) = (0i64, [0i64; 3]);
        order.retain(|hit| {
            let same = overlap(first, hit);
            if same {
                let weight = hit.score.max(1);
                score += weight;
                for (sum, at) in sums.iter_mut().zip([hit.x, hit.y, hit.side]) {
                    *sum += weight * i64::from(at);
                }
            }
            !same
        });
        let [x, y, side] = sums.map(|sum| ((sum + score / 2) / score) as i32);
        groups.push(Face { x, y, side, score, lean: first.lean });
    }
    groups.sort_by_key(|group| -group.score);
    groups
}

fn overlap(a: &Face, b: &Face) -> bool {
    let shared = |p: i32, q: i32| {
        let ends = (2 * p + a.side).min(2 * q + b.side);
        let starts = (2 * p - a.side).max(2 * q - b.side);
        i64::from((ends - starts).max(0)) // half pixels
    };
    let both = shared(a.x, b.x) * shared(a.y, b.y);
    let area = |side: i32| 4 * i64::from(side) * i64::from(side);
    10 * both > 3 * (area(a.side) + area(b.side) - both)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hit(x: i32, y: i32, side: i32, score: i64) -> Face {
        Face { x, y, side, score, lean: Lean::NONE }
    }

    #[test]
    fn boxes_that_overlap_are_one_face() {
        let hits = [hit(100, 50, 40, 10), hit(104, 50, 40, 10), hit(300, 50, 40, 15)];
        assert_eq!(groups(&hits), [hit(102, 50, 40, 20), hit(300, 50, 40, 15)]);
        assert_eq!(groups(&[]), []);
    }

    #[test]
    fn four_turns_look_at_every_box_once() {
        let levels = vec![0; 120 * 90];
        let grey = Grey::new(&levels, 120).unwrap();
        let mut lattice = Lattice::new(&grey, [40, 120], Lean::SIDES[0]);
        let places = |boxes: &mut Boxes, [_, _]: [i32; 2]| Some(boxes.side);
        let all = lattice.scan(Range::ALL, |_, _, _| true, places).unwrap();
        let turn = |turn| {
            let some = |size, column, row| quarter(size, column, row) == turn;
            lattice.scan(Range::ALL, some, places).unwrap()
        };
        let mut turns: Vec<Face> = [0, 1, 2, 3].into_iter().flat_map(turn).collect();
        turns.sort_by_key(|face| (face.side, face.y, face.x));
        assert!(all.len() > 400 && all == turns, "{} {}", all.len(), turns.len());
    }

    #[test]
    fn ranges_only_choose() {
        let levels = vec![0; 120 * 90];
        let grey = Grey::new(&levels, 120).unwrap();
        let mut lattice = Lattice::new(&grey, [40, 120], Lean::NONE);
        let places = |boxes: &mut Boxes, [_, _]: [i32; 2]| Some(boxes.side);
        let range = Range::about(&hit(60, 45, 50, 1), [1, 3], [7, 14]);
        let mut all = lattice.scan(Range::ALL, |_, _, _| true, places).unwrap();
        all.retain(|f| (44..=76).contains(&f.x) && (29..=61).contains(&f.y));
        all.retain(|f| (35..=70).contains(&f.side));
        assert_eq!(lattice.scan(range, |_, _, _| true, places), Some(all));
    }

    #[test]
    fn overlap_is_of_the_union() {
        let a = hit(0, 0, 100, 1);
        assert!(overlap(&a, &hit(50, 0, 100, 1)), "50 of 150");
        assert!(!overlap(&a, &hit(60, 0, 100, 1)), "40 of 160");
        assert!(!overlap(&a, &hit(0, 0, 50, 1)), "a quarter");
        assert!(!overlap(&a, &hit(200, 0, 100, 1)));
    }
}
