//! A model and its texture into the caller's memory: chunks of a file of any size in, a mesh out, in one pass.
//!
//! ```text
//!  v  -> millionths, i32      f -> triangles, face normals          finish: the box about what was referred to
//!  vn -> Q2.14, unit          (corners refer backwards)                     -> one grid, positions Q1.15
//!  vt -> Q16.16, v down
//! ```
//!
//! The grid and its rounding are those of the PC's loader (`scanout_assets::load`), so the frames are the same bits: the
//! box's centre at 0, its longest half side at 32760, to the nearest. Coordinates are exact for files of up to six
//! decimals, as Blender writes them; finer ones are rounded to millionths.
//!
//! | | |
//! |---|---|
//! | quads | cut along the shorter diagonal that lies inside, the first when about equal |
//! | five corners and more | a fan; right for convex polygons |
//! | normals | one a face where each face's corners share one; otherwise from its corners' positions |
//! | texels | RGB565, nearest |
//!
//! What it will not do: forward references, materials (`usemtl` is passed over), smooth normals.

use scanout::math::normalise;
use scanout::mesh::{Mesh, Normals};
use scanout::texture::{Texels, Texture};
use scanout_assets::number::Number;
use scanout_assets::obj::{self, Corner, Element, Event};
use scanout_assets::ppm;

use crate::fault::{FileFault, ModelFault, Part};
use crate::scene::{Model, Placement};

/// Greatest magnitude of a position on the grid, as the PC's loader has it.
const RANGE: i64 = 32_760;
/// Farthest coordinate, in millionths.
const FAR: i64 = 2_000_000_000;
/// "No texture coordinate here".
const NONE: u16 = u16::MAX;

/// Memory for a model. Bytes an element: 18 a position, 6 a normal, 8 a texture coordinate, 18 a triangle, 2 a texel.
#[derive(Debug)]
pub struct ModelMemory<'m> {
    /// Positions as they are read, in millionths.
    pub millionths: &'m mut [[i32; 3]],
    /// Positions on the grid, as many.
    pub positions: &'m mut [[i16; 3]],
    /// The file's normals.
    pub normals: &'m mut [[i16; 3]],
    /// Texture coordinates; one more than the file has may be needed.
    pub uvs: &'m mut [[i32; 2]],
    /// Triangles.
    pub triangles: &'m mut [[u16; 3]],
    /// Their texture coordinates, as many.
    pub uv_triangles: &'m mut [[u16; 3]],
    /// Their normals, as many.
    pub face_normals: &'m mut [[i16; 3]],
    /// The texture.
    pub texels: &'m mut [u16],
}

/// Counts of what was read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Positions.
    pub positions: usize,
    /// Normals.
    pub normals: usize,
    /// Texture coordinates.
    pub uvs: usize,
    /// Triangles.
    pub triangles: usize,
}

/// Reads an OBJ file, chunk by chunk.
#[derive(Debug)]
pub struct ObjReader<'r, 'm> {
    parser: obj::Parser,
    state: State<'r, 'm>,
}

#[derive(Debug)]
struct State<'r, 'm> {
    memory: &'r mut ModelMemory<'m>,
    totals: Totals,
    /// The face being read: its first corners, and how many there were.
    corners: [Corner; 4],
    count: usize,
    in_face: bool,
    /// Every face so far has one normal from the file.
    flat: bool,
    textured: bool,
    /// Corners without a texture coordinate.
    bare: bool,
    /// In millionths, of the positions that faces refer to.
    low: [i32; 3],
    high: [i32; 3],
}

impl<'r, 'm> ObjReader<'r, 'm> {
    /// A reader before the first byte.
    pub fn new(memory: &'r mut ModelMemory<'m>) -> Self {
        let nothing = Corner { position: 0, uv: None, normal: None };
        let state = State {
            memory,
            totals: Totals::default(),
            corners: [nothing; 4],
            count: 0,
            in_face: false,
            flat: true,
            textured: false,
            bare: false,
            low: [i32::MAX; 3],
            high: [i32::MIN; 3],
        };
        ObjReader { parser: obj::Parser::new(), state }
    }

