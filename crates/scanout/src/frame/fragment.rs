//! Fragments: the colour of each covered pixel, from constants, planes, texels and per-pixel light.
//!
//! A [`Shader`] gives the state of a pixel from its place, [`Shader::at`], and from its left neighbour, [`Shader::step`]. Stepping
//! adds a gradient modulo 2^32, which is exactly the plane's value at the next pixel; a row always begins from the plane,
//! so nothing remembers where it has been.

use crate::interpolate::Plane;
use crate::lanes::{LANES, U16x8, U32x8};
use crate::light::Lighting;
use crate::math::normalise_q14;
use crate::output::PixelFormat;
use crate::setup::Triangle;
use crate::shade::{FogWeights, Tint, blend, modulate};
use crate::texture::{Sampler, integer_q, reciprocal};

/// Colours of fragments.
pub(super) trait Shader {
    /// The attributes of a pixel.
    type Pixel: Copy;
    /// What eight pixels side by side share over the whole triangle.
    type Ramps: Copy;
    /// Every fragment has the same colour.
    const CONSTANT: bool = false;
    /// Runs are drawn in blocks.
    const IN_BLOCKS: bool = false;
    /// Triangles' boxes are at most 32 pixels wide and high.
    const SMALL: bool = false;
    /// Can give eight colours at a time.
    const SIDE_BY_SIDE: bool = false;

    /// The attributes at (x, y).
    fn at(&self, x: i32, y: i32) -> Self::Pixel;
    /// The same, where a run of `count` pixels, at most [`longest`](Self::longest), begins.
    #[inline(always)]
    fn begin(&self, x: i32, y: i32, _count: i32) -> Self::Pixel {
        self.at(x, y)
    }
    /// Only so many pixels may follow from one [`begin`](Self::begin), where there are blocks.
    #[inline(always)]
    fn longest(&self) -> i32 {
        i32::MAX
    }
    /// Those `count` pixels further right.
    fn step(&self, pixel: Self::Pixel, count: u32) -> Self::Pixel;
    /// Those one row down.
    fn down(&self, pixel: Self::Pixel) -> Self::Pixel;
    /// A pixel's colour.
    fn colour(&self, pixel: &Self::Pixel) -> [u8; 3];
    /// A pixel's colour in its format, without dither.
    #[inline(always)]
    fn encoded<F: PixelFormat>(&self, pixel: &Self::Pixel) -> F::Pixel {
        F::encode(self.colour(pixel))
    }
    /// A texel times the pixel's colour, without dither.
    #[inline(always)]
    fn tint<F: PixelFormat>(&self, pixel: &Self::Pixel, texel: u16) -> F::Pixel {
        F::modulate565(texel, self.colour(pixel))
    }

    /// Prepares for eight colours at a time.
    fn ramps(&self) -> Self::Ramps;
    /// The colours of a pixel and the next seven to the right, channel by channel; only those whose bit in `pass` is set
    /// need be right.
    fn side_by_side(&self, _: &Self::Ramps, _: &Self::Pixel, _pass: u32) -> [U16x8; 3] {
        [U16x8::splat(0); 3]
    }
}

/// The value of a plane `count` pixels further right.
#[inline(always)]
fn step(plane: &Plane, value: u32, count: u32) -> u32 {
    value.wrapping_add(plane.gx.wrapping_mul(count))
}

/// The value of a plane one row down.
#[inline(always)]
fn down(plane: &Plane, value: u32) -> u32 {
    value.wrapping_add(plane.gy)
}

/// One colour.
pub(super) struct Flat(pub [u8; 3]);

impl Shader for Flat {
    type Pixel = ();
    type Ramps = ();
    const CONSTANT: bool = true;
    const SIDE_BY_SIDE: bool = true;

    #[inline(always)]
    fn at(&self, _x: i32, _y: i32) {}
    #[inline(always)]
    fn step(&self, _: (), _count: u32) {}
    #[inline(always)]
    fn down(&self, _: ()) {}
    #[inline(always)]
    fn colour(&self, _: &()) -> [u8; 3] {
        self.0
    }
    #[inline(always)]
    fn ramps(&self) {}
    #[inline(always)]
    fn side_by_side(&self, _: &(), _: &(), _pass: u32) -> [U16x8; 3] {
        self.0.map(|c| U16x8::splat(c as u16))
    }
}

