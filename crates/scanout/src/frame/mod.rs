//! Frame: a scene prepared once, then drawn in bands of as few lines as the caller can afford.
//!
//! ```text
//!   Scene --prepare--> Frame --draw_rows, draw_bands--> rows of pixels --> the caller's sink (scan-out)
//!            |  transform, light, cull       |  clip, setup, raster, interpolate,
//!            |  into the caller's Store      |  texture, depth, shade, output
//! ```
//!
//! Preparing transforms and lights every vertex once and lists what will be drawn. Drawing reads that list and
//! changes nothing in it, so bands may be drawn in any order, any height, by several threads: the pixels are the
//! same. A primitive's planes are functions of the frame, not of the band, and are set up anew in each band that it touches.
//! [`Preparation`] divides preparing in the same way, and [`Frame::bands`] cuts the rows into bands of about equal work.
//!
//! | memory | bytes |
//! |---|---|
//! | a vertex | 20 ([`Vertex`]) |
//! | a primitive | 16 ([`Primitive`]) |
//! | an object | 72 ([`ObjectState`]) |
//! | a pixel of a band | the format's + 2 (depth) |
//!
//! Order: primitives are drawn in the order of the scene's objects and, within one, of its triangles, edges, points. What it will
//! not do: transparency, sorting.

mod bands;
mod check;
mod draw;
mod fragment;
mod parts;
mod prepare;
mod target;
mod walked;

use core::fmt;
use core::ops::Range;

use crate::hash::FrameHash;
use crate::output::PixelFormat;
use crate::scene::Scene;
use crate::shade::FogWeights;
use crate::texture::TextureError;
use crate::transform::{ClipMatrix, Vertex};

pub use bands::Bands;
pub use parts::{Part, Preparation, PrimitivePart, VertexPart};

/// The largest width and height of a frame.
pub const MAX_SIDE: u16 = 4096;

/// How triangles are walked. It cannot change a pixel; it exists to prove that.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Traversal {
    /// Row by row, with all that the processor has.
    #[default]
    Spans,
    /// Row by row, with nothing that the processor must be asked for: on x86-64, SSE2 and no more.
    Baseline,
    /// Row by row, pixel by pixel: what machines without vector registers do.
    Pixels,
    /// Tile by tile, 8 x 8 pixels.
    Tiles,
}

/// What a frame is like, besides its scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Width in pixels, 1 - 4096.
    pub width: u16,
    /// Height in pixels, 1 - 4096.
    pub height: u16,
    /// Ordered dither at the output.
    pub dither: bool,
    /// How triangles are walked.
    pub traversal: Traversal,
}

impl Settings {
    /// A frame of this size, without dither.
    pub const fn new(width: u16, height: u16) -> Settings {
        Settings { width, height, dither: false, traversal: Traversal::Spans }
    }
}

// The sizes that this module promises.
const _: () = assert!(size_of::<Vertex>() == 20);
const _: () = assert!(size_of::<Primitive>() == 16);
const _: () = assert!(size_of::<ObjectState>() == 72);

/// In place of an object's first vertex: its bounding sphere lies outside the view.
const UNSEEN: u32 = u32::MAX;

/// What the frame keeps for an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObjectState {
    /// Index of its first vertex in the store, or [`UNSEEN`].
    first_vertex: u32,
    /// Object to clip.
    clip: ClipMatrix,
}

impl Default for ObjectState {
    fn default() -> Self {
        ObjectState { first_vertex: 0, clip: ClipMatrix { m: [[0; 4]; 4], exponent: 0 } }
    }
}

/// What a primitive is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
enum Kind {
    #[default]
    Triangle,
    /// A triangle that only hides what lies behind it.
    Mask,
    Edge,
    Point,
}

/// Something to draw: a reference into the scene's meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Primitive {
    /// Index of the triangle, edge or position in its mesh.
    index: u32,
    /// First row that it may touch.
    top: i16,
    /// One past the last row.
    bottom: i16,
    /// Index of the object.
    object: u16,
    /// Colour of a flat triangle; of an edge, first how many more follow it.
    rgb: [u8; 3],
    /// [`Kind`] in the low bits, then [`CLIPPED`], [`BACK`].
    tag: u8,
}

/// The primitive must go through the clip stage when drawn.
const CLIPPED: u8 = 1 << 2;
/// A two-sided triangle seen from behind.
const BACK: u8 = 1 << 3;

