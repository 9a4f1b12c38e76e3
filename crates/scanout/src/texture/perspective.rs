//! Perspective: from planes in 1/w, s/w and t/w to a texel, and the mip level that a pixel needs.
//!
//! Setup takes whole repeats off the texture coordinates, so that they are small and not negative, multiplies them by the
//! corners' 1/w and scales each of the two products by a power of two to fill 31 bits (block floating point). The planes through these
//! are lifted by what their rounding can err, `Triangle::lift`, in a frame of 320x240 at most 2^-21 of their largest value: no pixel on
//! an edge at the texture's border may fall below 0, where another column's texel lies. (Triangles that reach beyond 2048 pixels aren't.)

use super::{Filter, MAX_LEVELS, SUBTEXEL_BITS, Texels, Texture, Wrap};
use crate::features;
use crate::interpolate::Plane;
use crate::math::{NARROW, NO_DIVISION, leading_zeros, reciprocal_by_seeds, seldom};
use crate::output::widen565;
use crate::setup::Triangle;

/// A triangle's texture coordinates over w, ready for every pixel.
#[derive(Clone, Copy, Debug, Default)]
pub struct Perspective {
    /// s/w and t/w, block floating point.
    pub st: [Plane; 2],
    /// Shifts that bring `plane * r` to 1/4096 texel, rounded down: half of that is in the plane.
    pub shift: [u32; 2],
}

/// A triangle's texture coordinates, ready for every pixel of any texture.
#[derive(Clone, Copy, Debug)]
pub struct TextureSetup<'a> {
    /// The texture.
    pub texture: &'a Texture<'a>,
    /// The planes.
    pub perspective: Perspective,
    /// Whole texels of level 0 to add: what was taken off before the division to keep numbers small.
    pub base: [i32; 2],
    /// Mip thresholds: level l or more where `q < thresholds[l - 1]`; 0 beyond the last level.
    pub thresholds: [u32; MAX_LEVELS as usize - 1],
}

/// The reciprocal that all machines share: `floor((2^47 - 1) / q)` for `q` the plane's value without its 8 fraction bits,
/// at least 1.
///
/// | q | r |
/// |---|---|
/// | [1, 2^23] | [2^24 - 1, 2^47 - 1] |
#[inline(always)]
pub fn reciprocal(q: u32) -> u64 {
    if NARROW && (1 << 15..1 << 24).contains(&q) {
        if NO_DIVISION { reciprocal_by_seeds(q) as u64 } else { long_division(q) as u64 }
    } else {
        NUMERATOR / q as u64
    }
}

/// What [`reciprocal`] divides.
pub(super) const NUMERATOR: u64 = (1 << 47) - 1;

/// [`reciprocal`] for `q` in [2^15, 2^24): 23 bits of the dividend, then eight and eight, by 32-bit divisions.
#[inline(always)]
fn long_division(q: u32) -> u32 {
    let top = (1 << 23) - 1;
    let (mut r, mut rest) = (top / q, top % q);
    for _ in 0..3 {
        rest = rest << 8 | 255;
        (r, rest) = ((r << 8) | (rest / q), rest % q);
    }
    r
}

/// `product >> shift` for shifts of 28 and more.
#[inline(always)]
fn whole(product: u64, shift: u32) -> u64 {
    if NARROW && shift >= 32 {
        ((product >> 32) as u32 >> (shift - 32)) as u64
    } else {
        product >> shift
    }
}

/// The integer part of the 1/w plane's value, at least 1.
#[inline(always)]
pub fn integer_q(plane_value: u32) -> u32 {
    let q = plane_value >> 8;
    if q == 0 {
        seldom();
        return 1;
    }
    q
}

/// [`local`] for one coordinate.
#[inline(always)]
fn local_axis([a, b, c]: [i32; 3], size: u32) -> ([u64; 3], i32) {
    let repeats = a.min(b).min(c) >> 16;
    let distance = |u: i32| {
        let u = u as i64 - ((repeats as i64) << 16);
        ((u * size as i64 + 8) >> (15 - SUBTEXEL_BITS) | 1) as u64
    };
    ([distance(a), distance(b), distance(c)], repeats)
}

/// Distances in a texture of `size` from the whole repeats below the least texture coordinate, in 1/8192 texel: the nearest 1/4096
/// texel and half of one, by which a pixel's place is rounded to nearest when it is cut; odd, [1, 2^39). And those repeats.
#[inline(always)]
pub(super) fn local(uv: [[i32; 2]; 3], size: [u32; 2]) -> ([[u64; 3]; 2], [i32; 2]) {
    let [[a, d], [b, e], [c, f]] = uv;
    let ((s, s_repeats), (t, t_repeats)) =
        (local_axis([a, b, c], size[0]), local_axis([d, e, f], size[1]));
    ([s, t], [s_repeats, t_repeats])
}

