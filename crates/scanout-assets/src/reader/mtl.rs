//! MTL: the material files of OBJ.
//!
//! | line | becomes |
//! |---|---|
//! | `Kd r g b` | colour |
//! | `Ka r g b` | ambient weight = 0.2 x mean, at most 0.2 (without it: 0.2) |
//! | `Ks r g b` | specular weight = 0.4 x mean; 0 when `illum` is 0 or 1 |
//! | `Ns` | shininess, 1 to 1024 |
//! | `map_Kd` | texture; of its options `-clamp`, `-s` and `-o` count, the others are skipped |
//! | `d`, `Tr` | ignored with a warning when not opaque |
//!
//! The diffuse weight is what remains to 1. Everything else is ignored.

use crate::error::Warnings;
use crate::model::MaterialBuf;
use crate::number::Number;
use crate::raw::UvMap;
use scanout::texture::Wrap;

/// Materials that a file may define.
const MATERIALS: usize = 65_536;

/// A material and the texture's name in the file.
#[derive(Debug)]
pub(crate) struct MtlMaterial {
    pub material: MaterialBuf,
    pub texture: Option<String>,
    pub uv_map: UvMap,
    ambient: f64,
    specular: f64,
    illumination: f64,
    dark: bool,
}

/// Options of `map_Kd` and how many words follow each at most; numbers are skipped as long as they look like numbers.
const OPTIONS: [(&str, usize); 13] = [
    ("-blendu", 1),
    ("-blendv", 1),
    ("-boost", 1),
    ("-bm", 1),
    ("-cc", 1),
    ("-clamp", 1),
    ("-imfchan", 1),
    ("-mm", 2),
    ("-o", 3),
    ("-s", 3),
    ("-t", 3),
    ("-texres", 1),
    ("-type", 1),
];

