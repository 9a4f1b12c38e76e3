//! Targets: colour and depth memory of some rows, and what is done with a fragment when it gets there.

use core::ops::Range;

use super::Traversal;
use super::fragment::Shader;
use crate::avx2::{self, Avx2, EIGHT, Pixels, STRIP};
use crate::depth;
use crate::features;
use crate::interpolate::Plane;
use crate::lanes::{self, LANES, U16x8, U32x8};
use crate::math::NARROW;
use crate::memory;
use crate::output::{PixelFormat, Rgb565};
use crate::raster::line::{ClipRect, Field, LineEnd, fill_cells};
use crate::raster::small;
use crate::raster::triangle::{Run, Runs, tiles};
use crate::scene::Background;
use crate::setup::{Edge, Triangle};
use crate::shade::blend;
use crate::texture::{Packed, Repeat565};
use crate::transform::Vertex;

/// Pixels of a triangle's box, as far as it is drawn, that are worth tables for its tint.
const ENOUGH: i64 = 512;

/// Eight neighbours in memory.
#[inline(always)]
fn eight_at(memory: &mut [u16], at: usize) -> Option<&mut [u16; LANES]> {
    memory.get_mut(at..at + LANES)?.first_chunk_mut()
}

/// Writes those of eight fragments that pass.
#[inline(always)]
fn write_eight<S: Shader>(
    shader: &S,
    ramps: &S::Ramps,
    pixel: &S::Pixel,
    pass: U16x8,
    depth: U16x8,
    depths: &mut [u16; LANES],
    colours: &mut [u16; LANES],
) {
    let bits = pass.bits();
    if bits == 0 {
        return;
    }
    pass.select(depth, U16x8::load(depths)).store(depths);
    let [r, g, b] = shader.side_by_side(ramps, pixel, bits);
    let r = r.and(U16x8::splat(0xf8)).shl::<8>();
    let g = g.and(U16x8::splat(0xfc)).shl::<3>();
    let rgb = r.or(g).or(b.shr::<3>());
    pass.select(rgb, U16x8::load(colours)).store(colours);
}

/// Draws edges the quick way; `other` draws those that are long or not inside.
#[inline(never)]
fn lines<T: Copy>(
    mut field: Field<T>,
    top: i32,
    edges: &[[u16; 2]],
    vertices: &[Vertex],
    value: T,
    other: impl Fn([&Vertex; 2], &mut [T]),
) {
    for edge in edges {
        let [Some(a), Some(b)] = edge.map(|i| vertices.get(i as usize)) else { continue };
        let place = |v: &Vertex| [(v.x >> 4) as u32, ((v.y >> 4) - top) as u32];
        if !field.line(place(a), place(b), value) {
            other([a, b], field.cells());
        }
    }
}

/// Colour and depth memory of the rows being drawn.
pub(super) struct Target<'m, F: PixelFormat> {
    pub(super) rows: Range<i32>,
    pub(super) width: usize,
    pub(super) dither: bool,
    pub(super) traversal: Traversal,
    pub(super) colour: &'m mut [F::Word],
    pub(super) depth: &'m mut [u16],
}

