//! Adaptive threshold: which pixels are darker than their surroundings.
//!
//! ```text
//!  mean(X, Y) = floor((S + n - 1) k / 65536),   S = sum of the n = (2 r + 1)^2 pixels around (X, Y) of the picture at half size,
//!                                               k = ceil(65536 / n): nearly S / n rounded up
//!  dark(x, y)  <=>  p(x, y) + margin < mean(x / 2, y / 2)
//! ```
//!
//! Blocks of 2 x 2 pixels share a window, which the halved picture holds in a quarter of the pixels. Integers only. Beyond the
//! picture's edge its outermost pixels go on; the outermost rows and columns themselves are never dark, so that nothing dark touches
//! the edge. Cost: for a pixel of the halved picture an addition and a subtraction for the sums of columns, and 2 r + 1 additions of
//! those; for a pixel one comparison. All of it in pieces of 32 pixels, which become vector instructions.

use crate::image::GreyImage;

/// Greatest radius: a window's sum fits 16 bits.
pub const MOST_RADIUS: usize = 7;

/// Columns of the halved picture in a piece, whose pixels fill a word of bits.
const PIECE: usize = 16;

/// Words of a row of `width` bits.
pub const fn words(width: usize) -> usize {
    width.div_ceil(32)
}

/// Entries of working memory for pictures of `width` pixels.
pub const fn columns(width: usize) -> usize {
    words(width) * PIECE + 2 * MOST_RADIUS
}

