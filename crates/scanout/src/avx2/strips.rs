//! Raster to output for tiny triangles: strips of sixteen columns, row by row, RGB565.
//!
//! ```text
//!      left half       right half
//!     +---------------+---------------+       A row of a strip, in 16-bit lanes:
//!     |          __--#|##__           |
//!     |    __--#######|####__         |         e0 | e1 | e2 >= 0       inside all edges
//!     |--#############|######__       |         max(z, stored) != z     nearer
//!     |    ---########|########__     |         both: take the new one
//!     |           ----|###########__  |
//!     +---------------+---------------+
//! ```
//!
//! Edge functions, depth and colours step from row to row by addition, which is exact. Colours are made for eight pixels at a time, only
//! where one of them passes. At the right border a strip begins further left, so that it lies in the row: what is
//! drawn twice is not nearer the second time.
#![allow(unsafe_code)]

mod textured;

pub use textured::textured;

use core::arch::x86_64::*;

use super::memory::load;
use super::{EIGHT, Lanes, Pixels, Planes, STRIP, Triangles};

/// A plane on its way down a strip: the values of the first eight pixels of a row, what to add a column and a row.
#[derive(Clone, Copy)]
struct Row {
    now: __m256i,
    gx: __m256i,
    gy: __m256i,
}

impl Row {
    /// Before there is any.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn none() -> Row {
        let zero = _mm256_setzero_si256();
        Row { now: zero, gx: zero, gy: zero }
    }

    /// Lane `i` of some planes, `columns` from their first pixel.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn new(planes: &Planes, i: usize, columns: __m256i) -> Row {
        let gx = _mm256_set1_epi32(planes.gx[i]);
        let first = _mm256_mullo_epi32(gx, columns);
        let now = _mm256_add_epi32(_mm256_set1_epi32(planes.start[i]), first);
        Row { now, gx, gy: _mm256_set1_epi32(planes.gy[i]) }
    }

    /// The values of the eight pixels from a column on.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn from<W: Window>(&self, window: W) -> __m256i {
        match window.columns() {
            Some(columns) => _mm256_add_epi32(self.now, _mm256_mullo_epi32(self.gx, columns)),
            None => self.now,
        }
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn next(&mut self) {
        self.now = _mm256_add_epi32(self.now, self.gy);
    }
}

/// Which eight pixels of a row.
trait Window: Copy {
    /// The first one's column, in all lanes; `None` for the strip's first.
    fn columns(self) -> Option<__m256i>;
}

/// The strip's first.
#[derive(Clone, Copy)]
struct First;

impl Window for First {
    #[inline(always)]
    fn columns(self) -> Option<__m256i> {
        None
    }
}

/// From some column on.
#[derive(Clone, Copy)]
struct From(__m256i);

impl Window for From {
    #[inline(always)]
    fn columns(self) -> Option<__m256i> {
        Some(self.0)
    }
}

/// Eight colours at a time.
trait Eight {
    /// RGB565; those that do not `pass` are any.
    ///
    /// # Safety
    /// AVX2 and FMA are there.
    unsafe fn eight<W: Window>(&self, pass: __m128i, window: W) -> __m128i;
}

/// Writes the pixels of a row that pass, eight side by side at most twice: the first half, and from the first one on that is left.
///
/// # Safety
/// AVX2 and FMA are there; `row` points to sixteen pixels that can be written.
#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn paint<C: Eight>(colours: &C, pass: __m256i, bits: u32, row: *mut u16) {
    let low = _mm256_castsi256_si128(pass);
    // SAFETY: as the caller says; the array has 32 bytes, of which sixteen are read from at most the sixteenth on.
    unsafe {
        if bits >> 16 == 0 {
            return write(low, colours.eight(low, First), row);
        }
        // In one go where they lie together, otherwise the left half and the right half.
        let mut at = (bits.trailing_zeros() / 2) as usize;
        if at < EIGHT && bits >> (2 * at + 16) != 0 {
            write(low, colours.eight(low, First), row);
            at = EIGHT;
        }
        let at = at.min(EIGHT);
        let mut lanes = [0u16; STRIP];
        _mm256_storeu_si256(lanes.as_mut_ptr().cast(), pass);
        let pass = _mm_loadu_si128(lanes.as_ptr().add(at).cast());
        let window = From(_mm256_set1_epi32(at as i32));
        write(pass, colours.eight(pass, window), row.add(at));
    }
}

