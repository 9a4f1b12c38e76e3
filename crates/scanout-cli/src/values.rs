//! Values on the command line: vectors, sizes, colours.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

/// Three numbers, `X,Y,Z`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triple(pub [f64; 3]);

impl FromStr for Triple {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        numbers::<3>(text, "X,Y,Z").map(Self)
    }
}

/// Two positive numbers, `W,H`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent(pub [f64; 2]);

impl FromStr for Extent {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let [w, h] = numbers::<2>(text, "W,H")?;
        if w > 0.0 && h > 0.0 { Ok(Self([w, h])) } else { Err("both must be above 0".into()) }
    }
}

/// Two distances, `NEAR,FAR`, 0 <= NEAR < FAR.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span(pub [f64; 2]);

impl FromStr for Span {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let [near, far] = numbers::<2>(text, "NEAR,FAR")?;
        if 0.0 <= near && near < far {
            Ok(Self([near, far]))
        } else {
            Err("expected NEAR,FAR with 0 <= NEAR < FAR".into())
        }
    }
}

fn numbers<const N: usize>(text: &str, shape: &str) -> Result<[f64; N], String> {
    let mut out = [0.0f64; N];
    let mut parts = text.split(',');
    for slot in &mut out {
        let part = parts.next().ok_or_else(|| format!("expected {shape}"))?.trim();
        *slot = part.parse().map_err(|_| format!("'{part}' is no number, expected {shape}"))?;
        if !slot.is_finite() {
            return Err(format!("'{part}' is not finite, expected {shape}"));
        }
    }
    if parts.next().is_some() { Err(format!("expected {shape}")) } else { Ok(out) }
}

/// Width and height in pixels, `W,H` or `WxH`, each 1 - 4096.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resolution {
    /// Pixels in a row.
    pub width: u16,
    /// Rows.
    pub height: u16,
}

/// The largest width or height that the program accepts, pixels.
pub const MAX_SIDE: u16 = 4096;

impl FromStr for Resolution {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (w, h) = text.split_once([',', 'x']).ok_or("expected W,H")?;
        let side = |part: &str| {
            let part = part.trim();
            part.parse::<u16>().ok().filter(|side| (1..=MAX_SIDE).contains(side)).ok_or_else(|| {
                format!("'{part}' is no size, expected W,H of whole numbers from 1 to {MAX_SIDE}")
            })
        };
        Ok(Self { width: side(w)?, height: side(h)? })
    }
}

impl fmt::Display for Resolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.width, self.height)
    }
}

/// A screen's width and height, `WxHmm`, `WxHcm` or `WxHin`; millimetres without a unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Millimetres(pub [f64; 2]);

impl FromStr for Millimetres {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let units = [("mm", 1.0), ("cm", 10.0), ("in", 25.4)];
        let found = units.iter().find_map(|(unit, mm)| Some((text.strip_suffix(unit)?, *mm)));
        let (numbers, unit) = found.unwrap_or((text, 1.0));
        let expected = || format!("'{text}' is no size, expected WxHmm, such as 520x290mm");
        let (w, h) = numbers.split_once(['x', ',']).ok_or_else(expected)?;
        let side = |part: &str| part.trim().parse::<f64>().map_err(|_| expected());
        let size = [side(w)? * unit, side(h)? * unit];
        match scanout_head::screen::Screen::new(size[0], size[1], 0.0) {
            Ok(_) => Ok(Self(size)),
            Err(error) => Err(error.to_string()),
        }
    }
}

/// A light: `X,Y,Z` towards it (parallel light), or `point:X,Y,Z` where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightAt {
    /// Parallel light from this direction.
    Towards([f64; 3]),
    /// A lamp at this place of the model's space.
    Point([f64; 3]),
}

impl FromStr for LightAt {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(place) = text.strip_prefix("point:") {
            return numbers::<3>(place, "point:X,Y,Z").map(Self::Point);
        }
        match numbers::<3>(text, "X,Y,Z or point:X,Y,Z")? {
            [0.0, 0.0, 0.0] => Err("a direction can't be 0,0,0".into()),
            towards => Ok(Self::Towards(towards)),
        }
    }
}

/// A colour: a name, `#rgb`, `#rrggbb` or `R,G,B` with 0 - 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour(pub [u8; 3]);

/// The names of colours that the program knows (CSS's sixteen, and a few more).
const NAMES: [(&str, u32); 22] = [
    ("black", 0x000000),
    ("silver", 0xc0c0c0),
    ("gray", 0x808080),
    ("grey", 0x808080),
    ("white", 0xffffff),
    ("maroon", 0x800000),
    ("red", 0xff0000),
    ("purple", 0x800080),
    ("fuchsia", 0xff00ff),
    ("magenta", 0xff00ff),
    ("green", 0x008000),
    ("lime", 0x00ff00),
    ("olive", 0x808000),
    ("yellow", 0xffff00),
    ("navy", 0x000080),
    ("blue", 0x0000ff),
    ("teal", 0x008080),
    ("aqua", 0x00ffff),
    ("cyan", 0x00ffff),
    ("orange", 0xffa500),
    ("pink", 0xffc0cb),
    ("brown", 0xa52a2a),
];

