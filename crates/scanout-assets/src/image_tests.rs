use super::*;

fn encode(kind: png::ColorType, depth: png::BitDepth, size: (u32, u32), data: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size.0, size.1);
    encoder.set_color(kind);
    encoder.set_depth(depth);
    if kind == png::ColorType::Indexed {
        encoder.set_palette(vec![10, 20, 30, 40, 50, 60]);
    }
    encoder.write_header().unwrap().write_image_data(data).unwrap();
    bytes
}

fn decode(bytes: &[u8]) -> (Vec<[u8; 3]>, usize) {
    let (image, warnings) = Image::decode(bytes, "t.png").unwrap();
    (image.rgb, warnings.len())
}

#[test]
fn png_of_every_depth_becomes_rgb() {
    use png::{BitDepth as D, ColorType as C};
    assert_eq!(
        decode(&encode(C::Rgb, D::Eight, (2, 1), &[1, 2, 3, 4, 5, 6])),
        (vec![[1, 2, 3], [4, 5, 6]], 0)
    );
    assert_eq!(decode(&encode(C::Grayscale, D::One, (2, 1), &[0x40])), (vec![[0; 3], [255; 3]], 0));
    assert_eq!(
        decode(&encode(C::Grayscale, D::Sixteen, (1, 1), &[0x12, 0x34])),
        (vec![[0x12; 3]], 0)
    );
    assert_eq!(
        decode(&encode(C::Indexed, D::Four, (2, 1), &[0x10])),
        (vec![[40, 50, 60], [10, 20, 30]], 0)
    );
    assert_eq!(decode(&encode(C::Rgba, D::Eight, (1, 1), &[7, 8, 9, 255])), (vec![[7, 8, 9]], 0));
    assert_eq!(decode(&encode(C::Rgba, D::Eight, (1, 1), &[7, 8, 9, 254])), (vec![[7, 8, 9]], 1));
    assert_eq!(decode(&encode(C::GrayscaleAlpha, D::Eight, (1, 1), &[7, 0])), (vec![[7; 3]], 1));
}

#[test]
fn large_pictures_are_scaled_down_with_a_warning() {
    let mut file = b"P5 2048 512 255\n".to_vec();
    file.extend((0..2048 * 512).map(|i| if i % 2 == 0 { 10 } else { 20 }));
    let (image, warnings) = Image::decode(&file, "t.pgm").unwrap();
    assert_eq!((image.width, image.height), (1024, 256));
    assert!(image.rgb.iter().all(|t| *t == [15; 3]));
    assert_eq!(warnings[0].to_string(), "t.pgm: 2048x512 scaled down to 1024x256");
    let thin = [b"P5 1 3000 255\n".as_slice(), &[9; 3000]].concat();
    let (image, _) = Image::decode(&thin, "t.pgm").unwrap();
    assert_eq!((image.width, image.height), (1, 1024));
}

#[test]
fn mip_levels_follow_one_another() {
    let rgb = (0..6).map(|i| [i * 10, 0, 255]).collect();
    let image = Image { name: String::new(), width: 3, height: 2, levels: 1, rgb }.with_mips();
    assert_eq!((image.levels, image.rgb.len()), (2, 7));
    assert_eq!(image.rgb[6], [25, 0, 255]);
    assert_eq!(image.clone().with_mips(), image, "again changes nothing");
    let sizes = |width, height| {
        let rgb = vec![[0; 3]; usize::from(width) * usize::from(height)];
        let image = Image { name: String::new(), width, height, levels: 1, rgb }.with_mips();
        (image.levels, image.rgb.len())
    };
    assert_eq!(sizes(1024, 1), (11, 2047));
    assert_eq!(sizes(8, 4), (4, 32 + 8 + 2 + 1));
    let texture = image.as_texture();
    assert_eq!((texture.width, texture.height, texture.levels), (3, 2, 2));
}

#[test]
fn rgb565_rounds_to_nearest() {
    let rgb = vec![[255; 3], [0; 3], [255, 0, 0], [4, 2, 5]];
    let image = Image { name: String::new(), width: 4, height: 1, levels: 1, rgb };
    assert_eq!(image.to_rgb565(), [0xffff, 0, 0xf800, 0x0001]);
}

/// A grey 8 x 8 baseline JPEG, made here by hand: one block whose only coefficient is the mean.
fn grey_jpeg() -> Vec<u8> {
    let mut bytes = vec![0xff, 0xd8, 0xff, 0xdb, 0, 67, 0];
    bytes.extend([1; 64]);
    bytes.extend([0xff, 0xc0, 0, 11, 8, 0, 8, 0, 8, 1, 1, 0x11, 0]);
    // Huffman tables of one code (length 1) each: DC category 6, AC end of block.
    for (class, value) in [(0x00, 6), (0x10, 0)] {
        bytes.extend([0xff, 0xc4, 0, 20, class, 1]);
        bytes.extend([0; 15]);
        bytes.push(value);
    }
    bytes.extend([0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0]);
    // 0 (category 6), 100000 (+32: 32 / 8 = 4 above 128), 0 (end of block).
    bytes.extend([0b0100_0000, 0xff, 0xd9]);
    bytes
}

#[test]
fn jpeg_is_read() {
    let (image, warnings) = Image::decode(&grey_jpeg(), "t.jpg").unwrap();
    assert_eq!((image.width, image.height, warnings.len()), (8, 8, 0));
    assert!(image.rgb.iter().all(|t| *t == [132; 3]), "{:?}", image.rgb[0]);
}

#[test]
fn broken_pictures_are_one_line() {
    let png = encode(png::ColorType::Rgb, png::BitDepth::Eight, (2, 2), &[9; 12]);
    let mut huge = png.clone();
    huge[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
    let jpeg = grey_jpeg();
    let cases: [&[u8]; 9] = [
        b"",
        b"GIF89a",
        b"P6 2 2 255\nabc",
        b"P6 65535 65535 255\nabc",
        &png[..20],
        &png[..50],
        &huge,
        &jpeg[..4],
        &jpeg[..60],
    ];
    for bytes in cases {
        let text = Image::decode(bytes, "t").unwrap_err().to_string();
        assert!(text.starts_with("t: ") && text.contains("; ") && !text.contains('\n'), "{text}");
    }
    // In our words, not the libraries'.
    let mut checksum = png.clone();
    checksum[29] ^= 1;
    let mut signature = png.clone();
    signature[5] = b'x';
    for (bytes, text) in [
        (checksum.as_slice(), "t: PNG: a checksum differs; copy the file again"),
        (&signature, "t: PNG: it is damaged; export it again"),
        (&png[..50], "t: PNG: it ends early; copy the file again"),
        (&jpeg[..4], "t: JPEG: it ends early; copy the file again"),
    ] {
        assert_eq!(Image::decode(bytes, "t").unwrap_err().to_string(), text);
    }
    for end in 0..png.len() {
        let _ = Image::decode(&png[..end], "t");
    }
    for end in 0..jpeg.len() {
        let _ = Image::decode(&jpeg[..end], "t");
    }
}

#[test]
fn a_missing_file_says_so() {
    let error = load_image("/nonexistent/x.png", &Limits::default()).unwrap_err();
    assert_eq!(error.to_string(), "/nonexistent/x.png: no such file; check the path");
}
