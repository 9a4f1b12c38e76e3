//! `video_timing.sv` clock by clock, and stereo and overlay on the pins against the library's integers.

mod common;

use common::{ARRANGEMENTS, Pixel, Screen, any_end, difference, line, pack};
use scanout::output::Rgb888;
use scanout::overlay::mix_row;
use scanout_cosim::monitor::Mode;
use scanout_cosim::{Model, Random};
use scanout_head::stereo::{Arrangement, compose};

#[test]
fn the_timing_is_the_table_of_system_c() {
    let mut model = Model::new("video_timing");
    let names = ["x", "y", "active", "hsync", "vsync", "blank_start"];
    let ports = names.map(|name| model.port(name));
    model.reset();
    let mut at = (0, 0);
    while model.get(ports[1]) != 0 {
        model.clock();
    }
    for _ in 0..2 * 800 * 525 + 5 {
        let (x, y) = at;
        let wanted = [
            x,
            y,
            u64::from(x < 640 && y < 480),
            u64::from(!(656..752).contains(&x)),
            u64::from(!(490..492).contains(&y)),
            u64::from(x == 0 && y == 480),
        ];
        assert_eq!(ports.map(|p| model.get(p)), wanted, "at {at:?}");
        model.clock();
        at = if x == 799 { (0, (y + 1) % 525) } else { (x + 1, y) };
    }
}

const INK: [u8; 3] = [250, 180, 60];
const BACK: [u8; 3] = [10, 20, 30];
const WIDTH: usize = 640;

/// A picture for each eye, in lines.
fn eyes(random: &mut Random, (width, height): (usize, usize)) -> Vec<Pixel> {
    let size = (width as i32, height as i32);
    let mut pixels = Vec::new();
    for i in 0..80 {
        let (a, b) = (any_end(random, size), any_end(random, size));
        let right = i % 2 == 1;
        pixels.extend(line(a, b, size, 0).into_iter().map(|p| Pixel { right, ..p }));
    }
    pixels
}

/// An eye's picture over what lies under it, by the library's overlay: `width` columns.
fn eye(pixels: &[Pixel], right: bool, width: usize, under: &[[u8; 3]]) -> Vec<[u8; 3]> {
    let bytes = width.div_ceil(8);
    let mut plane = vec![0u8; bytes * (under.len() / width)];
    for p in pixels.iter().filter(|p| p.right == right) {
        plane[p.y as usize * bytes + p.x as usize / 8] |= 0x80 >> (p.x % 8);
    }
    let mut picture = under.to_vec();
    for (row, bits) in picture.chunks_mut(width).zip(plane.chunks(bytes)) {
        mix_row::<Rgb888>(bits, row, width, INK);
    }
    picture
}

/// What a screen shows of two eyes' lines beside what the library composes of them; with a camera only where both eyes' pictures cover
/// the screen.
fn shown_and_composed(name: &str, codes: &[(u32, Option<Arrangement>)]) {
    let mut random = Random::new(21);
    let camera: Vec<[u8; 3]> =
        (0..WIDTH * 480).map(|_| [0; 3].map(|_: u8| random.below(256) as u8)).collect();
    for &(code, how) in codes {
        let sizes = how.map_or([(WIDTH, 480); 2], |how| how.eye_sizes(WIDTH, 480));
        let whole = sizes == [(WIDTH, 480); 2] && code != 3;
        for with_camera in if whole { &[false, true][..] } else { &[false] } {
            let mut screen = Screen::new(name, Mode::VGA, 22);
            screen.set("ink", pack(INK));
            screen.set("background", pack(BACK));
            screen.set("arrangement", code);
            let pixels = eyes(&mut random, sizes[0]);
            if *with_camera {
                screen.attach_camera(camera.clone());
            }
            let [left, right] = [false, true].map(|right| {
                let (width, height) = sizes[usize::from(right)];
                let under = if *with_camera { camera.clone() } else { vec![BACK; width * height] };
                eye(&pixels, right, width, &under)
            });
            let mut wanted = left.clone();
            if let Some(how) = how {
                wanted.resize(WIDTH * 480, [0; 3]);
                compose(how, &left, &right, &mut wanted, WIDTH);
            }
            screen.draw([pixels]);
            let seen = screen.frames(2);
            let last = &seen[1];
            assert_eq!(last.faults, [""; 0]);
            let wrong = difference(&last.pixels, &wanted, WIDTH);
            assert_eq!(wrong, None, "{name}: {how:?}, camera {with_camera}");
            assert_eq!(last.measured, Mode::VGA);
        }
    }
}

#[test]
fn stereo_and_overlay_are_the_librarys_integers() {
    if common::netlists_only() {
        return;
    }
    let four: Vec<_> = ARRANGEMENTS.into_iter().filter(|&(code, _)| code < 4).collect();
    shown_and_composed("screen_eyes", &four);
}

#[test]
fn all_nine_arrangements_are_the_librarys_integers() {
    if common::netlists_only() {
        return;
    }
    shown_and_composed("screen_stereo", &ARRANGEMENTS);
}

#[test]
fn a_camera_that_comes_too_late_costs_the_rest_of_a_frame_and_nothing_slips() {
    if common::netlists_only() {
        return;
    }
    let mut random = Random::new(23);
    let camera: Vec<[u8; 3]> = (0..WIDTH * 480)
        .map(|i| [1 + (i % 255) as u8, (i / WIDTH) as u8, random.below(256) as u8])
        .collect();
    let mut screen = Screen::new("screen_eyes", Mode::VGA, 24);
    screen.set("background", pack(BACK));
    screen.attach_camera(camera.clone());
    // Whole frames, then a few clocks without a pixel in the middle of one, then whole ones again.
    assert_eq!(difference(&screen.frames(2)[1].pixels, &camera, WIDTH), None);
    let late = screen.model.port("camera_late");
    for _ in 0..525 * 800 / 2 {
        screen.clock();
    }
    screen.camera().stalls = 100;
    let mut times = 0;
    for _ in 0..200 {
        screen.clock();
        times += screen.model.get(late);
    }
    screen.camera().stalls = 0;
    assert_eq!(times, 1);
    let seen = screen.frames(3);
    let broken = &seen[0].pixels;
    let from = (0..broken.len()).find(|&i| broken[i] != camera[i]).expect("a part is missing");
    assert!(broken[from..].iter().all(|&p| p == BACK), "after a missing pixel nothing is shown");
    assert!(from > WIDTH * 100 && from < WIDTH * 400, "at {from}");
    // The interrupted frame is thrown away as it comes; then they are whole again.
    assert_eq!(difference(&seen[2].pixels, &camera, WIDTH), None);
}
