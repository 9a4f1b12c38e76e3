//! A marker on the viewer's cap or glasses.

use scanout_ar::pose::track::Track;
use scanout_ar::{Detector, Dictionary, GreyImage};
use scanout_video::Frame;

use super::{Find, Mount, Sight};
use crate::V3;

/// What is worn.
#[derive(Clone, Copy, Debug)]
pub struct Marker {
    /// Its dictionary.
    pub dictionary: Dictionary,
    /// Its number.
    pub id: u16,
    /// Side of its black square, mm.
    pub size: f64,
}

impl Marker {
    /// The marker `DICTIONARY:NUMBER`, for example `aruco4x4_50:7`, with a black square of `size` mm; `None` when there is none
    /// of that name.
    pub fn by_name(name: &str, size: f64) -> Option<Self> {
        let (dictionary, id) = name.split_once(':')?;
        let dictionary = Dictionary::by_name(&dictionary.to_ascii_lowercase())?;
        let id = id.parse().ok().filter(|&id: &u16| usize::from(id) < dictionary.len())?;
        Some(Self { dictionary, id, size })
    }
}

/// Finds the marker in frames.
pub struct MarkerFinder {
    detector: Detector,
    marker: Marker,
    sight: Sight,
    mount: Mount,
    track: Track,
    grey: Vec<u8>,
}

impl MarkerFinder {
    /// Looks for this marker.
    pub fn new(marker: Marker, sight: Sight, mount: Mount) -> Self {
        let detector = Detector::new(&[marker.dictionary]);
        Self { detector, marker, sight, mount, track: Track::new(None), grey: Vec::new() }
    }
}

impl Find for MarkerFinder {
    fn find(&mut self, frame: &Frame) -> Option<V3> {
        let (width, height) = (frame.width, frame.height);
        let lens = self.sight.lens(width, height)?;
        frame.grey(&mut self.grey);
        let image = GreyImage::new(width, height, width, &self.grey)?;
        let found = self.detector.detect(&image).ok()?;
        // Of several with this number the one that agrees best: a reflection is worse.
        let mine = found.iter().filter(|one| one.id == self.marker.id);
        let best = mine.max_by(|a, b| a.agreement.total_cmp(&b.agreement))?;
        let (pose, _) = self.track.update(frame.time, &lens, self.marker.size, &best.corners)?;
        let ahead = pose.translation[2] > 0.0 && pose.translation.iter().all(|x| x.is_finite());
        ahead.then(|| self.mount.to_viewer(pose.translation))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markers_have_names() {
        let marker = Marker::by_name("ArUco4x4_50:7", 50.0).unwrap();
        assert_eq!((marker.dictionary.name, marker.id), ("aruco4x4_50", 7));
        for wrong in ["aruco4x4_50", "aruco4x4_50:50", "aruco4x4_50:-1", "april:1", ":1"] {
            assert!(Marker::by_name(wrong, 50.0).is_none(), "{wrong}");
        }
    }
}
