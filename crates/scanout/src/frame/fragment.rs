//! Fragments: the colour of each covered pixel, from constants, planes, texels and per-pixel light.
//!
//! A [`Shader`] is placed at a pixel and stepped to the right. Stepping adds a gradient modulo 2^32, which is exactly the
//! plane's value at the next pixel; a row always begins from the plane, so no shader remembers where it has been.

use crate::interpolate::{Plane, channel};
use crate::lanes::{LANES, U16x8, U32x8};
use crate::light::Lighting;
use crate::math::normalise_q14;
use crate::setup::Triangle;
use crate::shade::{FogWeights, blend, modulate};
use crate::texture::{Sampler, TextureSetup, integer_q, reciprocal};

/// Colours of fragments along a row.
pub(super) trait Shader {
    /// Every fragment has the same colour.
    const CONSTANT: bool = false;
    /// Can give eight colours at a time.
    const SIDE_BY_SIDE: bool = false;
    /// What eight colours share over the whole triangle.
    type Ramps: Copy;
    /// Prepares for eight colours at a time.
    fn ramps(&self) -> Self::Ramps;
    /// The colours here and of the next seven pixels to the right, channel by channel; only those whose bit in `pass` is
    /// set need be right.
    fn side_by_side(&self, _ramps: &Self::Ramps, _pass: u32) -> [U16x8; 3] {
        [U16x8::splat(0); 3]
    }
    /// Goes eight pixels to the right.
    fn step_eight(&mut self) {}
    /// Goes to pixel (x, y).
    fn place(&mut self, x: i32, y: i32);
    /// Goes one pixel to the right.
    fn step(&mut self);
    /// The colour here.
    fn colour(&self) -> [u8; 3];
}

/// A plane that walks along a row.
#[derive(Clone, Copy, Default)]
pub(super) struct Walk {
    plane: Plane,
    value: u32,
}

impl Walk {
    pub(super) fn new(plane: Plane) -> Walk {
        Walk { plane, value: 0 }
    }
    #[inline(always)]
    fn place(&mut self, x: i32, y: i32) {
        self.value = self.plane.at(x, y);
    }
    #[inline(always)]
    fn step(&mut self) {
        self.value = self.value.wrapping_add(self.plane.gx);
    }
    #[inline(always)]
    fn step_eight(&mut self) {
        self.value = self.value.wrapping_add(self.plane.gx.wrapping_mul(LANES as u32));
    }
}

/// One colour.
pub(super) struct Flat(pub [u8; 3]);

impl Shader for Flat {
    type Ramps = ();
    fn ramps(&self) {}
    const CONSTANT: bool = true;
    const SIDE_BY_SIDE: bool = true;
    #[inline(always)]
    fn side_by_side(&self, _ramps: &(), _pass: u32) -> [U16x8; 3] {
        self.0.map(|c| U16x8::splat(c as u16))
    }
    #[inline(always)]
    fn place(&mut self, _x: i32, _y: i32) {}
    #[inline(always)]
    fn step(&mut self) {}
    #[inline(always)]
    fn colour(&self) -> [u8; 3] {
        self.0
    }
}

/// Colours interpolated linearly on the screen.
pub(super) struct Gouraud([Walk; 3]);

impl Gouraud {
    pub(super) fn new(t: &Triangle, rgb: [[u8; 3]; 3]) -> Gouraud {
        Gouraud(
            [0, 1, 2]
                .map(|i| Walk::new(t.plane([0, 1, 2].map(|k: usize| (rgb[k][i] as u32) << 16)))),
        )
    }
}

