//! Other people's drawing on a band: an embedded-graphics `DrawTarget` over its colour memory.
//!
//! The target says that it has the whole frame's size, and keeps what falls on its rows. So text or a meter is drawn at
//! the frame's coordinates on each band, and the bands put together hold it as if it was drawn on the whole frame.
//!
//! ```text
//!   (0, 0) +--------------------------+
//!          |                          |
//!   top  > |======= 12 tri/s =========|   the rows in memory
//!          |======= (lower half) =====|   text at y = top + 10 is cut here and goes on in the next band
//!          |                          |
//!          +--------------------------+ size
//! ```
//!
//! Drawing is repeated for each band: keep it small, or ask [`BandTarget::rows`] first. Solid and contiguous fills
//! work row by row on slices. What it will not do: blend; depth is not looked at.

use core::convert::Infallible;
use core::ops::Range;

use embedded_graphics_core::Pixel;
use embedded_graphics_core::geometry::{OriginDimensions, Point, Size};
use embedded_graphics_core::pixelcolor::Rgb565;
use embedded_graphics_core::prelude::{DrawTarget, IntoStorage};
use embedded_graphics_core::primitives::Rectangle;

/// A band's colour memory as a target.
#[derive(Debug)]
pub struct BandTarget<'m> {
    colour: &'m mut [u16],
    size: (u16, u16),
    rows: Range<u16>,
}

impl<'m> BandTarget<'m> {
    /// Rows of RGB565 pixels from row `top` of a frame of `size` (width, height) on; as many as `colour` holds whole.
    pub fn new(colour: &'m mut [u16], size: (u16, u16), top: u16) -> Self {
        let rows = colour.len() / (size.0 as usize).max(1);
        let end = (top as usize + rows).min(size.1 as usize) as u16;
        BandTarget { colour, size, rows: top.min(end)..end }
    }

    /// The rows of the frame that are here.
    pub fn rows(&self) -> Range<u16> {
        self.rows.clone()
    }

    /// The rectangle that is here.
    pub fn visible(&self) -> Rectangle {
        let size = Size::new(self.size.0 as u32, self.rows.len() as u32);
        Rectangle::new(Point::new(0, self.rows.start as i32), size)
    }

    /// Memory of `width` pixels from (x, y) on, which must be visible.
    fn span(&mut self, x: i32, y: i32, width: u32) -> &mut [u16] {
        let row = (y - self.rows.start as i32) as usize * self.size.0 as usize;
        &mut self.colour[row + x as usize..][..width as usize]
    }
}

impl OriginDimensions for BandTarget<'_> {
    fn size(&self) -> Size {
        Size::new(self.size.0 as u32, self.size.1 as u32)
    }
}