impl Primitive {
    /// A triangle that is neither clipped nor seen from behind.
    const PLAIN: u8 = 0;
    /// What memory for primitives may begin as, in a static too.
    pub const EMPTY: Primitive =
        Primitive { index: 0, top: 0, bottom: 0, object: 0, rgb: [0; 3], tag: Primitive::PLAIN };

    /// Whether it may touch some rows.
    #[inline]
    fn touches(&self, rows: &Range<i32>) -> bool {
        (self.top as i32) < rows.end && self.bottom as i32 > rows.start
    }

    fn kind(&self) -> Kind {
        match self.tag & 3 {
            0 => Kind::Triangle,
            1 => Kind::Mask,
            2 => Kind::Edge,
            _ => Kind::Point,
        }
    }
}

/// Memory for a frame's prepared contents; [`Needed`] says how much.
#[derive(Debug)]
pub struct Store<'a> {
    /// One for each position of each object that can be seen.
    pub vertices: &'a mut [Vertex],
    /// One for each triangle, edge or point that can be seen.
    pub primitives: &'a mut [Primitive],
    /// One for each object.
    pub objects: &'a mut [ObjectState],
}

/// How much memory a frame needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Needed {
    /// Vertices.
    pub vertices: usize,
    /// Primitives.
    pub primitives: usize,
    /// Objects.
    pub objects: usize,
}

impl Needed {
    /// Enough for a scene from any camera, without looking at it closely.
    pub fn at_most(scene: &Scene) -> Needed {
        let mut needed = Needed { objects: scene.objects.len(), ..Needed::default() };
        for object in scene.objects {
            needed.vertices += object.mesh.positions.len();
            needed.primitives += prepare::most_primitives(object);
        }
        needed
    }

    /// The same in bytes.
    pub fn bytes(&self) -> usize {
        self.vertices * size_of::<Vertex>()
            + self.primitives * size_of::<Primitive>()
            + self.objects * size_of::<ObjectState>()
    }
}

/// What happened to a scene's geometry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Stats {
    /// Objects whose bounding sphere lies outside the view.
    pub objects_culled: u32,
    /// Vertices transformed.
    pub vertices: u32,
    /// Triangles looked at.
    pub triangles: u32,
    /// Triangles dropped for facing away or having no area.
    pub back_facing: u32,
    /// Primitives dropped for covering no pixel centre of the frame.
    pub outside: u32,
    /// Primitives that the clip stage must cut.
    pub clipped: u32,
    /// Primitives kept; up to 32 neighbouring edges inside the frame are one.
    pub primitives: u32,
}

/// Why a frame could not be prepared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PrepareError {
    /// Width or height is 0 or above 4096.
    Size {
        /// The width asked.
        width: u16,
        /// The height asked.
        height: u16,
    },
    /// The store is too small. Nothing is lost: give this much and prepare again.
    Store {
        /// How much is needed; `primitives` is exact once `vertices` and `objects` suffice, and enough before.
        needed: Needed,
        /// How much there was.
        given: Needed,
    },
    /// A mesh has an index beyond its positions, texture coordinates or normals.
    Index {
        /// Index of the object.
        object: usize,
        /// Index of its triangle, or edge where there are no triangles to blame.
        element: usize,
    },
    /// Parallel slices of a mesh differ in length.
    Lengths {
        /// Index of the object.
        object: usize,
    },
    /// A texture is not usable.
    Texture {
        /// Index of the object.
        object: usize,
        /// What is wrong.
        error: TextureError,
    },
    /// The background picture has not the frame's number of pixels.
    Background {
        /// Pixels in the frame.
        needed: usize,
        /// Pixels in the picture.
        given: usize,
    },
    /// More lights than [`MAX_LIGHTS`](crate::light::MAX_LIGHTS).
    Lights(usize),
    /// More than 65,536 objects.
    Objects(usize),
    /// The scene asks for something that was left out when the library was compiled.
    Feature {
        /// Index of the object that asks for it; `None` when the scene or the settings do.
        object: Option<usize>,
        /// Cargo's feature that brings it.
        feature: &'static str,
    },
}