impl Shader for Gouraud {
    const SIDE_BY_SIDE: bool = true;
    type Ramps = [U32x8; 3];
    #[inline(always)]
    fn ramps(&self) -> [U32x8; 3] {
        self.0.map(|walk| U32x8::ramp(0x8000, walk.plane.gx))
    }
    #[inline(always)]
    fn side_by_side(&self, ramps: &[U32x8; 3], _pass: u32) -> [U16x8; 3] {
        let byte = U16x8::splat(0xff);
        [0, 1, 2].map(|i| U32x8::splat(self.0[i].value).add(ramps[i]).high().and(byte))
    }
    #[inline(always)]
    fn step_eight(&mut self) {
        self.0.iter_mut().for_each(Walk::step_eight);
    }
    #[inline(always)]
    fn place(&mut self, x: i32, y: i32) {
        self.0.iter_mut().for_each(|w| w.place(x, y));
    }
    #[inline(always)]
    fn step(&mut self) {
        self.0.iter_mut().for_each(Walk::step);
    }
    #[inline(always)]
    fn colour(&self) -> [u8; 3] {
        [0, 1, 2].map(|i| channel(self.0[i].value))
    }
}

/// Another shader's colour times a texel.
pub(super) struct Textured<'a, S, T> {
    inner: S,
    sampler: T,
    setup: TextureSetup<'a>,
    q: Walk,
    st: [Walk; 2],
}

impl<'a, S, T> Textured<'a, S, T> {
    pub(super) fn new(inner: S, sampler: T, setup: TextureSetup<'a>, q: Plane) -> Self {
        Textured { inner, sampler, setup, q: Walk::new(q), st: setup.st.map(Walk::new) }
    }
}

impl<S: Shader, T: Sampler> Shader for Textured<'_, S, T> {
    type Ramps = S::Ramps;
    #[inline(always)]
    fn ramps(&self) -> S::Ramps {
        self.inner.ramps()
    }
    const SIDE_BY_SIDE: bool = S::SIDE_BY_SIDE && T::RGB565;
    #[inline(always)]
    fn side_by_side(&self, ramps: &S::Ramps, pass: u32) -> [U16x8; 3] {
        let mut texels = [0; LANES];
        let mut rest = pass;
        while rest != 0 {
            let i = rest.trailing_zeros();
            let at = |walk: &Walk| walk.value.wrapping_add(walk.plane.gx.wrapping_mul(i));
            let q = integer_q(at(&self.q));
            let st = [at(&self.st[0]), at(&self.st[1])];
            texels[i as usize & 7] = self.sampler.texel565(&self.setup, st, reciprocal(q));
            rest &= rest - 1;
        }
        let (colours, p) = (self.inner.side_by_side(ramps, pass), U16x8::load(&texels));
        // The same as `widen565` and `modulate`, in eight lanes.
        let (r, g, b) =
            (p.shr::<11>(), p.shr::<5>().and(U16x8::splat(63)), p.and(U16x8::splat(31)));
        let wide = [
            r.shl::<3>().or(r.shr::<2>()),
            g.shl::<2>().or(g.shr::<4>()),
            b.shl::<3>().or(b.shr::<2>()),
        ];
        [0, 1, 2].map(|i| {
            let t = wide[i].mul(colours[i]).add(U16x8::splat(128));
            t.add(t.shr::<8>()).shr::<8>()
        })
    }
    #[inline(always)]
    fn step_eight(&mut self) {
        self.inner.step_eight();
        self.q.step_eight();
        self.st.iter_mut().for_each(Walk::step_eight);
    }
    #[inline(always)]
    fn place(&mut self, x: i32, y: i32) {
        self.inner.place(x, y);
        self.q.place(x, y);
        self.st.iter_mut().for_each(|w| w.place(x, y));
    }
    #[inline(always)]
    fn step(&mut self) {
        self.inner.step();
        self.q.step();
        self.st.iter_mut().for_each(Walk::step);
    }
    #[inline(always)]
    fn colour(&self) -> [u8; 3] {
        let q = integer_q(self.q.value);
        let st = [self.st[0].value, self.st[1].value];
        modulate(self.sampler.texel(&self.setup, st, q, reciprocal(q)), self.inner.colour())
    }
}