    /// Reads a chunk.
    ///
    /// # Errors
    /// The first line that is malformed or has no room; feed no more then.
    pub fn feed(&mut self, chunk: &[u8]) -> Result<(), FileFault> {
        // By lines, so that a fault of the model has its line's number, too.
        for piece in chunk.split_inclusive(|byte| matches!(byte, b'\n' | b'\r')) {
            self.line(Some(piece))?;
        }
        Ok(())
    }

    /// The file ends here.
    ///
    /// # Errors
    /// As [`feed`](Self::feed), or there is nothing to draw.
    #[inline(never)]
    pub fn finish(&mut self) -> Result<Built, FileFault> {
        self.line(None)?;
        self.state.finish().map_err(FileFault::Model)
    }

    /// Reads a line or a piece of one; no bytes are the end of the file.
    #[inline(never)]
    fn line(&mut self, bytes: Option<&[u8]>) -> Result<(), FileFault> {
        let ObjReader { parser, state } = self;
        let (line, mut fault) = (parser.line(), None);
        let mut take = |event: Event<'_>| {
            if fault.is_none() {
                fault = state.event(event, line).err();
            }
        };
        // By reference, so that there is one copy of the parser.
        let mut sink: &mut dyn FnMut(Event<'_>) = &mut take;
        let result = match bytes {
            Some(bytes) => parser.feed(bytes, &mut sink),
            None => parser.finish(&mut sink),
        };
        match (fault, result) {
            (Some(fault), _) => Err(FileFault::Model(fault)),
            (None, result) => result.map_err(FileFault::Obj),
        }
    }
}

