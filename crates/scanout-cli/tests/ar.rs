//! `scanout marker`, `ar` and `calibrate` as a user runs them.

mod support;

use std::fmt::Write as _;

use scanout_ar::Dictionary;
use serde_json::Value;
use support::{model, run, run_with_input, scratch, stdout};

const MARKER: [&str; 4] = ["--marker", "aruco4x4_50:7", "--size", "80mm"];

/// The README's photograph: a marker at (0.196, -0.030, 0.500) m, drawn by OpenCV for a field of view of 60 degrees.
fn photograph() -> String {
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/ar-photograph.png").into()
}

fn path(name: &str) -> String {
    scratch(name).to_str().unwrap().into()
}

fn ar(more: &[&str]) -> (String, String, i32) {
    let arguments = [&["ar"], &MARKER[..], more].concat();
    let output = run(&arguments);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    (stdout(&output), error, output.status.code().unwrap())
}

fn poses(text: &str) -> Vec<Value> {
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
fn the_pose_of_the_photograph() {
    let (text, error, code) = ar(&["--source", &photograph(), "--json", "-"]);
    assert_eq!(code, 0, "{error}");
    let pose = &poses(&text)[0]["pose"];
    for (axis, want) in [0.196, -0.030, 0.500].into_iter().enumerate() {
        let got = pose["translation"][axis].as_f64().unwrap();
        assert!((got - want).abs() < 0.0005, "axis {axis}: {got} m, not {want}");
    }
    assert!(pose["error"].as_f64().unwrap() < 0.05);
}

/// A square as large as the marker, drawn as wire, covers the marker's outline: no half pixel is lost on the way.
#[test]
fn the_overlay_lies_on_the_marker_to_the_pixel() {
    let square = path("square.obj");
    std::fs::write(&square, "v 0 0 0\nv 1 0 0\nv 1 0 -1\nv 0 0 -1\nf 1 2 3 4\n").unwrap();
    let out = path("square.png");
    let more = ["--model", &square, "--mode", "wire", "--color", "0,255,0", "-o", &out];
    let source = photograph();
    let (_, error, code) = ar(&[&["--source", &source], &more[..]].concat());
    assert_eq!(code, 0, "{error}");
    let (text, ..) = ar(&["--source", &source, "--json", "-"]);
    let corners = &poses(&text)[0]["markers"][0]["corners"];
    let corner = |i: usize, axis: usize| corners[i][axis].as_f64().unwrap();
    let picture = scanout_video::read_picture(out.as_ref()).unwrap();
    let green = (0..picture.rgb.len()).filter(|&i| picture.rgb[i] == [0, 255, 0]);
    let places: Vec<[f64; 2]> = green
        .map(|i| [(i % picture.width) as f64 + 0.5, (i / picture.width) as f64 + 0.5])
        .collect();
    assert!(places.len() > 200);
    for (axis, name) in ["x", "y"].iter().enumerate() {
        let corner = |f: fn(f64, f64) -> f64, start| (0..4).map(|i| corner(i, axis)).fold(start, f);
        let place = |f: fn(f64, f64) -> f64, start| places.iter().map(|p| p[axis]).fold(start, f);
        let low = (corner(f64::min, f64::MAX), place(f64::min, f64::MAX));
        let high = (corner(f64::max, f64::MIN), place(f64::max, f64::MIN));
        // A pixel's centre is at most half a pixel from the line's end, and the end within a tenth of the corner.
        assert!(
            (low.0 - low.1).abs() < 0.6 && (high.0 - high.1).abs() < 0.6,
            "{name} {low:?} {high:?}"
        );
    }
}

#[test]
fn sunk_models_are_hidden_by_the_paper() {
    let (source, earth) = (photograph(), model("earth.obj"));
    let count = |more: &[&str]| {
        let out = path("sink.png");
        let more = [&["--source", &source, "--model", &earth, "-o", &out], more].concat();
        let (_, error, code) = ar(&more);
        assert_eq!(code, 0, "{error}");
        let (got, plain) = (
            scanout_video::read_picture(out.as_ref()),
            scanout_video::read_picture(source.as_ref()),
        );
        got.unwrap().rgb.iter().zip(&plain.unwrap().rgb).filter(|(a, b)| a != b).count()
    };
    let (stands, half, gone) = (count(&[]), count(&["--sink", "40mm"]), count(&["--sink", "81mm"]));
    assert!(half * 10 > stands * 4 && half * 10 < stands * 9, "{half} of {stands}");
    assert_eq!(gone, 0, "all of it is below the paper");
}

#[test]
fn printed_markers_are_found_again() {
    for (name, file) in [
        ("aruco4x4_50:7", "m.png"),
        ("apriltag36h11:586", "m2.png"),
        ("aruco_original:5", "m3.png"),
    ] {
        let out = path(file);
        let output = run(&["marker", name, "--size", "20mm", "--quiet", "2", "-o", &out]);
        assert!(output.status.success());
        let arguments = ["ar", "--marker", name, "--size", "20mm", "--source", &out, "--json", "-"];
        let line = &poses(&stdout(&run(&arguments)))[0];
        assert_eq!(line["markers"][0]["marker"], name);
        // 20 mm at 300 dots an inch: 236 dots, and half a dot for each of up to eight cells, which are whole dots.
        let corners = &line["markers"][0]["corners"];
        let side = corners[1][0].as_f64().unwrap() - corners[0][0].as_f64().unwrap();
        assert!((side - 236.0).abs() < 4.1, "{side}");
    }
    let (svg, pdf) = (path("m.svg"), path("m.pdf"));
    assert!(run(&["marker", "aruco4x4_50:7", "-o", &svg]).status.success());
    let text = std::fs::read_to_string(&svg).unwrap();
    assert!(
        text.contains("width=\"106.66666666666667mm\"") && text.contains("M1 1h6v1h-6z"),
        "{text}"
    );
    assert!(run(&["marker", "aruco4x4_50:7", "-o", &pdf]).status.success());
    assert!(std::fs::read(&pdf).unwrap().starts_with(b"%PDF-1.4"));
    let output = run(&["marker", "aruco4x4_50:50", "-o", &pdf]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("aruco4x4_50:0 to aruco4x4_50:49"));
}

/// A grey picture of 640x480 of a board of 2 x 2 markers, numbers 10 to 13, 60 pixels wide and 15 apart, but for `hidden` ones.
fn board(hidden: &[u16]) -> Vec<u8> {
    let dictionary = Dictionary::ARUCO_4X4_50;
    let mut picture = b"P5 640 480 255\n".to_vec();
    picture.extend((0..640 * 480).map(|i| {
        let place = |at: usize, start: usize| {
            let at = at.checked_sub(start).filter(|at| *at < 135)?;
            (at % 75 < 60).then_some((at / 75, at % 75 / 10))
        };
        let (Some((column, x)), Some((row, y))) = (place(i % 640, 200), place(i / 640, 150)) else {
            return 230;
        };
        let id = 10 + 2 * row as u16 + column as u16;
        let code = dictionary.code(id.into()).unwrap();
        if hidden.contains(&id) || dictionary.is_white(code, x, y) { 230 } else { 25u8 }
    }));
    picture
}

#[test]
fn a_board_is_where_any_of_its_markers_say() {
    let file = path("board.pgm");
    let pose = |hidden: &[u16], more: &[&str]| {
        std::fs::write(&file, board(hidden)).unwrap();
        let arguments = ["ar", "--marker", "aruco4x4_50:10", "--size", "20mm", "--source", &file];
        let output = run(&[&arguments[..], &["--json", "-"], more].concat());
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{error}");
        (poses(&stdout(&output)).remove(0), error)
    };
    let grid = ["--board", "2x2", "--gap", "5mm"];
    // 3 pixels a millimetre. The board's middle is at (267.5, 217.5); a field of view of 60 degrees is 554.256 pixels.
    let want = [-0.0175, -0.0075, 0.554256 / 3.0];
    for hidden in [&[][..], &[10], &[11, 12], &[10, 11, 12]] {
        let (line, _) = pose(hidden, &grid);
        assert_eq!(line["markers"].as_array().unwrap().len(), 4 - hidden.len());
        let slack = if hidden.len() == 3 { 0.001 } else { 0.0002 };
        for (axis, want) in want.into_iter().enumerate() {
            let got = line["pose"]["translation"][axis].as_f64().unwrap();
            assert!((got - want).abs() < slack, "{hidden:?} {axis}: {got} m, not {want}");
        }
    }
    let (line, error) = pose(&[10, 11, 12, 13], &grid);
    assert!(line["pose"].is_null());
    assert!(error.contains("no marker of the board is seen"), "{error}");
    // Without --board the first marker alone counts: its own middle.
    let (line, _) = pose(&[], &[]);
    let x = line["pose"]["translation"][0].as_f64().unwrap();
    assert!((x + 0.030).abs() < 0.0002, "{x}");
    let (line, _) = pose(&[10], &[]);
    assert!(line["pose"].is_null());
}

#[test]
fn boards_that_cannot_be_say_why() {
    for (more, what) in [
        (&["--board", "2"][..], "is no grid"),
        (&["--board", "0x2", "--gap", "5mm"], "is no grid"),
        (&["--gap", "5mm"], "--board"),
        (&["--board", "2x2"], "--gap"),
    ] {
        let (_, error, code) = ar(&[&["--source", &photograph(), "--json", "-"], more].concat());
        assert_eq!(code, 2, "{more:?} {error}");
        assert!(error.contains(what), "{more:?} {error}");
    }
}

#[test]
fn a_covered_corner_does_not_lose_the_marker() {
    let folder = scratch("covered-corner");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::copy(photograph(), folder.join("0.png")).unwrap();
    let source = folder.to_str().unwrap();
    let (text, ..) = ar(&["--source", source, "--json", "-"]);
    let corners = &poses(&text)[0]["markers"][0]["corners"];
    let corner = [0, 1].map(|axis| corners[0][axis].as_f64().unwrap());
    let mut picture = scanout_video::read_picture(photograph().as_ref()).unwrap();
    for (i, pixel) in picture.rgb.iter_mut().enumerate() {
        let place = [(i % picture.width) as f64, (i / picture.width) as f64];
        if (0..2).all(|axis| (place[axis] - corner[axis]).abs() < 27.0) {
            *pixel = [190, 150, 130];
        }
    }
    let header = format!("P6 {} {} 255\n", picture.width, picture.height);
    let bytes = [header.as_bytes(), picture.rgb.as_flattened()].concat();
    std::fs::write(folder.join("1.ppm"), bytes).unwrap();
    let (text, error, code) = ar(&["--source", source, "--json", "-", "--no-filter"]);
    assert_eq!(code, 0, "{error}");
    let lines = poses(&text);
    let at = |i: usize, axis: usize| lines[i]["pose"]["translation"][axis].as_f64().unwrap();
    for axis in 0..3 {
        let (before, covered) = (at(0, axis), at(1, axis));
        assert!((before - covered).abs() < 0.0005, "axis {axis}: {before} and {covered} m");
    }
    let (text, ..) = ar(&["--source", source, "--json", "-", "--no-tracking"]);
    assert!(poses(&text)[1]["pose"].is_null());
}

#[test]
fn a_film_through_pipes() {
    let film = path("film.y4m");
    let (_, error, code) = ar(&["--source", &photograph(), "-o", &film]);
    assert_eq!(code, 0, "{error}");
    let bytes = std::fs::read(&film).unwrap();
    let arguments = [&["ar"], &MARKER[..], &["--source", "-", "-o", "-"]].concat();
    let output = run_with_input(&arguments, &bytes);
    assert!(output.status.success());
    assert!(output.stdout.starts_with(b"YUV4MPEG2 W600 H400 F30000:1000 "));
    assert_eq!(output.stdout.len(), bytes.len());
}

#[test]
fn bad_input_is_told_and_the_film_goes_on() {
    let folder = scratch("bad-frames");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("0.ppm"), b"P6 1 1 255 abc").unwrap();
    // Hundreds of squares, none a marker.
    let mut squares = String::from("P5 320 240 255\n").into_bytes();
    squares.extend(
        (0..320 * 240).map(|i| if (i % 320 / 10 + i / 320 / 10) % 2 == 0 { 20 } else { 230u8 }),
    );
    std::fs::write(folder.join("1.pgm"), squares).unwrap();
    std::fs::write(folder.join("2.png"), b"\x89PNG\r\n").unwrap();
    std::fs::copy(photograph(), folder.join("3.png")).unwrap();
    let out = path("bad-out");
    let source = folder.to_str().unwrap();
    let (text, error, code) =
        ar(&["--source", source, "--model", &model("cube.obj"), "-o", &out, "--json", "-"]);
    assert_eq!(code, 0, "{error}");
    assert!(error.contains("frame 0: aruco4x4_50:7 is not seen"), "{error}");
    assert!(error.contains("2.png: PNG: it is damaged; it is left out"), "{error}");
    assert!(error.contains("the marker is seen again"), "{error}");
    assert!(error.contains("3 frames, 1 lost, the marker in 1; wrote 3"), "{error}");
    let lines = poses(&text);
    assert!(lines[0]["pose"].is_null() && lines[1]["markers"] == serde_json::json!([]));
    assert!(lines[2]["pose"].is_object());
}

