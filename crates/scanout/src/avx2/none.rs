//! No AVX2: the token does not exist, so nothing of this is ever called.

use super::{EIGHT, Lanes, Pixels, Plain, Seen, Source, Triangles};
use crate::light::PlainLight;
use crate::transform::{ClipMatrix, Vertex, Viewport};

/// Cannot be had here.
#[derive(Clone, Copy, Debug)]
pub enum Avx2 {}

impl Avx2 {
    /// There is none.
    #[inline(always)]
    pub fn detect() -> Option<Avx2> {
        None
    }
    /// Not reached.
    pub fn project(
        self,
        _: &Viewport,
        _: &ClipMatrix,
        _: &[[i16; 3]],
        _: [u8; 3],
        _: &mut [Vertex],
    ) {
        match self {}
    }
    /// Not reached.
    pub fn light(self, _: &PlainLight, _: &[[i16; 3]], _: &mut [Vertex]) {
        match self {}
    }
    /// Not reached.
    pub fn facing(
        self,
        _: &[[[u16; 3]; EIGHT]],
        _: &[Vertex],
        _: [i32; 2],
        _: bool,
        _: &mut Seen,
    ) -> Option<usize> {
        match self {}
    }
    /// Not reached.
    pub fn set_up(self, _: &Source, _: &[u32; EIGHT], _: &mut Triangles) {
        match self {}
    }
    /// Not reached.
    pub fn draw(self, _: &Source, _: &Triangles, _: Lanes, _: &[[u8; 3]; EIGHT], _: &mut Pixels) {
        match self {}
    }
    /// Not reached.
    pub fn heights(self, _: &[[[u16; 2]; EIGHT]], _: &[Vertex], _: [u32; 2]) -> Option<(i32, i32)> {
        match self {}
    }
    /// Not reached.
    pub fn lines(self, _: &[[u16; 2]; EIGHT], _: &[Vertex], _: &mut Plain) -> u32 {
        match self {}
    }
    /// Not reached.
    pub fn fill(self, _: &mut [u16], _: u16) {
        match self {}
    }
}
