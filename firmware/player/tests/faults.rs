//! Every fault is told on the display and on the serial port, and nothing panics.

mod common;

use common::{Pc, Prank, card_with, expected, image, model_file};
use player::fault::{CardFault, Fault, FileFault, ModelFault, Part};
use player::message;
use player::play::AREA;
use scanout::math::Q16;
use scanout_assets::{obj, ppm};
use scanout_display::model::{DisplayModel, Glass, Picture};

const SHOW: &str = "scale 0.9\nframes 3\nharts one";

/// The message's picture, drawn in one piece.
fn picture(text: &str) -> Picture<u16> {
    let mut bus = common::Bus { model: DisplayModel::new(Glass::default()), silent: 0, after: 0 };
    let setup = scanout_display::init::Setup { orientation: common::TURNED, ..Default::default() };
    setup.start(&mut bus, &mut scanout_display::model::NoDelay).unwrap();
    message::show(
        &mut bus,
        AREA,
        &mut vec![0; 320 * 240],
        b"scanout can't go on:",
        text.as_bytes(),
    )
    .unwrap();
    bus.model.picture().unwrap().upright(common::TURNED)
}

/// A fault that stays: it is told, and the board gives up at once.
fn stays(image: Vec<u8>, prank: Prank) -> (Fault, String) {
    let mut pc = Pc::new(image, prank);
    let fault = pc.play().unwrap_err();
    let text = fault.to_string();
    assert_eq!(pc.faults, std::slice::from_ref(&fault));
    assert!(pc.said.contains(&format!("fault: {text}")), "{:?}", pc.said);
    assert_eq!(pc.messages.len(), 1);
    assert!(pc.messages[0] == picture(&text), "on the display: {text}");
    assert!(pc.messages[0].pixels.iter().filter(|&&pixel| pixel == 0xffff).count() > 100);
    assert!(text.len() < 200 && text.is_ascii(), "{text}");
    (fault, text)
}

/// A fault that passes: it is told, and then the frames come.
fn passes(image: Vec<u8>, prank: Prank) -> Vec<Fault> {
    let mut pc = Pc::new(image, prank);
    pc.patience = 9;
    assert_eq!(pc.play(), Ok(()));
    assert_eq!(pc.hashes, expected("b", true, Q16::from_ratio(9, 10), 3));
    assert_eq!(pc.messages.len(), pc.faults.len());
    pc.faults
}

#[test]
fn no_card() {
    let (fault, text) = stays(card_with("b", SHOW), Prank::Missing(9));
    assert!(matches!(fault, Fault::Card { fault: CardFault::Missing, .. }));
    assert!(text.starts_with("no SD card answers"));
    assert_eq!(passes(card_with("b", SHOW), Prank::Missing(2)).len(), 2);
}

#[test]
fn pulled_out_between_any_two_sectors() {
    let mut pc = Pc::new(card_with("b", SHOW), Prank::None);
    pc.play().unwrap();
    let all = pc.card.reads.get();
    assert!(all > 60);
    let card = card_with("b", SHOW);
    for sectors in (0..all).step_by(7).chain([1, 2, 3, all - 1]) {
        // Put back in, it goes on.
        let faults = passes(card.clone(), Prank::PulledAfter(sectors.max(1)));
        assert!(
            matches!(faults[..], [Fault::Card { fault: CardFault::Gone, .. }]),
            "{sectors}: {faults:?}"
        );
    }
    // After the last sector nobody needs the card.
    assert_eq!(passes(card, Prank::PulledAfter(all)), []);
}

#[test]
fn wrong_checksums_are_tried_again_and_then_told() {
    for times in [1, 2] {
        let mut pc = Pc::new(card_with("b", SHOW), Prank::Checksum(0, times));
        assert_eq!(pc.play(), Ok(()));
        assert_eq!(pc.hashes, expected("b", true, Q16::from_ratio(9, 10), 3));
        assert!(pc.said.iter().any(|line| line.ends_with("of them again")));
    }
    let (fault, text) = stays(card_with("b", SHOW), Prank::Checksum(2100, 3));
    assert!(matches!(fault, Fault::Card { fault: CardFault::Checksum, tries: 3, .. }), "{fault:?}");
    assert!(text.contains("wrong checksum 3 times"));
}

#[test]
fn a_sector_that_cannot_be_read() {
    let (fault, _) = stays(card_with("b", SHOW), Prank::Refuse(2048));
    assert_eq!(fault, Fault::Card { fault: CardFault::Refused, sector: 2048, tries: 1 });
}

