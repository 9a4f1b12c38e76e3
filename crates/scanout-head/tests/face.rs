//! The readers of face models on damaged ones, and what a cascade and a localiser do, on models made here by hand.

mod support;

use scanout_head::face::{Boxes, Cascade, Finder, Grey, Localiser};
use support::Random;

fn put(to: &mut Vec<u8>, values: &[i32]) {
    to.extend(values.iter().flat_map(|value| value.to_le_bytes()));
}

fn put_real(to: &mut Vec<u8>, values: &[f32]) {
    to.extend(values.iter().flat_map(|value| value.to_le_bytes()));
}

/// Two trees of one comparison each: above must be darker than below, and left no brighter than right.
fn cascade() -> Vec<u8> {
    let mut bytes = Vec::new();
    put(&mut bytes, &[3, 0x7f81_7f81, 1, 2]);
    for comparison in [[-64i8, 0, 64, 0], [0, -64, 0, 64]] {
        bytes.extend(comparison.map(|code| code as u8));
        put_real(&mut bytes, &[-1.0, 1.0, 0.0]);
    }
    bytes
}

/// One stage, one tree of one comparison: left brighter than right, then a quarter of the side to the left and an eighth down,
/// otherwise stay.
fn localiser() -> Vec<u8> {
    let mut bytes = Vec::new();
    put(&mut bytes, &[1]);
    put_real(&mut bytes, &[0.5]);
    put(&mut bytes, &[1, 1]);
    bytes.extend([0i8, -64, 0, 64].map(|code| code as u8));
    put_real(&mut bytes, &[0.0, 0.0, 0.125, -0.25]);
    bytes
}

#[test]
fn a_cascade_compares() {
    let cascade = Cascade::read(&cascade()).unwrap();
    // Brighter downwards and to the right.
    let picture: Vec<u8> = (0..60 * 40).map(|i| (i % 60 + i / 60) as u8).collect();
    let grey = Grey::new(&picture, 60).unwrap();
    let lean = scanout_head::face::Lean::NONE;
    let score = |grey: &Grey<'_>, middle, side, lean| {
        cascade.score(&mut Boxes::new(grey, side, lean), grey, middle)
    };
    assert_eq!(score(&grey, [30, 20], 20, lean), Some(2 << 16));
    let upside_down: Vec<u8> = picture.iter().rev().copied().collect();
    let grey = Grey::new(&upside_down, 60).unwrap();
    assert_eq!(score(&grey, [30, 20], 20, lean), None);
    // A head that stands on its head.
    let turned = scanout_head::face::Lean::along(-1.0, 0.0);
    assert_eq!(score(&grey, [30, 20], 20, turned), Some(2 << 16));
    // Not wholly in the picture.
    for place in [[9, 20], [51, 20], [30, 9], [30, 31], [-400, 20]] {
        assert_eq!(score(&grey, place, 20, turned), None, "{place:?}");
    }
    assert_eq!(score(&grey, [30, 20], 9000, turned), None);
    // For pictures of another width.
    let narrow = Grey::new(&picture, 40).unwrap();
    let mut boxes = Boxes::new(&narrow, 20, lean);
    assert_eq!(cascade.score(&mut boxes, &grey, [30, 20]), None);
}

#[test]
fn a_localiser_steps() {
    use scanout_head::face::pupil::EyeBox;
    let localiser = Localiser::read(&localiser()).unwrap();
    let picture: Vec<u8> = (0..60 * 40).map(|i| 200 - (i % 60) as u8).collect();
    let grey = Grey::new(&picture, 60).unwrap();
    let lean = scanout_head::face::Lean::NONE;
    let from = EyeBox { middle: [30 * 256, 20 * 256], side: 16 * 256, lean };
    let [x, y] = localiser.find(&grey, from, 200);
    // 4 to the left, 2 down; the boxes' places and sizes average out.
    assert!((x - 26 * 256).abs() < 40 && (y - 22 * 256).abs() < 40, "{x} {y}");
    // The head's left is the picture's top when it leans to its right by a right angle.
    let lean = scanout_head::face::Lean::along(0.0, 1.0);
    let picture: Vec<u8> = (0..60 * 40).map(|i| 200 - (i / 60) as u8).collect();
    let grey = Grey::new(&picture, 60).unwrap();
    let [x, y] = localiser.find(&grey, EyeBox { lean, ..from }, 200);
    assert!((x - 28 * 256).abs() < 40 && (y - 16 * 256).abs() < 40, "{x} {y}");
}

