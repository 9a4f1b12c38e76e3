//! Cameras against f64 and against the systems' own formulas.

extern crate std;

use super::projection::{orthographic, perspective, perspective_focal, windowing};
use super::*;
use crate::math::Angle;
use crate::math::testing::Random;

type Float3 = [f64; 3];

fn dot(a: Float3, b: Float3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn sub(a: Float3, b: Float3) -> Float3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Float3, b: Float3) -> Float3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Float3) -> Float3 {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

fn vector(random: &mut Random, scale: f64) -> Vec3 {
    Vec3::from_f64([random.unit() * scale, random.unit() * scale, random.unit() * scale])
}

fn q(x: f64) -> Q16 {
    Q16::from_f64(x)
}

/// A world point in clip space, by the camera's own matrices, in f64.
fn clip(camera: &Camera, p: Float3) -> [f64; 4] {
    let m = (camera.projection * camera.view).to_f64();
    [0, 1, 2, 3].map(|r| m[r][0] * p[0] + m[r][1] * p[1] + m[r][2] * p[2] + m[r][3])
}

fn plain() -> Mat4 {
    perspective(Angle::from_degrees(q(60.0)), q(4.0 / 3.0), q(1.0), q(100.0)).unwrap()
}

#[test]
fn system_e_view_is_the_uvw_basis() {
    let mut random = Random::new();
    let mut worst = 0.0f64;
    for _ in 0..50_000 {
        let (eye, focal, up) =
            (vector(&mut random, 50.0), vector(&mut random, 50.0), vector(&mut random, 1.0));
        let Ok(view) = view::look_at(eye, focal, up) else { continue };
        let (e, f) = (eye.to_f64(), focal.to_f64());
        let w = unit(sub(e, f));
        let across = cross(up.to_f64(), w);
        let u = unit(across);
        let v = cross(w, u);
        let (m, reach) = (view.to_f64(), 1.0 + dot(e, e).sqrt());
        for (row, axis) in [u, v, w].iter().enumerate() {
            for (got, want) in m[row].iter().zip(axis) {
                worst = worst.max((got - want).abs());
            }
            assert!((m[row][3] + dot(*axis, e)).abs() <= reach * 2.0f64.powi(-28));
        }
        assert_eq!(m[3], [0.0, 0.0, 0.0, 1.0]);
    }
    std::println!("look_at: axis error 2^{}", worst.log2());
    assert!(worst <= 2.0f64.powf(-28.5));
}

#[test]
fn the_gaze_lies_along_minus_w() {
    let view = view::look_at(Vec3::from_f64([3.0, 4.0, 12.0]), Vec3::ZERO, Vec3::Y).unwrap();
    let [x, y, z, w] = view.transform_point(Vec3::ZERO);
    assert!(x.abs() <= 64 && y.abs() <= 64 && (z + (13 << 32)).abs() <= 64 && w == 1 << 32);
    // From the z axis nothing turns.
    let view = view::look_at(Vec3::from_f64([0.0, 0.0, 5.0]), Vec3::ZERO, Vec3::Y).unwrap();
    assert_eq!(view, Mat4::translation(Vec3::from_f64([0.0, 0.0, -5.0])));
}

#[test]
fn degenerate_views_are_errors() {
    let eye = Vec3::from_f64([1.0, 2.0, 3.0]);
    assert_eq!(view::look_at(eye, eye, Vec3::Y), Err(CameraError::NoGaze));
    assert_eq!(view::look_at(eye, Vec3::ZERO, Vec3::ZERO), Err(CameraError::UpAlongGaze));
    assert_eq!(view::look_at(eye, Vec3::ZERO, eye), Err(CameraError::UpAlongGaze));
    assert_eq!(view::look_at(eye, Vec3::ZERO, -eye.scale(q(7.0))), Err(CameraError::UpAlongGaze));
    // Nearly parallel still works, and gives an orthonormal basis.
    let mut nearly = eye;
    nearly.x.0 += 1;
    let m = view::look_at(eye, Vec3::ZERO, nearly).unwrap().to_f64();
    let row = |r: usize| [m[r][0], m[r][1], m[r][2]];
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        assert!(dot(row(a), row(b)).abs() <= 2.0f64.powi(-27));
        assert!((dot(row(a), row(a)) - 1.0).abs() <= 2.0f64.powi(-27));
    }
    // The far corners of the format.
    let corner = Vec3::new(Q16::MIN, Q16::MIN, Q16::MIN);
    let other = Vec3::new(Q16::MAX, Q16::MAX, Q16::MIN);
    let camera = Camera::look_at(corner, other, Vec3::new(Q16::MIN, Q16::MAX, Q16::MIN), plain());
    let [.., w] = clip(&camera.unwrap(), other.to_f64());
    assert!((w - 65536.0 * 2.0f64.sqrt()).abs() < 0.001);
}