#[test]
fn not_fat32() {
    let mut card = card_with("b", SHOW);
    let with = |at: usize, bytes: &[u8]| {
        let mut card = card.clone();
        card[at..at + bytes.len()].copy_from_slice(bytes);
        stays(card, Prank::None).1
    };
    assert!(with(510, &[0, 0]).contains("no FAT32 on the SD card (sector 0 has no signature)"));
    assert!(with(450, &[0x07]).contains("exFAT or NTFS"));
    assert!(with(450, &[0x83]).contains("no partition is FAT"));
    assert!(with(450, &[0xee]).contains("GPT"));
    assert!(with(3, b"EXFAT   ").contains("exFAT"));
    assert!(with(2048 * 512 + 510, &[0, 0]).contains("no FAT32"));
    card.fill(0);
    assert!(stays(card, Prank::None).1.contains("no FAT32"));
}

#[test]
fn damaged_file_systems_do_not_panic() {
    let good = card_with("b", SHOW);
    let mut state = 12345u32;
    let mut random = move |most: usize| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as usize % most
    };
    let volume = 2048 * 512;
    let fat = volume + 32 * 512;
    let sectors_per_fat =
        u32::from_le_bytes(good[volume + 36..volume + 40].try_into().unwrap()) as usize;
    let root = fat + 2 * sectors_per_fat * 512;
    let mut card = good;
    for round in 0..300 {
        let mut changed = Vec::new();
        for _ in 0..1 + random(3) {
            // The volume's boot sector, the first chains, the folders.
            let (from, most) = [(volume, 90), (fat, 400), (root, 1024)][round % 3];
            let at = from + random(most);
            changed.push((at, card[at]));
            card[at] = random(256) as u8;
        }
        let mut pc = Pc::new(card, Prank::None);
        pc.patience = 1;
        let _ = pc.play();
        card = pc.card.image;
        changed.iter().rev().for_each(|&(at, byte)| card[at] = byte);
    }
}

/// A card whose `show.txt` names these files.
fn card_of(obj: &[u8], ppm: Option<&[u8]>) -> Vec<u8> {
    let texture = if ppm.is_some() { "texture x.ppm\n" } else { "" };
    let show = format!("model x.obj\n{texture}frames 1\nharts one\nscale 0.9");
    let mut files = vec![("show.txt", show.into_bytes()), ("x.obj", obj.to_vec())];
    files.extend(ppm.map(|ppm| ("x.ppm", ppm.to_vec())));
    image(false, &files)
}

