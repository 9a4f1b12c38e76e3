//! Pictures of every mode and option, compared with the ones in `tests/goldens` pixel by pixel.
//!
//! `SCANOUT_BLESS=1 cargo test -p scanout-cli --test goldens` rewrites them, and nothing else does. A changed golden is
//! a change that users see: list it in CHANGELOG.md. On failure the picture, the golden and their difference are
//! written to the build's temporary folder, and the test says where.

mod support;

use scanout_cli::args::OutputFormat;
use scanout_cli::{compare, image_out};
use support::{bless, kept, model, run, scratch, stderr};

/// Draws, compares; a line of complaint when different.
fn check(name: &str, models: &[&str], options: &str) -> Option<String> {
    let got = scratch(&format!("{name}.got.png"));
    let models: Vec<String> = models.iter().map(|name| model(name)).collect();
    let photo = model("cube.ppm");
    let mut line = vec!["render"];
    line.extend(models.iter().map(String::as_str));
    line.extend(["--resolution", "160,120", "-o", got.to_str().expect("UTF-8")]);
    line.extend(options.split_whitespace().map(|word| if word == "PHOTO" { &photo } else { word }));
    let output = run(&line);
    assert!(output.status.success(), "{name}: {}", stderr(&output));

    let golden = kept("goldens").join(format!("{name}.png"));
    if bless() {
        std::fs::copy(&got, &golden).expect("golden written");
        return None;
    }
    let picture = compare::read(&got).expect("the program writes PNG");
    let Ok(expected) = compare::read(&golden) else {
        return Some(format!("{name}: there is no golden {}", golden.display()));
    };
    if (picture.width, picture.height) != (expected.width, expected.height) {
        return Some(format!("{name}: another size"));
    }
    let difference = compare::compare(&picture, &expected)?;
    let beside = |what: &str| scratch(&format!("{name}.{what}.png"));
    std::fs::copy(&golden, beside("expected")).expect("copied");
    image_out::write(&beside("difference"), OutputFormat::Png, &difference.picture, &[])
        .expect("written");
    Some(format!(
        "{name}: {} pixels differ, by up to {}, first at {:?}; see {} (and .expected, .difference)",
        difference.pixels,
        difference.largest,
        difference.first,
        got.display(),
    ))
}

fn check_all(cases: &[(&str, &[&str], &str)]) {
    let wrong: Vec<String> = cases.iter().filter_map(|c| check(c.0, c.1, c.2)).collect();
    assert!(wrong.is_empty(), "{} of {} differ:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
}

const TEAPOT: &[&str] = &["teapot.obj"];
const EARTH: &[&str] = &["earth.obj"];
const CUBE: &[&str] = &["cube.obj"];

#[test]
fn modes() {
    check_all(&[
        ("points", TEAPOT, "--mode points --point-size 3"),
        ("wire", TEAPOT, "--mode wire"),
        ("wire-smooth", TEAPOT, "--mode wire --smooth-lines"),
        ("hidden", TEAPOT, "--mode hidden"),
        ("hidden-smooth", TEAPOT, "--mode hidden --smooth-lines"),
        ("flat", TEAPOT, "--mode flat"),
        ("gouraud", TEAPOT, "--mode gouraud"),
        ("phong", TEAPOT, "--mode phong"),
        ("textured", EARTH, "--mode textured"),
        ("phong-textured", EARTH, "--mode phong --texture PHOTO"),
        ("hand", &["hand.glb"], "--background silver"),
        ("two-models", &["torus.obj", "cube.obj"], ""),
    ]);
}

#[test]
fn cameras() {
    check_all(&[
        ("front", TEAPOT, "--azimuth 0 --elevation 0"),
        ("below-rolled", TEAPOT, "--azimuth -120 --elevation -40 --roll 15"),
        ("pole", EARTH, "--elevation 90"),
        ("z-up", TEAPOT, "--up +Z"),
        ("zoom", EARTH, "--zoom 2.5"),
        ("wide-and-near", CUBE, "--camera-view-angle 100"),
        ("orthographic", CUBE, "--orthographic --mode hidden"),
        (
            "placed",
            TEAPOT,
            "--camera-position 40,30,50 --camera-focal-point 0,8,0 --camera-view-up 0.2,1,0",
        ),
        ("inside", CUBE, "--camera-position 0.3,0.2,0.1 --camera-view-angle 90 --two-sided"),
        ("off-axis", CUBE, "--eye 1.5,0.8,4 --screen 4,3"),
        ("rotation-frame", CUBE, "--rotation-frame 11 --rotation-axis 1,1,0"),
    ]);
}

#[test]
fn lights_and_textures() {
    check_all(&[
        ("light-left", TEAPOT, "--light -1,0,0 --ambient 0 --diffuse 1 --specular 0"),
        (
            "lamp",
            TEAPOT,
            "--mode phong --light point:0,25,10 --light 0,0,1 --shininess 8 --specular 0.6 --diffuse 0.4",
        ),
        ("light-floor", EARTH, "--light 1,0,0 --ambient 0 --light-floor 0.3"),
        ("fog", TEAPOT, "--fog 45,60 --background white"),
        ("nearest", CUBE, "--texture-filter nearest"),
        ("bilinear", CUBE, "--texture-filter bilinear"),
        ("color", TEAPOT, "--color orange"),
    ]);
}

#[test]
fn formats_and_stereo() {
    check_all(&[
        ("rgb565", EARTH, "--format rgb565"),
        ("rgb565-dither", EARTH, "--format rgb565 --dither"),
        ("rgb332-dither", EARTH, "--format rgb332 --dither"),
        ("mono", TEAPOT, "--format mono"),
        ("mono-dither", TEAPOT, "--format mono --dither"),
        ("background-image", TEAPOT, "--mode wire --background PHOTO"),
        ("anaglyph", TEAPOT, "--stereo anaglyph"),
        ("anaglyph-grey", EARTH, "--stereo anaglyph-grey"),
        ("anaglyph-half-colour", EARTH, "--stereo anaglyph-half-colour"),
        ("anaglyph-dubois", EARTH, "--stereo anaglyph-dubois"),
        ("anaglyph-swapped", EARTH, "--stereo anaglyph --swap-eyes"),
        ("side-by-side-half", CUBE, "--stereo side-by-side-half"),
        ("top-bottom-half", CUBE, "--stereo top-bottom-half"),
        ("side-by-side", CUBE, "--stereo side-by-side"),
        ("top-bottom", CUBE, "--stereo top-bottom"),
        ("interlaced", CUBE, "--stereo interlaced --eye-distance 0.5"),
        ("off-axis-stereo", CUBE, "--eye 1.5,0.8,4 --screen 4,3 --stereo anaglyph"),
    ]);
}
