//! `scanout bench`: the pixels of its cases, its answers, its errors.
//!
//! `SCANOUT_BLESS=1 cargo test -p scanout-cli --test bench` rewrites the hashes that the program knows.

mod support;

use serde_json::Value;
use support::{bless, kept, model, run, stderr, stdout};

fn answer(arguments: &[&str]) -> Value {
    let output = run(&[&["bench", "--json", "--time", "0.01"], arguments].concat());
    serde_json::from_str(&stdout(&output)).unwrap_or_else(|_| panic!("{}", stderr(&output)))
}

#[test]
fn every_case_draws_the_pixels_that_the_program_knows() {
    let answer = answer(&["--threads", "1,3"]);
    let cases = answer["cases"].as_array().unwrap();
    let mut known = String::new();
    let mut differ = Vec::new();
    for case in cases.iter().filter(|case| case["threads"] == 1) {
        let (name, hash) = (case["case"].as_str().unwrap(), case["hash"].as_str().unwrap());
        known.push_str(&format!("{name} {hash}\n"));
        if case["same"] != true {
            differ.push(name);
        }
    }
    if bless() {
        std::fs::write(kept("../src/cmd/bench/hashes.txt"), known).unwrap();
        return;
    }
    assert!(differ.is_empty(), "other pixels: {differ:?}");
    // Three threads drew every frame too, and no line.
    let threads = |n: u64| cases.iter().filter(|case| case["threads"] == n).count();
    assert_eq!((threads(1), threads(3)), (cases.len() - threads(3), threads(1) - 2));
}

#[test]
fn a_model_of_ones_own() {
    let torus = model("torus.obj");
    let answer = answer(&["--model", &torus, "--threads", "2"]);
    let cases = answer["cases"].as_array().unwrap();
    let names: Vec<_> = cases.iter().map(|case| case["case"].as_str().unwrap()).collect();
    let looks = ["flat", "gouraud", "textured", "wire"];
    assert_eq!(names, looks.map(|look| format!("torus:{look}:640x480")));
    for case in cases {
        assert_eq!(case["same"], Value::Null);
        assert_eq!(case["pixels"], 640 * 480);
        let times = ["minimum_us", "median_us", "frames_per_second", "pixels_per_second"];
        assert!(times.iter().all(|name| case[name].as_f64() > Some(0.0)), "{case}");
        assert!(case["minimum_us"].as_f64() <= case["median_us"].as_f64());
        assert!(case["runs"].as_u64() >= Some(3));
    }
    // The file's path is a source as well.
    let own = format!("{torus}:flat:640x480");
    let output = run(&["bench", "--time", "0.01", "--threads", "1", "--cases", &own]);
    assert!(stdout(&output).contains(cases[0]["hash"].as_str().unwrap()), "{}", stdout(&output));
}

#[test]
fn the_table_names_its_columns() {
    let output = run(&["bench", "--time", "0.01", "--cases", "5000:flat,lines:short"]);
    let text = stdout(&output);
    let mut lines = text.lines();
    let head = lines.next().unwrap();
    assert!(head.starts_with("case ") && head.ends_with("hash"), "{head}");
    assert!(lines.next().unwrap().starts_with("5000:flat:320x240 "));
    assert!(lines.last().unwrap().starts_with("lines:short:320x240 "));
    assert!(!text.contains("DIFFERS") && text.contains(" same"), "{text}");
}

#[test]
fn wrong_words_and_files() {
    let wrong: [(&[&str], i32); 7] = [
        (&["--cases", "nothing"], 2),
        (&["--cases", "5000:flatt:320x240"], 2),
        (&["--cases", "5000:flat:0x240"], 2),
        (&["--cases", "lines:middle:320x240"], 2),
        (&["--time", "0"], 2),
        (&["--threads", "0"], 2),
        (&["--model", "no such file.obj"], 1),
    ];
    for (arguments, code) in wrong {
        let output = run(&[&["bench"], arguments].concat());
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        let text = stderr(&output);
        let last = text.lines().last().unwrap();
        assert!(last.starts_with("scanout: ") && last.contains("; "), "{text}");
    }
}
