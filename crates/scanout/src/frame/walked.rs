//! Textured fragments of runs, a pixel after another, without a division at each: for machines of 32 bits, and tile by tile.
//!
//! | way | triangles | texels |
//! |---|---|---|
//! | [`BySteps`] | at most 32 pixels wide and high | [`Across`] the triangle |
//! | [`ByRows`] | all | [`Along`] the rows |
//!
//! Where a texel isn't certain either asks the definition, so pixels are [`Textured`](super::fragment::Textured)'s.

use core::cell::OnceCell;

use super::fragment::Shader;
use crate::interpolate::Plane;
use crate::output::{PixelFormat, widen565};
use crate::setup::Triangle;
use crate::shade::modulate;
use crate::texture::{Across, Along, Block, Perspective, Plain};

/// Another shader's colour times a texel, which comes by a [`Way`] where it is certain.
pub(super) struct Walked<S, T, W> {
    pub inner: S,
    pub sampler: T,
    pub way: W,
}

/// A triangle's way through a plain texture.
pub(super) trait Way {
    /// Only small triangles go this way, and each run in one block.
    const SMALL: bool = false;
    /// The pixels of a run.
    type Block: Walk;
    /// How many pixels a block may have.
    fn longest(&self) -> i32;
    /// The `count` pixels from (x, y) on.
    fn block(&self, x: i32, y: i32, count: u32) -> Self::Block;
    /// The texel by the definition.
    fn texel(&self, x: i32, y: i32) -> Option<[u32; 2]>;
}

/// Pixels of a run, one after another.
pub(super) trait Walk: Copy {
    /// To the next pixel.
    fn step(&mut self);
    /// The texel, if it is certain.
    fn texel(&self) -> Option<[u32; 2]>;
}

impl<const FRACTION: u32> Walk for Block<FRACTION> {
    #[inline(always)]
    fn step(&mut self) {
        self.step();
    }
    #[inline(always)]
    fn texel(&self) -> Option<[u32; 2]> {
        self.texel()
    }
}

/// [`Along`] the rows.
pub(super) struct ByRows {
    setup: Perspective,
    q: Plane,
    along: Along,
    size: [u64; 2],
}

impl ByRows {
    /// From three corners' texture coordinates and 1/w.
    // Once a triangle: where flash is little, a call instead of a copy for each shader.
    #[cfg_attr(target_arch = "x86_64", inline(always))]
    #[cfg_attr(not(target_arch = "x86_64"), inline(never))]
    pub(super) fn new(t: &Triangle, size: [u64; 2], uv: [[i32; 2]; 3], q: [u32; 3]) -> ByRows {
        let (setup, plane, fit) = Perspective::of_repeat(t, uv, q, size);
        let along = Along::new(&setup, &plane, q, size.map(|size| size as u32), fit);
        ByRows { setup, q: plane, along, size }
    }

    #[inline(always)]
    fn one(&self, x: i32, y: i32) -> Block<21> {
        let [s, t] = &self.setup.st;
        Block::one(&self.setup, self.size, self.q.at(x, y), [s.at(x, y), t.at(x, y)])
    }
}

impl Way for ByRows {
    type Block = Block<21>;

    #[inline(always)]
    fn longest(&self) -> i32 {
        self.along.length() as i32
    }
    #[inline(always)]
    fn block(&self, x: i32, y: i32, count: u32) -> Block<21> {
        // A block costs as much as two pixels of the definition.
        if count < 2 {
            return self.one(x, y);
        }
        let [s, t] = &self.setup.st;
        self.along.block(self.q.at(x, y), [s.at(x, y), t.at(x, y)], count)
    }
    #[cold]
    #[inline(never)]
    fn texel(&self, x: i32, y: i32) -> Option<[u32; 2]> {
        self.one(x, y).texel()
    }
}

/// [`Across`] the triangle.
pub(super) struct BySteps<'a> {
    pub across: &'a Across,
    pub triangle: &'a Triangle,
    pub uv: [[i32; 2]; 3],
    pub q: [u32; 3],
    pub size: [u64; 2],
    /// Made when a texel is uncertain.
    pub rows: &'a OnceCell<ByRows>,
}

impl Way for BySteps<'_> {
    const SMALL: bool = true;
    type Block = Block<22>;

    #[inline(always)]
    fn longest(&self) -> i32 {
        i32::MAX
    }
    #[inline(always)]
    fn block(&self, x: i32, y: i32, _count: u32) -> Block<22> {
        self.across.block(x, y)
    }
    #[cold]
    #[inline(never)]
    fn texel(&self, x: i32, y: i32) -> Option<[u32; 2]> {
        self.across.closer(x, y).or_else(|| {
            let rows = || ByRows::new(self.triangle, self.size, self.uv, self.q);
            self.rows.get_or_init(rows).texel(x, y)
        })
    }
}

impl<S: Shader, T: Plain, W: Way> Walked<S, T, W> {
    #[inline(always)]
    fn texel(&self, block: &W::Block, x: i32, y: i32) -> u16 {
        match block.texel() {
            Some(texel) => self.sampler.inside(texel),
            None => self.uncertain(x, y),
        }
    }

    #[cold]
    #[inline(never)]
    fn uncertain(&self, x: i32, y: i32) -> u16 {
        self.sampler.inside(self.way.texel(x, y).unwrap_or_default())
    }
}

impl<S: Shader, T: Plain, W: Way> Shader for Walked<S, T, W> {
    /// The inner shader's, the block and the place.
    type Pixel = (S::Pixel, W::Block, i32, i32);
    type Ramps = ();
    const IN_BLOCKS: bool = true;
    const SMALL: bool = W::SMALL;

    #[inline(always)]
    fn at(&self, x: i32, y: i32) -> Self::Pixel {
        self.begin(x, y, 1)
    }
    #[inline(always)]
    fn begin(&self, x: i32, y: i32, count: i32) -> Self::Pixel {
        let block = self.way.block(x, y, count as u32);
        (self.inner.at(x, y), block, x, y)
    }
    #[inline(always)]
    fn longest(&self) -> i32 {
        self.way.longest()
    }
    #[inline(always)]
    fn step(&self, (inner, mut block, x, y): Self::Pixel, count: u32) -> Self::Pixel {
        for _ in 0..count {
            block.step();
        }
        (self.inner.step(inner, count), block, x + count as i32, y)
    }
    #[inline(always)]
    fn down(&self, (_, _, x, y): Self::Pixel) -> Self::Pixel {
        self.at(x, y + 1)
    }
    #[inline(always)]
    fn colour(&self, (inner, block, x, y): &Self::Pixel) -> [u8; 3] {
        modulate(widen565(self.texel(block, *x, *y)), self.inner.colour(inner))
    }
    #[inline(always)]
    fn encoded<F: PixelFormat>(&self, (inner, block, x, y): &Self::Pixel) -> F::Pixel {
        self.inner.tint::<F>(inner, self.texel(block, *x, *y))
    }
    fn ramps(&self) {}
}