/// One colour that is prepared to tint texels.
pub(super) struct Tinted<T> {
    pub rgb: [u8; 3],
    pub tint: T,
}

impl<T: Tint> Shader for Tinted<T> {
    type Pixel = ();
    type Ramps = ();
    const SIDE_BY_SIDE: bool = true;

    #[inline(always)]
    fn at(&self, _x: i32, _y: i32) {}
    #[inline(always)]
    fn step(&self, _: (), _count: u32) {}
    #[inline(always)]
    fn down(&self, _: ()) {}
    #[inline(always)]
    fn colour(&self, _: &()) -> [u8; 3] {
        self.rgb
    }
    #[inline(always)]
    fn tint<F: PixelFormat>(&self, _: &(), texel: u16) -> F::Pixel {
        F::tint(&self.tint, texel, self.rgb)
    }
    #[inline(always)]
    fn ramps(&self) {}
    #[inline(always)]
    fn side_by_side(&self, _: &(), _: &(), _pass: u32) -> [U16x8; 3] {
        self.rgb.map(|c| U16x8::splat(c as u16))
    }
}

/// Colours interpolated linearly on the screen; half a level is added to the planes, so that the whole levels of their values
/// are rounded to nearest.
pub(super) struct Gouraud([Plane; 3]);

impl Gouraud {
    pub(super) fn new(t: &Triangle, rgb: [[u8; 3]; 3]) -> Gouraud {
        Gouraud::of(t.planes(Gouraud::values(rgb)))
    }
    /// What its planes go through.
    #[inline(always)]
    pub(super) fn values(rgb: [[u8; 3]; 3]) -> [[u32; 3]; 3] {
        [0, 1, 2].map(|i: usize| rgb.map(|rgb| (rgb[i] as u32) << 16))
    }
    /// From planes through its [`values`](Self::values).
    #[inline(always)]
    pub(super) fn of(planes: [Plane; 3]) -> Gouraud {
        Gouraud(planes.map(|plane| Plane { c: plane.c.wrapping_add(0x8000), ..plane }))
    }
}

impl Shader for Gouraud {
    type Pixel = [u32; 3];
    type Ramps = [U32x8; 3];
    const SIDE_BY_SIDE: bool = true;

    #[inline(always)]
    fn at(&self, x: i32, y: i32) -> [u32; 3] {
        [0, 1, 2].map(|i: usize| self.0[i].at(x, y))
    }
    #[inline(always)]
    fn step(&self, pixel: [u32; 3], count: u32) -> [u32; 3] {
        [0, 1, 2].map(|i| step(&self.0[i], pixel[i], count))
    }
    #[inline(always)]
    fn down(&self, pixel: [u32; 3]) -> [u32; 3] {
        [0, 1, 2].map(|i| down(&self.0[i], pixel[i]))
    }
    #[inline(always)]
    fn colour(&self, pixel: &[u32; 3]) -> [u8; 3] {
        pixel.map(|value| (value >> 16) as u8)
    }
    #[inline(always)]
    fn ramps(&self) -> [U32x8; 3] {
        [0, 1, 2].map(|i: usize| U32x8::ramp(0, self.0[i].gx))
    }
    #[inline(always)]
    fn side_by_side(&self, ramps: &[U32x8; 3], pixel: &[u32; 3], _pass: u32) -> [U16x8; 3] {
        let byte = U16x8::splat(0xff);
        [0, 1, 2].map(|i: usize| U32x8::splat(pixel[i]).add(ramps[i]).high().and(byte))
    }
}

/// Another shader's colour times a texel.
pub(super) struct Textured<S, T: Sampler> {
    pub inner: S,
    pub sampler: T,
    pub setup: T::Setup,
    pub q: Plane,
}

impl<S: Shader, T: Sampler> Textured<S, T> {
    /// From three corners' texture coordinates and 1/w.
    #[inline(always)]
    pub(super) fn new(t: &Triangle, inner: S, sampler: T, uv: [[i32; 2]; 3], q: [u32; 3]) -> Self {
        Textured { inner, sampler, setup: sampler.setup(t, uv, q), q: t.plane(q.map(|q| q << 8)) }
    }
}