#[test]
fn perspective_maps_its_planes_and_edges() {
    let mut random = Random::new();
    for _ in 0..20_000 {
        let degrees = random.range(2, 170) as f64;
        let (aspect, near) = (q(0.5 + random.unit().abs() * 2.0), q(0.01 + random.unit().abs()));
        let far = q(near.to_f64() + 1.0 + random.unit().abs() * 5000.0);
        let m = perspective(Angle::from_degrees(q(degrees)), aspect, near, far).unwrap().to_f64();
        let (n, f) = (near.to_f64(), far.to_f64());
        let cot = 1.0 / (degrees.to_radians() / 2.0).tan();
        let bound = 2.0f64.powi(-29) * (1.0 + cot * cot);
        assert!((m[1][1] - cot).abs() <= bound);
        assert!(
            (m[0][0] - cot / aspect.to_f64()).abs() <= bound / aspect.to_f64() + 2.0f64.powi(-32)
        );
        let z = |distance: f64| m[2][2] * -distance + m[2][3];
        assert!(z(n).abs() <= 2.0f64.powi(-30));
        assert!((z(f) - f).abs() <= f * 2.0f64.powi(-30));
        assert_eq!(m[3], [0.0, 0.0, -1.0, 0.0]);
    }
}

#[test]
fn system_b_projection_is_an_affine_map_of_ours() {
    // Equations 12 to 14 with fov_const = 1 / tan(phi / 2), aspect_ratio = height / width.
    let (fov_const, aspect, near, far) = (1.75, 240.0 / 320.0, 0.5, 60.0);
    let ours = perspective_focal(q(fov_const), q(aspect), q(near), q(far)).unwrap();
    let camera =
        Camera { view: Mat4::IDENTITY, projection: ours, viewpoint: Viewpoint::Point(Vec3::ZERO) };
    let mut random = Random::new();
    for i in 0..2_000 {
        let z = match i {
            0 => -near,
            1 => -far,
            _ => -near - (far - near) * random.unit().abs(),
        };
        let (x, y) = (random.unit() * 20.0, random.unit() * 20.0);
        let c = clip(&camera, [x, y, z]);
        let b = [
            fov_const * aspect * x,
            fov_const * y,
            (z * (far + near) + 2.0 * far * near) / (far - near),
            -z,
        ];
        // x, y and w are B's; z_B = w - 2 z, so that near becomes +1 and far -1.
        let mapped = [c[0], c[1], c[3] - 2.0 * c[2], c[3]];
        for k in 0..4 {
            assert!((mapped[k] - b[k]).abs() <= 1e-7, "{mapped:?} {b:?}");
        }
        let depth = mapped[2] / mapped[3];
        assert!(i != 0 || (depth - 1.0).abs() < 1e-7);
        assert!(i != 1 || (depth + 1.0).abs() < 1e-7);
    }
}

