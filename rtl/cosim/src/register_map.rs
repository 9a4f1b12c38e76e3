//! Addresses (in words) and fields of the control registers. Written by `cargo run --example registers` from
//! `registers.rs`: change that, not this. It needs nothing else, so a driver may include the file.

/// Register `magic`: address in words.
pub const MAGIC: u32 = 0x0000;
/// Its value after reset.
pub const MAGIC_RESET: u32 = 0x53434f31;

/// Register `size`: address in words.
pub const SIZE: u32 = 0x0001;
/// width of an eye's picture in pixels.
pub const SIZE_WIDTH_MASK: u32 = 0x0000ffff;
/// Lowest bit of it.
pub const SIZE_WIDTH_LSB: u32 = 0;
/// its height.
pub const SIZE_HEIGHT_MASK: u32 = 0xffff0000;
/// Lowest bit of it.
pub const SIZE_HEIGHT_LSB: u32 = 16;

/// Register `control`: address in words.
pub const CONTROL: u32 = 0x0002;
/// 1: pictures are drawn, one after the other; 0: the last one stays.
pub const CONTROL_RUN_MASK: u32 = 0x00000001;
/// Lowest bit of it.
pub const CONTROL_RUN_LSB: u32 = 0;
/// Its value after reset.
pub const CONTROL_RUN_RESET: u32 = 0x1;
/// 1: stand-alone, the matrix comes from the spin table; 0: from `matrix`.
pub const CONTROL_SPIN_MASK: u32 = 0x00000002;
/// Lowest bit of it.
pub const CONTROL_SPIN_LSB: u32 = 1;
/// Its value after reset.
pub const CONTROL_SPIN_RESET: u32 = 0x1;
/// 1: the camera under the drawing, where there is one.
pub const CONTROL_CAMERA_MASK: u32 = 0x00000004;
/// Lowest bit of it.
pub const CONTROL_CAMERA_LSB: u32 = 2;
/// 0 one eye, 1 anaglyph, 2 side by side, 3 interlaced, 4 top and bottom, anaglyphs: 5 grey, 6 half colour, 7 Dubois; `features.stereo` says which there are, another one is 0.
pub const CONTROL_ARRANGEMENT_MASK: u32 = 0x00000070;
/// Lowest bit of it.
pub const CONTROL_ARRANGEMENT_LSB: u32 = 4;
/// the words in `matrix` take effect with the next picture.
pub const CONTROL_COMMIT_MASK: u32 = 0x00000100;
/// Lowest bit of it.
pub const CONTROL_COMMIT_LSB: u32 = 8;

/// Register `status`: address in words.
pub const STATUS: u32 = 0x0003;
/// a picture is being drawn.
pub const STATUS_DRAWING_MASK: u32 = 0x00000001;
/// Lowest bit of it.
pub const STATUS_DRAWING_LSB: u32 = 0;
/// a commit waits for the next picture: don't write `matrix`.
pub const STATUS_COMMITTED_MASK: u32 = 0x00000002;
/// Lowest bit of it.
pub const STATUS_COMMITTED_LSB: u32 = 1;
/// the camera came too late for a pixel.
pub const STATUS_LATE_MASK: u32 = 0x00000004;
/// Lowest bit of it.
pub const STATUS_LATE_LSB: u32 = 2;
/// a line found no line memory, or came after the blank, or left the screen where there are no clip stages: a picture was not complete.
pub const STATUS_INCOMPLETE_MASK: u32 = 0x00000008;
/// Lowest bit of it.
pub const STATUS_INCOMPLETE_LSB: u32 = 3;

/// Register `pictures`: address in words.
pub const PICTURES: u32 = 0x0004;

/// Register `clocks`: address in words.
pub const CLOCKS: u32 = 0x0005;

/// Register `ink`: address in words.
pub const INK: u32 = 0x0006;
/// colour of lines in a one-bit plane: red, green, blue from the top.
pub const INK_MASK: u32 = 0x00ffffff;
/// Lowest bit of it.
pub const INK_LSB: u32 = 0;
/// Its value after reset.
pub const INK_RESET: u32 = 0xffffff;

/// Register `background`: address in words.
pub const BACKGROUND: u32 = 0x0007;
/// colour where nothing is drawn.
pub const BACKGROUND_MASK: u32 = 0x00ffffff;
/// Lowest bit of it.
pub const BACKGROUND_LSB: u32 = 0;

