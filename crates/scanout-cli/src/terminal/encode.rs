//! Pictures as bytes for a terminal.

use std::io::Write;

use super::Abilities;
use crate::image_out::Picture;

/// The picture no larger than `width` x `height`, proportions kept, each pixel the mean of those it covers.
pub fn shrunk(picture: &Picture, width: usize, height: usize) -> Picture {
    let (w, h) = (picture.width, picture.height);
    if w <= width && h <= height {
        return picture.clone();
    }
    // The tighter side decides: scale = min(width / w, height / h), compared without division.
    let (to_w, to_h) = if width * h <= height * w {
        (width, (h * width / w).max(1))
    } else {
        ((w * height / h).max(1), height)
    };
    resampled(picture, to_w, to_h)
}

/// The picture at exactly this size, each pixel the mean of those it covers.
fn resampled(picture: &Picture, width: usize, height: usize) -> Picture {
    let mut pixels = Vec::with_capacity(width * height);
    for y in 0..height {
        let rows = y * picture.height / height..((y + 1) * picture.height).div_ceil(height);
        for x in 0..width {
            let columns = x * picture.width / width..((x + 1) * picture.width).div_ceil(width);
            let mut sum = [0usize; 3];
            for row in rows.clone() {
                for pixel in &picture.pixels[row * picture.width..][columns.clone()] {
                    (0..3).for_each(|c| sum[c] += usize::from(pixel[c]));
                }
            }
            let count = rows.len() * columns.len();
            pixels.push(sum.map(|s| ((s + count / 2) / count) as u8));
        }
    }
    Picture { width, height, pixels }
}

/// The kitty graphics protocol: RGB in base64, at most 4096 bytes a piece; the terminal scales.
pub fn kitty(out: &mut Vec<u8>, picture: &Picture, terminal: &Abilities) {
    let (columns, rows) = (terminal.cells.0, terminal.cells.1.saturating_sub(2).max(1));
    let (need_w, need_h) =
        (picture.width.div_ceil(terminal.cell.0), picture.height.div_ceil(terminal.cell.1));
    let fit = if need_w <= columns && need_h <= rows {
        String::new()
    } else if columns * need_h <= rows * need_w {
        format!(",c={columns}")
    } else {
        format!(",r={rows}")
    };
    let text = base64(picture.pixels.as_flattened());
    let mut pieces = text.chunks(4096).peekable();
    let mut keys = format!("a=T,q=2,f=24,s={},v={}{fit},", picture.width, picture.height);
    while let Some(piece) = pieces.next() {
        let more = u8::from(pieces.peek().is_some());
        let _ = write!(out, "\x1b_G{keys}m={more};");
        out.extend_from_slice(piece);
        out.extend_from_slice(b"\x1b\\");
        keys.clear();
    }
    out.push(b'\n');
}

/// Base64 with padding (RFC 4648).
fn base64(bytes: &[u8]) -> Vec<u8> {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = Vec::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let mut word = [0; 4];
        word[1..=group.len()].copy_from_slice(group);
        let bits = u32::from_be_bytes(word);
        for digit in 0..4 {
            let index = bits >> (18 - 6 * digit) & 63;
            out.push(if digit <= group.len() { DIGITS[index as usize] } else { b'=' });
        }
    }
    out
}

/// Sixels: bands of six rows, a palette of 256 made for the picture.
pub fn sixel(out: &mut Vec<u8>, picture: &Picture, terminal: &Abilities) {
    let rows = terminal.cells.1.saturating_sub(2).max(1);
    let picture = shrunk(picture, terminal.cells.0 * terminal.cell.0, rows * terminal.cell.1);
    let (palette, indices) = palette(&picture);
    let (w, h) = (picture.width, picture.height);
    let _ = write!(out, "\x1bPq\"1;1;{w};{h}");
    for (i, rgb) in palette.iter().enumerate() {
        let [r, g, b] = rgb.map(|v| (u32::from(v) * 100 + 127) / 255);
        let _ = write!(out, "#{i};2;{r};{g};{b}");
    }
    for band in indices.chunks(6 * w) {
        let mut used = [false; 256];
        band.iter().for_each(|i| used[usize::from(*i)] = true);
        for colour in (0..=255u8).filter(|i| used[usize::from(*i)]) {
            let _ = write!(out, "#{colour}");
            let column = |x: usize| {
                let bits = band.iter().skip(x).step_by(w).enumerate();
                bits.fold(0, |bits, (row, i)| bits | u8::from(*i == colour) << row)
            };
            run_lengths(out, (0..w).map(column));
            out.push(b'$');
        }
        out.push(b'-');
    }
    out.extend_from_slice(b"\x1b\\");
}

