//! Webcams through Video4Linux 2: MJPEG where the camera has it, else YUYV.

use std::path::Path;

use v4l::buffer::Type;
use v4l::io::traits::CaptureStream;
use v4l::prelude::MmapStream;
use v4l::video::Capture;
use v4l::{Device, FourCC};

use crate::convert::to_rgb;
use crate::error::{VideoError, name_of};
use crate::frame::Frame;
use crate::picture::jpeg;

/// An open camera.
pub struct Webcam {
    stream: MmapStream<'static>,
    size: (usize, usize),
    mjpeg: bool,
}

impl Webcam {
    pub fn open(path: &Path) -> Result<Self, VideoError> {
        let name = name_of(path);
        let failed = |error: std::io::Error| VideoError::io(&name, &error);
        let device = Device::with_path(path).map_err(failed)?;
        let mut format = device.format().map_err(failed)?;
        format.fourcc = FourCC::new(b"MJPG");
        let mut got = device.set_format(&format).map_err(failed)?;
        if got.fourcc != FourCC::new(b"MJPG") {
            format.fourcc = FourCC::new(b"YUYV");
            got = device.set_format(&format).map_err(failed)?;
        }
        let mjpeg = got.fourcc == FourCC::new(b"MJPG");
        if !mjpeg && got.fourcc != FourCC::new(b"YUYV") {
            let what = format!("its format {} is not read", got.fourcc);
            return Err(VideoError::end(&name, what, "pipe it through ffmpeg -f yuv4mpegpipe"));
        }
        // Two buffers: the picture shown is as fresh as can be.
        let stream = MmapStream::with_buffers(&device, Type::VideoCapture, 2).map_err(failed)?;
        Ok(Self { stream, size: (got.width as usize, got.height as usize), mjpeg })
    }

    pub fn next(&mut self, name: &str, number: usize) -> Result<Frame, VideoError> {
        let (bytes, meta) = self.stream.next().map_err(|error| {
            VideoError::end(
                name,
                format!("the camera is gone ({error})"),
                "plug it in and start again",
            )
        })?;
        let bytes = &bytes[..(meta.bytesused as usize).min(bytes.len())];
        if self.mjpeg {
            return jpeg(bytes).map_err(|what| VideoError::frame(name, number, what));
        }
        let (width, height) = self.size;
        if bytes.len() < width * height * 2 {
            return Err(VideoError::frame(name, number, "it breaks off"));
        }
        let pairs = bytes.as_chunks::<4>().0;
        let both = |&[a, u, b, v]: &[u8; 4]| [to_rgb(a, u, v, false), to_rgb(b, u, v, false)];
        let rgb = pairs[..width * height / 2].iter().flat_map(both).collect();
        Ok(Frame { width, height, rgb, time: 0.0 })
    }
}
