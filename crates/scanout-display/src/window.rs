//! Windows: where a band lies in the controller's memory.
//!
//! An ST7789 has 240 columns and 320 rows. `MADCTL` turns the addresses, not the memory: with rows and columns
//! exchanged (MV) a window is given in landscape, x to 319, y to 239. Glass smaller than the memory (240x240, 135x240)
//! shows a part of it, and which addresses these are depends on the orientation.
//!
//! ```text
//!   memory, 240 x 320            addresses after a turn by 90 degrees (MV, MX)
//!   +---+-------+---+            +-------------------+
//!   |   | glass |   |            |      left         |
//!   |   |       |   |            | top +-------+     |    Area  = the glass, or the part of it
//!   |   |       |   |   ----->   |     |#######| <---------     that the frame is shown in
//!   |   +-------+   |            |     |=======| <--------- Window = one band of the area
//!   |               |            |     +-------+     |
//!   +---------------+            +-------------------+
//! ```
//!
//! On the wire a window is `CASET` (2Ah) with first and last column, and `RASET` (2Bh) with first and last row,
//! 16 bits each, high byte first, both ends inside.

use core::fmt;

use mipidsi::dcs::{DcsCommand, SetAddressMode};
use mipidsi::options::{ColorOrder, Orientation, RefreshOrder, Rotation};

/// Column address set.
pub const CASET: u8 = 0x2a;
/// Row address set.
pub const RASET: u8 = 0x2b;
/// Memory write, from the window's first pixel.
pub const RAMWR: u8 = 0x2c;

/// The parameter of `MADCTL` (36h) for an orientation, as mipidsi sends it.
pub fn madctl(orientation: Orientation, order: ColorOrder) -> u8 {
    let mut parameter = [0];
    SetAddressMode::new(order, orientation, RefreshOrder::default())
        .fill_params_buf(&mut parameter);
    parameter[0]
}

/// The frame's place among the controller's addresses, in pixels, after the orientation is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// Address of the first column.
    pub left: u16,
    /// Address of the first row.
    pub top: u16,
    /// Columns.
    pub width: u16,
    /// Rows.
    pub height: u16,
}

impl Area {
    /// 320 x 240: a full ST7789 turned by 90 or 270 degrees.
    pub const LANDSCAPE: Area = Area { left: 0, top: 0, width: 320, height: 240 };
    /// 240 x 320: a full ST7789 upright.
    pub const PORTRAIT: Area = Area { left: 0, top: 0, width: 240, height: 320 };

    /// Glass of `glass` pixels at `offset` in a memory of `memory` pixels (all of them columns, rows, upright), as it is
    /// addressed in an orientation. The same as mipidsi's `display_size` and `display_offset`.
    ///
    /// `None` when the glass is not within the memory.
    pub fn of_glass(
        memory: (u16, u16),
        glass: (u16, u16),
        offset: (u16, u16),
        orientation: Orientation,
    ) -> Option<Area> {
        let spare_x = memory.0.checked_sub(glass.0)?.checked_sub(offset.0)?;
        let spare_y = memory.1.checked_sub(glass.1)?.checked_sub(offset.1)?;
        let Orientation { rotation, mirrored } = orientation;
        let mirror_x = matches!(rotation, Rotation::Deg90 | Rotation::Deg180) != mirrored;
        let mirror_y = matches!(rotation, Rotation::Deg180 | Rotation::Deg270);
        let left = if mirror_x { spare_x } else { offset.0 };
        let top = if mirror_y { spare_y } else { offset.1 };
        Some(if rotation.is_vertical() {
            Area { left: top, top: left, width: glass.1, height: glass.0 }
        } else {
            Area { left, top, width: glass.0, height: glass.1 }
        })
    }

