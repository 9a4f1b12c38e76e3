//! How the program behaves: exit codes, streams, formats, hashes.

mod support;

use std::io::Read;
use std::process::Stdio;

use support::{model, run, run_with_input, scanout, scratch, stderr, stdout};

const SMALL: [&str; 2] = ["--resolution", "160,120"];

/// `scanout render teapot.obj --resolution 160,120 ...`.
fn render(more: &[&str]) -> std::process::Output {
    let teapot = model("teapot.obj");
    let line: Vec<&str> = ["render", &teapot].iter().chain(&SMALL).chain(more).copied().collect();
    run(&line)
}

/// One line, beginning with the program's name and ending with a remedy.
fn one_line(text: &str) {
    assert_eq!(text.lines().count(), 1, "{text}");
    assert!(text.starts_with("scanout: ") && text.contains("; "), "{text}");
}

#[test]
fn wrong_lines_exit_with_2_in_one_line() {
    let wrong: [&[&str]; 12] = [
        &["--no-such-option"],
        &["rendr"],
        &["render"],
        &["render", "a.obj", "--mode", "sketch"],
        &["render", "a.obj", "--resolution", "0,5"],
        &["render", "a.obj", "--background", "whitte"],
        &["render", "a.obj", "--eye", "0,0,1"],
        &["render", "a.obj", "--hash", "--json"],
        &["render", "a.obj", "-o", "-", "--hash"],
        &["render", "a.obj", "-o", "a.jpg"],
        &["render", "a.obj"],
        &["lines", "--octants", "-o", "-", "--table", "-"],
    ];
    for line in wrong {
        let output = run(line);
        assert_eq!(output.status.code(), Some(2), "{line:?}");
        assert!(output.stdout.is_empty());
        one_line(&stderr(&output));
    }
}

#[test]
fn bad_files_exit_with_1_in_one_line() {
    let missing = run(&["info", "no such file.obj"]);
    assert_eq!(missing.status.code(), Some(1));
    one_line(&stderr(&missing));
    assert!(stderr(&missing).contains("no such file.obj: "));

    let bad = scratch("bad.obj");
    std::fs::write(&bad, "v 0 0 0\nv 1 0 0\nf 1 2 9\n").unwrap();
    let output = run(&["render", bad.to_str().unwrap(), "--hash"]);
    assert_eq!(output.status.code(), Some(1));
    let last = stderr(&output).lines().last().unwrap_or_default().to_string();
    one_line(&last);
    assert!(last.contains("bad.obj"), "{last}");

    let output = render(&["-o", "/no such folder/a.png"]);
    assert_eq!(output.status.code(), Some(1));
    one_line(&stderr(&output));
}

#[test]
fn standard_input_equals_the_file() {
    let bytes = std::fs::read(model("teapot.obj")).unwrap();
    let options = ["--resolution", "160,120", "--hash", "--color", "red"];
    let line = ["render", "-", "--input-format", "obj"].iter().chain(&options);
    let piped = run_with_input(&line.copied().collect::<Vec<_>>(), &bytes);
    let sum = ["--ambient", "0.2", "--diffuse", "0.8", "--specular", "0", "--shininess", "32"];
    let line = ["render", "-"].iter().chain(&options).chain(&sum).copied();
    let guessed = run_with_input(&line.collect::<Vec<_>>(), &bytes);
    assert!(piped.status.success(), "{}", stderr(&piped));
    assert_eq!(stdout(&piped), stdout(&guessed));
    let file =
        render(&["--hash", "--color", "red"].iter().chain(&sum).copied().collect::<Vec<_>>());
    assert_eq!(stdout(&file), stdout(&guessed));
}

#[test]
fn standard_output_carries_the_picture_alone() {
    let png = render(&["-o", "-"]);
    assert!(png.stdout.starts_with(b"\x89PNG\r\n") && png.stderr.is_empty());
    let ppm = render(&["-o", "-", "--output-format", "ppm"]);
    assert!(ppm.stdout.starts_with(b"P6\n160 120\n255\n"));
    assert_eq!(ppm.stdout.len(), 15 + 160 * 120 * 3);
    for (format, bytes) in
        [("rgb888", 57_600), ("rgb565", 38_400), ("rgb332", 19_200), ("mono", 2_400)]
    {
        let raw = render(&["-o", "-", "--output-format", "raw", "--format", format]);
        assert_eq!(raw.stdout.len(), bytes, "{format}");
    }
}

