//! `screen.sv`: pictures of lines go in, the monitor reads the pins, and every frame is a whole picture.

mod common;

use common::{Pixel, Screen, any_end, difference, doubled, line, pack, pins};
use scanout::output::{Mono, PixelFormat, Rgb332, Rgb565, Rgb888};
use scanout_cosim::Random;
use scanout_cosim::monitor::{Mode, Seen};

const INK: [u8; 3] = [255, 200, 64];
const BACK: [u8; 3] = [32, 0, 128];
const SIZE: (i32, i32) = (640, 480);

/// Pictures of random lines with a frame of light around them, so that porches can be measured.
fn pictures(count: usize, lines: usize, size: (i32, i32), seed: u64) -> Vec<Vec<Pixel>> {
    let mut random = Random::new(seed);
    let mut picture = || {
        let corner =
            |x, y| scanout::raster::line::LineEnd { x, y, ..any_end(&mut Random::new(1), size) };
        let (right, bottom) = (size.0 - 1, size.1 - 1);
        let corners = [corner(0, 0), corner(right, 0), corner(right, bottom), corner(0, bottom)];
        let mut pixels: Vec<Pixel> =
            (0..4).flat_map(|i| line(corners[i], corners[(i + 1) % 4], size, 0)).collect();
        for _ in 0..lines {
            let (a, b) = (any_end(&mut random, size), any_end(&mut random, size));
            pixels.extend(line(a, b, size, 0));
        }
        pixels
    };
    (0..count).map(|_| picture()).collect()
}

/// A picture as it is seen through pins, each pixel's colour by `colour`.
fn painted(
    pixels: &[Pixel],
    size: (i32, i32),
    bits: [u32; 3],
    back: [u8; 3],
    colour: impl Fn(&Pixel) -> [u8; 3],
) -> Vec<[u8; 3]> {
    let mut picture = vec![pins(back, bits); (size.0 * size.1) as usize];
    for p in pixels {
        picture[(p.y * size.0 + p.x) as usize] = pins(colour(p), bits);
    }
    picture
}

/// Every frame is one of `wanted`, in their order; how many of them were seen, and how often the same twice.
fn in_order(seen: &[Seen], wanted: &[Vec<[u8; 3]>], width: usize) -> (usize, usize) {
    let (mut at, mut repeated) = (None, 0);
    let mut distinct = 0;
    for (i, frame) in seen.iter().enumerate() {
        assert_eq!(frame.faults, [""; 0], "frame {i}");
        if at.is_some_and(|at: usize| frame.pixels == wanted[at]) {
            repeated += 1;
            continue;
        }
        let from = at.map_or(0, |at| at + 1);
        let Some(found) = (from..wanted.len()).find(|&k| frame.pixels == wanted[k]) else {
            let next = wanted.get(from).map(|w| difference(&frame.pixels, w, width));
            panic!("frame {i} is none of the pictures from {from} on: {next:?}");
        };
        assert!(at.is_none() || found == from, "picture {from} was never shown");
        (at, distinct) = (Some(found), distinct + 1);
    }
    (distinct, repeated)
}

#[test]
fn a_one_bit_plane_shows_whole_pictures_sixty_times_a_second() {
    if common::netlists_only() {
        return;
    }
    let mut screen = Screen::new("screen_plane", Mode::VGA, 1);
    screen.set("ink", pack(INK));
    screen.set("background", pack(BACK));
    let pictures = pictures(5, 60, SIZE, 2);
    let bits = [3, 3, 2];
    let wanted: Vec<_> = pictures.iter().map(|p| painted(p, SIZE, bits, BACK, |_| INK)).collect();
    let mut seen = screen.frames(1);
    screen.draw(pictures);
    seen.extend(screen.frames(6));
    // With the background lit, the light is the picture's box.
    assert!(seen.iter().all(|s| s.measured == Mode::VGA), "{:?}", seen[0].measured);
    let first =
        seen.iter().position(|s| s.pixels == wanted[0]).expect("the first picture is shown");
    assert_eq!(in_order(&seen[first..first + 5], &wanted, 640), (5, 0), "a new picture each frame");
    // Before the first picture there was nothing, not the memory's random content.
    let nothing = vec![pins(BACK, bits); 640 * 480];
    assert!(seen[..first].iter().all(|s| s.pixels == nothing));
}

