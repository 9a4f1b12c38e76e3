//! Calibration files in OpenCV's layout, YAML or JSON (also ROS's `camera_info`, whose names are the same).
//!
//! ```text
//!  %YAML:1.0                                      {
//!  ---                                              "image_width": 640,
//!  image_width: 640                                 "image_height": 480,
//!  image_height: 480                                "camera_matrix": {"rows": 3, "cols": 3, "data": [600, ...]},
//!  camera_matrix: !!opencv-matrix                   "distortion_coefficients": {"rows": 1, "cols": 5, "data": [...]}
//!     rows: 3                                     }
//!     cols: 3
//!     dt: d
//!     data: [ 600., 0., 319.5, 0., 600., 239.5, 0., 0., 1. ]
//!  distortion_coefficients: !!opencv-matrix
//!     ...
//! ```
//!
//! Both are read by one scanner: behind a name, the numbers in the next brackets. OpenCV's pixel centres lie at .0; the reader adds the
//! half pixel and the writer takes it away.

use crate::lens::Lens;
use std::fmt;
use std::fmt::Write as _;

/// A camera and the pictures that it was calibrated for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration {
    /// The lens, for pictures of `size`.
    pub lens: Lens,
    /// Width and height in pixels, if the file tells them.
    pub size: Option<(usize, usize)>,
}

/// Why a calibration file can't be used.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CalibrationError {
    /// A name is missing.
    Missing(&'static str),
    /// What stands behind a name isn't as many numbers as there must be: line and name.
    Numbers(usize, &'static str),
    /// The matrix isn't a camera's.
    Matrix(usize),
    /// More than five coefficients, and the others aren't zero: how many.
    Coefficients(usize, usize),
}

impl fmt::Display for CalibrationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing(name) => {
                write!(f, "{name} is missing; write the file with 'scanout calibrate' or OpenCV")
            }
            Self::Numbers(line, name) => {
                write!(f, "{line}: {name} needs its numbers in brackets; write the file anew")
            }
            Self::Matrix(line) => write!(
                f,
                "{line}: camera_matrix must be [fx, 0, cx, 0, fy, cy, 0, 0, 1] with fx and fy above 0; calibrate anew"
            ),
            Self::Coefficients(line, count) => write!(
                f,
                "{line}: {count} distortion coefficients, but only k1, k2, p1, p2, k3 are understood; calibrate without the rational or thin-prism model"
            ),
        }
    }
}

impl std::error::Error for CalibrationError {}

/// The line and the numbers in the first brackets (nested ones too) behind `name`.
fn numbers(text: &str, name: &str) -> Option<(usize, Result<Vec<f64>, ()>)> {
    let at = text.match_indices(name).map(|(at, _)| at).find(|&at| {
        // A whole word, followed by a colon: `rectification_matrix` isn't `matrix`.
        let before = text[..at].chars().next_back();
        let behind = text[at + name.len()..].trim_start_matches('"').trim_start();
        !before.is_some_and(|c| c.is_alphanumeric() || c == '_') && behind.starts_with(':')
    })?;
    let line = text[..at].matches('\n').count() + 1;
    let rest = &text[at + name.len()..];
    let Some(open) = rest.find('[') else { return Some((line, Err(()))) };
    let (mut depth, mut end) = (0, None);
    for (i, c) in rest[open..].char_indices() {
        match c {
            '[' => depth += 1,
            ']' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            end = Some(open + i);
            break;
        }
    }
    let Some(end) = end else { return Some((line, Err(()))) };
    let inside = rest[open..end].replace(['[', ']'], " ");
    let parts = inside.split([',', ' ', '\n', '\r', '\t']).filter(|part| !part.is_empty());
    let values = parts.map(|part| part.trim_end_matches('.').parse::<f64>().map_err(|_| ()));
    Some((line, values.collect()))
}

/// The whole number behind `name: `.
fn whole(text: &str, name: &str) -> Option<usize> {
    let rest = &text[text.find(name)? + name.len()..];
    let rest = rest.trim_start_matches(['"', ':', ' ']);
    rest.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()
}

