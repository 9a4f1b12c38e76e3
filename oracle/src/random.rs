//! Reproducible random triangles of the kinds that break rasterisers.

use crate::triangle::{FAR, STEPS, Triangle, Vertex};

/// SplitMix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators, 2014).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The same seed gives the same numbers.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number of `low..high`.
    ///
    /// # Panics
    /// If the range is empty.
    pub fn range(&mut self, low: i32, high: i32) -> i32 {
        assert!(low < high);
        let width = (i64::from(high) - i64::from(low)) as u64;
        (i64::from(low) + (self.bits() % width) as i64) as i32
    }
}

/// What is special about a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// At most 8 pixels wide and high, anywhere in the picture.
    Small,
    /// Corners anywhere in the picture.
    Large,
    /// Two corners at most 1 pixel apart, the third anywhere.
    Sliver,
    /// Corners up to one picture outside the picture.
    Outside,
    /// All corners on pixel centres or pixel corners, so that edges run through centres: the fill rule decides.
    Centred,
    /// Edges along a row or column of pixel centres.
    Axis,
}

impl Kind {
    /// Every kind.
    pub const ALL: [Kind; 6] =
        [Kind::Small, Kind::Large, Kind::Sliver, Kind::Outside, Kind::Centred, Kind::Axis];
}

/// A random triangle for a picture of `width` by `height` pixels: random attributes, depth over the whole range (half of the
/// triangles: over 1/64 of it), texture coordinates within [-1, 2), 1/w within a ratio of 64.
pub fn triangle(random: &mut Random, kind: Kind, width: u32, height: u32) -> Triangle {
    let (w, h) = (width as i32 * STEPS, height as i32 * STEPS);
    let near = |r: &mut Random, (x, y): (i32, i32), d: i32| {
        (r.range(x - d, x + d + 1), r.range(y - d, y + d + 1))
    };
    let centre = |(x, y): (i32, i32)| (x & !(STEPS / 2 - 1), y & !(STEPS / 2 - 1));
    let a = (random.range(0, w), random.range(0, h));
    let (b, c) =
        ((random.range(0, w), random.range(0, h)), (random.range(0, w), random.range(0, h)));
    let corners = match kind {
        Kind::Small => [a, near(random, a, 4 * STEPS), near(random, a, 4 * STEPS)],
        Kind::Large => [a, b, c],
        Kind::Sliver => [a, near(random, a, STEPS), c],
        Kind::Outside => [a, b, c].map(|_| (random.range(-w, 2 * w), random.range(-h, 2 * h))),
        Kind::Centred => {
            let reach = 8 * STEPS;
            let pair = if random.bits().is_multiple_of(2) {
                (b, c)
            } else {
                (near(random, a, reach), near(random, a, reach))
            };
            [centre(a), centre(pair.0), centre(pair.1)]
        }
        Kind::Axis => {
            let a = centre(a);
            let c = if random.bits().is_multiple_of(2) { centre(c) } else { c };
            let b = if random.bits().is_multiple_of(2) { (a.0, b.1) } else { (b.0, a.1) };
            [a, b, c]
        }
    };
    let order = random.bits() as usize;
    let mut corners = corners.map(|(x, y)| vertex(random, x, y));
    if order & 16 != 0 {
        let middle = corners[0].z.clamp(1 << 26, FAR - (1 << 26));
        for corner in &mut corners {
            corner.z = middle - (1 << 25) + (corner.z >> 6);
        }
    }
    corners.rotate_left(order % 3);
    if order & 8 != 0 {
        corners.swap(0, 1);
    }
    Triangle(corners)
}

/// A corner with random attributes.
pub fn vertex(random: &mut Random, x: i32, y: i32) -> Vertex {
    let z = match random.range(0, 8) {
        0 => 0,
        1 => FAR,
        _ => (random.bits() % (u64::from(FAR) + 1)) as u32,
    };
    let colour = [(); 3].map(|()| match random.range(0, 8) {
        0 => 0,
        1 => 255,
        _ => random.bits() as u8,
    });
    let uv = [(); 2].map(|()| random.range(-1 << 16, 2 << 16));
    let octave = 1 << random.range(10, 16);
    let q = (octave + random.range(0, octave)) as u32;
    Vertex { x, y, z, colour, uv, q }
}
