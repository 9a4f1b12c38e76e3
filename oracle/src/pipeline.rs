//! `scanout` itself, behind the same three questions: its public stages `setup`, `raster` and `interpolate`, called as its own
//! frame loop calls them.

use scanout::interpolate::channel;
use scanout::raster::triangle::spans;
use scanout::{depth, setup};

use crate::triangle::{
    Coverage, Fragment, Picture, Renderer, Rounding, Texel, Texture, Triangle, Vertex,
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
        spans(&prepared, 0..self.height as i32, width, |y, columns| {
            for x in columns {
                let pixel = &mut picture.pixels[(y * width + x) as usize];
                assert!(pixel.is_none(), "pixel {x}, {y} drawn twice");
                *pixel = Some(value(&prepared, x, y));
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

    /// None: every pixel is judged.
    fn rounding(&self, _: &Triangle) -> Rounding {
        Rounding { colour: 0.0, depth: 0.0, uvq: [0.0; 2], q: 0.0 }
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

    fn texels(&mut self, _: &Triangle, _: &Texture) -> Picture<Texel> {
        unimplemented!("until scanout sets up texture planes from corners in public")
    }
}
