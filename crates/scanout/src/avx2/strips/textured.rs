//! Textured strips: texels times colours, eight side by side.

use core::arch::x86_64::*;

use super::{Colours, Eight, Gouraud, Row, Window, draw, paint};
use crate::avx2::memory::load;
use crate::avx2::{EIGHT, Lanes, Pixels, Triangles};
use crate::texture::{Repeat565, SUBTEXEL_BITS, integer_q, reciprocal};

/// Channels of eight colours, 0 - 255 in 16-bit lanes: r0-3 g0-3 r4-7 g4-7 and b0-3 0 b4-7 0.
#[derive(Clone, Copy)]
struct Channels {
    rg: __m256i,
    b: __m256i,
}

/// Where the colours come from that texels are multiplied by.
trait Tint {
    /// See [`Colours::begin`].
    ///
    /// # Safety
    /// AVX2 and FMA are there.
    unsafe fn begin(&mut self, triangles: &Triangles, i: usize, columns: __m256i);
    /// Of eight pixels.
    ///
    /// # Safety
    /// AVX2 and FMA are there.
    unsafe fn channels<W: Window>(&self, window: W) -> Channels;
    /// To the next row.
    ///
    /// # Safety
    /// AVX2 and FMA are there.
    unsafe fn next(&mut self);
}

impl Tint for Gouraud {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn begin(&mut self, triangles: &Triangles, i: usize, columns: __m256i) {
        self.start(triangles, i, columns);
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn channels<W: Window>(&self, window: W) -> Channels {
        let byte = _mm256_set1_epi32(0xff);
        let channel = |row: &Row| _mm256_and_si256(_mm256_srli_epi32(row.from(window), 16), byte);
        let [r, g, b] = &self.0;
        Channels {
            rg: _mm256_packus_epi32(channel(r), channel(g)),
            b: _mm256_packus_epi32(channel(b), _mm256_setzero_si256()),
        }
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn next(&mut self) {
        self.step();
    }
}

/// One colour a triangle.
struct FlatTint<'a> {
    rgb: &'a [[u8; 3]; EIGHT],
    now: Channels,
}

impl Tint for FlatTint<'_> {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn begin(&mut self, _: &Triangles, i: usize, _: __m256i) {
        let [r, g, b] = self.rgb[i].map(|v| _mm256_set1_epi16(v as i16));
        let zero = _mm256_setzero_si256();
        self.now = Channels { rg: _mm256_unpacklo_epi64(r, g), b: _mm256_unpacklo_epi64(b, zero) };
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn channels<W: Window>(&self, _: W) -> Channels {
        self.now
    }
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn next(&mut self) {}
}

/// Lanes as an array.
#[inline]
fn array(v: __m256i) -> [u32; EIGHT] {
    // SAFETY: as large, and any bits are a value.
    unsafe { core::mem::transmute::<__m256i, [u32; EIGHT]>(v) }
}

/// Texels times colours.
struct Textured<'a, T> {
    tint: T,
    texture: &'a Repeat565<'a>,
    q: Row,
    st: [Row; 2],
    /// Shifts from products to whole texels, at least 32.
    shift: [u32; 2],
}

/// Texels one by one: where a texture repeats, or four bytes at its last texel would be beyond it.
#[cold]
#[inline(never)]
fn one_by_one(
    texture: &Repeat565,
    shift: [u32; 2],
    pass: [u32; EIGHT],
    q: [u32; EIGHT],
    [s, t]: [[u32; EIGHT]; 2],
) -> [u32; EIGHT] {
    core::array::from_fn(|i| {
        let r = || reciprocal(integer_q(q[i]));
        let shift = shift.map(|s| s - SUBTEXEL_BITS);
        if pass[i] != 0 { texture.at(shift, [s[i], t[i]], r()) as u32 } else { 0 }
    })
}

impl<T: Tint> Textured<'_, T> {
    /// The texels of eight pixels in the lower halves of 32-bit lanes; those that do not `pass` are any.
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    fn texels<W: Window>(&self, pass: __m256i, window: W) -> __m256i {
        let number = |v: i32| _mm256_set1_epi32(v);
        let q_plane = self.q.from(window);
        let q = _mm256_srli_epi32(q_plane, 8);
        // r = floor((2^47 - 1) / q): below 2^31 for q above 2^16, which setup has seen to.
        let all = _mm256_set1_pd(((1u64 << 47) - 1) as f64);
        let reciprocal =
            |q: __m128i| _mm256_cvttpd_epi32(_mm256_div_pd(all, _mm256_cvtepi32_pd(q)));
        let low = reciprocal(_mm256_castsi256_si128(q));
        let even = _mm256_set_m128i(reciprocal(_mm256_extracti128_si256(q, 1)), low);
        let odd = _mm256_srli_epi64(even, 32);
        let axis = |row: &Row, shift: u32| {
            let v = row.from(window);
            // Odd lanes end in the upper half of their 64 bits.
            let low = _mm_cvtsi32_si128(shift as i32);
            let high = _mm_cvtsi32_si128(shift as i32 - 32);
            let a = _mm256_srl_epi64(_mm256_mul_epu32(v, even), low);
            let b = _mm256_srl_epi64(_mm256_mul_epu32(_mm256_srli_epi64(v, 32), odd), high);
            _mm256_blend_epi32(a, b, 0b1010_1010)
        };
        let [s, t] = &self.st;
        let (x, y) = (axis(s, self.shift[0]), axis(t, self.shift[1]));
        let [width, height] = self.texture.size.map(|v| v as i32);
        let texels = self.texture.texels.len().min((width * height) as usize);
        let index = _mm256_add_epi32(_mm256_mullo_epi32(y, number(width)), x);
        let at_most =
            |v: __m256i, most: i32| _mm256_cmpeq_epi32(_mm256_min_epu32(v, number(most)), v);
        // A row of texels too far is an index too far. The last texel is left out: two are read.
        let last = texels.saturating_sub(2) as i32;
        let good = _mm256_and_si256(at_most(x, width - 1), at_most(index, last));
        if texels < 2 || _mm256_testc_si256(good, pass) == 0 {
            let st = [array(s.from(window)), array(t.from(window))];
            let texels = one_by_one(self.texture, self.shift, array(pass), array(q_plane), st);
            return load(&texels.map(|v| v as i32));
        }
        // SAFETY: lanes that pass are at most the last but one, and others are not read.
        unsafe {
            let at = self.texture.texels.as_ptr().cast();
            _mm256_mask_i32gather_epi32::<2>(_mm256_setzero_si256(), at, index, pass)
        }
    }
}

