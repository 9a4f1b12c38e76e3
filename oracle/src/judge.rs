//! Compares a renderer's answers with the exact ones.
//!
//! A renderer has a bound for its own rounding ([`Renderer::rounding`]). Where that bound alone is more than half of the tolerance
//! (the gradients of slivers are steep), or the exact texture coordinate lies within the bound of a border between two texels, the
//! pixel is counted as not judged, and the report says how many there were. Coverage is always judged.

use std::fmt;

use crate::reference::{self, Exact};
use crate::triangle::{FAR, Fragment, Picture, Renderer, Rounding, Texel, Texture, Triangle};

/// Largest rounding bound, in steps of colour or depth, with which a pixel is judged.
const STEADY: f64 = 0.5;

/// Sums over many triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// Triangles looked at.
    pub triangles: usize,
    /// Covered pixels (by the exact answer).
    pub pixels: usize,
    /// Pixels that one covers and the other does not.
    pub coverage_differs: usize,
    /// Pixels whose colour was judged.
    pub colour_judged: usize,
    /// Pixels whose colour was not judged.
    pub colour_unjudged: usize,
    /// Largest distance of a judged colour channel from the exact value, in 1/255.
    pub colour_error: f64,
    /// Pixels whose depth was judged.
    pub depth_judged: usize,
    /// Pixels whose depth was not judged.
    pub depth_unjudged: usize,
    /// Largest distance of a judged depth from the exact value, in 1/65535 of the depth range.
    pub depth_error: f64,
    /// Pixels whose texel was judged.
    pub texel_judged: usize,
    /// Pixels whose texel was not judged: too close to a border between two texels.
    pub texel_unjudged: usize,
    /// Judged pixels whose texel differs.
    pub texel_differs: usize,
}

impl Report {
    /// Judges coverage of one triangle.
    pub fn coverage(&mut self, renderer: &mut dyn Renderer, triangle: &Triangle) {
        let expected = reference::coverage(triangle, renderer.size());
        let got = renderer.coverage(triangle);
        self.triangles += 1;
        self.covered(&expected, &got, |_, (), ()| ());
    }

    /// Judges coverage, colour and depth of one triangle.
    pub fn colour_depth(&mut self, renderer: &mut dyn Renderer, triangle: &Triangle) {
        let expected = reference::exact(triangle, renderer.size());
        let got = renderer.colour_depth(triangle);
        let rounding = renderer.rounding(triangle);
        self.triangles += 1;
        self.covered(&expected, &got, |report, exact, got| report.fragment(exact, got, &rounding));
    }

    /// Judges coverage and nearest texels of one triangle.
    pub fn texels(&mut self, renderer: &mut dyn Renderer, triangle: &Triangle, texture: &Texture) {
        let expected = reference::exact(triangle, renderer.size());
        let got = renderer.texels(triangle, texture);
        let rounding = renderer.rounding(triangle);
        self.triangles += 1;
        self.covered(&expected, &got, |report, exact, got| {
            report.texel(exact, got, texture, &rounding);
        });
    }

    /// Judges `renderer` by `judge`, pixel against pixel: coverage, colour and depth of one triangle. The errors are the
    /// differences of the two answers, judged where both are steady.
    pub fn against(
        &mut self,
        renderer: &mut dyn Renderer,
        judge: &mut dyn Renderer,
        triangle: &Triangle,
    ) {
        let expected = judge.colour_depth(triangle);
        let got = renderer.colour_depth(triangle);
        let (a, b) = (judge.rounding(triangle), renderer.rounding(triangle));
        let colour = Self::is_steady(a.colour.max(b.colour));
        let depth = Self::is_steady(a.depth.max(b.depth));
        self.triangles += 1;
        self.covered(&expected, &got, |report, expected, got| {
            let errors = expected.colour.iter().zip(got.colour).map(|(a, b)| a.abs_diff(b));
            report.colour(errors.max().unwrap_or(0).into(), colour);
            // 65537 = u32::MAX / 65535
            report.depth(f64::from(expected.depth.abs_diff(got.depth)) / 65537.0, depth);
        });
    }