/// The colours of a strip's rows.
trait Colours {
    /// Lane `i` of the triangles, `columns` from their first pixel.
    ///
    /// # Safety
    /// AVX2 and FMA are there.
    unsafe fn begin(&mut self, triangles: &Triangles, i: usize, columns: __m256i);
    /// Writes this row's pixels that `pass`; `bits` has two for each.
    ///
    /// # Safety
    /// AVX2 and FMA are there; `row` points to sixteen pixels that can be written.
    unsafe fn paint(&self, pass: __m256i, bits: u32, row: *mut u16);
    /// To the next row.
    ///
    /// # Safety
    /// AVX2 and FMA are there.
    unsafe fn next(&mut self);
}

/// Writes those of eight pixels that pass.
///
/// # Safety
/// `at` points to eight pixels that can be written.
#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn write(pass: __m128i, colours: __m128i, at: *mut u16) {
    // SAFETY: as the caller says; the instructions ask no alignment.
    unsafe {
        let before = _mm_loadu_si128(at.cast());
        _mm_storeu_si128(at.cast(), _mm_blendv_epi8(before, colours, pass));
    }
}

/// One colour a triangle.
struct Flat<'a> {
    rgb: &'a [[u8; 3]; EIGHT],
    now: __m256i,
}

impl Colours for Flat<'_> {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn begin(&mut self, _: &Triangles, i: usize, _: __m256i) {
        use crate::output::{PixelFormat, Rgb565};
        self.now = _mm256_set1_epi16(Rgb565::encode(self.rgb[i]) as i16);
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn paint(&self, pass: __m256i, _: u32, row: *mut u16) {
        // SAFETY: sixteen pixels, as the caller says; the instructions ask no alignment.
        unsafe {
            let before = _mm256_loadu_si256(row.cast());
            _mm256_storeu_si256(row.cast(), _mm256_blendv_epi8(before, self.now, pass));
        }
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn next(&mut self) {}
}

/// Colours interpolated.
struct Gouraud([Row; 3]);

impl Gouraud {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn start(&mut self, triangles: &Triangles, i: usize, columns: __m256i) {
        let [r, g, b] = &triangles.colour;
        self.0 = [Row::new(r, i, columns), Row::new(g, i, columns), Row::new(b, i, columns)];
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn step(&mut self) {
        self.0[0].next();
        self.0[1].next();
        self.0[2].next();
    }
}

impl Eight for Gouraud {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn eight<W: Window>(&self, _: __m128i, window: W) -> __m128i {
        // Bits 16 - 23 are the channel; what is above them is a value just outside its range, which wraps.
        let [r, g, b] = &self.0;
        let r = _mm256_srli_epi32(r.from(window), 8);
        let g = _mm256_srli_epi32(g.from(window), 13);
        let b = _mm256_srli_epi32(b.from(window), 19);
        let r = _mm256_and_si256(r, _mm256_set1_epi32(0xf800));
        let g = _mm256_and_si256(g, _mm256_set1_epi32(0x07e0));
        let b = _mm256_and_si256(b, _mm256_set1_epi32(0x001f));
        let v = _mm256_or_si256(_mm256_or_si256(r, g), b);
        _mm_packus_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1))
    }
}

