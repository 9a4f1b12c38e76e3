//! What the firmware shows is what the PC draws, bit for bit: its own integer loader against the PC's in floating point.

mod common;

use common::{Pc, Prank, card_with, expected, fragment, image, model_file};
use scanout::math::Q16;

/// System B's scales.
fn scale(model: &str) -> Q16 {
    if model == "a" { Q16::from_ratio(35, 100) } else { Q16::from_ratio(9, 10) }
}

#[test]
fn a_turn_of_each_model_is_the_pcs() {
    for (model, show) in [("a", "scale 0.35"), ("b", "scale 0.9"), ("c", "scale 0.9")] {
        let mut pc =
            Pc::new(card_with(model, &format!("{show}\nframes 92\nharts one")), Prank::None);
        assert_eq!(pc.play(), Ok(()));
        assert_eq!(pc.faults, []);
        let hashes = expected(model, true, scale(model), 92);
        assert_eq!(pc.hashes, hashes, "{model}");
        assert!(hashes[0] != hashes[1] && hashes[0] == hashes[90]);
    }
}

#[test]
fn two_harts_show_the_same() {
    for harts in ["relay", "both"] {
        let show = format!("scale 0.9\nframes 180\nharts {harts}");
        let mut pc = Pc::new(card_with("b", &show), Prank::None);
        assert_eq!(pc.play(), Ok(()));
        assert_eq!(pc.hashes, expected("b", true, scale("b"), 180), "{harts}");
    }
}

#[test]
fn without_show_and_texture() {
    let mut pc = Pc::new(image(false, &[("model.obj", model_file("c.obj"))]), Prank::None);
    pc.patience = 2;
    // Without end: the bus fails some time, and patience with it.
    (pc.bus.after, pc.bus.silent) = (2_000, u32::MAX);
    assert!(pc.play().is_err());
    let count = pc.hashes.len() as u32;
    assert!(count > 10);
    assert_eq!(pc.hashes, expected("c", false, Q16::ONE, count));
}

#[test]
fn bare_volumes_sub_directories_long_names_and_fragments() {
    let show = "model Models of System B/Torus, the first one.obj\n\
                texture models of system b/textures/a long name, too.PPM\nscale 0.35\nframes 2\nharts one";
    let files = [
        ("show.txt", show.as_bytes().to_vec()),
        ("Models of System B/Torus, the first one.obj", model_file("a.obj")),
        ("Models of System B/textures/A long name, too.ppm", model_file("a.ppm")),
    ];
    let hashes = expected("a", true, scale("a"), 2);
    for bare in [false, true] {
        let plain = image(bare, &files);
        let mut pieces = plain.clone();
        fragment(&mut pieces, if bare { 0 } else { 2048 * 512 });
        assert!(plain != pieces);
        let sectors: usize = files.iter().map(|(_, bytes)| bytes.len().div_ceil(512)).sum();
        for image in [plain, pieces] {
            let mut pc = Pc::new(image, Prank::None);
            assert_eq!(pc.play(), Ok(()), "bare: {bare}");
            assert_eq!(pc.hashes, hashes, "bare: {bare}");
            // Each sector of the files once; folders and tables are a few more.
            let reads = pc.card.reads.get() as usize;
            assert!((sectors..sectors * 5 / 4).contains(&reads), "{reads} reads of {sectors}");
        }
    }
}