    /// Judges `renderer` by `judge`, pixel against pixel: coverage and nearest texels of one triangle. Not judged are pixels
    /// whose exact coordinate lies within the bound of either from a border between texels.
    pub fn texels_against(
        &mut self,
        renderer: &mut dyn Renderer,
        judge: &mut dyn Renderer,
        triangle: &Triangle,
        texture: &Texture,
    ) {
        let expected = judge.texels(triangle, texture);
        let got = renderer.texels(triangle, texture);
        let exact = reference::exact(triangle, renderer.size());
        let roundings = [judge.rounding(triangle), renderer.rounding(triangle)];
        self.triangles += 1;
        self.covered(&expected, &got, |_, _, _| ());
        for ((expected, got), exact) in expected.pixels.iter().zip(&got.pixels).zip(&exact.pixels) {
            let (Some(expected), Some(got), Some(exact)) = (expected, got, exact) else { continue };
            let unsure = roundings.iter().any(|rounding| at_border(exact, texture, rounding));
            self.texel_verdict(expected != got, unsure);
        }
    }

    /// Counts coverage, and calls `both` for the pixels that both pictures cover.
    fn covered<A: Copy, B: Copy>(
        &mut self,
        expected: &Picture<A>,
        got: &Picture<B>,
        mut both: impl FnMut(&mut Self, A, B),
    ) {
        for (expected, got) in expected.pixels.iter().zip(&got.pixels) {
            self.pixels += usize::from(expected.is_some());
            match (expected, got) {
                (Some(expected), Some(got)) => both(self, *expected, *got),
                (None, None) => {}
                _ => self.coverage_differs += 1,
            }
        }
    }

    pub(crate) fn fragment(&mut self, exact: Exact, got: Fragment, rounding: &Rounding) {
        let errors = exact.colour.iter().zip(got.colour).map(|(a, b)| a.minus(b.into()).abs());
        self.colour(errors.fold(0.0, f64::max), Self::is_steady(rounding.colour));
        self.depth_fragment(exact, got, rounding);
    }

    pub(crate) fn depth_fragment(&mut self, exact: Exact, got: Fragment, rounding: &Rounding) {
        self.depth(depth_error(&exact, got.depth), Self::is_steady(rounding.depth));
    }

    /// True when a rounding bound is small enough to judge with.
    pub(crate) fn is_steady(rounding: f64) -> bool {
        rounding <= STEADY
    }

    pub(crate) fn colour(&mut self, error: f64, steady: bool) {
        if steady {
            self.colour_judged += 1;
            self.colour_error = self.colour_error.max(error);
        } else {
            self.colour_unjudged += 1;
        }
    }

    pub(crate) fn depth(&mut self, error: f64, steady: bool) {
        if steady {
            self.depth_judged += 1;
            self.depth_error = self.depth_error.max(error);
        } else {
            self.depth_unjudged += 1;
        }
    }

    pub(crate) fn texel(
        &mut self,
        exact: Exact,
        got: Texel,
        texture: &Texture,
        rounding: &Rounding,
    ) {
        let (right, _) = reference::texel(&exact, texture);
        self.texel_verdict(got != right, at_border(&exact, texture, rounding));
    }

    /// A pixel whose triangle is not sure: neither its colour nor, with a texture, its texel is judged.
    pub(crate) fn undecided(&mut self, textured: bool) {
        let count = if textured { &mut self.texel_unjudged } else { &mut self.colour_unjudged };
        *count += 1;
    }

    pub(crate) fn texel_verdict(&mut self, differs: bool, at_border: bool) {
        if at_border {
            self.texel_unjudged += 1;
        } else {
            self.texel_judged += 1;
            self.texel_differs += usize::from(differs);
        }
    }

