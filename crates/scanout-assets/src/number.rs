//! Decimal numbers of text files, exact until somebody chooses a binary format.
//!
//! A [`Number`] is `mantissa * 10^exponent`. It holds at most 18 significant digits; further digits are dropped, which
//! changes the value by less than one part in 10^17. `nan`, `inf` and anything else that is not a number is refused.

use core::fmt::Write;

/// A decimal number: `mantissa * 10^exponent`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Number {
    /// Signed digits, at most 18 of them.
    pub mantissa: i64,
    /// Power of ten.
    pub exponent: i32,
}

/// Digits kept; 10^18 < 2^63.
const DIGITS: u32 = 18;
/// Exponents are clamped to this, far outside f64's range, so that they never overflow.
const EXPONENT_LIMIT: u64 = 100_000;

impl Number {
    /// Reads `[+-] digits [. digits] [e [+-] digits]`, the whole of `text`; `None` when it is anything else.
    /// At least one digit must stand before or after the point.
    pub fn parse(text: &[u8]) -> Option<Self> {
        let (negative, mut rest) = sign(text);
        let mut mantissa = 0i64;
        let mut kept = 0;
        let mut exponent = 0i64;
        let mut any = false;
        let mut after_point = false;
        while let [byte, tail @ ..] = rest {
            match byte {
                b'0'..=b'9' => {
                    any = true;
                    if kept < DIGITS {
                        mantissa = mantissa * 10 + i64::from(byte - b'0');
                        kept += u32::from(mantissa != 0);
                        exponent -= i64::from(after_point);
                    } else {
                        exponent += i64::from(!after_point);
                    }
                }
                b'.' if !after_point => after_point = true,
                b'e' | b'E' => break,
                _ => return None,
            }
            rest = tail;
        }
        if !any {
            return None;
        }
        if let [_, tail @ ..] = rest {
            let (down, digits) = sign(tail);
            let power = whole(digits)?.min(EXPONENT_LIMIT) as i64;
            exponent += if down { -power } else { power };
        }
        let limit = EXPONENT_LIMIT as i64;
        let exponent = exponent.clamp(-limit, limit) as i32;
        let mantissa = if negative { -mantissa } else { mantissa };
        Some(Self { mantissa, exponent: if mantissa == 0 { 0 } else { exponent } })
    }

    /// The nearest `f64` (correctly rounded); a value too large gives an infinity.
    pub fn to_f64(self) -> f64 {
        // Both factors are exact here, so the one operation rounds once.
        if self.mantissa.unsigned_abs() < 1 << 53 && (-22..=22).contains(&self.exponent) {
            let power = POWERS[self.exponent.unsigned_abs() as usize];
            let mantissa = self.mantissa as f64;
            return if self.exponent < 0 { mantissa / power } else { mantissa * power };
        }
        let mut text = Text { bytes: [0; 40], length: 0 };
        // 20 + 1 + 8 characters at most: the buffer can't overflow, and the grammar is Rust's.
        let _ = write!(text, "{}e{}", self.mantissa, self.exponent);
        core::str::from_utf8(&text.bytes[..text.length])
            .ok()
            .and_then(|t| t.parse().ok())
            .unwrap_or(0.0)
    }

    /// The nearest Q16.16 (ties upwards), saturated to `i32`. Integers only: for machines without an FPU.
    pub fn to_q16(self) -> i32 {
        const MOST: i64 = 1 << 15;
        let digits = self.exponent.unsigned_abs();
        let value = match self.exponent {
            0.. => {
                // 19 digits are beyond the range.
                let whole = (0..digits.min(19)).fold(self.mantissa, |m, _| m.saturating_mul(10));
                whole.clamp(-MOST, MOST) << 16
            }
            -15.. => {
                let power = 10i64.pow(digits);
                let whole = self.mantissa.div_euclid(power).clamp(-MOST - 1, MOST);
                // 16 bits of the fraction, one a step: below 2^51 each time.
                let mut rest = self.mantissa.rem_euclid(power);
                let mut value = whole;
                for _ in 0..16 {
                    rest *= 2;
                    value = 2 * value + i64::from(rest >= power);
                    rest -= if rest >= power { power } else { 0 };
                }
                value + i64::from(2 * rest >= power)
            }
            // 10^n / 2^16 = 5^n 2^(n - 16), below 2^61.
            -23.. => {
                let divisor = 5i64.pow(digits) << (digits - 16);
                let rest = self.mantissa.rem_euclid(divisor);
                self.mantissa.div_euclid(divisor) + i64::from(2 * rest >= divisor)
            }
            // |mantissa| < 10^18, so it rounds to zero.
            _ => 0,
        };
        value.clamp(i32::MIN.into(), i32::MAX.into()) as i32
    }
}

