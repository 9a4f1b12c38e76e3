//! Palettes of textures: the colours of a picture brought down to 16 or 256.
//!
//! 1. Median cut (Heckbert 1982): the box of colours with the largest sum of squared distances from its mean is cut at the mean of the
//!    channel that varies most, until there are enough boxes.
//! 2. k-means (Lloyd): each texel goes to its nearest colour, each colour to the mean of its texels, at most twelve times.
//!
//! Distances are squared differences of 8-bit R, G, B. Integers alone, so a picture has one palette on every machine. Colours are kept as
//! RGB565, as the pipeline reads them; a picture of no more colours than fit keeps exactly those.

use std::collections::BTreeMap;

use scanout::output::widen565;

use crate::model::Image;

/// How a baked texture is stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TextureFormat {
    /// Two bytes a texel.
    #[default]
    Rgb565,
    /// A byte a texel and 256 colours.
    Palette256,
    /// Half a byte a texel and 16 colours.
    Palette16,
}

impl TextureFormat {
    /// Colours of the palette, if it has one.
    pub fn colours(self) -> Option<usize> {
        match self {
            Self::Rgb565 => None,
            Self::Palette256 => Some(256),
            Self::Palette16 => Some(16),
        }
    }
}

/// A picture with a palette.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Paletted {
    /// Colours, RGB565; as many as were asked for, the last ones black where fewer are used.
    pub palette: Vec<u16>,
    /// One a texel of all levels.
    pub indices: Vec<u8>,
    /// Colours that are used.
    pub used: usize,
    /// Sum over all texels and channels of the squared difference from the picture, 8 bits a channel.
    pub squares: u64,
}

impl Paletted {
    /// Root of the mean squared difference from the picture, 8-bit steps a channel.
    pub fn error(&self) -> f64 {
        (self.squares as f64 / (3 * self.indices.len().max(1)) as f64).sqrt()
    }
}

type Rgb = [u8; 3];

fn distance(a: Rgb, b: Rgb) -> u64 {
    (0..3).map(|k| u64::from(a[k].abs_diff(b[k])).pow(2)).sum()
}

/// The nearest RGB565, and back to 8 bits.
fn pack([r, g, b]: Rgb) -> u16 {
    let scale = |c: u8, most: u16| (u16::from(c) * most + 127) / 255;
    scale(r, 31) << 11 | scale(g, 63) << 5 | scale(b, 31)
}

/// Colours and how often each occurs.
type Histogram = [(Rgb, u64)];

/// Counts, sums and squares of a box of colours.
struct Spread {
    count: u64,
    sum: [u64; 3],
    /// Sum of squared distances from the mean, a channel.
    squares: [u64; 3],
}

impl Spread {
    fn of(colours: &Histogram) -> Self {
        let (mut count, mut sum, mut square) = (0, [0; 3], [0; 3]);
        for (rgb, n) in colours {
            count += n;
            for k in 0..3 {
                sum[k] += n * u64::from(rgb[k]);
                square[k] += n * u64::from(rgb[k]).pow(2);
            }
        }
        // sum (x - mean)^2 = sum x^2 - (sum x)^2 / n; 128 bits since sums are squared.
        let squares = [0, 1, 2].map(|k| {
            square[k] - (u128::from(sum[k]).pow(2) / u128::from(u64::max(count, 1))) as u64
        });
        Self { count, sum, squares }
    }

    fn mean(&self) -> Rgb {
        self.sum.map(|sum| ((sum + self.count / 2) / self.count.max(1)) as u8)
    }
}

/// Cuts the colours into at most `most` boxes and gives their means.
fn median_cut(colours: &mut Histogram, most: usize) -> Vec<Rgb> {
    let mut boxes = vec![colours];
    while boxes.len() < most {
        let worst = (0..boxes.len())
            .filter(|&i| boxes[i].len() > 1)
            .max_by_key(|&i| Spread::of(boxes[i]).squares.iter().sum::<u64>());
        let Some(worst) = worst else { break };
        let whole = boxes.swap_remove(worst);
        let spread = Spread::of(whole);
        let channel = (0..3).max_by_key(|&k| spread.squares[k]).unwrap_or(0);
        whole.sort_unstable_by_key(|(rgb, _)| (rgb[channel], *rgb));
        let mean = spread.sum[channel] / spread.count.max(1);
        // Both halves have a colour: the least is not above the mean, the greatest is above or alone.
        let at = whole.partition_point(|(rgb, _)| u64::from(rgb[channel]) <= mean);
        let (low, high) = whole.split_at_mut(at.clamp(1, whole.len() - 1));
        boxes.extend([low, high]);
    }
    boxes.iter().map(|colours| Spread::of(colours).mean()).collect()
}

