//! Raster to output for tiny triangles: strips of eight columns, row by row, RGB565.
//!
//! ```text
//!      strip 0   strip 1            A row of a strip, in 16-bit lanes:
//!     +--------+--------+
//!     |      _-|-_      |             e0 | e1 | e2 < 0       outside an edge
//!     |   _--##|##-_    |             max(z, stored) = z     not nearer
//!     |_--#####|####-_  |             either: keep what is stored
//!     +--------+--------+
//! ```
//!
//! Edge functions, depth and colours step from row to row by addition, which is exact. At the right border a strip begins further
//! left, so that it lies in the row: what is drawn twice is not nearer the second time.
#![allow(unsafe_code)]

use core::arch::x86_64::*;

use super::memory::load;
use super::{EIGHT, Lanes, Pixels, Planes, Triangles};
use crate::texture::{Repeat565, SUBTEXEL_BITS, integer_q, reciprocal};

/// A plane on its way down a strip: the values of a row's eight pixels, and what to add for the next.
#[derive(Clone, Copy)]
struct Row {
    now: __m256i,
    down: __m256i,
}

impl Row {
    /// Lane `i` of some planes, from `steps` columns to the right on.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn new(planes: &Planes, i: usize, steps: __m256i) -> Row {
        let right = _mm256_mullo_epi32(_mm256_set1_epi32(planes.gx[i]), steps);
        Row {
            now: _mm256_add_epi32(_mm256_set1_epi32(planes.start[i]), right),
            down: _mm256_set1_epi32(planes.gy[i]),
        }
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn next(&mut self) {
        self.now = _mm256_add_epi32(self.now, self.down);
    }
}

/// 32-bit lanes that hold 16 bits, to 16-bit lanes.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn pack(v: __m256i) -> __m128i {
    _mm_packus_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1))
}

/// The colours of a strip's rows.
trait Colours: Sized {
    /// Lane `i` of the triangles, from `steps` columns to the right of their first on.
    ///
    /// # Safety
    /// AVX2 and FMA are there.
    unsafe fn begin(&mut self, triangles: &Triangles, i: usize, steps: __m256i);
    /// RGB565 of this row's pixels; those that `fail` need not be right.
    ///
    /// # Safety
    /// AVX2 and FMA are there.
    unsafe fn row(&self, fail: __m128i) -> __m128i;
    /// To the next row.
    ///
    /// # Safety
    /// AVX2 and FMA are there.
    unsafe fn next(&mut self);
}

/// One colour a triangle, encoded.
struct Flat<'a> {
    rgb: &'a [[u8; 3]; EIGHT],
    now: __m128i,
}

impl Colours for Flat<'_> {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn begin(&mut self, _: &Triangles, i: usize, _: __m256i) {
        use crate::output::{PixelFormat, Rgb565};
        self.now = _mm_set1_epi16(Rgb565::encode(self.rgb[i]) as i16);
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn row(&self, _: __m128i) -> __m128i {
        self.now
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn next(&mut self) {}
}

/// Colours interpolated.
struct Gouraud([Row; 3]);

