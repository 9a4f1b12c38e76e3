//! Films written and read back, and broken ones.

use std::path::{Path, PathBuf};

use scanout_video::{Frame, Sink, SinkFormat, Source, VideoError};

fn frame(number: usize) -> Frame {
    let colour = |x: usize, y: usize| [(x * 3) as u8, (y * 3) as u8, (number * 40) as u8];
    let rgb = (0..48 * 64).map(|i| colour(i % 64, i / 64)).collect();
    Frame { width: 64, height: 48, rgb, time: 0.0 }
}

fn place(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("scanout-video-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder.join(name)
}

fn film(name: &str) -> PathBuf {
    let path = place(name);
    let mut sink = Sink::create(&path, SinkFormat::for_path(&path).unwrap(), 25.0).unwrap();
    (0..3).for_each(|number| sink.write(&frame(number)).unwrap());
    assert_eq!(sink.count(), 3);
    sink.finish().unwrap();
    path
}

fn read(path: &Path) -> Vec<Result<Frame, VideoError>> {
    let mut source = Source::open(path, 25.0).unwrap();
    let mut all = Vec::new();
    while let Some(next) = source.next() {
        all.push(next);
        assert!(all.len() < 100, "a source must end");
    }
    all
}

#[test]
fn what_was_written_is_read() {
    for (name, most) in [("a.y4m", 4), ("a.mjpeg", 40), ("folder", 0)] {
        let frames = read(&film(name));
        assert_eq!(frames.len(), 3, "{name}");
        for (number, got) in frames.into_iter().enumerate() {
            let (got, want) = (got.unwrap(), frame(number));
            assert_eq!((got.width, got.height, got.time), (64, 48, number as f64 / 25.0));
            let pairs = got.rgb.as_flattened().iter().zip(want.rgb.as_flattened());
            let worst = pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap();
            assert!(worst <= most, "{name}: {worst}");
        }
    }
    let last = place("one.png");
    let mut sink = Sink::create(&last, SinkFormat::Png, 25.0).unwrap();
    sink.write(&frame(2)).unwrap();
    sink.finish().unwrap();
    assert_eq!(read(&last)[0].as_ref().unwrap().rgb, frame(2).rgb);
}

#[test]
fn a_damaged_frame_is_left_out_and_the_film_goes_on() {
    let path = film("damaged.mjpeg");
    let mut bytes = std::fs::read(&path).unwrap();
    // The second picture's header.
    let second = bytes.windows(3).enumerate().filter(|(_, w)| *w == [0xff, 0xd8, 0xff]).nth(1);
    let at = second.unwrap().0;
    bytes[at + 30..at + 200].fill(0x11);
    std::fs::write(&path, &bytes).unwrap();
    let frames = read(&path);
    assert!(frames.iter().any(|frame| frame.as_ref().is_err_and(|error| !error.ends())));
    assert_eq!(frames.iter().filter(|frame| frame.is_ok()).count(), 2);

    let folder = film("holes");
    std::fs::write(folder.join("00001.png"), b"\x89PNG and no more").unwrap();
    std::fs::write(folder.join("notes.txt"), b"no picture").unwrap();
    let frames = read(&folder);
    let text = frames[1].as_ref().unwrap_err().to_string();
    assert!(text.ends_with("frame 1: 00001.png: PNG: it is damaged; it is left out"), "{text}");
    assert!(frames[2].is_ok());
}

#[test]
fn a_film_that_breaks_off_keeps_what_came_before() {
    let path = film("short.y4m");
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() - 9]).unwrap();
    let frames = read(&path);
    assert_eq!(frames.iter().filter(|frame| frame.is_ok()).count(), 2);
    assert!(frames.len() <= 3);
}

#[test]
fn what_cannot_be_opened_says_what_to_do() {
    let open = |path: &PathBuf| Source::open(path, 25.0).err().unwrap().to_string();
    assert!(open(&place("none.y4m")).ends_with("no such file or directory; check the path"));
    let text = place("text.txt");
    std::fs::write(&text, "hello").unwrap();
    assert!(open(&text).contains("neither y4m nor MJPEG nor a picture; pipe it through"));
    std::fs::write(&text, "").unwrap();
    assert!(open(&text).contains("it is empty"));
    std::fs::write(&text, "YUV4MPEG2 W0\n").unwrap();
    assert!(open(&text).contains("header"));
    let folder = place("empty-folder");
    std::fs::create_dir_all(&folder).unwrap();
    assert!(open(&folder).contains("no picture in this folder"));
}

#[test]
fn frames_of_another_size_are_refused_where_the_format_has_one() {
    let path = place("sizes.y4m");
    let mut sink = Sink::create(&path, SinkFormat::Y4m, 25.0).unwrap();
    sink.write(&frame(0)).unwrap();
    let small = Frame { width: 1, height: 1, rgb: vec![[0; 3]], time: 0.0 };
    assert!(!sink.write(&small).unwrap_err().ends());
    sink.write(&frame(1)).unwrap();
    sink.finish().unwrap();
    assert_eq!(read(&path).len(), 2);
}
