//! The lens for frames of any size.

use std::path::PathBuf;

use scanout_ar::Lens;
use scanout_ar::calibration::Calibration;

use crate::args::ar::ArArgs;
use crate::error::{Error, Result};
use crate::narrate;

/// Where intrinsics come from.
pub struct Cameras {
    file: Option<(PathBuf, Calibration)>,
    fov: f64,
    /// The last size and its lens.
    last: Option<((usize, usize), Lens)>,
}

impl Cameras {
    /// Reads the calibration.
    pub fn new(args: &ArArgs) -> Result<Self> {
        let file = match &args.calibration {
            None => None,
            Some(path) => {
                let bytes = std::fs::read(path).map_err(|error| Error::io(path, &error))?;
                let text = String::from_utf8_lossy(&bytes);
                let calibration = Calibration::read(&text)
                    .map_err(|error| Error::Failed(format!("{}: {error}", path.display())))?;
                Some((path.clone(), calibration))
            }
        };
        Ok(Self { file, fov: args.fov, last: None })
    }

    /// The lens for frames of this size.
    pub fn lens(&mut self, width: usize, height: usize) -> Result<Lens> {
        if let Some((size, lens)) = self.last
            && size == (width, height)
        {
            return Ok(lens);
        }
        let lens = match &self.file {
            None => {
                if self.last.is_none() {
                    narrate!(
                        "scanout: no --calibration: a field of view of {} degrees is assumed, so distances are rough",
                        self.fov
                    );
                }
                Lens::from_field_of_view(width, height, self.fov)
                    .ok_or_else(|| Error::failed("source", "an empty frame", "give pictures"))?
            }
            Some((path, calibration)) => calibration.for_size(width, height).ok_or_else(|| {
                let (w, h) = calibration.size.unwrap_or_default();
                let what = format_args!("it is for {w} x {h}, the frame is {width} x {height}");
                Error::failed(path.display(), what, "calibrate with frames of this shape")
            })?,
        };
        self.last = Some(((width, height), lens));
        Ok(lens)
    }
}
