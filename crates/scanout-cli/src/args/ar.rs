//! The options of `marker`, `ar` and `calibrate`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, ValueHint};
use scanout_ar::Dictionary;

use super::{DrawMode, Terminal};
use crate::values::{Colour, Up};

/// A marker, `DICTIONARY:NUMBER`.
#[derive(Clone, Copy, Debug)]
pub struct MarkerName {
    /// Its dictionary.
    pub dictionary: Dictionary,
    /// Its number.
    pub id: u16,
}

impl FromStr for MarkerName {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, id) = text.split_once(':').unwrap_or((text, ""));
        let dictionary = Dictionary::by_name(&name.to_ascii_lowercase()).ok_or_else(|| {
            let names: Vec<&str> = Dictionary::ALL.iter().map(|d| d.name).collect();
            format!(
                "'{name}' is no dictionary, expected DICTIONARY:NUMBER with one of {}",
                names.join(", ")
            )
        })?;
        let most = dictionary.len() - 1;
        match id.parse::<u16>() {
            Ok(id) if usize::from(id) <= most => Ok(Self { dictionary, id }),
            _ => Err(format!("'{id}' is no marker of {name}, expected {name}:0 to {name}:{most}")),
        }
    }
}

impl std::fmt::Display for MarkerName {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}", self.dictionary.name, self.id)
    }
}

/// A length with its unit, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Length(pub f64);

impl FromStr for Length {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let units = [("mm", 0.001), ("cm", 0.01), ("in", 0.0254), ("m", 1.0)];
        let wrong = || format!("'{text}' is no length, expected e.g. 80mm, 8cm, 0.08m or 3in");
        let (number, unit) = units
            .iter()
            .find_map(|(name, unit)| text.trim().strip_suffix(name).map(|number| (number, unit)))
            .ok_or_else(wrong)?;
        let metres = number.trim().parse::<f64>().map_err(|_| wrong())? * unit;
        let possible = metres.is_finite() && (1e-4..=1000.0).contains(&metres);
        if possible {
            Ok(Self(metres))
        } else {
            Err(format!("{text} is not between 0.1mm and 1000m"))
        }
    }
}

/// Columns and rows, `CxR`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid(pub u16, pub u16);

impl FromStr for Grid {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |part: &str| part.trim().parse().ok().filter(|n| (1..=100).contains(n));
        let both = text.split_once(['x', ',']).and_then(|(c, r)| side(c).zip(side(r)));
        both.map(|(c, r)| Self(c, r))
            .ok_or_else(|| format!("'{text}' is no grid, expected COLUMNSxROWS, each 1 to 100"))
    }
}

/// `scanout marker`.
#[derive(Args, Debug)]
pub struct MarkerArgs {
    /// Dictionary and number, e.g. aruco4x4_50:7 or apriltag36h11:0
    #[arg(value_name = "MARKER")]
    pub marker: MarkerName,
    /// Where it goes: .png, .svg or .pdf
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub output: PathBuf,
    /// Side of the black square, with its unit: mm, cm, m, in
    #[arg(long, value_name = "LENGTH", default_value = "80mm")]
    pub size: Length,
    /// White paper around it, cells
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=8))]
    pub quiet: u8,
    /// Dots an inch of a .png
    #[arg(long, value_name = "N", default_value_t = 300, value_parser = clap::value_parser!(u16).range(10..=2400))]
    pub dpi: u16,
}

/// `scanout ar`.
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  \
    scanout marker aruco4x4_50:7 --size 80mm -o marker.pdf\n  \
    scanout ar --source photos/ --marker aruco4x4_50:7 --size 80mm --model teapot.obj -o out/\n  \
    ffmpeg -i film.mp4 -f yuv4mpegpipe -pix_fmt yuv420p - | scanout ar --source - --marker aruco4x4_50:7 \\\n    \
    --size 80mm --model teapot.obj --calibration camera.yml -o film.y4m --json poses.jsonl\n\n\
    Poses: a line of JSON a frame; from the marker's axes (x right, y up, z out of the paper) to the camera's (x right, y down, \
    z forward), metres; corners in pixels, the first pixel's centre is (0.5, 0.5).")]