/// Up to 256 colours, exact when the picture has no more, and each pixel's index.
fn palette(picture: &Picture) -> (Vec<[u8; 3]>, Vec<u8>) {
    let mut exact: Vec<[u8; 3]> = picture.pixels.clone();
    exact.sort_unstable();
    exact.dedup();
    if exact.len() <= 256 {
        let index = |pixel| exact.binary_search(pixel).unwrap_or_default() as u8;
        let indices = picture.pixels.iter().map(index).collect();
        return (exact, indices);
    }
    let rgba: Vec<u8> = picture.pixels.iter().flat_map(|p| [p[0], p[1], p[2], 255]).collect();
    let quantiser = color_quant::NeuQuant::new(10, 256, &rgba);
    let index = |pixel: &[u8]| quantiser.index_of(pixel) as u8;
    let indices = rgba.chunks_exact(4).map(index).collect();
    (crate::compare::triples(&quantiser.color_map_rgb()), indices)
}

/// Sixel characters with `!count` for runs longer than three.
fn run_lengths(out: &mut Vec<u8>, columns: impl Iterator<Item = u8>) {
    let mut columns = columns.peekable();
    while let Some(bits) = columns.next() {
        let mut count = 1;
        while columns.next_if_eq(&bits).is_some() {
            count += 1;
        }
        let character = b'?' + bits;
        if count > 3 {
            let _ = write!(out, "!{count}{}", char::from(character));
        } else {
            out.extend(std::iter::repeat_n(character, count));
        }
    }
}

/// Two pixels a character: the upper half block in the upper pixel's colour on the lower pixel's.
pub fn half_blocks(out: &mut Vec<u8>, picture: &Picture, terminal: &Abilities) {
    let rows = terminal.cells.1.saturating_sub(2).max(1);
    let picture = shrunk(picture, terminal.cells.0, 2 * rows);
    let black = vec![[0; 3]; picture.width];
    for pair in picture.pixels.chunks(2 * picture.width) {
        let (upper, lower) = pair.split_at(picture.width);
        let lower = if lower.is_empty() { &black } else { lower };
        let mut last = None;
        for (a, b) in upper.iter().zip(lower) {
            if last != Some((a, b)) {
                colours(out, *a, *b, terminal.colour24);
                last = Some((a, b));
            }
            out.extend_from_slice("\u{2580}".as_bytes());
        }
        out.extend_from_slice(b"\x1b[0m\n");
    }
}

fn colours(out: &mut Vec<u8>, front: [u8; 3], back: [u8; 3], colour24: bool) {
    let _ = if colour24 {
        let ([r, g, b], [s, h, c]) = (front, back);
        write!(out, "\x1b[38;2;{r};{g};{b};48;2;{s};{h};{c}m")
    } else {
        write!(out, "\x1b[38;5;{};48;5;{}m", xterm256(front), xterm256(back))
    };
}

/// The nearest of xterm's 256 colours: the 6 x 6 x 6 cube (16 - 231) or the greys 8, 18, ... 238 (232 - 255).
fn xterm256(rgb: [u8; 3]) -> u8 {
    const LEVELS: [u8; 6] = [0, 95, 135, 175, 215, 255];
    let distance = |other: [u8; 3]| -> u32 {
        (0..3).map(|c| u32::from(rgb[c].abs_diff(other[c])).pow(2)).sum()
    };
    let near = |v: u8| (0..6).min_by_key(|i| LEVELS[*i].abs_diff(v)).unwrap_or_default();
    let cube = rgb.map(near);
    let mean = rgb.iter().map(|v| u32::from(*v)).sum::<u32>() / 3;
    let grey = (mean.saturating_sub(3) / 10).min(23) as u8;
    if distance([8 + 10 * grey; 3]) < distance(cube.map(|i| LEVELS[i])) {
        232 + grey
    } else {
        (16 + 36 * cube[0] + 6 * cube[1] + cube[2]) as u8
    }
}

