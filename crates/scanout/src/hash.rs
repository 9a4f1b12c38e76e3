//! The frame hash: one number that says whether two machines drew the same picture.
//!
//! FNV-1a with 64 bits (Fowler, Noll, Vo; draft-eastlake-fnv): start at the offset basis, and for
//! each byte
//!
//! ```text
//! h = ((h xor byte) * 0x0000_0100_0000_01b3) mod 2^64          h starts at 0xcbf2_9ce4_8422_2325
//! ```
//!
//! over these bytes, in this order:
//!
//! | bytes | content |
//! |---|---|
//! | 2 | width in pixels, little-endian |
//! | 2 | height in pixels, little-endian |
//! | 1 | format: 1 = RGB888, 2 = RGB565, 3 = RGB332, 4 = mono |
//! | rest | the pixels, rows top to bottom, each left to right, nothing between rows |
//!
//! | format | pixel |
//! |---|---|
//! | RGB888 | 3 bytes: red, green, blue |
//! | RGB565 | 2 bytes, `rrrrrggg gggbbbbb`: big-endian, as an ST7789 receives them |
//! | RGB332 | 1 byte, `rrrgggbb` |
//! | mono | 8 pixels a byte, leftmost in the top bit; a row ends with zero bits to a whole byte |
//!
//! So firmware hashes what it sends to the display, and an RTL bench what leaves the scan-out, in
//! bands of any height.
//!
//! It finds mistakes, not attackers. Cost: one 64-bit multiplication a byte (the prime has three
//! groups of bits: a shift by 40 and a product with 0x1b3 do as well).
//!
//! # Test vectors
//!
//! | width x height, format | bytes after the header | hash |
//! |---|---|---|
//! | 2 x 1 RGB888, red and blue | `ff 00 00 00 00 ff` | `1b9c052a1e344dfb` |
//! | 2 x 1 RGB565, red and blue | `f8 00 00 1f` | `28ff8a2985620b71` |
//! | 2 x 1 RGB332, red and blue | `e0 03` | `eb9173fed6e279a2` |
//! | 10 x 2 mono, `#.#.#.#.#.` and `.........#` | `aa 80 00 40` | `52eee10369360b71` |
//! | 320 x 240 RGB565, black | 153,600 times `00` | `98b0add1cde3acc8` |

/// `format_id` of a frame with 3 bytes a pixel: red, green, blue.
pub const FORMAT_RGB888: u8 = 1;
/// `format_id` of a frame with 2 bytes a pixel, big-endian.
pub const FORMAT_RGB565: u8 = 2;
/// `format_id` of a frame with 1 byte a pixel.
pub const FORMAT_RGB332: u8 = 3;
/// `format_id` of a frame with 8 pixels a byte.
pub const FORMAT_MONO: u8 = 4;

/// The hash of a frame whose bytes arrive in pieces.
///
/// ```
/// use scanout::hash::{FORMAT_RGB332, FrameHash};
/// let mut hash = FrameHash::new(2, 1, FORMAT_RGB332);
/// hash.update(&[0xe0, 0x03]);
/// assert_eq!(hash.finish(), 0xeb91_73fe_d6e2_79a2);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameHash(u64);

impl FrameHash {
    /// The hash of a frame's header: size in pixels, and one of the `FORMAT_` numbers.
    #[must_use]
    pub const fn new(width: u16, height: u16, format_id: u8) -> Self {
        let ([w0, w1], [h0, h1]) = (width.to_le_bytes(), height.to_le_bytes());
        Self(fnv1a(0xcbf2_9ce4_8422_2325, &[w0, w1, h0, h1, format_id]))
    }

    /// Adds the next bytes of the frame, as many or few as are at hand.
    pub const fn update(&mut self, bytes: &[u8]) {
        self.0 = fnv1a(self.0, bytes);
    }

    /// The hash of everything so far.
    #[must_use]
    pub const fn finish(&self) -> u64 {
        self.0
    }
}

const fn fnv1a(mut hash: u64, bytes: &[u8]) -> u64 {
    let mut i = 0;
    while i < bytes.len() {
        hash = (hash ^ bytes[i] as u64).wrapping_mul(0x0000_0100_0000_01b3);
        i += 1;
    }
    hash
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_vectors_of_fnv1a() {
        let basis = 0xcbf2_9ce4_8422_2325;
        assert_eq!(fnv1a(basis, b""), basis);
        assert_eq!(fnv1a(basis, b"a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv1a(basis, b"foobar"), 0x8594_4171_f739_67e8);
    }

    #[test]
    fn frames() {
        // Computed with an independent program (Python's integers).
        let hash = |width, height, format, bytes: &[u8]| {
            let mut hash = FrameHash::new(width, height, format);
            hash.update(bytes);
            hash.finish()
        };
        assert_eq!(hash(2, 1, FORMAT_RGB888, &[255, 0, 0, 0, 0, 255]), 0x1b9c_052a_1e34_4dfb);
        assert_eq!(hash(2, 1, FORMAT_RGB565, &[0xf8, 0, 0, 0x1f]), 0x28ff_8a29_8562_0b71);
        assert_eq!(hash(2, 1, FORMAT_RGB332, &[0xe0, 0x03]), 0xeb91_73fe_d6e2_79a2);
        assert_eq!(hash(10, 2, FORMAT_MONO, &[0xaa, 0x80, 0, 0x40]), 0x52ee_e103_6936_0b71);
        let mut black = FrameHash::new(320, 240, FORMAT_RGB565);
        for _ in 0..240 {
            black.update(&[0; 640]);
        }
        assert_eq!(black.finish(), 0x98b0_add1_cde3_acc8);
    }
}
