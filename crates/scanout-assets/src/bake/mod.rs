//! Baked models: the `.mesh` binary that firmware uses in place, and the `.hex` tables that hardware reads.
//!
//! # The `.mesh` binary, versions 1 and 2
//!
//! Little-endian. Every offset counts bytes from the beginning of the file and is a multiple of 4; a file that lies
//! at an address divisible by 4 is read without copying (see [`Aligned`]).
//!
//! | byte | type | header |
//! |---|---|---|
//! | 0 | `[u8; 4]` | magic `SCNM` |
//! | 4 | u16, u16 | version (1; 2 where a texture has a palette), size of this header (64) |
//! | 8 | u32 | size of the file |
//! | 12 | u32 | CRC-32 (IEEE, as in PNG) of all bytes from 16 to the end |
//! | 16 | u16, u16 | number of parts, number of textures |
//! | 20 | u32 | offset of the part records (they follow one another), texture records right after them |
//! | 24 | i64 | scale, Q32.32: world units a mesh position of 1.0 stands for |
//! | 32 | 3 x i64 | offset x, y, z in the world, Q32.32 |
//! | 56 | u32, u32 | 0 |
//!
//! | byte | type | part record, 96 bytes |
//! |---|---|---|
//! | 0 | u32, u32 | name: offset, bytes (UTF-8) |
//! | 8 | u32, u32 | positions: offset, count; `[i16; 3]`, Q1.15 |
//! | 16 | u32, u32 | normals: offset, count; `[i16; 3]`, Q2.14 |
//! | 24 | u32, u32 | colours: offset, count (as many as positions, or 0); `[u8; 3]` |
//! | 32 | u32, u32 | texture coordinates: offset, count; `[i32; 2]`, Q16.16, v down |
//! | 40 | u32, u32 | triangles: offset, count; `[u16; 3]` |
//! | 48 | u32 | triangles of texture coordinates: offset; as many as triangles, or offset 0: none |
//! | 52 | u32, u32 | edges: offset, count; `[u16; 2]` |
//! | 60 | u16 | kind of the normals: 0 none, 1 one a position, 2 one a triangle |
//! | 62 | u16 | flags: bit 0 two-sided, bit 1 bounding sphere present, bits 2, 3 and 4, 5 wrap in u and v |
//! | 64 | 3 x i16, u16 | bounding sphere: centre Q1.15, radius U1.15 |
//! | 72 | 3 x u8, u8 | colour, 0 |
//! | 76 | 3 x i32 | weights ambient, diffuse, specular, Q16.16 |
//! | 88 | u16, u16 | shininess, texture (65535: none) |
//! | 92 | u32 | 0 |
//!
//! | byte | type | texture record, 16 bytes |
//! |---|---|---|
//! | 0 | u16, u16 | width, height, 1 to 1024 |
//! | 4 | u16, u16 | mip levels; format: 0 RGB565, 1 palette of 256 colours, 2 palette of 16 |
//! | 8 | u32, u32 | texels: offset, count of all levels |
//!
//! | format | what lies at the offset |
//! |---|---|
//! | 0 | u16 a texel, RGB565 |
//! | 1 | 256 x u16, RGB565, then u8 a texel |
//! | 2 | 16 x u16, RGB565, then 4 bits a texel, the first of two in the low half of the byte |
//!
//! Wrap is what lies outside [0, 1) of the texture: 0 it repeats, 1 mirrored, 2 its outermost texel continues, 3 border.
//!
//! The `.hex` tables are described by [`HEX_README`], which is written beside them.

mod binary;
#[cfg(feature = "std")]
mod hex;
#[cfg(feature = "std")]
mod write;

pub use binary::{Aligned, BakeError, BakedMesh, BakedPart, read};
#[cfg(feature = "std")]
pub use hex::{HEX_README, HexError, check_hex, hex_files};
#[cfg(feature = "std")]
pub use write::{to_binary, to_binary_as, write_binary, write_binary_as, write_hex};

use scanout::texture::Wrap;

/// First bytes of a `.mesh` file.
pub const MAGIC: [u8; 4] = *b"SCNM";
/// Latest version of the format: the one with palettes. Files without one are written as version 1, and both are read.
pub const VERSION: u16 = 2;
/// Version of files without palettes.
const VERSION_WITHOUT_PALETTES: u16 = 1;

const HEADER: usize = 64;
const PART: usize = 96;
const TEXTURE: usize = 16;
/// Formats of texture records.
const PALETTE_8: u16 = 1;
const PALETTE_4: u16 = 2;
/// "No texture".
const NO_TEXTURE: u16 = u16::MAX;

/// Wrap in u and v as 4 bits.
#[cfg(feature = "std")]
fn wrap_bits([u, v]: [Wrap; 2]) -> u8 {
    let bits = |wrap: Wrap| WRAPS.iter().position(|&w| w == wrap).unwrap_or(0) as u8;
    bits(u) | bits(v) << 2
}

/// In the order of their numbers.
const WRAPS: [Wrap; 4] = [Wrap::Repeat, Wrap::Mirror, Wrap::Clamp, Wrap::Border];

/// CRC-32 (IEEE 802.3), bit by bit: slow but without a table; about 60 cycles a byte on a Cortex-M.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |c, _| (c >> 1) ^ (0xedb8_8320 & (c & 1).wrapping_neg()))
    })
}

#[cfg(all(test, feature = "std"))]
mod tests;
