//! Errors as the user reads them: `subject: what; what to do`, on one line.

use std::fmt;
use std::io;
use std::path::Path;

/// Why a command failed.
#[derive(Debug)]
pub enum Error {
    /// The command line can't be obeyed: exit code 2.
    Usage(String),
    /// Something went wrong on the way: exit code 1.
    Failed(String),
    /// The reader of our output went away: that's its right, and no error.
    BrokenPipe,
    /// The command did its work and the answer is "no", already told (a picture that differs): exit code 1.
    Unequal,
}

/// What every command returns.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// A command line that can't be obeyed; `remedy` says what would.
    pub fn usage(what: impl fmt::Display, remedy: impl fmt::Display) -> Self {
        Self::Usage(format!("{what}; {remedy}"))
    }

    /// A failure concerning `subject`; `remedy` says what the user can do.
    pub fn failed(
        subject: impl fmt::Display,
        what: impl fmt::Display,
        remedy: impl fmt::Display,
    ) -> Self {
        Self::Failed(format!("{subject}: {what}; {remedy}"))
    }

    /// A failure to read or write `path`. A closed pipe becomes [`Error::BrokenPipe`].
    pub fn io(path: &Path, error: &io::Error) -> Self {
        let remedy = match error.kind() {
            io::ErrorKind::BrokenPipe => return Self::BrokenPipe,
            io::ErrorKind::NotFound => "check the path",
            io::ErrorKind::PermissionDenied => "check the permissions or choose another place",
            io::ErrorKind::StorageFull => "free some space or choose another place",
            io::ErrorKind::IsADirectory => "name a file, not a folder",
            _ => "check the file and try again",
        };
        let what = error.to_string();
        // The system's "(os error 2)" helps nobody.
        let what = what.split(" (os error").next().unwrap_or_default().to_lowercase();
        Self::failed(path.display(), what, remedy)
    }

    /// A failure to write to standard output.
    pub fn stdout(error: &io::Error) -> Self {
        Self::io(Path::new("standard output"), error)
    }

    /// The exit code: 0 fine, 1 failed or unequal, 2 not understood.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Failed(_) | Self::Unequal => 1,
            Self::BrokenPipe => 0,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usage(text) | Self::Failed(text) => f.write_str(text),
            Self::BrokenPipe => f.write_str("the reader went away"),
            Self::Unequal => f.write_str("the pictures differ"),
        }
    }
}

impl std::error::Error for Error {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_file_is_one_line_with_a_remedy() {
        let error = io::Error::from_raw_os_error(2);
        let text = Error::io(Path::new("a b.obj"), &error).to_string();
        assert_eq!(text, "a b.obj: no such file or directory; check the path");
    }

    #[test]
    fn a_closed_pipe_is_success() {
        let error = io::Error::from(io::ErrorKind::BrokenPipe);
        assert_eq!(Error::stdout(&error).exit_code(), 0);
    }
}
