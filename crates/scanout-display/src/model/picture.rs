//! A picture that came out of the model.

use std::vec::Vec;

use mipidsi::options::{Orientation, Rotation};
use scanout::hash::{FORMAT_RGB565, FORMAT_RGB888, FrameHash};

/// Pixels, rows from the top, each from the left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture<P> {
    /// Width in pixels.
    pub width: u16,
    /// Height in pixels.
    pub height: u16,
    /// `width` x `height` pixels.
    pub pixels: Vec<P>,
}

impl<P: Copy> Picture<P> {
    /// The pixel at (x, y), which must be within the picture.
    pub fn at(&self, x: u16, y: u16) -> P {
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// A picture of another size, each pixel taken from a place in this one.
    fn gather(&self, width: u16, height: u16, from: impl Fn(u16, u16) -> (u16, u16)) -> Self {
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            pixels.extend((0..width).map(|x| {
                let (x, y) = from(x, y);
                self.at(x, y)
            }));
        }
        Picture { width, height, pixels }
    }

    /// A part of it; `None` where it reaches beyond.
    pub fn crop(&self, left: u16, top: u16, width: u16, height: u16) -> Option<Self> {
        let inside =
            left.checked_add(width)? <= self.width && top.checked_add(height)? <= self.height;
        inside.then(|| self.gather(width, height, |x, y| (left + x, top + y)))
    }

    /// A quarter turn clockwise.
    pub fn turned(&self) -> Self {
        self.gather(self.height, self.width, |x, y| (y, self.height - 1 - x))
    }

    /// Left and right exchanged.
    pub fn mirrored(&self) -> Self {
        self.gather(self.width, self.height, |x, y| (self.width - 1 - x, y))
    }

    /// The glass as its viewer holds it: a display set to `orientation` shows its content turned clockwise, then mirrored;
    /// this undoes both, by turning the picture and not by the controller's addresses.
    pub fn upright(&self, orientation: Orientation) -> Self {
        let picture = if orientation.mirrored { self.mirrored() } else { self.clone() };
        match orientation.rotation {
            Rotation::Deg0 => picture,
            Rotation::Deg90 => picture.turned().turned().turned(),
            Rotation::Deg180 => picture.turned().turned(),
            Rotation::Deg270 => picture.turned(),
        }
    }
}

impl Picture<u16> {
    /// The frame hash, comparable with `Frame::hash::<Rgb565>`.
    pub fn hash(&self) -> u64 {
        let mut hash = FrameHash::new(self.width, self.height, FORMAT_RGB565);
        self.pixels.iter().for_each(|pixel| hash.update(&pixel.to_be_bytes()));
        hash.finish()
    }
}

impl Picture<[u8; 3]> {
    /// The frame hash of RGB888 pixels.
    pub fn hash(&self) -> u64 {
        let mut hash = FrameHash::new(self.width, self.height, FORMAT_RGB888);
        self.pixels.iter().for_each(|pixel| hash.update(pixel));
        hash.finish()
    }
}
