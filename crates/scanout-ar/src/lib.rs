//! Square markers in grey pictures: ArUco and AprilTag 36h11.
//!
//! ```text
//!  grey picture -> threshold -> contour -> quad -> edges -> decode -> pattern -> corners
//!                  \______ integers ______/   \______ floating point, a few a picture ___/
//! ```
//!
//! Everything works in the caller's memory, without allocator and operating system.
//!
//! # Conventions
//!
//! - **Pixel centres lie at .5**: the first pixel's centre is (0.5, 0.5), as everywhere in scanout. OpenCV's coordinates are ours
//!   minus 0.5; AprilTag's are ours.
//! - Corners: top left, top right, bottom right, bottom left of the upright marker, the outer corners of its black border.
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]

#[cfg(feature = "std")]
pub mod calibration;
pub mod contour;
pub mod decode;
pub mod detect;
pub mod dictionary;
pub mod edges;
pub mod homography;
pub mod image;
pub mod lens;
pub mod line;
pub mod near;
pub mod pattern;
pub mod pose;
pub mod quad;
pub mod solve;
pub mod threshold;

#[cfg(feature = "std")]
mod detector;

pub use detect::{Detection, Parameters};
#[cfg(feature = "std")]
pub use detector::Detector;
pub use dictionary::Dictionary;
pub use image::GreyImage;
pub use lens::Lens;
pub use pose::Pose;