impl<T: Tint> Eight for Textured<'_, T> {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn eight<W: Window>(&self, pass: __m128i, window: W) -> __m128i {
        let texels = self.texels(_mm256_cvtepi16_epi32(pass), window);
        // SAFETY: AVX2 and FMA are there.
        let tint = unsafe { self.tint.channels(window) };
        let channel = |mask: i32| _mm256_and_si256(texels, _mm256_set1_epi32(mask));
        let both =
            |r: i16, g: i16| _mm256_unpacklo_epi64(_mm256_set1_epi16(r), _mm256_set1_epi16(g));
        // `widen565`: r8 = floor(r5 33 / 4), g8 = floor(g6 65 / 16), by the upper halves of products.
        let rg = _mm256_packus_epi32(channel(0xf800), channel(0x07e0));
        let rg = _mm256_mulhi_epu16(rg, both(33 << 3, 65 << 7));
        let b = _mm256_packus_epi32(channel(0x001f), _mm256_setzero_si256());
        let b = _mm256_mulhi_epu16(_mm256_slli_epi16(b, 11), _mm256_set1_epi16(33 << 3));
        // `modulate`: t = a b + 128, (t + floor(t / 256)) / 256 = 257 t / 65536.
        let times = |a: __m256i, b: __m256i| {
            let t = _mm256_add_epi16(_mm256_mullo_epi16(a, b), _mm256_set1_epi16(128));
            _mm256_mulhi_epu16(t, _mm256_set1_epi16(257))
        };
        let (rg, b) = (times(rg, tint.rg), times(b, tint.b));
        // To their places.
        let rg = _mm256_mullo_epi16(_mm256_and_si256(rg, both(0xf8, 0xfc)), both(1 << 8, 1 << 3));
        let rgb = _mm256_or_si256(rg, _mm256_srli_epi16(b, 3));
        let rgb = _mm256_or_si256(rgb, _mm256_srli_si256(rg, 8));
        _mm256_castsi256_si128(_mm256_permute4x64_epi64(rgb, 0b10_00))
    }
}

impl<T: Tint> Colours for Textured<'_, T> {
    #[inline]
    #[target_feature(enable = "avx2,fma")]
    unsafe fn begin(&mut self, triangles: &Triangles, i: usize, columns: __m256i) {
        self.q = Row::new(&triangles.q, i, columns);
        let [s, t] = &triangles.st;
        self.st = [Row::new(s, i, columns), Row::new(t, i, columns)];
        self.shift = [triangles.shift[0][i] as u32, triangles.shift[1][i] as u32];
        // SAFETY: the same demand.
        unsafe { self.tint.begin(triangles, i, columns) }
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
        self.q.next();
        self.st[0].next();
        self.st[1].next();
        // SAFETY: the same demand.
        unsafe { self.tint.next() }
    }
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
    let (q, st, shift) = (Row::none(), [Row::none(); 2], [32; 2]);
    match flat {
        Some(rgb) => {
            let zero = _mm256_setzero_si256();
            let tint = FlatTint { rgb, now: Channels { rg: zero, b: zero } };
            draw(triangles, lanes, &mut Textured { tint, texture, q, st, shift }, pixels);
        }
        None => {
            let tint = Gouraud([Row::none(); 3]);
            draw(triangles, lanes, &mut Textured { tint, texture, q, st, shift }, pixels);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::avx2::{Avx2, Planes, STRIP, Source};
    use crate::output::{PixelFormat, Rgb565, widen565};
    use crate::shade::modulate;
    use crate::texture::{Texels, Texture};

    /// Rows of texels, also where a texture repeats or its last texel is hit.
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
            let mut t = Triangles { ready: 1, ..Triangles::default() };
            (t.right[0], t.rows[0]) = (STRIP as i32, 1);
            let q = [1 << 20, 1 << 30][case / 4 % 2];
            (t.q.start[0], t.q.gx[0]) = ((1 << 24) + random(q) as i32, random(q / 16) as i32);
            for axis in 0..2 {
                (t.st[axis].start[0], t.st[axis].gx[0]) =
                    (random(1 << 30) as i32, random(1 << 26) as i32);
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
                width: STRIP as i32,
            };
            let (mut colours, mut depths) = ([0; STRIP], [u16::MAX; STRIP]);
            let mut pixels =
                Pixels { colours: &mut colours, depths: &mut depths, width: STRIP, top: 0 };
            avx2.draw(&source, &t, 0..1, &[rgb; EIGHT], &mut pixels);
            assert_eq!(depths, [0; STRIP]);
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
