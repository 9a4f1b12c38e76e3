//! A model as files describe it: polygons over shared lists, any size, floating point. Readers fill it;
//! `assemble` makes the fixed-point parts of it.

use crate::error::{LoadError, Warnings};
use crate::load::Limits;
use crate::model::{Image, MaterialBuf};
use std::collections::HashMap;

/// "No index".
pub(crate) const NONE: u32 = u32::MAX;
/// Smoothing group of a face in a file that names none: smoothing is then limited by the crease angle.
pub(crate) const SMOOTHING_UNSPECIFIED: u32 = u32::MAX;
/// Coordinates beyond this are refused; squares of them stay far inside `f64`.
pub(crate) const COORDINATE_LIMIT: f64 = 1e30;

/// One corner of a polygon; `NONE` where the file gives no index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Corner {
    pub position: u32,
    pub uv: u32,
    pub normal: u32,
}

/// A polygon: its corners end before `end` in [`Raw::corners`], and begin where the previous face's end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    pub end: u32,
    /// Index into [`Raw::materials`].
    pub material: u32,
    /// 0 = flat.
    pub smoothing: u32,
}

/// Where a material's texture lies: `uv * scale + offset`, v upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct UvMap {
    pub scale: [f64; 2],
    pub offset: [f64; 2],
}

impl UvMap {
    pub(crate) const IDENTITY: Self = Self { scale: [1.0; 2], offset: [0.0; 2] };

    /// Of a texture coordinate with v downwards, as [`Raw::uvs`].
    pub(crate) fn apply(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let Self { scale, offset } = self;
        [u * scale[0] + offset[0], 1.0 - ((1.0 - v) * scale[1] + offset[1])]
    }
}

/// The whole model. Every index is valid (readers check), every number finite.
#[derive(Debug, Default)]
pub(crate) struct Raw {
    pub positions: Vec<[f64; 3]>,
    /// Parallel to `positions`, or empty.
    pub colours: Vec<[u8; 3]>,
    /// v down.
    pub uvs: Vec<[f64; 2]>,
    /// Any length.
    pub normals: Vec<[f32; 3]>,
    pub corners: Vec<Corner>,
    pub faces: Vec<Face>,
    /// Line segments: two positions and a material.
    pub lines: Vec<[u32; 3]>,
    /// Points: a position and a material.
    pub points: Vec<[u32; 2]>,
    /// At least one when anything refers to it.
    pub materials: Vec<MaterialBuf>,
    /// Of the materials whose texture is scaled or moved, by index.
    pub uv_maps: HashMap<u32, UvMap>,
    pub images: Vec<Image>,
    /// Some material names a texture, found or not.
    pub texture_named: bool,
    pub warnings: Warnings,
}

impl Raw {
    /// The corners of face `index`.
    pub(crate) fn face(&self, index: usize) -> &[Corner] {
        let begin = if index == 0 { 0 } else { self.faces[index - 1].end as usize };
        &self.corners[begin..self.faces[index].end as usize]
    }

    /// Ends a face whose corners were pushed; fewer than three are taken back. True when it was kept.
    pub(crate) fn end_face(&mut self, material: u32, smoothing: u32) -> bool {
        let begin = self.faces.last().map_or(0, |face| face.end as usize);
        if self.corners.len() - begin < 3 {
            self.corners.truncate(begin);
            return false;
        }
        self.faces.push(Face { end: self.corners.len() as u32, material, smoothing });
        true
    }

    /// Refuses a model that grew beyond the limits. Readers call it as they go.
    pub(crate) fn check(&self, file: &str, limits: &Limits) -> Result<(), LoadError> {
        let elements = [
            self.positions.len(),
            self.uvs.len(),
            self.normals.len(),
            self.corners.len(),
            self.lines.len(),
            self.points.len(),
        ];
        if elements.into_iter().any(|n| n > limits.elements as usize) {
            return Err(LoadError::too_large(
                file,
                format!("more than {} vertices or corners; simplify the mesh", limits.elements),
            ));
        }
        Ok(())
    }
}

/// True for three finite numbers of usable size.
pub(crate) fn usable(v: &[f64]) -> bool {
    v.iter().all(|x| x.abs() <= COORDINATE_LIMIT)
}
