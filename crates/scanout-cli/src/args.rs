//! The command line: one definition for parser, help, man page and completions.
//!
//! Names follow f3d where f3d has the option; its longer spellings are accepted as aliases.

pub mod ar;
mod choices;
mod window;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueHint};

pub use window::WindowArgs;

pub use choices::{
    DrawMode, InputFormat, OutputFormat, PixelFormat, Stereo, Terminal, TextureFilter, TextureWrap,
};

use crate::values::{Backdrop, Colour, Extent, LightAt, Resolution, Span, Triple, Up};

/// Render meshes without a GPU: every pixel an integer function, the same on a PC, a microcontroller and an FPGA.
#[derive(Parser, Debug)]
#[command(
    name = "scanout",
    version,
    about = "Render meshes without a GPU, each pixel an integer function",
    long_about = "Render meshes without a GPU: every pixel is an integer function, the same one on a PC, on a \
                  microcontroller and on an FPGA.\n\nWithout a command: the demonstration, in a window, or in \
                  the terminal and as files in ./out.",
    after_help = "Examples:\n  \
                  scanout render teapot.obj -o teapot.png\n  \
                  scanout render teapot.obj --mode hidden --azimuth 45 -o - | display\n  \
                  scanout turntable teapot.obj -o teapot.gif\n  \
                  scanout view teapot.obj\n\n\
                  Exit codes: 0 done, 1 failed or pictures differ, 2 command line not understood.",
    max_term_width = 100
)]
pub struct Cli {
    /// What to do; nothing means `demo`.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// The commands.
#[derive(Subcommand, Debug)]
pub enum Command {
    /// Show what the pipeline does: a window, or a picture in the terminal and files
    Demo(DemoArgs),
    /// Draw a picture of one or more models
    Render(RenderArgs),
    /// Look at models in a window: orbit, pan, zoom
    View(ViewArgs),
    /// Look through the screen as through a window: your head moves, the picture follows
    Window(WindowArgs),
    /// Draw the model turning once: GIF, APNG or a folder of pictures
    Turntable(TurntableArgs),
    /// Tell what a model holds and what it needs on a small machine
    Info(InfoArgs),
    /// Write what firmware links and what hardware reads
    Bake(BakeArgs),
    /// Write a marker to print
    Marker(ar::MarkerArgs),
    /// Put a model on a marker in a film or a webcam's picture, and tell its pose
    Ar(ar::ArArgs),
    /// Find a camera's intrinsics from pictures of a chessboard
    Calibrate(ar::CalibrateArgs),
    /// Draw the 16 test lines of every direction, and list their pixels
    Lines(LinesArgs),
    /// Measure how fast this machine draws, and check that it draws the same pixels as every other
    Bench(BenchArgs),
    /// Write the completions of a shell to standard output
    Completions(CompletionsArgs),
    /// Write the man page to standard output
    Man,
}

/// `scanout demo`.
#[derive(Args, Debug)]
pub struct DemoArgs {
    /// No window, even where there is a display
    #[arg(long)]
    pub no_window: bool,
    /// How to show the picture in the terminal
    #[arg(long, value_enum, value_name = "HOW", default_value_t)]
    pub terminal: Terminal,
    /// Where the files go
    #[arg(short, long, value_name = "DIR", default_value = "out", value_hint = ValueHint::DirPath)]
    pub output: PathBuf,
}

impl DemoArgs {
    /// What `scanout` alone means.
    pub fn standard() -> Self {
        Self { no_window: false, terminal: Terminal::Auto, output: "out".into() }
    }
}

/// What is drawn and from where: shared by render, view and turntable.
#[derive(Args, Debug)]
pub struct SceneArgs {
    /// Models: OBJ, STL, PLY, glTF or GLB; `-` reads standard input
    #[arg(value_name = "MODEL", required = true, value_hint = ValueHint::FilePath)]
    pub models: Vec<PathBuf>,
    /// Format of the models, instead of guessing by name
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub input_format: Option<InputFormat>,
    /// How surfaces are drawn [default: textured; wire or points for what has no faces]; flat, gouraud and phong leave the model's own textures away, but draw that of --texture
    #[arg(long, value_enum, value_name = "MODE")]
    pub mode: Option<DrawMode>,
    /// Picture on the surface, instead of the model's own
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath, visible_alias = "texture-base-color")]
    pub texture: Option<PathBuf>,
    /// How a texel is chosen [default: mipmap]
    #[arg(long, value_enum, value_name = "FILTER")]
    pub texture_filter: Option<TextureFilter>,
    /// What lies outside the texture [default: as the model says, else repeat]
    #[arg(long, value_enum, value_name = "WRAP")]
    pub texture_wrap: Option<TextureWrap>,
    /// Colour of the surface, instead of the model's own
    #[arg(long, value_name = "COLOR")]
    pub color: Option<Colour>,
    /// Draw back faces too [default: of models that are not closed]
    #[arg(long, conflicts_with = "one_sided")]
    pub two_sided: bool,
    /// Draw no back faces, even of models that are not closed
    #[arg(long)]
    pub one_sided: bool,
    /// Side of a point, pixels, 1 - 64
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=64))]
    pub point_size: u8,
    /// Smooth the lines of wire and hidden
    #[arg(long, visible_alias = "anti-aliasing")]
    pub smooth_lines: bool,
    /// Camera.
    #[command(flatten)]
    pub camera: CameraArgs,
    /// Light.
    #[command(flatten)]
    pub light: LightArgs,
    /// Picture.
    #[command(flatten)]
    pub picture: PictureArgs,
}

