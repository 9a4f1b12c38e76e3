//! What is known of a camera: its file, and how it is found from pictures of a chessboard.

mod file;

pub use file::{Calibration, CalibrationError};
