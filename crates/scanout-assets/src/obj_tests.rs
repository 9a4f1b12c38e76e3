use super::*;

/// Everything that the parser knows, with every kind of line end.
const FILE: &str = "# comment\r\nmtllib my materials.mtl\r\no thing\nv 0 0 0\nv 1. .5 -1e-1 1.0\rv +1 2 3 0.5 0.25 1\n\
vt 0.25\nvt .5 0.75 0\nvn 0 0 1 # up\ng a b\nusemtl c\\d e \ns off\ns 3\nf 1 2 3\nf -3/-1 -2/1/ -1/2\nf 1//1 2//-1 \\\n\
  3//1\nf 1/1/1 2/2/1 3/1/1 1/2/1 #5\nl 1 2 3\np 1 -1\ncurv 0 1 2\n\n   \t\nv 9 9 9";

/// All events as text.
fn events(bytes: &[u8], chunk: usize) -> Result<Vec<String>, Error> {
    let mut parser = Parser::new();
    let mut out = Vec::new();
    let mut sink = |event: Event<'_>| out.push(format!("{event:?}"));
    for chunk in bytes.chunks(chunk) {
        parser.feed(chunk, &mut sink)?;
    }
    parser.finish(&mut sink)?;
    Ok(out)
}

#[test]
fn chunks_of_any_size_give_the_same_events() {
    let whole = events(FILE.as_bytes(), usize::MAX).unwrap();
    for chunk in [1, 2, 7, 512] {
        assert_eq!(events(FILE.as_bytes(), chunk).unwrap(), whole);
    }
    let crlf = FILE.replace("\r\n", "\n").replace('\r', "\n").replace('\n', "\r\n");
    assert_eq!(events(crlf.as_bytes(), 3).unwrap(), whole);
}

#[test]
fn every_element_is_understood() {
    let mut seen = Vec::new();
    let mut corners = Vec::new();
    let mut parser = Parser::new();
    let mut sink = |event: Event<'_>| match event {
        Event::Position { xyz, colour } => {
            let rgb = colour.map(|c| c.map(Number::to_f64));
            seen.push(format!("v {:?} {rgb:?}", xyz.map(Number::to_f64)));
        }
        Event::Uv(uv) => seen.push(format!("vt {:?}", uv.map(Number::to_f64))),
        Event::Corner(c) => corners.push((c.position, c.uv, c.normal)),
        Event::Material(n)
        | Event::Library(n)
        | Event::Group(n)
        | Event::Object(n)
        | Event::Ignored(n) => {
            seen.push(String::from_utf8(n.to_vec()).unwrap());
        }
        Event::Smoothing(s) => seen.push(format!("s {s}")),
        _ => {}
    };
    parser.feed(FILE.as_bytes(), &mut sink).unwrap();
    parser.finish(&mut sink).unwrap();
    assert_eq!(
        seen,
        [
            "my materials.mtl",
            "thing",
            "v [0.0, 0.0, 0.0] None",
            "v [1.0, 0.5, -0.1] None",
            "v [1.0, 2.0, 3.0] Some([0.5, 0.25, 1.0])",
            "vt [0.25, 0.0]",
            "vt [0.5, 0.75]",
            "a b",
            "c\\d e",
            "s 0",
            "s 3",
            "curv",
            "v [9.0, 9.0, 9.0] None",
        ]
    );
    assert_eq!(corners[3..6], [(0, Some(1), None), (1, Some(0), None), (2, Some(1), None)]);
    assert_eq!(corners[6..9], [(0, None, Some(0)), (1, None, Some(0)), (2, None, Some(0))]);
    assert_eq!(
        corners[13..],
        [(0, None, None), (1, None, None), (2, None, None), (0, None, None), (2, None, None)]
    );
}

#[test]
fn a_face_may_have_any_number_of_corners() {
    let mut text = String::from("v 0 0 0\nf");
    text.push_str(&" 1".repeat(100_000));
    let corners = events(text.as_bytes(), 4096).unwrap();
    assert_eq!(corners.len(), 1 + 1 + 100_000 + 1);
}

#[test]
fn errors_name_line_and_word() {
    let long = format!("f {}", "1".repeat(WORD + 1));
    let long_keyword = "x".repeat(WORD + 9);
    for (text, message) in [
        ("v 0 0 0\nv 1 nan 2", "line 2: 'nan' is not a finite number; mend the line"),
        ("v 0 inf 0", "line 1: 'inf' is not a finite number; mend the line"),
        ("v 0 0", "line 1: too few numbers; v and vn need 3, vt needs 1"),
        ("vt", "line 1: too few numbers; v and vn need 3, vt needs 1"),
        (
            "v 0 0 0 \\\r\n\r\nf 0",
            "line 3: '0' refers to no element; indices count from 1, or back from -1",
        ),
        ("f 1 -1", "line 1: '-1' refers to no element; indices count from 1, or back from -1"),
        ("f 1/2/3/4", "line 1: '1/2/3/4' is not a corner; write v, v/t, v//n or v/t/n"),
        ("f /1", "line 1: '/1' is not a corner; write v, v/t, v//n or v/t/n"),
        ("f 1.5", "line 1: '1.5' is not a corner; write v, v/t, v//n or v/t/n"),
        (
            "f 4294967296",
            "line 1: '4294967296' refers to no element; indices count from 1, or back from -1",
        ),
        ("f \u{e9}", "line 1: '\\xc3\\xa9' is not a corner; write v, v/t, v//n or v/t/n"),
        (&long, "line 1: a word is longer than 512 bytes; is this OBJ?"),
    ] {
        let error = events(text.as_bytes(), 1).unwrap_err();
        assert_eq!(error.to_string(), message);
        assert_eq!(events(text.as_bytes(), usize::MAX).unwrap_err(), error);
    }
    assert_eq!(events(long_keyword.as_bytes(), 9).unwrap().len(), 1, "an unknown line is skipped");
    assert!(events(b"", 1).unwrap().is_empty());
}

#[test]
fn an_error_stays() {
    let mut parser = Parser::new();
    let error =
        parser.feed(b"v x", &mut |_| {}).and_then(|()| parser.feed(b"\nv 0 0 0\n", &mut |_| {}));
    assert_eq!(parser.feed(b"v 0 0 0\n", &mut |_| {}), error);
    assert_eq!(parser.finish(&mut |_| {}), error);
}