impl Colours for Gouraud {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn begin(&mut self, triangles: &Triangles, i: usize, steps: __m256i) {
        let [r, g, b] = &triangles.colour;
        self.0 = [Row::new(r, i, steps), Row::new(g, i, steps), Row::new(b, i, steps)];
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn row(&self, _: __m128i) -> __m128i {
        // Bits 16 - 23 are the channel; what is above them is a value just outside its range, which wraps.
        let [r, g, b] = [self.0[0].now, self.0[1].now, self.0[2].now];
        let r = _mm256_and_si256(_mm256_srli_epi32(r, 8), _mm256_set1_epi32(0xf800));
        let g = _mm256_and_si256(_mm256_srli_epi32(g, 13), _mm256_set1_epi32(0x07e0));
        let b = _mm256_and_si256(_mm256_srli_epi32(b, 19), _mm256_set1_epi32(0x001f));
        pack(_mm256_or_si256(_mm256_or_si256(r, g), b))
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn next(&mut self) {
        self.0[0].next();
        self.0[1].next();
        self.0[2].next();
    }
}

/// Channels in 16-bit lanes.
trait Channels {
    /// See [`Colours::begin`].
    ///
    /// # Safety
    /// AVX2 and FMA are there.
    unsafe fn begin(&mut self, triangles: &Triangles, i: usize, steps: __m256i);
    /// 0 - 255 each.
    ///
    /// # Safety
    /// AVX2 and FMA are there.
    unsafe fn row(&self) -> [__m128i; 3];
    /// To the next row.
    ///
    /// # Safety
    /// AVX2 and FMA are there.
    unsafe fn next(&mut self);
}

impl Channels for Gouraud {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn begin(&mut self, triangles: &Triangles, i: usize, steps: __m256i) {
        // SAFETY: the same demand.
        unsafe { Colours::begin(self, triangles, i, steps) }
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn row(&self) -> [__m128i; 3] {
        let byte = _mm256_set1_epi32(0xff);
        let channel = |v: &Row| pack(_mm256_and_si256(_mm256_srli_epi32(v.now, 16), byte));
        [channel(&self.0[0]), channel(&self.0[1]), channel(&self.0[2])]
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn next(&mut self) {
        // SAFETY: the same demand.
        unsafe { Colours::next(self) }
    }
}

/// One colour a triangle, its channels.
struct FlatChannels<'a> {
    rgb: &'a [[u8; 3]; EIGHT],
    now: [__m128i; 3],
}

impl Channels for FlatChannels<'_> {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn begin(&mut self, _: &Triangles, i: usize, _: __m256i) {
        let [r, g, b] = self.rgb[i].map(i16::from);
        self.now = [_mm_set1_epi16(r), _mm_set1_epi16(g), _mm_set1_epi16(b)];
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn row(&self) -> [__m128i; 3] {
        self.now
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn next(&mut self) {}
}

/// Texels times colours.
struct Textured<'a, C> {
    channels: C,
    texture: &'a Repeat565<'a>,
    q: Row,
    st: [Row; 2],
    /// Shifts from products to whole texels.
    shift: [u32; 2],
}

impl<C> Textured<'_, C> {
    /// The texels of a row one by one: where eight at a time would not be exact, or would read beyond the texture.
    #[cold]
    #[inline(never)]
    fn one_by_one(&self, fail: __m128i) -> __m128i {
        // SAFETY: each is as large as what is copied into it, and any bits are a value.
        let (fail, q, st): ([i16; EIGHT], [u32; EIGHT], [[u32; EIGHT]; 2]) = unsafe {
            (
                core::mem::transmute::<__m128i, [i16; EIGHT]>(fail),
                core::mem::transmute::<__m256i, [u32; EIGHT]>(self.q.now),
                self.st.map(|row| core::mem::transmute::<__m256i, [u32; EIGHT]>(row.now)),
            )
        };
        let shift = self.shift.map(|s| s - SUBTEXEL_BITS);
        let texels: [u16; EIGHT] = core::array::from_fn(|i| {
            if fail[i] != 0 {
                return 0;
            }
            let r = reciprocal(integer_q(q[i]));
            self.texture.at(shift, [st[0][i], st[1][i]], r)
        });
        // SAFETY: as above.
        unsafe { core::mem::transmute::<[u16; EIGHT], __m128i>(texels) }
    }