pub struct ArArgs {
    /// Frames: a folder of pictures, a y4m, MJPEG, PNG, JPEG or PPM file, `-`, or /dev/video0
    #[arg(long, value_name = "SOURCE", value_hint = ValueHint::AnyPath)]
    pub source: PathBuf,
    /// The marker that the model stands on, e.g. aruco4x4_50:7; of a board the first
    #[arg(long, value_name = "MARKER")]
    pub marker: MarkerName,
    /// Side of its black square, with its unit: mm, cm, m, in
    #[arg(long, value_name = "LENGTH")]
    pub size: Length,
    /// A board of markers with numbers from MARKER's on, by rows
    #[arg(long, value_name = "COLUMNSxROWS", requires = "gap")]
    pub board: Option<Grid>,
    /// Distance between the markers of a board
    #[arg(long, value_name = "LENGTH", requires = "board")]
    pub gap: Option<Length>,
    /// The model: OBJ, STL, PLY, glTF or GLB; none: poses only
    #[arg(long, value_name = "MODEL", value_hint = ValueHint::FilePath)]
    pub model: Option<PathBuf>,
    /// Length of the model's longer side on the paper [default: SIZE]
    #[arg(long, value_name = "LENGTH", requires = "model")]
    pub model_size: Option<Length>,
    /// Which axis of the model points out of the paper
    #[arg(long, value_enum, value_name = "AXIS", default_value = "+Y", ignore_case = true)]
    pub up: Up,
    /// How surfaces are drawn [default: textured; wire or points for what has no faces]
    #[arg(long, value_enum, value_name = "MODE")]
    pub mode: Option<DrawMode>,
    /// Colour of the surface [default: the model's own; black for wire and hidden]
    #[arg(long, value_name = "COLOR")]
    pub color: Option<Colour>,
    /// Smooth the lines of wire and hidden
    #[arg(long)]
    pub smooth_lines: bool,
    /// Sink the model into the paper, which hides what is below
    #[arg(long, value_name = "LENGTH", requires = "model")]
    pub sink: Option<Length>,
    /// The camera's calibration, OpenCV's YAML or JSON; the output is straightened by it
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "fov")]
    pub calibration: Option<PathBuf>,
    /// Field of view across the picture's width, degrees, where there is no calibration
    #[arg(long, value_name = "DEG", default_value_t = 60.0, value_parser = super::between(5.0, 150.0))]
    pub fov: f64,
    /// Show each frame's pose as it is measured
    #[arg(long)]
    pub no_filter: bool,
    /// Look for the marker in each frame anew, not also where it was: then a covered corner loses it
    #[arg(long)]
    pub no_tracking: bool,
    /// Frames a second, where the source doesn't say it
    #[arg(long, value_name = "N", default_value_t = 30.0, value_parser = super::between(0.01, 1000.0))]
    pub fps: f64,
    /// Where frames go: .y4m, .mjpeg, .png (the last), a folder, or `-` (y4m); without it a window or the terminal
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::AnyPath)]
    pub output: Option<PathBuf>,
    /// Where poses go, a line of JSON a frame; `-` is standard output
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub json: Option<PathBuf>,
    /// How to show frames in the terminal
    #[arg(long, value_enum, value_name = "HOW", default_value_t)]
    pub terminal: Terminal,
}

/// `scanout calibrate`.
#[derive(Args, Debug)]
pub struct CalibrateArgs {
    /// Pictures of a chessboard from different sides: a folder, a film, or `-`
    #[arg(value_name = "SOURCE", value_hint = ValueHint::AnyPath)]
    pub source: PathBuf,
    /// Inner corners of the board, where four squares meet
    #[arg(long, value_name = "COLUMNSxROWS", default_value = "9x6")]
    pub board: Grid,
    /// Side of a square, with its unit
    #[arg(long, value_name = "LENGTH", default_value = "25mm")]
    pub square: Length,
    /// Where the calibration goes, OpenCV's YAML; `-` is standard output
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub output: PathBuf,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markers_and_lengths() {
        let marker: MarkerName = "aruco4x4_50:7".parse().unwrap();
        assert_eq!(marker.to_string(), "aruco4x4_50:7");
        let error = |text: &str| text.parse::<MarkerName>().unwrap_err();
        assert!(error("aruco4x4_50:50").ends_with("expected aruco4x4_50:0 to aruco4x4_50:49"));
        assert!(error("qr:1").contains("apriltag36h11"));
        assert!(error("aruco4x4_50").contains("'' is no marker"));
        let length = |text: &str| text.parse::<Length>().map(|length| (length.0 * 1e6).round());
        assert_eq!(length("80mm"), Ok(80_000.0));
        assert_eq!(length("3in"), Ok(76_200.0));
        assert_eq!(length("0.08 m"), Ok(80_000.0));
        assert!(length("80").is_err() && length("-1mm").is_err() && length("nanmm").is_err());
    }
}