#[test]
fn a_pipe_closed_early_is_success() {
    for line in [
        vec!["render", "M", "-o", "-", "--output-format", "ppm", "--resolution", "1024,768"],
        vec!["turntable", "M", "-o", "-", "--frames", "4"],
        vec!["lines", "--octants", "--table", "-", "--resolution", "4001,4001"],
    ] {
        let teapot = model("teapot.obj");
        let line = line.iter().map(|word| if *word == "M" { &teapot } else { *word });
        let mut child =
            scanout().args(line).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut first = [0; 4];
        child.stdout.take().unwrap().read_exact(&mut first).unwrap(); // and closed here
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert!(output.stderr.is_empty(), "{}", stderr(&output));
    }
}

#[test]
fn bands_and_threads_cannot_change_a_pixel() {
    for options in
        [&["--mode", "phong"][..], &["--format", "rgb565", "--dither"], &["--mode", "hidden"]]
    {
        let hash = |bands: &str, threads: &str| {
            let line = ["--hash", "--bands", bands, "--threads", threads];
            let output = render(&[options, &line].concat());
            assert!(output.status.success(), "{}", stderr(&output));
            stdout(&output)
        };
        let expected = hash("240", "1");
        assert_eq!(expected.trim_end().len(), 16);
        for bands in ["1", "7", "240"] {
            for threads in ["1", "2"] {
                assert_eq!(hash(bands, threads), expected, "{bands} lines, {threads} threads");
            }
        }
    }
}

#[test]
fn json_parses_and_holds_the_hash() {
    let output = render(&["--json"]);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(value["width"], 160);
    assert_eq!(value["hash"], stdout(&render(&["--hash"])).trim_end());
    assert_eq!(value["frames"][0]["triangles"], 992);
    let stereo = render(&["--json", "--stereo", "anaglyph"]);
    let value: serde_json::Value = serde_json::from_slice(&stereo.stdout).unwrap();
    assert_eq!(value["frames"].as_array().map(Vec::len), Some(2));

    let info = run(&["info", &model("earth.obj"), "--json"]);
    let value: serde_json::Value = serde_json::from_slice(&info.stdout).unwrap();
    assert_eq!(value["textures"][0]["width"], 1024);
    assert_eq!(value["memory"]["frame_bytes"], 320 * 240 * 4);
}

#[test]
fn stats_go_to_standard_error() {
    let output = render(&["--stats"]);
    assert!(output.stdout.is_empty());
    for word in ["vertices", "back-facing", "primitives", "prepare us", "draw us", "hash"] {
        assert!(stderr(&output).contains(word), "{word}");
    }
}

#[test]
fn a_reference_is_equal_or_a_difference_is_drawn() {
    let reference = scratch("reference.ppm");
    let path = reference.to_str().unwrap();
    assert!(render(&["-o", path]).status.success());
    assert_eq!(render(&["--reference", path]).status.code(), Some(0));

    let difference = scratch("reference.seen.png");
    let seen = difference.to_str().unwrap();
    let output = render(&["--reference", path, "--azimuth", "31", "--difference", seen]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("pixels differ"), "{}", stderr(&output));
    assert!(std::fs::read(&difference).unwrap().starts_with(b"\x89PNG"));

    let output = render(&["--reference", path, "--resolution", "80,60"]);
    assert_eq!(output.status.code(), Some(2), "an option given twice");
    let output =
        run(&["render", &model("teapot.obj"), "--resolution", "80,60", "--reference", path]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("measures 160 x 120"));
}

#[test]
fn no_color_means_characters_alone() {
    let plain = render(&["--terminal", "ascii"]);
    assert!(plain.stdout.iter().all(|byte| *byte == b'\n' || (b' '..=b'~').contains(byte)));
    assert!(plain.stdout.contains(&b'#'));
    let teapot = model("teapot.obj");
    let forced = |how: &str| {
        let line = ["render", &teapot, "--terminal", how, "--resolution", "160,120"];
        scanout().args(line).env("NO_COLOR", "1").output().unwrap().stdout
    };
    assert!(forced("half-blocks").starts_with(b"\x1b[38;5;"), "forcing beats NO_COLOR");
    assert!(forced("kitty").starts_with(b"\x1b_Ga=T"));
    assert!(forced("sixel").starts_with(b"\x1bPq"));
}

