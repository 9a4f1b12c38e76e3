//! Vectors of f64 with nothing but `+ - * /` and square root, so that every host computes the same bits; sines come from
//! the pipeline's own table.

use scanout::math::Angle;

/// Three components.
pub type V3 = [f64; 3];

/// Inner product.
pub fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Outer product.
pub fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `a + b * t`.
pub fn along(a: V3, b: V3, t: f64) -> V3 {
    [a[0] + b[0] * t, a[1] + b[1] * t, a[2] + b[2] * t]
}

/// `a - b`.
pub fn minus(a: V3, b: V3) -> V3 {
    along(a, b, -1.0)
}

/// Length.
pub fn length(a: V3) -> f64 {
    dot(a, a).sqrt()
}

/// The direction, or `None` for a vector too short to have one.
pub fn normalised(a: V3) -> Option<V3> {
    let length = length(a);
    (length > 1e-30).then(|| a.map(|x| x / length))
}

/// Sine and cosine of an angle in degrees, from the pipeline's table (error 2^-29.8).
pub fn sin_cos(degrees: f64) -> (f64, f64) {
    let (sin, cos) = Angle::from_degrees_f64(degrees).sin_cos();
    (f64::from(sin) / f64::from(1 << 30), f64::from(cos) / f64::from(1 << 30))
}

/// `v` turned by `degrees` about the unit vector `axis`, counter-clockwise seen from its tip (Rodrigues' formula).
pub fn turned(v: V3, axis: V3, degrees: f64) -> V3 {
    let (sin, cos) = sin_cos(degrees);
    let along_axis = dot(v, axis) * (1.0 - cos);
    let sideways = cross(axis, v);
    std::array::from_fn(|i| v[i] * cos + sideways[i] * sin + axis[i] * along_axis)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quarter_turn_about_y_brings_z_to_x() {
        assert_eq!(turned([0.0, 0.0, 1.0], [0.0, 1.0, 0.0], 90.0), [1.0, 0.0, 0.0]);
    }
}