    /// Adds another report.
    pub fn add(&mut self, other: &Report) {
        for (sum, count) in [
            (&mut self.triangles, other.triangles),
            (&mut self.pixels, other.pixels),
            (&mut self.coverage_differs, other.coverage_differs),
            (&mut self.colour_judged, other.colour_judged),
            (&mut self.colour_unjudged, other.colour_unjudged),
            (&mut self.depth_judged, other.depth_judged),
            (&mut self.depth_unjudged, other.depth_unjudged),
            (&mut self.texel_judged, other.texel_judged),
            (&mut self.texel_unjudged, other.texel_unjudged),
            (&mut self.texel_differs, other.texel_differs),
        ] {
            *sum += count;
        }
        self.colour_error = self.colour_error.max(other.colour_error);
        self.depth_error = self.depth_error.max(other.depth_error);
    }

    /// True when at least 95 of 100 pixels were judged.
    #[must_use]
    pub fn is_conclusive(&self) -> bool {
        let pairs = [
            (self.colour_judged, self.colour_unjudged),
            (self.depth_judged, self.depth_unjudged),
            (self.texel_judged, self.texel_unjudged),
        ];
        self.pixels > 0 && pairs.iter().all(|&(judged, not)| not * 19 <= judged)
    }

    /// True when nothing differs by more than the tolerances: no pixel of coverage, no judged texel, 1/255 in colour, one step
    /// of 1/65535 in depth.
    #[must_use]
    pub fn passes(&self) -> bool {
        let same = self.coverage_differs == 0 && self.texel_differs == 0;
        same && self.colour_error <= 1.0 && self.depth_error <= 1.0
    }
}

/// Distance of a depth (`u32::MAX` at the far plane) from the exact one, in 1/65535 of the depth range.
fn depth_error(exact: &Exact, depth: u32) -> f64 {
    // depth / (2^32 - 1) against num / den / FAR, both brought to one denominator before the one conversion.
    let (far, full) = (i128::from(FAR), i128::from(u32::MAX));
    let difference = exact.depth.num * full - i128::from(depth) * far * exact.depth.den;
    let scale = exact.depth.den as f64 * full as f64 * 65536.0;
    (difference as f64 / scale).abs()
}

/// True where the rounding bound reaches a border between two texels.
pub(crate) fn at_border(exact: &Exact, texture: &Texture, rounding: &Rounding) -> bool {
    let (_, to_border) = reference::texel(exact, texture);
    let bounds = texel_rounding(exact, texture, rounding);
    to_border[0] <= bounds[0] || to_border[1] <= bounds[1]
}

