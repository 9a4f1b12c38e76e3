//! The head-tracked window: the screen is a hole into the scene, and the viewer's own position decides what is seen
//! through it (system C's title). Two pictures, one an eye, make it stereo.
//!
//! ```text
//!  source --sample--> calibration -> One Euro filter -> prediction -> glide --eye, mm--> screen --> off-axis camera
//!  (network, recording, hand)        \________________ tracker ________________/                    (crate scanout)
//! ```
//!
//! | module | does |
//! |---|---|
//! | [`screen`] | the physical screen; an eye before it to a camera |
//! | [`source`] | who moves the viewer: the interface |
//! | [`manual`], [`opentrack`], [`recording`] | hand, network, files |
//! | `camera` (feature `camera`) | the viewer's face, or a marker on cap or glasses, seen by a camera |
//! | [`face`] | a face and its pupils in a picture |
//! | [`one_euro`] | steady when the head rests, quick when it moves |
//! | [`tracker`] | from samples to the eye of the next picture; a lost face glides back |
//! | [`latency`] | from input to picture, measured |
//! | [`stereo`] | two eyes in one picture, exact integers that hardware repeats |
//! | [`room`] | system C's room: a box of lines behind the glass with the cube in it |
//!
//! # Conventions
//!
//! Millimetres and seconds. **Viewer's coordinates**: the origin is the middle of the screen, x to the right, y upwards (against
//! gravity), z out of the screen towards the viewer, so that the viewer is at z > 0 and what lies behind the glass at z < 0.
//! The eye's position drives the picture, never the angles of the head.
//!
//! What it will not do: curved screens, lens distortion of head-mounted displays, gaze.

#![cfg_attr(not(any(feature = "std", test)), no_std)]
#![forbid(unsafe_code)]

pub mod one_euro;
pub mod room;
pub mod screen;
pub mod stereo;

#[cfg(feature = "camera")]
pub mod camera;
#[cfg(feature = "std")]
pub mod face;
#[cfg(feature = "std")]
pub mod latency;
#[cfg(feature = "std")]
pub mod manual;
#[cfg(feature = "std")]
pub mod opentrack;
#[cfg(feature = "std")]
pub mod recording;
#[cfg(feature = "std")]
pub mod source;
#[cfg(feature = "std")]
pub mod tracker;

/// Three numbers: a place or a direction.
pub type V3 = [f64; 3];
