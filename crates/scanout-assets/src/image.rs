//! Textures: PPM, PGM, PNG and JPEG to 8 bits a channel, at most 1024 x 1024; mip levels; RGB565.

use crate::error::{At, LoadError, Warning, WarningLevel};
use crate::load::{Limits, read_file};
use crate::model::Image;
use crate::ppm;
use scanout::texture::{Filter, Texels, Texture, Wrap};
use std::path::Path;

/// Greatest side of a texture; larger pictures are scaled down.
pub const SIDE: usize = 1024;
/// Greatest number of texels that a picture may have before it is scaled down.
const TEXELS: usize = 1 << 26;

/// A picture of any size, before it becomes an [`Image`].
struct Picture {
    width: usize,
    height: usize,
    rgb: Vec<[u8; 3]>,
}

/// Loads a texture: PPM, PGM, PNG or JPEG, by content. Alpha is dropped and pictures larger than 1024 are scaled down, with
/// a warning each.
///
/// # Errors
/// [`LoadError`], one line.
pub fn load_image(
    path: impl AsRef<Path>,
    limits: &Limits,
) -> Result<(Image, Vec<Warning>), LoadError> {
    let path = path.as_ref();
    let bytes = read_file(path, limits.file_bytes)?;
    Image::decode(&bytes, &path.display().to_string())
}

impl Image {
    /// Decodes a PPM, PGM, PNG or JPEG from bytes; `name` stands in messages.
    ///
    /// # Errors
    /// [`LoadError`], one line.
    pub fn decode(bytes: &[u8], name: &str) -> Result<(Self, Vec<Warning>), LoadError> {
        let mut warnings = Vec::new();
        let mut warn = |text: String| {
            warnings.push(Warning {
                level: WarningLevel::Warning,
                text: format!("{name}: {text}"),
                count: 1,
            })
        };
        let picture = if bytes.starts_with(b"\x89PNG") {
            png(bytes, name, &mut warn)?
        } else if bytes.starts_with(&[0xff, 0xd8]) {
            jpeg(bytes, name)?
        } else if let [b'P', b'2' | b'3' | b'5' | b'6', ..] = bytes {
            netpbm(bytes, name)?
        } else {
            return Err(LoadError::unsupported(
                name,
                At::File,
                "not a picture this program reads; convert it to PNG, JPEG or PPM",
            ));
        };
        let (width, height) = (picture.width, picture.height);
        let picture = picture.fit(SIDE);
        if (picture.width, picture.height) != (width, height) {
            warn(format!("{width}x{height} scaled down to {}x{}", picture.width, picture.height));
        }
        let image = Self {
            name: name.into(),
            width: picture.width as u16,
            height: picture.height as u16,
            levels: 1,
            rgb: picture.rgb,
        };
        Ok((image, warnings))
    }

    /// The picture with all its mip levels down to 1 x 1, each the box-filtered mean of the one above, rounded to nearest.
    #[must_use]
    pub fn with_mips(mut self) -> Self {
        self.rgb.truncate(usize::from(self.width) * usize::from(self.height));
        self.levels = 1;
        let (mut width, mut height) = (usize::from(self.width), usize::from(self.height));
        let mut begin = 0;
        while width > 1 || height > 1 {
            let (w, h) = ((width / 2).max(1), (height / 2).max(1));
            let next = shrink(&self.rgb[begin..], width, height, w, h);
            begin = self.rgb.len();
            self.rgb.extend(next);
            (width, height) = (w, h);
            self.levels += 1;
        }
        self
    }

    /// All levels as 5-6-5 bits, red on top, each channel rounded to nearest.
    pub fn to_rgb565(&self) -> Vec<u16> {
        let scale = |c: u8, most: u16| (u16::from(c) * most + 127) / 255;
        let pack = |[r, g, b]: &[u8; 3]| scale(*r, 31) << 11 | scale(*g, 63) << 5 | scale(*b, 31);
        self.rgb.iter().map(pack).collect()
    }

    /// The picture as the pipeline reads it: repeating, nearest texel, black border; change the fields as you like.
    pub fn as_texture(&self) -> Texture<'_> {
        self.texture_over(Texels::Rgb888(&self.rgb))
    }

    /// As [`Image::as_texture`], over texels that [`Image::to_rgb565`] made.
    pub fn as_texture565<'a>(&self, texels: &'a [u16]) -> Texture<'a> {
        self.texture_over(Texels::Rgb565(texels))
    }

    fn texture_over<'a>(&self, texels: Texels<'a>) -> Texture<'a> {
        Texture {
            width: self.width,
            height: self.height,
            levels: self.levels,
            texels,
            wrap: [Wrap::Repeat; 2],
            filter: Filter::Nearest,
            border: [0; 3],
        }
    }
}

impl Picture {
    /// Scaled down by a box filter so that neither side exceeds `side`; the aspect is kept.
    fn fit(self, side: usize) -> Self {
        let longest = self.width.max(self.height);
        if longest <= side {
            return self;
        }
        let scaled = |n: usize| ((n * side + longest / 2) / longest).clamp(1, side);
        let (width, height) = (scaled(self.width), scaled(self.height));
        let rgb = shrink(&self.rgb, self.width, self.height, width, height);
        Self { width, height, rgb }
    }
}