/// The camera.
#[derive(Args, Debug)]
#[command(next_help_heading = "Camera")]
pub struct CameraArgs {
    /// Where the camera stands; without it the model fills the view
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub camera_position: Option<Triple>,
    /// What it looks at [default: the model's middle]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub camera_focal_point: Option<Triple>,
    /// What is up in the picture [default: as --up]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub camera_view_up: Option<Triple>,
    /// Vertical field of view, degrees, 1 - 170
    #[arg(long, value_name = "DEG", default_value_t = 30.0, value_parser = between(1.0, 170.0))]
    pub camera_view_angle: f64,
    /// Parallel projection
    #[arg(long, visible_alias = "camera-orthographic", conflicts_with_all = ["camera_view_angle", "stereo"])]
    pub orthographic: bool,
    /// Walk around the model, degrees [default: 30, or 0 with --camera-position]
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, visible_alias = "camera-azimuth-angle", value_parser = angle())]
    pub azimuth: Option<f64>,
    /// Rise above the model, degrees [default: 20, or 0 with --camera-position]
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, visible_alias = "camera-elevation-angle", value_parser = angle())]
    pub elevation: Option<f64>,
    /// Tilt the camera, degrees
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, default_value_t = 0.0, value_parser = angle())]
    pub roll: f64,
    /// Enlarge the picture about its middle, 0.01 - 100
    #[arg(long, value_name = "F", default_value_t = 1.0, visible_alias = "camera-zoom-factor", value_parser = between(0.01, 100.0))]
    pub zoom: f64,
    /// Which axis of the model points up
    #[arg(long, value_enum, value_name = "AXIS", default_value = "+Y", ignore_case = true)]
    pub up: Up,
    /// Turn the model to frame K, 4 degrees a frame; the camera stands so that the whole turn fits
    #[arg(long, value_name = "K", allow_hyphen_values = true)]
    pub rotation_frame: Option<i32>,
    /// Axis of that turn, through the model's middle [default: as --up]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub rotation_axis: Option<Triple>,
    /// Two eyes in one picture
    #[arg(long, value_enum, value_name = "HOW")]
    pub stereo: Option<Stereo>,
    /// Distance of the two eyes [default: 1/30 of the distance to the focal point]
    #[arg(long, value_name = "D", requires = "stereo", value_parser = between(0.0, 1e9))]
    pub eye_distance: Option<f64>,
    /// The right eye's picture where the left eye's belongs
    #[arg(long, requires = "stereo")]
    pub swap_eyes: bool,
    /// Off-axis: the eye, from the middle of the screen, z towards the viewer
    #[arg(
        long,
        value_name = "X,Y,Z",
        requires = "screen",
        allow_hyphen_values = true,
        conflicts_with_all = ["camera_position", "camera_view_angle", "orthographic", "zoom"]
    )]
    pub eye: Option<Triple>,
    /// Off-axis: the screen's size; it stands upright through the focal point, unless --azimuth, --elevation or --roll turn it
    #[arg(long, value_name = "W,H", requires = "eye")]
    pub screen: Option<Extent>,
}

/// Lights and how surfaces answer.
#[derive(Args, Debug)]
#[command(next_help_heading = "Light")]
pub struct LightArgs {
    /// Direction towards a light, or point:X,Y,Z for a lamp; may be repeated [default: a strong one at the viewer's upper left, a weak one at the right]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub light: Vec<LightAt>,
    /// Weight of ambient light, 0 - 1 [default: the material's]
    #[arg(long, value_name = "F", value_parser = between(0.0, 1.0))]
    pub ambient: Option<f64>,
    /// Weight of diffuse reflection, 0 - 1 [default: the material's]
    #[arg(long, value_name = "F", value_parser = between(0.0, 1.0))]
    pub diffuse: Option<f64>,
    /// Weight of specular reflection, 0 - 1 [default: the material's]
    #[arg(long, value_name = "F", value_parser = between(0.0, 1.0))]
    pub specular: Option<f64>,
    /// Exponent of specular reflection, 1 - 1024 [default: the material's]
    #[arg(long, value_name = "F", value_parser = between(1.0, 1024.0))]
    pub shininess: Option<f64>,
    /// Least brightness of a lit surface, 0 - 1
    #[arg(long, value_name = "F", default_value_t = 0.0, value_parser = between(0.0, 1.0))]
    pub light_floor: f64,
    /// Fog in the background's colour: none at NEAR, all at FAR
    #[arg(long, value_name = "NEAR,FAR")]
    pub fog: Option<Span>,
}