/// Writes one bit a pixel, 1 = dark, the leftmost in a word's lowest bit, [`words`] words a row.
///
/// `half` is `image` halved by [`crate::image::halve`]. `RADIUS` is 1 to [`MOST_RADIUS`], in pixels of `half`; `margin`, in grey
/// levels, keeps noise in even areas from becoming dark; `sums` is working memory of [`columns`] entries.
///
/// # Panics
/// When `bits` or `sums` is too short or `half` has another size.
pub fn adaptive<const RADIUS: usize>(
    image: &GreyImage,
    half: &GreyImage,
    margin: u8,
    sums: &mut [u16],
    bits: &mut [u32],
) {
    const { assert!(RADIUS >= 1 && RADIUS <= MOST_RADIUS) }
    let (width, height) = (image.width(), image.height());
    let row_words = words(width);
    let bits = &mut bits[..row_words * height];
    if width < 3 || height < 3 {
        bits.fill(0);
        return;
    }
    assert!((half.width(), half.height()) == (width / 2, height / 2));
    // Column sums, with `RADIUS` columns beyond each edge.
    let sums = &mut sums[..row_words * PIECE + 2 * RADIUS];
    sums.fill(0);
    let (columns, last) = (width / 2, height / 2 - 1);
    for y in 0..=2 * RADIUS {
        add(&mut sums[RADIUS..][..columns], half.row(y.saturating_sub(RADIUS).min(last)));
    }
    for y in 0..=last {
        if y > 0 {
            let (new, old) = ((y + RADIUS).min(last), (y - 1).saturating_sub(RADIUS));
            exchange(&mut sums[RADIUS..][..columns], half.row(new), half.row(old));
        }
        let (first, end) = (sums[RADIUS], sums[RADIUS + columns - 1]);
        sums[..RADIUS].fill(first);
        sums[RADIUS + columns..].fill(end);
        // An odd last row of the picture belongs to the last one of the half.
        let rows = if y == last { 2 * y..height } else { 2 * y..2 * y + 2 };
        let to = &mut bits[rows.start * row_words..rows.end * row_words];
        for piece in 0..row_words {
            let levels = levels::<RADIUS>(&sums[PIECE * piece..], margin);
            for (row, to) in rows.clone().zip(to.chunks_exact_mut(row_words)) {
                to[piece] = compare(&image.row(row)[32 * piece..], &levels);
            }
        }
    }
    for (y, row) in bits.chunks_exact_mut(row_words).enumerate() {
        if y == 0 || y == height - 1 {
            row.fill(0);
        }
        row[0] &= !1;
        row[(width - 1) / 32] &= !(1 << ((width - 1) % 32));
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

/// The levels below which the 32 pixels of a piece are dark, from the sums of its columns and of those beside it.
fn levels<const RADIUS: usize>(sums: &[u16], margin: u8) -> [u8; 2 * PIECE] {
    let area = const { ((2 * RADIUS + 1) * (2 * RADIUS + 1)) as u16 };
    let reciprocal = const { 65536usize.div_ceil((2 * RADIUS + 1) * (2 * RADIUS + 1)) as u16 };
    let sums = &sums[..PIECE + 2 * RADIUS];
    // At most 225 pixels of 255, and 224: below 65,536.
    let mut totals = [area - 1; PIECE];
    for first in 0..=2 * RADIUS {
        for i in 0..PIECE {
            totals[i] = totals[i].wrapping_add(sums[first + i]);
        }
    }
    let levels = totals.map(|total| {
        let mean = ((u32::from(total) * u32::from(reciprocal)) >> 16) as u16;
        mean.saturating_sub(margin.into()) as u8
    });
    core::array::from_fn(|i| levels[i / 2])
}

/// Up to 32 pixels against their levels.
fn compare(row: &[u8], levels: &[u8; 2 * PIECE]) -> u32 {
    let piece = if cfg!(any(target_arch = "x86_64", target_arch = "aarch64")) {
        compare_by_vectors
    } else {
        compare_by_words
    };
    match row.first_chunk() {
        Some(pixels) => piece(pixels, levels),
        None => {
            // Beyond the row's end nothing is dark.
            let mut pixels = [255; 2 * PIECE];
            pixels[..row.len()].copy_from_slice(row);
            piece(&pixels, levels)
        }
    }
}

/// The highest bits of eight bytes; the first byte's becomes the lowest.
fn highest_bits(bytes: u64) -> u32 {
    ((bytes & HIGH).wrapping_mul(0x0002_0408_1020_4081) >> 56) as u32
}

const HIGH: u64 = 0x8080_8080_8080_8080;

/// For machines whose vector instructions saturate: a byte's difference that isn't 0 sets its highest bit.
fn compare_by_vectors(pixels: &[u8; 2 * PIECE], levels: &[u8; 2 * PIECE]) -> u32 {
    let mut flags = [0u8; 2 * PIECE];
    for i in 0..2 * PIECE {
        flags[i] = levels[i].saturating_sub(pixels[i]).saturating_add(127);
    }
    let eights = flags.as_chunks().0.iter().enumerate();
    eights.fold(0, |dark, (i, eight)| dark | highest_bits(u64::from_le_bytes(*eight)) << (8 * i))
}

/// For others: eight bytes of a word at once. Their highest bits are set aside, so that no difference borrows from its neighbour.
fn compare_by_words(pixels: &[u8; 2 * PIECE], levels: &[u8; 2 * PIECE]) -> u32 {
    let eights = pixels.as_chunks().0.iter().zip(levels.as_chunks().0).enumerate();
    eights.fold(0, |dark, (i, (pixels, levels))| {
        let (p, level) = (u64::from_le_bytes(*pixels), u64::from_le_bytes(*levels));
        let not_below = (p | HIGH) - (level & !HIGH);
        dark | highest_bits((!p & level) | !((p ^ level) | not_below)) << (8 * i)
    })
}

/// A margin that noise seldom passes: from the picture's own noise, about a grey level and a half for each of its standard deviation,
/// 3 to 16.
///
/// The median of |a - 2 b + c| of neighbouring pixels, taken at a thirty-second of them, is 1.65 standard deviations of white noise
/// and hardly changed by edges.
pub fn margin(image: &GreyImage) -> u8 {
    let mut counts = [0u32; 64];
    let mut all = 0;
    for y in (0..image.height()).step_by(8) {
        let fours = image.row(y).as_chunks::<4>().0;
        for &[a, b, c, _] in fours {
            let second = i32::from(a) - 2 * i32::from(b) + i32::from(c);
            counts[(second.unsigned_abs() as usize).min(63)] += 1;
        }
        all += fours.len() as u32;
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
    use crate::image::halve;
    use std::vec;
    use std::vec::Vec;

    type Adaptive = fn(&GreyImage, &GreyImage, u8, &mut [u16], &mut [u32]);

    /// The definition, pixel by pixel.
    fn by_definition(image: &GreyImage, half: &GreyImage, radius: i64, margin: u8) -> Vec<bool> {
        let (width, height) = (image.width() as i64, image.height() as i64);
        let (columns, rows) = (half.width() as i64, half.height() as i64);
        let at = |x: i64, y: i64| {
            u32::from(half.row(y.clamp(0, rows - 1) as usize)[x.clamp(0, columns - 1) as usize])
        };
        let dark = |x: i64, y: i64| {
            let (middle, line) = (x / 2, (y / 2).min(rows - 1));
            let window = (-radius..=radius)
                .flat_map(|dy| (-radius..=radius).map(move |dx| (dx, dy)))
                .map(|(dx, dy)| at(middle + dx, line + dy));
            let n = (2 * radius + 1).pow(2) as u32;
            let mean = (window.sum::<u32>() + n - 1) * 65536u32.div_ceil(n) / 65536;
            let inside = x > 0 && y > 0 && x < width - 1 && y < height - 1;
            inside && u32::from(image.row(y as usize)[x as usize]) + u32::from(margin) < mean
        };
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| dark(x, y)).collect()
    }

    #[test]
    fn equals_its_definition() {
        let mut seed = 1u32;
        let mut check = |radius, margin, width, height, adaptive: Adaptive| {
            let pixels: Vec<u8> = (0..width * height)
                .map(|_| {
                    seed = seed.wrapping_mul(1664525).wrapping_add(1013904223);
                    (seed >> 24) as u8
                })
                .collect();
            let image = GreyImage::new(width, height, width, &pixels).unwrap();
            let mut half = vec![0; (width / 2) * (height / 2)];
            halve(&image, &mut half);
            let half = GreyImage::new(width / 2, height / 2, width / 2, &half).unwrap();
            let mut bits = vec![u32::MAX; words(width) * height];
            adaptive(&image, &half, margin, &mut vec![9; columns(width)], &mut bits);
            if width < 3 {
                assert!(bits.iter().all(|&word| word == 0));
                return;
            }
            let want = by_definition(&image, &half, radius, margin);
            for (i, want) in want.into_iter().enumerate() {
                let (x, y) = (i % width, i / width);
                let got = bits[y * words(width) + x / 32] >> (x % 32) & 1 == 1;
                assert_eq!(got, want, "{width}x{height} r {radius}: {x} {y}");
            }
        };
        check(1, 0, 3, 3, adaptive::<1>);
        check(1, 0, 1, 9, adaptive::<1>);
        check(2, 7, 40, 9, adaptive::<2>);
        check(4, 3, 33, 31, adaptive::<4>);
        check(7, 32, 7, 50, adaptive::<7>);
        check(6, 1, 64, 5, adaptive::<6>);
        check(3, 255, 65, 6, adaptive::<3>);
    }

    #[test]
    fn both_comparisons_are_one() {
        let all: Vec<[u8; 2]> = (0..=255).flat_map(|p| (0..=255).map(move |q| [p, q])).collect();
        for pairs in all.as_chunks::<32>().0 {
            let (pixels, levels) = (pairs.map(|pair| pair[0]), pairs.map(|pair| pair[1]));
            let want = (0..32).fold(0, |bits, i| bits | u32::from(pixels[i] < levels[i]) << i);
            assert_eq!(compare_by_vectors(&pixels, &levels), want);
            assert_eq!(compare_by_words(&pixels, &levels), want);
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