#[test]
fn several_models_in_one_scene() {
    let (a, b) = (model("torus.obj"), model("cube.obj"));
    let output = run(&["render", &a, &b, "--json", "--resolution", "80,60"]);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let alone = run(&["render", &a, "--json", "--resolution", "80,60"]);
    let one: serde_json::Value = serde_json::from_slice(&alone.stdout).unwrap();
    assert_eq!(
        value["frames"][0]["triangles"].as_u64(),
        one["frames"][0]["triangles"].as_u64().map(|n| n + 12)
    );
}

#[test]
fn turntables_of_each_container() {
    let cube = model("cube.obj");
    let make = |name: &str| {
        let path = scratch(name);
        let line = ["turntable", &cube, "--frames", "3", "--resolution", "40,30", "-o"];
        let output = scanout().args(line).arg(&path).output().unwrap();
        assert!(output.status.success(), "{}", stderr(&output));
        path
    };
    assert!(std::fs::read(make("turn.gif")).unwrap().starts_with(b"GIF89a"));
    let apng = std::fs::read(make("turn.png")).unwrap();
    assert_eq!(apng.windows(4).filter(|four| four == b"fcTL").count(), 3);
    let folder = make("turn");
    assert!(folder.join("frame-0002.png").is_file() && !folder.join("frame-0003.png").exists());
}

#[test]
fn the_lines_of_system_d() {
    let output = run(&["lines", "--octants", "--table", "-"]);
    let text = stdout(&output);
    let rows: Vec<Vec<i32>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(' ').map(|word| word.parse().unwrap()).collect())
        .collect();
    assert!(rows.iter().all(|row| row.len() == 6));
    assert_eq!(rows.last().map(|row| row[0]), Some(15));
    assert_eq!(rows[0], [0, 120, 120, 255, 0, 0]);
}

#[test]
fn the_demonstration_needs_neither_display_nor_terminal_nor_models() {
    let folder = scratch("empty");
    std::fs::create_dir_all(&folder).unwrap();
    let _ = std::fs::remove_dir_all(folder.join("out"));
    let output = scanout().current_dir(&folder).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(output.stdout.is_empty(), "narration goes to standard error");
    let told = stderr(&output);
    assert!(told.contains("no window") && told.contains("Try next"), "{told}");
    for name in ["textured.png", "hidden.png", "turntable.gif"] {
        assert!(folder.join("out").join(name).is_file(), "{name}");
        assert!(told.contains(name), "{name}");
    }
}

#[test]
fn a_window_without_a_display_says_what_to_do() {
    let output = run(&["view", &model("cube.obj")]);
    assert_eq!(output.status.code(), Some(1));
    one_line(&stderr(&output));
    assert!(stderr(&output).contains("scanout render"));
}

#[test]
fn baking_writes_the_binary_and_the_tables() {
    let folder = scratch("baked");
    let output = scanout().args(["bake", &model("cube.obj"), "-o"]).arg(&folder).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(std::fs::read(folder.join("cube.mesh")).unwrap().starts_with(b"SCNM"));
    assert!(folder.join("README.md").is_file());
}

#[test]
fn a_reference_is_never_overwritten() {
    let path = scratch("kept.png");
    let name = path.to_str().unwrap();
    assert!(render(&["-o", name]).status.success());
    let before = std::fs::read(&path).unwrap();
    let folder = path.parent().unwrap();
    let detour = folder.join("..").join(folder.file_name().unwrap()).join("kept.png");
    for other in [name, detour.to_str().unwrap()] {
        let output = render(&["--azimuth", "50", "-o", other, "--reference", name]);
        assert_eq!(output.status.code(), Some(2), "{other}");
        one_line(&stderr(&output));
        let output = render(&["--azimuth", "50", "--difference", other, "--reference", name]);
        assert_eq!(output.status.code(), Some(2), "{other}");
    }
    assert_eq!(std::fs::read(&path).unwrap(), before);
}

