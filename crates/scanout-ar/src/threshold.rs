//! Adaptive threshold: which pixels are darker than their surroundings.
//!
//! ```text
//!  dark(x, y)  <=>  n (p(x, y) + margin) < sum of the n = (2 r + 1)^2 pixels around (x, y)
//! ```
//!
//! Integers only. Beyond the picture's edge its outermost pixels go on; the outermost rows and columns themselves are never dark, so
//! that nothing dark touches the edge. Cost: a sum of columns (one addition and one subtraction a pixel), a few additions of
//! those, one comparison.

use crate::image::GreyImage;

/// Greatest radius: a window's sum fits 16 bits.
pub const MOST_RADIUS: usize = 7;

/// Greatest margin, for the same reason.
pub const MOST_MARGIN: u8 = 32;

/// Words of a row of `width` bits.
pub const fn words(width: usize) -> usize {
    width.div_ceil(32)
}

/// Entries of working memory for a row of `width` pixels.
pub const fn columns(width: usize) -> usize {
    4 * (width + 2 * MOST_RADIUS)
}

/// Writes one bit a pixel, 1 = dark, the leftmost in a word's lowest bit, [`words`] words a row.
///
/// `radius` is 1 to [`MOST_RADIUS`]; `margin`, in grey levels up to [`MOST_MARGIN`], keeps noise in even areas from becoming dark;
/// `sums` is working memory of [`columns`] entries.
///
/// # Panics
/// When `bits` or `sums` is too short or `radius` or `margin` too large.
pub fn adaptive(image: &GreyImage, radius: usize, margin: u8, sums: &mut [u16], bits: &mut [u32]) {
    let (width, height) = (image.width(), image.height());
    let row_words = words(width);
    let bits = &mut bits[..row_words * height];
    if width < 3 || height < 3 {
        bits.fill(0);
        return;
    }
    assert!(radius <= MOST_RADIUS && margin <= MOST_MARGIN);
    // Column sums, with `radius` columns beyond each edge.
    let (sums, rest) = sums.split_at_mut(width + 2 * radius);
    sums.fill(0);
    let last = height - 1;
    for y in 0..=2 * radius {
        add(&mut sums[radius..][..width], image.row(y.saturating_sub(radius).min(last)));
    }
    let area = ((2 * radius + 1) * (2 * radius + 1)) as u16;
    for y in 0..height {
        if y > 0 {
            let (new, old) = ((y + radius).min(last), (y - 1).saturating_sub(radius));
            exchange(&mut sums[radius..][..width], image.row(new), image.row(old));
        }
        let to = &mut bits[y * row_words..][..row_words];
        if y == 0 || y == last {
            to.fill(0);
            continue;
        }
        let (first, end) = (sums[radius], sums[radius + width - 1]);
        sums[..radius].fill(first);
        sums[radius + width..].fill(end);
        let totals = windows(sums, 2 * radius + 1, rest, width);
        compare(image.row(y), totals, area, margin, to);
        to[0] &= !1;
        to[(width - 1) / 32] &= !(1 << ((width - 1) % 32));
    }
}