impl Calibration {
    /// Reads a file's text.
    ///
    /// # Errors
    /// [`CalibrationError`]; those that have a line begin with it, so that the file's name and a colon can be put before.
    pub fn read(text: &str) -> Result<Self, CalibrationError> {
        let (line, matrix) =
            numbers(text, "camera_matrix").ok_or(CalibrationError::Missing("camera_matrix"))?;
        let matrix: [f64; 9] = matrix
            .ok()
            .and_then(|values| values.try_into().ok())
            .ok_or(CalibrationError::Numbers(line, "camera_matrix"))?;
        let mut distortion = [0.0; 5];
        let names = ["distortion_coefficients", "dist_coeffs", "dist_coeff", "distCoeffs"];
        let given = names.into_iter().find_map(|name| numbers(text, name));
        if let Some((at, values)) = given {
            let name = "distortion_coefficients";
            let values = values.map_err(|()| CalibrationError::Numbers(at, name))?;
            if values.iter().skip(5).any(|&value| value != 0.0) {
                return Err(CalibrationError::Coefficients(at, values.len()));
            }
            distortion.iter_mut().zip(values).for_each(|(to, value)| *to = value);
        }
        let lens = Lens::from_opencv(&matrix, &distortion).ok_or(CalibrationError::Matrix(line))?;
        let size = whole(text, "image_width").zip(whole(text, "image_height"));
        Ok(Self { lens, size: size.filter(|&(w, h)| w > 0 && h > 0) })
    }

    /// The lens for pictures of another size than calibrated for: scaled. `None` when the shape of the picture is another one.
    pub fn for_size(&self, width: usize, height: usize) -> Option<Lens> {
        let Some((w, h)) = self.size else { return Some(self.lens) };
        let (across, down) = (width as f64 / w as f64, height as f64 / h as f64);
        ((across / down - 1.0).abs() < 0.02).then(|| self.lens.scaled(across, down))
    }

    /// OpenCV's YAML; `error` is the root mean square reprojection error in pixels.
    pub fn to_yaml(&self, error: Option<f64>) -> String {
        let list = |values: &[f64]| {
            let words: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
            words.join(", ")
        };
        let mut text = String::from("%YAML:1.0\n---\n");
        if let Some((width, height)) = self.size {
            let _ = write!(text, "image_width: {width}\nimage_height: {height}\n");
        }
        let _ = write!(
            text,
            "camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ {} ]\n\
             distortion_coefficients: !!opencv-matrix\n   rows: 1\n   cols: 5\n   dt: d\n   data: [ {} ]\n",
            list(&self.lens.to_opencv()),
            list(&self.lens.distortion),
        );
        if let Some(error) = error {
            let _ = writeln!(text, "avg_reprojection_error: {error:?}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_written_is_read() {
        let lens = Lens {
            focal: [600.25, 601.0],
            centre: [321.0, 239.125],
            distortion: [-0.25, 0.125, 1e-4, -2e-5, 0.0],
        };
        let file = Calibration { lens, size: Some((640, 480)) };
        let text = file.to_yaml(Some(0.25));
        assert!(text.contains("600.25, 0.0, 320.5,"), "OpenCV's centre is half a pixel less");
        assert_eq!(Calibration::read(&text), Ok(file));
        let half = file.for_size(320, 240).unwrap();
        assert_eq!(half.focal, [300.125, 300.5]);
        assert_eq!(half.centre, [160.5, 119.5625]);
        assert_eq!(file.for_size(640, 360), None);
    }

    #[test]
    fn json_opencv_s_own_yaml_and_ros() {
        let json = r#"{"camera_matrix": [[600, 0, 319.5], [0, 610, 239.5], [0, 0, 1]], "dist_coeffs": [[-0.1]]}"#;
        let got = Calibration::read(json).unwrap();
        assert_eq!((got.lens.focal, got.lens.centre), ([600.0, 610.0], [320.0, 240.0]));
        assert_eq!((got.lens.distortion[0], got.size), (-0.1, None));
        let yaml = "%YAML:1.0\n---\nimage_width: 640\nimage_height: 480\nrectification_matrix:\n  data: [1]\n\
                    camera_matrix: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 6.0e+02, 0.,\n       3.195e+02, 0., 600., 239.5, 0., 0., 1. ]\n";
        let got = Calibration::read(yaml).unwrap();
        assert_eq!((got.lens.centre, got.size), ([320.0, 240.0], Some((640, 480))));
    }

    #[test]
    fn broken_files_say_where() {
        let error = |text: &str| Calibration::read(text).unwrap_err().to_string();
        assert!(error("").starts_with("camera_matrix is missing"));
        assert!(error("\ncamera_matrix: 5").starts_with("2: camera_matrix needs"));
        assert!(error("camera_matrix: [1, 2]").starts_with("1: camera_matrix needs"));
        assert!(error("camera_matrix: [[[").starts_with("1: "));
        let flat = "camera_matrix: [0, 0, 1, 0, 5, 1, 0, 0, 1]";
        assert!(error(flat).starts_with("1: camera_matrix must be"));
        let many =
            "camera_matrix: [5, 0, 1, 0, 5, 1, 0, 0, 1]\ndist_coeffs: [1, 2, 3, 4, 5, 6, 7, 8]";
        assert!(error(many).starts_with("2: 8 distortion"));
    }
}
