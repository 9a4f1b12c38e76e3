//! Two eyes in one picture, as exact integer arithmetic: what this module says, a mixer in hardware repeats bit for bit.
//!
//! | arrangement | ffmpeg's stereo3d | left eye | right eye | an eye's picture |
//! |---|---|---|---|---|
//! | anaglyph, grey | `arcg` | red, its luma | green and blue, its luma | whole frame |
//! | anaglyph, colour | `arcc` | red channel | green and blue channels | whole frame |
//! | anaglyph, half colour | `arch` | red, its luma | green and blue channels | whole frame |
//! | anaglyph, Dubois | `arcd` | both eyes in each channel, by least squares for red-cyan glasses | | whole frame |
//! | side by side | `sbsl` | left half | right half | W/2 x H, in natural proportions |
//! | side by side, half | `sbs2l` | left half | right half | W/2 x H, the whole view squeezed |
//! | top-bottom | `abl` | upper half | lower half | W x H/2, in natural proportions |
//! | top-bottom, half | `ab2l` | upper half | lower half | W x H/2, the whole view squeezed |
//! | row-interleaved | `irl` | even rows (0, 2, ...) | odd rows | whole frame |
//!
//! When the split side is odd, the middle column or row is the right eye's. Swapped eyes (ffmpeg's names that end in `r`): exchange
//! the two pictures before.
//!
//! Anaglyphs: each output channel is `clamp(floor((c0 Rl + c1 Gl + c2 Bl + c3 Rr + c4 Gr + c5 Br) / 65536), 0, 255)` with the
//! signed 18-bit coefficients of [`Arrangement::coefficients`] (Q1.16; a sum fits 26 bits). Luma is BT.601's 0.299 R + 0.587 G +
//! 0.114 B; Dubois' matrix is that of E. Dubois, "A projection method to generate anaglyph stereo images", ICASSP 2001, times 65536
//! to nearest.

/// How two eyes become one picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Arrangement {
    /// Red-cyan, without colours.
    AnaglyphGrey,
    /// Red-cyan, all colours; red and cyan things flicker.
    Anaglyph,
    /// Red-cyan, the left eye's picture without colours.
    AnaglyphHalfColour,
    /// Red-cyan, least squares in colour for real glasses.
    AnaglyphDubois,
    /// Two halves, left and right, in natural proportions.
    SideBySide,
    /// Two halves, left and right, squeezed: what televisions take.
    SideBySideHalf,
    /// Two halves, one above the other, in natural proportions.
    TopBottom,
    /// Two halves, one above the other, squeezed.
    TopBottomHalf,
    /// Rows in turn, for screens with polarised rows.
    Interlaced,
}

use Arrangement::{
    Anaglyph, AnaglyphDubois, AnaglyphGrey, AnaglyphHalfColour, Interlaced, SideBySide,
    SideBySideHalf, TopBottom, TopBottomHalf,
};

/// Weights of the left eye's R, G, B and the right eye's R, G, B for each output channel, Q1.16.
pub type Coefficients = [[i32; 6]; 3];

const ONE: i32 = 1 << 16;
const LEFT_LUMA: [i32; 6] = [19_595, 38_470, 7_471, 0, 0, 0];
const RIGHT_LUMA: [i32; 6] = [0, 0, 0, 19_595, 38_470, 7_471];
const LEFT_RED: [i32; 6] = [ONE, 0, 0, 0, 0, 0];
const RIGHT_GREEN: [i32; 6] = [0, 0, 0, 0, ONE, 0];
const RIGHT_BLUE: [i32; 6] = [0, 0, 0, 0, 0, ONE];
const DUBOIS: Coefficients = [
    [29_891, 32_800, 11_559, -2_849, -5_763, -102],
    [-2_627, -2_479, -1_033, 24_804, 48_080, -1_209],
    [-997, -1_350, -358, -4_729, -7_403, 80_373],
];

/// Which eye a pixel of the screen comes from, and where in that eye's picture it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Both eyes, mixed, at the screen's own place.
    Both,
    /// The left eye.
    Left {
        /// Column of its picture.
        x: usize,
        /// Row of its picture.
        y: usize,
    },
    /// The right eye.
    Right {
        /// Column of its picture.
        x: usize,
        /// Row of its picture.
        y: usize,
    },
}