/// A number of digits alone, saturated; `None` when there is none or something else.
pub fn whole(digits: &[u8]) -> Option<u64> {
    if digits.is_empty() {
        return None;
    }
    digits.iter().try_fold(0u64, |value, digit| {
        let digit = digit.is_ascii_digit().then(|| u64::from(digit - b'0'))?;
        Some(value.saturating_mul(10).saturating_add(digit))
    })
}

/// Whether it begins with a minus, and what follows the sign, if there is one.
pub(crate) fn sign(text: &[u8]) -> (bool, &[u8]) {
    match text {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        _ => (false, text),
    }
}

/// 10^0 to 10^22, the powers of ten that `f64` holds exactly.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

struct Text {
    bytes: [u8; 40],
    length: usize,
}

impl Write for Text {
    fn write_str(&mut self, s: &str) -> core::fmt::Result {
        let end = self.length + s.len();
        self.bytes.get_mut(self.length..end).ok_or(core::fmt::Error)?.copy_from_slice(s.as_bytes());
        self.length = end;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn q(text: &str) -> i32 {
        Number::parse(text.as_bytes()).unwrap().to_q16()
    }

    #[test]
    fn whole_numbers_are_those_of_the_standard_library() {
        for text in [
            "0",
            "007",
            "4294967296",
            "18446744073709551615",
            "",
            "-1",
            "1.",
            "1e0",
            " 1",
            "1 ",
            "0x1",
        ] {
            assert_eq!(whole(text.as_bytes()), text.parse().ok(), "{text}");
        }
        for text in ["18446744073709551616", "18446744073709551620", "99999999999999999999999"] {
            assert_eq!(whole(text.as_bytes()), Some(u64::MAX), "{text}");
        }
        assert_eq!(whole(b"99999999999999999999999x"), None);
    }

    /// The definition in 128 bits.
    fn q16_exact(number: Number) -> i32 {
        let scaled = i128::from(number.mantissa) << 16;
        let value = match number.exponent {
            0.. => scaled * 10i128.pow(number.exponent.min(14) as u32),
            ..=-30 => 0,
            negative => {
                let power = 10i128.pow(negative.unsigned_abs());
                (2 * scaled + power).div_euclid(2 * power)
            }
        };
        value.clamp(i32::MIN.into(), i32::MAX.into()) as i32
    }

    #[test]
    fn q16_is_exact() {
        let mut seed = 3u64;
        let mut random = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            seed >> 4
        };
        for i in 0..30_000 {
            let size = 10u64.pow((random() % 19) as u32);
            let mut mantissa = (random() % size) as i64;
            if i % 5 == 0 {
                // Halves of a step, and what is next to them.
                mantissa = (2 * (mantissa % 60_000) + 1) * 762_939_453_125 + i % 3 - 1;
            }
            for mantissa in [mantissa, -mantissa] {
                for exponent in -32..20 {
                    let number =
                        Number { mantissa: mantissa % 1_000_000_000_000_000_000, exponent };
                    assert_eq!(number.to_q16(), q16_exact(number), "{number:?}");
                }
            }
        }
    }

    #[test]
    fn agrees_with_the_standard_library() {
        for text in [
            "0",
            "-0",
            "1",
            "+1",
            ".5",
            "5.",
            "-.25",
            "1e3",
            "1E-3",
            "1e+3",
            "0.1",
            "123456789.123456789",
            "3.14159265358979323846264338327950288",
            "1e308",
            "1e-320",
            "00012.5000",
            "1e400",
            "-1e-400",
            "100000000000000000000000",
            "0.000000000000000000000000000001234",
            "9007199254740993",
        ] {
            let ours = Number::parse(text.as_bytes()).unwrap().to_f64();
            let theirs: f64 = text.parse().unwrap();
            assert_eq!(ours, theirs, "{text}");
        }
    }

    #[test]
    fn refuses_what_is_no_number() {
        for text in [
            "", "+", "-", ".", "e5", "1e", "1e+", "nan", "inf", "-inf", "1.#QNAN", "1.2.3", "1,5",
            "0x10", "1f", "--1", "1e5.0",
        ] {
            assert_eq!(Number::parse(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn q16_rounds_to_nearest_and_saturates() {
        assert_eq!(q("1"), 65536);
        assert_eq!(q("-1.5"), -98304);
        assert_eq!(q("0.00000762939453125"), 1); // half a step goes up
        assert_eq!(q("-0.00000762939453125"), 0);
        assert_eq!(q("0.0000076"), 0);
        assert_eq!(q("32768"), i32::MAX);
        assert_eq!(q("-32768"), i32::MIN);
        assert_eq!(q("1e99999999999"), i32::MAX);
        assert_eq!(q("-1e400"), i32::MIN);
        assert_eq!(q("1e-400"), 0);
        assert_eq!(q("999999999999999999e-18"), 65536);
        assert_eq!(q("999999999999999999e-30"), 0);
    }
}