/// The values of a coordinate's plane, and its shift.
#[inline(always)]
fn over_w(local: &[u64; 3], q: [u32; 3]) -> ([u32; 3], u32) {
    let [a, b, c] = [local[0] * q[0] as u64, local[1] * q[1] as u64, local[2] * q[2] as u64];
    // The largest has the leading one of all of them together.
    let over = ((a | b | c) >> 31) as u32;
    let drop = if over == 0 { 0 } else { 32 - leading_zeros(over) };
    let round = |p: u64| ((p + ((1 << drop) >> 1)) >> drop) as u32;
    ([round(a), round(b), round(c)], 48 - drop)
}

/// The planes of s/w and t/w where rounding takes no covered pixel's value below 0.
#[inline(always)]
fn lifted(triangle: &Triangle, st: [Plane; 2]) -> [Plane; 2] {
    let lift = triangle.lift();
    st.map(|plane| Plane { c: plane.c.wrapping_add(lift), ..plane })
}

impl Perspective {
    /// From the corners' places in the texture as [`local`] has them, and their 1/w (integers, the largest in [2^22, 2^23)).
    #[inline(always)]
    pub(super) fn new(
        triangle: &Triangle,
        local: &[[u64; 3]; 2],
        q: [u32; 3],
    ) -> (Perspective, bool) {
        let (values, shift) = Perspective::values(local, q);
        let (st, fit) = triangle.planes_and_fit(values);
        (Perspective { st: lifted(triangle, st), shift }, fit)
    }

    /// What the planes go through, and the shifts.
    #[inline(always)]
    pub(super) fn values(local: &[[u64; 3]; 2], q: [u32; 3]) -> ([[u32; 3]; 2], [u32; 2]) {
        let [s, t] = local;
        let ((s, s_shift), (t, t_shift)) = (over_w(s, q), over_w(t, q));
        ([s, t], [s_shift, t_shift])
    }

    /// Of a texture of `size` that repeats, with the plane of 1/w, and whether all changes a column fit 32 bits.
    #[inline(always)]
    pub(crate) fn of_repeat(
        triangle: &Triangle,
        uv: [[i32; 2]; 3],
        q: [u32; 3],
        size: [u64; 2],
    ) -> (Perspective, Plane, bool) {
        let (local, _) = local(uv, size.map(|size| size as u32));
        let ([s_values, t_values], shift) = Perspective::values(&local, q);
        let ([q, s, t], fit) = triangle.planes_and_fit([q.map(|q| q << 8), s_values, t_values]);
        (Perspective { st: lifted(triangle, [s, t]), shift }, q, fit)
    }
}

impl<'a> TextureSetup<'a> {
    /// Sets a triangle's texture up from its corners' texture coordinates (Q16.16) and 1/w (integers, the largest in
    /// [2^22, 2^23)).
    pub fn new(t: &Triangle, texture: &'a Texture<'a>, uv: [[i32; 2]; 3], q: [u32; 3]) -> Self {
        let size = [texture.width, texture.height].map(u32::from);
        let (local, repeats) = local(uv, size);
        let base = [0, 1].map(|axis: usize| match texture.wrap[axis] {
            Wrap::Repeat => 0,
            Wrap::Mirror => (repeats[axis] & 1) * size[axis] as i32,
            Wrap::Clamp | Wrap::Border => repeats[axis] * size[axis] as i32,
        });
        let thresholds = if features::ALL_TEXTURES && texture.levels > 1 {
            thresholds(t, &local, q, texture.levels)
        } else {
            [0; MAX_LEVELS as usize - 1]
        };
        TextureSetup { texture, perspective: Perspective::new(t, &local, q).0, base, thresholds }
    }

    /// Where a pixel lies in the texture, 1/4096 texel of level 0: from the values of its planes and the reciprocal of its
    /// 1/w.
    #[inline(always)]
    pub fn locate(&self, st: [u32; 2], r: u64) -> [i64; 2] {
        [0, 1].map(|i| {
            let product = (st[i] as u64).wrapping_mul(r);
            let shift = self.perspective.shift[i];
            (product >> shift) as i64 + ((self.base[i] as i64) << SUBTEXEL_BITS)
        })
    }

