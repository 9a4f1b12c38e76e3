//! Fixed-point arithmetic.

/// Q16.16.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Default, Hash)]
#[repr(transparent)]
pub struct Q16(pub i32);

/// A vector of Q16.16.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Vec3 {
    /// x
    pub x: Q16,
    /// y
    pub y: Q16,
    /// z
    pub z: Q16,
}

/// 4 x 4 matrix, Q32.32, row major, column vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mat4 {
    /// `m[row][column]`
    pub m: [[i64; 4]; 4],
}