fn nearest(palette: &[Rgb], rgb: Rgb) -> usize {
    (0..palette.len()).min_by_key(|&i| (distance(palette[i], rgb), i)).unwrap_or(0)
}

impl Image {
    /// The picture, all levels, with a palette of `most` colours, 1 to 256.
    #[must_use]
    pub fn to_palette(&self, most: usize) -> Paletted {
        let most = most.clamp(1, 256);
        let mut exact: Vec<u16> = self.rgb.iter().map(|&rgb| pack(rgb)).collect();
        exact.sort_unstable();
        exact.dedup();
        if exact.len() > most {
            exact = self.few_colours(most);
        }
        let used = exact.len();
        let wide: Vec<Rgb> = exact.iter().map(|&colour| widen565(colour)).collect();
        let mut known = BTreeMap::new();
        let mut squares = 0;
        let indices = self.rgb.iter().map(|&rgb| {
            // A picture of few colours keeps its own RGB565.
            let index = *known.entry(rgb).or_insert_with(|| {
                exact.binary_search(&pack(rgb)).unwrap_or_else(|_| nearest(&wide, rgb))
            });
            squares += distance(wide[index], rgb);
            index as u8
        });
        let indices = indices.collect();
        exact.resize(most, 0);
        Paletted { palette: exact, indices, used, squares }
    }

    /// At most `most` colours, RGB565, in ascending order.
    fn few_colours(&self, most: usize) -> Vec<u16> {
        let mut counts = BTreeMap::new();
        for &rgb in &self.rgb {
            *counts.entry(rgb).or_insert(0u64) += 1;
        }
        let mut colours: Vec<(Rgb, u64)> = counts.into_iter().collect();
        let mut palette = median_cut(&mut colours, most);
        for _ in 0..12 {
            let mut groups: Vec<Vec<(Rgb, u64)>> = vec![Vec::new(); palette.len()];
            for &(rgb, n) in &colours {
                groups[nearest(&palette, rgb)].push((rgb, n));
            }
            let means = groups
                .iter()
                .zip(&palette)
                .map(|(group, &old)| if group.is_empty() { old } else { Spread::of(group).mean() });
            let means: Vec<Rgb> = means.collect();
            if means == palette {
                break;
            }
            palette = means;
        }
        let mut packed: Vec<u16> = palette.into_iter().map(pack).collect();
        packed.sort_unstable();
        packed.dedup();
        packed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(rgb: Vec<Rgb>) -> Image {
        Image { name: "t".into(), width: rgb.len() as u16, height: 1, levels: 1, rgb }
    }

    #[test]
    fn few_colours_are_kept() {
        let colours = [[255, 0, 0], [0, 255, 0], [0, 0, 255], [8, 8, 8]];
        let image = image((0..100).map(|i| colours[i * i % 4]).collect());
        let paletted = image.to_palette(16);
        assert_eq!(paletted.palette.len(), 16);
        assert_eq!(paletted.used, 2, "squares modulo 4 are 0 and 1");
        let back: Vec<u16> =
            paletted.indices.iter().map(|&i| paletted.palette[usize::from(i)]).collect();
        assert_eq!(back, image.to_rgb565());
    }

    /// Better than the same number of evenly spaced colours, and not worse with more.
    #[test]
    fn colours_go_where_the_picture_has_them() {
        let image = image(
            (0..4096u32)
                .map(|i| [(i / 16) as u8, (i / 32) as u8 + 20, (i * 7 % 64) as u8])
                .collect(),
        );
        let error = |most| image.to_palette(most).error();
        let even: u64 = image
            .rgb
            .iter()
            .map(|&rgb| {
                let cut = |v: u8, levels: u32| {
                    ((u32::from(v) * levels / 256 * 2 + 1) * 128 / levels) as u8
                };
                distance(rgb, [cut(rgb[0], 4), cut(rgb[1], 2), cut(rgb[2], 2)])
            })
            .sum();
        let even = (even as f64 / (3 * 4096) as f64).sqrt();
        assert!(error(16) < even / 2.0, "{} against {even}", error(16));
        let errors = [2, 4, 16, 64, 256].map(error);
        assert!(errors.windows(2).all(|pair| pair[1] < pair[0]), "{errors:?}");
        assert_eq!(image.to_palette(16), image.to_palette(16));
    }

    #[test]
    fn one_colour_is_the_mean() {
        let paletted = image(vec![[0; 3], [248, 252, 248]]).to_palette(1);
        assert_eq!((paletted.used, paletted.indices), (1, vec![0, 0]));
        assert_eq!(widen565(paletted.palette[0]).map(|c| c / 16), [7, 7, 7]);
    }
}
