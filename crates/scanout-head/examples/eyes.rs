//! Where the eyes are in each frame of a film, for judges:
//!
//! `cargo run --release -p scanout-head --features camera --example eyes -- FACE EYES FILM [--anew]`
//!
//! A line a frame: both pupils (x y x y, pixels, the first pixel's centre at 0.5), the face's box (x y side), how sure it is, and ms;
//! `-` where nobody is seen. `--anew` forgets the frame before.

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use scanout_head::face::{Cascade, Finder, Grey, Localiser};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [face, eyes, film, options @ ..] = arguments.as_slice() else {
        return Err("usage: eyes FACE EYES FILM [--anew]".into());
    };
    let cascade = Cascade::read(&std::fs::read(face)?)?;
    let localiser = Localiser::read(&std::fs::read(eyes)?)?;
    let mut finder = Finder::new(cascade, localiser);
    let mut frames = scanout_video::Source::open(Path::new(film), 30.0)?;
    let mut levels = Vec::new();
    while let Some(frame) = frames.next() {
        let frame = frame?;
        frame.grey(&mut levels);
        let grey = Grey::new(&levels, frame.width).ok_or("an empty frame")?;
        if options.first().is_some_and(|option| option == "--anew") {
            finder.forget();
        }
        let start = Instant::now();
        // As a camera of 60 degrees sees people up to 1.5 m away.
        let found = finder.find(&grey, [frame.width as f64 * 0.104, frame.height as f64]);
        let ms = start.elapsed().as_secs_f64() * 1e3;
        match found {
            None => println!("- {ms:.3}"),
            Some(eyes) => {
                let [[ax, ay], [bx, by]] = eyes.pupils;
                let face = eyes.face;
                let sure = face.score as f64 / 65_536.0;
                println!(
                    "{ax} {ay} {bx} {by} {} {} {} {sure:.2} {ms:.3}",
                    face.x, face.y, face.side
                );
            }
        }
    }
    Ok(())
}
