//! Which of Cargo's features are compiled in. Constants instead of attributes: what is left out is still checked by the
//! compiler, and leaves the program because nothing reaches it.
//!
//! Drawing may rely on `Frame::prepare` having refused what is not there.

macro_rules! features {
    ($($name:ident = $feature:literal)*) => {
        $(
            #[doc = concat!("`", $feature, "`")]
            pub(crate) const $name: bool = cfg!(feature = $feature);
        )*
    };
}

features! {
    ALL_LIGHTS = "all-lights"
    ALL_TEXTURES = "all-textures"
    BACKGROUND_IMAGES = "background-images"
    CLUSTERS = "clusters"
    DITHER = "dither"
    FOG = "fog"
    GOURAUD = "gouraud"
    LINES = "lines"
    PALETTE_TEXTURES = "palette-textures"
    PHONG = "phong"
    POINTS = "points"
    SMOOTH_LINES = "smooth-lines"
    TILES = "tiles"
    TWO_SIDED = "two-sided"
    VERTEX_COLOURS = "vertex-colours"
}