    /// The mip level for a pixel whose 1/w is `q`.
    #[inline(always)]
    pub fn level(&self, q: u32) -> u8 {
        if self.texture.levels == 1 {
            return 0;
        }
        self.thresholds.iter().take_while(|&&threshold| q < threshold).count() as u8
    }
}

/// A way to fetch texels: the general one, or one that knows more about its texture and gives the same.
pub trait Sampler: Copy {
    /// What it needs of a triangle.
    type Setup: Copy;
    /// Texels can be had as they are stored, RGB565.
    const RGB565: bool = false;
    /// Sets a triangle up, as [`TextureSetup::new`].
    fn setup(&self, t: &Triangle, uv: [[i32; 2]; 3], q: [u32; 3]) -> Self::Setup;
    /// The planes of a triangle.
    fn perspective(setup: &Self::Setup) -> &Perspective;
    /// The texel as it is stored, where it is RGB565; `texel` is this, widened.
    fn texel565(&self, _setup: &Self::Setup, _st: [u32; 2], _r: u64) -> u16 {
        0
    }
    /// The texel of a pixel from the values of its s/w and t/w planes, its 1/w and the reciprocal of that.
    fn texel(&self, setup: &Self::Setup, st: [u32; 2], q: u32, r: u64) -> [u8; 3];
}

/// Nearest texels of a texture that repeats and has one level, stored as RGB565 or as indices of such colours: which texel a pixel has can be
/// found in any way.
pub(crate) trait Plain: Sampler<Setup = Perspective> {
    /// Width and height.
    fn size(&self) -> [u64; 2];
    /// A texel by its number, rows from the top.
    fn stored(&self, index: usize) -> u16;
    /// A texel inside the texture.
    #[inline(always)]
    fn inside(&self, [x, y]: [u32; 2]) -> u16 {
        self.stored(y as usize * self.size()[0] as usize + x as usize)
    }
}

/// Any texture.
#[derive(Clone, Copy, Debug)]
pub struct General<'a>(pub &'a Texture<'a>);

impl<'a> Sampler for General<'a> {
    type Setup = TextureSetup<'a>;

    fn setup(&self, t: &Triangle, uv: [[i32; 2]; 3], q: [u32; 3]) -> TextureSetup<'a> {
        TextureSetup::new(t, self.0, uv, q)
    }
    #[inline(always)]
    fn perspective<'s>(setup: &'s TextureSetup<'a>) -> &'s Perspective {
        &setup.perspective
    }
    #[inline]
    fn texel(&self, setup: &TextureSetup, st: [u32; 2], q: u32, r: u64) -> [u8; 3] {
        let [s, t] = setup.locate(st, r);
        setup.texture.sample(s, t, setup.level(q))
    }
}

/// Nearest texels of an RGB565 texture that repeats and has one level, any size.
#[derive(Clone, Copy, Debug)]
pub struct Repeat565<'a> {
    pub(crate) texels: &'a [u16],
    pub(crate) size: [u64; 2],
}

impl<'a> Repeat565<'a> {
    /// `None` when the texture is not of this kind.
    pub fn new(texture: &Texture<'a>) -> Option<Self> {
        let Texels::Rgb565(texels) = texture.texels else { return None };
        let plain = texture.filter == Filter::Nearest
            && texture.levels == 1
            && texture.wrap == [Wrap::Repeat; 2];
        let size = [texture.width, texture.height].map(u64::from);
        // None beyond the last row.
        let texels = &texels[..texels.len().min(texture.level_offset(1))];
        plain.then_some(Repeat565 { texels, size })
    }

    /// Sets a triangle up, and whether all changes a column fit 32 bits.
    #[inline(always)]
    pub(crate) fn setup_and_fit(
        &self,
        t: &Triangle,
        uv: [[i32; 2]; 3],
        q: [u32; 3],
    ) -> (Perspective, bool) {
        let (local, _) = local(uv, self.size.map(|size| size as u32));
        Perspective::new(t, &local, q)
    }

    /// Sets a triangle up together with its depth and 1/w, whose planes have much in common with the texture's.
    // Once a triangle: where flash is little, a call instead of a copy for each shader.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub(crate) fn setup_with(
        &self,
        triangle: &Triangle,
        z: [u32; 3],
        uv: [[i32; 2]; 3],
        q: [u32; 3],
    ) -> ([Plane; 2], Perspective) {
        let (local, _) = local(uv, self.size.map(|size| size as u32));
        let ([s_values, t_values], shift) = Perspective::values(&local, q);
        let [z, q, s, t] = triangle.planes([z, q.map(|q| q << 8), s_values, t_values]);
        ([z, q], Perspective { st: lifted(triangle, [s, t]), shift })
    }

    /// The texel as it is stored, from the shifts of a [`Perspective`].
    #[inline(always)]
    pub(crate) fn at(&self, shift: [u32; 2], st: [u32; 2], r: u64) -> u16 {
        self.stored(texel_of_repeat(self.size, shift, st, r))
    }
}