/// Reads a material library; malformed lines are warnings.
pub(crate) fn read(bytes: &[u8], file: &str, warnings: &mut Warnings) -> Vec<MtlMaterial> {
    let text = String::from_utf8_lossy(bytes);
    let mut materials: Vec<MtlMaterial> = Vec::new();
    for (index, line) in text.split(['\n', '\r']).enumerate() {
        let line = line.trim();
        let (key, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        let rest = rest.trim();
        if key == "newmtl" {
            if materials.len() == MATERIALS {
                warnings
                    .warn(format!("{file}: more than {MATERIALS} materials; the rest are ignored"));
                break;
            }
            materials.push(MtlMaterial {
                material: MaterialBuf { name: rest.into(), ..MaterialBuf::default() },
                texture: None,
                uv_map: UvMap::IDENTITY,
                ambient: 1.0,
                specular: 0.0,
                illumination: 2.0,
                dark: false,
            });
            continue;
        }
        let Some(current) = materials.last_mut() else { continue };
        let bad = |warnings: &mut Warnings| {
            warnings.warn(format!("{file}: line {}: '{key}' without numbers is ignored", index + 1))
        };
        match key {
            "Kd" => match colour(rest) {
                Some(kd) => {
                    current.material.colour = kd.map(|c| (c * 255.0).round() as u8);
                    current.dark = kd == [0.0; 3];
                }
                None => bad(warnings),
            },
            "Ka" => match colour(rest) {
                Some(ka) => current.ambient = (ka[0] + ka[1] + ka[2]) / 3.0,
                None => bad(warnings),
            },
            "Ks" => match colour(rest) {
                Some(ks) => current.specular = (ks[0] + ks[1] + ks[2]) / 3.0,
                None => bad(warnings),
            },
            "Ns" => match number(rest) {
                Some(ns) => current.material.shininess = ns.round().clamp(1.0, 1024.0) as u16,
                None => bad(warnings),
            },
            "illum" => current.illumination = number(rest).unwrap_or(2.0),
            "d" if number(rest).is_some_and(|d| d < 1.0) => {
                warnings.warn(format!("{file}: transparency (d) is ignored"));
            }
            "Tr" if number(rest).is_some_and(|tr| tr > 0.0) => {
                warnings.warn(format!("{file}: transparency (Tr) is ignored"));
            }
            "map_Kd" | "map_kd" => current.map(rest),
            _ => {}
        }
    }
    for m in &mut materials {
        let specular = if m.illumination < 2.0 { 0.0 } else { 0.4 * m.specular };
        let ambient = 0.2 * m.ambient;
        m.material.ambient = ambient as f32;
        m.material.specular = specular as f32;
        m.material.diffuse = (1.0 - ambient - specular) as f32;
        if m.texture.is_some() && m.dark {
            warnings.warn(format!(
                "{file}: material '{}' would blacken its texture (Kd 0 0 0); white is used",
                m.material.name
            ));
            m.material.colour = [255; 3];
        }
    }
    materials
}

fn number(text: &str) -> Option<f64> {
    Number::parse(text.split_whitespace().next()?.as_bytes()).map(Number::to_f64)
}

/// One or three numbers in [0, 1], clamped.
fn colour(text: &str) -> Option<[f64; 3]> {
    let mut words = text.split_whitespace();
    let first = number(words.next()?)?;
    let second = words.next().and_then(number).unwrap_or(first);
    let third = words.next().and_then(number).unwrap_or(first);
    Some([first, second, third].map(|c| c.clamp(0.0, 1.0)))
}

impl MtlMaterial {
    /// `map_Kd`: options, then the file's name, which is the rest of the line, since names have spaces.
    fn map(&mut self, text: &str) {
        self.texture = None;
        self.uv_map = UvMap::IDENTITY;
        self.material.wrap = [Wrap::Repeat; 2];
        self.texture = self.options(text).filter(|name| !name.is_empty()).map(str::to_string);
    }

    /// Takes the options; what follows them, or `None` after one that is unknown.
    fn options<'a>(&mut self, mut text: &'a str) -> Option<&'a str> {
        while text.starts_with('-') {
            let (option, rest) = text.split_once(char::is_whitespace)?;
            let &(_, words) = OPTIONS.iter().find(|(name, _)| *name == option)?;
            text = rest.trim_start();
            for i in 0..words {
                let Some((word, rest)) = text.split_once(char::is_whitespace) else { break };
                // `-o`, `-s`, `-t` take one to three numbers; `-clamp on`, `-type sphere` take a word.
                let number = number(word);
                if i > 0 && number.is_none() {
                    break;
                }
                match (option, number, i) {
                    ("-clamp", _, _) if word.eq_ignore_ascii_case("on") => {
                        self.material.wrap = [Wrap::Clamp; 2];
                    }
                    ("-s", Some(x), 0 | 1) => self.uv_map.scale[i] = x,
                    ("-o", Some(x), 0 | 1) => self.uv_map.offset[i] = x,
                    _ => {}
                }
                text = rest.trim_start();
            }
        }
        Some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_sum_to_one() {
        let mut warnings = Warnings::default();
        let text = b"newmtl a b\r\nKd 1 .5 0\r\nKa 1 1 1\r\nKs 0.5 0.5 0.5\r\nNs 96.078\r\nd 0.5\r\n\
            newmtl matt\nillum 1\nKs 1 1 1\nKd nan\nmap_Kd -s 1 1 1 -o 0 0 -clamp on my brick.png\n";
        let materials = read(text, "m.mtl", &mut warnings);
        let a = &materials[0].material;
        assert_eq!((a.name.as_str(), a.colour, a.shininess), ("a b", [255, 128, 0], 96));
        assert_eq!((a.ambient, a.diffuse, a.specular), (0.2, 0.6, 0.2));
        let matt = &materials[1];
        assert_eq!(matt.material.specular, 0.0);
        assert_eq!(matt.texture.as_deref(), Some("my brick.png"));
        assert_eq!(warnings.0.len(), 2);
    }

    #[test]
    fn options_of_a_texture_count() {
        let mut warnings = Warnings::default();
        let text = b"newmtl a\nmap_Kd -s 2 3 4 -o 0.5 -clamp ON a b.png\n\
            newmtl b\nmap_Kd -clamp on -s 5 x\nmap_Kd -clamp off -o 0.25 -0.5 2x.png\n";
        let m = read(text, "m.mtl", &mut warnings);
        assert_eq!(m[0].texture.as_deref(), Some("a b.png"));
        assert_eq!(m[0].material.wrap, [Wrap::Clamp; 2]);
        assert_eq!(m[0].uv_map, UvMap { scale: [2.0, 3.0], offset: [0.5, 0.0] });
        // The last line of several counts, with its options only.
        assert_eq!(m[1].texture.as_deref(), Some("2x.png"));
        assert_eq!(m[1].material.wrap, [Wrap::Repeat; 2]);
        assert_eq!(m[1].uv_map, UvMap { scale: [1.0; 2], offset: [0.25, -0.5] });
        assert!(warnings.0.is_empty());
    }

    #[test]
    fn anything_is_tolerated() {
        let mut warnings = Warnings::default();
        assert!(read(b"", "m", &mut warnings).is_empty());
        assert!(read(b"Kd 1 1 1\n\xff\xfe", "m", &mut warnings).is_empty());
        let m = read(
            b"newmtl\nmap_Kd\nmap_Kd -s\nmap_Kd -what x\nKd 0 0 0\nmap_Kd x",
            "m",
            &mut warnings,
        );
        assert_eq!(m[0].material.colour, [255; 3]);
    }
}