impl Arrangement {
    /// All of them.
    pub const ALL: [Arrangement; 9] = [
        AnaglyphGrey,
        Anaglyph,
        AnaglyphHalfColour,
        AnaglyphDubois,
        SideBySide,
        SideBySideHalf,
        TopBottom,
        TopBottomHalf,
        Interlaced,
    ];

    /// The weights of an anaglyph; `None` where every pixel is one eye's.
    pub const fn coefficients(self) -> Option<Coefficients> {
        match self {
            AnaglyphGrey => Some([LEFT_LUMA, RIGHT_LUMA, RIGHT_LUMA]),
            Anaglyph => Some([LEFT_RED, RIGHT_GREEN, RIGHT_BLUE]),
            AnaglyphHalfColour => Some([LEFT_LUMA, RIGHT_GREEN, RIGHT_BLUE]),
            AnaglyphDubois => Some(DUBOIS),
            SideBySide | SideBySideHalf | TopBottom | TopBottomHalf | Interlaced => None,
        }
    }

    /// Sizes (width, height) of the left and the right eye's picture in a frame of `width` x `height`.
    ///
    /// Halves of at least one pixel, so a frame must measure two along the split.
    pub const fn eye_sizes(self, width: usize, height: usize) -> [(usize, usize); 2] {
        match self {
            SideBySide | SideBySideHalf => [(width / 2, height), (width - width / 2, height)],
            TopBottom | TopBottomHalf => [(width, height / 2), (width, height - height / 2)],
            _ => [(width, height); 2],
        }
    }

    /// The share of the screen's width and height that an eye sees through: a half where halves keep natural proportions.
    pub const fn share(self) -> (f64, f64) {
        match self {
            SideBySide => (0.5, 1.0),
            TopBottom => (1.0, 0.5),
            _ => (1.0, 1.0),
        }
    }

    /// Where the pixel (`x`, `y`) of a frame of `width` x `height` comes from.
    #[inline]
    pub const fn place(self, width: usize, height: usize, x: usize, y: usize) -> Place {
        match self {
            SideBySide | SideBySideHalf if x < width / 2 => Place::Left { x, y },
            SideBySide | SideBySideHalf => Place::Right { x: x - width / 2, y },
            TopBottom | TopBottomHalf if y < height / 2 => Place::Left { x, y },
            TopBottom | TopBottomHalf => Place::Right { x, y: y - height / 2 },
            Interlaced if y.is_multiple_of(2) => Place::Left { x, y },
            Interlaced => Place::Right { x, y },
            _ => Place::Both,
        }
    }
}

/// One pixel of an anaglyph from the two eyes' pixels.
#[inline]
pub const fn mix(c: &Coefficients, [a, b, d]: [u8; 3], [e, f, g]: [u8; 3]) -> [u8; 3] {
    let eyes = [a as i32, b as i32, d as i32, e as i32, f as i32, g as i32];
    let mut rgb = [0; 3];
    let mut channel = 0;
    while channel < 3 {
        let (mut sum, mut i) = (0, 0);
        while i < 6 {
            sum += c[channel][i] * eyes[i];
            i += 1;
        }
        let value = sum >> 16;
        rgb[channel] = if value < 0 {
            0
        } else if value > 255 {
            255
        } else {
            value as u8
        };
        channel += 1;
    }
    rgb
}

