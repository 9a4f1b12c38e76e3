//! Mesa's software renderer llvmpipe through OSMesa, loaded at run time.
//!
//! # How it is fed
//! Corners go in as they are after snapping, through identity matrices and a viewport four times the picture's size, centred on
//! the picture: `x_ndc = x / (32 W)` with x measured from the picture's centre. With W and H powers of two the way back to window
//! coordinates is exact in floats, and llvmpipe's own snapping (8 sub-pixel bits) keeps our 4. What reaches out of the picture by
//! up to 1.5 pictures is not clipped, so GL cuts no triangle.
//!
//! Window coordinates are linear in x and y (w = 1): colour and depth are planes on the screen. Perspective enters through the
//! texture coordinates `(s q, t q, 0, q)`, which GL divides at each pixel.
//!
//! GL's y points up, ours down: row 0 of the picture is GL's row 0, and nothing is mirrored. llvmpipe then applies the
//! top-left rule in memory order, which is ours; `tests/judges.rs` shows it with edges through pixel centres.
//!
//! # What it will not do
//! It takes no triangle that reaches further out, and it draws on the thread that created it.

use std::ffi::{CStr, c_int};
use std::fmt;
use std::marker::PhantomData;
use std::rc::Rc;

use crate::gl::{self, Functions};
use crate::triangle::{
    Coverage, FAR, Fragment, Picture, Renderer, Rounding, STEPS, Texel, Texture, Triangle, Vertex,
    Wrap,
};

/// The file that is looked for by the system's loader, unless the environment variable `SCANOUT_OSMESA` names another.
const LIBRARY: &str = "libOSMesa.so.8";

/// Why there is no judge.
#[derive(Debug)]
pub enum LoadError {
    /// The library is not installed.
    Missing(libloading::Error),
    /// The library is there but does not do what is needed.
    Unusable(String),
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing(_) => write!(f, "libOSMesa not found; install libosmesa6"),
            Self::Unusable(why) => write!(f, "libOSMesa cannot judge: {why}"),
        }
    }
}

impl std::error::Error for LoadError {}

/// A window of pixels drawn by llvmpipe.
///
/// `Rc` makes it neither `Send` nor `Sync`: GL contexts belong to one thread.
pub struct Llvmpipe {
    gl: Functions,
    context: gl::RawContext,
    /// OSMesa draws into this memory; it is never read here (see `read`), and never moves while the context lives.
    buffer: Box<[u32]>,
    width: u32,
    height: u32,
    _one_thread: PhantomData<Rc<()>>,
}

impl Llvmpipe {
    /// Loads the library and makes a context of `width` by `height` pixels, RGBA and a depth buffer of 24 bits or more.
    ///
    /// # Errors
    /// [`LoadError::Missing`] when the library is not installed, [`LoadError::Unusable`] when it is not llvmpipe or gives no
    /// such context.
    pub fn new(width: u32, height: u32) -> Result<Self, LoadError> {
        let file = std::env::var_os("SCANOUT_OSMESA").unwrap_or_else(|| LIBRARY.into());
        // SAFETY: loading runs Mesa's initialisers, which are those of any program linked with it.
        let library = unsafe { libloading::Library::new(file) }.map_err(LoadError::Missing)?;
        let gl = Functions::new(library).map_err(|e| LoadError::Unusable(e.to_string()))?;
        // SAFETY: plain values, and a null pointer for "shares nothing".
        let context = unsafe { (gl.create_context)(gl::RGBA, 32, 0, 0, std::ptr::null_mut()) };
        if context.is_null() {
            return Err(LoadError::Unusable("no context with 32 bits of depth".into()));
        }
        let buffer = vec![0; (width * height) as usize].into_boxed_slice();
        let mut this = Self { gl, context, buffer, width, height, _one_thread: PhantomData };
        if !this.make_current() {
            return Err(LoadError::Unusable(format!("no buffer of {width} x {height} pixels")));
        }
        let renderer = this.string(gl::RENDERER);
        if !renderer.contains("llvmpipe") {
            return Err(LoadError::Unusable(format!("the renderer is {renderer}, not llvmpipe")));
        }
        if this.depth_bits() < 24 {
            return Err(LoadError::Unusable(format!("{} bits of depth", this.depth_bits())));
        }
        this.set_up();
        Ok(this)
    }

