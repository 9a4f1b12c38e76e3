//! Frames of a film, from wherever they come to wherever they go.
//!
//! | source | how it is named |
//! |---|---|
//! | a folder of PNG, JPEG, PPM or PGM pictures | its path; by name, in order |
//! | y4m, MJPEG (also inside AVI), PNG, JPEG, PPM and PGM, one or many in a row | a file's path, or `-` for standard input; told by content |
//! | a webcam (feature `webcam`) | `/dev/video0` |
//!
//! Sinks: y4m, MJPEG, PNG (one picture or a folder of them).
//!
//! A frame that can't be read is an error of that frame, and the next call goes on behind it; see [`VideoError::ends`].

mod convert;
mod error;
mod folder;
mod frame;
mod mjpeg;
mod picture;
mod ppm;
mod sink;
mod source;
#[cfg(feature = "webcam")]
mod webcam;
mod y4m_in;

pub use error::VideoError;
pub use frame::Frame;
pub use picture::{decode_picture, read_picture, write_png};
pub use sink::{Sink, SinkFormat};
pub use source::Source;