impl State<'_, '_> {
    fn event(&mut self, event: Event<'_>, line: u32) -> Result<(), ModelFault> {
        let full = |part, most| ModelFault::TooMany { line, part, most };
        match event {
            Event::Position { ref xyz, .. } => {
                // One step of an index is left for "no index".
                let most =
                    self.memory.millionths.len().min(self.memory.positions.len()).min(65_535);
                if self.totals.positions == most {
                    return Err(full(Part::Positions, most));
                }
                let slot = &mut self.memory.millionths[self.totals.positions];
                for (coordinate, number) in slot.iter_mut().zip(xyz) {
                    *coordinate = millionths(*number).ok_or(ModelFault::TooFar { line })?;
                }
                self.totals.positions += 1;
            }
            Event::Normal(xyz) => {
                let slot = self.memory.normals.get_mut(self.totals.normals);
                let Some(slot) = slot else {
                    return Err(full(Part::Normals, self.memory.normals.len()));
                };
                // Any length does; one without direction is zero, and the face's own is taken.
                let unit = normalise(xyz.map(|n| i64::from(n.to_q16()))).unwrap_or([0; 3]);
                *slot = unit.map(|v| ((v + (1 << 15)) >> 16) as i16);
                self.totals.normals += 1;
            }
            Event::Uv([u, v]) => {
                let most = self.memory.uvs.len().min(usize::from(NONE));
                if self.totals.uvs == most {
                    return Err(full(Part::TextureCoordinates, most));
                }
                let down = i32::try_from(65_536 - i64::from(v.to_q16())).unwrap_or(i32::MAX);
                self.memory.uvs[self.totals.uvs] = [u.to_q16(), down];
                self.totals.uvs += 1;
            }
            Event::Begin(element) => {
                self.in_face = element == Element::Face;
                self.count = 0;
            }
            Event::Corner(corner) if self.in_face => return self.corner(corner, line),
            Event::End if self.in_face => {
                self.in_face = false;
                match self.count {
                    3 => self.triangle([0, 1, 2], line)?,
                    4 if self.second_diagonal() => {
                        self.triangle([0, 1, 3], line)?;
                        self.triangle([1, 2, 3], line)?;
                    }
                    4 => self.first_diagonal(line)?,
                    _ => {}
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn corner(&mut self, corner: Corner, line: u32) -> Result<(), ModelFault> {
        let within = |index: Option<u32>, total| index.is_none_or(|index| (index as usize) < total);
        if !within(Some(corner.position), self.totals.positions)
            || !within(corner.uv, self.totals.uvs)
            || !within(corner.normal, self.totals.normals)
        {
            return Err(ModelFault::Undefined { line });
        }
        for (axis, v) in self.memory.millionths[corner.position as usize].into_iter().enumerate() {
            self.low[axis] = self.low[axis].min(v);
            self.high[axis] = self.high[axis].max(v);
        }
        self.textured |= corner.uv.is_some();
        self.bare |= corner.uv.is_none();
        let normal = |corner: &Corner| {
            let normal = self.memory.normals[corner.normal? as usize];
            (normal != [0; 3]).then_some(normal)
        };
        let own = normal(&corner);
        self.flat &= own.is_some() && (self.count == 0 || own == normal(&self.corners[0]));
        // The fifth corner shows that this is no quad; from then on the last slot moves along.
        if self.count >= 4 {
            if self.count == 4 {
                self.first_diagonal(line)?;
            }
            self.corners[2] = self.corners[3];
            self.corners[3] = corner;
            self.count += 1;
            return self.triangle([0, 2, 3], line);
        }
        self.corners[self.count] = corner;
        self.count += 1;
        Ok(())
    }

    fn first_diagonal(&mut self, line: u32) -> Result<(), ModelFault> {
        self.triangle([0, 1, 2], line)?;
        self.triangle([0, 2, 3], line)
    }

    fn triangle(&mut self, which: [usize; 3], line: u32) -> Result<(), ModelFault> {
        let index = self.totals.triangles;
        let memory = &mut *self.memory;
        let most =
            memory.triangles.len().min(memory.uv_triangles.len()).min(memory.face_normals.len());
        if index == most {
            return Err(ModelFault::TooMany { line, part: Part::Triangles, most });
        }
        for (place, corner) in which.into_iter().enumerate() {
            let Corner { position, uv, .. } = self.corners[corner];
            memory.triangles[index][place] = position as u16;
            memory.uv_triangles[index][place] = uv.map_or(NONE, |uv| uv as u16);
        }
        memory.face_normals[index] =
            self.corners[0].normal.map_or([0; 3], |normal| memory.normals[normal as usize]);
        self.totals.triangles += 1;
        Ok(())
    }

    /// Whether a quad is cut from its second corner to its fourth: when only that lies inside, or when it is shorter.
    #[inline(never)]
    fn second_diagonal(&self) -> bool {
        let p = self.corners.map(|c| self.memory.millionths[c.position as usize]);
        let mut size = 0;
        for corner in 1..4 {
            size = minus(&p, corner, 0, 0).iter().fold(size, |bits, v| bits | v.unsigned_abs());
        }
        let bits = 64 - size.leading_zeros();
        // Twice Newell's normal of a quad is the product of its diagonals. 20 bits a difference here.
        let fine = bits.saturating_sub(19);
        let n = cross(&minus(&p, 2, 0, fine), &minus(&p, 3, 1, fine));
        let mut inside = [false; 4];
        for (inside, [a, b, c]) in
            inside.iter_mut().zip([[0, 1, 2], [0, 2, 3], [0, 1, 3], [1, 2, 3]])
        {
            let normal = cross(&minus(&p, b, a, fine), &minus(&p, c, a, fine));
            let along = normal.iter().zip(&n).map(|(a, b)| i128::from(*a) * i128::from(*b));
            *inside = along.sum::<i128>() > 0;
        }
        // 30 bits a difference, so that squares fit.
        let coarse = bits.saturating_sub(29);
        let length = |a, b| i128::from(minus(&p, a, b, coarse).iter().map(|v| v * v).sum::<i64>());
        match (inside[0] && inside[1], inside[2] && inside[3]) {
            (true, false) => false,
            (false, true) => true,
            _ => 1000 * length(1, 3) < 998 * length(0, 2),
        }
    }

    fn finish(&mut self) -> Result<Built, ModelFault> {
        if self.totals.triangles == 0 {
            return Err(ModelFault::Nothing);
        }
        // In millionths: twice the half side, twice the middle.
        let (mut side, mut middle) = (0, [0; 3]);
        for (middle, (low, high)) in middle.iter_mut().zip(self.low.into_iter().zip(self.high)) {
            let (low, high) = (i64::from(low), i64::from(high));
            side = side.max(high - low);
            *middle = low + high;
        }
        let Totals { positions, triangles, .. } = self.totals;
        let (from, to) =
            (&self.memory.millionths[..positions], &mut self.memory.positions[..positions]);
        for (from, to) in from.iter().zip(to) {
            for axis in 0..3 {
                to[axis] = on_grid(2 * i64::from(from[axis]) - middle[axis], side);
            }
        }
        let mut totals = self.totals;
        if self.textured && self.bare {
            // Corners without coordinates get (0, 0), as in the PC's loader.
            let most = self.memory.uvs.len().min(usize::from(NONE));
            if totals.uvs == most {
                return Err(ModelFault::TooMany { line: 0, part: Part::TextureCoordinates, most });
            }
            self.memory.uvs[totals.uvs] = [0; 2];
            for corner in self.memory.uv_triangles[..triangles].as_flattened_mut() {
                if *corner == NONE {
                    *corner = totals.uvs as u16;
                }
            }
            totals.uvs += 1;
        }
        let placement = Placement {
            scale: if side == 0 {
                1 << 32
            } else {
                // Half the side / 10^6 * 32768 / 32760, Q32.32.
                ratio(side, 47, 2_000_000 * RANGE)
            },
            offset: middle.map(|middle| ratio(middle, 32, 2_000_000)),
        };
        Ok(Built { totals, placement, flat: self.flat, textured: self.textured })
    }
}

/// From corner `b` to corner `a` in steps of 2^`drop` millionths, downwards.
#[inline(never)]
fn minus(corners: &[[i32; 3]; 4], a: usize, b: usize, drop: u32) -> [i64; 3] {
    core::array::from_fn(|i| (i64::from(corners[a][i]) - i64::from(corners[b][i])) >> drop)
}

/// The cross product of differences of 20 bits.
#[inline(never)]
fn cross(&[a, b, c]: &[i64; 3], &[d, e, f]: &[i64; 3]) -> [i64; 3] {
    [b * f - c * e, c * d - a * f, a * e - b * d]
}

/// `n 2^up / d`, nearest, halves upwards: a division, then a bit a step. `n` and `d` below 2^61, the result below 2^63.
fn ratio(n: i64, up: u32, d: i64) -> i64 {
    let (mut quotient, mut rest) = (n.div_euclid(d), n.rem_euclid(d));
    for _ in 0..up {
        rest *= 2;
        let next = i64::from(rest >= d);
        (quotient, rest) = (2 * quotient + next, rest - next * d);
    }
    quotient + i64::from(2 * rest >= d)
}

/// `32760 twice / side`, the nearest, halves away from zero.
fn on_grid(twice: i64, side: i64) -> i16 {
    if side == 0 {
        return 0;
    }
    let magnitude = (2 * RANGE * twice.abs() + side) / (2 * side);
    // What no face refers to may lie beyond.
    let magnitude = magnitude.min(32_767);
    (if twice < 0 { -magnitude } else { magnitude }) as i16
}

/// A decimal number in millionths, the nearest; `None` beyond 2,000.
fn millionths(number: Number) -> Option<i32> {
    let (mut value, mut half) = (number.mantissa, false);
    for _ in 0..(number.exponent + 6).clamp(0, 10) {
        // Beyond 2^31 already, which more digits don't change.
        value = if value.abs() > FAR { value } else { 10 * value };
    }
    // Floor by floor is the floor of the whole; what decides the rounding is the last digit taken off and nothing below it,
    // as halves go upwards. |mantissa| < 10^18, so 20 digits leave nothing.
    for _ in (number.exponent + 6).clamp(-20, 0)..0 {
        half = value.rem_euclid(10) >= 5;
        value = value.div_euclid(10);
    }
    value += i64::from(half);
    i32::try_from(value).ok().filter(|v| i64::from(*v).abs() <= FAR)
}

/// What an [`ObjReader`] left in the memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Built {
    /// How much of what.
    pub totals: Totals,
    placement: Placement,
    flat: bool,
    textured: bool,
}

/// A picture's size, its texels being in the memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Picture {
    width: u16,
    height: u16,
}

impl Built {
    /// The model in the memory that it was read into.
    #[inline(never)]
    pub fn model<'m>(&self, memory: &'m ModelMemory<'_>, picture: Option<Picture>) -> Model<'m> {
        let Totals { positions, uvs, triangles, .. } = self.totals;
        let normals = match self.flat {
            true => Normals::Face(&memory.face_normals[..triangles]),
            false => Normals::None,
        };
        let (uvs, uv_triangles) = if self.textured { (uvs, triangles) } else { (0, 0) };
        let mesh = Mesh {
            positions: &memory.positions[..positions],
            normals,
            uvs: &memory.uvs[..uvs],
            triangles: &memory.triangles[..triangles],
            uv_triangles: &memory.uv_triangles[..uv_triangles],
            ..Mesh::default()
        };
        let texture = picture
            .and_then(|p| Texture::new(p.width, p.height, Texels::Rgb565(memory.texels)).ok());
        Model { mesh, texture, placement: self.placement }
    }
}

/// Reads a PPM or PGM file, chunk by chunk.
#[derive(Debug)]
pub struct PpmReader<'r> {
    parser: ppm::Parser,
    texels: &'r mut [u16],
    count: usize,
    size: Option<(u32, u32)>,
}

impl<'r> PpmReader<'r> {
    /// A reader before the first byte.
    pub fn new(texels: &'r mut [u16]) -> Self {
        PpmReader { parser: ppm::Parser::new(), texels, count: 0, size: None }
    }

