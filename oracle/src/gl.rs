//! The functions and constants of OSMesa and OpenGL 1.x that the judge uses, loaded at run time.

use std::ffi::{c_int, c_void};

use libloading::Library;

/// Opaque `OSMesaContext`.
pub(crate) type RawContext = *mut c_void;

pub(crate) const RGBA: u32 = 0x1908;
pub(crate) const UNSIGNED_BYTE: u32 = 0x1401;
pub(crate) const UNSIGNED_INT: u32 = 0x1405;
pub(crate) const DEPTH_COMPONENT: u32 = 0x1902;
pub(crate) const DEPTH_BITS: u32 = 0x0D56;
pub(crate) const DEPTH_TEST: u32 = 0x0B71;
pub(crate) const LESS: u32 = 0x0201;
pub(crate) const ALWAYS: u32 = 0x0207;
pub(crate) const DITHER: u32 = 0x0BD0;
pub(crate) const SMOOTH: u32 = 0x1D01;
pub(crate) const TRIANGLES: u32 = 0x0004;
pub(crate) const TEXTURE_2D: u32 = 0x0DE1;
pub(crate) const TEXTURE_MAG_FILTER: u32 = 0x2800;
pub(crate) const TEXTURE_MIN_FILTER: u32 = 0x2801;
pub(crate) const TEXTURE_WRAP_S: u32 = 0x2802;
pub(crate) const TEXTURE_WRAP_T: u32 = 0x2803;
pub(crate) const TEXTURE_ENV: u32 = 0x2300;
pub(crate) const TEXTURE_ENV_MODE: u32 = 0x2200;
pub(crate) const REPLACE: c_int = 0x1E01;
pub(crate) const NEAREST: c_int = 0x2600;
pub(crate) const REPEAT: c_int = 0x2901;
pub(crate) const CLAMP_TO_EDGE: c_int = 0x812F;
pub(crate) const MIRRORED_REPEAT: c_int = 0x8370;
pub(crate) const COLOR_BUFFER_BIT: u32 = 0x4000;
pub(crate) const DEPTH_BUFFER_BIT: u32 = 0x0100;
pub(crate) const RENDERER: u32 = 0x1F01;
pub(crate) const VERSION: u32 = 0x1F02;

/// Declares [`Functions`]: one field a C function, found in the library by its name.
macro_rules! functions {
    ($($field:ident = $symbol:literal ($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// C functions. The pointers stay valid as long as `_library` is loaded, that is as long as this value lives.
        pub(crate) struct Functions {
            $(pub(crate) $field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
            _library: Library,
        }

        impl Functions {
            /// Finds every function.
            pub(crate) fn new(library: Library) -> Result<Self, libloading::Error> {
                $(
                    // SAFETY: the signature is the one of the OpenGL 1.x registry and of GL/osmesa.h on platforms
                    // where GLAPIENTRY is the C calling convention; `_library` keeps the code loaded.
                    let $field = unsafe {
                        *library.get::<unsafe extern "C" fn($($argument),*) $(-> $result)?>($symbol)?
                    };
                )*
                Ok(Self { $($field,)* _library: library })
            }
        }
    };
}

functions! {
    create_context = b"OSMesaCreateContextExt\0" (u32, c_int, c_int, c_int, RawContext) -> RawContext;
    destroy_context = b"OSMesaDestroyContext\0" (RawContext);
    make_current = b"OSMesaMakeCurrent\0" (RawContext, *mut c_void, u32, c_int, c_int) -> u8;
    get_string = b"glGetString\0" (u32) -> *const std::ffi::c_char;
    get_integer = b"glGetIntegerv\0" (u32, *mut c_int);
    get_error = b"glGetError\0" () -> u32;
    viewport = b"glViewport\0" (c_int, c_int, c_int, c_int);
    depth_range = b"glDepthRange\0" (f64, f64);
    clear_colour = b"glClearColor\0" (f32, f32, f32, f32);
    clear_depth = b"glClearDepth\0" (f64);
    clear = b"glClear\0" (u32);
    enable = b"glEnable\0" (u32);
    disable = b"glDisable\0" (u32);
    shade_model = b"glShadeModel\0" (u32);
    depth_function = b"glDepthFunc\0" (u32);
    begin = b"glBegin\0" (u32);
    end = b"glEnd\0" ();
    colour = b"glColor4ub\0" (u8, u8, u8, u8);
    texture_coordinate = b"glTexCoord4f\0" (f32, f32, f32, f32);
    vertex = b"glVertex4f\0" (f32, f32, f32, f32);
    texture_parameter = b"glTexParameteri\0" (u32, u32, c_int);
    texture_environment = b"glTexEnvi\0" (u32, u32, c_int);
    texture_image = b"glTexImage2D\0"
        (u32, c_int, c_int, c_int, c_int, c_int, u32, u32, *const c_void);
    read_pixels = b"glReadPixels\0" (c_int, c_int, c_int, c_int, u32, u32, *mut c_void);
}
