//! y4m: what `ffmpeg -f yuv4mpegpipe` and many others write. 8 bits; 4:2:0, 4:2:2, 4:4:4 and grey.

use std::io::Read;

use y4m::{Colorspace, Decoder, Limits};

use crate::convert::to_rgb;
use crate::frame::Frame;
use crate::picture::SIDE;

/// A y4m stream.
pub struct Y4m<R: Read> {
    decoder: Decoder<R>,
    full: bool,
    /// Frames a second, if the header says it.
    pub rate: Option<f64>,
}

impl<R: Read> Y4m<R> {
    /// Reads the header.
    pub fn new(reader: R) -> Result<Self, String> {
        let limits = Limits { bytes: SIDE * SIDE * 3 };
        let decoder = Decoder::new_with_limits(reader, limits)
            .map_err(|_| "its y4m header is damaged or its frames are too large".to_string())?;
        let space = decoder.get_colorspace();
        if decoder.get_bit_depth() != 8 {
            return Err(format!("{space:?} has more than 8 bits a sample; add -pix_fmt yuv420p"));
        }
        let rate = decoder.get_framerate();
        let rate = (rate.num > 0 && rate.den > 0).then(|| rate.num as f64 / rate.den as f64);
        let header = String::from_utf8_lossy(decoder.get_raw_params());
        let full = header.contains("XCOLORRANGE=FULL");
        Ok(Self { decoder, full, rate })
    }

    /// The next frame; `None` at the end.
    pub fn next(&mut self) -> Result<Option<Frame>, String> {
        let (width, height) = (self.decoder.get_width(), self.decoder.get_height());
        let (across, down) = match self.decoder.get_colorspace() {
            Colorspace::Cmono => (0, 0),
            Colorspace::C422 => (2, 1),
            Colorspace::C444 => (1, 1),
            _ => (2, 2),
        };
        let full = self.full;
        let frame = match self.decoder.read_frame() {
            Ok(frame) => frame,
            Err(y4m::Error::EOF) => return Ok(None),
            Err(_) => return Err("the y4m stream is damaged or ends early".into()),
        };
        let (y, u, v) = (frame.get_y_plane(), frame.get_u_plane(), frame.get_v_plane());
        let mut rgb = Vec::with_capacity(width * height);
        for row in 0..height {
            for column in 0..width {
                let grey = y[row * width + column];
                rgb.push(if across == 0 {
                    to_rgb(grey, 128, 128, full)
                } else {
                    let at = row / down * width.div_ceil(across) + column / across;
                    to_rgb(grey, u[at], v[at], full)
                });
            }
        }
        Ok(Some(Frame { width, height, rgb, time: 0.0 }))
    }
}
