//! Finds markers in a stream of binary PGM pictures on standard input; the judges' harness drives it.
//!
//! ```text
//!  cargo run --release -p scanout-ar --example detect -- aruco4x4_50 apriltag36h11 < pictures.pgm
//! ```
//!
//! For each picture a line: the processor's time in microseconds, then for each marker `name:id` and eight coordinates.

use std::io::{BufReader, BufWriter, Read, Write};

use rustix::time::{ClockId, clock_gettime};
use scanout_ar::{Detector, Dictionary, GreyImage};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut dictionaries = Vec::new();
    for name in std::env::args().skip(1) {
        dictionaries.push(Dictionary::by_name(&name).ok_or(format!("{name}: no such dictionary"))?);
    }
    let mut detector = Detector::new(&dictionaries);
    let mut input = BufReader::new(std::io::stdin().lock());
    let mut output = BufWriter::new(std::io::stdout().lock());
    while let Some((width, height, pixels)) = read_pgm(&mut input)? {
        let image = GreyImage::new(width, height, width, &pixels).ok_or("picture too short")?;
        let start = clock_gettime(ClockId::ThreadCPUTime);
        let names: Vec<&str> = detector.dictionaries().iter().map(|d| d.name).collect();
        let found = detector.detect(&image)?;
        let end = clock_gettime(ClockId::ThreadCPUTime);
        let micros = (end.tv_sec - start.tv_sec) * 1_000_000 + (end.tv_nsec - start.tv_nsec) / 1000;
        write!(output, "{micros}")?;
        for one in found {
            write!(output, " {}:{}", names[usize::from(one.dictionary)], one.id)?;
            for value in one.corners.as_flattened() {
                write!(output, " {value:.5}")?;
            }
        }
        writeln!(output)?;
        output.flush()?;
    }
    Ok(())
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
