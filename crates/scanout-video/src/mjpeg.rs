//! JPEG pictures in a row, with or without something between them (AVI's chunk headers).
//!
//! A picture begins with FF D8 FF. Its segments are skipped by their lengths, so that a preview inside one doesn't end it; coded data
//! ends at a marker that is neither FF 00 nor a restart.

use std::io::{self, BufRead};

/// Longest picture, bytes.
const MOST: usize = 64 << 20;

/// What comes next in the stream.
#[derive(Debug, PartialEq)]
pub enum Next {
    /// A whole picture.
    Picture(Vec<u8>),
    /// A picture that breaks off.
    Broken,
    /// The stream has ended.
    End,
}

/// The next picture's bytes.
pub fn next(from: &mut impl BufRead) -> io::Result<Next> {
    let mut bytes = vec![0xff, 0xd8, 0xff];
    let mut last = [0u8; 3];
    while last != [0xff, 0xd8, 0xff] {
        let Some(byte) = byte(from)? else { return Ok(Next::End) };
        last = [last[1], last[2], byte];
    }
    loop {
        // Behind an FF that begins a marker.
        let Some(marker) = push(from, &mut bytes)? else { return Ok(Next::Broken) };
        match marker {
            0xff => continue,
            0xd9 => return Ok(Next::Picture(bytes)),
            0x01 | 0xd0..=0xd8 => {}
            _ => {
                let (Some(high), Some(low)) = (push(from, &mut bytes)?, push(from, &mut bytes)?)
                else {
                    return Ok(Next::Broken);
                };
                for _ in 2..u16::from_be_bytes([high, low]) {
                    if push(from, &mut bytes)?.is_none() {
                        return Ok(Next::Broken);
                    }
                }
            }
        }
        // Coded data, or nothing, up to the next marker.
        let coded = marker == 0xda;
        loop {
            match push(from, &mut bytes)? {
                None => return Ok(Next::Broken),
                Some(0xff) if !coded => break,
                Some(0xff) => match from.fill_buf()?.first() {
                    Some(0x00 | 0xd0..=0xd7) => {}
                    _ => break,
                },
                Some(_) if coded => {}
                Some(_) => return Ok(Next::Broken),
            }
        }
        if bytes.len() > MOST {
            return Ok(Next::Broken);
        }
    }
}

fn byte(from: &mut impl BufRead) -> io::Result<Option<u8>> {
    let Some(&byte) = from.fill_buf()?.first() else { return Ok(None) };
    from.consume(1);
    Ok(Some(byte))
}

fn push(from: &mut impl BufRead, bytes: &mut Vec<u8>) -> io::Result<Option<u8>> {
    let next = byte(from)?;
    bytes.extend(next);
    Ok(next)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PICTURE: &[u8] = &[
        0xff, 0xd8, 0xff, 0xe0, 0, 6, 0xff, 0xd9, 1, 2, // a segment that holds an end marker
        0xff, 0xda, 0, 2, 5, 0xff, 0, 6, 0xff, 0xd3, 7, 0xff, 0xd9,
    ];

    #[test]
    fn pictures_between_other_things() {
        let mut stream = [b"RIFF\xff\xd8junk".as_slice(), PICTURE, b"00dc", PICTURE].concat();
        let mut from = stream.as_slice();
        assert_eq!(next(&mut from).unwrap(), Next::Picture(PICTURE.to_vec()));
        assert_eq!(next(&mut from).unwrap(), Next::Picture(PICTURE.to_vec()));
        assert_eq!(next(&mut from).unwrap(), Next::End);
        stream.truncate(stream.len() - 1);
        let mut from = stream.as_slice();
        assert!(matches!(next(&mut from).unwrap(), Next::Picture(_)));
        assert_eq!(next(&mut from).unwrap(), Next::Broken);
        assert_eq!(next(&mut from).unwrap(), Next::End);
    }
}
