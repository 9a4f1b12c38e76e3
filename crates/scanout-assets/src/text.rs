//! Messages without `core::fmt`, whose machinery takes 9 KB of a microcontroller's flash: a template, values for its gaps, and whoever
//! takes the bytes.
//!
//! Errors of this crate have `tell` beside `Display`; both say the same, since the latter is made of the former.
//!
//! ```
//! use scanout_assets::text::{Value, fill};
//! let mut line: Vec<u8> = Vec::new();
//! fill("line %: '%' at %", &[Value::Number(7), Value::Escaped(b"x\xff"), Value::Hex(255)], &mut |piece| line.extend(piece));
//! assert_eq!(line, b"line 7: 'x\\xff' at 0xff");
//! ```
//!
//! What it will not do: widths, signs, fractions.

use core::fmt;

/// Takes a message's bytes, UTF-8, piece by piece; no piece ends inside a character that began in it.
pub type Sink<'s> = &'s mut dyn FnMut(&[u8]);

/// What stands in a gap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Value<'v> {
    /// Text as it is.
    Text(&'v str),
    /// Bytes of whatever kind, as `<[u8]>::escape_ascii` writes them.
    Escaped(&'v [u8]),
    /// A decimal number.
    Number(usize),
    /// A hexadecimal number, `0x` before it.
    Hex(usize),
}

/// Hands on `template`, each `%` in it replaced by the next of `values`; by nothing when there are fewer.
pub fn fill(template: &str, values: &[Value<'_>], to: Sink<'_>) {
    let mut values = values.iter();
    for (index, piece) in template.as_bytes().split(|&byte| byte == b'%').enumerate() {
        if index > 0
            && let Some(value) = values.next()
        {
            value.write(to);
        }
        to(piece);
    }
}

impl Value<'_> {
    fn write(self, to: Sink<'_>) {
        match self {
            Value::Text(text) => to(text.as_bytes()),
            Value::Escaped(bytes) => bytes.iter().for_each(|&byte| escape(byte, to)),
            Value::Number(number) => digits(number, 10, to),
            Value::Hex(number) => {
                to(b"0x");
                digits(number, 16, to);
            }
        }
    }
}

fn digit(value: usize) -> u8 {
    let value = value as u8;
    value + if value < 10 { b'0' } else { b'a' - 10 }
}

fn digits(mut number: usize, base: usize, to: Sink<'_>) {
    // 2^64 has 20 digits.
    let (mut digits, mut first) = ([0; 20], 20);
    while first == 20 || number > 0 {
        first -= 1;
        digits[first] = digit(number % base);
        number /= base;
    }
    to(&digits[first..]);
}

fn escape(byte: u8, to: Sink<'_>) {
    match byte {
        b'\t' => to(b"\\t"),
        b'\r' => to(b"\\r"),
        b'\n' => to(b"\\n"),
        b'\'' | b'"' | b'\\' => to(&[b'\\', byte]),
        b' '..=b'~' => to(&[byte]),
        _ => to(&[b'\\', b'x', digit((byte >> 4).into()), digit((byte & 15).into())]),
    }
}

/// What `tell` says, for implementations of `Display`.
///
/// # Errors
/// The formatter's.
pub fn display(f: &mut fmt::Formatter<'_>, tell: impl FnOnce(Sink<'_>)) -> fmt::Result {
    let mut result = Ok(());
    tell(&mut |piece| {
        if result.is_ok() {
            result = core::str::from_utf8(piece).map_or(Err(fmt::Error), |text| f.write_str(text));
        }
    });
    result
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;

    fn filled(template: &str, values: &[Value<'_>]) -> String {
        let mut text = Vec::new();
        fill(template, values, &mut |piece| text.extend(piece));
        String::from_utf8(text).unwrap()
    }

    #[test]
    fn numbers_are_those_of_format() {
        for n in [0, 7, 10, 99, 100, 65_536, u32::MAX as usize, usize::MAX] {
            assert_eq!(filled("%", &[Value::Number(n)]), format!("{n}"));
            assert_eq!(filled("<%>", &[Value::Hex(n)]), format!("<{n:#x}>"));
        }
    }

    #[test]
    fn bytes_are_escaped_as_the_library_does() {
        let all: Vec<u8> = (0..=255).collect();
        assert_eq!(filled("%", &[Value::Escaped(&all)]), all.escape_ascii().to_string());
    }

    #[test]
    fn gaps_may_stand_anywhere() {
        let (a, b) = (Value::Text("ä"), Value::Text("b"));
        assert_eq!(filled("%, ö%", &[a, b]), "ä, öb");
        assert_eq!(filled("%%", &[a]), "ä");
        assert_eq!(filled("", &[a]), "");
    }
}