#[test]
fn system_e_windowing_is_pixels_per_unit_from_the_middle() {
    let (width, height) = (640u16, 480u16);
    let projection = windowing(q(37.5), (width, height), q(-10.0), q(10.0)).unwrap();
    let (eye, focal) = (Vec3::from_f64([1.0, 2.0, 3.0]), Vec3::from_f64([-1.0, 0.5, 0.0]));
    let camera = Camera::look_at(eye, focal, Vec3::Y, projection).unwrap();
    let m = camera.view.to_f64();
    let mut random = Random::new();
    for _ in 0..2_000 {
        let p = vector(&mut random, 8.0).to_f64();
        let [x, y, _, w] = clip(&camera, p);
        assert_eq!(w, 1.0);
        // The viewport's x right, y down against E's multiply and add.
        let pixel = [(x + 1.0) / 2.0 * width as f64, (1.0 - y) / 2.0 * height as f64];
        let uv = [0, 1].map(|r| dot([m[r][0], m[r][1], m[r][2]], p) + m[r][3]);
        assert!((pixel[0] - (uv[0] * 37.5 + 320.0)).abs() < 1e-5);
        assert!((pixel[1] - (240.0 - uv[1] * 37.5)).abs() < 1e-5);
    }
    // The viewer of parallel rays is a direction: w.
    let Viewpoint::Direction(w) = camera.viewpoint else { panic!("a point") };
    let exact = unit(sub(eye.to_f64(), focal.to_f64()));
    assert!((0..3).all(|i| (w.to_f64()[i] - exact[i]).abs() <= 1.0 / 65536.0));
}

#[test]
fn orthographic_maps_its_box() {
    let m = orthographic(q(8.0), q(6.0), q(1.0), q(21.0)).unwrap().to_f64();
    assert_eq!(m[0], [0.25, 0.0, 0.0, 0.0]);
    assert!((m[1][1] - 1.0 / 3.0).abs() <= 2.0f64.powi(-33));
    assert!((m[2][3] - m[2][2]).abs() <= 2.0f64.powi(-32));
    assert!((m[2][2] * -21.0 + m[2][3] - 1.0).abs() <= 2.0f64.powi(-27));
    assert_eq!(m[3], [0.0, 0.0, 0.0, 1.0]);
    assert!(orthographic(q(8.0), q(6.0), q(-5.0), q(5.0)).is_ok());
}

#[test]
fn impossible_projections_are_errors() {
    let (fov, one, two) = (Angle::QUARTER, q(1.0), q(2.0));
    for bad in [Angle(0), Angle(1), Angle::HALF, Angle(u32::MAX)] {
        assert_eq!(perspective(bad, one, one, two), Err(CameraError::FieldOfView), "{bad:?}");
    }
    let (zero, less) = (Q16::ZERO, q(-1.0));
    for bad in [zero, less] {
        assert_eq!(perspective(fov, bad, one, two), Err(CameraError::Size));
        assert_eq!(perspective(fov, one, bad, two), Err(CameraError::Depth));
        assert_eq!(perspective_focal(bad, one, one, two), Err(CameraError::FieldOfView));
        assert_eq!(perspective_focal(one, bad, one, two), Err(CameraError::Size));
        assert_eq!(orthographic(bad, one, one, two), Err(CameraError::Size));
        assert_eq!(orthographic(one, bad, one, two), Err(CameraError::Size));
        assert_eq!(windowing(bad, (4, 4), one, two), Err(CameraError::Size));
    }
    for far in [one, Q16::HALF, Q16::MIN] {
        assert_eq!(perspective(fov, one, one, far), Err(CameraError::Depth));
        assert_eq!(orthographic(one, one, one, far), Err(CameraError::Depth));
        assert_eq!(windowing(one, (4, 4), one, far), Err(CameraError::Depth));
    }
    assert_eq!(windowing(one, (0, 4), one, two), Err(CameraError::Size));
    assert_eq!(windowing(one, (4, 0), one, two), Err(CameraError::Size));
    // Extremes that exist must not overflow.
    assert!(perspective(Angle(2), Q16(1), Q16(1), Q16(2)).is_err());
    assert!(perspective(Angle((1 << 31) - 1), Q16::MAX, Q16(1), Q16::MAX).is_ok());
    assert!(orthographic(Q16(1), Q16(1), Q16::MIN, Q16::MAX).is_ok());
    assert_eq!(std::format!("{}", CameraError::Depth), "the planes must satisfy 0 < near < far");
}