#[test]
fn slow_drawing_repeats_a_picture_and_never_shows_half_of_one() {
    if common::netlists_only() {
        return;
    }
    // The drawing side's own clock is 3.75 times, then 0.75 times the pixel clock; it waits more often than it draws.
    for (quarters, stalls) in [(15, 97), (3, 85)] {
        let mut screen = Screen::new("screen_plane", Mode::VGA, 3);
        (screen.draw_quarters, screen.stalls) = (Some(quarters), stalls);
        screen.set("ink", pack(INK));
        let lines = if quarters > 4 { 300 } else { 400 };
        let pictures = pictures(3, lines, SIZE, 4);
        let wanted: Vec<_> =
            pictures.iter().map(|p| painted(p, SIZE, [3, 3, 2], [0; 3], |_| INK)).collect();
        let mut seen = screen.frames(1);
        screen.draw(pictures);
        while screen.waiting() > 0 {
            seen.extend(screen.frames(1));
        }
        seen.extend(screen.frames(2));
        let dark = vec![[0; 3]; 640 * 480];
        let first = seen.iter().position(|s| s.pixels != dark).expect("something is shown");
        let (distinct, repeated) = in_order(&seen[first..], &wanted, 640);
        assert_eq!(distinct, 3);
        assert!(repeated >= 2, "drawing was meant to be slow");
        assert!(seen[first].measured == Mode::VGA);
    }
}

#[test]
fn another_mode_and_single_port_memory() {
    if common::netlists_only() {
        return;
    }
    for (name, mode, size, scale, bits) in [
        ("screen_plane_800", Mode::SVGA, (800, 600), 1, [8, 8, 8]),
        ("screen_spram", Mode::VGA, (320, 240), 2, [4, 4, 4]),
    ] {
        let mut screen = Screen::new(name, mode, 5);
        screen.set("ink", pack(INK));
        screen.set("background", pack(BACK));
        let pictures = pictures(3, 50, size, 6);
        let wanted: Vec<_> = pictures
            .iter()
            .map(|p| painted(p, size, bits, BACK, |_| INK))
            .map(|p| if scale == 2 { doubled(&p, size.0 as usize) } else { p })
            .collect();
        let mut seen = screen.frames(1);
        screen.draw(pictures);
        seen.extend(screen.frames(4));
        let first = seen.iter().position(|s| s.pixels == wanted[0]).expect(name);
        assert!(first <= 2, "{name}: the first picture was frame {first}");
        assert_eq!(in_order(&seen[first..], &wanted, mode.horizontal.active).0, 3, "{name}");
        assert_eq!(seen[0].measured, mode, "{name}");
    }
}

#[test]
fn a_colour_framebuffer_holds_any_format() {
    if common::netlists_only() {
        return;
    }
    /// A pixel as the framebuffer gives it back.
    fn stored<F: PixelFormat, const DITHER: bool>(p: &Pixel) -> [u8; 3] {
        let mut row = [F::Word::default()];
        let dithered = F::encode_dithered(p.rgb, p.x, p.y);
        F::store(&mut row, 0, if DITHER { dithered } else { F::encode(p.rgb) });
        F::load(&row, 0)
    }
    type Stored = fn(&Pixel) -> [u8; 3];
    let configurations: [(&str, usize, Stored, [u32; 3]); 6] = [
        ("screen_rgb332", 2, stored::<Rgb332, true>, [3, 3, 2]),
        ("screen_rgb565", 2, stored::<Rgb565, false>, [8; 3]),
        ("screen_rgb888", 1, stored::<Rgb888, false>, [8; 3]),
        ("screen_rgb888_2x", 2, stored::<Rgb888, false>, [8; 3]),
        ("screen_mono", 1, stored::<Mono, true>, [8; 3]),
        ("screen_mono_2x", 2, stored::<Mono, false>, [8; 3]),
    ];
    for (name, scale, stored, bits) in configurations {
        let size = (SIZE.0 / scale as i32, SIZE.1 / scale as i32);
        let mut screen = Screen::new(name, Mode::VGA, 7);
        (screen.draw_quarters, screen.stalls) = (Some(9), 30);
        screen.set("background", pack(BACK));
        let pictures = pictures(3, 50, size, 8);
        let wanted: Vec<_> = pictures
            .iter()
            .map(|p| painted(p, size, bits, BACK, stored))
            .map(|p| if scale == 2 { doubled(&p, 320) } else { p })
            .collect();
        let mut seen = screen.frames(1);
        screen.draw(pictures);
        seen.extend(screen.frames(5));
        let first = seen.iter().position(|s| s.pixels == wanted[0]).expect(name);
        assert_eq!(in_order(&seen[first..], &wanted, 640).0, 3, "{name}");
    }
}

