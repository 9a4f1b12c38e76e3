//! What is known of a camera: its file, and how it is found from pictures of a chessboard.

pub mod chessboard;
mod file;
pub mod zhang;

pub use file::{Calibration, CalibrationError};
