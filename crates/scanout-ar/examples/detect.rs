//! Finds markers in a stream of binary PGM pictures on standard input; the judges' harness drives it.
//!
//! ```text
//!  cargo run --release -p scanout-ar --example detect -- [OPTIONS] aruco4x4_50 apriltag36h11 < pictures.pgm
//!
//!  --lens FX,FY,CX,CY,K1,K2,P1,P2,K3   intrinsics, pixel centres at .5: poses are told too
//!  --size S                            side of the markers
//!  --fps N                             the pictures are frames of a film: poses are decided by the last frames
//!  --filter                            and filtered
//!  --again                             markers are looked for where they were in the last frame
//! ```
//!
//! For each picture a line: the processor's time in microseconds, then for each marker `name:id:wrong bits:agreement`, eight coordinates, and with
//! `--lens` nine entries of the rotation and three of the translation.

use std::collections::HashMap;
use std::io::{BufReader, BufWriter, Read, Write};

use rustix::time::{ClockId, clock_gettime};
use scanout_ar::pose::filter::OneEuro;
use scanout_ar::pose::planar::solve_square;
use scanout_ar::pose::track::Track;
use scanout_ar::{Detection, Detector, Dictionary, GreyImage, Lens, Pose};

struct Options {
    lens: Option<Lens>,
    size: f64,
    fps: Option<f64>,
    filter: Option<OneEuro>,
    again: bool,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut dictionaries = Vec::new();
    let mut options = Options { lens: None, size: 1.0, fps: None, filter: None, again: false };
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
        match argument.as_str() {
            "--lens" => {
                let numbers: Result<Vec<f64>, _> = value()?.split(',').map(str::parse).collect();
                let [fx, fy, cx, cy, k1, k2, p1, p2, k3] =
                    numbers?[..].try_into().map_err(|_| "--lens needs nine numbers")?;
                let distortion = [k1, k2, p1, p2, k3];
                options.lens = Some(Lens { focal: [fx, fy], centre: [cx, cy], distortion });
            }
            "--size" => options.size = value()?.parse()?,
            "--fps" => options.fps = Some(value()?.parse()?),
            "--filter" => options.filter = Some(OneEuro::default()),
            "--again" => options.again = true,
            name => dictionaries
                .push(Dictionary::by_name(name).ok_or(format!("{name}: no such dictionary"))?),
        }
    }
    let mut detector = Detector::new(&dictionaries);
    detector.film = options.again;
    let names: Vec<&str> = detector.dictionaries().iter().map(|d| d.name).collect();
    let mut tracks = HashMap::new();
    let mut input = BufReader::new(std::io::stdin().lock());
    let mut output = BufWriter::new(std::io::stdout().lock());
    let mut frame = 0;
    while let Some((width, height, pixels)) = read_pgm(&mut input)? {
        let image = GreyImage::new(width, height, width, &pixels).ok_or("picture too short")?;
        let start = clock_gettime(ClockId::ThreadCPUTime);
        let found = detector.detect(&image)?;
        let end = clock_gettime(ClockId::ThreadCPUTime);
        let micros = (end.tv_sec - start.tv_sec) * 1_000_000 + (end.tv_nsec - start.tv_nsec) / 1000;
        write!(output, "{micros}")?;
        for one in found {
            let name = names[usize::from(one.dictionary)];
            write!(output, " {name}:{}:{}:{:.3}", one.id, one.wrong, one.agreement)?;
            for value in one.corners.as_flattened() {
                write!(output, " {value:.5}")?;
            }
            if options.lens.is_some() {
                match pose(&options, &mut tracks, frame, one) {
                    Some(pose) => {
                        for value in pose.rotation.as_flattened().iter().chain(&pose.translation) {
                            write!(output, " {value:.9}")?;
                        }
                    }
                    None => write!(output, "{}", " nan".repeat(12))?,
                }
            }
        }
        writeln!(output)?;
        output.flush()?;
        frame += 1;
    }
    Ok(())
}

fn pose(
    options: &Options,
    tracks: &mut HashMap<(u8, u16), Track>,
    frame: u32,
    one: &Detection,
) -> Option<Pose> {
    let lens = options.lens?;
    let Some(fps) = options.fps else {
        return Some(solve_square(&lens, options.size, &one.corners)?[0].pose);
    };
    let track =
        tracks.entry((one.dictionary, one.id)).or_insert_with(|| Track::new(options.filter));
    Some(track.update(f64::from(frame) / fps, &lens, options.size, &one.corners)?.0)
}

/// `P5`, width, height and 255 with one white-space byte after each, then the pixels; `None` at the end.
fn read_pgm(input: &mut impl Read) -> std::io::Result<Option<(usize, usize, Vec<u8>)>> {
    let mut words: Vec<String> = vec![String::new()];
    while words.len() <= 4 {
        let mut byte = [0];
        if input.read(&mut byte)? == 0 {
            return Ok(None);
        }
        match byte[0] {
            b' ' | b'\n' => words.push(String::new()),
            other => words.last_mut().into_iter().for_each(|word| word.push(other.into())),
        }
    }
    let number = |word: &str| word.parse().map_err(std::io::Error::other);
    let (width, height) = (number(&words[1])?, number(&words[2])?);
    let mut pixels = vec![0; width * height];
    input.read_exact(&mut pixels)?;
    Ok(Some((width, height, pixels)))
}
