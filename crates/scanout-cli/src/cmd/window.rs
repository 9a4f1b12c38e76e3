//! `scanout window`: the screen is a hole into the scene, and the viewer's own position decides what is seen.

mod scenery;
mod viewer;

use std::fs::File;
use std::io::BufReader;
use std::path::Path;
use std::time::Instant;

use scanout_head::camera::{self, Camera, FaceFinder, Find, Marker, MarkerFinder, Mount, Sight};
use scanout_head::face::{Cascade, Localiser, ModelError};
use scanout_head::latency::Latency;
use scanout_head::manual::Manual;
use scanout_head::one_euro::Settings;
use scanout_head::opentrack::Opentrack;
use scanout_head::recording::{self, Replay};
use scanout_head::screen::Screen;
use scanout_head::source::Sample;
use scanout_head::tracker::{self, Calibration, Tracker};

use self::viewer::{Head, Record, Viewer};
use crate::animation::{self, Writer};
use crate::args::WindowArgs;
use crate::cmd::info::scene_args;
use crate::draw::{Options, processors};
use crate::error::{Error, Result};
use crate::image_out::is_dash;
use crate::scene_builder::Stage;
use crate::scene_builder::view::Fit;
use crate::window::{self, NoWindow, Setting};
use crate::{narrate, progress};

/// The end of `scanout window --help`.
pub const EXPLANATION: &str = "The mouse stands for the head; arrow keys move it too, + and - or the wheel nearer and farther, R back to the middle, Esc quits.\n\
opentrack (or a phone that speaks its protocol): output 'UDP over network' to this machine, port 4242, and --head udp. \
The picture is right for one viewer, who sits where the tracker says; with --stereo also in depth.\n\n\
Examples:\n  \
scanout window --screen 520x290mm --fullscreen\n  \
scanout window teapot.obj --head udp --stereo anaglyph-dubois --fullscreen\n  \
scanout window --head udp --record head.csv\n  \
scanout window --head head.csv -o head.gif\n  \
scanout marker aruco4x4_50:0 --size 50mm -o cap.pdf\n  \
scanout window --head camera --marker aruco4x4_50:0 --marker-size 50 --camera-tilt -10";

/// The screen of a 24-inch display, when nobody measured.
const USUAL: [f64; 2] = [520.0, 290.0];

/// What to measure, for somebody who has not.
const FIRST_RUN: &str = "scanout: for a true window, measure in millimetres and give --screen, --viewer and --fullscreen:\n\
scanout:   --screen WxHmm   width and height of the lit picture (a 520x290mm one, 24 inches, is supposed now), --tilt if it leans back\n\
scanout:   --viewer X,Y,Z   your eyes from its middle: right, up, distance (0,0,600 is supposed); --head-origin for a tracker's zero";

/// The most pictures that -o writes.
const MOST_PICTURES: u32 = 100_000;

/// Opens the window, or writes the pictures of a recording.
pub fn run(args: &WindowArgs) -> Result<()> {
    let screen = screen(args)?;
    let epoch = Instant::now();
    if args.face.is_some() && args.head != "camera" {
        let what = format_args!("--face with --head {}: nobody would look", args.head).to_string();
        return Err(Error::usage(what, "add --head camera"));
    }
    if let Some(path) = &args.output {
        animation::container_for(path)?;
        let film = args.head == "camera" && is_film(&args.source);
        let live = matches!(args.head.as_str(), "mouse" | "keys" | "udp" | "camera");
        if live && !film {
            return Err(Error::usage(
                "pictures are written of a recording or a film",
                "give --head FILE.csv, recorded with --record, or --head camera --source FILM",
            ));
        }
    }
    let (mut head, duration) = head(args, &screen, epoch)?;
    let from_zero = args.head_origin.map(|origin| origin.0);
    let origin = from_zero.unwrap_or(if args.head == "udp" { args.viewer.0 } else { [0.0; 3] });
    let calibration = Calibration { origin, scale: args.head_scale.0 };
    let filter = Settings { minimum: args.filter_cutoff, beta: args.filter_beta };
    let tracker = Tracker::new(tracker::Options {
        calibration,
        filter: (!args.no_filter).then_some(filter),
        prediction: args.predict / 1000.0,
        rest: args.viewer.0,
        silence_is_loss: head.source().silence_is_loss(),
    });
    let (stage, shot) = stage(args, &screen)?;
    let mut viewer = Viewer {
        stage,
        shot,
        options: Options {
            format: crate::args::PixelFormat::Rgb888,
            dither: false,
            bands: None,
            threads: processors(),
        },
        screen,
        head,
        tracker,
        calibration,
        record: args.record.as_deref().map(Record::create).transpose()?,
        latency: Latency::default(),
        epoch,
        newest: None,
        fullscreen: args.fullscreen,
    };
    let done = match (&args.output, duration) {
        (Some(path), Some(duration)) => write(&mut viewer, args, path, duration),
        _ => show(&mut viewer, args),
    };
    if let Some(record) = viewer.record.take() {
        record.finish()?;
    }
    if args.output.is_none()
        && let Some(summary) = viewer.latency.summary()
    {
        narrate!("scanout: {summary}");
    }
    done
}

