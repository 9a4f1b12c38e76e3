//! Two eyes in one picture: the crate `scanout-head` has the arithmetic, this module its names on the command line.

use scanout_head::stereo::{self, Arrangement};

use crate::args::Stereo;
use crate::image_out::Picture;

/// The arrangement of a name.
pub fn arrangement(how: Stereo) -> Arrangement {
    match how {
        Stereo::Anaglyph => Arrangement::Anaglyph,
        Stereo::AnaglyphGrey => Arrangement::AnaglyphGrey,
        Stereo::AnaglyphHalfColour => Arrangement::AnaglyphHalfColour,
        Stereo::AnaglyphDubois => Arrangement::AnaglyphDubois,
        Stereo::SideBySide => Arrangement::SideBySide,
        Stereo::SideBySideHalf => Arrangement::SideBySideHalf,
        Stereo::TopBottom => Arrangement::TopBottom,
        Stereo::TopBottomHalf => Arrangement::TopBottomHalf,
        Stereo::Interlaced => Arrangement::Interlaced,
    }
}

/// Sizes (width, height) of the left and the right eye's picture in a frame of `width` x `height`.
///
/// Halves of at least one pixel, so a frame must measure two along the split.
pub fn eye_sizes(how: Stereo, width: u16, height: u16) -> [(u16, u16); 2] {
    arrangement(how)
        .eye_sizes(width.into(), height.into())
        .map(|(width, height)| (width as u16, height as u16))
}

/// The proportions (width, height) of what an eye sees: those of its picture, or of the whole frame where it is squeezed.
pub fn proportions(how: Stereo, eye: (u16, u16), frame: (u16, u16)) -> (u16, u16) {
    match how {
        Stereo::SideBySideHalf | Stereo::TopBottomHalf => frame,
        _ => eye,
    }
}

/// Puts two eyes' pictures, of the sizes that [`eye_sizes`] told, into one.
pub fn compose(how: Stereo, left: &Picture, right: &Picture) -> Picture {
    let (width, height) = match how {
        Stereo::SideBySide | Stereo::SideBySideHalf => (left.width + right.width, left.height),
        Stereo::TopBottom | Stereo::TopBottomHalf => (left.width, left.height + right.height),
        _ => (left.width, left.height),
    };
    let mut picture = Picture::filled(width, height, [0; 3]);
    let how = arrangement(how);
    stereo::compose(how, &left.pixels, &right.pixels, &mut picture.pixels, width);
    picture
}

#[cfg(test)]
mod tests {
    use clap::ValueEnum;

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

    #[test]
    fn every_name_has_an_arrangement_of_its_own() {
        let mut all: Vec<_> =
            Stereo::value_variants().iter().map(|how| arrangement(*how)).collect();
        assert_eq!(all.len(), Arrangement::ALL.len());
        all.dedup();
        assert!(Arrangement::ALL.iter().all(|how| all.contains(how)));
    }
}