/// Box filter: each new texel is the mean of the area it covers, parts of texels weighted by their share.
fn shrink(from: &[[u8; 3]], width: usize, height: usize, w: usize, h: usize) -> Vec<[u8; 3]> {
    let mut out = Vec::with_capacity(w * h);
    // In units of 1/w and 1/h of a texel, so that all shares are integers.
    let area = (width * height) as u64;
    for y in 0..h {
        let (top, bottom) = (y * height, (y + 1) * height);
        for x in 0..w {
            let (left, right) = (x * width, (x + 1) * width);
            let mut sum = [0u64; 3];
            for row in top / h..bottom.div_ceil(h) {
                let tall = bottom.min((row + 1) * h) - top.max(row * h);
                for column in left / w..right.div_ceil(w) {
                    let wide = right.min((column + 1) * w) - left.max(column * w);
                    let texel = from[row * width + column];
                    for (s, c) in sum.iter_mut().zip(texel) {
                        *s += u64::from(c) * (tall * wide) as u64;
                    }
                }
            }
            out.push(sum.map(|s| ((s + area / 2) / area) as u8));
        }
    }
    out
}

/// Refuses pictures that would take too much memory.
fn check_size(name: &str, width: usize, height: usize) -> Result<(), LoadError> {
    if width == 0 || height == 0 {
        return Err(LoadError::malformed(
            name,
            At::File,
            "the picture has no texels; export it again",
        ));
    }
    if width.saturating_mul(height) > TEXELS {
        return Err(LoadError::too_large(
            name,
            format!("{width}x{height} texels are more than {TEXELS}; scale it down"),
        ));
    }
    Ok(())
}

fn netpbm(bytes: &[u8], name: &str) -> Result<Picture, LoadError> {
    let mut size = (0, 0);
    let mut rgb = Vec::new();
    let mut refused = None;
    let mut sink = |event: ppm::Event| match event {
        ppm::Event::Header { width, height } => {
            size = (width as usize, height as usize);
            refused = check_size(name, size.0, size.1).err();
            // A texel takes at least a byte of the file: a header can't claim more than that.
            rgb.reserve_exact((size.0 * size.1).min(bytes.len()).min(TEXELS));
        }
        ppm::Event::Texel(texel) => {
            if refused.is_none() {
                rgb.push(texel);
            }
        }
    };
    let mut parser = ppm::Parser::new();
    let result = parser.feed(bytes, &mut sink).and_then(|()| parser.finish(&mut sink));
    if let Some(error) = refused {
        return Err(error);
    }
    result.map_err(|error| {
        let text = error.to_string();
        let what = text.split_once(": ").map_or(text.as_str(), |(_, what)| what);
        LoadError::malformed(name, At::Byte(error.byte), what)
    })?;
    Ok(Picture { width: size.0, height: size.1, rgb })
}

fn too_large(name: &str) -> LoadError {
    LoadError::too_large(name, "the picture is too large; scale it down")
}

fn png(bytes: &[u8], name: &str, warn: &mut impl FnMut(String)) -> Result<Picture, LoadError> {
    let fail = |error: png::DecodingError| match error {
        png::DecodingError::LimitsExceeded => too_large(name),
        png::DecodingError::IoError(_) => {
            LoadError::malformed(name, At::File, "PNG: it ends early; copy the file again")
        }
        // The library's words name its own types; a checksum is what tells a bad copy.
        error if error.to_string().contains("CRC") => {
            LoadError::malformed(name, At::File, "PNG: a checksum differs; copy the file again")
        }
        _ => LoadError::malformed(name, At::File, "PNG: it is damaged; export it again"),
    };
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_limits(png::Limits { bytes: 64 << 20 });
    decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::STRIP_16);
    let mut reader = decoder.read_info().map_err(fail)?;
    let (width, height) = (reader.info().width as usize, reader.info().height as usize);
    check_size(name, width, height)?;
    let size = reader.output_buffer_size().unwrap_or(usize::MAX);
    if size > 4 * TEXELS {
        return Err(too_large(name));
    }
    let mut data = vec![0; size];
    let info = reader.next_frame(&mut data).map_err(fail)?;
    data.truncate(info.buffer_size());
    let channels = info.color_type.samples();
    if channels % 2 == 0 && data.chunks_exact(channels).any(|t| t[channels - 1] != 255) {
        warn("its transparency is ignored".into());
    }
    let rgb = data
        .chunks_exact(channels)
        .map(|t| if channels < 3 { [t[0]; 3] } else { [t[0], t[1], t[2]] })
        .collect();
    Ok(Picture { width, height, rgb })
}

fn jpeg(bytes: &[u8], name: &str) -> Result<Picture, LoadError> {
    use zune_jpeg::errors::DecodeErrors;
    use zune_jpeg::zune_core::{
        bytestream::ZCursor, colorspace::ColorSpace, options::DecoderOptions,
    };
    let damaged = || LoadError::malformed(name, At::File, "JPEG: it is damaged; export it again");
    let fail = |error: DecodeErrors| match error {
        DecodeErrors::LargeDimensions(_) => too_large(name),
        DecodeErrors::ExhaustedData | DecodeErrors::IoErrors(_) => {
            LoadError::malformed(name, At::File, "JPEG: it ends early; copy the file again")
        }
        DecodeErrors::Unsupported(_) => {
            let what = "JPEG: lossless or arithmetic coding is not read; export it as baseline";
            LoadError::unsupported(name, At::File, what)
        }
        _ => damaged(),
    };
    let options = DecoderOptions::default()
        .set_max_width(16_384)
        .set_max_height(16_384)
        .jpeg_set_out_colorspace(ColorSpace::RGB);
    let mut decoder = zune_jpeg::JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(fail)?;
    let (width, height) = decoder.dimensions().ok_or_else(damaged)?;
    check_size(name, width, height)?;
    let data = decoder.decode().map_err(fail)?;
    if data.len() != width * height * 3 {
        return Err(damaged());
    }
    let rgb = data.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    Ok(Picture { width, height, rgb })
}

#[cfg(test)]
#[path = "image_tests.rs"]
mod tests;
