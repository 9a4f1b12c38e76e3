//! Triangles that are made alike: flat or Gouraud, plain or with a plain texture. How is decided once an object, and those that are clipped
//! or lit from behind go the general way, in their place in the list.
//!
//! | way | where |
//! |---|---|
//! | eight at a time | AVX2, RGB565 |
//! | textured, in registers of 64 bits | RV64 and its like, `Traversal::Pixels`: `texture/packed.rs` |
//! | one by one | elsewhere; formats as in [`setup`](crate::setup) and [`interpolate`](crate::interpolate) |

use core::cell::OnceCell;

use super::super::fragment::{Flat, Gouraud, Shader, Textured, Tinted};
use super::super::target::Target;
use super::super::walked::{ByRows, BySteps, Walked};
use super::super::{BACK, Frame, Primitive};
use crate::avx2::{EIGHT, Source, Triangles};
use crate::features;
use crate::interpolate::Plane;
use crate::light::Lighting;
use crate::math::NARROW;
use crate::mesh::Normals;
use crate::output::PixelFormat;
use crate::scene::Mode;
use crate::setup::Triangle;
use crate::shade::{Factors, Grey, Tables};
use crate::texture::{Across, Packed, Plain, Repeat565};
use crate::transform::{Vertex, common_inverse_w};

impl<'a> Frame<'a> {
    /// What triangles are made from, of objects whose triangles are all made alike.
    pub(super) fn source<F: PixelFormat>(
        &self,
        object: u16,
        target: &Target<F>,
    ) -> Option<Source<'a>> {
        let first_vertex = self.objects[object as usize].first_vertex as usize;
        let object = &self.scene.objects[object as usize];
        let mesh = object.mesh;
        let gouraud = match (object.mode, mesh.normals) {
            (Mode::Gouraud, Normals::Vertex(_)) => true,
            (Mode::Flat | Mode::Gouraud, _) => false,
            _ => return None,
        };
        let textured = object.material.texture.filter(|_| !mesh.uv_triangles.is_empty());
        let texture = textured.and_then(Repeat565::new);
        if self.fog.is_some() || textured.is_some() != texture.is_some() {
            return None;
        }
        Some(Source {
            triangles: mesh.triangles,
            vertices: &self.vertices[first_vertex..first_vertex + mesh.positions.len()],
            uv_triangles: mesh.uv_triangles,
            uvs: mesh.uvs,
            texture,
            gouraud,
            rows: (target.rows.start, target.rows.end),
            width: target.width as i32,
        })
    }

    /// Draws primitives of one object one by one: how their triangles are made is decided here, once.
    // A call, so that other ways have its memory.
    #[inline(never)]
    pub(super) fn draw_plain<F: PixelFormat>(
        &self,
        source: &Source,
        run: &[Primitive],
        lights: &mut Option<(u16, Lighting)>,
        target: &mut Target<F>,
    ) {
        let uv = |index: usize| -> [[i32; 2]; 3] {
            let Some([i, j, k]) = source.uv_triangles.get(index) else { return [[0; 2]; 3] };
            let at = |&i: &u16| match source.uvs.get(i as usize) {
                Some(&[u, v]) => [u, v],
                None => [0, 0],
            };
            [at(i), at(j), at(k)]
        };
        let q = |v: &[&Vertex; 3]| common_inverse_w(*v).0;
        match (features::GOURAUD && source.gouraud, source.texture) {
            (false, None) => {
                self.draw_alike(source, run, lights, target, |target, t, v, primitive| {
                    let [z] = t.planes([v.map(|v| v.z)]);
                    target.fill(t, &z, &Flat(primitive.rgb));
                });
            }
            (true, None) => {
                self.draw_alike(source, run, lights, target, |target, t, v, _| {
                    let (z, shader) = shaded(t, v);
                    target.fill(t, &z, &shader);
                });
            }
            (false, Some(sampler)) => {
                let mut last = None;
                self.draw_alike(source, run, lights, target, |target, t, v, primitive| {
                    let (uv, q) = (uv(primitive.index as usize), q(v));
                    let (z, rgb) = (v.map(|v| v.z), primitive.rgb);
                    let (tabled, grey) = (target.tabled(t), Grey::new(rgb));
                    if target.packs()
                        && (tabled || grey.is_some())
                        && let Some(packed) = Packed::new(t, z, uv, q, sampler.size)
                    {
                        return match grey {
                            Some(tint) if !tabled => {
                                target.fill_packed(t, &packed, &Tinted { rgb, tint }, &sampler)
                            }
                            _ => {
                                let inner = with_tables(&mut last, rgb);
                                target.fill_packed(t, &packed, &inner, &sampler)
                            }
                        };
                    }
                    if NARROW && tabled {
                        let inner = with_tables(&mut last, rgb);
                        return by_rows(target, t, &t.plane(z), inner, sampler, uv, q);
                    }
                    let inner = Tinted { rgb, tint: Factors::new(rgb) };
                    if target.walks() {
                        return shortest(target, t, &t.plane(z), inner, sampler, uv, q);
                    }
                    let ([z, q], setup) = sampler.setup_with(t, z, uv, q);
                    target.fill(t, &z, &Textured { inner, sampler, setup, q });
                });
            }
            (true, Some(sampler)) => {
                self.draw_alike(source, run, lights, target, |target, t, v, primitive| {
                    let (z, inner) = shaded(t, v);
                    let (uv, q) = (uv(primitive.index as usize), q(v));
                    if target.packs()
                        && let Some(packed) = Packed::new(t, v.map(|v| v.z), uv, q, sampler.size)
                    {
                        return target.fill_packed(t, &packed, &inner, &sampler);
                    }
                    shortest(target, t, &z, inner, sampler, uv, q);
                });
            }
        }
    }

    /// Draws primitives of one object, its plain ones by `draw`.
    #[inline(never)]
    fn draw_alike<F: PixelFormat>(
        &self,
        source: &Source,
        run: &[Primitive],
        lights: &mut Option<(u16, Lighting)>,
        target: &mut Target<F>,
        mut draw: impl FnMut(&mut Target<F>, &Triangle, &[&Vertex; 3], &Primitive),
    ) {
        let rows = target.rows.clone();
        for primitive in run.iter().filter(|p| p.touches(&rows)) {
            if source.is_plain(primitive.tag)
                && let Some(corners) = source.triangles.get(primitive.index as usize)
                && let (Some(a), Some(b), Some(c)) = (
                    source.vertices.get(corners[0] as usize),
                    source.vertices.get(corners[1] as usize),
                    source.vertices.get(corners[2] as usize),
                )
            {
                if let Some(t) = Triangle::new([[a.x, a.y], [b.x, b.y], [c.x, c.y]]) {
                    draw(target, &t, &[a, b, c], primitive);
                }
            } else {
                self.draw_primitive(primitive, lights, target);
            }
        }
    }

    /// Draws primitives of one object in groups of eight.
    pub(super) fn draw_groups<F: PixelFormat>(
        &self,
        source: &Source,
        run: &[Primitive],
        lights: &mut Option<(u16, Lighting)>,
        target: &mut Target<F>,
    ) {
        let rows = target.rows.clone();
        let mut touching = run.iter().filter(|p| p.touches(&rows));
        let mut triangles = Triangles::default();
        loop {
            // What is not of the plain kind, and what fills up the last group, is not ready.
            let mut group = [&Primitive::EMPTY; EIGHT];
            let (mut count, mut plain) = (0, 0u32);
            for (slot, primitive) in group.iter_mut().zip(&mut touching) {
                *slot = primitive;
                plain |= (source.is_plain(primitive.tag) as u32) << count;
                count += 1;
            }
            if count == 0 {
                return;
            }
            let Some((avx2, _)) = target.pixels() else { return };
            avx2.set_up(source, &group.map(|p| p.index), &mut triangles);
            let ready = triangles.ready & plain;
            let flat = group.map(|p| p.rgb);
            let mut next = 0;
            while next < count {
                let end = next + (!(ready >> next)).trailing_zeros() as usize;
                if end > next
                    && let Some((avx2, mut pixels)) = target.pixels()
                {
                    avx2.draw(source, &triangles, next..end.min(count), &flat, &mut pixels);
                }
                next = end;
                if next < count {
                    self.draw_primitive(group[next], lights, target);
                    next += 1;
                }
            }
        }
    }
}