/// Puts two eyes' pictures (rows from the top, of the sizes that [`Arrangement::eye_sizes`] told) into `out`, a frame of
/// `width` pixels a row.
///
/// # Panics
/// When `left` or `right` has not the size that belongs to `out`, or `out` is not whole rows.
pub fn compose(
    how: Arrangement,
    left: &[[u8; 3]],
    right: &[[u8; 3]],
    out: &mut [[u8; 3]],
    width: usize,
) {
    assert!(width > 0 && out.len().is_multiple_of(width), "whole rows");
    let height = out.len() / width;
    let [l, r] = how.eye_sizes(width, height);
    assert!(left.len() == l.0 * l.1 && right.len() == r.0 * r.1, "the eyes' pictures must fit");
    if let Some(coefficients) = how.coefficients() {
        for ((pixel, l), r) in out.iter_mut().zip(left).zip(right) {
            *pixel = mix(&coefficients, *l, *r);
        }
        return;
    }
    // Every other arrangement takes runs of a row from one eye.
    let half = if l.0 < width { width / 2 } else { width };
    for (y, row) in out.chunks_exact_mut(width).enumerate() {
        for (start, run) in [(0, half), (half, width)] {
            if start == run {
                continue;
            }
            let (eye, stride, x, y) = match how.place(width, height, start, y) {
                Place::Left { x, y } => (left, l.0, x, y),
                Place::Right { x, y } => (right, r.0, x, y),
                Place::Both => unreachable!("anaglyphs were mixed above"),
            };
            let first = y * stride + x;
            row[start..run].copy_from_slice(&eye[first..first + run - start]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one_where_a_grey_thing_must_stay_grey() {
        for how in [AnaglyphGrey, Anaglyph, AnaglyphHalfColour] {
            for channel in how.coefficients().unwrap() {
                assert_eq!(channel.iter().sum::<i32>(), ONE, "{how:?}");
            }
        }
        // Dubois: within 0.2 % of one.
        for channel in DUBOIS {
            assert!((channel.iter().sum::<i32>() - ONE).abs() < 200, "{channel:?}");
        }
    }

    #[test]
    fn dubois_is_the_published_matrix() {
        const PUBLISHED: [[f64; 6]; 3] = [
            [0.4561, 0.500484, 0.176381, -0.0434706, -0.0879388, -0.00155529],
            [-0.0400822, -0.0378246, -0.0157589, 0.378476, 0.73364, -0.0184503],
            [-0.0152161, -0.0205971, -0.00546856, -0.0721527, -0.112961, 1.2264],
        ];
        for (row, published) in DUBOIS.iter().zip(PUBLISHED) {
            for (c, p) in row.iter().zip(published) {
                assert!((f64::from(*c) - p * 65536.0).abs() < 1.0, "{c} {p}");
            }
        }
    }

    /// Left, right, and what grey, half colour and Dubois make of them: for whoever builds the mixer anew.
    const VECTORS: [(Pixel, Pixel, [Pixel; 3]); 4] = [
        ([200, 100, 50], [30, 60, 90], [[124, 54, 54], [124, 60, 90], [143, 41, 96]]),
        ([1, 2, 3], [4, 5, 6], [[1, 4, 4], [1, 5, 6], [1, 4, 6]]),
        ([255, 0, 128], [0, 255, 127], [[90, 164, 164], [90, 255, 127], [116, 172, 122]]),
        ([17, 99, 201], [254, 3, 77], [[86, 86, 86], [86, 3, 77], [81, 89, 72]]),
    ];

    type Pixel = [u8; 3];

    #[test]
    fn vectors() {
        for (left, right, expected) in VECTORS {
            let got = [AnaglyphGrey, AnaglyphHalfColour, AnaglyphDubois]
                .map(|how| mix(&how.coefficients().unwrap(), left, right));
            assert_eq!(got, expected, "{left:?} {right:?}");
        }
    }

    #[test]
    fn extremes_are_clamped_and_never_wrap() {
        assert_eq!(mix(&DUBOIS, [255; 3], [0; 3]), [255, 0, 0]);
        assert_eq!(mix(&DUBOIS, [0; 3], [255; 3]), [0, 255, 255]);
        let grey = AnaglyphGrey.coefficients().unwrap();
        for level in 0..=255 {
            assert_eq!(mix(&grey, [level; 3], [level; 3]), [level; 3]);
        }
    }

    /// `compose` against `place` and `mix`, pixel by pixel, in every size with an odd and an even split.
    #[test]
    fn every_pixel_is_where_its_place_says() {
        for how in Arrangement::ALL {
            for (width, height) in [(2, 2), (5, 4), (4, 5), (7, 3)] {
                let [l, r] = how.eye_sizes(width, height);
                let eye = |(w, h): (usize, usize), tag: u8| -> Vec<[u8; 3]> {
                    (0..w * h).map(|i| [tag, (i % w) as u8 * 9, (i / w) as u8 * 9]).collect()
                };
                let (left, right) = (eye(l, 40), eye(r, 200));
                let mut out = vec![[0; 3]; width * height];
                compose(how, &left, &right, &mut out, width);
                for (i, pixel) in out.iter().enumerate() {
                    let expected = match how.place(width, height, i % width, i / width) {
                        Place::Both => mix(&how.coefficients().unwrap(), left[i], right[i]),
                        Place::Left { x, y } => left[y * l.0 + x],
                        Place::Right { x, y } => right[y * r.0 + x],
                    };
                    assert_eq!(*pixel, expected, "{how:?} {width} x {height}, pixel {i}");
                }
            }
        }
    }
}
