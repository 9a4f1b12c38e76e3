//! Culling triangles: which can be seen, between which rows, and the colours of those that are lit as a whole.
//!
//! | value | format |
//! |---|---|
//! | corners, boxes | Q28.4 |
//! | twice the area | 1/256 pixel^2, i64, negative for front faces |
//! | rows | whole, i16 |

use core::ops::Range;

use super::super::{BACK, CLIPPED, Kind, PrepareError, Primitive};
use super::{List, ObjectPass, Transformed, geometric_normal, surface_colour};
use crate::avx2::{EIGHT, Seen};
use crate::clip::{self, Corner};
use crate::cull::{ClusterView, Facing, facing, facing_in_clip_space};
use crate::features;
use crate::light::Lighting;
use crate::mesh::{Cluster, Mesh, Normals};
use crate::setup::{first_pixel, signed_area};
use crate::transform::{CLIP, FAR, NEAR, Vertex};

impl ObjectPass<'_> {
    /// Cull: triangles that can be seen, lit if they are lit as a whole.
    pub(super) fn triangles(
        &self,
        range: Range<usize>,
        vertices: &mut impl Transformed,
        lighting: &Lighting,
        kind: Kind,
        list: &mut List,
    ) -> Result<(), PrepareError> {
        let first = list.len;
        self.facing_triangles(range, vertices, kind, list)?;
        if self.whole
            && let Some(listed) = list.primitives.get_mut(first..)
        {
            let count = (list.len - first).min(listed.len());
            self.light_faces(&mut listed[..count], lighting);
        }
        Ok(())
    }

    /// Cull.
    #[inline(always)]
    fn facing_triangles(
        &self,
        range: Range<usize>,
        vertices: &mut impl Transformed,
        kind: Kind,
        list: &mut List,
    ) -> Result<(), PrepareError> {
        list.stats.triangles += range.len() as u32;
        let Some(avx2) = self.avx2 else {
            return match &self.clusters {
                Some(view) => self.by_clusters(view, range, vertices, kind, list),
                None => self.one_by_one(range, vertices, kind, list),
            };
        };
        let triangles = &self.object.mesh.triangles[range.clone()];
        let one_sided = self.one_sided();
        let size = [self.settings.width as i32, self.settings.height as i32];
        let (groups, rest) = triangles.as_chunks::<EIGHT>();
        let (mut next, mut seen) = (0, Seen::default());
        while next < groups.len() {
            let found =
                avx2.facing(&groups[next..], vertices.vertices(), size, one_sided, &mut seen);
            list.stats.back_facing += seen.turned;
            list.stats.outside += seen.outside;
            let Some(passed) = found else { break };
            let group = next + passed;
            let first = range.start + group * EIGHT;
            next = group + 1;
            if !seen.plain {
                self.one_by_one(first..first + EIGHT, vertices, kind, list)?;
                continue;
            }
            let mut rest = seen.kept;
            while rest != 0 {
                let k = rest.trailing_zeros() as usize & (EIGHT - 1);
                rest &= rest - 1;
                let rows = (seen.top[k] as i16, seen.bottom[k] as i16);
                let facing = if seen.back >> k & 1 == 0 { Facing::Front } else { Facing::Back };
                self.keep(first + k, kind as u8, rows, facing, list);
                vertices.keep(groups[group][k]);
            }
        }
        self.one_by_one(range.end - rest.len()..range.end, vertices, kind, list)
    }

    /// The same for triangles whose clusters are asked first.
    fn by_clusters(
        &self,
        view: &ClusterView,
        range: Range<usize>,
        vertices: &mut impl Transformed,
        kind: Kind,
        list: &mut List,
    ) -> Result<(), PrepareError> {
        const MANY: usize = Cluster::TRIANGLES;
        let clusters = &self.object.mesh.clusters[..range.end.div_ceil(MANY)];
        let mut at = range.start;
        while at < range.end {
            // The triangles up to the next cluster that is turned away, then all of such clusters.
            let from = at / MANY;
            let kept = clusters[from..].iter().take_while(|c| !view.turned_away(c)).count();
            let to = range.end.min((from + kept) * MANY);
            if kept > 0 {
                vertices.complete(self, &self.object.mesh.triangles[at..to]);
                self.one_by_one(at..to, vertices, kind, list)?;
                at = to;
            }
            let from = from + kept;
            // The first of them is known to be.
            let rest = clusters.get(from + 1..).unwrap_or(&[]);
            let turned = 1 + rest.iter().take_while(|c| view.turned_away(c)).count();
            let to = range.end.min((from + turned) * MANY);
            list.stats.back_facing += (to - at) as u32;
            at = to;
        }
        Ok(())
    }

    /// The same, one after another. Most are dropped here, so this loop holds nothing but the tests.
    #[inline(never)]
    fn one_by_one(
        &self,
        range: Range<usize>,
        marked: &mut impl Transformed,
        kind: Kind,
        list: &mut List,
    ) -> Result<(), PrepareError> {
        let one_sided = self.one_sided();
        let mut triangles = range.clone().zip(&self.object.mesh.triangles[range.clone()]);
        let mut kept = 0;
        while let Some((index, &triangle, found)) =
            Self::next_facing(&mut triangles, marked.vertices(), one_sided)
        {
            kept += 1;
            match found {
                Found::Unclipped([a, b, c], facing) => {
                    let low = [0, 1].map(|i: usize| a[i].min(b[i]).min(c[i]));
                    let high = [0, 1].map(|i: usize| a[i].max(b[i]).max(c[i]));
                    let Some(rows) = self.rows(low, high) else {
                        list.stats.outside += 1;
                        continue;
                    };
                    self.keep(index, kind as u8, rows, facing, list);
                }
                Found::Clipped => self.keep_clipped(index, marked.vertices(), kind, list),
                Found::NoVertex => {
                    return Err(PrepareError::Index { object: self.index, element: index });
                }
            }
            marked.keep(triangle);
        }
        list.stats.back_facing += range.len() as u32 - kept;
        Ok(())
    }

    /// The same tests for a triangle that the clip stage must cut.
    #[inline(never)]
    fn keep_clipped(&self, index: usize, vertices: &[Vertex], kind: Kind, list: &mut List) {
        let mesh = self.object.mesh;
        let triangle = mesh.triangles[index];
        let [a, b, c] = triangle.map(|i| vertices[i as usize].flags);
        if a & b & c & (NEAR | FAR) != 0 {
            list.stats.outside += 1;
            return;
        }
        let corners = triangle.map(|c| self.clip.apply_one(mesh.positions[c as usize]));
        let facing = facing_in_clip_space(&corners);
        if facing == Facing::Edge || (facing == Facing::Back && self.one_sided()) {
            list.stats.back_facing += 1;
            return;
        }
        let Some(rows) = self.clipped_rows(&corners) else {
            list.stats.outside += 1;
            return;
        };
        list.stats.clipped += 1;
        self.keep(index, kind as u8 | CLIPPED, rows, facing, list);
    }

    /// Lists a triangle.
    #[inline]
    fn keep(
        &self,
        index: usize,
        tag: u8,
        (top, bottom): (i16, i16),
        facing: Facing,
        list: &mut List,
    ) {
        let tag = tag | if facing == Facing::Back { BACK } else { 0 };
        let object = self.index as u16;
        list.push(Primitive { index: index as u32, top, bottom, object, rgb: [0; 3], tag });
    }

    /// Light: triangles that are lit as a whole.
    #[inline(never)]
    fn light_faces(&self, primitives: &mut [Primitive], lighting: &Lighting) {
        let (mesh, colour) = (*self.object.mesh, self.object.material.colour);
        // Without other lights the general way is as short.
        let plain = if features::ALL_LIGHTS { lighting.plain() } else { None };
        let plain = plain.filter(|_| mesh.colours.is_empty());
        for primitive in primitives {
            let (index, back) = (primitive.index as usize, primitive.tag & BACK != 0);
            primitive.rgb = match &plain {
                Some(light) => light.lit(colour, normal(&mesh, index, back)),
                None => self.face_colour(index, back, lighting),
            };
        }
    }

    /// The colour of a triangle that is lit as a whole: the mean of its corners' colours, lit at their centre.
    #[inline(never)]
    fn face_colour(&self, index: usize, back: bool, lighting: &Lighting) -> [u8; 3] {
        let mesh = self.object.mesh;
        let triangle = mesh.triangles[index];
        let normal = normal(mesh, index, back);
        let mut colour = self.object.material.colour;
        if features::VERTEX_COLOURS && !mesh.colours.is_empty() {
            let colours = triangle.map(|c| surface_colour(self.object, c));
            colour = [0, 1, 2].map(|k| {
                let sum: u32 = colours.iter().map(|c| c[k] as u32).sum();
                ((sum + 1) / 3) as u8
            });
        }
        let mut centre = [0; 3];
        if lighting.needs_position() {
            let corners = triangle.map(|c| mesh.positions[c as usize]);
            centre = [0, 1, 2].map(|k| {
                let sum: i32 = corners.iter().map(|c| c[k] as i32).sum();
                sum.div_euclid(3) as i16
            });
        }
        lighting.lit_in_mesh(colour, normal, centre)
    }

    /// The next triangle that isn't dropped at first sight. Most are, so this loop holds nothing but the test.
    #[inline(always)]
    fn next_facing<'t>(
        triangles: &mut impl Iterator<Item = (usize, &'t [u16; 3])>,
        vertices: &[Vertex],
        one_sided: bool,
    ) -> Option<(usize, &'t [u16; 3], Found)> {
        for (index, triangle) in triangles {
            let [a, b, c] = triangle.map(|i| vertices.get(i as usize));
            let (Some(a), Some(b), Some(c)) = (a, b, c) else {
                return Some((index, triangle, Found::NoVertex));
            };
            if (a.flags | b.flags | c.flags) & CLIP != 0 {
                return Some((index, triangle, Found::Clipped));
            }
            let corners = [[a.x, a.y], [b.x, b.y], [c.x, c.y]];
            let facing = facing(signed_area(&corners));
            if facing == Facing::Front || (facing == Facing::Back && !one_sided) {
                return Some((index, triangle, Found::Unclipped(corners, facing)));
            }
        }
        None
    }

    /// Rows of the frame that a clipped triangle may touch.
    fn clipped_rows(&self, triangle: &[[i32; 4]; 3]) -> Option<(i16, i16)> {
        // In place: a corner is many words, and `map` moves it about.
        let mut corners = [Corner::default(); 3];
        for (corner, &clip) in corners.iter_mut().zip(triangle) {
            corner.clip = clip;
        }
        let polygon = clip::triangle(corners);
        let corners = polygon.corners();
        if corners.is_empty() {
            return None;
        }
        let (mut low, mut high) = ([i32::MAX; 2], [i32::MIN; 2]);
        for corner in corners {
            let v = self.viewport.project_one(&corner.clip);
            low = [low[0].min(v.x), low[1].min(v.y)];
            high = [high[0].max(v.x), high[1].max(v.y)];
        }
        self.rows(low, high)
    }

    /// Rows of the frame with pixel centres in a box (Q28.4); `None` when the box holds no centre.
    #[inline(always)]
    fn rows(&self, low: [i32; 2], high: [i32; 2]) -> Option<(i16, i16)> {
        let (width, height) = (self.settings.width as i32, self.settings.height as i32);
        let (x0, x1) = (first_pixel(low[0]).max(0), first_pixel(high[0]).min(width));
        let (y0, y1) = (first_pixel(low[1]).max(0), first_pixel(high[1]).min(height));
        (x0 < x1 && y0 < y1).then_some((y0 as i16, y1 as i16))
    }
}

/// The normal by which a triangle is lit as a whole.
#[inline(always)]
fn normal(mesh: &Mesh, index: usize, back: bool) -> [i16; 3] {
    let normal = match mesh.normals {
        Normals::Face(normals) => normals[index],
        _ => geometric_normal(mesh, mesh.triangles[index]),
    };
    if back { normal.map(|v| v.saturating_neg()) } else { normal }
}

/// What a triangle that isn't dropped at first sight is.
enum Found {
    /// Its corners, Q28.4.
    Unclipped([[i32; 2]; 3], Facing),
    /// The clip stage must cut it.
    Clipped,
    /// One of its indices is of no vertex.
    NoVertex,
}