impl Colours for Gouraud {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn begin(&mut self, triangles: &Triangles, i: usize, columns: __m256i) {
        self.start(triangles, i, columns);
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn paint(&self, pass: __m256i, bits: u32, row: *mut u16) {
        // SAFETY: the same demands.
        unsafe { paint(self, pass, bits, row) }
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn next(&mut self) {
        self.step();
    }
}

/// Draws lanes of the triangles.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn draw<C: Colours>(triangles: &Triangles, lanes: Lanes, colours: &mut C, pixels: &mut Pixels) {
    let width = pixels.width;
    let len = pixels.colours.len().min(pixels.depths.len());
    let eight = load(&[0, 1, 2, 3, 4, 5, 6, 7]);
    let sixteen = _mm256_setr_epi16(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    for i in lanes {
        let (first, rows) = (triangles.x[i], triangles.rows[i]);
        let (mut left, right) = (triangles.left[i], triangles.right[i]);
        if rows <= 0 {
            continue;
        }
        let row = (triangles.top[i] - pixels.top) as usize * width;
        while left < right {
            let x = left.min(width as i32 - STRIP as i32);
            let at = row + x as usize;
            if at + (rows as usize - 1) * width + STRIP > len {
                return;
            }
            // SAFETY: the strip's sixteen pixels of each row, as just tested, lie in both slices.
            unsafe {
                let colour = pixels.colours.as_mut_ptr().add(at);
                let depth = pixels.depths.as_mut_ptr().add(at);
                let columns = _mm256_add_epi32(eight, _mm256_set1_epi32(x - first));
                colours.begin(triangles, i, columns);
                let z = Row::new(&triangles.depth, i, columns);
                let columns = _mm256_add_epi16(sixteen, _mm256_set1_epi16((x - first) as i16));
                strip(triangles, i, columns, z, colours, colour, depth, rows, width);
            }
            left += STRIP as i32;
        }
    }
}

/// Draws one strip.
///
/// # Safety
/// `colour` and `depth` point to sixteen pixels that can be written, and so do they `width` further on, `rows` times in all.
#[allow(clippy::too_many_arguments)]
#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn strip<C: Colours>(
    triangles: &Triangles,
    i: usize,
    columns: __m256i,
    mut z: Row,
    colours: &mut C,
    mut colour: *mut u16,
    mut depth: *mut u16,
    rows: i32,
    width: usize,
) {
    let edge = |e: &Planes| {
        let right = _mm256_mullo_epi16(_mm256_set1_epi16(e.gx[i] as i16), columns);
        _mm256_add_epi16(_mm256_set1_epi16(e.start[i] as i16), right)
    };
    let down = |e: &Planes| _mm256_set1_epi16(e.gy[i] as i16);
    let [e0, e1, e2] = &triangles.edges;
    let (d0, d1, d2) = (down(e0), down(e1), down(e2));
    let (mut e0, mut e1, mut e2) = (edge(e0), edge(e1), edge(e2));
    let z_right = _mm256_slli_epi32(z.gx, 3);
    let mut rest = rows;
    loop {
        // SAFETY: sixteen pixels, as the caller says.
        let stored = unsafe { _mm256_loadu_si256(depth.cast()) };
        let (left, right) = (z.now, _mm256_add_epi32(z.now, z_right));
        let new = _mm256_packus_epi32(_mm256_srli_epi32(left, 16), _mm256_srli_epi32(right, 16));
        let new = _mm256_permute4x64_epi64(new, 0b11_01_10_00);
        let behind = _mm256_cmpeq_epi16(_mm256_max_epu16(new, stored), new);
        let edges = _mm256_or_si256(_mm256_or_si256(e0, e1), e2);
        let pass = _mm256_andnot_si256(behind, _mm256_cmpgt_epi16(edges, _mm256_set1_epi16(-1)));
        let bits = _mm256_movemask_epi8(pass) as u32;
        if bits != 0 {
            // SAFETY: as above.
            unsafe {
                _mm256_storeu_si256(depth.cast(), _mm256_blendv_epi8(stored, new, pass));
                colours.paint(pass, bits, colour);
            }
        }
        rest -= 1;
        if rest == 0 {
            return;
        }
        e0 = _mm256_add_epi16(e0, d0);
        e1 = _mm256_add_epi16(e1, d1);
        e2 = _mm256_add_epi16(e2, d2);
        z.next();
        // SAFETY: AVX2 is there; there is another row, as the caller says.
        unsafe {
            colours.next();
            colour = colour.add(width);
            depth = depth.add(width);
        }
    }
}

/// Triangles of one colour each.
#[target_feature(enable = "avx2,fma")]
pub fn flat(triangles: &Triangles, lanes: Lanes, rgb: &[[u8; 3]; EIGHT], pixels: &mut Pixels) {
    draw(triangles, lanes, &mut Flat { rgb, now: _mm256_setzero_si256() }, pixels);
}

/// Triangles with a colour at each vertex.
#[target_feature(enable = "avx2,fma")]
pub fn gouraud(triangles: &Triangles, lanes: Lanes, pixels: &mut Pixels) {
    draw(triangles, lanes, &mut Gouraud([Row::none(); 3]), pixels);
}
