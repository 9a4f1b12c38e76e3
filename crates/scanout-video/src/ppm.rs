//! Binary PPM and PGM (P6 and P5) of 8 bits, one after another in a stream.

use std::io::{self, BufRead};

use crate::frame::Frame;
use crate::picture::SIDE;

/// The next picture; `None` at the end.
pub fn read(from: &mut impl BufRead) -> io::Result<Option<Frame>> {
    let bad = |what: &str| io::Error::new(io::ErrorKind::InvalidData, format!("PPM: {what}"));
    let Some(magic) = word(from)? else { return Ok(None) };
    let channels = match magic.as_str() {
        "P5" => 1,
        "P6" => 3,
        _ => return Err(bad("it does not begin with P5 or P6")),
    };
    let mut number = |most: usize| match word(from)?.and_then(|word| word.parse().ok()) {
        Some(number) if (1..=most).contains(&number) => Ok(number),
        _ => Err(bad("its size is damaged or too large")),
    };
    let (width, height) = (number(SIDE)?, number(SIDE)?);
    if number(65535)? != 255 {
        return Err(bad("it has not 8 bits a channel"));
    }
    let mut bytes = vec![0; width * height * channels];
    from.read_exact(&mut bytes).map_err(|error| match error.kind() {
        io::ErrorKind::UnexpectedEof => bad("it ends early"),
        _ => error,
    })?;
    let rgb = match channels {
        1 => bytes.iter().map(|&grey| [grey; 3]).collect(),
        _ => bytes.as_chunks::<3>().0.to_vec(),
    };
    Ok(Some(Frame { width, height, rgb, time: 0.0 }))
}

/// A word of the header, and the one white-space byte behind it; `None` at the end.
fn word(from: &mut impl BufRead) -> io::Result<Option<String>> {
    let mut word = String::new();
    loop {
        let Some(&byte) = from.fill_buf()?.first() else {
            return Ok(if word.is_empty() { None } else { Some(word) });
        };
        from.consume(1);
        match byte {
            b'#' if word.is_empty() => {
                from.skip_until(b'\n')?;
            }
            byte if byte.is_ascii_whitespace() => {
                if !word.is_empty() {
                    return Ok(Some(word));
                }
            }
            byte if word.len() < 16 => word.push(byte.into()),
            _ => return Ok(Some(word)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_in_a_row() {
        let mut stream = &b"P6\n# a comment\n1 2 255\nabcdefP5 2 1\n255\nxy"[..];
        let first = read(&mut stream).unwrap().unwrap();
        assert_eq!((first.width, first.height, &first.rgb[..]), (1, 2, &[*b"abc", *b"def"][..]));
        assert_eq!(read(&mut stream).unwrap().unwrap().rgb, [[b'x'; 3], [b'y'; 3]]);
        assert_eq!(read(&mut stream).unwrap(), None);
        for bad in ["P6 0 1 255 ", "P6 1 1 255 ab", "P6 1 1 65535 abcdef", "GIF", "P5 99999 1 255 "]
        {
            assert!(read(&mut bad.as_bytes()).is_err(), "{bad}");
        }
    }
}