    /// The texels of a row.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn texels(&self, fail: __m128i) -> __m128i {
        let number = |v: i32| _mm256_set1_epi32(v);
        let fail_wide = _mm256_cvtepi16_epi32(fail);
        let q = _mm256_srli_epi32(self.q.now, 8);
        // r = floor((2^47 - 1) / q): below 2^32 for q above 2^15.
        let all = _mm256_set1_pd(((1u64 << 47) - 1) as f64);
        let magic = _mm256_set1_pd((1u64 << 52) as f64);
        let reciprocal = |q: __m128i| {
            let r = _mm256_floor_pd(_mm256_div_pd(all, _mm256_cvtepi32_pd(q)));
            _mm256_castpd_si256(_mm256_add_pd(r, magic))
        };
        let r = [reciprocal(_mm256_castsi256_si128(q)), reciprocal(_mm256_extracti128_si256(q, 1))];
        let axis = |i: usize| {
            let v = self.st[i].now;
            let shift = _mm_cvtsi32_si128(self.shift[i] as i32);
            let half = _mm256_set1_epi64x(1 << (self.shift[i] - SUBTEXEL_BITS - 1));
            let texel = |v: __m128i, r: __m256i| {
                let product = _mm256_mul_epu32(_mm256_cvtepu32_epi64(v), r);
                let rounded = _mm256_add_epi64(product, half);
                _mm256_castsi256_ps(_mm256_srl_epi64(rounded, shift))
            };
            let low = texel(_mm256_castsi256_si128(v), r[0]);
            let high = texel(_mm256_extracti128_si256(v, 1), r[1]);
            let mixed = _mm256_castps_pd(_mm256_shuffle_ps(low, high, 0b10_00_10_00));
            _mm256_castpd_si256(_mm256_permute4x64_pd(mixed, 0b11_01_10_00))
        };
        let (x, y) = (axis(0), axis(1));
        // Texel and reciprocal in range; where a texel wraps round, or may be the last, one by one.
        let (width, height) = (self.texture.size[0] as i32, self.texture.size[1] as i32);
        let right = |v: __m256i, n: i32| _mm256_cmpeq_epi32(_mm256_min_epu32(v, number(n - 1)), v);
        let index = _mm256_add_epi32(_mm256_mullo_epi32(y, number(width)), x);
        let last = self.texture.texels.len().min(i32::MAX as usize) as i32 - 1;
        let good = _mm256_and_si256(
            _mm256_and_si256(right(x, width), right(y, height)),
            _mm256_and_si256(
                _mm256_cmpgt_epi32(number(last), index),
                _mm256_cmpgt_epi32(q, number(1 << 15)),
            ),
        );
        // All that count are good.
        if _mm256_testc_si256(_mm256_or_si256(good, fail_wide), number(-1)) == 0 {
            return self.one_by_one(fail);
        }
        let index = _mm256_andnot_si256(fail_wide, index);
        // SAFETY: 0 <= index < last: two texels beginning at `index` are in the slice.
        let pairs =
            unsafe { _mm256_i32gather_epi32::<2>(self.texture.texels.as_ptr().cast(), index) };
        pack(_mm256_and_si256(pairs, number(0xffff)))
    }
}

impl<C: Channels> Colours for Textured<'_, C> {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn begin(&mut self, triangles: &Triangles, i: usize, steps: __m256i) {
        self.q = Row::new(&triangles.q, i, steps);
        let [s, t] = &triangles.st;
        self.st = [Row::new(s, i, steps), Row::new(t, i, steps)];
        self.shift = [triangles.shift[0][i] as u32, triangles.shift[1][i] as u32];
        // SAFETY: the same demand.
        unsafe { self.channels.begin(triangles, i, steps) }
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn row(&self, fail: __m128i) -> __m128i {
        let texels = self.texels(fail);
        let number = |v: i16| _mm_set1_epi16(v);
        // As `widen565` and `modulate`: the exact quotient by 255, rounded.
        let r = _mm_srli_epi16(texels, 11);
        let g = _mm_and_si128(_mm_srli_epi16(texels, 5), number(63));
        let b = _mm_and_si128(texels, number(31));
        let r = _mm_or_si128(_mm_slli_epi16(r, 3), _mm_srli_epi16(r, 2));
        let g = _mm_or_si128(_mm_slli_epi16(g, 2), _mm_srli_epi16(g, 4));
        let b = _mm_or_si128(_mm_slli_epi16(b, 3), _mm_srli_epi16(b, 2));
        // SAFETY: the same demand.
        let colours = unsafe { self.channels.row() };
        let times = |a: __m128i, b: __m128i| {
            let t = _mm_add_epi16(_mm_mullo_epi16(a, b), number(128));
            _mm_srli_epi16(_mm_add_epi16(t, _mm_srli_epi16(t, 8)), 8)
        };
        let (r, g, b) = (times(r, colours[0]), times(g, colours[1]), times(b, colours[2]));
        let r = _mm_slli_epi16(_mm_and_si128(r, number(0xf8)), 8);
        let g = _mm_slli_epi16(_mm_and_si128(g, number(0xfc)), 3);
        _mm_or_si128(_mm_or_si128(r, g), _mm_srli_epi16(b, 3))
    }

    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn next(&mut self) {
        self.q.next();
        self.st[0].next();
        self.st[1].next();
        // SAFETY: the same demand.
        unsafe { self.channels.next() }
    }
}

