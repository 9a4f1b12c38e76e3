//! Rotations: matrices, rotation vectors, quaternions.

use libm::{acos, cos, sin, sqrt};

/// Three rows of three.
pub type Matrix3 = [[f64; 3]; 3];

/// The rotation that does nothing.
pub const IDENTITY: Matrix3 = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The product of two matrices.
pub fn multiply(a: &Matrix3, b: &Matrix3) -> Matrix3 {
    core::array::from_fn(|i| {
        core::array::from_fn(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j])
    })
}

/// A matrix times a column.
pub fn apply(a: &Matrix3, v: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| a[i][0] * v[0] + a[i][1] * v[1] + a[i][2] * v[2])
}

/// The transpose, of a rotation the inverse.
pub fn transpose(a: &Matrix3) -> Matrix3 {
    core::array::from_fn(|i| core::array::from_fn(|j| a[j][i]))
}

/// The cross product.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The rotation about a vector by its length, radians (Rodrigues).
pub fn from_vector(v: [f64; 3]) -> Matrix3 {
    let angle = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    if angle < 1e-12 {
        return IDENTITY;
    }
    let [x, y, z] = v.map(|x| x / angle);
    let (s, c) = (sin(angle), cos(angle));
    let d = 1.0 - c;
    [
        [c + x * x * d, x * y * d - z * s, x * z * d + y * s],
        [y * x * d + z * s, c + y * y * d, y * z * d - x * s],
        [z * x * d - y * s, z * y * d + x * s, c + z * z * d],
    ]
}

/// The rotation's vector: its axis, as long as its angle, 0 to pi.
pub fn to_vector(r: &Matrix3) -> [f64; 3] {
    let [w, x, y, z] = to_quaternion(r);
    let length = sqrt(x * x + y * y + z * z);
    if length < 1e-12 {
        return [0.0; 3];
    }
    let (w, sign) = if w < 0.0 { (-w, -1.0) } else { (w, 1.0) };
    let factor = sign * 2.0 * libm::atan2(length, w) / length;
    [x * factor, y * factor, z * factor]
}

/// The angle between two rotations, radians, 0 to pi.
pub fn angle(a: &Matrix3, b: &Matrix3) -> f64 {
    let trace: f64 = (0..3).map(|i| (0..3).map(|j| a[i][j] * b[i][j]).sum::<f64>()).sum();
    acos(((trace - 1.0) / 2.0).clamp(-1.0, 1.0))
}

/// A rotation as a unit quaternion w, x, y, z.
pub fn to_quaternion(r: &Matrix3) -> [f64; 4] {
    // The largest of the four is found from the diagonal, so that nothing small is divided by.
    let trace = r[0][0] + r[1][1] + r[2][2];
    let squares = [
        1.0 + trace,
        1.0 + 2.0 * r[0][0] - trace,
        1.0 + 2.0 * r[1][1] - trace,
        1.0 + 2.0 * r[2][2] - trace,
    ];
    let largest = (1..4).fold(0, |best, i| if squares[i] > squares[best] { i } else { best });
    let s = 2.0 * sqrt(squares[largest].max(1e-300));
    let (a, b, c) = (r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]);
    let (d, e, f) = (r[0][1] + r[1][0], r[0][2] + r[2][0], r[1][2] + r[2][1]);
    let q = match largest {
        0 => [s * s / 4.0, a, b, c],
        1 => [a, s * s / 4.0, d, e],
        2 => [b, d, s * s / 4.0, f],
        _ => [c, e, f, s * s / 4.0],
    };
    q.map(|x| x / s)
}

/// A quaternion w, x, y, z of any length but zero as a rotation.
pub fn from_quaternion(q: [f64; 4]) -> Matrix3 {
    let length = sqrt(q.iter().map(|x| x * x).sum());
    let [w, x, y, z] = q.map(|x| x / length);
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_quaternions_and_matrices_are_one() {
        for vector in
            [[0.0; 3], [0.1, -2.0, 0.5], [3.0, 0.3, 0.0], [0.0, 0.0, 3.1], [-1.0, -1.0, 1.0]]
        {
            let r = from_vector(vector);
            let back = to_vector(&r);
            assert!((0..3).all(|i| (back[i] - vector[i]).abs() < 1e-9), "{vector:?} {back:?}");
            let again = from_quaternion(to_quaternion(&r));
            assert!(angle(&r, &again) < 1e-6);
            assert!(angle(&multiply(&r, &transpose(&r)), &IDENTITY) < 1e-6);
        }
        // A quarter turn about z takes x to y.
        let y = apply(&from_vector([0.0, 0.0, core::f64::consts::FRAC_PI_2]), [1.0, 0.0, 0.0]);
        assert!(y[0].abs() < 1e-12 && (y[1] - 1.0).abs() < 1e-12);
    }
}
