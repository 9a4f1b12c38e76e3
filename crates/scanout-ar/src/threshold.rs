//! Adaptive threshold: which pixels are darker than their surroundings.
//!
//! ```text
//!  dark(x, y)  <=>  n (p(x, y) + margin) < sum of the n = (2 r + 1)^2 pixels around (x, y)
//! ```
//!
//! Integers only. Beyond the picture's edge its outermost pixels go on; the outermost rows and columns themselves are never dark, so
//! that nothing dark touches the edge. Cost: a sum of columns (one addition and one subtraction a pixel), a running sum of those,
//! one comparison.

use crate::image::GreyImage;

/// Greatest radius: sums of a column fit 16 bits.
pub const MOST_RADIUS: usize = 64;

/// Words of a row of `width` bits.
pub const fn words(width: usize) -> usize {
    width.div_ceil(32)
}

/// Columns of working memory for a row of `width` pixels.
pub const fn columns(width: usize) -> usize {
    width + 2 * MOST_RADIUS + 1
}

/// Writes one bit a pixel, 1 = dark, the leftmost in a word's lowest bit, [`words`] words a row.
///
/// `radius` is 1 to [`MOST_RADIUS`]; `margin`, in grey levels, keeps noise in even areas from becoming dark; `sums` is working
/// memory of [`columns`] entries.
///
/// # Panics
/// When `bits` or `sums` is too short or `radius` too large.
pub fn adaptive(image: &GreyImage, radius: usize, margin: u8, sums: &mut [u16], bits: &mut [u32]) {
    let (width, height) = (image.width(), image.height());
    let row_words = words(width);
    let bits = &mut bits[..row_words * height];
    if width < 3 || height < 3 {
        bits.fill(0);
        return;
    }
    assert!(radius <= MOST_RADIUS);
    // Column sums with `radius` columns beyond each edge, and one before.
    let sums = &mut sums[..width + 2 * radius + 1];
    sums.fill(0);
    let last = height - 1;
    for y in 0..=2 * radius {
        add(&mut sums[radius + 1..][..width], image.row(y.saturating_sub(radius).min(last)));
    }
    let area = ((2 * radius + 1) * (2 * radius + 1)) as u32;
    for y in 0..height {
        if y > 0 {
            let (new, old) = ((y + radius).min(last), (y - 1).saturating_sub(radius));
            exchange(&mut sums[radius + 1..][..width], image.row(new), image.row(old));
        }
        let to = &mut bits[y * row_words..][..row_words];
        if y == 0 || y == last {
            to.fill(0);
            continue;
        }
        let (first, end) = (sums[radius + 1], sums[radius + width]);
        sums[..=radius].fill(first);
        sums[radius + 1 + width..].fill(end);
        compare(image.row(y), sums, radius, area, margin, to);
        to[0] &= !1;
        to[(width - 1) / 32] &= !(1 << ((width - 1) % 32));
    }
}

fn add(sums: &mut [u16], row: &[u8]) {
    for (sum, &pixel) in sums.iter_mut().zip(row) {
        *sum += u16::from(pixel);
    }
}

fn exchange(sums: &mut [u16], new: &[u8], old: &[u8]) {
    for ((sum, &new), &old) in sums.iter_mut().zip(new).zip(old) {
        *sum = sum.wrapping_add(u16::from(new)).wrapping_sub(u16::from(old));
    }
}

/// One row: `sums[x]` to `sums[x + 2 radius + 1]` are the columns from one before the window of pixel x to its last.
fn compare(row: &[u8], sums: &[u16], radius: usize, area: u32, margin: u8, to: &mut [u32]) {
    let mut sum: u32 = sums[..=2 * radius].iter().map(|&sum| u32::from(sum)).sum();
    let (leaving, entering) = (sums, &sums[2 * radius + 1..]);
    let mut totals = [0u32; 32];
    for (word, to) in to.iter_mut().enumerate() {
        let start = word * 32;
        let row = &row[start..row.len().min(start + 32)];
        let (leaving, entering) = (&leaving[start..], &entering[start..]);
        for ((total, &old), &new) in totals.iter_mut().zip(leaving).zip(&entering[..row.len()]) {
            sum = sum.wrapping_add(u32::from(new)).wrapping_sub(u32::from(old));
            *total = sum;
        }
        let mut dark = 0;
        for (i, (&pixel, &total)) in row.iter().zip(&totals).enumerate() {
            dark |= u32::from((u32::from(pixel) + u32::from(margin)) * area < total) << i;
        }
        *to = dark;
    }
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;
    use std::vec;
    use std::vec::Vec;

    /// The definition, pixel by pixel.
    fn by_definition(image: &GreyImage, radius: i64, margin: u8) -> Vec<bool> {
        let (width, height) = (image.width() as i64, image.height() as i64);
        let at = |x: i64, y: i64| {
            u32::from(image.row(y.clamp(0, height - 1) as usize)[x.clamp(0, width - 1) as usize])
        };
        let dark = |x: i64, y: i64| {
            let window = (-radius..=radius)
                .flat_map(|dy| (-radius..=radius).map(move |dx| (dx, dy)))
                .map(|(dx, dy)| at(x + dx, y + dy));
            let n = (2 * radius + 1).pow(2) as u32;
            let inside = x > 0 && y > 0 && x < width - 1 && y < height - 1;
            inside && n * (at(x, y) + u32::from(margin)) < window.sum()
        };
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| dark(x, y)).collect()
    }

    #[test]
    fn equals_its_definition() {
        let mut seed = 1u32;
        for (width, height, radius, margin) in [
            (3, 3, 1, 0),
            (40, 9, 2, 7),
            (33, 31, 5, 3),
            (7, 50, 20, 7),
            (64, 5, 64, 1),
            (1, 9, 1, 0),
        ] {
            let pixels: Vec<u8> = (0..width * height)
                .map(|_| {
                    seed = seed.wrapping_mul(1664525).wrapping_add(1013904223);
                    (seed >> 24) as u8
                })
                .collect();
            let image = GreyImage::new(width, height, width, &pixels).unwrap();
            let mut bits = vec![u32::MAX; words(width) * height];
            adaptive(&image, radius, margin, &mut vec![9; columns(width)], &mut bits);
            let want = by_definition(&image, radius as i64, margin);
            for (i, want) in want.into_iter().enumerate() {
                let (x, y) = (i % width, i / width);
                let got = bits[y * words(width) + x / 32] >> (x % 32) & 1 == 1;
                assert_eq!(got, want && width > 2, "{width}x{height} r {radius}: {x} {y}");
            }
        }
    }
}