/// Draws lanes of the triangles.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn draw<C: Colours>(triangles: &Triangles, lanes: Lanes, colours: &mut C, pixels: &mut Pixels) {
    let width = pixels.width;
    let len = pixels.colours.len().min(pixels.depths.len());
    let count = load(&[0, 1, 2, 3, 4, 5, 6, 7]);
    let columns = _mm_setr_epi16(0, 1, 2, 3, 4, 5, 6, 7);
    for i in lanes {
        let (first, rows) = (triangles.x[i], triangles.rows[i]);
        let (mut left, right) = (triangles.left[i], triangles.right[i]);
        if rows <= 0 {
            continue;
        }
        let row = (triangles.top[i] - pixels.top) as usize * width;
        while left < right {
            let x = left.min(width as i32 - EIGHT as i32);
            let at = row + x as usize;
            if at + (rows as usize - 1) * width + EIGHT > len {
                return;
            }
            // SAFETY: the strip's eight pixels of each row, as just tested, lie in both slices.
            unsafe {
                let colour = pixels.colours.as_mut_ptr().add(at);
                let depth = pixels.depths.as_mut_ptr().add(at);
                let steps = x - first;
                let wide = _mm256_add_epi32(count, _mm256_set1_epi32(steps));
                let columns = _mm_add_epi16(columns, _mm_set1_epi16(steps as i16));
                colours.begin(triangles, i, wide);
                let z = Row::new(&triangles.depth, i, wide);
                strip(triangles, i, columns, z, colours, colour, depth, rows, width);
            }
            left += EIGHT as i32;
        }
    }
}

/// Draws one strip.
///
/// # Safety
/// `colour` and `depth` point to eight pixels that can be written, and so do they `width` further on, `rows` times in all.
#[allow(clippy::too_many_arguments)]
#[inline]
#[target_feature(enable = "avx2,fma")]
unsafe fn strip<C: Colours>(
    triangles: &Triangles,
    i: usize,
    columns: __m128i,
    mut z: Row,
    colours: &mut C,
    mut colour: *mut u16,
    mut depth: *mut u16,
    rows: i32,
    width: usize,
) {
    let edge = |e: &Planes| {
        let right = _mm_mullo_epi16(_mm_set1_epi16(e.gx[i] as i16), columns);
        _mm_add_epi16(_mm_set1_epi16(e.start[i] as i16), right)
    };
    let down = |e: &Planes| _mm_set1_epi16(e.gy[i] as i16);
    let [e0, e1, e2] = &triangles.edges;
    let (d0, d1, d2) = (down(e0), down(e1), down(e2));
    let (mut e0, mut e1, mut e2) = (edge(e0), edge(e1), edge(e2));
    let mut rest = rows;
    loop {
        // SAFETY: eight pixels, as the caller says.
        let stored = unsafe { _mm_loadu_si128(depth.cast()) };
        let new = pack(_mm256_srli_epi32(z.now, 16));
        let behind = _mm_cmpeq_epi16(_mm_max_epu16(new, stored), new);
        let outside = _mm_srai_epi16(_mm_or_si128(_mm_or_si128(e0, e1), e2), 15);
        let fail = _mm_or_si128(behind, outside);
        if _mm_test_all_ones(fail) == 0 {
            // SAFETY: as above.
            unsafe {
                _mm_storeu_si128(depth.cast(), _mm_blendv_epi8(new, stored, fail));
                let before = _mm_loadu_si128(colour.cast());
                let after = _mm_blendv_epi8(colours.row(fail), before, fail);
                _mm_storeu_si128(colour.cast(), after);
            }
        }
        rest -= 1;
        if rest == 0 {
            return;
        }
        e0 = _mm_add_epi16(e0, d0);
        e1 = _mm_add_epi16(e1, d1);
        e2 = _mm_add_epi16(e2, d2);
        z.next();
        // SAFETY: AVX2 is there; there is another row, as the caller says.
        unsafe {
            colours.next();
            colour = colour.add(width);
            depth = depth.add(width);
        }
    }
}

#[inline]
#[target_feature(enable = "avx2,fma")]
fn no_row() -> Row {
    Row { now: _mm256_setzero_si256(), down: _mm256_setzero_si256() }
}