    /// The window of `rows` rows of `width` columns from row `top` of the frame on, whose pixel (0, 0) is the
    /// area's.
    ///
    /// # Errors
    /// When the band is empty or not within the area.
    pub fn window(&self, top: u16, rows: u16, width: u16) -> Result<Window, Outside> {
        let outside = Outside { top, rows, width, area: (self.width, self.height) };
        let end = top.checked_add(rows).filter(|&end| rows > 0 && end <= self.height);
        if end.is_none() || width == 0 || width > self.width {
            return Err(outside);
        }
        let span = |first: u16, offset: u16, count: u16| {
            let start = first.checked_add(offset)?;
            Some([start, start.checked_add(count - 1)?])
        };
        let columns = span(self.left, 0, width).ok_or(outside)?;
        let rows = span(self.top, top, rows).ok_or(outside)?;
        Ok(Window { columns, rows })
    }
}

/// Part of the controller's memory; first and last address, both inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First and last column.
    pub columns: [u16; 2],
    /// First and last row.
    pub rows: [u16; 2],
}

impl Window {
    /// The parameters of `CASET`.
    pub fn caset(&self) -> [u8; 4] {
        big_endian(self.columns)
    }

    /// The parameters of `RASET`.
    pub fn raset(&self) -> [u8; 4] {
        big_endian(self.rows)
    }
}

fn big_endian([first, last]: [u16; 2]) -> [u8; 4] {
    let ([a, b], [c, d]) = (first.to_be_bytes(), last.to_be_bytes());
    [a, b, c, d]
}

/// A band is empty, or not within the display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outside {
    /// The band's first row.
    pub top: u16,
    /// Its rows.
    pub rows: u16,
    /// Its width.
    pub width: u16,
    /// Width and height of the area.
    pub area: (u16, u16),
}

impl fmt::Display for Outside {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Outside { top, rows, width, area } = self;
        write!(
            f,
            "a band of {width} x {rows} pixels from row {top} on does not fit a display of "
        )?;
        write!(f, "{} x {}; check the frame's size and the orientation", area.0, area.1)
    }
}

impl core::error::Error for Outside {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_inclusive_and_big_endian() {
        let window = Area { left: 1, top: 40, width: 320, height: 240 }.window(16, 16, 320);
        let window = window.unwrap();
        assert_eq!(window, Window { columns: [1, 320], rows: [56, 71] });
        assert_eq!(window.caset(), [0, 1, 1, 0x40]);
        assert_eq!(window.raset(), [0, 56, 0, 71]);
    }

    #[test]
    fn bands_outside_are_errors() {
        let area = Area::LANDSCAPE;
        assert!(area.window(239, 1, 320).is_ok());
        for (top, rows, width) in
            [(239, 2, 320), (0, 241, 1), (240, 1, 1), (0, 0, 1), (0, 1, 0), (0, 1, 321)]
        {
            assert!(area.window(top, rows, width).is_err(), "{top} {rows} {width}");
        }
        assert!(area.window(u16::MAX, 2, 1).is_err());
        let far = Area { left: u16::MAX, top: 0, width: 2, height: 1 };
        assert!(far.window(0, 1, 1).is_ok() && far.window(0, 1, 2).is_err());
    }

    #[test]
    fn glass_larger_than_the_memory_is_none() {
        let area = |glass, offset| Area::of_glass((240, 320), glass, offset, Orientation::new());
        assert!(area((241, 320), (0, 0)).is_none());
        assert!(area((240, 240), (0, 81)).is_none());
        assert_eq!(area((240, 320), (0, 0)), Some(Area::PORTRAIT));
    }

    #[test]
    fn address_mode_of_each_rotation() {
        let parameter = |rotation, order| madctl(Orientation::new().rotate(rotation), order);
        assert_eq!(parameter(Rotation::Deg0, ColorOrder::Rgb), 0x00);
        assert_eq!(parameter(Rotation::Deg90, ColorOrder::Rgb), 0x60);
        assert_eq!(parameter(Rotation::Deg180, ColorOrder::Bgr), 0xc8);
        assert_eq!(parameter(Rotation::Deg270, ColorOrder::Rgb), 0xa0);
    }
}