/// Characters of growing weight from the darkest to the brightest pixel; a character is about twice as high as wide. No control sequences at all.
pub fn ascii(out: &mut Vec<u8>, picture: &Picture, terminal: &Abilities) {
    const RAMP: &[u8] = b" .:-=+*#%@";
    let rows = terminal.cells.1.saturating_sub(2).max(1);
    // The last column stays free: some terminals wrap when it is written.
    let square = shrunk(picture, terminal.cells.0.saturating_sub(1).max(1), 2 * rows);
    let picture = resampled(&square, square.width, square.height.div_ceil(2));
    let luma = |p: &[u8; 3]| usize::from(scanout::output::luma(*p));
    let (low, high) =
        picture.pixels.iter().map(luma).fold((255, 0), |(l, h), v| (v.min(l), v.max(h)));
    for row in picture.rows() {
        let weigh = |p| RAMP[(luma(p) - low) * (RAMP.len() - 1) / (high - low).max(1)];
        let line: Vec<u8> = row.iter().map(weigh).collect();
        out.extend_from_slice(line.trim_ascii_end());
        out.push(b'\n');
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(encode: impl Fn(&mut Vec<u8>)) -> String {
        let mut out = Vec::new();
        encode(&mut out);
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn base64_of_rfc_4648() {
        let cases =
            [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")];
        for (plain, coded) in cases {
            assert_eq!(base64(plain.as_bytes()), coded.as_bytes());
        }
    }

    #[test]
    fn kitty_sends_pieces_and_ends_with_m_0() {
        let picture = Picture::filled(64, 32, [1, 2, 3]);
        let text = text(|out| kitty(out, &picture, &Abilities::UNKNOWN));
        assert!(text.starts_with("\x1b_Ga=T,q=2,f=24,s=64,v=32,m=1;AQIDAQID"));
        assert_eq!(text.matches("m=1;").count(), 1);
        assert_eq!(text.matches("\x1b_Gm=0;").count(), 1);
    }

    #[test]
    fn sixel_of_two_colours_is_exact() {
        let mut picture = Picture::filled(5, 7, [0, 0, 0]);
        picture.pixels[0] = [255, 0, 0];
        let text = text(|out| sixel(out, &picture, &Abilities::UNKNOWN));
        let expected = "\x1bPq\"1;1;5;7#0;2;0;0;0#1;2;100;0;0#0}!4~$#1@!4?$-#0!5@$-\x1b\\";
        assert_eq!(text, expected);
    }

    #[test]
    fn half_blocks_pair_rows() {
        let mut picture = Picture::filled(2, 3, [9, 9, 9]);
        picture.pixels[0] = [255, 0, 0];
        let terminal = Abilities { colour24: true, ..Abilities::UNKNOWN };
        let text = text(|out| half_blocks(out, &picture, &terminal));
        let expected = "\x1b[38;2;255;0;0;48;2;9;9;9m▀\x1b[38;2;9;9;9;48;2;9;9;9m▀\x1b[0m\n\
                        \x1b[38;2;9;9;9;48;2;0;0;0m▀▀\x1b[0m\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn xterm_colours_map_to_themselves() {
        assert_eq!(xterm256([0, 0, 0]), 16);
        assert_eq!(xterm256([255, 255, 255]), 231);
        assert_eq!(xterm256([95, 135, 175]), 67);
        assert_eq!(xterm256([238, 238, 238]), 255);
        assert_eq!(xterm256([8, 8, 8]), 232);
    }

    #[test]
    fn ascii_has_no_control_sequences() {
        let mut picture = Picture::filled(200, 100, [0; 3]);
        picture.pixels[..10_000].fill([255; 3]);
        let text = text(|out| ascii(out, &picture, &Abilities::UNKNOWN));
        assert!(text.chars().all(|c| c == '\n' || (' '..='~').contains(&c)));
        assert!(text.starts_with("@@@@"));
        assert!(text.lines().all(|line| line.len() < 80));
    }

    #[test]
    fn shrinking_keeps_proportions_and_the_mean() {
        let picture = Picture::filled(640, 480, [10, 20, 30]);
        let small = shrunk(&picture, 80, 44);
        assert_eq!((small.width, small.height), (58, 44));
        assert!(small.pixels.iter().all(|p| *p == [10, 20, 30]));
    }
}
