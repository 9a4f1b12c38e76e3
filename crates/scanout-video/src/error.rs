//! What can go wrong, as a line that says where, what and what to do.

use std::fmt;
use std::io;
use std::path::Path;

/// Why there is no frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VideoError {
    text: String,
    ends: bool,
    broken_pipe: bool,
}

impl VideoError {
    /// One frame is lost; the next may be well.
    pub(crate) fn frame(name: &str, number: usize, what: impl fmt::Display) -> Self {
        let text = format!("{name}: frame {number}: {what}; it is left out");
        Self { text, ends: false, broken_pipe: false }
    }

    /// Nothing more comes from this source.
    pub(crate) fn end(name: &str, what: impl fmt::Display, remedy: &str) -> Self {
        Self { text: format!("{name}: {what}; {remedy}"), ends: true, broken_pipe: false }
    }

    /// A file or stream that can't be read or written.
    pub(crate) fn io(name: &str, error: &io::Error) -> Self {
        let remedy = match error.kind() {
            io::ErrorKind::NotFound => "check the path",
            io::ErrorKind::PermissionDenied => "check the permissions or choose another place",
            io::ErrorKind::StorageFull => "free some space or choose another place",
            _ => "check the file and try again",
        };
        let what = error.to_string().to_lowercase();
        // The system's "(os error 2)" helps nobody.
        let what = what.split(" (os error").next().unwrap_or_default().to_string();
        let broken_pipe = error.kind() == io::ErrorKind::BrokenPipe;
        Self { broken_pipe, ..Self::end(name, what, remedy) }
    }

    /// Is the source or sink finished? If not, only a frame was lost.
    pub fn ends(&self) -> bool {
        self.ends
    }

    /// Did the reader of our output go away?
    pub fn is_broken_pipe(&self) -> bool {
        self.broken_pipe
    }
}

impl fmt::Display for VideoError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

impl std::error::Error for VideoError {}

/// A path as messages show it.
pub(crate) fn name_of(path: &Path) -> String {
    if path.as_os_str() == "-" { "standard input".into() } else { path.display().to_string() }
}
