//! `scanout window`: pictures of a recorded head, what is written, what is refused.
//!
//! `SCANOUT_BLESS=1 cargo test -p scanout-cli --test window` rewrites the goldens `window-*.png`.

mod support;

use scanout_cli::args::OutputFormat;
use scanout_cli::{compare, image_out};
use support::{bless, kept, model, run, scanout, scratch, stderr};

/// A head at rest in the middle, to the right and above, near to the left, far below: four samples, one a second.
const HEAD: &str = "time_s,x_mm,y_mm,z_mm\n0,0,0,600\n1,250,120,600\n2,-180,0,350\n3,0,-200,900\n";

fn recording(name: &str) -> String {
    let path = scratch(&format!("{name}.csv"));
    std::fs::write(&path, HEAD).unwrap();
    path.to_str().unwrap().into()
}

/// The pictures of that head's four places, unfiltered, one a second; they are compared with goldens.
fn check(name: &str, models: &[&str], options: &str) -> Vec<String> {
    let folder = scratch(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let head = recording(name);
    let models: Vec<String> = models.iter().map(|name| model(name)).collect();
    let mut line =
        vec!["window", "--head", &head, "--fps", "1", "--no-filter", "--screen", "520x290mm"];
    line.extend(models.iter().map(String::as_str));
    line.extend(["--resolution", "208,116", "-o", folder.to_str().unwrap()]);
    line.extend(options.split_whitespace());
    let output = run(&line);
    assert!(output.status.success(), "{}", stderr(&output));
    let mut wrong = Vec::new();
    for frame in 0..4 {
        let got = folder.join(format!("frame-{frame:04}.png"));
        let golden = kept("goldens").join(format!("window-{name}-{frame}.png"));
        if bless() {
            std::fs::copy(&got, &golden).unwrap();
            continue;
        }
        let Ok(expected) = compare::read(&golden) else {
            wrong.push(format!("there is no golden {}", golden.display()));
            continue;
        };
        let picture = compare::read(&got).unwrap();
        if let Some(difference) = compare::compare(&picture, &expected) {
            let to = folder.join(format!("difference-{frame}.png"));
            image_out::write(&to, OutputFormat::Png, &difference.picture, &[]).unwrap();
            wrong.push(format!(
                "{} differs from {}, see {}",
                got.display(),
                golden.display(),
                to.display()
            ));
        }
    }
    wrong
}

#[test]
fn what_a_recorded_head_sees() {
    let mut wrong = check("room", &[], "");
    wrong.extend(check("glasses", &[], "--stereo anaglyph-dubois"));
    wrong.extend(check("before", &["teapot.obj"], "--depth 60 --size 120 --tilt 20"));
    wrong.extend(check("halves", &[], "--stereo side-by-side-half --swap-eyes --mode wire"));
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_recording_of_a_replay_is_the_recording() {
    let (head, again) = (recording("again"), scratch("again-out.csv"));
    let folder = scratch("again-pictures");
    let line = ["window", "--head", &head, "--fps", "10", "--resolution", "20,12"];
    let rest = ["-o", folder.to_str().unwrap(), "--record", again.to_str().unwrap()];
    let output = run(&[&line[..], &rest].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let text = std::fs::read_to_string(&again).unwrap();
    let expected = "time_s,x_mm,y_mm,z_mm\n0.000000,0.000,0.000,600.000\n1.000000,250.000,120.000,600.000\n\
                    2.000000,-180.000,0.000,350.000\n3.000000,0.000,-200.000,900.000\n";
    assert_eq!(text, expected);
}

/// Writes a picture of 320 x 240 with marker aruco4x4_50:0, 48 pixels wide, its middle `dx`, `dy` from the picture's; none without.
fn frame(folder: &std::path::Path, number: usize, middle: Option<(i32, i32)>) {
    const ROWS: [u8; 4] = [0b1011, 0b0101, 0b0011, 0b0010];
    let mut bytes = b"P5\n320 240\n255\n".to_vec();
    for i in 0..320 * 240 {
        let cell = middle.map(|(dx, dy)| {
            [i % 320 - 160 - dx + 24, i / 320 - 120 - dy + 24].map(|at| at.div_euclid(8))
        });
        bytes.push(match cell {
            Some([x @ 1..=4, y @ 1..=4]) if ROWS[y as usize - 1] >> (4 - x) & 1 == 1 => 225,
            Some([0..=5, 0..=5]) => 35,
            Some([-1..=6, -1..=6]) => 225,
            _ => 140,
        });
    }
    std::fs::write(folder.join(format!("{number}.pgm")), bytes).unwrap();
}

#[test]
fn a_marker_in_a_film_moves_the_viewer() {
    let (film, csv) = (scratch("cap"), scratch("cap.csv"));
    let _ = std::fs::remove_dir_all(&film);
    std::fs::create_dir_all(&film).unwrap();
    for (number, middle) in [Some((0, 0)), Some((60, 0)), None, Some((0, -40))].iter().enumerate() {
        frame(&film, number, *middle);
    }
    let pictures = scratch("cap-pictures");
    let out = ["-o", pictures.to_str().unwrap(), "--record", csv.to_str().unwrap()];
    let line =
        ["window", "--head", "camera", "--source", film.to_str().unwrap(), "--source-fps", "1"];
    let rest = ["--fps", "10", "--resolution", "20,12", "--camera-place", "0,150,0", "--no-filter"];
    let output = run(&[&line[..], &rest, &out].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).contains("aruco4x4_50:0 is in 3 of 4 frames"), "{}", stderr(&output));
    // 320 pixels are 60 degrees, so the focal length is 277.13 pixels, and 50 mm in 48 pixels are 288.67 mm away; the picture's right
    // is the viewer's left.
    let expected = [
        (0.0, Some([0.0, 150.0])),
        (1.0, Some([-62.5, 150.0])),
        (2.0, None),
        (3.0, Some([0.0, 191.67])),
    ];
    let text = std::fs::read_to_string(&csv).unwrap();
    assert_eq!(text.lines().count(), 5, "{text}");
    for (line, (time, place)) in text.lines().skip(1).zip(expected) {
        let fields: Vec<f64> = line.split(',').flat_map(str::parse).collect();
        assert!((fields[0] - time).abs() < 0.11, "{line}");
        match place {
            None => assert_eq!(fields.len(), 1, "{line}"),
            Some([x, y]) => {
                let off = [fields[1] - x, fields[2] - y, fields[3] - 288.67];
                assert!(off.iter().all(|off| off.abs() < 1.5), "{line}: {off:?}");
            }
        }
    }
}

#[test]
fn wrong_lines_and_files_are_told() {
    let bad = scratch("bad-head.csv");
    std::fs::write(&bad, "time_s,x_mm,y_mm,z_mm\n0,1,2\n").unwrap();
    let bad = bad.to_str().unwrap();
    let lines: [(&[&str], i32, &str); 17] = [
        (&["--head", "phone"], 2, "--head phone: no such source; one of"),
        (&["--head", "camera", "--marker", "aruco4x4_50:50"], 2, "no such marker; give"),
        (&["--head", "camera", "--source", "no such film"], 1, "no such film"),
        (&["--head", "camera", "--calibration", "no such.yaml"], 1, "no such.yaml: no such file"),
        (&["--head", "no such.csv"], 1, "no such.csv: no such file"),
        (&["--head", bad, "-o", "x.gif"], 1, "line 2: 3 fields; give"),
        (&["-o", "x.gif"], 2, "of a recording or a film; give --head"),
        (&["--head", bad, "-o", "x.xyz"], 2, "no moving picture"),
        (&["--screen", "1x1mm"], 2, "each side must be 10 to 20000 mm"),
        (&["--tilt", "90"], 2, "not in -89 - 89"),
        (&["--swap-eyes"], 2, "--stereo"),
        (&["--head", "camera", "--face", "a.bin"], 2, "--eyes"),
        (&["--face", "a.bin", "--eyes", "b.bin", "--marker", "april:1"], 2, "--marker"),
        (&["--face", "no.bin", "--eyes", "no.bin"], 2, "--head mouse: nobody would look; add"),
        (&["--head", "camera", "--face", "no.bin", "--eyes", "no.bin"], 1, "no.bin: no such file"),
        (&["--head", "camera", "--face", bad, "--eyes", bad], 1, "no cascade of faces: it begins"),
        (&["no such.obj"], 1, "no such.obj"),
    ];
    for (options, code, what) in lines {
        let output = run(&[&["window"], options].concat());
        assert_eq!(output.status.code(), Some(code), "{options:?}: {}", stderr(&output));
        let text = stderr(&output);
        assert!(text.lines().count() == 1 && text.contains(what), "{options:?}: {text}");
    }
}

#[test]
fn a_port_in_use_and_a_missing_display_are_told() {
    let socket = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    let address = socket.local_addr().unwrap().to_string();
    let output = run(&["window", "--head", "udp", "--listen", &address]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        stderr(&output).contains("choose another address with --listen"),
        "{}",
        stderr(&output)
    );
    // Without --screen three lines say what to measure.
    let output = scanout().args(["window", "--frames", "1"]).output().unwrap();
    assert_eq!(output.status.code(), Some(1));
    let text = stderr(&output);
    assert_eq!(text.lines().count(), 4, "{text}");
    assert!(text.contains("--screen WxHmm") && text.contains("--head FILE.csv -o OUT"), "{text}");
}