/// The picture and how it is drawn.
#[derive(Args, Debug)]
#[command(next_help_heading = "Picture")]
pub struct PictureArgs {
    /// Size in pixels
    #[arg(long, value_name = "W,H", default_value = "640,480")]
    pub resolution: Resolution,
    /// What lies behind the model.
    #[arg(
        long,
        value_name = "COLOR|IMAGE",
        visible_alias = "background-color",
        help = "Colour (name, #rrggbb or R,G,B) or picture behind the model [default: #20242c, with rgb332 #494955]"
    )]
    pub background: Option<Backdrop>,
    /// Pixels as the display takes them
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t)]
    pub format: PixelFormat,
    /// Ordered dither, 4 x 4
    #[arg(long)]
    pub dither: bool,
    /// Draw in bands of N lines [default: by --threads]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub bands: Option<u16>,
    /// Threads that draw [default: one a processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: Option<u16>,
}

impl PictureArgs {
    /// What lies behind the model. RGB332 would turn the usual grey, which has little of each colour, to olive.
    pub fn backdrop(&self) -> Backdrop {
        self.background.clone().unwrap_or(Backdrop::Colour(match self.format {
            PixelFormat::Rgb332 => [0x49, 0x49, 0x55],
            _ => [0x20, 0x24, 0x2c],
        }))
    }
}

/// `scanout render`.
#[derive(Args, Debug)]
pub struct RenderArgs {
    /// Where the picture goes: .png, .ppm, .raw, or `-`; without it a terminal shows it
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::FilePath)]
    pub output: Option<PathBuf>,
    /// Format of the picture, instead of by OUT's name (`-`: png)
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub output_format: Option<OutputFormat>,
    /// How to show the picture in the terminal
    #[arg(long, value_enum, value_name = "HOW", default_value_t)]
    pub terminal: Terminal,
    /// Print the frame's hash, alone
    #[arg(long, conflicts_with = "json")]
    pub hash: bool,
    /// Tell counts and times a stage, on standard error
    #[arg(long)]
    pub stats: bool,
    /// Print counts, times and the hash as JSON
    #[arg(long)]
    pub json: bool,
    /// Compare with this PNG or PPM: exit 1 and a difference picture when not equal; --json tells it too
    #[arg(long, value_name = "FILE", visible_alias = "ref", value_hint = ValueHint::FilePath)]
    pub reference: Option<PathBuf>,
    /// Where the difference picture goes, .png, .ppm or .raw; removed when equal [default: beside OUT as *.difference.png, without OUT here with the name of the reference]
    #[arg(long, value_name = "FILE", requires = "reference", value_hint = ValueHint::FilePath)]
    pub difference: Option<PathBuf>,
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
}

/// `scanout view`.
#[derive(Args, Debug)]
#[command(after_help = crate::window::KEYS)]
pub struct ViewArgs {
    /// Tell the frame rate on standard error too
    #[arg(long)]
    pub stats: bool,
    /// Close after N frames
    #[arg(long, value_name = "N")]
    pub frames: Option<u32>,
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
}

/// `scanout turntable`.
#[derive(Args, Debug)]
pub struct TurntableArgs {
    /// .gif, .png (animated), a folder for single pictures, or `-` (GIF)
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::AnyPath)]
    pub output: PathBuf,
    /// Pictures in a turn, 1 - 3600
    #[arg(long, value_name = "N", default_value_t = 90, value_parser = clap::value_parser!(u16).range(1..=3600))]
    pub frames: u16,
    /// Pictures a second, 1 - 100; browsers slow GIFs down above 50
    #[arg(long, value_name = "N", default_value_t = 25, value_parser = clap::value_parser!(u16).range(1..=100))]
    pub fps: u16,
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
}