const fn split(rgb: u32) -> [u8; 3] {
    let [_, r, g, b] = rgb.to_be_bytes();
    [r, g, b]
}

impl FromStr for Colour {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected =
            || format!("'{text}' is no colour, expected a name, #rrggbb or R,G,B (0-255)");
        let lower = text.trim().to_ascii_lowercase();
        if let Some((_, rgb)) = NAMES.iter().find(|(name, _)| *name == lower) {
            return Ok(Self(split(*rgb)));
        }
        if let Some(hex) = lower.strip_prefix('#') {
            let value = u32::from_str_radix(hex, 16).map_err(|_| expected())?;
            return match hex.len() {
                6 => Ok(Self(split(value))),
                3 => Ok(Self([8, 4, 0].map(|shift| ((value >> shift & 15) * 17) as u8))),
                _ => Err(expected()),
            };
        }
        let parts: Vec<u8> = lower
            .split(',')
            .map(|part| part.trim().parse::<u8>())
            .collect::<Result<_, _>>()
            .map_err(|_| expected())?;
        parts.try_into().map(Self).map_err(|_| expected())
    }
}

/// What lies behind the model: a colour, or a picture's file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Backdrop {
    /// One colour.
    Colour([u8; 3]),
    /// A picture, stretched over the frame.
    Image(PathBuf),
}

impl FromStr for Backdrop {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse::<Colour>() {
            Ok(Colour(rgb)) => Ok(Self::Colour(rgb)),
            // A name with a dot or a folder is a file; anything else is a colour that was misspelt.
            Err(message) => {
                if text.contains(['.', '/', '\\']) {
                    Ok(Self::Image(text.into()))
                } else {
                    Err(format!("{message} (or the file of a picture, such as ./photo.png)"))
                }
            }
        }
    }
}

/// `AXIS`: which axis of the model points up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Up {
    /// +Y, as in most OBJ and glTF files.
    #[value(name = "+Y", aliases = ["+y", "Y", "y"])]
    Y,
    /// +Z, as in most STL files and CAD.
    #[value(name = "+Z", aliases = ["+z", "Z", "z"])]
    Z,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours() {
        assert_eq!("#8Af".parse(), Ok(Colour([0x88, 0xaa, 0xff])));
        assert_eq!("#8040ff".parse(), Ok(Colour([0x80, 0x40, 0xff])));
        assert_eq!("12, 0,255".parse(), Ok(Colour([12, 0, 255])));
        assert_eq!("Teal".parse(), Ok(Colour([0, 128, 128])));
        assert!("#12345".parse::<Colour>().is_err());
        assert!("256,0,0".parse::<Colour>().is_err());
        assert!("1,2".parse::<Colour>().is_err());
    }

    #[test]
    fn a_file_and_a_misspelt_colour_are_told_apart() {
        assert_eq!("a.png".parse(), Ok(Backdrop::Image("a.png".into())));
        assert_eq!("white".parse(), Ok(Backdrop::Colour([255; 3])));
        assert!("whitte".parse::<Backdrop>().is_err());
    }

    #[test]
    fn sizes_have_bounds() {
        assert_eq!("320x240".parse(), Ok(Resolution { width: 320, height: 240 }));
        assert_eq!("1,4096".parse(), Ok(Resolution { width: 1, height: 4096 }));
        for bad in ["0,1", "1,4097", "12", "-1,5", "1,2,3"] {
            assert!(bad.parse::<Resolution>().is_err(), "{bad}");
        }
    }

    #[test]
    fn screens_have_units() {
        for text in ["520x290mm", "520x290", "52x29cm", "520,290", " 520 x 290 mm"] {
            assert_eq!(text.parse(), Ok(Millimetres([520.0, 290.0])), "{text}");
        }
        assert_eq!("20x10in".parse(), Ok(Millimetres([508.0, 254.0])));
        for bad in ["520", "520mm", "axb", "1x1mm", "nanx290", "520x-290", "520x290m"] {
            assert!(bad.parse::<Millimetres>().is_err(), "{bad}");
        }
    }

    #[test]
    fn near_lies_before_far() {
        assert_eq!("0,2".parse(), Ok(Span([0.0, 2.0])));
        for bad in ["10,1", "1,1", "-1,1", "1"] {
            assert!(bad.parse::<Span>().is_err(), "{bad}");
        }
    }

    #[test]
    fn vectors_are_finite() {
        assert_eq!("-1,2.5,3e2".parse(), Ok(Triple([-1.0, 2.5, 300.0])));
        for bad in ["1,2", "1,2,3,4", "nan,0,0", "inf,0,0", "a,b,c"] {
            assert!(bad.parse::<Triple>().is_err(), "{bad}");
        }
        assert!("0,0,0".parse::<LightAt>().is_err());
    }
}