#[test]
fn a_difference_obeys_its_name_and_goes_away_when_equal() {
    let (reference, difference) = (scratch("plain.png"), scratch("plain.seen.ppm"));
    let (reference, seen) = (reference.to_str().unwrap(), difference.to_str().unwrap());
    assert!(render(&["-o", reference]).status.success());
    let line = ["--reference", reference, "--difference", seen, "--json"];
    let unequal = render(&[&line[..], &["--azimuth", "31"]].concat());
    assert_eq!(unequal.status.code(), Some(1));
    assert!(std::fs::read(&difference).unwrap().starts_with(b"P6"));
    let value: serde_json::Value = serde_json::from_slice(&unequal.stdout).unwrap();
    assert_eq!(value["reference"]["equal"], false);
    assert!(value["reference"]["different_pixels"].as_u64() > Some(0));

    let equal = render(&line);
    assert_eq!(equal.status.code(), Some(0));
    assert!(!difference.exists(), "a stale difference stays");
    let value: serde_json::Value = serde_json::from_slice(&equal.stdout).unwrap();
    assert_eq!(value["reference"]["equal"], true);
    assert_eq!(value["reference"]["different_pixels"], 0);
    let jpeg = render(&["--reference", reference, "--difference", "a.jpg"]);
    assert_eq!(jpeg.status.code(), Some(2));
}

#[test]
fn a_file_where_a_folder_should_be() {
    let file = scratch("no-folder");
    std::fs::write(&file, "").unwrap();
    let (name, cube) = (file.to_str().unwrap(), model("cube.obj"));
    for line in [
        ["bake", &cube, "-o", name].as_slice(),
        &["turntable", &cube, "-o", name, "--frames", "2"],
        &["demo", "--no-window", "-o", name],
    ] {
        let output = run(line);
        assert_eq!(output.status.code(), Some(1));
        let told = stderr(&output).lines().last().unwrap_or_default().to_string();
        assert!(told.contains("is not a folder"), "{told}");
    }
    let output = run(&["bake", &cube, "-o", "-"]);
    assert_eq!(output.status.code(), Some(2));
    one_line(&stderr(&output));
}

#[cfg(unix)]
#[test]
fn the_null_device_takes_everything() {
    assert!(render(&["-o", "/dev/null"]).status.success());
    let cube = model("cube.obj");
    let line = ["turntable", &cube, "-o", "/dev/null", "--frames", "2", "--resolution", "40,30"];
    assert!(run(&line).status.success());
}

#[test]
fn options_that_exclude_each_other_exit_with_2() {
    let cube = model("cube.obj");
    for line in [
        "--fog 10,1",
        "--eye 0,0,4 --screen 4,3 --orthographic",
        "--eye 0,0,4 --screen 4,3 --zoom 2",
        "--eye 0,0,4 --screen 4,3 --camera-position 1,2,3",
        "--eye 0,0,4 --screen 4,3 --camera-view-angle 20",
        "--orthographic --camera-view-angle 20",
        "--orthographic --stereo anaglyph",
        "--two-sided --one-sided",
    ] {
        let mut all = vec!["render", &cube, "--hash"];
        all.extend(line.split(' '));
        let output = run(&all);
        assert_eq!(output.status.code(), Some(2), "{line}");
        one_line(&stderr(&output));
    }
}

#[test]
fn a_camera_out_of_reach_is_named() {
    for (option, place) in [
        ("--camera-focal-point", "1e9,0,0"),
        ("--camera-position", "1e30,0,0"),
        ("--camera-position", "0,1e7,0"),
    ] {
        let output = render(&["--hash", option, place]);
        assert_eq!(output.status.code(), Some(2));
        one_line(&stderr(&output));
        assert!(stderr(&output).contains(option), "{}", stderr(&output));
        assert!(stderr(&output).contains("stay within"), "{}", stderr(&output));
    }
    // Everything within reach can be drawn.
    for line in [
        ["--camera-position", "0,0,1600000"].as_slice(),
        &["--camera-focal-point", "1200000,0,0"],
        &["--camera-position", "0,0,1600000", "--camera-focal-point", "1200000,0,0"],
    ] {
        let output = render(&[&["--hash"], line].concat());
        assert!(output.status.success(), "{}", stderr(&output));
    }
}