/// How far the texture coordinates may be off at this pixel, in texels: `d(u q) / q + u d(q) / q`, and two roundings of the
/// quotient in 24-bit floats.
fn texel_rounding(exact: &Exact, texture: &Texture, rounding: &Rounding) -> [f64; 2] {
    let q = exact.q.to_f64();
    let direction = |n: usize, size: u32| {
        let u = (exact.uv[n].to_f64() - rounding.origin[n]).abs();
        let quotient = (rounding.uvq[n] + u * rounding.q) / (q - rounding.q).max(f64::MIN_POSITIVE);
        let float = 2.0 * (u + 65536.0) / f64::from(1 << 24);
        (quotient + float) * f64::from(size) / 65536.0 + rounding.texel
    };
    [direction(0, texture.width), direction(1, texture.height)]
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { triangles, pixels, coverage_differs, .. } = self;
        write!(f, "{triangles} triangles, {pixels} pixels; {coverage_differs} differ in coverage")?;
        if self.colour_judged > 0 {
            let (error, unjudged) = (self.colour_error, self.colour_unjudged);
            write!(f, ", colour off by at most {error:.4}/255 ({unjudged} not judged)")?;
        }
        if self.depth_judged > 0 {
            let (error, unjudged) = (self.depth_error, self.depth_unjudged);
            write!(f, ", depth off by at most {error:.4}/65535 ({unjudged} not judged)")?;
        }
        if self.texel_judged > 0 {
            write!(f, ", {} in texel ({} not judged)", self.texel_differs, self.texel_unjudged)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Kind, Random, triangle};
    use crate::triangle::{Coverage, Vertex};

    const SIZE: (u32, u32) = (64, 64);

    /// Draws as the reference says, after changing the corners: a renderer with one known fault.
    struct Faulty(fn(&mut Vertex));

    impl Faulty {
        fn exact(&self, triangle: &Triangle) -> Picture<Exact> {
            let mut triangle = *triangle;
            triangle.0.iter_mut().for_each(self.0);
            reference::exact(&triangle, SIZE)
        }

        fn map<T>(&self, triangle: &Triangle, value: impl Fn(&Exact) -> T) -> Picture<T> {
            let exact = self.exact(triangle);
            let pixels = exact.pixels.iter().map(|p| p.as_ref().map(&value)).collect();
            Picture { width: SIZE.0, height: SIZE.1, pixels }
        }
    }

    impl Renderer for Faulty {
        fn name(&self) -> &str {
            "faulty"
        }

        fn size(&self) -> (u32, u32) {
            SIZE
        }

        fn rounding(&self, _: &Triangle) -> Rounding {
            Rounding {
                colour: 0.0,
                depth: 0.0,
                uvq: [0.0; 2],
                q: 0.0,
                origin: [0.0; 2],
                texel: 0.0,
            }
        }

        fn coverage(&mut self, triangle: &Triangle) -> Coverage {
            self.map(triangle, |_| ())
        }

        fn colour_depth(&mut self, triangle: &Triangle) -> Picture<Fragment> {
            self.map(triangle, |exact| Fragment {
                colour: exact.colour.map(|c| c.to_f64().round() as u8),
                depth: (exact.depth.to_f64() / f64::from(FAR) * f64::from(u32::MAX)) as u32,
            })
        }

        fn texels(&mut self, triangle: &Triangle, texture: &Texture) -> Picture<Texel> {
            self.map(triangle, |exact| reference::texel(exact, texture).0)
        }
    }

    fn reports(fault: fn(&mut Vertex)) -> [Report; 2] {
        let (mut random, mut renderer) = (Random::new(3), Faulty(fault));
        let texture = Texture { width: 64, height: 64, wrap: crate::Wrap::Repeat };
        let (mut fragments, mut texels) = (Report::default(), Report::default());
        for kind in Kind::ALL.into_iter().cycle().take(200) {
            let triangle = triangle(&mut random, kind, SIZE.0, SIZE.1);
            fragments.colour_depth(&mut renderer, &triangle);
            texels.texels(&mut renderer, &triangle, &texture);
        }
        [fragments, texels]
    }

    #[test]
    fn the_right_picture_passes_with_only_its_last_rounding() {
        let [fragments, texels] = reports(|_| ());
        assert!(fragments.passes() && texels.passes());
        assert!(fragments.colour_error <= 0.5, "{fragments}");
        assert_eq!(fragments.colour_unjudged + fragments.depth_unjudged, 0);
    }

    #[test]
    fn small_faults_are_found() {
        let passes = |fault| reports(fault).map(|report| report.passes());
        assert_eq!(passes(|v| v.x += 1), [false, false], "1/16 pixel");
        assert_eq!(passes(|v| v.colour[2] = v.colour[2].saturating_sub(2)), [false, true]);
        assert_eq!(passes(|v| v.z = v.z.saturating_sub(3 << 15)), [false, true], "1.5 steps");
        assert_eq!(passes(|v| v.uv[0] += 64), [true, false], "1/16 texel");
        assert_eq!(passes(|v| v.q = 1), [true, false], "affine texture");
    }
}