    /// Makes this context the thread's current one; every public function begins with it.
    fn make_current(&mut self) -> bool {
        let (width, height) = (self.width as c_int, self.height as c_int);
        let buffer = self.buffer.as_mut_ptr().cast();
        // SAFETY: the context is alive, the buffer holds width * height RGBA pixels and outlives the context.
        unsafe {
            (self.gl.make_current)(self.context, buffer, gl::UNSIGNED_BYTE, width, height) != 0
        }
    }

    /// State that never changes.
    fn set_up(&mut self) {
        let gl = &self.gl;
        let (width, height) = (self.width as c_int, self.height as c_int);
        // SAFETY: the context is current; all arguments are plain values.
        unsafe {
            (gl.viewport)(-3 * width / 2, -3 * height / 2, 4 * width, 4 * height);
            (gl.depth_range)(0.0, 1.0);
            (gl.clear_colour)(0.0, 0.0, 0.0, 0.0);
            (gl.clear_depth)(1.0);
            (gl.disable)(gl::DITHER);
            (gl.enable)(gl::DEPTH_TEST);
            (gl.shade_model)(gl::SMOOTH);
            for (name, value) in
                [(gl::TEXTURE_MIN_FILTER, gl::NEAREST), (gl::TEXTURE_MAG_FILTER, gl::NEAREST)]
            {
                (gl.texture_parameter)(gl::TEXTURE_2D, name, value);
            }
            (gl.texture_environment)(gl::TEXTURE_ENV, gl::TEXTURE_ENV_MODE, gl::REPLACE);
        }
    }

    fn string(&self, name: u32) -> String {
        // SAFETY: the context is current; GL returns a null pointer or a static string that ends with a zero.
        unsafe {
            let text = (self.gl.get_string)(name);
            if text.is_null() {
                return String::new();
            }
            CStr::from_ptr(text).to_string_lossy().into_owned()
        }
    }

    /// The renderer and version as they name themselves.
    pub fn description(&mut self) -> String {
        self.make_current();
        format!("{}, {}", self.string(gl::RENDERER), self.string(gl::VERSION))
    }

    /// Bits of the depth buffer.
    pub fn depth_bits(&mut self) -> u32 {
        self.make_current();
        let mut bits = 0;
        // SAFETY: the context is current; this name writes one integer.
        unsafe { (self.gl.get_integer)(gl::DEPTH_BITS, &mut bits) };
        bits as u32
    }

    /// Empties the picture: transparent black, depth at the far plane.
    pub fn clear(&mut self) {
        self.make_current();
        // SAFETY: the context is current.
        unsafe { (self.gl.clear)(gl::COLOR_BUFFER_BIT | gl::DEPTH_BUFFER_BIT) };
    }

    /// Draws triangles over what is there, with alpha 255; a fragment passes when strictly nearer if `depth_test`, always
    /// otherwise.
    ///
    /// # Panics
    /// If a corner lies more than 1.5 pictures outside (GL would clip), or GL reports an error.
    pub fn draw(&mut self, triangles: &[Triangle], texture: Option<&Texture>, depth_test: bool) {
        self.make_current();
        match texture {
            Some(texture) => self.bind(texture),
            // SAFETY: the context is current.
            None => unsafe { (self.gl.disable)(gl::TEXTURE_2D) },
        }
        // SAFETY: the context is current.
        unsafe {
            (self.gl.depth_function)(if depth_test { gl::LESS } else { gl::ALWAYS });
            (self.gl.begin)(gl::TRIANGLES);
        }
        for vertex in triangles.iter().flat_map(|t| &t.0) {
            self.emit(vertex);
        }
        // SAFETY: the context is current and between begin and end.
        let error = unsafe {
            (self.gl.end)();
            (self.gl.get_error)()
        };
        assert_eq!(error, 0, "GL error {error:#x}");
    }