impl<S: Shader, T: Sampler> Shader for Textured<S, T> {
    /// The inner shader's, 1/w, s/w and t/w.
    type Pixel = (S::Pixel, u32, u32, u32);
    type Ramps = (S::Ramps, [U32x8; 3]);
    const SIDE_BY_SIDE: bool = S::SIDE_BY_SIDE && T::RGB565;

    #[inline(always)]
    fn at(&self, x: i32, y: i32) -> Self::Pixel {
        let [s, t] = &T::perspective(&self.setup).st;
        (self.inner.at(x, y), self.q.at(x, y), s.at(x, y), t.at(x, y))
    }
    #[inline(always)]
    fn step(&self, (inner, q, s, t): Self::Pixel, count: u32) -> Self::Pixel {
        let [ds, dt] = &T::perspective(&self.setup).st;
        let inner = self.inner.step(inner, count);
        (inner, step(&self.q, q, count), step(ds, s, count), step(dt, t, count))
    }
    #[inline(always)]
    fn down(&self, (inner, q, s, t): Self::Pixel) -> Self::Pixel {
        let [ds, dt] = &T::perspective(&self.setup).st;
        (self.inner.down(inner), down(&self.q, q), down(ds, s), down(dt, t))
    }
    #[inline(always)]
    fn colour(&self, (inner, q, s, t): &Self::Pixel) -> [u8; 3] {
        let q = integer_q(*q);
        let texel = self.sampler.texel(&self.setup, [*s, *t], q, reciprocal(q));
        modulate(texel, self.inner.colour(inner))
    }
    #[inline(always)]
    fn encoded<F: PixelFormat>(&self, (inner, q, s, t): &Self::Pixel) -> F::Pixel {
        let q = integer_q(*q);
        if T::RGB565 {
            let texel = self.sampler.texel565(&self.setup, [*s, *t], reciprocal(q));
            self.inner.tint::<F>(inner, texel)
        } else {
            let texel = self.sampler.texel(&self.setup, [*s, *t], q, reciprocal(q));
            F::encode(modulate(texel, self.inner.colour(inner)))
        }
    }
    #[inline(always)]
    fn ramps(&self) -> Self::Ramps {
        let [s, t] = &T::perspective(&self.setup).st;
        (self.inner.ramps(), [&self.q, s, t].map(|plane| U32x8::ramp(0, plane.gx)))
    }
    #[inline(always)]
    fn side_by_side(&self, ramps: &Self::Ramps, pixel: &Self::Pixel, pass: u32) -> [U16x8; 3] {
        let (ramps, own) = ramps;
        let (inner, q, s, t) = *pixel;
        let lanes = |value: u32, ramp: U32x8| U32x8::splat(value).add(ramp).to_array();
        let (q, s, t) = (lanes(q, own[0]), lanes(s, own[1]), lanes(t, own[2]));
        let mut texels = [0; LANES];
        let mut rest = pass;
        while rest != 0 {
            let i = rest.trailing_zeros() as usize & (LANES - 1);
            let r = reciprocal(integer_q(q[i]));
            texels[i] = self.sampler.texel565(&self.setup, [s[i], t[i]], r);
            rest &= rest - 1;
        }
        let (colours, p) = (self.inner.side_by_side(ramps, &inner, pass), U16x8::load(&texels));
        // The same as `widen565` and `modulate`, in eight lanes.
        let (r, g) = (p.shr::<11>(), p.shr::<5>().and(U16x8::splat(63)));
        let b = p.and(U16x8::splat(31));
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
}

/// Three signed attributes divided by w, block floating point: `value = (plane - 2^31) r / 2^shift`.
pub(super) struct Signed {
    planes: [Plane; 3],
    shift: u32,
}

impl Signed {
    /// From three corners' values, |value| <= 2^30, and their 1/w (integers, the largest in [2^22, 2^23)).
    pub(super) fn new(t: &Triangle, values: [[i32; 3]; 3], q: [u32; 3]) -> Signed {
        let product = |k: usize, i: usize| values[k][i] as i64 * q[k] as i64;
        let largest = (0..9).map(|j| product(j / 3, j % 3).unsigned_abs()).max().unwrap_or(0);
        let drop = (64 - largest.leading_zeros()).saturating_sub(30);
        let planes = [0, 1, 2].map(|i| {
            let biased = |k: usize| ((product(k, i) >> drop) + (1 << 31)) as u32;
            t.plane([0, 1, 2].map(biased))
        });
        Signed { planes, shift: 47 - drop }
    }
    #[inline(always)]
    fn at(&self, x: i32, y: i32) -> [u32; 3] {
        [0, 1, 2].map(|i: usize| self.planes[i].at(x, y))
    }
    #[inline(always)]
    fn step(&self, values: [u32; 3], count: u32) -> [u32; 3] {
        [0, 1, 2].map(|i| step(&self.planes[i], values[i], count))
    }
    #[inline(always)]
    fn down(&self, values: [u32; 3]) -> [u32; 3] {
        [0, 1, 2].map(|i| down(&self.planes[i], values[i]))
    }
    #[inline(always)]
    fn value(&self, values: [u32; 3], r: u64) -> [i32; 3] {
        over_w(values)
            .map(|v| ((v as i128 * r as i128) >> self.shift).clamp(-(1 << 30), 1 << 30) as i32)
    }
}

/// Signed plane values without their bias.
#[inline(always)]
fn over_w(values: [u32; 3]) -> [i32; 3] {
    values.map(|v| v.wrapping_sub(1 << 31) as i32)
}

/// Light at every pixel: normals and positions interpolated in perspective. The direction of a normal needs no division by
/// 1/w.
pub(super) struct Phong<'a, S> {
    pub surface: S,
    pub lighting: &'a Lighting,
    pub normal: Signed,
    pub position: Signed,
    pub q: Plane,
}