/// System C's screen in our axes: its x right, y down, z into the screen; the screen's plane at z =
/// 640.
fn system_c_camera(viewer: [i32; 3]) -> Camera {
    let at =
        |x: i16, y: i16, z: i16| Vec3::new(Q16::from_int(x), Q16::from_int(-y), Q16::from_int(-z));
    let screen = Screen {
        lower_left: at(0, 480, 640),
        lower_right: at(640, 480, 640),
        upper_left: at(0, 0, 640),
    };
    let [x, y, z] = viewer.map(|n| n as i16);
    Camera::off_axis(at(x, y, z), &screen, q(0.5), q(2000.0)).unwrap()
}

#[test]
fn system_c_head_tracked_projection() {
    let mut random = Random::new();
    let mut viewers = std::vec![[320, 240, 0], [0, 0, 0], [639, 479, 639], [0, 479, 600]];
    for _ in 0..500 {
        let [x, y, z] = [639, 479, 639].map(|most| random.range(0, most) as i32);
        viewers.push([x, y, z]);
    }
    let mut worst = 0.0f64;
    for viewer in viewers {
        let camera = system_c_camera(viewer);
        // C's cube: cube_x0 ... cube_z1.
        for corner in 0..8 {
            let pick = |bit: i32, low: i32, high: i32| if corner & bit == 0 { low } else { high };
            let p = [pick(1, 200, 440), pick(2, 120, 360), pick(4, 740, 980)];
            let c = camera.projection.mul(&camera.view).transform_point(Vec3::new(
                Q16::from_int(p[0] as i16),
                Q16::from_int(-p[1] as i16),
                Q16::from_int(-p[2] as i16),
            ));
            let size = [640, 480];
            for axis in 0..2 {
                // Clip to pixels, exactly: (1 +- c / w) size / 2; C's y runs down.
                let signed = if axis == 0 { c[0] } else { -c[1] } as i128;
                let (num, den) = ((c[3] as i128 + signed) * size[axis] as i128, 2 * c[3] as i128);
                // x' = xv + (x - xv) (640 - zv) / (z - zv)
                let dz = (p[2] - viewer[2]) as i128;
                let exact = viewer[axis] as i128 * dz
                    + ((p[axis] - viewer[axis]) * (640 - viewer[2])) as i128;
                // |num / den - exact / dz| as one fraction
                let apart = (num * dz - exact * den).abs();
                assert!(2 * apart <= den * dz, "half a pixel: {viewer:?} {p:?}");
                worst = worst.max(apart as f64 / (den * dz) as f64);
            }
        }
    }
    std::println!("system C: at most {worst:e} pixels apart");
    assert!(worst < 2.0f64.powi(-22));
}