/// `scanout info`.
#[derive(Args, Debug)]
pub struct InfoArgs {
    /// The model; `-` reads standard input
    #[arg(value_name = "MODEL", value_hint = ValueHint::FilePath)]
    pub model: PathBuf,
    /// Format of the model, instead of guessing by name
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub input_format: Option<InputFormat>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// `scanout bake`.
#[derive(Args, Debug)]
pub struct BakeArgs {
    /// The model; `-` reads standard input
    #[arg(value_name = "MODEL", value_hint = ValueHint::FilePath)]
    pub model: PathBuf,
    /// Format of the model, instead of guessing by name
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub input_format: Option<InputFormat>,
    /// Textures of the binary with a palette of so many colours: a byte a texel (256) or half a byte (16), instead of two
    #[arg(long, value_enum, value_name = "COLOURS")]
    pub palette: Option<PaletteSize>,
    /// Folder for the files
    #[arg(short, long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub output: PathBuf,
}

/// Colours of a palette.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum PaletteSize {
    /// Half a byte a texel
    #[value(name = "16")]
    Sixteen,
    /// A byte a texel
    #[value(name = "256")]
    TwoHundredAndFiftySix,
}

/// `scanout lines`.
#[derive(Args, Debug)]
pub struct LinesArgs {
    /// One line in each octant and on each border of two, from red to blue
    #[arg(long, required = true)]
    pub octants: bool,
    /// Where the picture goes: .png, .ppm, .raw, or `-`
    #[arg(short, long, value_name = "OUT", value_hint = ValueHint::FilePath, required_unless_present = "table")]
    pub output: Option<PathBuf>,
    /// Format of the picture, instead of by OUT's name (`-`: png)
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub output_format: Option<OutputFormat>,
    /// The pixels as text, `line x y r g b`; `-` is standard output
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub table: Option<PathBuf>,
    /// Size in pixels
    #[arg(long, value_name = "W,H", default_value = "241,241")]
    pub resolution: Resolution,
}

/// `scanout bench`.
#[derive(Args, Debug)]
#[command(after_help = crate::cmd::bench::EXPLANATION)]
pub struct BenchArgs {
    /// Only cases with one of these words in their name; or SOURCE:LOOK:WIDTHxHEIGHT of your own
    #[arg(long, value_name = "WORD", value_delimiter = ',')]
    pub cases: Vec<String>,
    /// A model of your own, drawn flat, gouraud, textured and wire at 640x480; may be repeated
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub model: Vec<PathBuf>,
    /// Seconds for each case and number of threads, 0.01 - 600
    #[arg(long, value_name = "SECONDS", default_value_t = 0.5, value_parser = between(0.01, 600.0))]
    pub time: f64,
    /// Numbers of threads, each 1 - 256 [default: 1, 2, and one a processor]
    #[arg(long, value_name = "N", value_delimiter = ',', value_parser = clap::value_parser!(u16).range(1..=256))]
    pub threads: Vec<u16>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

/// `scanout completions`.
#[derive(Args, Debug)]
pub struct CompletionsArgs {
    /// The shell
    #[arg(value_enum, value_name = "SHELL")]
    pub shell: clap_complete::Shell,
}

pub(crate) fn between(low: f64, high: f64) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| match text.parse::<f64>() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        Ok(_) => Err(format!("not in {low} - {high}")),
        Err(_) => Err("no number".into()),
    }
}

fn angle() -> impl Fn(&str) -> Result<f64, String> + Clone {
    between(-3600.0, 3600.0)
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory, ValueEnum};

    use super::*;

    #[test]
    fn the_definition_is_sound() {
        Cli::command().debug_assert();
    }

    #[test]
    fn negative_vectors_are_values() {
        let line = "scanout render a.obj --camera-position -1,-2,3 --azimuth -30 --light -1,0,0";
        let cli = Cli::try_parse_from(line.split(' ')).unwrap();
        let Some(Command::Render(args)) = cli.command else { panic!("render") };
        assert_eq!(args.scene.camera.camera_position, Some(Triple([-1.0, -2.0, 3.0])));
        assert_eq!(args.scene.camera.azimuth, Some(-30.0));
    }

    #[test]
    fn the_default_backgrounds_stay_grey() {
        use scanout::output::{PixelFormat as _, Rgb332};
        let line = "scanout render a.obj --format rgb332".split(' ');
        let Some(Command::Render(args)) = Cli::parse_from(line).command else { panic!("render") };
        let Backdrop::Colour(rgb) = args.scene.picture.backdrop() else { panic!("a colour") };
        let mut row = [0];
        Rgb332::store(&mut row, 0, Rgb332::encode(rgb));
        assert_eq!(Rgb332::load(&row, 0), rgb, "exact in RGB332");
        let most = (0..3).map(|i| rgb[i].abs_diff(rgb[(i + 1) % 3])).max();
        assert!(most < Some(16), "{rgb:?}");
    }

    #[test]
    fn modes_and_their_names_agree() {
        for mode in DrawMode::ALL {
            assert_eq!(mode.to_possible_value().unwrap().get_name(), mode.name());
        }
    }
}