impl<S: Shader> Shader for Phong<'_, S> {
    /// The surface's, 1/w, normal/w and position/w.
    type Pixel = (S::Pixel, u32, [u32; 3], [u32; 3]);
    type Ramps = ();

    #[inline(always)]
    fn at(&self, x: i32, y: i32) -> Self::Pixel {
        (self.surface.at(x, y), self.q.at(x, y), self.normal.at(x, y), self.position.at(x, y))
    }
    #[inline(always)]
    fn step(&self, (surface, q, normal, position): Self::Pixel, count: u32) -> Self::Pixel {
        let (normal, position) =
            (self.normal.step(normal, count), self.position.step(position, count));
        (self.surface.step(surface, count), step(&self.q, q, count), normal, position)
    }
    #[inline(always)]
    fn down(&self, (surface, q, normal, position): Self::Pixel) -> Self::Pixel {
        let (normal, position) = (self.normal.down(normal), self.position.down(position));
        (self.surface.down(surface), down(&self.q, q), normal, position)
    }
    fn colour(&self, (surface, q, normal, position): &Self::Pixel) -> [u8; 3] {
        let n = normalise_q14(over_w(*normal));
        // Where it falls is only asked for when light depends on it: that costs a division.
        let mut p = [0; 3];
        if self.lighting.needs_position() {
            p = self.position.value(*position, reciprocal(integer_q(*q)));
        }
        self.lighting.lit(self.surface.colour(surface), n, p)
    }
    fn ramps(&self) {}
}

/// Another shader's colour behind fog.
pub(super) struct Fogged<'a, S> {
    pub inner: S,
    pub fog: &'a FogWeights,
    pub q: Plane,
    /// `w = r 2^-shift` in U16.16 world units.
    pub shift: i32,
}

impl<S: Shader> Shader for Fogged<'_, S> {
    /// The inner shader's and 1/w.
    type Pixel = (S::Pixel, u32);
    type Ramps = ();

    #[inline(always)]
    fn at(&self, x: i32, y: i32) -> Self::Pixel {
        (self.inner.at(x, y), self.q.at(x, y))
    }
    #[inline(always)]
    fn step(&self, (inner, q): Self::Pixel, count: u32) -> Self::Pixel {
        (self.inner.step(inner, count), step(&self.q, q, count))
    }
    #[inline(always)]
    fn down(&self, (inner, q): Self::Pixel) -> Self::Pixel {
        (self.inner.down(inner), down(&self.q, q))
    }
    #[inline(always)]
    fn colour(&self, (inner, q): &Self::Pixel) -> [u8; 3] {
        let w = distance(reciprocal(integer_q(*q)), self.shift);
        blend(self.inner.colour(inner), self.fog.colour, self.fog.weight(w))
    }
    fn ramps(&self) {}
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