/// Draws a textured triangle, by the way that is the shortest.
#[inline(always)]
pub(super) fn shortest<F: PixelFormat, S: Shader, T: Plain>(
    target: &mut Target<F>,
    t: &Triangle,
    z: &Plane,
    inner: S,
    sampler: T,
    uv: [[i32; 2]; 3],
    q: [u32; 3],
) {
    if !target.walks() {
        return target.fill(t, z, &Textured::new(t, inner, sampler, uv, q));
    }
    match &Across::new(t, uv, q, sampler.size().map(|size| size as u32)) {
        Some(across) => {
            let (size, rows) = (sampler.size(), &OnceCell::new());
            let way = BySteps { across, triangle: t, uv, q, size, rows };
            target.fill(t, z, &Walked { inner, sampler, way });
        }
        None => by_rows(target, t, z, inner, sampler, uv, q),
    }
}

/// Draws a textured triangle along its rows.
#[inline(never)]
pub(super) fn by_rows<F: PixelFormat, S: Shader, T: Plain>(
    target: &mut Target<F>,
    t: &Triangle,
    z: &Plane,
    inner: S,
    sampler: T,
    uv: [[i32; 2]; 3],
    q: [u32; 3],
) {
    let way = ByRows::new(t, sampler.size(), uv, q);
    target.fill(t, z, &Walked { inner, sampler, way });
}

/// One colour with its tables, which are the last triangle's if that had the same: the halves of a flat quadrilateral do.
#[inline(never)]
fn with_tables(last: &mut Option<([u8; 3], Tables)>, rgb: [u8; 3]) -> Tinted<&Tables> {
    if last.as_ref().is_some_and(|&(known, _)| known != rgb) {
        *last = None;
    }
    let (_, tint) = last.get_or_insert_with(|| (rgb, Tables::new(rgb)));
    Tinted { rgb, tint }
}

/// Depth and colours through three vertices.
#[inline(always)]
fn shaded(t: &Triangle, v: &[&Vertex; 3]) -> (Plane, Gouraud) {
    let [r, g, b] = Gouraud::values(v.map(|v| v.rgb));
    let [z, r, g, b] = t.planes([v.map(|v| v.z), r, g, b]);
    (z, Gouraud::of([r, g, b]))
}

impl Source<'_> {
    /// Whether a primitive of this tag is made as all of its object: neither clipped nor to be lit from behind.
    #[inline(always)]
    fn is_plain(&self, tag: u8) -> bool {
        tag == Primitive::PLAIN || (tag == BACK && !self.gouraud)
    }
}
