//! Where frames go.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::convert::to_yuv;
use crate::error::VideoError;
use crate::frame::Frame;
use crate::picture::write_png;

/// What a sink writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SinkFormat {
    /// y4m, 4:4:4: every pixel keeps its colour.
    Y4m,
    /// JPEG pictures in a row, quality 92.
    Mjpeg,
    /// One PNG; of several frames the last stays.
    Png,
    /// A folder of PNGs, `00000.png` and so on.
    Folder,
}

impl SinkFormat {
    /// By a path's ending; a name without ending is a folder, `-` is y4m. `None` for other endings.
    pub fn for_path(path: &Path) -> Option<Self> {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match ending.as_str() {
            _ if path.as_os_str() == "-" => Some(Self::Y4m),
            "y4m" => Some(Self::Y4m),
            "mjpeg" | "mjpg" | "jpg" | "jpeg" => Some(Self::Mjpeg),
            "png" => Some(Self::Png),
            "" => Some(Self::Folder),
            _ => None,
        }
    }
}

/// A film that is written frame by frame. The first frame decides the size of a y4m film.
pub struct Sink {
    path: PathBuf,
    name: String,
    rate: f64,
    kind: Kind,
    count: usize,
}

enum Kind {
    Folder,
    Png,
    Mjpeg(Box<dyn Write>),
    Waiting(Box<dyn Write>),
    Y4m(Box<dyn Write>, (usize, usize)),
    Closed,
}

impl Sink {
    /// Opens a file, a folder or standard output for frames at `rate` a second.
    ///
    /// # Errors
    /// [`VideoError`], a line.
    pub fn create(path: &Path, format: SinkFormat, rate: f64) -> Result<Self, VideoError> {
        let dash = path.as_os_str() == "-";
        let name = if dash { "standard output".into() } else { path.display().to_string() };
        let open = || -> Result<Box<dyn Write>, VideoError> {
            if dash {
                return Ok(Box::new(BufWriter::new(io::stdout())));
            }
            let file = File::create(path).map_err(|error| VideoError::io(&name, &error))?;
            Ok(Box::new(BufWriter::new(file)))
        };
        let kind = match format {
            SinkFormat::Y4m => Kind::Waiting(open()?),
            SinkFormat::Mjpeg => Kind::Mjpeg(open()?),
            SinkFormat::Png => Kind::Png,
            SinkFormat::Folder => {
                std::fs::create_dir_all(path).map_err(|error| VideoError::io(&name, &error))?;
                Kind::Folder
            }
        };
        Ok(Self { path: path.into(), name, rate, kind, count: 0 })
    }

    /// Frames written.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Writes a frame.
    ///
    /// # Errors
    /// Failures to write; a frame of another size than the first, where the format has one size only.
    pub fn write(&mut self, frame: &Frame) -> Result<(), VideoError> {
        let name = self.name.clone();
        let failed = |error: io::Error| VideoError::io(&name, &error);
        if let Kind::Waiting(_) = self.kind {
            let Kind::Waiting(mut to) = std::mem::replace(&mut self.kind, Kind::Closed) else {
                return Ok(());
            };
            let (width, height) = (frame.width, frame.height);
            let rate = (self.rate * 1000.0).round().max(1.0);
            writeln!(to, "YUV4MPEG2 W{width} H{height} F{rate}:1000 Ip A1:1 C444")
                .map_err(failed)?;
            self.kind = Kind::Y4m(to, (width, height));
        }
        match &mut self.kind {
            Kind::Y4m(to, size) => {
                if *size != (frame.width, frame.height) {
                    let what = format!(
                        "a frame of {} x {} in a film of {} x {}",
                        frame.width, frame.height, size.0, size.1
                    );
                    return Err(VideoError::frame(&self.name, self.count, what));
                }
                let mut planes = [const { Vec::new() }; 3];
                for rgb in &frame.rgb {
                    for (plane, value) in planes.iter_mut().zip(to_yuv(*rgb)) {
                        plane.push(value);
                    }
                }
                to.write_all(b"FRAME\n").map_err(failed)?;
                for plane in &planes {
                    to.write_all(plane).map_err(failed)?;
                }
            }
            Kind::Mjpeg(to) => {
                let (Ok(width), Ok(height)) =
                    (u16::try_from(frame.width), u16::try_from(frame.height))
                else {
                    return Err(VideoError::frame(&self.name, self.count, "it is too large"));
                };
                let mut bytes = Vec::new();
                jpeg_encoder::Encoder::new(&mut bytes, 92)
                    .encode(frame.rgb.as_flattened(), width, height, jpeg_encoder::ColorType::Rgb)
                    .map_err(|error| failed(io::Error::other(error)))?;
                to.write_all(&bytes).map_err(failed)?;
            }
            Kind::Png => self.png(&self.path, frame)?,
            Kind::Folder => self.png(&self.path.join(format!("{:05}.png", self.count)), frame)?,
            Kind::Waiting(_) | Kind::Closed => {}
        }
        self.count += 1;
        Ok(())
    }

    fn png(&self, path: &Path, frame: &Frame) -> Result<(), VideoError> {
        let name = path.display().to_string();
        let failed = |error: io::Error| VideoError::io(&name, &error);
        if path.as_os_str() == "-" {
            return write_png(io::stdout().lock(), frame).map_err(failed);
        }
        let mut file = BufWriter::new(File::create(path).map_err(failed)?);
        write_png(&mut file, frame).and_then(|()| file.flush()).map_err(failed)
    }

    /// Ends the film: everything is written.
    ///
    /// # Errors
    /// Failures to write.
    pub fn finish(self) -> Result<(), VideoError> {
        let done = match self.kind {
            Kind::Mjpeg(mut to) | Kind::Waiting(mut to) | Kind::Y4m(mut to, _) => to.flush(),
            _ => Ok(()),
        };
        done.map_err(|error| VideoError::io(&self.name, &error))
    }
}
