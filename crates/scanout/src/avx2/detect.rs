//! Whether the processor has AVX2, FMA and POPCNT, and the operating system keeps their registers.
#![allow(unsafe_code)]

use core::arch::x86_64::{__cpuid, __cpuid_count, _xgetbv};
use core::sync::atomic::{AtomicU8, Ordering};

use super::{EIGHT, Lanes, Pixels, Plain, Seen, Source, Triangles};
use super::{edges, facing, light, planes, project, strips};
use crate::light::PlainLight;
use crate::transform::{ClipMatrix, Vertex, Viewport};

/// Proof that AVX2, FMA and POPCNT can be used.
#[derive(Clone, Copy, Debug)]
pub struct Avx2(());

/// Asked once: the instruction is slow where a hypervisor answers it.
static FOUND: AtomicU8 = AtomicU8::new(UNKNOWN);
const UNKNOWN: u8 = 0;
const YES: u8 = 1;
const NO: u8 = 2;

/// Intel's manual, volume 1, 14.7.1: leaf 1 for AVX, FMA, POPCNT, OSXSAVE; XCR0 for the registers; leaf 7 for AVX2.
fn ask() -> bool {
    const FMA: u32 = 1 << 12;
    const POPCNT: u32 = 1 << 23;
    const OSXSAVE: u32 = 1 << 27;
    const AVX: u32 = 1 << 28;
    const AVX2: u32 = 1 << 5;
    if __cpuid(0).eax < 7 {
        return false;
    }
    let wanted = FMA | POPCNT | OSXSAVE | AVX;
    if __cpuid(1).ecx & wanted != wanted {
        return false;
    }
    #[target_feature(enable = "xsave")]
    fn state() -> u64 {
        // SAFETY: register 0 exists wherever the instruction does.
        unsafe { _xgetbv(0) }
    }
    // SAFETY: OSXSAVE was found, so the instruction is there.
    let kept = unsafe { state() };
    kept & 6 == 6 && __cpuid_count(7, 0).ebx & AVX2 != 0
}

/// Calls a function that needs AVX2, FMA and POPCNT.
macro_rules! call {
    ($e:expr) => {{
        // SAFETY: the token `self` exists only where `ask` found AVX2, FMA and POPCNT, the only thing that these functions ask.
        #[allow(clippy::macro_metavars_in_unsafe)]
        unsafe {
            $e
        }
    }};
}

impl Avx2 {
    /// The token, where the processor can.
    #[inline]
    pub fn detect() -> Option<Avx2> {
        let mut found = FOUND.load(Ordering::Relaxed);
        if found == UNKNOWN {
            found = if ask() { YES } else { NO };
            FOUND.store(found, Ordering::Relaxed);
        }
        (found == YES).then_some(Avx2(()))
    }

    /// Transforms positions to vertices of one colour; as many as the shorter of both slices has.
    pub fn project(
        self,
        viewport: &Viewport,
        clip: &ClipMatrix,
        positions: &[[i16; 3]],
        rgb: [u8; 3],
        vertices: &mut [Vertex],
    ) {
        call!(project::project(viewport, clip, positions, rgb, vertices));
    }

    /// Lights vertices by their normals; as many as the shorter of both slices has.
    pub fn light(self, light: &PlainLight, normals: &[[i16; 3]], vertices: &mut [Vertex]) {
        call!(light::light(light, normals, vertices));
    }

    /// The next group in which triangles can be seen in a frame of this width and height, or that is not plain; and what there is to
    /// say about it. Without one, how many were turned or outside.
    #[inline]
    pub fn facing(
        self,
        groups: &[[[u16; 3]; EIGHT]],
        vertices: &[Vertex],
        size: [i32; 2],
        one_sided: bool,
        seen: &mut Seen,
    ) -> Option<usize> {
        call!(facing::facing(groups, vertices, size, one_sided, seen))
    }

    /// Sets up eight triangles, given by their indices.
    pub fn set_up(self, source: &Source, indices: &[u32; EIGHT], out: &mut Triangles) {
        call!(planes::set_up(source, indices, out));
    }

    /// Draws some of them, in order; `flat` are their colours where they have one each.
    pub fn draw(
        self,
        source: &Source,
        triangles: &Triangles,
        lanes: Lanes,
        flat: &[[u8; 3]; EIGHT],
        pixels: &mut Pixels,
    ) {
        match (source.gouraud, &source.texture) {
            (false, None) => call!(strips::flat(triangles, lanes, flat, pixels)),
            (true, None) => call!(strips::gouraud(triangles, lanes, pixels)),
            (gouraud, Some(texture)) => {
                let flat = (!gouraud).then_some(flat);
                call!(strips::textured(triangles, lanes, texture, flat, pixels))
            }
        }
    }

    /// The highest and the lowest end (Q28.4) of edges whose ends are all inside a frame of this width and height (1/16 pixel);
    /// `None` where one is not, or is to be clipped, or an index is out of range.
    pub fn heights(
        self,
        groups: &[[[u16; 2]; EIGHT]],
        vertices: &[Vertex],
        size: [u32; 2],
    ) -> Option<(i32, i32)> {
        call!(edges::heights(groups, vertices, size))
    }

    /// Draws edges of one value; the bits of those drawn. Others have an end outside or more than 1024 steps.
    pub fn lines(self, edges: &[[u16; 2]; EIGHT], vertices: &[Vertex], to: &mut Plain) -> u32 {
        call!(edges::lines(edges, vertices, to))
    }

    /// Fills memory.
    pub fn fill(self, memory: &mut [u16], value: u16) {
        #[target_feature(enable = "avx2")]
        fn fill(memory: &mut [u16], value: u16) {
            memory.fill(value);
        }
        call!(fill(memory, value));
    }
}
