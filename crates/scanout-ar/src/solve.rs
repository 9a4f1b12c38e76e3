//! Small systems of linear equations with a symmetric, positive matrix, such as normal equations.

use libm::sqrt;

/// Solves `matrix x = right` by Cholesky's factorisation; only the lower triangle is read. `None` when the matrix is not positive
/// definite.
#[allow(clippy::needless_range_loop)] // As the textbook writes it.
pub fn solve<const N: usize>(mut matrix: [[f64; N]; N], mut right: [f64; N]) -> Option<[f64; N]> {
    for i in 0..N {
        for j in 0..=i {
            let mut sum = matrix[i][j];
            for k in 0..j {
                sum -= matrix[i][k] * matrix[j][k];
            }
            if i == j {
                if sum <= 0.0 || !sum.is_finite() {
                    return None;
                }
                matrix[i][i] = sqrt(sum);
            } else {
                matrix[i][j] = sum / matrix[j][j];
            }
        }
    }
    for i in 0..N {
        for k in 0..i {
            right[i] -= matrix[i][k] * right[k];
        }
        right[i] /= matrix[i][i];
    }
    for i in (0..N).rev() {
        for k in i + 1..N {
            right[i] -= matrix[k][i] * right[k];
        }
        right[i] /= matrix[i][i];
    }
    Some(right)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_and_refuses() {
        let got = solve([[4.0, 2.0], [2.0, 3.0]], [2.0, -1.0]).unwrap();
        assert!((got[0] - 1.0).abs() < 1e-12 && (got[1] + 1.0).abs() < 1e-12);
        assert_eq!(solve([[1.0, 2.0], [2.0, 1.0]], [0.0; 2]), None);
        assert_eq!(solve([[f64::NAN]], [0.0]), None);
    }
}