    /// Whether the last texel was read; what follows may stay on the card.
    pub fn is_done(&self) -> bool {
        self.parser.is_done()
    }

    /// Reads a chunk.
    ///
    /// # Errors
    /// The file is malformed or its texels don't fit the memory; feed no more then.
    pub fn feed(&mut self, chunk: &[u8]) -> Result<(), FileFault> {
        self.step(Some(chunk))
    }

    fn step(&mut self, chunk: Option<&[u8]>) -> Result<(), FileFault> {
        let PpmReader { parser, texels, count, size } = self;
        let mut take = |event: ppm::Event| match event {
            ppm::Event::Header { width, height } => *size = Some((width, height)),
            ppm::Event::Texel(rgb) => {
                if let Some(texel) = texels.get_mut(*count) {
                    *texel = pack(rgb);
                }
                *count += 1;
            }
        };
        // By reference, so that there is one copy of the parser; no chunk is the end of the file.
        let mut sink: &mut dyn FnMut(ppm::Event) = &mut take;
        let result = match chunk {
            Some(chunk) => parser.feed(chunk, &mut sink),
            None => parser.finish(&mut sink),
        };
        self.fits()?;
        result.map_err(FileFault::Ppm)
    }

    /// The file ends here.
    ///
    /// # Errors
    /// As [`feed`](Self::feed), or texels are missing.
    pub fn finish(&mut self) -> Result<Picture, FileFault> {
        self.step(None)?;
        // Done, so there was a header, which fitted.
        let (width, height) = self.size.unwrap_or((0, 0));
        Ok(Picture { width: width as u16, height: height as u16 })
    }

    fn fits(&self) -> Result<(), FileFault> {
        match self.size {
            Some((width, height))
                if width > 1024
                    || height > 1024
                    || (width * height) as usize > self.texels.len() =>
            {
                let most = self.texels.len();
                Err(FileFault::Model(ModelFault::Texture { width, height, most }))
            }
            _ => Ok(()),
        }
    }
}

/// RGB565, each channel rounded to the nearest, as the PC's loader does.
fn pack([r, g, b]: [u8; 3]) -> u16 {
    let scale = |c: u8, most: u16| (u16::from(c) * most + 127) / 255;
    scale(r, 31) << 11 | scale(g, 63) << 5 | scale(b, 31)
}