/// Which texel a pixel has of a texture that repeats, from the shifts of a [`Perspective`].
#[inline(always)]
pub(super) fn texel_of_repeat(size: [u64; 2], shift: [u32; 2], st: [u32; 2], r: u64) -> usize {
    let [x, y] = column_and_row(size, shift, st, r);
    y * size[0] as usize + x
}

/// The texel's column and row.
#[inline(always)]
pub(super) fn column_and_row(size: [u64; 2], shift: [u32; 2], st: [u32; 2], r: u64) -> [usize; 2] {
    let axis = |i: usize| {
        let texel = whole((st[i] as u64).wrapping_mul(r), shift[i] + SUBTEXEL_BITS);
        // Whole repeats are taken off at setup: few triangles reach into the next one.
        (if texel < size[i] { texel } else { texel % size[i] }) as usize
    };
    [axis(0), axis(1)]
}

impl Plain for Repeat565<'_> {
    #[inline(always)]
    fn size(&self) -> [u64; 2] {
        self.size
    }
    #[inline(always)]
    fn stored(&self, index: usize) -> u16 {
        match self.texels.get(index) {
            Some(&texel) => texel,
            None => {
                seldom();
                0
            }
        }
    }
}

impl Sampler for Repeat565<'_> {
    type Setup = Perspective;
    const RGB565: bool = true;

    #[inline(always)]
    fn setup(&self, t: &Triangle, uv: [[i32; 2]; 3], q: [u32; 3]) -> Perspective {
        if cfg!(target_arch = "x86_64") {
            self.setup_and_fit(t, uv, q).0
        } else {
            // By code that is there.
            self.setup_with(t, [0; 3], uv, q).1
        }
    }
    #[inline(always)]
    fn perspective(setup: &Perspective) -> &Perspective {
        setup
    }
    #[inline(always)]
    fn texel565(&self, setup: &Perspective, st: [u32; 2], r: u64) -> u16 {
        self.at(setup.shift, st, r)
    }
    #[inline(always)]
    fn texel(&self, setup: &Perspective, st: [u32; 2], _q: u32, r: u64) -> [u8; 3] {
        widen565(self.texel565(setup, st, r))
    }
}

/// The mip thresholds of a triangle: `T_1 = cbrt(texture area * q0 q1 q2 / (2 screen area))`, rounded down, then each next
/// one by the factor `2^(-2/3)` = 41285 / 65536.
fn thresholds(
    t: &Triangle,
    st: &[[u64; 3]; 2],
    q: [u32; 3],
    levels: u8,
) -> [u32; MAX_LEVELS as usize - 1] {
    let d = |i: usize, axis: usize| (st[axis][i] as i128 - st[axis][0] as i128) / 2;
    // 1/2^24 texel^2 against 1/2^8 pixel^2.
    let texture_area = (d(1, 0) * d(2, 1) - d(2, 0) * d(1, 1)).unsigned_abs();
    let cube = q.iter().map(|&q| q as u128).product::<u128>();
    let scale = 1 + 2 * SUBTEXEL_BITS - 8;
    let product = texture_area.saturating_mul(cube >> 16) / ((t.area as u128) << (scale - 16));
    let mut threshold = cube_root(product);
    let mut out = [0; MAX_LEVELS as usize - 1];
    for slot in &mut out[..levels as usize - 1] {
        *slot = threshold;
        threshold = ((threshold as u64 * 41285) >> 16) as u32;
    }
    out
}

/// `min(floor(cbrt(n)), 2^25 - 1)`, one bit a step.
fn cube_root(n: u128) -> u32 {
    (0..25).rev().fold(0u32, |root, bit| {
        let tried = root | 1 << bit;
        if (tried as u128).pow(3) <= n { tried } else { root }
    })
}

#[cfg(test)]
mod tests {
    use super::super::RepeatPalette;
    use super::*;

