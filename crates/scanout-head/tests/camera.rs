//! The camera source on pictures whose truth is known: a marker at given places, ray by ray, with noise.

mod support;

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::{Duration, Instant};

use scanout_ar::Dictionary;
use scanout_head::V3;
use scanout_head::camera::{Camera, Find, Marker, MarkerFinder, Mount, Sight};
use scanout_head::source::Source;
use scanout_video::Frame;
use support::Random;

const SIZE: [usize; 2] = [480, 360];
const FOV: f64 = 60.0;
const MOUNT: Mount = Mount { place: [0.0, 160.0, 5.0], tilt: -8.0 };

fn marker() -> Marker {
    Marker { dictionary: Dictionary::ARUCO_4X4_50, id: 7, size: 50.0 }
}

/// The picture that the camera takes of a marker whose middle is at `place`, turned by `yaw` degrees about the upright axis; grey levels
/// 40 and 220 on 130, 3 x 3 rays a pixel, noise of two levels.
fn picture(place: V3, yaw: f64, random: &mut Random) -> Frame {
    let [w, h] = SIZE;
    let focal = w as f64 / 2.0 / (FOV / 2.0).to_radians().tan();
    let (sin, cos) = yaw.to_radians().sin_cos();
    // The marker's right (as its reader sees it) and up; it faces the screen.
    let (right, up, normal) = ([-cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, -cos]);
    let m = marker();
    let code = m.dictionary.code(m.id.into()).unwrap();
    let cells = usize::from(m.dictionary.side) + 2;
    let origin = MOUNT.to_viewer([0.0; 3]);
    // Where the marker is in the picture, so that rays are followed only there.
    let (tilt, from) = (MOUNT.tilt.to_radians(), [0, 1, 2].map(|i| place[i] - origin[i]));
    let depth = from[1] * tilt.sin() + from[2] * tilt.cos();
    let down = -from[1] * tilt.cos() + from[2] * tilt.sin();
    let middle = [w as f64 / 2.0 - from[0] / depth * focal, h as f64 / 2.0 + down / depth * focal];
    let reach = m.size * focal / depth * 1.2;
    let dot = |a: V3, b: V3| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let level = |x: f64, y: f64| -> f64 {
        let through =
            MOUNT.to_viewer([(x - w as f64 / 2.0) / focal, (y - h as f64 / 2.0) / focal, 1.0]);
        let ray: V3 = std::array::from_fn(|i| through[i] - origin[i]);
        let from: V3 = std::array::from_fn(|i| place[i] - origin[i]);
        let t = dot(from, normal) / dot(ray, normal);
        let at: V3 = std::array::from_fn(|i| origin[i] + ray[i] * t - place[i]);
        let (u, v) = (dot(at, right) / m.size + 0.5, 0.5 - dot(at, up) / m.size);
        let margin = 1.0 / cells as f64;
        match (u, v) {
            _ if (0.0..1.0).contains(&u) && (0.0..1.0).contains(&v) => {
                let cell = |s: f64| (s * cells as f64) as usize;
                if m.dictionary.is_white(code, cell(u), cell(v)) { 220.0 } else { 40.0 }
            }
            _ if u > -margin && u < 1.0 + margin && v > -margin && v < 1.0 + margin => 220.0,
            _ => 130.0,
        }
    };
    let mut rgb = Vec::with_capacity(w * h);
    for y in 0..h {
        for x in 0..w {
            let ray = |k: usize| {
                let (dx, dy) = ((k % 3) as f64 / 3.0 + 1.0 / 6.0, (k / 3) as f64 / 3.0 + 1.0 / 6.0);
                level(x as f64 + dx, y as f64 + dy)
            };
            let near = (x as f64 - middle[0]).abs().max((y as f64 - middle[1]).abs()) < reach;
            let mean = if near { (0..9).map(ray).sum::<f64>() / 9.0 } else { 130.0 };
            let mean = mean + 2.0 * random.normal();
            rgb.push([mean.round().clamp(0.0, 255.0) as u8; 3]);
        }
    }
    Frame { width: w, height: h, rgb, time: 0.0 }
}

