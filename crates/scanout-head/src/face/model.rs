//! Model files: bytes in, numbers out, and a line about what is wrong.

use std::fmt;

/// Deepest tree that is read.
const DEEPEST: i32 = 12;

/// Most trees that are read; with leaves below 7 their sum in Q.16 fits 31 bits.
const MOST_TREES: i32 = 4096;

/// Why a file is not the model that was asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelError(String);

impl ModelError {
    pub(super) fn new(what: impl fmt::Display) -> Self {
        Self(what.to_string())
    }
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for ModelError {}

/// Little-endian numbers one after the other.
pub(super) struct Bytes<'a> {
    all: &'a [u8],
    at: usize,
}

impl<'a> Bytes<'a> {
    pub fn new(all: &'a [u8]) -> Self {
        Self { all, at: 0 }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], ModelError> {
        let from = self.all.get(self.at..).and_then(|rest| rest.first_chunk::<N>());
        let bytes = *from.ok_or_else(|| {
            ModelError::new(format_args!("it breaks off at byte {}", self.all.len()))
        })?;
        self.at += N;
        Ok(bytes)
    }

    pub fn int(&mut self) -> Result<i32, ModelError> {
        Ok(i32::from_le_bytes(self.take()?))
    }

    /// A number between -`limit` and `limit` as Q.16, to nearest.
    pub fn fixed(&mut self, limit: f32) -> Result<i32, ModelError> {
        let at = self.at;
        let value = f32::from_le_bytes(self.take()?);
        if value.is_nan() || value.abs() > limit {
            return Err(ModelError::new(format_args!(
                "byte {at}: {value} where a number up to {limit} is expected"
            )));
        }
        Ok((value * 65536.0).round() as i32)
    }

    /// A count between 1 and `most`.
    pub fn count(&mut self, most: i32, what: &str) -> Result<usize, ModelError> {
        let value = self.int()?;
        if !(1..=most).contains(&value) {
            return Err(ModelError::new(format_args!("{value} {what}; 1 to {most} are read")));
        }
        Ok(value as usize)
    }

    /// Depth of the trees.
    pub fn depth(&mut self) -> Result<u32, ModelError> {
        Ok(self.count(DEEPEST, "levels of a tree")? as u32)
    }

    /// Number of trees.
    pub fn trees(&mut self) -> Result<usize, ModelError> {
        self.count(MOST_TREES, "trees")
    }

    /// The comparisons of a tree's inner nodes, behind an unused one so that node 1 is the root and 2 n its child.
    pub fn comparisons(&mut self, depth: u32, to: &mut Vec<Comparison>) -> Result<(), ModelError> {
        to.push([0; 4]);
        for _ in 1..1usize << depth {
            to.push(self.take::<4>()?.map(|byte| byte as i8));
        }
        Ok(())
    }

    /// Checks, before anything is set aside for it, that `bytes` more are there, and no more.
    pub fn exactly(&self, bytes: usize) -> Result<(), ModelError> {
        let wanted = self.at + bytes;
        let got = self.all.len();
        if got != wanted {
            let what = if got < wanted { "it breaks off" } else { "something follows the model" };
            return Err(ModelError::new(format_args!("{what}: {got} bytes instead of {wanted}")));
        }
        Ok(())
    }
}

/// Two places whose pixels are compared: row and column of each, 1/256 of the box's side from its middle.
pub(super) type Comparison = [i8; 4];