#[test]
fn help_is_a_command_too() {
    let words = |line: &[&str]| stdout(&run(line));
    assert!(words(&["help"]).contains("Usage: scanout"));
    assert!(words(&["help", "render"]).contains("--camera-position"));
    let lone = run(&["view", &model("cube.obj")]);
    assert!(stderr(&lone).starts_with("scanout: window: neither WAYLAND_DISPLAY"));
}

#[cfg(target_os = "linux")]
#[test]
fn help_to_a_full_disk_fails() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    for line in [&["--help"][..], &["man"], &["completions", "bash"]] {
        let output = scanout().args(line).stdout(full.try_clone().unwrap()).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{line:?}");
        one_line(&stderr(&output));
    }
}

#[test]
fn a_fast_gif_is_told() {
    let (cube, path) = (model("cube.obj"), scratch("fast.gif"));
    let path = path.to_str().unwrap();
    let make = |fps| {
        let line = ["turntable", &cube, "--frames", "2", "--resolution", "20,15", "--fps", fps];
        stderr(&run(&[&line[..], &["-o", path]].concat()))
    };
    assert!(make("51").contains("browsers"));
    assert!(!make("50").contains("browsers"));
}

/// Draws a text as an OBJ model; what is said on standard error.
fn told(name: &str, text: &str, options: &str) -> String {
    let path = scratch(name);
    std::fs::write(&path, text).unwrap();
    let mut line = vec!["render", path.to_str().unwrap(), "--hash", "--resolution", "40,30"];
    line.extend(options.split_whitespace());
    let output = run(&line);
    assert!(output.status.success(), "{}", stderr(&output));
    stderr(&output)
}

const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
const EDGES: &str = "v 0 0 0\nv 1 0 0\nv 1 1 1\nl 1 2 3\n";
const DOTS: &str = "v 0 0 0\nv 1 0 0\nv 1 1 1\np 1 2 3\n";

#[test]
fn a_blank_picture_is_told_with_the_remedy() {
    assert_eq!(told("quad.obj", QUAD, ""), "");
    assert_eq!(told("quad.obj", QUAD, "--azimuth 180"), "", "open models are drawn two-sided");
    let cases = [
        ("quad.obj", QUAD, "--azimuth 180 --one-sided", "--two-sided"),
        ("quad.obj", QUAD, "--fog 0.1,0.2", "fog"),
        ("quad.obj", QUAD, "--fog 0.1,0.2 --dither --format rgb565", "fog"),
        ("quad.obj", QUAD, "--camera-position 9,0,9 --camera-focal-point 20,0,9", "camera options"),
        ("quad.obj", QUAD, "--color black --background black", "--color"),
        ("edges.obj", EDGES, "--mode gouraud", "--mode wire"),
        ("dots.obj", DOTS, "--mode wire", "--mode points"),
    ];
    for (name, text, options, remedy) in cases {
        let told = told(name, text, options);
        one_line(&told);
        assert!(told.contains("nothing is to be seen") && told.contains(remedy), "{told}");
    }
    let cube = std::fs::read_to_string(model("cube.obj")).unwrap();
    let cube: String =
        cube.lines().filter(|l| !l.starts_with("mtllib")).fold(String::new(), |a, l| a + l + "\n");
    let inside = "--camera-position 0.1,0.1,0.1 --camera-focal-point 1,0,0";
    assert!(told("inside.obj", &cube, inside).contains("use --two-sided"));
    assert!(!told("inside.obj", &cube, &format!("{inside} --two-sided")).contains("nothing"));
}

#[test]
fn models_without_faces_choose_their_mode() {
    assert!(told("edges.obj", EDGES, "").contains("drawn as wire"));
    assert!(told("dots.obj", DOTS, "").contains("drawn as points"));
    assert_eq!(told("edges.obj", EDGES, "--mode wire"), "");
    // Beside a model with faces, lines and points are still seen.
    let quad = scratch("beside.obj");
    std::fs::write(&quad, QUAD).unwrap();
    let edges = scratch("beside-edges.obj");
    std::fs::write(&edges, "v 0 0 2\nv 1 1 2\nl 1 2\n").unwrap();
    let (quad, edges) = (quad.to_str().unwrap(), edges.to_str().unwrap());
    let count = |more: &[&str]| {
        let line = ["render", quad, edges, "--json", "--resolution", "40,30"];
        let output = run(&[&line[..], more].concat());
        let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        value["frames"][0]["primitives"].as_u64().unwrap()
    };
    assert_eq!(count(&[]), count(&["--mode", "gouraud"]) + 1);
}

