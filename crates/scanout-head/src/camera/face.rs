//! The viewer's face: the rays to both pupils, and depth from how far eyes are apart.
//!
//! ```text
//!  rays (x / z, y / z) to the pupils: a, b        depth = eye distance / |b - a|        place = depth ((a + b) / 2, 1)
//! ```
//!
//! That is right for a head that faces the camera's plane. One that is turned aside by an angle seems farther away, by one part in its
//! cosine: 1.5 % at 10 degrees, 6 % at 20. The places aside and above change alike.

use scanout_video::Frame;

use super::{Find, Mount, Sight};
use crate::V3;
use crate::face::{self, BOX, Cascade, Grey, Localiser};

/// The nearest and the farthest viewer, mm from the camera.
pub const DISTANCES: [f64; 2] = [200.0, 1500.0];

/// Finds the eyes of a face.
pub struct FaceFinder {
    finder: face::Finder,
    eye_distance: f64,
    sight: Sight,
    mount: Mount,
    grey: Vec<u8>,
}

impl FaceFinder {
    /// With these models, for a viewer whose pupils are `eye_distance` mm apart (63 for most grown people).
    pub fn new(
        cascade: Cascade,
        localiser: Localiser,
        eye_distance: f64,
        sight: Sight,
        mount: Mount,
    ) -> Self {
        let finder = face::Finder::new(cascade, localiser);
        Self { finder, eye_distance, sight, mount, grey: Vec::new() }
    }
}

impl Find for FaceFinder {
    /// The middle between the eyes.
    fn find(&mut self, frame: &Frame) -> Option<V3> {
        let lens = self.sight.lens(frame.width, frame.height)?;
        frame.grey(&mut self.grey);
        let grey = Grey::new(&self.grey, frame.width)?;
        let [near, far] = DISTANCES.map(|z| BOX * self.eye_distance * lens.focal[0] / z);
        let eyes = self.finder.find(&grey, [far, near])?;
        let [a, b] = eyes.pupils.map(|pupil| lens.ray(pupil));
        let depth = self.eye_distance / libm::hypot(b[0] - a[0], b[1] - a[1]);
        let place = [(a[0] + b[0]) / 2.0 * depth, (a[1] + b[1]) / 2.0 * depth, depth];
        place.iter().all(|x| x.is_finite()).then(|| self.mount.to_viewer(place))
    }
}