#[test]
fn missing_empty_and_confused_files() {
    let card = |files: &[common::File<'_>]| stays(image(false, files), Prank::None).1;
    let c = || model_file("c.obj");
    assert!(card(&[("other.txt", b"1".to_vec())]).starts_with("model.obj: no such file"));
    assert!(card(&[("model.obj", vec![])]).starts_with("model.obj: the file is empty"));
    assert!(
        card(&[("show.txt", vec![]), ("model.obj", c())])
            .starts_with("show.txt: the file is empty")
    );
    assert!(
        card(&[("show.txt", b"model d/e.obj".to_vec()), ("d/x", c())])
            .starts_with("d/e.obj: no such file")
    );
    assert!(card(&[("show.txt", b"model d".to_vec()), ("d/x", c())]).starts_with("d: a folder"));
    assert!(card(&[("show.txt", b"model x/y".to_vec()), ("x", c())]).starts_with("x/y: a folder"));
    assert!(
        card(&[("show.txt", b"\n\nscale big".to_vec()), ("model.obj", c())])
            .starts_with("show.txt, line 3: scale")
    );
    assert!(card(&[("show.txt", vec![b'#'; 1025]), ("model.obj", c())]).contains("1024 bytes"));
}

/// A file that is named twice isn't read twice.
#[test]
fn a_model_that_is_its_own_texture() {
    let files = [
        ("show.txt", b"model c.obj\ntexture c.obj\nframes 1\nharts one\nscale 0.9".to_vec()),
        ("c.obj", model_file("c.obj")),
    ];
    let mut pc = Pc::new(image(false, &files), Prank::None);
    pc.patience = 1;
    assert_eq!(pc.play(), Ok(()));
    assert_eq!(pc.hashes, expected("c", false, Q16::from_ratio(9, 10), 1));
    assert!(pc.faults[0].to_string().starts_with("c.obj: named twice"), "{:?}", pc.faults);
    let show = b"model show.txt".to_vec();
    assert!(stays(image(false, &[("show.txt", show)]), Prank::None).1.contains("named twice"));
}

#[test]
fn models_too_large_for_the_memory() {
    let repeat = |line: &str, n: usize| line.repeat(n).into_bytes();
    let base = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let cases: [(Vec<u8>, Part, u32); 4] = [
        (repeat("v 1 2 3\n", 501), Part::Positions, 501),
        (repeat("vn 1 2 3\n", 501), Part::Normals, 501),
        (repeat("vt 1 2\n", 501), Part::TextureCoordinates, 501),
        ([base.as_bytes(), &repeat("f 1 2 3\n", 1001)].concat(), Part::Triangles, 1004),
    ];
    for (file, part, line) in cases {
        let (fault, text) = stays(card_of(&file, None), Prank::None);
        let Fault::File(_, FileFault::Model(ModelFault::TooMany { line: at, part: what, .. })) =
            fault
        else {
            panic!("{fault:?}")
        };
        assert_eq!((at, what), (line, part), "{text}");
    }
}

#[test]
fn malformed_models() {
    let told = |text: &str| stays(card_of(text.as_bytes(), None), Prank::None);
    let (fault, text) = told("v 0 0 0\nv 1 x 0\n");
    assert!(matches!(
        fault,
        Fault::File(
            _,
            FileFault::Obj(obj::Error { line: 2, kind: obj::ErrorKind::NotANumber, .. })
        )
    ));
    assert_eq!(text, "x.obj, line 2: 'x' is not a finite number; mend the line");
    assert!(told("v 0 0\n").1.contains("line 1: too few numbers"));
    assert!(told("v 0 0 0\nf 1/ 2/b 3\n").1.contains("line 2"));
    assert!(told("v 0 0 0\n\nf 1 2 3\n").1.contains("line 3: refers to"));
    assert!(told("v 0 0 0\nv 0 1 0\nv 1 0 0\nf 1//1 2//1 3//1\n").1.contains("line 4: refers to"));
    assert!(told("v 0 0 2001\n").1.contains("line 1: a coordinate beyond 2000"));
    assert!(told("v 0 0 0\nf 1 1\n").1.contains("no faces"));
    assert!(told("PNG\x01\x02\x03").1.contains("no faces"));
}

/// A texture that is no good is told, then the model is shown without.
#[test]
fn textures_that_are_no_good() {
    let c = model_file("c.obj");
    let header = |text: &str, texels: usize| [text.as_bytes(), &vec![7; texels]].concat();
    for (ppm, part) in [
        (header("P6 251 250 255\n", 9), "251 x 250 texels; at most 62500"),
        (header("P6 1025 1 255\n", 9), "1025 x 1 texels"),
        (header("P6 65535 65535 255\n", 9), "65535 x 65535 texels"),
        (header("P6 8 8 255\n", 191), "the file ends before its last texel"),
        (header("P6 8 0 255\n", 191), "width and height"),
        (header("JFIF", 191), "not a PPM"),
    ] {
        let mut pc = Pc::new(card_of(&c, Some(&ppm)), Prank::None);
        pc.patience = 1;
        assert_eq!(pc.play(), Ok(()));
        assert_eq!(pc.hashes, expected("c", false, Q16::from_ratio(9, 10), 1));
        let text = pc.faults[0].to_string();
        assert!(text.contains(part), "{text}");
        assert!(pc.messages[0] == picture(&text));
    }
    let fault = Pc::new(card_of(&c, Some(b"P6 8 8 255\n\x01")), Prank::None).play();
    assert!(matches!(
        fault,
        Err(Fault::File(_, FileFault::Ppm(ppm::Error { kind: ppm::ErrorKind::Truncated, .. })))
    ));
}

#[test]
fn a_display_that_never_answers_and_one_that_comes_back() {
    let mut pc = Pc::new(card_with("b", SHOW), Prank::None);
    (pc.bus.silent, pc.patience) = (u32::MAX, 4);
    assert_eq!(pc.play(), Err(Fault::Display));
    assert_eq!(pc.said, ["fault: the display takes no data; check its wires and power"; 5]);
    // From the first byte on, in the middle of a frame, and while a fault is told.
    for after in [0, 3, 7, 30, 100] {
        for prank in [Prank::None, Prank::Missing(1)] {
            let mut pc = Pc::new(card_with("b", SHOW), prank);
            (pc.bus.after, pc.bus.silent, pc.patience) = (after, 3, 9);
            assert_eq!(pc.play(), Ok(()), "after {after}");
            assert_eq!(pc.hashes, expected("b", true, Q16::from_ratio(9, 10), 3), "after {after}");
            assert!(
                pc.said.contains(
                    &"fault: the display takes no data; check its wires and power".into()
                )
            );
        }
    }
    // On two harts the one that draws does not wait for ever for the one that sends.
    for harts in ["relay", "both"] {
        let mut pc =
            Pc::new(card_with("b", &format!("scale 0.9\nframes 3\nharts {harts}")), Prank::None);
        (pc.bus.after, pc.bus.silent, pc.patience) = (40, 3, 9);
        assert_eq!(pc.play(), Ok(()));
        assert_eq!(pc.hashes, expected("b", true, Q16::from_ratio(9, 10), 3), "{harts}");
    }
}
