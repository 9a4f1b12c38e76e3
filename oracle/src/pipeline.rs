//! `scanout` itself, behind the same three questions: its public stages `setup`, `raster`, `interpolate`, `texture` and `depth`, called as its own
//! frame loop calls them.

use scanout::interpolate::channel;
use scanout::raster::triangle::{Run, Runs};
use scanout::texture::{General, Sampler, TextureSetup, integer_q, reciprocal};
use scanout::{depth, setup, texture};

use crate::triangle::{
    Coverage, Fragment, Picture, Renderer, Rounding, STEPS, Texel, Texture, Triangle, Vertex, Wrap,
};

/// A picture drawn by `scanout`, whole and by spans.
#[derive(Clone, Copy, Debug)]
pub struct Pipeline {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Pipeline {
    /// A picture with `value(triangle, x, y)` at each covered pixel.
    fn draw<T>(
        &self,
        triangle: &Triangle,
        mut value: impl FnMut(&setup::Triangle, i32, i32) -> T,
    ) -> Picture<T> {
        let mut picture = Picture::empty(self.width, self.height);
        let corners = triangle.0.map(|v| [v.x, v.y]);
        let Some(prepared) = setup::Triangle::new(corners) else { return picture };
        let width = self.width as i32;
        Runs::spans(&prepared, 0..self.height as i32, 0..width).for_each(|Run { y, x0, x1 }| {
            for x in x0..x1 {
                let pixel = &mut picture.pixels[y * width as usize + x];
                assert!(pixel.is_none(), "pixel {x}, {y} drawn twice");
                *pixel = Some(value(&prepared, x as i32, y as i32));
            }
        });
        picture
    }
}

impl Renderer for Pipeline {
    fn name(&self) -> &str {
        "scanout"
    }

    fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Colour and depth: none, every pixel is judged.
    ///
    /// Texels: gradients are rounded to nearest, so a plane is off by half a unit for each column and row from the first corner,
    /// and by the unit of its constant. The unit of `s/w` is at most 2^-30 of the largest corner's; that of `q` is 1/256
    /// where the largest is at least 2^22, and the plane's value is then rounded down to an integer. Coordinates are
    /// rounded to 1/4096 texel twice: at the corners and at the pixel.
    fn rounding(&self, triangle: &Triangle) -> Rounding {
        let extent = |of: fn(&Vertex) -> i32| {
            let [a, b, c] = triangle.0.each_ref().map(of);
            f64::from(a.max(b).max(c) - a.min(b).min(c)) / f64::from(STEPS)
        };
        let units = 0.5 * (extent(|v| v.x) + extent(|v| v.y)) + 2.0;
        let shift = q_shift(triangle);
        // Whole repeats are taken off first.
        let origin = [0, 1].map(|n| {
            let low = triangle.0.iter().map(|v| v.uv[n]).fold(i32::MAX, i32::min);
            f64::from(low & !0xffff)
        });
        let largest = |n: usize| {
            let product = |v: &Vertex| (f64::from(v.uv[n]) - origin[n]) * f64::from(v.q);
            triangle.0.iter().map(product).fold(0.0, f64::max)
        };
        Rounding {
            colour: 0.0,
            depth: 0.0,
            uvq: [0, 1].map(|n| units * largest(n) / f64::from(1 << 30)),
            q: (units / 256.0 + 1.0) / f64::from(1 << shift),
            origin,
            texel: 2.0 / 8192.0,
        }
    }

    fn coverage(&mut self, triangle: &Triangle) -> Coverage {
        self.draw(triangle, |_, _, _| ())
    }

    fn colour_depth(&mut self, triangle: &Triangle) -> Picture<Fragment> {
        let values = |of: fn(&Vertex) -> u32| triangle.0.each_ref().map(of);
        let planes: [fn(&Vertex) -> u32; 4] = [
            |v| u32::from(v.colour[0]) << 16,
            |v| u32::from(v.colour[1]) << 16,
            |v| u32::from(v.colour[2]) << 16,
            |v| v.z,
        ];
        let Some(prepared) = setup::Triangle::new(triangle.0.map(|v| [v.x, v.y])) else {
            return Picture::empty(self.width, self.height);
        };
        let [red, green, blue, z] = planes.map(|of| prepared.plane(values(of)));
        self.draw(triangle, |_, x, y| Fragment {
            colour: [red, green, blue].map(|plane| channel(plane.at(x, y))),
            // 65535 becomes u32::MAX.
            depth: u32::from(depth::round(z.at(x, y))) * 65537,
        })
    }

    fn texels(&mut self, triangle: &Triangle, texture: &Texture) -> Picture<Texel> {
        let Some(prepared) = setup::Triangle::new(triangle.0.map(|v| [v.x, v.y])) else {
            return Picture::empty(self.width, self.height);
        };
        let rgba = texture.rgba();
        let texels: Vec<[u8; 3]> = rgba.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect();
        let (width, height) = (texture.width as u16, texture.height as u16);
        let mut texels = texture::Texture::new(width, height, texture::Texels::Rgb888(&texels))
            .expect("sizes from 1 to 256");
        texels.wrap = [match texture.wrap {
            Wrap::Repeat => texture::Wrap::Repeat,
            Wrap::Mirror => texture::Wrap::Mirror,
            Wrap::Clamp => texture::Wrap::Clamp,
        }; 2];
        let shift = q_shift(triangle);
        let q = triangle.0.map(|v| v.q << shift);
        let setup = TextureSetup::new(&prepared, &texels, triangle.0.map(|v| v.uv), q);
        let plane = prepared.plane(q.map(|q| q << 8));
        self.draw(triangle, |_, x, y| {
            let q = integer_q(plane.at(x, y));
            let st = setup.perspective.st.map(|plane| plane.at(x, y));
            let colour = General(&texels).texel(&setup, st, q, reciprocal(q));
            texture.texel(colour).expect("a colour of the texture")
        })
    }
}

/// The shift that brings the largest of the corners' q into [2^22, 2^23), as the vertex stage delivers it.
///
/// # Panics
/// If one of them is 2^23 or more, or all are 0.
fn q_shift(triangle: &Triangle) -> u32 {
    let largest = triangle.0.iter().map(|v| v.q).fold(0, u32::max);
    assert!((1..1 << 23).contains(&largest), "1/w of at most 23 bits");
    largest.leading_zeros() - 9
}
