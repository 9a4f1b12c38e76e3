//! Who moves the viewer: one small interface for hand, network, recording and whatever comes.

use crate::V3;

/// Where a source saw the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// When, seconds of the caller's clock (see [`Source::poll`]).
    pub time: f64,
    /// The place of the eye, or of the middle between the eyes, mm in the viewer's coordinates; `None` when the source looked
    /// and found nobody.
    pub eye: Option<V3>,
}

/// Something that knows where the viewer is.
pub trait Source {
    /// The newest sample since the last call, if there is one. `now` is the caller's clock in seconds, which only goes forward.
    /// Never waits.
    fn poll(&mut self, now: f64) -> Option<Sample>;

    /// Does silence mean that the viewer is lost? A camera or a network tracker speaks all the time, a hand doesn't.
    fn silence_is_loss(&self) -> bool;

    /// Something that the user should know, once.
    fn notice(&mut self) -> Option<String> {
        None
    }
}
