//! Between R, G, B and Y, U, V (Rec. 601): integers with 8 fraction bits, rounded to nearest.

/// Y, U, V of limited range (black 16, white 235) or full range to R, G, B.
pub fn to_rgb(y: u8, u: u8, v: u8, full: bool) -> [u8; 3] {
    let (u, v) = (i32::from(u) - 128, i32::from(v) - 128);
    let sums = if full {
        let y = 256 * i32::from(y);
        [y + 359 * v, y - 88 * u - 183 * v, y + 454 * u]
    } else {
        let y = 298 * (i32::from(y) - 16);
        [y + 409 * v, y - 100 * u - 208 * v, y + 516 * u]
    };
    sums.map(|sum| ((sum + 128) >> 8).clamp(0, 255) as u8)
}

/// R, G, B to Y, U, V of limited range.
pub fn to_yuv([r, g, b]: [u8; 3]) -> [u8; 3] {
    let (r, g, b) = (i32::from(r), i32::from(g), i32::from(b));
    [
        ((66 * r + 129 * g + 25 * b + 128) >> 8) + 16,
        ((-38 * r - 74 * g + 112 * b + 128) >> 8) + 128,
        ((112 * r - 94 * g - 18 * b + 128) >> 8) + 128,
    ]
    .map(|x| x.clamp(0, 255) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        for rgb in [[0; 3], [255; 3], [200, 30, 90], [10, 250, 128], [128; 3]] {
            let [y, u, v] = to_yuv(rgb);
            let back = to_rgb(y, u, v, false);
            assert!((0..3).all(|i| rgb[i].abs_diff(back[i]) <= 3), "{rgb:?} {back:?}");
        }
        assert_eq!(to_rgb(255, 128, 128, true), [255; 3]);
        assert_eq!(to_rgb(235, 128, 128, false), [255; 3]);
        assert_eq!(to_rgb(0, 255, 255, false)[1], 0);
    }
}