impl fmt::Display for PrepareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            PrepareError::Size { width, height } => {
                write!(f, "frame of {width} x {height} pixels; each side must be 1 to {MAX_SIDE}")
            }
            PrepareError::Store { needed, given } => write!(
                f,
                "the store has room for {} vertices, {} primitives, {} objects and needs {}, {}, {} ({} bytes)",
                given.vertices,
                given.primitives,
                given.objects,
                needed.vertices,
                needed.primitives,
                needed.objects,
                needed.bytes()
            ),
            PrepareError::Index { object, element } => {
                write!(
                    f,
                    "object {object}: element {element} of its mesh has an index out of range"
                )
            }
            PrepareError::Lengths { object } => {
                write!(f, "object {object}: parallel slices of its mesh differ in length")
            }
            PrepareError::Texture { object, error } => write!(f, "object {object}: {error}"),
            PrepareError::Background { needed, given } => {
                write!(f, "the background has {given} pixels, the frame {needed}")
            }
            PrepareError::Lights(n) => {
                write!(f, "{n} lights; at most {} are possible", crate::light::MAX_LIGHTS)
            }
            PrepareError::Objects(n) => write!(f, "{n} objects; at most 65536 are possible"),
            PrepareError::Feature { object, feature } => {
                match object {
                    Some(object) => write!(f, "object {object}")?,
                    None => f.write_str("the scene")?,
                }
                write!(f, " needs what was left out: compile scanout with its feature `{feature}`")
            }
        }
    }
}

impl core::error::Error for PrepareError {}

/// Band memory is too small, or rows lie outside the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BandError {
    /// Less memory than the rows need.
    Memory {
        /// Words of colour memory needed.
        colour: usize,
        /// Words of depth memory needed.
        depth: usize,
    },
    /// The rows asked for are not rows of the frame.
    Rows {
        /// Rows in the frame.
        height: u16,
    },
}

impl fmt::Display for BandError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            BandError::Memory { colour, depth } => {
                write!(f, "the band needs {colour} words of colour and {depth} of depth memory")
            }
            BandError::Rows { height } => {
                write!(f, "the frame has {height} rows; draw rows within it")
            }
        }
    }
}

impl core::error::Error for BandError {}

/// Why drawing in bands ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DrawError<E> {
    /// The band memory does not do.
    Band(BandError),
    /// The sink failed.
    Sink(E),
}

impl<E: fmt::Display> fmt::Display for DrawError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            DrawError::Band(e) => e.fmt(f),
            DrawError::Sink(e) => write!(f, "the band could not be delivered: {e}"),
        }
    }
}

impl<E: fmt::Debug + fmt::Display> core::error::Error for DrawError<E> {}

/// Rows of finished pixels.
#[derive(Clone, Copy, Debug)]
pub struct Band<'a, F: PixelFormat> {
    /// First row.
    pub top: u16,
    /// Number of rows.
    pub rows: u16,
    /// Width in pixels.
    pub width: u16,
    /// `rows` x `F::words(width)` words.
    pub colour: &'a [F::Word],
    /// `rows` x `width` depths.
    pub depth: &'a [u16],
}

impl<F: PixelFormat> Band<'_, F> {
    /// Adds the band's pixels to a frame hash.
    pub fn add_to(&self, hash: &mut FrameHash) {
        let words = F::words(self.width as usize);
        for row in self.colour.chunks_exact(words) {
            F::bytes(row, self.width as usize, &mut |bytes| hash.update(bytes));
        }
    }
}

/// A scene ready to be drawn.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    scene: &'a Scene<'a>,
    settings: Settings,
    vertices: &'a [Vertex],
    /// All primitives; or, where there are parts, the memory that these have their lists in.
    primitives: &'a [Primitive],
    parts: &'a [Part],
    objects: &'a [ObjectState],
    fog: Option<FogWeights>,
    stats: Stats,
}

impl<'a> Frame<'a> {
    /// Counts of what was prepared.
    pub fn stats(&self) -> Stats {
        self.stats
    }

    /// The primitives in the order of drawing, list by list.
    fn lists(&self) -> impl Iterator<Item = &'a [Primitive]> {
        let (primitives, parts) = (self.primitives, self.parts);
        let whole = parts.is_empty().then_some(primitives);
        whole.into_iter().chain(parts.iter().map(|part| &primitives[part.listed()]))
    }

    /// The settings it was prepared with.
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// The whole frame's hash, drawn in bands of `lines` lines; see [`hash`](crate::hash).
    ///
    /// # Errors
    /// When the memory is too small for `lines` lines.
    pub fn hash<F: PixelFormat>(
        &self,
        lines: u16,
        colour: &mut [F::Word],
        depth: &mut [u16],
    ) -> Result<u64, BandError> {
        let mut hash = FrameHash::new(self.settings.width, self.settings.height, F::ID);
        let drawn = self.draw_bands::<F, core::convert::Infallible>(lines, colour, depth, |band| {
            band.add_to(&mut hash);
            Ok(())
        });
        match drawn {
            Ok(()) => Ok(hash.finish()),
            Err(DrawError::Band(e)) => Err(e),
            Err(DrawError::Sink(never)) => match never {},
        }
    }
}
