use super::*;

/// Size and texels.
type Picture = ((u32, u32), Vec<[u8; 3]>);

fn parse(bytes: &[u8], chunk: usize) -> Result<Picture, Error> {
    let mut parser = Parser::new();
    let (mut size, mut texels) = ((0, 0), Vec::new());
    let mut sink = |event| match event {
        Event::Header { width, height } => size = (width, height),
        Event::Texel(texel) => texels.push(texel),
    };
    for chunk in bytes.chunks(chunk) {
        parser.feed(chunk, &mut sink)?;
    }
    parser.finish(&mut sink)?;
    assert!(parser.is_done());
    Ok((size, texels))
}

/// The same result whatever the chunks.
fn read(bytes: &[u8]) -> Result<Picture, Error> {
    let whole = parse(bytes, usize::MAX);
    for chunk in [1, 7, 512] {
        assert_eq!(parse(bytes, chunk), whole);
    }
    whole
}

#[test]
fn all_four_kinds() {
    let expected = ((2, 1), vec![[1, 2, 3], [4, 5, 6]]);
    assert_eq!(read(b"P6\n2 1\n255\n\x01\x02\x03\x04\x05\x06").unwrap(), expected);
    assert_eq!(read(b"P3 2 1 255 1 2 3 4 5 6").unwrap(), expected);
    assert_eq!(read(b"P3 2 1 255 1 2 3\n# note 7 8\n4 5 6#end").unwrap(), expected);
    let grey = ((1, 2), vec![[9; 3], [10; 3]]);
    assert_eq!(read(b"P5 1 2 255 \x09\x0a").unwrap(), grey);
    assert_eq!(read(b"P2 1 2 255 9\n10\n").unwrap(), grey);
}

#[test]
fn the_first_texel_may_look_like_space_or_comment() {
    for first in [b' ', b'\n', b'\r', b'\t', b'#', b'0'] {
        let file = [b"P6\n# GIMP\n1 1 # size\n255\n".as_slice(), &[first, b'#', b'\n']].concat();
        assert_eq!(read(&file).unwrap(), ((1, 1), vec![[first, b'#', b'\n']]));
    }
    // A comment right after the greatest value ends with the one white space.
    assert_eq!(read(b"P5#a\n1#b\n1#c\n255#d\n\n").unwrap(), ((1, 1), vec![[10; 3]]));
}

#[test]
fn samples_are_scaled_to_nearest() {
    assert_eq!(read(b"P2 4 1 3 0 1 2 3").unwrap().1, [[0; 3], [85; 3], [170; 3], [255; 3]]);
    assert_eq!(read(b"P2 2 1 1 0 1").unwrap().1, [[0; 3], [255; 3]]);
    let wide = b"P5 3 1 65535 \x00\x00\x80\x00\xff\xff";
    assert_eq!(read(wide).unwrap().1, [[0; 3], [128; 3], [255; 3]]);
    assert_eq!(read(b"P6 1 1 256 \x01\x00\x00\x80\x00\x01").unwrap().1, [[255, 128, 1]]);
}

#[test]
fn errors_name_the_byte() {
    for (bytes, byte, kind) in [
        (b"".as_slice(), 0, ErrorKind::Magic),
        (b"P", 1, ErrorKind::Magic),
        (b"P4 1 1 0", 1, ErrorKind::Magic),
        (b"P66", 2, ErrorKind::Magic),
        (b"P6 0 1 255 ", 4, ErrorKind::Size),
        (b"P6 1 65536 255 ", 10, ErrorKind::Size),
        (b"P6 99999999999999999999 1", 23, ErrorKind::Size),
        (b"P6 -1 1 255 ", 3, ErrorKind::NotANumber),
        (b"P6 1 1 0 ", 8, ErrorKind::MaxVal),
        (b"P6 1 1 65536 ", 12, ErrorKind::MaxVal),
        (b"P2 1 1 9 10 ", 11, ErrorKind::Sample),
        (b"P5 1 1 9 \x0a", 9, ErrorKind::Sample),
        (b"P6 2 1 255 abcde", 16, ErrorKind::Truncated),
        (b"P3 1 1 255 1 2", 14, ErrorKind::Truncated),
        (b"P6 65535 65535 255\n", 19, ErrorKind::Truncated),
        (b"P6 1 1 255", 10, ErrorKind::Truncated),
        (b"P2 1 1 255 x", 11, ErrorKind::NotANumber),
    ] {
        assert_eq!(read(bytes), Err(Error { byte, kind }), "{}", bytes.escape_ascii());
    }
    assert_eq!(read(b"P6 2 1").unwrap_err().kind, ErrorKind::Truncated);
}

#[test]
fn trailing_bytes_are_ignored() {
    assert_eq!(read(b"P5 1 1 255 aP5 1 1 255 b").unwrap().1, [[b'a'; 3]]);
}
