//! Preparing edges and points: which can be seen, between which rows (positions Q28.4, rows whole).

use core::ops::Range;

use super::super::{CLIPPED, Kind, PrepareError, Primitive};
use super::{List, ObjectPass, TOGETHER};
use crate::avx2::EIGHT;
use crate::clip;
use crate::transform::{CLIP, FAR, NEAR, Vertex};

impl ObjectPass<'_> {
    /// Edges with both ends in the frame are listed in runs of neighbours: `index` is the first, `rgb[0]` how many more
    /// there are. Runs begin at multiples of [`TOGETHER`], where a range must.
    pub(super) fn edges(
        &self,
        range: Range<usize>,
        vertices: &[Vertex],
        list: &mut List,
    ) -> Result<(), PrepareError> {
        let (width, height) = (self.settings.width as u32 * 16, self.settings.height as u32 * 16);
        let inside =
            |v: &Vertex| v.flags & CLIP == 0 && (v.x as u32) < width && (v.y as u32) < height;
        let starts = range.clone().step_by(TOGETHER);
        for (start, edges) in starts.zip(self.object.mesh.edges[range].chunks(TOGETHER)) {
            let mut first = start;
            if let (Some(avx2), (groups, [])) = (self.avx2, edges.as_chunks::<EIGHT>())
                && let Some((high, low)) = avx2.heights(groups, vertices, [width, height])
            {
                self.edge_run(first, edges.len(), high, low, list);
                continue;
            }
            // The run's length, its highest and its lowest end.
            let (mut length, mut high, mut low) = (0, i32::MAX, 0);
            for (i, edge) in (start..).zip(edges) {
                let [Some(a), Some(b)] = edge.map(|c| vertices.get(c as usize)) else {
                    return Err(PrepareError::Index { object: self.index, element: i });
                };
                if inside(a) && inside(b) {
                    (length, high, low) =
                        (length + 1, high.min(a.y).min(b.y), low.max(a.y).max(b.y));
                    continue;
                }
                self.edge_run(first, length, high, low, list);
                (first, length, high, low) = (i + 1, 0, i32::MAX, 0);
                self.edge(i, [a, b], list);
            }
            self.edge_run(first, length, high, low, list);
        }
        Ok(())
    }

    /// Lists a run of edges between two heights, none when it is empty.
    fn edge_run(&self, first: usize, length: usize, high: i32, low: i32, list: &mut List) {
        let [a, b] = [high, low].map(|y| Vertex { y, ..Vertex::default() });
        if length > 0
            && let Some((top, bottom)) = self.line_rows(&a, &b, 2)
        {
            list.push(Primitive {
                index: first as u32,
                top,
                bottom,
                object: self.index as u16,
                rgb: [length as u8 - 1, 0, 0],
                tag: Kind::Edge as u8,
            });
        }
    }

    /// Lists an edge that leaves the frame or must be clipped, if it can be seen.
    #[inline(never)]
    fn edge(&self, index: usize, [a, b]: [&Vertex; 2], list: &mut List) {
        let edge = self.object.mesh.edges[index];
        let mut rows = None;
        let clipped = (a.flags | b.flags) & CLIP != 0;
        if a.flags & b.flags & (NEAR | FAR) == 0 {
            let ends = if clipped {
                clip::line(self.corner(edge[0]), self.corner(edge[1]))
                    .map(|ends| ends.map(|c| self.viewport.project_one(&c.clip)))
            } else {
                Some([*a, *b])
            };
            // An anti-aliased line reaches one pixel to each side.
            rows = ends.and_then(|[a, b]| self.line_rows(&a, &b, 2));
        }
        let Some((top, bottom)) = rows else {
            list.stats.outside += 1;
            return;
        };
        list.stats.clipped += clipped as u32;
        let tag = Kind::Edge as u8 | if clipped { CLIPPED } else { 0 };
        let object = self.index as u16;
        list.push(Primitive { index: index as u32, top, bottom, object, rgb: [0; 3], tag });
    }

    pub(super) fn points(&self, range: Range<usize>, vertices: &[Vertex], list: &mut List) {
        for (i, v) in range.clone().zip(&vertices[range]) {
            let reach = self.object.point_size as i32;
            let rows = if v.flags & CLIP != 0 { None } else { self.line_rows(v, v, reach) };
            let Some((top, bottom)) = rows else {
                list.stats.outside += 1;
                continue;
            };
            let (tag, object) = (Kind::Point as u8, self.index as u16);
            list.push(Primitive { index: i as u32, top, bottom, object, rgb: [0; 3], tag });
        }
    }

    /// Rows of the frame that a line or point may touch, `reach` pixels to each side.
    fn line_rows(&self, a: &Vertex, b: &Vertex, reach: i32) -> Option<(i16, i16)> {
        let (width, height) = (self.settings.width as i32, self.settings.height as i32);
        let x0 = (a.x.min(b.x) >> 4) - reach;
        let x1 = (a.x.max(b.x) >> 4) + reach;
        let y0 = ((a.y.min(b.y) >> 4) - reach).max(0);
        let y1 = ((a.y.max(b.y) >> 4) + reach + 1).min(height);
        (x0 < width && x1 >= 0 && y0 < y1).then_some((y0 as i16, y1 as i16))
    }
}
