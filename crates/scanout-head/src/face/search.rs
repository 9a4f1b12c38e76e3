//! Boxes of many sizes at many places: the face among them.

use super::cascade::Cascade;
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
pub struct Range {
    /// Columns of middles, first and last.
    pub x: [i32; 2],
    /// Rows of middles, first and last.
    pub y: [i32; 2],
    /// Sides, least and greatest.
    pub side: [i32; 2],
    /// How they lean.
    pub lean: Lean,
}

impl Range {
    /// The whole picture.
    pub fn all(grey: &Grey<'_>, side: [i32; 2], lean: Lean) -> Self {
        Self { x: [0, grey.width as i32], y: [0, grey.height as i32], side, lean }
    }

    /// About a face of the picture before: a third of its side each way, a quarter larger or smaller.
    pub fn about(face: &Face) -> Self {
        let reach = face.side / 3;
        Self {
            x: [face.x - reach, face.x + reach],
            y: [face.y - reach, face.y + reach],
            side: [face.side * 4 / 5, face.side * 5 / 4],
            lean: face.lean,
        }
    }
}

/// More boxes than this are no faces but a model that sees one everywhere; a face has up to some hundred.
const MOST_HITS: usize = 2048;

/// The face that most boxes agree on; `None` when their sum is below `least`, Q.16. Boxes are a tenth of their side apart, and each
/// size is a tenth larger than the one before.
pub fn search(cascade: &Cascade, grey: &Grey<'_>, range: Range, least: i64) -> Option<Face> {
    let mut hits = Vec::new();
    let mut side = range.side[0].max(20);
    let greatest = range.side[1].min(grey.width.min(grey.height) as i32);
    while side <= greatest {
        let step = (side / 10).max(1);
        let reach = range.lean.reach(side);
        let ends =
            |[from, to]: [i32; 2], size: usize| (from.max(reach), to.min(size as i32 - reach));
        let ((left, right), (top, bottom)) =
            (ends(range.x, grey.width), ends(range.y, grey.height));
        for y in (top..=bottom).step_by(step as usize) {
            for x in (left..=right).step_by(step as usize) {
                if hits.len() == MOST_HITS {
                    return None;
                }
                if let Some(score) = cascade.score(grey, [x, y], side, range.lean) {
                    hits.push(Face { x, y, side, score: score.into(), lean: range.lean });
                }
            }
        }
        side = (side * 11 / 10).max(side + 1);
    }
    agree(&hits).filter(|face| face.score >= least)
}

/// Boxes that overlap the surest one of their group by 0.3 of their union are one face, in the middle of them, weighted.
fn agree(hits: &[Face]) -> Option<Face> {
    let mut order: Vec<&Face> = hits.iter().collect();
    order.sort_by_key(|hit| (-hit.score, hit.y, hit.x, hit.side));
    let mut best: Option<Face> = None;
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
        if best.is_none_or(|best| score > best.score) {
            let [x, y, side] = sums.map(|sum| ((sum + score / 2) / score) as i32);
            best = Some(Face { x, y, side, score, lean: first.lean });
        }
    }
    best
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
        assert_eq!(agree(&hits), Some(hit(102, 50, 40, 20)));
        assert_eq!(agree(&[]), None);
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
