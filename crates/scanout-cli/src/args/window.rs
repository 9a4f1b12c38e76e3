//! `scanout window`.

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::{DrawMode, InputFormat, Stereo, between};
use crate::values::{Millimetres, Resolution, Triple};

/// `scanout window`.
#[derive(Args, Debug)]
#[command(after_help = crate::cmd::window::EXPLANATION)]
pub struct WindowArgs {
    /// What stands in the room behind the glass [default: a cube]
    #[arg(value_name = "MODEL", value_hint = ValueHint::FilePath)]
    pub model: Option<PathBuf>,
    /// Format of the model, instead of guessing by name
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub input_format: Option<InputFormat>,
    /// How surfaces are drawn [default: textured]
    #[arg(long, value_enum, value_name = "MODE")]
    pub mode: Option<DrawMode>,
    /// Largest side of the model, mm [default: half of the screen's height]
    #[arg(long, value_name = "MM", value_parser = between(1.0, 20_000.0))]
    pub size: Option<f64>,
    /// Where its middle is: mm before the glass, negative behind it [default: as far behind as the cube]
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = between(-20_000.0, 2_000.0))]
    pub depth: Option<f64>,
    /// Leave the room's lines away
    #[arg(long)]
    pub no_room: bool,
    /// Two eyes in one picture
    #[arg(long, value_enum, value_name = "HOW")]
    pub stereo: Option<Stereo>,
    /// Distance of the two eyes, mm: for --stereo, and for depth with --face
    #[arg(long, value_name = "MM", default_value_t = 63.0, value_parser = between(0.0, 200.0))]
    pub eye_distance: f64,
    /// The right eye's picture where the left eye's belongs
    #[arg(long, requires = "stereo")]
    pub swap_eyes: bool,

    /// Size of the picture on the glass: WxHmm, cm or in [default: 520x290mm]
    #[arg(long, value_name = "WxHmm", help_heading = "Screen")]
    pub screen: Option<Millimetres>,
    /// How far the screen's top leans back, degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, default_value_t = 0.0, value_parser = between(-89.0, 89.0), help_heading = "Screen")]
    pub tilt: f64,
    /// Size in pixels
    #[arg(long, value_name = "W,H", default_value = "1040,580", help_heading = "Screen")]
    pub resolution: Resolution,
    /// Cover the whole screen, as the measures suppose
    #[arg(long, conflicts_with = "output", help_heading = "Screen")]
    pub fullscreen: bool,
    /// Close after N frames; with -o, write N
    #[arg(long, value_name = "N", help_heading = "Screen")]
    pub frames: Option<u32>,

    /// Who moves the viewer: mouse, keys, udp (opentrack), camera (your face, or a marker on your cap), or a recorded FILE.csv
    #[arg(long, value_name = "WHO", default_value = "mouse", help_heading = "Viewer")]
    pub head: String,
    /// Where opentrack's packets are awaited; 0.0.0.0:4242 lets other machines in
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:4242", help_heading = "Viewer")]
    pub listen: SocketAddr,
    /// Where the viewer is when nobody is seen, mm from the middle of the screen: right, up, out of the glass
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        default_value = "0,0,600",
        help_heading = "Viewer"
    )]
    pub viewer: Triple,
    /// Where the tracker's zero is, in the same measure; for camera, where your eyes are from the marker [default: udp as --viewer, others 0,0,0]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, help_heading = "Viewer")]
    pub head_origin: Option<Triple>,
    /// Factors of the tracker's axes; -1,1,1 exchanges left and right
    #[arg(
        long,
        value_name = "X,Y,Z",
        allow_hyphen_values = true,
        default_value = "1,1,1",
        help_heading = "Viewer"
    )]
    pub head_scale: Triple,
    /// Take the tracker's places as they are, without the One Euro filter
    #[arg(long, help_heading = "Viewer")]
    pub no_filter: bool,
    /// The filter's cut-off at rest, Hz; less is steadier
    #[arg(long, value_name = "HZ", default_value_t = 1.5, value_parser = between(0.01, 1000.0), help_heading = "Viewer")]
    pub filter_cutoff: f64,
    /// How much the cut-off rises with speed, Hz for each mm/s; more is quicker
    #[arg(long, value_name = "F", default_value_t = 0.1, value_parser = between(0.0, 100.0), help_heading = "Viewer")]
    pub filter_beta: f64,
    /// Draw for where the head will be in so many ms
    #[arg(long, value_name = "MS", default_value_t = 0.0, value_parser = between(0.0, 200.0), help_heading = "Viewer")]
    pub predict: f64,
    /// Write where the head was into FILE.csv, for --head FILE.csv
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, help_heading = "Viewer")]
    pub record: Option<PathBuf>,

    /// Frames: /dev/video0, a folder of pictures, a y4m, MJPEG, PNG, JPEG or PPM file, or `-`
    #[arg(long, value_name = "SOURCE", default_value = "/dev/video0", value_hint = ValueHint::AnyPath, help_heading = "Camera")]
    pub source: PathBuf,
    /// Frames a second, where the source doesn't say it
    #[arg(long, value_name = "N", default_value_t = 30.0, value_parser = between(0.01, 1000.0), help_heading = "Camera")]
    pub source_fps: f64,
    /// Look for your face, not for a marker: the model that finds it (scripts/face-models fetches both)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, requires = "eyes", conflicts_with_all = ["marker", "marker_size"], help_heading = "Camera")]
    pub face: Option<PathBuf>,
    /// The model that finds its pupils
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, requires = "face", help_heading = "Camera")]
    pub eyes: Option<PathBuf>,
    /// The marker on your cap or glasses, DICTIONARY:NUMBER
    #[arg(long, value_name = "MARKER", default_value = "aruco4x4_50:0", help_heading = "Camera")]
    pub marker: String,
    /// Side of its black square, mm
    #[arg(long, value_name = "MM", default_value_t = 50.0, value_parser = between(1.0, 1000.0), help_heading = "Camera")]
    pub marker_size: f64,
    /// Where the camera's lens is, mm from the middle of the screen [default: 10 above the upper edge]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, help_heading = "Camera")]
    pub camera_place: Option<Triple>,
    /// How far the camera looks up, degrees; negative looks down
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, default_value_t = 0.0, value_parser = between(-89.0, 89.0), help_heading = "Camera")]
    pub camera_tilt: f64,
    /// The camera's calibration, OpenCV's YAML or JSON
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, conflicts_with = "fov", help_heading = "Camera")]
    pub calibration: Option<PathBuf>,
    /// Field of view across the picture's width, degrees, where there is no calibration
    #[arg(long, value_name = "DEG", default_value_t = 60.0, value_parser = between(5.0, 150.0), help_heading = "Camera")]
    pub fov: f64,

    /// No window: a recording's or a film's pictures go to .gif, .png (animated), or a folder
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::AnyPath, help_heading = "Pictures")]
    pub output: Option<PathBuf>,
    /// Pictures a second in OUT, 1 - 100
    #[arg(long, value_name = "N", requires = "output", default_value_t = 30, value_parser = clap::value_parser!(u16).range(1..=100), help_heading = "Pictures")]
    pub fps: u16,
}
