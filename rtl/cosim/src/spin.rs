//! The stand-alone mode's table: a model that turns about an axis, as `spin.sv` computes it.
//!
//! ```text
//! object to world = placement . R(angle) . scale        R = a a^T + (1 - a a^T) cos + [a]x sin        (Rodrigues)
//! m[k] = A[k] + (B[k] cos + C[k] sin + 2^29 >> 30)      in units of one power of two for all words
//! ```
//!
//! The power of two is chosen so that no row can leave `ClipMatrix`'s range at any angle.

use std::path::Path;

use scanout::camera::{Camera, projection};
use scanout::math::{Angle, Mat4, Q16, Vec3, tables::SINE};
use scanout::transform::ClipMatrix;
use scanout_assets::{LoadOptions, bake, load};

/// Steps of a turn.
pub const STEPS: u32 = 1024;

/// A, B, C of each word of a clip matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Spin {
    /// Word k's A, B, C.
    pub words: [[i32; 3]; 16],
}

impl Spin {
    /// A model that turns about `axis` (any length but zero) through the world's origin, `scale` of it large, before it
    /// is seen through `world_to_clip`.
    pub fn new(world_to_clip: &Mat4, axis: [f64; 3], scale: f64) -> Spin {
        let length = axis.iter().map(|v| v * v).sum::<f64>().sqrt();
        let a = axis.map(|v| v / length);
        let view = world_to_clip.to_f64();
        let dyad = |i: usize, j: usize| a[i] * a[j];
        let cross = [[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]];
        let turn = |i: usize, j: usize| {
            let one = if i == j { 1.0 } else { 0.0 };
            [dyad(i, j), one - dyad(i, j), cross[i][j]]
        };
        let mut real = [[0.0; 3]; 16];
        for row in 0..4 {
            for column in 0..3 {
                real[row * 4 + column] = [0, 1, 2]
                    .map(|part| (0..3).map(|k| view[row][k] * turn(k, column)[part] * scale).sum());
            }
            real[row * 4 + 3][0] = view[row][3];
        }
        // The largest sum of a row's sizes at any angle lies in [2^29, 2^30).
        let row = |row: &[[f64; 3]], angle: u32| {
            let (sin, cos) =
                (f64::from(angle) * std::f64::consts::TAU / f64::from(STEPS)).sin_cos();
            row.iter().map(|[a, b, c]| (a + b * cos + c * sin).abs()).sum::<f64>()
        };
        let largest = (0..STEPS)
            .flat_map(|angle| real.chunks(4).map(move |words| row(words, angle)))
            .fold(1e-9, f64::max);
        // A little less, so that rounding four words can't pass it.
        let unit = f64::exp2((30.0 - (largest * (1.0 + 1e-8)).log2()).floor());
        Spin { words: real.map(|word| word.map(|v| (v * unit).round() as i32)) }
    }

    /// The matrix at `angle` in 1/1024 turn.
    pub fn matrix(&self, angle: u32) -> ClipMatrix {
        let (sin, cos) = Angle((angle % STEPS) << 22).sin_cos();
        let word = |k: usize| {
            let [a, b, c] = self.words[k].map(i64::from);
            (a + ((b * i64::from(cos) + c * i64::from(sin) + (1 << 29)) >> 30)) as i32
        };
        ClipMatrix {
            m: std::array::from_fn(|r| std::array::from_fn(|c| word(4 * r + c))),
            exponent: 0,
        }
    }

    /// The words of the window `spin`, for the left eye and the right one.
    pub fn table(left: &Spin, right: &Spin) -> [u32; 512] {
        let mut table = [0; 512];
        table[..256].copy_from_slice(&SINE);
        for (eye, spin) in [left, right].into_iter().enumerate() {
            for (k, word) in spin.words.iter().enumerate() {
                for (part, &v) in word.iter().enumerate() {
                    table[256 + 64 * eye + 4 * k + part] = v as u32;
                }
            }
        }
        table
    }

    /// [`Spin::table`] as text for `$readmemh`.
    pub fn hex(left: &Spin, right: &Spin) -> String {
        Spin::table(left, right).map(|word| format!("{word:08x}\n")).concat()
    }
}

/// Models in `boards/models`.
pub const BOARD_MODELS: [&str; 2] = ["teapot", "torus"];

/// The spin of a board's model: seen from a little above through 45 degrees, 4:3, turning about a tilted axis.
///
/// # Panics
/// Never: the camera is valid.
pub fn board_spin() -> (Camera, Spin) {
    let lens = projection::perspective(
        Angle::from_degrees_f64(45.0),
        Q16::from_ratio(4, 3),
        Q16::from_ratio(1, 10),
        Q16::from_int(20),
    );
    let eye = Vec3::from_f64([0.0, 0.9, 2.9]);
    let camera = lens.and_then(|lens| Camera::look_at(eye, Vec3::ZERO, Vec3::Y, lens));
    let camera = camera.expect("a valid camera");
    let spin = Spin::new(&camera.projection.mul(&camera.view), [0.2, 1.0, 0.0], 1.0);
    (camera, spin)
}

/// File names and contents for a model of the repository at `root`: vertices and edges as `scanout bake` writes them, and the spin
/// table.
///
/// # Panics
/// When the model cannot be read.
pub fn board_tables(root: &Path, name: &str) -> Vec<(String, String)> {
    let path = root.join("models").join(name).with_extension("obj");
    let model = load(&path, &LoadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
    let tables = bake::hex_files(&model).unwrap_or_else(|e| panic!("{e}"));
    let mut files: Vec<(String, String)> = tables
        .into_iter()
        .filter(|(name, _)| name == "vertices.hex" || name == "edges.hex")
        .collect();
    let (_, spin) = board_spin();
    files.push(("spin.hex".into(), Spin::hex(&spin, &spin)));
    files
}