/// Triangles of one colour each.
#[target_feature(enable = "avx2,fma")]
pub fn flat(triangles: &Triangles, lanes: Lanes, rgb: &[[u8; 3]; EIGHT], pixels: &mut Pixels) {
    draw(triangles, lanes, &mut Flat { rgb, now: _mm_setzero_si128() }, pixels);
}

/// Triangles with a colour at each vertex.
#[target_feature(enable = "avx2,fma")]
pub fn gouraud(triangles: &Triangles, lanes: Lanes, pixels: &mut Pixels) {
    draw(triangles, lanes, &mut Gouraud([no_row(); 3]), pixels);
}

/// Textured triangles, with one colour each or one at each vertex.
#[target_feature(enable = "avx2,fma")]
pub fn textured(
    triangles: &Triangles,
    lanes: Lanes,
    texture: &Repeat565,
    flat: Option<&[[u8; 3]; EIGHT]>,
    pixels: &mut Pixels,
) {
    let (q, st, shift) = (no_row(), [no_row(); 2], [SUBTEXEL_BITS + 1; 2]);
    match flat {
        Some(rgb) => {
            let channels = FlatChannels { rgb, now: [_mm_setzero_si128(); 3] };
            draw(triangles, lanes, &mut Textured { channels, texture, q, st, shift }, pixels);
        }
        None => {
            let channels = Gouraud([no_row(); 3]);
            draw(triangles, lanes, &mut Textured { channels, texture, q, st, shift }, pixels);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::avx2::{Avx2, Source};
    use crate::output::{PixelFormat, Rgb565, widen565};
    use crate::shade::modulate;
    use crate::texture::{Texels, Texture};

    /// A row of texels at any 1/w, also where one reciprocal does not fit 32 bits, a texture repeats or its last texel is hit.
    #[test]
    fn a_row_of_texels_is_one_at_a_time() {
        let Some(avx2) = Avx2::detect() else { return };
        let mut seed = 3u64;
        let mut random = |n: u32| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (((seed >> 32) * n as u64) >> 32) as u32
        };
        let texels: [u16; 64 * 32] = core::array::from_fn(|i| (i * 40503) as u16);
        for case in 0..20_000 {
            let size = [(64, 32), (1, 1), (5, 3), (32, 64)][case % 4];
            let used = &texels[..size.0 as usize * size.1 as usize];
            let texture = Texture::new(size.0, size.1, Texels::Rgb565(used)).unwrap();
            let texture = Repeat565::new(&texture).unwrap();
            let q = [1 << 9, 1 << 20, 1 << 24, 1 << 31][case / 4 % 4];
            let mut t = Triangles { ready: 1, ..Triangles::default() };
            (t.right[0], t.rows[0]) = (EIGHT as i32, 1);
            (t.q.start[0], t.q.gx[0]) = (random(q / 2) as i32, random(q / 16) as i32);
            for axis in 0..2 {
                (t.st[axis].start[0], t.st[axis].gx[0]) =
                    (random(1 << 30) as i32, random(1 << 27) as i32);
                t.shift[axis][0] = 40 + random(20) as i32;
            }
            let rgb = [(); 3].map(|()| random(256) as u8);
            let source = Source {
                triangles: &[],
                vertices: &[],
                uv_triangles: &[],
                uvs: &[],
                texture: Some(texture),
                gouraud: false,
                rows: (0, 1),
                width: EIGHT as i32,
            };
            let (mut colours, mut depths) = ([0; EIGHT], [u16::MAX; EIGHT]);
            let mut pixels =
                Pixels { colours: &mut colours, depths: &mut depths, width: EIGHT, top: 0 };
            avx2.draw(&source, &t, 0..1, &[rgb; EIGHT], &mut pixels);
            assert_eq!(depths, [0; EIGHT]);
            let shift = [0, 1].map(|axis| t.shift[axis][0] as u32 - SUBTEXEL_BITS);
            for (i, got) in colours.into_iter().enumerate() {
                let at = |p: &Planes| (p.start[0] + i as i32 * p.gx[0]) as u32;
                let r = reciprocal(integer_q(at(&t.q)));
                let texel = texture.at(shift, t.st.each_ref().map(at), r);
                assert_eq!(got, Rgb565::encode(modulate(widen565(texel), rgb)));
            }
        }
    }
}