fn screen(args: &WindowArgs) -> Result<Screen> {
    let [width, height] = args.screen.map_or(USUAL, |size| size.0);
    let screen = Screen::new(width, height, args.tilt);
    screen.map_err(|error| Error::usage(error, "correct --screen or --tilt"))
}

/// Who moves the viewer, and how long if it is a recording.
fn head(args: &WindowArgs, screen: &Screen, epoch: Instant) -> Result<(Head, Option<f64>)> {
    match args.head.as_str() {
        "mouse" => Ok((Head::Hand(Manual::new(args.viewer.0), true), None)),
        "keys" => Ok((Head::Hand(Manual::new(args.viewer.0), false), None)),
        "udp" => {
            let source = Opentrack::bind(args.listen, epoch).map_err(|error| {
                let remedy = "close what listens there, or choose another address with --listen";
                Error::failed(args.listen, error.to_string().to_lowercase(), remedy)
            })?;
            narrate!("scanout: opentrack's packets are awaited on {}", source.address());
            Ok((Head::Other(Box::new(source)), None))
        }
        name if name.contains('.') => {
            let path = Path::new(name);
            let file = File::open(path).map_err(|error| Error::io(path, &error))?;
            let samples = recording::read(BufReader::new(file))
                .map_err(|error| Error::Failed(format!("{name}: {error}")))?;
            Ok(replayed(samples, args))
        }
        "camera" => camera(args, screen, epoch),
        other => Err(Error::usage(
            format_args!("--head {other}: no such source"),
            "one of mouse, keys, udp, camera, or a recording's FILE.csv",
        )),
    }
}

fn replayed(samples: Vec<Sample>, args: &WindowArgs) -> (Head, Option<f64>) {
    let replay = Replay::new(samples, args.output.is_none());
    let duration = replay.duration();
    (Head::Other(Box::new(replay)), Some(duration))
}

/// Frames with an end and a pace of their own, unlike a webcam's or those of a pipe.
fn is_film(source: &Path) -> bool {
    !is_dash(source) && !source.starts_with("/dev")
}

/// The viewer, seen by a camera or in a film of one.
fn camera(args: &WindowArgs, screen: &Screen, epoch: Instant) -> Result<(Head, Option<f64>)> {
    let (mut finder, what) = finder(args, sight(args)?, mount(args, screen))?;
    let failed = |error: camera::VideoError| Error::Failed(error.to_string());
    if !is_film(&args.source) {
        let camera = Camera::start(&args.source, args.source_fps, finder, epoch).map_err(failed)?;
        return Ok((Head::Other(Box::new(camera)), None));
    }
    let film = camera::film(&args.source, args.source_fps, &mut *finder, |error| {
        narrate!("scanout: {error}");
    });
    let samples = film.map_err(failed)?;
    let seen = samples.iter().filter(|sample| sample.eye.is_some()).count();
    narrate!("scanout: {}: {what} is in {seen} of {} frames", args.source.display(), samples.len());
    if samples.is_empty() {
        return Err(Error::failed(
            args.source.display(),
            "no frame can be read",
            "give another film",
        ));
    }
    Ok(replayed(samples, args))
}