    /// One corner, between begin and end.
    fn emit(&self, vertex: &Vertex) {
        let device = |position: i32, size: u32| {
            let position = f64::from(position) / f64::from(STEPS) - f64::from(size) / 2.0;
            let device = position / (2.0 * f64::from(size));
            assert!(device.abs() <= 1.0, "corner further out than 1.5 pictures: {vertex:?}");
            device as f32
        };
        let (x, y) = (device(vertex.x, self.width), device(vertex.y, self.height));
        let z = (f64::from(vertex.z) / f64::from(FAR) * 2.0 - 1.0) as f32;
        let q = f64::from(vertex.q);
        let [s, t] = vertex.uv.map(|c| (f64::from(c) / 65536.0 * q) as f32);
        let [red, green, blue] = vertex.colour;
        // SAFETY: the context is current; all arguments are plain values.
        unsafe {
            (self.gl.colour)(red, green, blue, 255);
            (self.gl.texture_coordinate)(s, t, 0.0, q as f32);
            (self.gl.vertex)(x, y, z, 1.0);
        }
    }

    /// Makes `texture` the one that is drawn with.
    fn bind(&mut self, texture: &Texture) {
        let wrap = match texture.wrap {
            Wrap::Repeat => gl::REPEAT,
            Wrap::Mirror => gl::MIRRORED_REPEAT,
            Wrap::Clamp => gl::CLAMP_TO_EDGE,
        };
        let texels = texture.rgba();
        let (width, height) = (texture.width as c_int, texture.height as c_int);
        let gl = &self.gl;
        // SAFETY: the context is current; GL reads width * height * 4 bytes during the call, which is the length of `texels`
        // (rows of 4-byte texels satisfy the default alignment of 4).
        unsafe {
            (gl.enable)(gl::TEXTURE_2D);
            (gl.texture_parameter)(gl::TEXTURE_2D, gl::TEXTURE_WRAP_S, wrap);
            (gl.texture_parameter)(gl::TEXTURE_2D, gl::TEXTURE_WRAP_T, wrap);
            let pixels = texels.as_ptr().cast();
            let format = gl::RGBA;
            (gl.texture_image)(
                gl::TEXTURE_2D,
                0,
                format as c_int,
                width,
                height,
                0,
                format,
                gl::UNSIGNED_BYTE,
                pixels,
            );
        }
    }

    fn read<T: Clone + Default>(&mut self, format: u32, kind: u32) -> Vec<T> {
        assert_eq!(size_of::<T>(), 4, "one value of four bytes a pixel");
        self.make_current();
        let (width, height) = (self.width as c_int, self.height as c_int);
        let mut pixels = vec![T::default(); (self.width * self.height) as usize];
        // SAFETY: the context is current; GL writes width * height values of 4 bytes, the length of `pixels`; only
        // u32 and [u8; 4] are used for T, for which every bit pattern is a value.
        unsafe {
            let target = pixels.as_mut_ptr().cast();
            (self.gl.read_pixels)(0, 0, width, height, format, kind, target);
        }
        pixels
    }

    /// The colours as RGBA, rows from top to bottom.
    pub fn read_colours(&mut self) -> Vec<[u8; 4]> {
        self.read(gl::RGBA, gl::UNSIGNED_BYTE)
    }

    /// The depths, `u32::MAX` at the far plane, rows from top to bottom.
    pub fn read_depths(&mut self) -> Vec<u32> {
        self.read(gl::DEPTH_COMPONENT, gl::UNSIGNED_INT)
    }

    /// Bound of the error of a plane that llvmpipe sets up and evaluates in 24-bit floats:
    ///
    /// ```text
    ///   gx = ((a1 - a0)(y2 - y0) - (a2 - a0)(y1 - y0)) / area,  gy likewise,  a(x, y) = (a0 - gx x0 - gy y0) + gx x + gy y
    /// ```
    ///
    /// Each operation rounds by at most 2^-24 of its result. The products of a gradient are bounded one by one, since they may
    /// cancel; so may those of the area, which makes the gradients of slivers uncertain as a whole. Which corner llvmpipe
    /// begins with is not documented, so the worst of the three counts.
    fn plane_rounding(&self, triangle: &Triangle, value: impl Fn(&Vertex) -> f64) -> f64 {
        let [a, b, c] = triangle.0;
        let orders = [[a, b, c], [b, c, a], [c, a, b]];
        let bounds = orders.iter().map(|corners| self.plane_rounding_from(corners, &value));
        bounds.fold(0.0, f64::max)
    }