#[test]
fn off_axis_sees_the_screen_where_it_is() {
    let mut random = Random::new();
    for _ in 0..5_000 {
        // A rectangle anywhere: two perpendicular edges from a corner.
        let (corner, right) =
            (vector(&mut random, 5.0).to_f64(), unit(vector(&mut random, 1.0).to_f64()));
        let up = unit(cross(vector(&mut random, 1.0).to_f64(), right));
        let normal = cross(right, up);
        let (width, height) = (1.0 + random.unit().abs() * 4.0, 1.0 + random.unit().abs() * 4.0);
        let on = |s: f64, t: f64, n: f64| {
            [0, 1, 2].map(|i| corner[i] + right[i] * width * s + up[i] * height * t + normal[i] * n)
        };
        let screen = Screen {
            lower_left: Vec3::from_f64(on(0.0, 0.0, 0.0)),
            lower_right: Vec3::from_f64(on(1.0, 0.0, 0.0)),
            upper_left: Vec3::from_f64(on(0.0, 1.0, 0.0)),
        };
        let distance = 1.0 + random.unit().abs() * 4.0;
        let eye = on(random.unit() * 2.0, random.unit() * 2.0, distance);
        let camera = Camera::off_axis(Vec3::from_f64(eye), &screen, q(0.1), q(100.0)).unwrap();
        for (s, t) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.5, 0.5), (0.3, 0.9)] {
            // A point on the screen and any point behind it on the same ray fall on the same place.
            let p = on(s, t, 0.0);
            for depth in [1.0, 2.5] {
                let ray = [0, 1, 2].map(|i| eye[i] + (p[i] - eye[i]) * depth);
                let [x, y, z, w] = clip(&camera, ray);
                assert!((w - distance * depth).abs() < 1e-3);
                assert!((x / w - (2.0 * s - 1.0)).abs() < 2e-4, "{} {s}", x / w);
                assert!((y / w - (2.0 * t - 1.0)).abs() < 2e-4, "{} {t}", y / w);
                assert!(z > 0.0 && z < w);
            }
        }
    }
}

#[test]
fn off_axis_is_kooima_s_generalised_perspective_projection() {
    let mut random = Random::new();
    let mut worst = 0.0f64;
    for _ in 0..20_000 {
        let right = unit(vector(&mut random, 1.0).to_f64());
        let up = unit(cross(vector(&mut random, 1.0).to_f64(), right));
        let a = vector(&mut random, 50.0);
        let edge = |axis: Float3, length: f64| a + Vec3::from_f64(axis.map(|x| x * length));
        let screen = Screen {
            lower_left: a,
            lower_right: edge(right, 0.5 + random.unit().abs() * 60.0),
            upper_left: edge(up, 0.5 + random.unit().abs() * 60.0),
        };
        let eye = vector(&mut random, 100.0);
        let (n, f) = (0.25, 900.0);
        let Ok(camera) = Camera::off_axis(eye, &screen, q(n), q(f)) else { continue };
        // Kooima's code, on the rounded inputs.
        let [pa, pb, pc] =
            [screen.lower_left, screen.lower_right, screen.upper_left].map(Vec3::to_f64);
        let pe = eye.to_f64();
        let vr = unit(sub(pb, pa));
        let vn = unit(cross(vr, sub(pc, pa)));
        let vu = cross(vn, vr);
        let [va, vb, vc] = [sub(pa, pe), sub(pb, pe), sub(pc, pe)];
        let d = -dot(vn, va);
        let [l, r] = [va, vb].map(|v| dot(vr, v) * n / d);
        let [b, t] = [va, vc].map(|v| dot(vu, v) * n / d);
        let m = camera.projection.to_f64();
        let reach = [va, vb, vc].map(|v| dot(v, v).sqrt()).iter().sum::<f64>();
        for (got, exact, side) in [
            (m[0][0], 2.0 * n / (r - l), dot(vr, sub(pb, pa))),
            (m[1][1], 2.0 * n / (t - b), dot(vu, sub(pc, pa))),
            (m[0][2], (r + l) / (r - l), dot(vr, sub(pb, pa))),
            (m[1][2], (t + b) / (t - b), dot(vu, sub(pc, pa))),
        ] {
            worst = worst.max((got - exact).abs() / (reach / side));
        }
        for (row, axis) in [vr, vu, vn].iter().enumerate() {
            let v = camera.view.to_f64()[row];
            assert!((0..3).all(|i| (v[i] - axis[i]).abs() <= 2.0f64.powf(-28.5)));
            assert!((v[3] + dot(*axis, pe)).abs() <= 2.0f64.powi(-28) * 200.0);
        }
    }
    std::println!("off_axis: entry error 2^{} of the ratio", worst.log2());
    assert!(worst <= 2.0f64.powi(-27));
}