#[test]
fn a_worn_marker_is_found_where_it_is() {
    let mut random = Random(11);
    let mut finder = MarkerFinder::new(marker(), Sight::FieldOfView(FOV), MOUNT);
    let (mut aside, mut deep, mut count) = (0.0f64, 0.0f64, 0);
    for index in 0..8 {
        let place = [
            random.between(-150.0, 150.0),
            random.between(-60.0, 120.0),
            random.between(450.0, 750.0),
        ];
        let yaw = random.between(-30.0, 30.0);
        let mut frame = picture(place, yaw, &mut random);
        frame.time = f64::from(index);
        let found = finder.find(&frame).unwrap_or_else(|| panic!("not found at {place:?}, {yaw}"));
        let off: V3 = std::array::from_fn(|i| found[i] - place[i]);
        aside += off[0] * off[0] + off[1] * off[1];
        deep += off[2] * off[2];
        count += 1;
    }
    let [aside, deep] = [aside, deep].map(|sum| (sum / f64::from(count)).sqrt());
    println!("{count} pictures: {aside:.2} mm aside, {deep:.2} mm in depth (rms)");
    assert!(aside < 0.8 && deep < 4.0, "{aside} {deep}");
}

#[test]
fn a_marker_that_rests_hardly_trembles() {
    let mut random = Random(12);
    let mut finder = MarkerFinder::new(marker(), Sight::FieldOfView(FOV), MOUNT);
    let place = [40.0, 30.0, 600.0];
    let mut found = Vec::new();
    for index in 0..10 {
        let mut frame = picture(place, 10.0, &mut random);
        frame.time = f64::from(index) / 30.0;
        found.push(finder.find(&frame).expect("it is there"));
    }
    let tremble = [0, 1, 2].map(|i| {
        let mean = found.iter().map(|p| p[i]).sum::<f64>() / found.len() as f64;
        (found.iter().map(|p| (p[i] - mean).powi(2)).sum::<f64>() / found.len() as f64).sqrt()
    });
    println!("tremble of a resting marker at 0.6 m: {tremble:.3?} mm along x, y, z");
    assert!(tremble[0] < 0.1 && tremble[1] < 0.1 && tremble[2] < 0.6, "{tremble:?}");
}

#[test]
fn nobody_is_found_where_nobody_is() {
    let mut random = Random(13);
    let mut finder = MarkerFinder::new(marker(), Sight::FieldOfView(FOV), MOUNT);
    // Behind the camera's field of view, and a picture of nothing.
    assert_eq!(finder.find(&picture([3000.0, 0.0, 600.0], 0.0, &mut random)), None);
    assert_eq!(finder.find(&Frame::default()), None);
    // Another marker than the one that is worn.
    let other = Marker { id: 8, ..marker() };
    let mut finder = MarkerFinder::new(other, Sight::FieldOfView(FOV), MOUNT);
    assert_eq!(finder.find(&picture([0.0, 0.0, 600.0], 0.0, &mut random)), None);
}

/// Tells a frame's grey level, slowly.
struct Slow(Arc<AtomicUsize>);

impl Find for Slow {
    fn find(&mut self, frame: &Frame) -> Option<V3> {
        self.0.fetch_add(1, Relaxed);
        std::thread::sleep(Duration::from_millis(30));
        (frame.rgb[0][0] != 13).then(|| [frame.rgb[0][0].into(), 0.0, 600.0])
    }
}

/// Frames that come faster than they are looked at: some are left out, never the last, and nobody waits.
#[test]
fn the_newest_frame_is_looked_at() {
    let film = std::env::temp_dir().join(format!("scanout-head-{}.ppm", std::process::id()));
    let mut bytes = Vec::new();
    for level in 0..200 {
        bytes.extend(b"P5 1 1 255\n");
        bytes.push(level);
    }
    std::fs::write(&film, bytes).unwrap();
    let looks = Arc::new(AtomicUsize::new(0));
    let epoch = Instant::now();
    let mut camera = Camera::start(&film, 30.0, Box::new(Slow(looks.clone())), epoch).unwrap();
    let (mut seen, mut asked) = (Vec::new(), 0);
    while seen.last() != Some(&199.0) {
        asked += 1;
        if let Some(sample) = camera.poll(epoch.elapsed().as_secs_f64()) {
            seen.push(sample.eye.expect("nobody is only at 13")[0]);
            assert!(sample.time <= epoch.elapsed().as_secs_f64());
        }
        assert!(epoch.elapsed() < Duration::from_secs(20), "the last frame is looked at: {seen:?}");
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(seen.is_sorted() && looks.load(Relaxed) < 50, "{seen:?}");
    assert!(asked > 2 * seen.len(), "asking never waits for a look: {asked} times, {seen:?}");
    assert_eq!(camera.poll(1e3), None);
    std::fs::remove_file(film).unwrap();
    assert!(Camera::start("no such film".as_ref(), 30.0, Box::new(Slow(looks)), epoch).is_err());
}