/// Who looks at the frames, and what for.
fn finder(args: &WindowArgs, sight: Sight, mount: Mount) -> Result<(Box<dyn Find>, String)> {
    let (Some(face), Some(eyes)) = (&args.face, &args.eyes) else {
        let marker = Marker::by_name(&args.marker, args.marker_size).ok_or_else(|| {
            let what = format_args!("--marker {}: no such marker", args.marker).to_string();
            Error::usage(what, "give DICTIONARY:NUMBER, such as aruco4x4_50:0 or apriltag36h11:5")
        })?;
        return Ok((Box::new(MarkerFinder::new(marker, sight, mount)), args.marker.clone()));
    };
    if args.eye_distance < 30.0 {
        let what = format_args!("--eye-distance {}: too little to tell depth", args.eye_distance);
        return Err(Error::usage(what, "measure from pupil to pupil; 63 is usual"));
    }
    let cascade = model(face, Cascade::read)?;
    let localiser = model(eyes, Localiser::read)?;
    let finder = FaceFinder::new(cascade, localiser, args.eye_distance, sight, mount);
    Ok((Box::new(finder), "a face".into()))
}

fn model<T>(path: &Path, read: fn(&[u8]) -> std::result::Result<T, ModelError>) -> Result<T> {
    let bytes = std::fs::read(path).map_err(|error| Error::io(path, &error))?;
    read(&bytes).map_err(|error| {
        let remedy = "fetch it anew with scripts/face-models; --face and --eyes are not the same";
        Error::failed(path.display(), error, remedy)
    })
}

/// How the camera sees.
fn sight(args: &WindowArgs) -> Result<Sight> {
    let Some(path) = &args.calibration else { return Ok(Sight::FieldOfView(args.fov)) };
    let text = std::fs::read_to_string(path).map_err(|error| Error::io(path, &error))?;
    camera::calibration(&text).map_err(|error| Error::Failed(format!("{}:{error}", path.display())))
}

/// Where the camera is.
fn mount(args: &WindowArgs, screen: &Screen) -> Mount {
    let above = || screen.at(0.0, 1.0 + 20.0 / screen.size[1]);
    let place = args.camera_place.map_or_else(above, |place| place.0);
    Mount { place, tilt: args.camera_tilt }
}

/// The scene, and a shot whose window is the screen.
fn stage(args: &WindowArgs, screen: &Screen) -> Result<(Stage, crate::scene_builder::Shot)> {
    let [w, h] = screen.size;
    let window = [format!("{w},{h}"), "--eye=0,0,600".into()];
    let options = ["--screen", &window[0], &window[1], "--camera-focal-point", "0,0,0"];
    let mut scene = scene_args(&options);
    scene.camera.stereo = args.stereo;
    scene.camera.eye_distance = args.stereo.map(|_| args.eye_distance);
    scene.camera.swap_eyes = args.swap_eyes;
    let mut stage = Stage::with_models(scenery::models(args, screen.size)?, &scene)?;
    if let Some(mode) = args.mode {
        stage.set_mode_of_faces(mode);
    }
    let size = (args.resolution.width, args.resolution.height);
    let shot = stage.shot(&scene, size, Fit::Tight)?;
    Ok((stage, shot))
}

fn show(viewer: &mut Viewer, args: &WindowArgs) -> Result<()> {
    let size = (args.resolution.width, args.resolution.height);
    let setting = Setting { size, frames: args.frames };
    if args.screen.is_none() {
        narrate!("{FIRST_RUN}");
    }
    match window::run(viewer, setting) {
        Ok(outcome) => outcome,
        Err(NoWindow(why)) => Err(Error::failed(
            "window",
            why,
            "record elsewhere and write pictures with 'scanout window --head FILE.csv -o OUT'",
        )),
    }
}

/// The pictures that the recording's viewer would have seen.
fn write(viewer: &mut Viewer, args: &WindowArgs, path: &Path, duration: f64) -> Result<()> {
    let container = animation::container_for(path)?;
    let (width, height) = (args.resolution.width, args.resolution.height);
    let all = (duration * f64::from(args.fps)).floor() as u32 + 1;
    let frames = args.frames.unwrap_or(all).clamp(1, MOST_PICTURES);
    let mut writer = Writer::create(path, (width.into(), height.into()), frames, args.fps)?;
    let bar = progress::bar(frames.into(), "window");
    // GIF counts in 1/100 s; rounding each picture alike would change the speed.
    let time = |frame: u32| (200 * frame + u32::from(args.fps)) / (2 * u32::from(args.fps));
    for frame in 0..frames {
        let now = f64::from(frame) / f64::from(args.fps);
        let picture = viewer.picture(now, width, height)?;
        let delay = (time(frame + 1) - time(frame)) as u16;
        writer.push(&animation::encode(container, picture, delay))?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    writer.finish()?;
    if !is_dash(path) {
        narrate!("scanout: wrote {} ({frames} frames)", path.display());
    }
    Ok(())
}