    /// The same for one order of the corners.
    fn plane_rounding_from(&self, corners: &[Vertex; 3], value: impl Fn(&Vertex) -> f64) -> f64 {
        const ROUNDINGS: f64 = 3.0;
        let [a, b, c] = corners;
        let pixels = |v: i32| f64::from(v) / f64::from(STEPS);
        let (x1, y1) = (pixels(b.x - a.x), pixels(b.y - a.y));
        let (x2, y2) = (pixels(c.x - a.x), pixels(c.y - a.y));
        let (d1, d2) = (value(b) - value(a), value(c) - value(a));
        let area = (x1 * y2 - x2 * y1).abs();
        let area_roundings = 2.0 * ((x1 * y2).abs() + (x2 * y1).abs()) / area;
        let gradient = |p: f64, q: f64| {
            let terms = ROUNDINGS * (p.abs() + q.abs()) + area_roundings * (p - q).abs();
            terms / area
        };
        let reach = |size: u32, of: fn(&Vertex) -> i32| {
            corners.iter().map(|v| pixels(of(v)).abs()).fold(f64::from(size), f64::max)
        };
        let largest = corners.iter().map(|v| value(v).abs()).fold(0.0, f64::max);
        let along_x = gradient(d1 * y2, d2 * y1) * reach(self.width, |v| v.x);
        let along_y = gradient(d2 * x1, d1 * x2) * reach(self.height, |v| v.y);
        (ROUNDINGS * largest + along_x + along_y) / f64::from(1 << 24)
    }

    /// Covered pixels (alpha 255) through `value(index, colour)`.
    fn picture<T>(&self, colours: &[[u8; 4]], value: impl Fn(usize, [u8; 3]) -> T) -> Picture<T> {
        let pixel = |(i, &[r, g, b, a]): (usize, &[u8; 4])| (a != 0).then(|| value(i, [r, g, b]));
        let pixels = colours.iter().enumerate().map(pixel).collect();
        Picture { width: self.width, height: self.height, pixels }
    }
}

impl Drop for Llvmpipe {
    fn drop(&mut self) {
        // SAFETY: made by create_context and destroyed once.
        unsafe { (self.gl.destroy_context)(self.context) };
    }
}

impl Renderer for Llvmpipe {
    fn name(&self) -> &str {
        "llvmpipe"
    }

    fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    fn rounding(&self, triangle: &Triangle) -> Rounding {
        let colour = [0, 1, 2].map(|n| self.plane_rounding(triangle, |v| v.colour[n].into()));
        let depth = self.plane_rounding(triangle, |v| f64::from(v.z) / 65536.0);
        let uvq =
            [0, 1].map(|n| self.plane_rounding(triangle, |v| f64::from(v.uv[n]) * f64::from(v.q)));
        let q = self.plane_rounding(triangle, |v| v.q.into());
        Rounding {
            colour: colour.into_iter().fold(0.0, f64::max),
            depth,
            uvq,
            q,
            origin: [0.0; 2],
            texel: 0.0,
        }
    }

    fn coverage(&mut self, triangle: &Triangle) -> Coverage {
        self.clear();
        self.draw(&[*triangle], None, false);
        let colours = self.read_colours();
        self.picture(&colours, |_, _| ())
    }

    fn colour_depth(&mut self, triangle: &Triangle) -> Picture<Fragment> {
        self.clear();
        self.draw(&[*triangle], None, false);
        let (colours, depths) = (self.read_colours(), self.read_depths());
        self.picture(&colours, |i, colour| Fragment { colour, depth: depths[i] })
    }

    /// # Panics
    /// If a pixel shows a colour that is no texel of the texture.
    fn texels(&mut self, triangle: &Triangle, texture: &Texture) -> Picture<Texel> {
        self.clear();
        self.draw(&[*triangle], Some(texture), false);
        let colours = self.read_colours();
        let texel = |colour| texture.texel(colour).expect("a colour of the texture");
        self.picture(&colours, |_, colour| texel(colour))
    }
}
