//! Two eyes in one picture.
//!
//! | arrangement | left eye | right eye | size of an eye's picture |
//! |---|---|---|---|
//! | anaglyph | red channel | green and blue channels | whole frame |
//! | side by side | left half | right half | W/2 x H, in natural proportions |
//! | top-bottom | upper half | lower half | W x H/2, in natural proportions |
//! | interlaced | even lines (0, 2, ...) | odd lines | whole frame |
//!
//! When the split side is odd, the middle column or line is the right eye's.

use crate::args::Stereo;
use crate::image_out::Picture;

/// Sizes (width, height) of the left and the right eye's picture in a frame of `width` x `height`.
///
/// Halves of at least one pixel, so a frame must measure two along the split.
pub fn eye_sizes(how: Stereo, width: u16, height: u16) -> [(u16, u16); 2] {
    match how {
        Stereo::Anaglyph | Stereo::Interlaced => [(width, height); 2],
        Stereo::SideBySide => [(width / 2, height), (width - width / 2, height)],
        Stereo::TopBottom => [(width, height / 2), (width, height - height / 2)],
    }
}

/// Puts two eyes' pictures, of the sizes that [`eye_sizes`] told, into one.
pub fn compose(how: Stereo, left: &Picture, right: &Picture) -> Picture {
    let both = left.pixels.iter().zip(&right.pixels);
    match how {
        Stereo::Anaglyph => {
            let pixels = both.map(|(l, r)| [l[0], r[1], r[2]]).collect();
            Picture { pixels, ..*left }
        }
        Stereo::Interlaced => {
            let rows = left.rows().zip(right.rows()).enumerate();
            let pixels = rows.flat_map(|(y, (l, r))| if y % 2 == 0 { l } else { r }).copied();
            Picture { pixels: pixels.collect(), ..*left }
        }
        Stereo::SideBySide => {
            let rows = left.rows().zip(right.rows());
            let pixels = rows.flat_map(|(l, r)| l.iter().chain(r)).copied().collect();
            Picture { width: left.width + right.width, height: left.height, pixels }
        }
        Stereo::TopBottom => {
            let pixels = [&left.pixels[..], &right.pixels[..]].concat();
            Picture { width: left.width, height: left.height + right.height, pixels }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const L: [u8; 3] = [1, 2, 3];
    const R: [u8; 3] = [7, 8, 9];

    fn composed(how: Stereo, width: u16, height: u16) -> Picture {
        let [l, r] = eye_sizes(how, width, height);
        let eye = |(w, h): (u16, u16), rgb| Picture::filled(w.into(), h.into(), rgb);
        let picture = compose(how, &eye(l, L), &eye(r, R));
        assert_eq!((picture.width, picture.height), (width.into(), height.into()));
        assert_eq!(picture.pixels.len(), picture.width * picture.height);
        picture
    }

    #[test]
    fn arrangements() {
        assert_eq!(composed(Stereo::Anaglyph, 2, 1).pixels, [[1, 8, 9]; 2]);
        assert_eq!(composed(Stereo::Interlaced, 1, 3).pixels, [L, R, L]);
        assert_eq!(composed(Stereo::SideBySide, 3, 2).pixels, [L, R, R, L, R, R]);
        assert_eq!(composed(Stereo::TopBottom, 1, 3).pixels, [L, R, R]);
    }
}