impl<F: PixelFormat> Target<'_, F> {
    /// The colour and depth of row `y`.
    #[inline(always)]
    fn row(&mut self, y: i32) -> (&mut [F::Word], &mut [u16]) {
        let (i, words) = ((y - self.rows.start) as usize, F::words(self.width));
        (
            &mut self.colour[i * words..(i + 1) * words],
            &mut self.depth[i * self.width..(i + 1) * self.width],
        )
    }

    #[inline(always)]
    fn encode(&self, rgb: [u8; 3], x: i32, y: i32) -> F::Pixel {
        if features::DITHER && self.dither { F::encode_dithered(rgb, x, y) } else { F::encode(rgb) }
    }

    pub(super) fn clip_rect(&self) -> ClipRect {
        ClipRect { x0: 0, y0: self.rows.start, x1: self.width as i32, y1: self.rows.end }
    }

    /// The token for AVX2, where this target may be drawn with it.
    fn avx2(&self) -> Option<Avx2> {
        if self.traversal == Traversal::Spans { Avx2::detect() } else { None }
    }

    /// The memory as RGB565 without dither, at least a strip wide, for AVX2; `None` where it is not.
    pub(super) fn pixels(&mut self) -> Option<(Avx2, Pixels<'_>)> {
        let avx2 = self.avx2().filter(|_| !self.dither && self.width >= STRIP)?;
        let (width, top) = (self.width, self.rows.start);
        let colours = F::rgb565(self.colour)?;
        Some((avx2, Pixels { colours, depths: self.depth, width, top }))
    }

    pub(super) fn clear(&mut self, background: &Background) {
        match self.avx2() {
            Some(avx2) => avx2.fill(self.depth, depth::FAR),
            None => memory::fill(self.depth, depth::FAR),
        }
        if let (Background::Colour(rgb), Some((avx2, pixels))) = (background, self.pixels()) {
            return avx2.fill(pixels.colours, Rgb565::encode(*rgb));
        }
        let (width, dither) = (self.width, features::DITHER && self.dither);
        let pixels = width * self.rows.len();
        if let (Background::Colour(rgb), false, Some(colours)) =
            (background, dither, F::rgb565(self.colour).and_then(|all| all.get_mut(..pixels)))
        {
            // Not row by row: a row has few words.
            return memory::fill(colours, Rgb565::encode(*rgb));
        }
        for y in self.rows.clone() {
            let (row, _) = self.row(y);
            if let (Background::Colour(rgb), false) = (background, dither) {
                F::fill(row, width, F::encode(*rgb));
                continue;
            }
            if !features::BACKGROUND_IMAGES && !dither {
                continue;
            }
            // The bits of the last word that are no pixels.
            if let Some(last) = row.last_mut() {
                *last = F::Word::default();
            }
            for x in 0..width {
                let rgb = match background {
                    Background::Colour(rgb) => *rgb,
                    Background::Image(pixels) if features::BACKGROUND_IMAGES => {
                        pixels[y as usize * width + x]
                    }
                    Background::Image(_) => [0; 3],
                };
                let pixel =
                    if dither { F::encode_dithered(rgb, x as i32, y) } else { F::encode(rgb) };
                F::store(row, x, pixel);
            }
        }
    }

    /// A triangle's covered pixels in some columns, row by row.
    #[inline(always)]
    fn runs<'t>(&self, t: &'t Triangle, columns: Range<i32>) -> Runs<'t> {
        Runs::either(t, self.rows.clone(), columns, self.by_tiles())
    }

    fn by_tiles(&self) -> bool {
        features::TILES && self.traversal == Traversal::Tiles
    }

    /// Whether texels are better found along the row: where 64-bit products and divisions are dear, and tile by tile, so that
    /// every machine can prove it.
    pub(super) fn walks(&self) -> bool {
        NARROW || self.by_tiles()
    }

    /// Whether textured pixels are drawn one after another on a machine with long products.
    #[inline(always)]
    pub(super) fn packs(&self) -> bool {
        let by_pixels = !lanes::AVAILABLE || self.traversal == Traversal::Pixels;
        let other = NARROW || self.by_tiles() || (features::DITHER && self.dither);
        by_pixels && !other
    }

    /// Whether a triangle's pixels, drawn one after another here, are enough to make tables for their tint.
    #[inline(always)]
    pub(super) fn tabled(&self, t: &Triangle) -> bool {
        // Half of a box at most is covered.
        t.area >= ENOUGH * 256 && self.has_enough(t)
    }

    #[cold]
    #[inline(never)]
    fn has_enough(&self, t: &Triangle) -> bool {
        let by_pixels =
            !lanes::AVAILABLE || !matches!(self.traversal, Traversal::Spans | Traversal::Baseline);
        if !by_pixels || self.dither || F::rgb565(&mut []).is_none() {
            return false;
        }
        let rows = t.max()[1].min(self.rows.end) - t.min()[1].max(self.rows.start);
        let columns = t.max()[0].min(self.width as i32) - t.min()[0].max(0);
        (columns * rows.max(0)) as i64 >= ENOUGH
    }

    /// Depth, shade, output: a triangle's fragments.
    #[inline(always)]
    pub(super) fn fill<S: Shader>(&mut self, t: &Triangle, z: &Plane, shader: &S) {
        if features::TILES && self.traversal == Traversal::Tiles {
            return self.fill_tiles(t, z, shader);
        }
        let columns = 0..self.width as i32;
        if features::DITHER && self.dither {
            self.fill_runs::<S, true>(t, z, shader, columns);
        } else if lanes::AVAILABLE
            && self.traversal != Traversal::Pixels
            && S::SIDE_BY_SIDE
            && F::rgb565(&mut []).is_some()
        {
            if self.width >= LANES && t.is_tiny() {
                self.fill_strips(t, z, shader);
            } else {
                self.fill_side_by_side(t, z, shader);
            }
        } else {
            self.fill_runs::<S, false>(t, z, shader, columns);
        }
    }

    /// The same tile by tile.
    #[cold]
    fn fill_tiles<S: Shader>(&mut self, t: &Triangle, z: &Plane, shader: &S) {
        for columns in tiles(t, self.width as i32) {
            if features::DITHER && self.dither {
                self.fill_runs::<S, true>(t, z, shader, columns);
            } else {
                self.fill_runs::<S, false>(t, z, shader, columns);
            }
        }
    }

    /// The fragments of some columns one after another.
    #[inline(never)]
    fn fill_runs<S: Shader, const DITHER: bool>(
        &mut self,
        t: &Triangle,
        z: &Plane,
        shader: &S,
        columns: Range<i32>,
    ) {
        let constant =
            F::encode(if S::CONSTANT { shader.colour(&shader.at(0, 0)) } else { [0; 3] });
        let z = depth::biased(z);
        if S::SMALL && !self.by_tiles() {
            return small::for_each(t, self.rows.clone(), columns, |Run { y, x0, x1 }| {
                self.fill_block::<S, DITHER>(&z, shader, constant, y, x0..x1)
            });
        }
        self.runs(t, columns).for_each(|Run { y, x0, x1 }| {
            if !S::IN_BLOCKS {
                return self.fill_block::<S, DITHER>(&z, shader, constant, y, x0..x1);
            }
            let mut first = x0;
            while first < x1 {
                let end = x1.min(first + shader.longest() as usize);
                self.fill_block::<S, DITHER>(&z, shader, constant, y, first..end);
                first = end;
            }
        });
    }

    /// Fragments side by side in row `y`; `constant` where they have one colour.
    #[inline(always)]
    fn fill_block<S: Shader, const DITHER: bool>(
        &mut self,
        z: &Plane,
        shader: &S,
        constant: F::Pixel,
        row: usize,
        columns: Range<usize>,
    ) {
        let (first, y) = (columns.start as i32, row as i32);
        let state = (z.at(first, y), shader.begin(first, y, columns.len() as i32));
        F::walk(
            self.colour,
            self.depth,
            (self.width, row - self.rows.start as usize, columns),
            state,
            |(value, _), stored| depth::test(stored, depth::whole(*value)),
            |(_, pixel), i| {
                if DITHER {
                    F::encode_dithered(shader.colour(pixel), first + i as i32, y)
                } else if S::CONSTANT {
                    constant
                } else {
                    shader.encoded::<F>(pixel)
                }
            },
            |(value, pixel)| (value.wrapping_add(z.gx), shader.step(pixel, 1)),
        );
    }

    /// A textured triangle's fragments one after another.
    #[inline(never)]
    pub(super) fn fill_packed<S: Shader>(
        &mut self,
        t: &Triangle,
        packed: &Packed,
        inner: &S,
        sampler: &Repeat565,
    ) {
        let columns = 0..self.width as i32;
        self.runs(t, columns).for_each(|Run { y, x0, x1 }| {
            let (first, row) = (x0 as i32, y as i32);
            F::walk(
                self.colour,
                self.depth,
                (self.width, y - self.rows.start as usize, x0..x1),
                (packed.at(first, row), inner.at(first, row)),
                |(pixel, _), stored| depth::test(stored, pixel.depth()),
                |(pixel, colour), _| inner.tint::<F>(colour, packed.texel(sampler, pixel)),
                |(pixel, colour)| (packed.step(pixel), inner.step(colour, 1)),
            );
        });
    }

    /// A tiny triangle in strips of eight columns, RGB565 only: no spans, edges are tested at every pixel.
    #[inline(never)]
    fn fill_strips<S: Shader>(&mut self, t: &Triangle, z: &Plane, shader: &S) {
        let (width, rows) = (self.width, self.rows.clone());
        let Some(colours) = F::rgb565(self.colour) else { return };
        let (top, bottom) = (t.min()[1].max(rows.start), t.max()[1].min(rows.end));
        let (first, last) = (t.min()[0].max(0), t.max()[0].min(width as i32));
        let (z_ramp, ramps) = (U32x8::ramp(0x8000, z.gx), shader.ramps());
        let all = t.edges();
        let mut left = first;
        while left < last && top < bottom {
            // At the right border the strip begins further left: what is drawn twice is not nearer the second time.
            let x = left.min((width - LANES) as i32);
            let edge = |e: &Edge| U16x8::ramp(e.at(x, top) as u16, e.a as u16);
            let mut edges = all.each_ref().map(edge);
            let down = all.each_ref().map(|e| U16x8::splat(e.b as u16));
            let (mut value, mut pixel) = (z.at(x, top), shader.at(x, top));
            let mut at = (top - rows.start) as usize * width + x as usize;
            for _ in top..bottom {
                let inside = edges[0].or(edges[1]).or(edges[2]).not_negative();
                let (Some(eight), Some(stored)) = (eight_at(colours, at), eight_at(self.depth, at))
                else {
                    return;
                };
                let new = U32x8::splat(value).add(z_ramp).high();
                let pass = new.below(U16x8::load(stored)).and(inside);
                write_eight(shader, &ramps, &pixel, pass, new, stored, eight);
                edges = [0, 1, 2].map(|i| edges[i].add(down[i]));
                value = value.wrapping_add(z.gy);
                pixel = shader.down(pixel);
                at += width;
            }
            left += LANES as i32;
        }
    }

    /// [`fill_runs`](Self::fill_runs) eight pixels at a time where the row has room for them, RGB565 only.
    #[inline(never)]
    fn fill_side_by_side<S: Shader>(&mut self, t: &Triangle, z: &Plane, shader: &S) {
        let (top, width) = (self.rows.start as usize, self.width);
        let mut runs = self.runs(t, 0..width as i32);
        let Some(colours) = F::rgb565(self.colour) else { return };
        let (z_ramp, ramps) = (U32x8::ramp(0x8000, z.gx), shader.ramps());
        runs.for_each(|run| {
            let row = (run.y - top) * width;
            let here = row + run.x0..row + width;
            let (eights, rest) = colours[here.clone()].as_chunks_mut::<LANES>();
            let (depth_eights, depth_rest) = self.depth[here].as_chunks_mut::<LANES>();
            let (x, y) = (run.x0 as i32, run.y as i32);
            let mut value = z.at(x, y);
            let mut pixel = shader.at(x, y);
            let mut left = run.x1 - run.x0;
            for (eight, stored) in eights.iter_mut().zip(depth_eights) {
                let old = U16x8::load(stored);
                let new = U32x8::splat(value).add(z_ramp).high();
                let pass = new.below(old).and(U16x8::first(left));
                write_eight(shader, &ramps, &pixel, pass, new, stored, eight);
                if left <= LANES {
                    left = 0;
                    break;
                }
                left -= LANES;
                value = value.wrapping_add(z.gx.wrapping_mul(LANES as u32));
                pixel = shader.step(pixel, LANES as u32);
            }
            // What remains at the end of the row.
            for (colour, stored) in rest.iter_mut().zip(depth_rest).take(left) {
                if depth::test(stored, depth::round(value)) {
                    *colour = Rgb565::encode(shader.colour(&pixel));
                }
                value = value.wrapping_add(z.gx);
                pixel = shader.step(pixel, 1);
            }
        });
    }

    /// Depth only, pushed back so that the triangle's own edges stay visible: by its steepest slope a
    /// pixel, at most 2048 steps, and two steps.
    pub(super) fn mask(&mut self, t: &Triangle, z: &Plane) {
        let slope = (z.gx as i32).unsigned_abs().max((z.gy as i32).unsigned_abs());
        let bias = slope.min(2048 << 16) + (2 << 16);
        self.runs(t, 0..self.width as i32).for_each(|run| {
            let (x, y) = (run.x0 as i32, run.y as i32);
            let (_, depths) = self.row(y);
            let mut value = z.at(x, y);
            for stored in &mut depths[run.x0..run.x1] {
                // Rounding may leave a value just below 0, which wraps to the top.
                let pushed = value.wrapping_add(0x8000).saturating_add(bias) >> 16;
                depth::test(stored, pushed as u16);
                value = value.wrapping_add(z.gx);
            }
        });
    }

    /// Edges of one colour without depth, the quick way; false where the format or dither forbids it.
    pub(super) fn draw_lines(
        &mut self,
        edges: &[[u16; 2]],
        vertices: &[Vertex],
        rgb: [u8; 3],
    ) -> bool {
        let (clip, width, rows) = (self.clip_rect(), self.width, self.rows.clone());
        let (groups, rest) = edges.as_chunks::<EIGHT>();
        if let (Some(avx2), false) = (self.avx2(), self.dither)
            && !groups.is_empty()
            && F::rgb565(self.colour).is_some()
        {
            let (rows, top, value) = (rows.len(), rows.start, Rgb565::encode(rgb));
            for group in groups {
                let Some(cells) = F::rgb565(self.colour) else { return false };
                let done = avx2.lines(
                    group,
                    vertices,
                    &mut avx2::Plain { cells, width, rows, top, value },
                );
                let mut left = !done & 0xff;
                while left != 0 {
                    let edge = &group[left.trailing_zeros() as usize % EIGHT];
                    self.draw_lines(core::slice::from_ref(edge), vertices, rgb);
                    left &= left - 1;
                }
            }
            return rest.is_empty() || self.draw_lines(rest, vertices, rgb);
        }
        let (false, Some(cells)) = (self.dither, F::pixels(self.colour)) else { return false };
        let value = F::encode(rgb);
        let Some(field) = Field::new(cells, width, clip) else { return false };
        lines(field, rows.start, edges, vertices, value, |[a, b], cells| {
            let end = |v: &Vertex| LineEnd { x: v.x >> 4, y: v.y >> 4, ..LineEnd::default() };
            let (a, b) = (end(a), end(b));
            if a.y.min(b.y) < rows.end && a.y.max(b.y) >= rows.start {
                fill_cells(cells, width, clip, &a, &b, value);
            }
        });
        true
    }

    /// A line of one colour without depth, the quick way; false where the format or dither forbids it.
    pub(super) fn draw_line(&mut self, a: &LineEnd, b: &LineEnd) -> bool {
        let (clip, width) = (self.clip_rect(), self.width);
        match F::pixels(self.colour) {
            Some(cells) if !self.dither => {
                fill_cells(cells, width, clip, a, b, F::encode(a.rgb));
                true
            }
            _ => false,
        }
    }

    #[inline]
    pub(super) fn plot(&mut self, x: i32, y: i32, z: Option<u16>, rgb: [u8; 3]) {
        let pixel = self.encode(rgb, x, y);
        let (row, depths) = self.row(y);
        if z.is_none_or(|z| depth::test(&mut depths[x as usize], z)) {
            F::store(row, x as usize, pixel);
        }
    }

    /// Mixes a colour into what is there.
    pub(super) fn mix(&mut self, x: i32, y: i32, z: Option<u16>, rgb: [u8; 3], weight: u8) {
        let (row, depths) = self.row(y);
        if z.is_none_or(|z| z < depths[x as usize]) {
            let mixed = blend(F::load(row, x as usize), rgb, weight);
            let pixel = self.encode(mixed, x, y);
            F::store(self.row(y).0, x as usize, pixel);
        }
    }
}
