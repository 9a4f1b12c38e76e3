//! Errors and warnings of the loader: one line each, with the place and the remedy.

use std::fmt;

/// What kind of failure it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LoadErrorKind {
    /// The operating system did not give the file.
    Io,
    /// The content violates its format.
    Malformed,
    /// The content is well-formed but uses what this reader does not read.
    Unsupported,
    /// The content exceeds [`crate::Limits`].
    TooLarge,
    /// There is nothing to draw.
    Empty,
}

/// Where in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// The file as a whole.
    File,
    /// A line, from 1.
    Line(u32),
    /// A byte, from 0.
    Byte(u64),
}

/// Why a file could not be loaded. `Display` is one line: `file:line: what is wrong; what to do`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadError {
    /// The kind of failure.
    pub kind: LoadErrorKind,
    /// The file, as the caller named it.
    pub file: String,
    /// The place in it.
    pub at: At,
    /// What is wrong; what to do.
    pub what: String,
}

impl LoadError {
    /// A malformed file.
    pub(crate) fn malformed(file: &str, at: At, what: impl Into<String>) -> Self {
        Self { kind: LoadErrorKind::Malformed, file: file.into(), at, what: what.into() }
    }

    /// A feature this reader lacks.
    pub(crate) fn unsupported(file: &str, at: At, what: impl Into<String>) -> Self {
        Self { kind: LoadErrorKind::Unsupported, file: file.into(), at, what: what.into() }
    }

    /// More than the limits allow.
    pub(crate) fn too_large(file: &str, what: impl Into<String>) -> Self {
        Self { kind: LoadErrorKind::TooLarge, file: file.into(), at: At::File, what: what.into() }
    }
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A file name may contain a line feed; the message stays one line.
        let file = self.file.replace(|c: char| c.is_control(), "?");
        match self.at {
            At::File => write!(f, "{file}: {}", self.what),
            At::Line(line) => write!(f, "{file}:{line}: {}", self.what),
            At::Byte(byte) => write!(f, "{file}: byte {byte}: {}", self.what),
        }
    }
}

impl std::error::Error for LoadError {}

/// How much a [`Warning`] matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WarningLevel {
    /// A choice was made that the user may want to know.
    Note,
    /// The picture may differ from what the file's author saw.
    Warning,
}

/// Something that did not prevent loading. `Display` is one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// How much it matters.
    pub level: WarningLevel,
    /// What happened.
    pub text: String,
    /// How often.
    pub count: u64,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)?;
        if self.count > 1 { write!(f, " ({} times)", self.count) } else { Ok(()) }
    }
}

/// Distinct warnings kept; a hostile file can't fill memory with them.
const KEPT: usize = 64;

/// Collects warnings and counts repeated ones.
#[derive(Debug, Default)]
pub(crate) struct Warnings(pub(crate) Vec<Warning>);

impl Warnings {
    pub(crate) fn warn(&mut self, text: impl Into<String>) {
        self.add(WarningLevel::Warning, 1, text.into());
    }

    pub(crate) fn note(&mut self, text: impl Into<String>) {
        self.add(WarningLevel::Note, 1, text.into());
    }

    /// A warning that happened `count` times; nothing when that is 0.
    pub(crate) fn counted(&mut self, count: u64, text: impl Into<String>) {
        if count > 0 {
            self.add(WarningLevel::Warning, count, text.into());
        }
    }

    fn add(&mut self, level: WarningLevel, count: u64, text: String) {
        let text = if self.0.len() < KEPT {
            text.replace(|c: char| c.is_control(), "?")
        } else {
            "further warnings are not shown".into()
        };
        match self.0.iter_mut().find(|w| w.text == text) {
            Some(known) => known.count += count,
            None => self.0.push(Warning { level, text, count }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_one_line() {
        let error = LoadError::malformed("a\nb.obj", At::Line(3), "bad; mend it");
        assert_eq!(error.to_string(), "a?b.obj:3: bad; mend it");
        let error = LoadError::malformed("a.stl", At::Byte(80), "bad");
        assert_eq!(error.to_string(), "a.stl: byte 80: bad");
    }

    #[test]
    fn warnings_are_counted_and_bounded() {
        let mut warnings = Warnings::default();
        for _ in 0..10 {
            warnings.warn("same");
        }
        for i in 0..1000 {
            warnings.warn(format!("other {i}"));
        }
        assert_eq!(warnings.0[0].to_string(), "same (10 times)");
        assert_eq!(warnings.0.len(), KEPT + 1);
        assert_eq!(warnings.0[KEPT].count, 1000 - 63);
    }
}
