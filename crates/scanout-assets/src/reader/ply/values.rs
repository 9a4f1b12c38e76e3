//! The body of a PLY file as a sequence of numbers.

use super::header::Kind;
use super::place;
use crate::error::At;
use crate::number::Number;

/// Takes one number after the other out of the body.
pub(super) struct Values<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u32,
    /// `None`: text.
    big_endian: Option<bool>,
}

impl<'a> Values<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize, line: u32, big_endian: Option<bool>) -> Self {
        Self { bytes, at, line, big_endian }
    }

    /// Where the last number stands.
    pub(super) fn at(&self) -> At {
        place(self.big_endian.is_none(), self.line, self.at)
    }

    /// The next number, or `None` when there is none.
    pub(super) fn number(&mut self, kind: Kind) -> Option<f64> {
        match self.big_endian {
            None => self.text(),
            Some(big_endian) => self.binary(kind, big_endian),
        }
    }

    fn text(&mut self) -> Option<f64> {
        while let Some(byte) = self.bytes.get(self.at).filter(|b| b.is_ascii_whitespace()) {
            self.line = self.line.saturating_add(u32::from(*byte == b'\n'));
            self.at += 1;
        }
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        let number = Number::parse(&rest[..length])?;
        self.at += length;
        Some(number.to_f64())
    }

    fn binary(&mut self, kind: Kind, big_endian: bool) -> Option<f64> {
        let size = kind.size();
        let mut bytes = [0; 8];
        bytes[..size].copy_from_slice(self.bytes.get(self.at..self.at + size)?);
        self.at += size;
        if big_endian {
            bytes[..size].reverse();
        }
        let [a, b, c, d, ..] = bytes;
        let whole = u32::from_le_bytes([a, b, c, d]);
        Some(match kind {
            Kind::I8 => f64::from(a as i8),
            Kind::U8 => f64::from(a),
            Kind::I16 => f64::from(whole as i16),
            Kind::U16 => f64::from(whole as u16),
            Kind::I32 => f64::from(whole as i32),
            Kind::U32 => f64::from(whole),
            Kind::F32 => f64::from(f32::from_bits(whole)),
            Kind::F64 => f64::from_le_bytes(bytes),
        })
    }
}
