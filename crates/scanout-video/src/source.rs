//! Where frames come from.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

use crate::error::{VideoError, name_of};
use crate::folder;
use crate::frame::Frame;
use crate::mjpeg::{self, Next};
use crate::picture::{decode_picture, jpeg, read_picture};
use crate::ppm;
use crate::y4m_in::Y4m;

/// Readable from whatever thread has it.
type Stream = Box<dyn BufRead + Send>;

/// A film that is read frame by frame, by any thread.
pub struct Source {
    kind: Kind,
    name: String,
    rate: f64,
    live: bool,
    /// Frames read, the lost ones too.
    count: usize,
    /// Lost frames in a row.
    lost: usize,
    ended: bool,
}

enum Kind {
    Folder(std::vec::IntoIter<PathBuf>),
    Y4m(Box<Y4m<Stream>>),
    Jpegs(Stream),
    Ppms(Stream),
    Picture(Stream),
    #[cfg(feature = "webcam")]
    Webcam(crate::webcam::Webcam),
}

impl Source {
    /// Opens a folder, a file, `-` or a webcam. `rate` is the frames a second of what doesn't say its own.
    ///
    /// # Errors
    /// [`VideoError`], a line.
    pub fn open(path: &Path, rate: f64) -> Result<Self, VideoError> {
        let name = name_of(path);
        let source = |kind| Self {
            kind,
            name: name.clone(),
            rate,
            live: false,
            count: 0,
            lost: 0,
            ended: false,
        };
        if path.is_dir() {
            return Ok(source(Kind::Folder(folder::pictures(path)?.into_iter())));
        }
        if path.starts_with("/dev") && name.contains("video") {
            return Self::camera(path, source);
        }
        let mut stream: Stream = if path.as_os_str() == "-" {
            Box::new(BufReader::with_capacity(1 << 16, io::stdin()))
        } else {
            let file = File::open(path).map_err(|error| VideoError::io(&name, &error))?;
            Box::new(BufReader::with_capacity(1 << 16, file))
        };
        let start = stream.fill_buf().map_err(|error| VideoError::io(&name, &error))?;
        let kind = match start {
            [] => return Err(VideoError::end(&name, "it is empty", "give frames")),
            [b'Y', b'U', b'V', ..] => {
                let remedy = "write it with 'ffmpeg -f yuv4mpegpipe -pix_fmt yuv420p'";
                let y4m = Y4m::new(stream).map_err(|what| VideoError::end(&name, what, remedy))?;
                let rate = y4m.rate.unwrap_or(rate);
                return Ok(Self { rate, ..source(Kind::Y4m(Box::new(y4m))) });
            }
            [b'R', b'I', b'F', b'F', ..] | [0xff, 0xd8, ..] => Kind::Jpegs(stream),
            [b'P', b'5' | b'6', ..] => Kind::Ppms(stream),
            [0x89, b'P', b'N', b'G', ..] => Kind::Picture(stream),
            _ => {
                return Err(VideoError::end(
                    &name,
                    "neither y4m nor MJPEG nor a picture",
                    "pipe it through 'ffmpeg -i FILE -f yuv4mpegpipe -pix_fmt yuv420p -'",
                ));
            }
        };
        Ok(source(kind))
    }

    #[cfg(feature = "webcam")]
    fn camera(path: &Path, source: impl Fn(Kind) -> Self) -> Result<Self, VideoError> {
        let camera = crate::webcam::Webcam::open(path)?;
        Ok(Self { live: true, ..source(Kind::Webcam(camera)) })
    }

    #[cfg(not(feature = "webcam"))]
    fn camera(path: &Path, _: impl Fn(Kind) -> Self) -> Result<Self, VideoError> {
        Err(VideoError::end(
            &name_of(path),
            "this program was built without webcams",
            "build it with the feature webcam, or pipe: ffmpeg -f v4l2 -i /dev/video0 -f yuv4mpegpipe -pix_fmt yuv420p - | scanout ... -",
        ))
    }

