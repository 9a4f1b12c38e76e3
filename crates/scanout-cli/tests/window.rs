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

#[test]
fn wrong_lines_and_files_are_told() {
    let bad = scratch("bad-head.csv");
    std::fs::write(&bad, "time_s,x_mm,y_mm,z_mm\n0,1,2\n").unwrap();
    let bad = bad.to_str().unwrap();
    let lines: [(&[&str], i32, &str); 9] = [
        (&["--head", "camera"], 2, "--head camera: no such source; one of"),
        (&["--head", "no such.csv"], 1, "no such.csv: no such file"),
        (&["--head", bad, "-o", "x.gif"], 1, "line 2: 3 fields; give"),
        (&["-o", "x.gif"], 2, "of a recording; give --head"),
        (&["--head", bad, "-o", "x.xyz"], 2, "no moving picture"),
        (&["--screen", "1x1mm"], 2, "each side must be 10 to 20000 mm"),
        (&["--tilt", "90"], 2, "not in -89 - 89"),
        (&["--eye-distance", "60"], 2, "--stereo"),
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
