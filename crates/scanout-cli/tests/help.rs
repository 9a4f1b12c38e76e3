//! Help texts, compared with the ones in `tests/help`. `SCANOUT_BLESS=1 cargo test -p scanout-cli --test help` rewrites them.

mod support;

use support::{bless, kept, run, stdout};

fn check(name: &str, arguments: &[&str]) {
    let output = run(arguments);
    assert!(output.status.success());
    let got = stdout(&output);
    let path = kept("help").join(name).with_extension("txt");
    if bless() {
        std::fs::write(&path, &got).unwrap();
        return;
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        got == expected,
        "{} differs; SCANOUT_BLESS=1 rewrites it; got:\n{got}",
        path.display()
    );
}

#[test]
fn help_texts() {
    check("scanout", &["--help"]);
    for command in [
        "demo",
        "render",
        "view",
        "window",
        "turntable",
        "info",
        "bake",
        "marker",
        "ar",
        "calibrate",
        "lines",
        "bench",
        "completions",
        "man",
    ] {
        check(command, &[command, "--help"]);
    }
}

#[test]
fn the_man_page_names_every_option_of_render() {
    let page = stdout(&run(&["man"])).replace('\\', "");
    let help = stdout(&run(&["render", "--help"]));
    let mut count = 0;
    for line in help.lines().filter(|line| line.trim_start().starts_with('-')) {
        let Some(name) = line.split_whitespace().find(|word| word.starts_with("--")) else {
            continue;
        };
        assert!(page.contains(name), "{name} is missing in the man page");
        count += 1;
    }
    assert!(count > 40);
    assert!(page.starts_with(".ie") && page.contains(".TH scanout 1"));
}

#[test]
fn completions_know_the_commands() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = stdout(&run(&["completions", shell]));
        assert!(text.contains("turntable") && text.contains("camera-position"), "{shell}");
    }
}
