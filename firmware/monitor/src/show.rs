//! Frames where a person sees them.

use std::io::{self, BufWriter, IsTerminal, Write};

use scanout::output::widen565 as rgb;
use scanout_display::model::Picture;

/// Where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum How {
    /// In this terminal, two pixels a character, 24-bit colours.
    Terminal,
    /// In a window.
    Window,
}

impl How {
    /// By name.
    pub fn parse(word: &str) -> Result<Self, String> {
        match word {
            "terminal" => Ok(How::Terminal),
            "window" => Ok(How::Window),
            _ => Err(format!("{word} is nowhere to show; terminal or window")),
        }
    }
}

/// A place that shows frames.
pub enum Screen {
    /// The terminal.
    Terminal,
    /// A window, which runs on the first thread.
    #[cfg(feature = "window")]
    Window(std::sync::Arc<crate::window::Shared>),
}

impl Screen {
    /// This terminal.
    pub fn terminal() -> Result<Self, String> {
        if !io::stdout().is_terminal() {
            return Err("standard output is no terminal; use --hashes or --png".into());
        }
        print!("\x1b[2J");
        Ok(Screen::Terminal)
    }

    /// Shows a frame; false when nobody looks any more.
    pub fn show(&mut self, picture: &Picture<u16>) -> bool {
        match self {
            Screen::Terminal => half_blocks(picture).is_ok(),
            #[cfg(feature = "window")]
            Screen::Window(shared) => shared.put(picture),
        }
    }
}

/// The picture at a quarter of its size: 80 x 30 characters, the upper half block in the upper pixel's colour.
fn half_blocks(picture: &Picture<u16>) -> io::Result<()> {
    let mut out = BufWriter::new(io::stdout().lock());
    write!(out, "\x1b[H")?;
    let mean = |x: u16, y: u16| {
        let mut sum = [0u32; 3];
        for (dx, dy) in (0..16).map(|i| (i % 4, i / 4)) {
            let pixel = rgb(picture.at(4 * x + dx, 4 * y + dy));
            sum = [0, 1, 2].map(|i| sum[i] + u32::from(pixel[i]));
        }
        sum.map(|v| (v + 8) / 16)
    };
    for row in 0..picture.height / 8 {
        for x in 0..picture.width / 4 {
            let ([r, g, b], [s, h, c]) = (mean(x, 2 * row), mean(x, 2 * row + 1));
            write!(out, "\x1b[38;2;{r};{g};{b};48;2;{s};{h};{c}m\u{2580}")?;
        }
        writeln!(out, "\x1b[0m")?;
    }
    out.flush()
}

/// Writes a frame as a picture.
pub fn png(path: &str, picture: &Picture<u16>) -> io::Result<()> {
    let file = BufWriter::new(std::fs::File::create(path)?);
    let mut encoder = png::Encoder::new(file, picture.width.into(), picture.height.into());
    encoder.set_color(png::ColorType::Rgb);
    let pixels: Vec<u8> = picture.pixels.iter().flat_map(|&pixel| rgb(pixel)).collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&pixels)?;
    Ok(writer.finish()?)
}