#[test]
fn off_axis_before_the_middle_is_plain_perspective() {
    let screen = Screen::centred(q(4.0), q(3.0));
    let eye = Vec3::from_f64([0.0, 0.0, 2.0]);
    let camera = Camera::off_axis(eye, &screen, q(0.5), q(50.0)).unwrap();
    let focal = perspective_focal(Q16::from_ratio(4, 3), Q16::from_ratio(3, 4), q(0.5), q(50.0));
    let (got, want) = (camera.projection.to_f64(), focal.unwrap().to_f64());
    for (a, b) in got.iter().flatten().zip(want.iter().flatten()) {
        assert!((a - b).abs() < 2.0f64.powi(-15)); // 4/3 and 3/4 were rounded to Q16.16
    }
    assert_eq!(camera.view, Mat4::translation(-eye));
    assert_eq!(camera.viewpoint, Viewpoint::Point(eye));
    let odd = Screen::centred(Q16(5), Q16(3));
    assert_eq!((odd.lower_right - odd.lower_left).x, Q16(5));
    assert_eq!((odd.upper_left - odd.lower_left).y, Q16(3));
}

#[test]
fn impossible_screens_are_errors() {
    let screen = Screen::centred(q(4.0), q(3.0));
    let front = Vec3::from_f64([0.0, 0.0, 2.0]);
    let off = |eye, screen: &Screen| Camera::off_axis(eye, screen, q(0.5), q(50.0)).unwrap_err();
    assert_eq!(off(Vec3::ZERO, &screen), CameraError::BehindScreen);
    assert_eq!(off(-front, &screen), CameraError::BehindScreen);
    let point = Screen { lower_left: front, lower_right: front, upper_left: front };
    assert_eq!(off(front, &point), CameraError::NoScreen);
    let line = Screen { upper_left: screen.lower_right, ..screen };
    assert_eq!(off(front, &line), CameraError::NoScreen);
    assert_eq!(off(front, &Screen::centred(Q16::ZERO, q(1.0))), CameraError::NoScreen);
    assert_eq!(Camera::off_axis(front, &screen, q(0.0), q(1.0)), Err(CameraError::Depth));
    assert_eq!(Camera::off_axis(front, &screen, q(2.0), q(1.0)), Err(CameraError::Depth));
    let aside = Vec3::new(Q16::MAX, Q16::MIN, Q16(1));
    let dot = Screen::centred(Q16(1), Q16(1));
    assert_eq!(off(aside, &dot), CameraError::Size);
    assert!(Camera::off_axis_pair(front, -front, &screen, q(0.5), q(50.0)).is_err());
    // All corners of the format.
    let far = |x, y, z| Vec3::new(x, y, z);
    let (a, b) = (Q16::MIN, Q16::MAX);
    let huge =
        Screen { lower_left: far(a, a, a), lower_right: far(b, a, a), upper_left: far(a, b, a) };
    assert!(Camera::off_axis(far(b, b, b), &huge, Q16(1), b).is_ok());
}