/// Three signed attributes divided by w, block floating point: `value = (plane - 2^31) r / 2^shift`.
pub(super) struct Signed {
    walks: [Walk; 3],
    shift: u32,
}

impl Signed {
    /// From three corners' values, |value| <= 2^30, and their 1/w (integers, the largest in [2^22, 2^23)).
    pub(super) fn new(t: &Triangle, values: [[i32; 3]; 3], q: [u32; 3]) -> Signed {
        let product = |k: usize, i: usize| values[k][i] as i64 * q[k] as i64;
        let largest = (0..9).map(|j| product(j / 3, j % 3).unsigned_abs()).max().unwrap_or(0);
        let drop = (64 - largest.leading_zeros()).saturating_sub(30);
        let walks = [0, 1, 2].map(|i| {
            let biased = |k: usize| ((product(k, i) >> drop) + (1 << 31)) as u32;
            Walk::new(t.plane([0, 1, 2].map(biased)))
        });
        Signed { walks, shift: 47 - drop }
    }
    #[inline(always)]
    fn over_w(&self) -> [i32; 3] {
        [0, 1, 2].map(|i| self.walks[i].value.wrapping_sub(1 << 31) as i32)
    }
    #[inline(always)]
    fn value(&self, r: u64) -> [i32; 3] {
        self.over_w()
            .map(|v| ((v as i128 * r as i128) >> self.shift).clamp(-(1 << 30), 1 << 30) as i32)
    }
}

/// Light at every pixel: normals and positions interpolated in perspective. The direction of a normal needs no
/// division by 1/w.
pub(super) struct Phong<'a, S> {
    pub surface: S,
    pub lighting: &'a Lighting,
    pub normal: Signed,
    pub position: Signed,
    pub q: Walk,
}

impl<S: Shader> Shader for Phong<'_, S> {
    type Ramps = ();
    fn ramps(&self) {}
    #[inline(always)]
    fn place(&mut self, x: i32, y: i32) {
        self.surface.place(x, y);
        self.q.place(x, y);
        self.normal.walks.iter_mut().chain(&mut self.position.walks).for_each(|w| w.place(x, y));
    }
    #[inline(always)]
    fn step(&mut self) {
        self.surface.step();
        self.q.step();
        self.normal.walks.iter_mut().chain(&mut self.position.walks).for_each(Walk::step);
    }
    fn colour(&self) -> [u8; 3] {
        let r = reciprocal(integer_q(self.q.value));
        let n = normalise_q14(self.normal.over_w());
        self.lighting.lit(self.surface.colour(), n, self.position.value(r))
    }
}

/// Another shader's colour behind fog.
pub(super) struct Fogged<'a, S> {
    pub inner: S,
    pub fog: &'a FogWeights,
    pub q: Walk,
    /// `w = r 2^-shift` in U16.16 world units.
    pub shift: i32,
}

impl<S: Shader> Shader for Fogged<'_, S> {
    type Ramps = ();
    fn ramps(&self) {}
    #[inline(always)]
    fn place(&mut self, x: i32, y: i32) {
        self.inner.place(x, y);
        self.q.place(x, y);
    }
    #[inline(always)]
    fn step(&mut self) {
        self.inner.step();
        self.q.step();
    }
    #[inline(always)]
    fn colour(&self) -> [u8; 3] {
        let w = distance(reciprocal(integer_q(self.q.value)), self.shift);
        blend(self.inner.colour(), self.fog.colour, self.fog.weight(w))
    }
}

/// `r 2^-shift`, saturating.
pub(super) fn distance(r: u64, shift: i32) -> u32 {
    let w = match shift {
        0..64 => r >> shift,
        64.. => 0,
        ..0 if r.leading_zeros() as i32 > -shift => r << -shift,
        _ => u64::MAX,
    };
    w.min(u32::MAX as u64) as u32
}