#[test]
fn what_cannot_work_says_why() {
    let failing = |more: &[&str], code: i32, what: &str| {
        let (_, error, got) = ar(more);
        assert_eq!(got, code, "{error}");
        assert!(error.contains(what), "{error}");
    };
    let source = photograph();
    failing(
        &["--source", "none.y4m", "--json", "-"],
        1,
        "none.y4m: no such file or directory; check the path",
    );
    failing(&["--source", &source, "-o", "a.gif"], 2, "a.gif: no format for this name");
    failing(
        &["--source", &source, "-o", "-", "--json", "-"],
        2,
        "can't both go to standard output",
    );
    failing(&["--source", &source, "--terminal", "off"], 1, "write frames with -o OUT");
    let yaml = path("bad.yml");
    std::fs::write(&yaml, "camera_matrix: [1, 2]\n").unwrap();
    failing(
        &["--source", &source, "--calibration", &yaml, "--json", "-"],
        1,
        "bad.yml: 1: camera_matrix needs its numbers",
    );
    let mut text = String::new();
    let _ = write!(
        text,
        "image_width: 640\nimage_height: 480\ncamera_matrix: [600, 0, 320, 0, 600, 240, 0, 0, 1]\n"
    );
    std::fs::write(&yaml, text).unwrap();
    failing(
        &["--source", &source, "--calibration", &yaml, "--json", "-"],
        1,
        "it is for 640 x 480, the frame is 600 x 400",
    );
    if !cfg!(feature = "webcam") {
        failing(&["--source", "/dev/video0", "--json", "-"], 1, "built without webcams");
    }
    let output = run(&["calibrate", &source, "-o", "-"]);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1));
    assert!(
        error.contains("picture 0: the board of 9 x 6 inner corners is not seen whole"),
        "{error}"
    );
    assert!(error.contains("seen in 0 pictures only"), "{error}");
}