    /// Frames a second.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Does it go on whether frames are taken or not?
    pub fn is_live(&self) -> bool {
        self.live
    }

    /// Its name in messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The next frame; `None` at the end. After an error that doesn't [end](VideoError::ends) the film, the next call goes on.
    #[allow(clippy::should_implement_trait)] // An iterator would end at the first error in most people's hands.
    pub fn next(&mut self) -> Option<Result<Frame, VideoError>> {
        if self.ended {
            return None;
        }
        let number = self.count;
        self.count += 1;
        let next = self.read(number);
        match &next {
            None => self.ended = true,
            Some(Ok(_)) => self.lost = 0,
            Some(Err(error)) => {
                self.lost += 1;
                self.ended = error.ends();
            }
        }
        let time = number as f64 / self.rate;
        next.map(|result| result.map(|frame| Frame { time, ..frame }))
    }

    fn read(&mut self, number: usize) -> Option<Result<Frame, VideoError>> {
        let name = &self.name;
        let failed = |error: io::Error| VideoError::io(name, &error);
        let lost = |what: String| VideoError::frame(name, number, what);
        match &mut self.kind {
            Kind::Folder(paths) => {
                let path = paths.next()?;
                let file = name_of(path.file_name().unwrap_or_default().as_ref());
                let bytes = std::fs::read(&path).map_err(|error| lost(format!("{file}: {error}")));
                Some(bytes.and_then(|bytes| {
                    decode_picture(&bytes).map_err(|what| lost(format!("{file}: {what}")))
                }))
            }
            Kind::Y4m(y4m) => y4m
                .next()
                .map_err(|what| VideoError::end(name, what, "the frames before it are done"))
                .transpose(),
            Kind::Jpegs(stream) => match mjpeg::next(stream) {
                Ok(Next::Picture(bytes)) => Some(jpeg(&bytes).map_err(lost)),
                Ok(Next::Broken) => Some(Err(lost("JPEG: it breaks off".into()))),
                Ok(Next::End) => None,
                Err(error) => Some(Err(failed(error))),
            },
            Kind::Ppms(stream) => match ppm::read(stream) {
                Ok(frame) => frame.map(Ok),
                Err(error) => {
                    let remedy = "the frames before it are done";
                    Some(Err(VideoError::end(name, error, remedy)))
                }
            },
            Kind::Picture(stream) => {
                let mut bytes = Vec::new();
                if let Err(error) = stream.read_to_end(&mut bytes) {
                    return Some(Err(failed(error)));
                }
                if bytes.is_empty() {
                    return None;
                }
                Some(decode_picture(&bytes).map_err(lost))
            }
            #[cfg(feature = "webcam")]
            Kind::Webcam(camera) => Some(camera.next(name, number)),
        }
    }
}

/// Films that fit into memory.
impl Source {
    /// All frames of a folder or file, for programs that need them at once; those that can't be read are told to `tell`.
    ///
    /// # Errors
    /// When the source can't be opened.
    pub fn all(
        path: &Path,
        rate: f64,
        mut tell: impl FnMut(&VideoError),
    ) -> Result<Vec<(String, Frame)>, VideoError> {
        if path.is_dir() {
            let mut frames = Vec::new();
            for path in folder::pictures(path)? {
                match read_picture(&path) {
                    Ok(frame) => frames.push((name_of(&path), frame)),
                    Err(error) => tell(&error),
                }
            }
            return Ok(frames);
        }
        let mut source = Self::open(path, rate)?;
        let mut frames = Vec::new();
        while let Some(next) = source.next() {
            match next {
                Ok(frame) => {
                    frames.push((format!("{} frame {}", source.name, source.count - 1), frame))
                }
                Err(error) => tell(&error),
            }
        }
        Ok(frames)
    }
}

/// Whoever reads a camera on a thread of its own relies on it.
const _: () = {
    const fn goes_between_threads<T: Send>() {}
    goes_between_threads::<Source>();
};
