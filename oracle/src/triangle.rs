//! What the renderers are asked to draw, and the form of their answers.

/// Sub-pixel steps in a pixel: positions are multiples of 1/16 pixel.
pub const STEPS: i32 = 16;

/// Depth of the far plane: 65535 in U16.16.
pub const FAR: u32 = 65535 << 16;

/// A corner in snapped window coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Vertex {
    /// Distance from the picture's left edge in 1/16 pixel, rightwards.
    pub x: i32,
    /// Distance from the picture's top edge in 1/16 pixel, downwards.
    pub y: i32,
    /// Depth, U16.16: 0 at the near plane, [`FAR`] at the far plane.
    pub z: u32,
    /// Red, green, blue, 0 to 255. Colours are interpolated linearly on the screen.
    pub colour: [u8; 3],
    /// Texture coordinates u (right) and v (down), Q16.16: 1.0 is one repeat of the texture.
    pub uv: [i32; 2],
    /// 1/w of the corner, in any unit: texture coordinates are interpolated as `(u q) / q`.
    pub q: u32,
}

/// Three corners in either order: both sides are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Triangle(pub [Vertex; 3]);

/// What happens to texture coordinates outside [0, 1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrap {
    /// The texture repeats.
    Repeat,
    /// Every second repeat is mirrored.
    Mirror,
    /// The outermost texel continues.
    Clamp,
}

/// A texture whose texels show their own position, so that the picture tells which texel was fetched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Texture {
    /// Columns, 1 to 256.
    pub width: u32,
    /// Rows, 1 to 256.
    pub height: u32,
    /// Applied to both directions.
    pub wrap: Wrap,
}

impl Texture {
    /// The texels row by row as RGBA: red is the column, green is the row, blue the low byte of their product (a check),
    /// alpha 255.
    #[must_use]
    pub fn rgba(&self) -> Vec<u8> {
        let texel = |i: u32| {
            let (column, row) = (i % self.width, i / self.width);
            [column as u8, row as u8, (column * row) as u8, 255]
        };
        (0..self.width * self.height).flat_map(texel).collect()
    }

    /// The texel that a colour names; `None` where the colour is no texel of this texture.
    #[must_use]
    pub fn texel(&self, [column, row, check]: [u8; 3]) -> Option<Texel> {
        let inside = u32::from(column) < self.width && u32::from(row) < self.height;
        (inside && check == column.wrapping_mul(row)).then_some(Texel { column, row })
    }
}

/// Column and row of a texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Texel {
    /// 0 is the leftmost column.
    pub column: u8,
    /// 0 is the first row of the texture's memory.
    pub row: u8,
}

/// Colour and depth of a covered pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fragment {
    /// Red, green, blue, 0 to 255.
    pub colour: [u8; 3],
    /// 0 at the near plane, `u32::MAX` at the far plane.
    pub depth: u32,
}

/// One value a pixel, rows from top to bottom; `None` where the triangle does not cover the pixel's centre.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture<T> {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` values.
    pub pixels: Vec<Option<T>>,
}

/// The pixels that a triangle covers.
pub type Coverage = Picture<()>;

impl<T> Picture<T> {
    /// A picture in which nothing is covered.
    #[must_use]
    pub fn empty(width: u32, height: u32) -> Self {
        let pixels = std::iter::repeat_with(|| None).take((width * height) as usize).collect();
        Self { width, height, pixels }
    }

    /// Forgets the values and keeps which pixels are covered.
    #[must_use]
    pub fn coverage(&self) -> Coverage {
        let pixels = self.pixels.iter().map(|p| p.as_ref().map(|_| ())).collect();
        Picture { width: self.width, height: self.height, pixels }
    }

    /// Number of covered pixels.
    #[must_use]
    pub fn covered(&self) -> usize {
        self.pixels.iter().flatten().count()
    }
}

/// How far a renderer's planes may be off by its own number formats, before its results are rounded to colours, depths and
/// texels. Where that is too far, a renderer cannot judge another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding {
    /// In 1/255.
    pub colour: f64,
    /// In 1/65535 of the depth range.
    pub depth: f64,
    /// Of the planes u q and v q, in Q16.16 times the corners' unit of q.
    pub uvq: [f64; 2],
    /// Of the plane q, in the corners' unit.
    pub q: f64,
    /// Where the renderer's own texture coordinates begin, in Q16.16: an error of q counts for the distance from there.
    pub origin: [f64; 2],
    /// Of texture coordinates besides what comes from the planes, in texels.
    pub texel: f64,
}

/// Something that draws one triangle into an empty picture of its own size.
pub trait Renderer {
    /// For messages.
    fn name(&self) -> &str;

    /// Width and height of the pictures, in pixels.
    fn size(&self) -> (u32, u32);

    /// Bounds of its rounding over the pixels of this triangle.
    fn rounding(&self, triangle: &Triangle) -> Rounding;

    /// The pixels whose centre the triangle covers by the top-left rule.
    fn coverage(&mut self, triangle: &Triangle) -> Coverage;

    /// Colour and depth of the covered pixels; no texture, no depth test.
    fn colour_depth(&mut self, triangle: &Triangle) -> Picture<Fragment>;

    /// The nearest texel that each covered pixel shows, perspective-correct.
    fn texels(&mut self, triangle: &Triangle, texture: &Texture) -> Picture<Texel>;
}