impl DrawTarget for BandTarget<'_> {
    type Color = Rgb565;
    type Error = Infallible;

    fn draw_iter<I>(&mut self, pixels: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Pixel<Rgb565>>,
    {
        let visible = self.visible();
        for Pixel(point, colour) in pixels {
            if visible.contains(point) {
                self.span(point.x, point.y, 1)[0] = colour.into_storage();
            }
        }
        Ok(())
    }

    fn fill_contiguous<I>(&mut self, area: &Rectangle, colours: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Rgb565>,
    {
        let part = area.intersection(&self.visible());
        if part.is_zero_sized() {
            return Ok(());
        }
        let mut colours = colours.into_iter();
        let skip = |colours: &mut I::IntoIter, count: usize| {
            if count > 0 {
                colours.nth(count - 1);
            }
        };
        let left = part.top_left.x.abs_diff(area.top_left.x) as usize;
        let right = area.size.width as usize - left - part.size.width as usize;
        let above = part.top_left.y.abs_diff(area.top_left.y) as usize;
        skip(&mut colours, above.saturating_mul(area.size.width as usize));
        for y in part.rows() {
            skip(&mut colours, left);
            let span = self.span(part.top_left.x, y, part.size.width);
            // The span first: zip then takes no colour beyond its end.
            for (pixel, colour) in span.iter_mut().zip(&mut colours) {
                *pixel = colour.into_storage();
            }
            skip(&mut colours, right);
        }
        Ok(())
    }

    fn fill_solid(&mut self, area: &Rectangle, colour: Rgb565) -> Result<(), Infallible> {
        let part = area.intersection(&self.visible());
        for y in part.rows() {
            self.span(part.top_left.x, y, part.size.width).fill(colour.into_storage());
        }
        Ok(())
    }

    fn clear(&mut self, colour: Rgb565) -> Result<(), Infallible> {
        self.fill_solid(&self.visible(), colour)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics::mono_font::MonoTextStyle;
    use embedded_graphics::mono_font::ascii::FONT_6X10;
    use embedded_graphics::prelude::*;
    use embedded_graphics::primitives::{Circle, Line, PrimitiveStyle};
    use embedded_graphics::text::Text;

    const SIZE: (u16, u16) = (64, 40);
    const PIXELS: usize = 64 * 40;

    /// Text across every border, shapes that leave the frame on each side.
    fn draw(target: &mut BandTarget<'_>) {
        let style = MonoTextStyle::new(&FONT_6X10, Rgb565::YELLOW);
        for (x, y) in [(-3, 6), (5, 17), (40, 25), (2, 41)] {
            Text::new("Frame 27!", Point::new(x, y), style).draw(target).unwrap();
        }
        let line = PrimitiveStyle::with_stroke(Rgb565::CYAN, 2);
        Line::new(Point::new(-9, 50), Point::new(80, -5)).into_styled(line).draw(target).unwrap();
        let fill = PrimitiveStyle::with_fill(Rgb565::RED);
        Circle::new(Point::new(50, 10), 21).into_styled(fill).draw(target).unwrap();
        let colours = (0u16..).map(|i| Rgb565::from(RawU16::new(i.wrapping_mul(40503))));
        let area = Rectangle::new(Point::new(-4, -3), Size::new(20, 12));
        target.fill_contiguous(&area, colours.take(240)).unwrap();
        target
            .fill_solid(&Rectangle::new(Point::new(60, 3), Size::new(9, 99)), Rgb565::GREEN)
            .unwrap();
    }
    use embedded_graphics::pixelcolor::raw::RawU16;

    #[test]
    fn bands_together_are_the_whole() {
        let mut whole = [7; PIXELS];
        draw(&mut BandTarget::new(&mut whole, SIZE, 0));
        for lines in [1, 7, 16, 40] {
            let mut bands = [7; PIXELS];
            for (i, band) in bands.chunks_mut(64 * lines).enumerate() {
                draw(&mut BandTarget::new(band, SIZE, (i * lines) as u16));
            }
            assert!(whole == bands, "bands of {lines} lines");
        }
        assert!(whole.contains(&7) && whole.contains(&0x07e0));
    }

    /// The fast fills are what their pixels one by one are.
    #[test]
    fn fills_are_their_pixels() {
        for top in [0, 5, 30] {
            for (x, y, w, h) in [(0, 0, 64, 40), (-5, 3, 20, 9), (60, 28, 9, 40), (-9, -9, 4, 4)] {
                let area = Rectangle::new(Point::new(x, y), Size::new(w, h));
                let colours = || (1u16..).map(|i| Rgb565::from(RawU16::new(i)));
                let (mut fast, mut slow) = ([0; 64 * 10], [0; 64 * 10]);
                BandTarget::new(&mut fast, SIZE, top).fill_contiguous(&area, colours()).unwrap();
                let pixels = area.points().zip(colours()).map(|(p, c)| Pixel(p, c));
                BandTarget::new(&mut slow, SIZE, top).draw_iter(pixels).unwrap();
                assert!(fast == slow, "{area:?} at {top}");
                BandTarget::new(&mut fast, SIZE, top).fill_solid(&area, Rgb565::BLUE).unwrap();
                let pixels = area.points().map(|p| Pixel(p, Rgb565::BLUE));
                BandTarget::new(&mut slow, SIZE, top).draw_iter(pixels).unwrap();
                assert!(fast == slow, "solid {area:?} at {top}");
            }
        }
    }

    #[test]
    fn odd_memory_is_cut_to_the_frame() {
        let mut colour = [0; 64 * 3 + 5];
        assert_eq!(BandTarget::new(&mut colour, SIZE, 2).rows(), 2..5);
        assert_eq!(BandTarget::new(&mut colour, SIZE, 39).rows(), 39..40);
        assert_eq!(BandTarget::new(&mut colour, SIZE, 500).rows(), 40..40);
        let mut none = BandTarget::new(&mut colour, (0, 0), 0);
        assert_eq!(none.clear(Rgb565::RED), Ok(()));
        assert_eq!(colour, [0; 64 * 3 + 5]);
    }
}