    #[test]
    fn long_division_is_division() {
        for q in (1 << 15..1 << 24).step_by(97).chain([1 << 15, (1 << 24) - 1, 1 << 23]) {
            assert_eq!(long_division(q) as u64, ((1u64 << 47) - 1) / q as u64, "{q}");
        }
    }

    #[test]
    fn cube_roots() {
        for n in [0u128, 1, 7, 8, 26, 27, 1 << 60, (1 << 60) - 1, u128::MAX] {
            let r = cube_root(n) as u128;
            assert!(r.pow(3) <= n && ((r + 1).pow(3) > n || r == (1 << 25) - 1));
        }
    }

    /// 1/w of three distances as the vertex stage delivers it.
    fn q_of(w: [f64; 3]) -> [u32; 3] {
        let nearest = w.iter().fold(f64::MAX, |a, &b| a.min(b));
        w.map(|w| (nearest / w * ((1 << 23) - 1) as f64) as u32)
    }

    struct Case {
        v: [[i32; 2]; 3],
        uv: [[i32; 2]; 3],
        w: [f64; 3],
    }

    fn cases() -> impl Iterator<Item = Case> {
        let mut seed = 5u64;
        let mut random = move |n: u64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 33) % n
        };
        (0..400).map(move |_| Case {
            v: [(); 3].map(|()| [random(16 * 640) as i32, random(16 * 480) as i32]),
            uv: [(); 3].map(|()| [random(4 << 16) as i32 - (2 << 16), random(1 << 16) as i32]),
            w: [(); 3].map(|()| 1.0 + random(1000) as f64 / 100.0),
        })
    }

    /// Exact s, t (texels) and the area of texture a pixel covers, at the centre of pixel (x, y), in f64.
    fn exact(case: &Case, size: [f64; 2], x: f64, y: f64) -> ([f64; 2], f64) {
        let at = |x: f64, y: f64| {
            let p = [x * 16.0 + 8.0, y * 16.0 + 8.0];
            let v = case.v.map(|v| v.map(f64::from));
            let cross = |a: [f64; 2], b: [f64; 2]| {
                (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
            };
            let l = [
                cross(v[1], v[2]) / case.w[0],
                cross(v[2], v[0]) / case.w[1],
                cross(v[0], v[1]) / case.w[2],
            ];
            let sum: f64 = l.iter().sum();
            [0, 1].map(|k| {
                (0..3).map(|i| l[i] * case.uv[i][k] as f64).sum::<f64>() / sum / 65536.0 * size[k]
            })
        };
        let (a, b, c) = (at(x, y), at(x + 1e-3, y), at(x, y + 1e-3));
        let area = ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs() * 1e6;
        (a, area)
    }

    /// The faster sampler is the general one.
    #[test]
    fn samplers_agree() {
        let texels: [u16; 64 * 32] = core::array::from_fn(|i| (i * 40503) as u16);
        agree(&Texture::new(64, 32, Texels::Rgb565(&texels)).unwrap());
        agree(&Texture::new(50, 39, Texels::Rgb565(&texels)).unwrap());
        let other = Texture {
            wrap: [Wrap::Repeat, Wrap::Clamp],
            ..Texture::new(64, 32, Texels::Rgb565(&texels)).unwrap()
        };
        assert!(Repeat565::new(&other).is_none());
    }

    /// So is that of palettes.
    #[test]
    fn samplers_of_palettes_agree() {
        let indices: [u8; 50 * 39] = core::array::from_fn(|i| (i * 31) as u8);
        let palette: [u16; 256] = core::array::from_fn(|i| (i * 40503) as u16);
        let eight = Texels::Palette8 { indices: &indices, palette: &palette };
        let four = Texels::Palette4 { indices: &indices, palette: &palette[..16] };
        for (width, texels) in [(50, eight), (64, eight), (51, four)] {
            let texture = Texture::new(width, 30, texels).unwrap();
            agree_with(&texture, RepeatPalette::new(&texture).unwrap());
        }
    }

    fn agree(texture: &Texture) {
        agree_with(texture, Repeat565::new(texture).unwrap());
    }

    fn agree_with<S: Sampler>(texture: &Texture, fast: S) {
        for case in cases() {
            let Some(t) = Triangle::new(case.v) else { continue };
            let any = General(texture);
            let (setup, lean) =
                (any.setup(&t, case.uv, q_of(case.w)), fast.setup(&t, case.uv, q_of(case.w)));
            let mut value = 1u32;
            for i in 0..200u32 {
                value = value.wrapping_mul(1664525).wrapping_add(1013904223);
                let (st, q) = ([value >> 1, (value ^ i << 9) >> 1], (value >> 9).max(1));
                let r = reciprocal(q);
                assert_eq!(fast.texel(&lean, st, q, r), any.texel(&setup, st, q, r));
            }
        }
    }

    /// A pixel whose centre lies on an edge along the texture's border has a texel of that border, however the planes are rounded.
    #[test]
    fn pixels_on_the_border_have_its_texels() {
        let texels: [u16; 64 * 64] = core::array::from_fn(|i| i as u16);
        let texture = Texture::new(64, 64, Texels::Rgb565(&texels)).unwrap();
        let sampler = super::super::Repeat565::new(&texture).unwrap();
        let mut seed = 11u64;
        let mut random = |n: u64| {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((seed >> 33) % n) as i32
        };
        let mut on_edge = 0;
        for case in 0..6000 {
            // The edge from one pixel's centre to another, where u is 0, 64 repeats from the third corner.
            let [from, to] = [(); 2].map(|()| [16 * random(60) + 8, 16 * random(90) + 8]);
            let v = [from, to, [from[0] + 1 + random(3000), random(3000)]];
            let Some(t) = Triangle::new(v) else { continue };
            let uv = [0, 0, 64 << 16].map(|u| [u, random(1 << 16)]);
            let mut q = [(); 3].map(|()| (1 << 20) + random(1 << 22) as u32);
            q[case % 3] = (1 << 22) + random(1 << 22) as u32;
            let ([_, q_plane], setup) = sampler.setup_with(&t, [0; 3], uv, q);
            let steps = (to[0] - from[0]).abs().max((to[1] - from[1]).abs()) / 16;
            for step in 0..=steps {
                let on = |i: usize| {
                    let (n, d) = ((to[i] - from[i]) / 16 * step, steps.max(1));
                    (n % d == 0).then_some(from[i] / 16 + n / d)
                };
                let (Some(x), Some(y)) = (on(0), on(1)) else { continue };
                if t.covers(x, y) {
                    let st = setup.st.map(|plane| plane.at(x, y));
                    let r = reciprocal(integer_q(q_plane.at(x, y)));
                    assert_eq!(sampler.texel565(&setup, st, r) % 64, 0, "{v:?} {x} {y}");
                    on_edge += 1;
                }
            }
        }
        assert!(on_edge > 5000, "{on_edge}");
    }

    #[test]
    #[cfg_attr(not(feature = "all-textures"), ignore = "the feature all-textures is left out")]
    fn coordinates_and_levels_match_real_numbers() {
        let texels = [[0u8; 3]; 256 * 128 * 4 / 3 + 2];
        let mut texture = Texture::new(256, 128, Texels::Rgb888(&texels)).unwrap();
        (texture.levels, texture.filter) = (8, Filter::Nearest);
        let (mut worst, mut near_miss, mut pixels) = (0f64, 0, 0);
        for case in cases() {
            let Some(t) = Triangle::new(case.v) else { continue };
            let q = q_of(case.w);
            let setup = TextureSetup::new(&t, &texture, case.uv, q);
            let q_plane = t.plane(q.map(|q| q << 8));
            for y in (t.min()[1]..t.max()[1]).step_by(5) {
                for x in (t.min()[0]..t.max()[0]).step_by(5).filter(|&x| t.covers(x, y)) {
                    let q = integer_q(q_plane.at(x, y));
                    let st = setup.perspective.st.map(|plane| plane.at(x, y));
                    let ([s, _], level) = (setup.locate(st, reciprocal(q)), setup.level(q));
                    let (st, area) = exact(&case, [256.0, 128.0], x as f64, y as f64);
                    let got = s as f64 / 4096.0;
                    // Whole repeats are dropped for `Repeat`.
                    let off = (got - st[0] + 128.0).rem_euclid(256.0) - 128.0;
                    worst = worst.max(off.abs());
                    let lod = area.log2() / 2.0;
                    pixels += 1;
                    if ((lod + 0.5).floor().clamp(0.0, 7.0) - level as f64).abs() > 0.0 {
                        near_miss += 1;
                        let fraction = (lod + 0.5) - (lod + 0.5).round();
                        assert!(fraction.abs() < 0.02, "level {level} for {lod}");
                    }
                }
            }
        }
        assert!(pixels > 10_000);
        // Triangles of up to 640x480 pixels and 1024 texels, eleven times as far away at one corner as at another.
        assert!(worst < 1.0 / 500.0, "off by {worst} texel");
        assert!(near_miss * 100 < pixels, "{near_miss} of {pixels}");
    }
}