/// Sums of `count` neighbouring columns, the first for the window that begins at column 0. Sums of 1, 2, 4 and 8 columns are added up
/// as `count` has bits: a few additions of whole rows, which become vector instructions, where a running sum would be one chain.
fn windows<'a>(sums: &[u16], count: usize, rest: &'a mut [u16], width: usize) -> &'a [u16] {
    let length = sums.len();
    let (totals, rest) = rest.split_at_mut(width);
    let (mut from, rest) = rest.split_at_mut(length);
    let mut to = &mut rest[..length];
    from.copy_from_slice(sums);
    totals.fill(0);
    let (mut offset, mut size) = (0, 1);
    loop {
        if count & size != 0 {
            for (total, part) in totals.iter_mut().zip(&from[offset..]) {
                *total = total.wrapping_add(*part);
            }
            offset += size;
        }
        if 2 * size > count {
            return totals;
        }
        for ((to, a), b) in to.iter_mut().zip(&*from).zip(&from[size..]) {
            *to = a.wrapping_add(*b);
        }
        core::mem::swap(&mut from, &mut to);
        size *= 2;
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

/// One row of pixels against the sums of their windows.
///
/// All fits 16 bits: 255 * 225 and (255 + 32) * 225 are below 65,536. The pieces of 32 pixels are arrays so that the compiler makes
/// vector instructions of them; eight flags become eight bits by one multiplication.
fn compare(row: &[u8], totals: &[u16], area: u16, margin: u8, to: &mut [u32]) {
    let (pixels, rest) = row.as_chunks::<32>();
    let (windows, rest_windows) = totals.as_chunks::<32>();
    for ((to, pixels), windows) in to.iter_mut().zip(pixels).zip(windows) {
        *to = piece(pixels, windows, area, margin);
    }
    if !rest.is_empty() {
        // Beyond the row's end windows are empty, so that nothing is dark.
        let (mut pixels, mut windows) = ([0; 32], [0; 32]);
        pixels[..rest.len()].copy_from_slice(rest);
        windows[..rest.len()].copy_from_slice(rest_windows);
        to[row.len() / 32] = piece(&pixels, &windows, area, margin);
    }
}

fn piece(pixels: &[u8; 32], windows: &[u16; 32], area: u16, margin: u8) -> u32 {
    let mut flags = [0u8; 32];
    for i in 0..32 {
        let level = (u16::from(pixels[i]) + u16::from(margin)) * area;
        flags[i] = u8::from(level < windows[i]);
    }
    let mut dark = 0;
    for (i, eight) in flags.as_chunks::<8>().0.iter().enumerate() {
        let bits = u64::from_le_bytes(*eight).wrapping_mul(0x0102_0408_1020_4080) >> 56;
        dark |= (bits as u32) << (8 * i);
    }
    dark
}

/// A margin that noise seldom passes: from the picture's own noise, about a grey level and a half for each of its standard deviation,
/// 3 to 16.
///
/// The median of |a - 2 b + c| of neighbouring pixels, taken on a sixteenth of them, is 1.65 standard deviations of white noise and
/// hardly changed by edges.
pub fn margin(image: &GreyImage) -> u8 {
    let mut counts = [0u32; 64];
    let mut all = 0;
    for y in (0..image.height()).step_by(4) {
        for three in image.row(y).windows(3).step_by(4) {
            let [a, b, c] = [0, 1, 2].map(|i| i32::from(three[i]));
            counts[((a - 2 * b + c).unsigned_abs() as usize).min(63)] += 1;
            all += 1;
        }
    }
    let mut below = 0;
    let median = counts.iter().position(|&count| {
        below += count;
        2 * below >= all
    });
    (2 + median.unwrap_or(0)).clamp(3, 16) as u8
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
            (7, 50, 7, 32),
            (64, 5, 6, 1),
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

    #[test]
    fn the_margin_follows_noise_and_not_edges() {
        let mut seed = 9u32;
        let mut noisy = |amplitude: i32| {
            let pixels: Vec<u8> = (0..64 * 64)
                .map(|i| {
                    seed = seed.wrapping_mul(1664525).wrapping_add(1013904223);
                    let wall = if i % 16 < 8 { 60 } else { 180 };
                    (wall + (seed >> 24) as i32 * amplitude / 256 - amplitude / 2) as u8
                })
                .collect();
            margin(&GreyImage::new(64, 64, 64, &pixels).unwrap())
        };
        assert_eq!(noisy(0), 3);
        // 30 grey levels wide: a standard deviation of 8.7.
        assert!((9..=16).contains(&noisy(30)), "{}", noisy(30));
        assert_eq!(margin(&GreyImage::new(0, 0, 0, &[]).unwrap()), 3);
    }
}
