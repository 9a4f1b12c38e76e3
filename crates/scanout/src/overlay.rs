//! Overlay: a plane of one bit a pixel over a camera's picture (system A): the ink where the bit is set, the camera elsewhere.
//!
//! Two ways give an overlay. Drawing with [`Background::Image`](crate::scene::Background::Image) puts the camera's picture
//! into the band before the scene is drawn over it: any mode, any colours. [`mix_row`] does what A's hardware does while it scans
//! out: the wireframe lives in a plane of one bit a pixel (320 x 200 = 8,000 bytes) and the camera's pixels
//! pass by. What it will not do: blend.

use crate::output::PixelFormat;

/// Mixes a row: pixel x becomes `ink` where bit x of `plane` is set (leftmost in the top bit) and stays the camera's elsewhere.
/// Pixels beyond the plane's end stay too.
pub fn mix_row<F: PixelFormat>(plane: &[u8], camera: &mut [F::Word], width: usize, ink: [u8; 3]) {
    let ink = F::encode(ink);
    for (i, &byte) in plane.iter().enumerate() {
        let mut bits = byte;
        while bits != 0 {
            let lead = bits.leading_zeros() as usize;
            let x = i * 8 + lead;
            if x < width {
                F::store(camera, x, ink);
            }
            bits &= !(0x80 >> lead);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{Rgb332, Rgb888};

    #[test]
    fn ink_where_set_camera_elsewhere() {
        let mut row = [[10, 20, 30]; 12];
        mix_row::<Rgb888>(&[0b0100_0001, 0b1000_1111], &mut row, 12, [0; 3]);
        let inked = core::array::from_fn(|x| [1, 7, 8].contains(&x));
        assert_eq!(row.map(|p| p == [0; 3]), inked);
        assert!(row.iter().all(|&p| p == [0; 3] || p == [10, 20, 30]));
    }

    #[test]
    fn a_plane_longer_than_the_row_is_cut() {
        let mut row = [0xffu8; 5];
        mix_row::<Rgb332>(&[0xff, 0xff], &mut row, 5, [0; 3]);
        assert_eq!(row, [0; 5]);
    }
}