/// Register `model`: address in words.
pub const MODEL: u32 = 0x0008;
/// vertices in `vertex`; 0: as many as the built-in model has.
pub const MODEL_VERTICES_MASK: u32 = 0x0000ffff;
/// Lowest bit of it.
pub const MODEL_VERTICES_LSB: u32 = 0;
/// edges in `edge`; 0: as many as the built-in model has.
pub const MODEL_EDGES_MASK: u32 = 0xffff0000;
/// Lowest bit of it.
pub const MODEL_EDGES_LSB: u32 = 16;

/// Register `speed`: address in words.
pub const SPEED: u32 = 0x0009;
/// steps of 1/1024 turn a picture, two's complement.
pub const SPEED_MASK: u32 = 0x000003ff;
/// Lowest bit of it.
pub const SPEED_LSB: u32 = 0;
/// Its value after reset.
pub const SPEED_RESET: u32 = 0x4;

/// Register `angle`: address in words.
pub const ANGLE: u32 = 0x000a;
/// of the last picture, in 1/1024 turn.
pub const ANGLE_MASK: u32 = 0x000003ff;
/// Lowest bit of it.
pub const ANGLE_LSB: u32 = 0;

/// Register `features`: address in words.
pub const FEATURES: u32 = 0x000b;
/// to the screen: 0 planes of one bit, 1 colour framebuffer, 2 line memories.
pub const FEATURES_WAY_MASK: u32 = 0x00000003;
/// Lowest bit of it.
pub const FEATURES_WAY_LSB: u32 = 0;
/// arrangements: 0 none, 1 those to 3, 2 those to 6 (7 is as 6), 3 all.
pub const FEATURES_STEREO_MASK: u32 = 0x00000030;
/// Lowest bit of it.
pub const FEATURES_STEREO_LSB: u32 = 4;

/// Register `palette0`: address in words.
pub const PALETTE0: u32 = 0x000c;
/// colour of group 0 (line memories and colour framebuffer).
pub const PALETTE0_MASK: u32 = 0x00ffffff;
/// Lowest bit of it.
pub const PALETTE0_LSB: u32 = 0;
/// Its value after reset.
pub const PALETTE0_RESET: u32 = 0xffffff;

/// Register `palette1`: address in words.
pub const PALETTE1: u32 = 0x000d;
/// colour of group 1.
pub const PALETTE1_MASK: u32 = 0x00ffffff;
/// Lowest bit of it.
pub const PALETTE1_LSB: u32 = 0;
/// Its value after reset.
pub const PALETTE1_RESET: u32 = 0xff0000;

/// Register `palette2`: address in words.
pub const PALETTE2: u32 = 0x000e;
/// colour of group 2.
pub const PALETTE2_MASK: u32 = 0x00ffffff;
/// Lowest bit of it.
pub const PALETTE2_LSB: u32 = 0;
/// Its value after reset.
pub const PALETTE2_RESET: u32 = 0xff00;

/// Register `palette3`: address in words.
pub const PALETTE3: u32 = 0x000f;
/// colour of group 3.
pub const PALETTE3_MASK: u32 = 0x00ffffff;
/// Lowest bit of it.
pub const PALETTE3_LSB: u32 = 0;
/// Its value after reset.
pub const PALETTE3_RESET: u32 = 0xff;

/// Window `matrix`: clip matrix, rows x, y, z, w of four words each: 32 bits with sign, one power of two in common (`ClipMatrix::m`); from word 16 on the right eye's.
pub const MATRIX: u32 = 0x0100;
/// Its words.
pub const MATRIX_WORDS: u32 = 32;

/// Window `spin`: 0 - 255: sines of a quarter turn, Q2.30; 256 + 4 k: A, B, C of matrix word k: A + (B cos + C sin + 2^29 >> 30); from word 320 on the right eye's.
pub const SPIN: u32 = 0x0200;
/// Its words.
pub const SPIN_WORDS: u32 = 512;

/// Window `vertex`: vertex v: word 2 v + 1 is z (low half); then word 2 v is y, x (x low), which stores all three: Q1.15 each.
pub const VERTEX: u32 = 0x0800;
/// Its words.
pub const VERTEX_WORDS: u32 = 2048;

/// Window `edge`: edge e: vertices b, a (a low), 16 bits each.
pub const EDGE: u32 = 0x1000;
/// Its words.
pub const EDGE_WORDS: u32 = 4096;