#[test]
fn damaged_models_are_told() {
    let told = |result: Result<(), scanout_head::face::ModelError>| result.unwrap_err().to_string();
    let face = |bytes: &[u8]| told(Cascade::read(bytes).map(|_| ()));
    let eyes = |bytes: &[u8]| told(Localiser::read(bytes).map(|_| ()));
    assert_eq!(face(b""), "it breaks off at byte 0");
    assert_eq!(face(b"\x89PNG...."), "no cascade of faces: it begins with 1196314761 instead of 3");
    let whole = cascade();
    assert_eq!(face(&whole[..whole.len() - 1]), "it breaks off: 47 bytes instead of 48");
    assert_eq!(
        face(&[&whole[..], b"\n"].concat()),
        "something follows the model: 49 bytes instead of 48"
    );
    let mut deep = whole.clone();
    deep[8] = 31;
    assert_eq!(face(&deep), "31 levels of a tree; 1 to 12 are read");
    let mut leaf = whole;
    leaf[20..24].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(face(&leaf), "byte 20: NaN where a number up to 7 is expected");
    let whole = localiser();
    assert_eq!(eyes(&whole[..20]), "it breaks off: 20 bytes instead of 36");
    assert_eq!(eyes(&[0xff; 40]), "-1 stages (is it a localiser of pupils?); 1 to 16 are read");
    // One for the other.
    assert!(face(&whole).contains("no cascade"), "{}", face(&whole));
    assert!(eyes(&cascade()).contains("a number up to 1"), "{}", eyes(&cascade()));
}

/// Whatever the bytes: an error, or a model that works on any picture.
#[test]
fn no_bytes_panic() {
    let mut random = Random(5);
    let [face, eyes] = [cascade(), localiser()];
    let (mut read, mut refused) = (0, 0);
    for round in 0..20_000 {
        let mut damage = |bytes: &[u8]| {
            let mut bytes = bytes.to_vec();
            for _ in 0..(random.unit() * 4.0) as usize {
                let at = (random.unit() * bytes.len() as f64) as usize;
                bytes[at] = (random.unit() * 256.0) as u8;
            }
            if random.unit() < 0.1 {
                bytes.truncate((random.unit() * bytes.len() as f64) as usize);
            }
            bytes
        };
        let models = (Cascade::read(&damage(&face)), Localiser::read(&damage(&eyes)));
        let (Ok(cascade), Ok(localiser)) = models else {
            refused += 1;
            continue;
        };
        read += 1;
        if round % 8 != 0 {
            continue;
        }
        let width = 1 + (random.unit() * 70.0) as usize;
        let height = 1 + (random.unit() * 70.0) as usize;
        let picture: Vec<u8> = (0..width * height).map(|_| (random.unit() * 256.0) as u8).collect();
        let mut finder = Finder::new(cascade, localiser);
        for _ in 0..3 {
            if let Some(eyes) = finder.find(&Grey::new(&picture, width).unwrap(), [20.0, 1e9]) {
                assert!(eyes.pupils.as_flattened().iter().all(|x| x.is_finite()));
            }
        }
    }
    assert!(read > 4000 && refused > 4000, "{read} {refused}");
}

#[test]
fn pictures_of_odd_sizes() {
    let finder =
        || Finder::new(Cascade::read(&cascade()).unwrap(), Localiser::read(&localiser()).unwrap());
    for (width, height) in [(1, 1), (1, 900), (8192, 1), (961, 3), (40, 8192), (1000, 1000)] {
        let picture = vec![77; width * height];
        let grey = Grey::new(&picture, width).unwrap();
        for sides in [[1.0, 1e9], [f64::NAN, f64::INFINITY], [500.0, 20.0], [-5.0, -1.0]] {
            let _ = finder().find(&grey, sides);
        }
    }
    assert!(Grey::new(&vec![0; 8193], 8193).is_none());
}