#[test]
fn half_blocks_in_a_pipe_obey_colorterm() {
    let teapot = model("teapot.obj");
    let line = ["render", &teapot, "--terminal", "half-blocks", "--resolution", "40,30"];
    let output = scanout().args(line).env("COLORTERM", "truecolor").output().unwrap();
    assert!(output.stdout.starts_with(b"\x1b[38;2;"));
}

/// Runs the program in a terminal of 80 x 24 that never answers; everything that it wrote there.
#[cfg(target_os = "linux")]
fn in_terminal(line: &str, variable: (&str, &str)) -> Option<String> {
    let program = scanout().get_program().to_str().unwrap().to_string();
    let command = format!("stty cols 80 rows 24; {program} {line}");
    let mut script = std::process::Command::new("script");
    script.args(["-qec", &command, "/dev/null"]).stdin(Stdio::null());
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET", "NO_COLOR", "COLORTERM"] {
        script.env_remove(name);
    }
    let output = script.env(variable.0, variable.1).output().ok()?; // not installed
    Some(stdout(&output))
}

#[cfg(target_os = "linux")]
#[test]
fn a_plain_terminal_is_sent_no_control_sequences() {
    let line = format!("render {} --resolution 80,60", model("teapot.obj"));
    for variable in [("NO_COLOR", "1"), ("TERM", "dumb")] {
        // The quickest of a few: other programs may keep the machine busy, an answer that never comes makes each slow.
        let mut quickest = u128::MAX;
        for _ in 0..5 {
            let start = std::time::Instant::now();
            let Some(told) = in_terminal(&line, variable) else { return };
            assert!(told.contains('#') && !told.contains('\x1b'), "{told:?}");
            quickest = quickest.min(start.elapsed().as_millis());
            if quickest < 900 {
                break;
            }
        }
        assert!(quickest < 900, "it waited for an answer");
    }
    let turn = format!(
        "turntable {} --frames 3 --resolution 40,30 -o {}",
        model("cube.obj"),
        scratch("plain.gif").display()
    );
    let Some(told) = in_terminal(&turn, ("TERM", "dumb")) else { return };
    assert!(told.contains("wrote") && !told.contains('\x1b'), "{told:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn the_demonstration_leaves_its_picture_in_sight() {
    let line = format!("demo -o {}", scratch("in-sight").display());
    let Some(told) = in_terminal(&line, ("TERM", "dumb")) else { return };
    let lines: Vec<&str> = told.lines().map(str::trim_end).collect();
    let last = &lines[lines.len() - 23..]; // and the prompt
    assert!(last.iter().any(|line| line.contains("Try next")), "{told}");
    let from_picture = lines.iter().position(|line| line.is_empty() || line.contains('@'));
    assert!(from_picture.is_some_and(|top| top >= lines.len() - 23), "{told}");
}

#[test]
fn the_model_says_what_lies_outside_its_texture() {
    let photo = std::path::PathBuf::from(model("cube.ppm"));
    std::fs::copy(photo, scratch("wrap.ppm")).unwrap();
    let hash = |wrap: &str, options: &[&str]| {
        let mtl = format!("newmtl a\nKd 1 1 1\nmap_Kd {wrap}wrap.ppm\n");
        std::fs::write(scratch("wrap.mtl"), mtl).unwrap();
        let obj = "mtllib wrap.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n\
                   vt 0 0\nvt 3 0\nvt 3 3\nvt 0 3\nf 1/1 2/2 3/3 4/4\n";
        let path = scratch("wrap.obj");
        std::fs::write(&path, obj).unwrap();
        let line = ["render", path.to_str().unwrap(), "--hash", "--resolution", "40,30"];
        let output = run(&[&line[..], options].concat());
        assert!(output.stderr.is_empty(), "{}", stderr(&output));
        stdout(&output)
    };
    let (repeated, clamped) = (hash("", &[]), hash("-clamp on ", &[]));
    assert_ne!(repeated, clamped);
    assert_eq!(hash("", &["--texture-wrap", "clamp"]), clamped);
    assert_eq!(hash("-clamp on ", &["--texture-wrap", "repeat"]), repeated);
}