#[test]
fn stereo_has_no_parallax_at_the_convergence_distance() {
    let (eye, focal) = (Vec3::from_f64([2.0, 3.0, 4.0]), Vec3::from_f64([0.0, 1.0, -3.0]));
    let centre = Camera::look_at(eye, focal, Vec3::Y, plain()).unwrap();
    let (distance, convergence) = (0.25, 6.0);
    let [left, right] = centre.stereo_pair(q(distance), q(convergence)).unwrap();
    let rigid = centre.view.inverse_rigid().to_f64();
    let mut random = Random::new();
    for _ in 0..2_000 {
        let depth = 1.0 + random.unit().abs() * 30.0;
        let local = [random.unit() * depth, random.unit() * depth, -depth];
        let p =
            [0, 1, 2].map(|r| dot([rigid[r][0], rigid[r][1], rigid[r][2]], local) + rigid[r][3]);
        let [l, c, r] = [&left, &centre, &right].map(|camera| clip(camera, p));
        let parallax = r[0] / r[3] - l[0] / l[3];
        // Similar triangles: e fx (1 / c - 1 / depth), on the right beyond the convergence
        // distance.
        let fx = centre.projection.to_f64()[0][0];
        let exact = distance * fx * (1.0 / convergence - 1.0 / depth);
        assert!((parallax - exact).abs() < 1e-6, "{parallax} {exact}");
        assert!((l[1] - c[1]).abs() < 1e-6 && (l[2] - c[2]).abs() < 1e-6, "no vertical parallax");
        assert!((l[3] - c[3]).abs() < 1e-6 && (r[3] - c[3]).abs() < 1e-6);
    }
    let (Viewpoint::Point(l), Viewpoint::Point(r)) = (left.viewpoint, right.viewpoint) else {
        panic!("directions")
    };
    let apart = sub(r.to_f64(), l.to_f64());
    assert!((dot(apart, apart).sqrt() - distance).abs() < 1e-4);
    assert!(dot(apart, sub(eye.to_f64(), focal.to_f64())).abs() < 1e-3);
    // Each eye's view agrees with its viewpoint.
    let [x, y, z, _] = left.view.transform_point(l).map(|n| n as f64 / 4294967296.0);
    assert!(x.abs() < 3e-5 && y.abs() < 3e-5 && z.abs() < 3e-5);
}

#[test]
fn stereo_and_off_axis_pairs_agree() {
    // An upright screen at the convergence distance is the same window.
    let (near, far, e) = (q(0.5), q(50.0), 0.5);
    let screen = Screen::centred(q(4.0), q(2.0));
    let eye = |x: f64| Vec3::from_f64([x, 0.0, 3.0]);
    let pair = Camera::off_axis_pair(eye(-e / 2.0), eye(e / 2.0), &screen, near, far).unwrap();
    let projection = perspective_focal(q(3.0), q(0.5), near, far).unwrap();
    let centre = Camera::look_at(eye(0.0), Vec3::ZERO, Vec3::Y, projection).unwrap();
    for (a, b) in pair.iter().zip(centre.stereo_pair(q(e), q(3.0)).unwrap()) {
        let (m, n) = ((a.projection * a.view).to_f64(), (b.projection * b.view).to_f64());
        for (x, y) in m.iter().flatten().zip(n.iter().flatten()) {
            assert!((x - y).abs() < 2.0f64.powi(-28));
        }
        assert_eq!(a.viewpoint, b.viewpoint);
    }
}

#[test]
fn impossible_stereo_is_an_error() {
    let camera = |projection| {
        Camera::look_at(Vec3::from_f64([0.0, 0.0, 5.0]), Vec3::ZERO, Vec3::Y, projection).unwrap()
    };
    let (one, zero) = (q(1.0), Q16::ZERO);
    let perspective = camera(plain());
    assert_eq!(perspective.stereo_pair(q(-1.0), one), Err(CameraError::Stereo));
    assert_eq!(perspective.stereo_pair(one, zero), Err(CameraError::Stereo));
    let flat = perspective.stereo_pair(zero, one).unwrap();
    assert_eq!(flat, [perspective, perspective]);
    let parallel = camera(orthographic(one, one, zero, one).unwrap());
    assert_eq!(parallel.stereo_pair(one, one), Err(CameraError::NotPerspective));
    let mut wide = perspective;
    wide.projection.m[0][0] = i64::MAX;
    assert_eq!(wide.stereo_pair(Q16::MAX, Q16(1)), Err(CameraError::Size));
}