#[test]
fn line_memories_are_the_painters_picture_without_a_framebuffer() {
    if common::netlists_only() {
        return;
    }
    let palette = [[255, 0, 0], [0, 255, 0], [64, 64, 255], [255, 255, 255]];
    let mut screen = Screen::new("screen_lines", Mode::VGA, 9);
    let port = screen.model.port("palette");
    for (i, &rgb) in palette.iter().enumerate() {
        screen.model.set_bits(port, 24 * i as u32, 24, pack(rgb).into());
    }
    screen.set("background", pack(BACK));
    let mut random = Random::new(10);
    let mut scenes: Vec<Vec<Pixel>> = Vec::new();
    // Twelve lines anywhere, in three groups, always have room.
    for _ in 0..3 {
        let mut any = || any_end(&mut random, SIZE);
        scenes.push((0..12).flat_map(|i| line(any(), any(), SIZE, i / 4)).collect());
    }
    // 200 short lines share twelve memories; those that would find no room are left out by the same rule.
    let mut many = Vec::new();
    let (mut flat, mut steep) = (vec![0; 640], vec![0; 480]);
    while many.len() < 4000 {
        let a = any_end(&mut random, SIZE);
        let x = (a.x + random.range(-40, 40) as i32).clamp(0, 639);
        let y = (a.y + random.range(-40, 40) as i32).clamp(0, 479);
        let b = scanout::raster::line::LineEnd { x, y, ..a };
        let pixels = line(a, b, SIZE, 3);
        let room =
            |p: &Pixel| if p.steep { steep[p.y as usize] < 6 } else { flat[p.x as usize] < 6 };
        if pixels.iter().all(room) {
            for p in &pixels {
                *(if p.steep { &mut steep[p.y as usize] } else { &mut flat[p.x as usize] }) += 1;
            }
            many.extend(pixels);
        }
    }
    scenes.push(many);
    let bits = [3, 3, 2];
    let wanted: Vec<_> = scenes
        .iter()
        .map(|s| painted(s, SIZE, bits, BACK, |p| palette[p.group as usize]))
        .collect();
    let mut seen = screen.frames(1);
    screen.draw(scenes);
    seen.extend(screen.frames(1));
    // One picture a frame: what is drawn in a blank is shown at once.
    let dropped = screen.model.port("dropped");
    for _ in 0..4 {
        assert_eq!(screen.model.get(dropped), 0);
        seen.extend(screen.frames(1));
    }
    let first = seen.iter().position(|s| s.pixels == wanted[0]).expect("the first picture");
    assert_eq!(in_order(&seen[first..first + 4], &wanted, 640), (4, 0));
    // Without a new picture the last one stays.
    assert!(screen.frames(2).iter().all(|s| s.pixels == wanted[3]));
}

#[test]
fn lines_without_room_are_counted() {
    if common::netlists_only() {
        return;
    }
    let mut screen = Screen::new("screen_lines", Mode::VGA, 11);
    let end = |x, y| scanout::raster::line::LineEnd { x, y, ..Default::default() };
    // 13 flat lines across the same columns: the last one finds no memory.
    let scene: Vec<Pixel> =
        (0..13).flat_map(|i| line(end(100, 10 * i), end(299, 10 * i), SIZE, 0)).collect();
    screen.draw([scene]);
    let dropped = screen.model.port("dropped");
    while screen.waiting() > 0 {
        screen.clock();
    }
    (0..4).for_each(|_| drop(screen.clock()));
    assert_eq!(screen.model.get(dropped), 200);
}
