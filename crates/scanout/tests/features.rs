//! Cargo features: with one left out, `prepare` names it and the object that asks for it; whatever is compiled in, the same
//! pixels. `./test unit` runs this with none, with each alone and with all.

mod common;

use common::{Memory, Owned, camera, sphere};
use scanout::frame::{Frame, Needed, PrepareError, Settings};
use scanout::math::{Mat4, Q16, Vec3};
use scanout::mesh::Mesh;
use scanout::output::Rgb565;
use scanout::scene::{Background, Fog, Light, LightKind, Material, Mode, Object, Scene};
use scanout::texture::{Filter, Texels, Texture, Wrap};

const SIZE: Settings = Settings::new(64, 48);

/// What is compiled in.
macro_rules! compiled_in {
    ($($feature:literal)*) => {
        fn compiled_in(feature: &str) -> bool {
            match feature {
                // What draws every texture draws those, too.
                "palette-textures" if cfg!(feature = "all-textures") => true,
                $($feature => cfg!(feature = $feature),)*
                _ => panic!("no feature {feature}"),
            }
        }
    };
}

compiled_in! {
    "all-lights" "all-textures" "background-images" "dither" "fog" "gouraud" "lines" "palette-textures" "phong" "points" "smooth-lines"
    "two-sided" "vertex-colours"
}

/// A scene of two objects, the second of which can be changed before it is drawn.
struct Stage {
    mesh: Owned,
    coloured: bool,
    material: Material<'static>,
    texture: Texture<'static>,
    textured: bool,
    mode: Mode,
    smooth_lines: bool,
    transform: Mat4,
    light: Light,
    fog: Option<Fog>,
    background: Background<'static>,
    settings: Settings,
}

static TEXELS: [u16; 8 * 8] = {
    let (mut texels, mut i) = ([0; 64], 0);
    while i < 64 {
        texels[i] = (i * 40503) as u16;
        i += 1;
    }
    texels
};

static INDICES: [u8; 8 * 8] = {
    let (mut indices, mut i) = ([0; 64], 0);
    while i < 64 {
        indices[i] = i as u8;
        i += 1;
    }
    indices
};

static PICTURE: [[u8; 3]; 64 * 48] = {
    let (mut picture, mut i) = ([[0; 3]; 64 * 48], 0);
    while i < picture.len() {
        picture[i] = [i as u8, (i / 7) as u8, 90];
        i += 1;
    }
    picture
};

impl Stage {
    fn plain() -> Stage {
        Stage {
            mesh: sphere(12, 8),
            coloured: false,
            material: Material::default(),
            texture: Texture::new(8, 8, Texels::Rgb565(&TEXELS)).unwrap(),
            textured: false,
            mode: Mode::Flat,
            smooth_lines: false,
            transform: Mat4::translation(Vec3::from_f64([0.4, 0.0, 0.3])),
            light: Light {
                kind: LightKind::Directional(Vec3 {
                    x: Q16(40_000),
                    y: Q16(60_000),
                    z: Q16(65_536),
                }),
                colour: [255; 3],
            },
            fog: None,
            background: Background::Colour([16, 24, 40]),
            settings: SIZE,
        }
    }

    fn hash(&self) -> Result<u64, PrepareError> {
        let whole = self.mesh.mesh();
        let first = Mesh { colours: &[], ..whole };
        let second = Mesh { colours: if self.coloured { whole.colours } else { &[] }, ..whole };
        let mut material = self.material;
        if self.textured {
            material.texture = Some(&self.texture);
        }
        let plain = Material::default();
        let objects = [
            Object::new(&first, &plain, Mode::Flat),
            Object {
                transform: self.transform,
                smooth_lines: self.smooth_lines,
                ..Object::new(&second, &material, self.mode)
            },
        ];
        let lights = [self.light];
        let mut scene = Scene::new(camera(SIZE.width, SIZE.height), &objects);
        scene.lights = &lights;
        (scene.fog, scene.background) = (self.fog, self.background);
        let mut memory = Memory::new(Needed::at_most(&scene));
        let frame = Frame::prepare(&scene, self.settings, memory.store())?;
        let (mut colour, mut depth) = (vec![0; 64 * 48], vec![0; 64 * 48]);
        Ok(frame.hash::<Rgb565>(16, &mut colour, &mut depth).unwrap())
    }
}

/// What is changed, the object that is to blame and the feature that is needed, the frame's hash.
type Case = (fn(&mut Stage), Option<usize>, &'static str, u64);

const CASES: [Case; 18] = [
    (|s| s.mode = Mode::Gouraud, Some(1), "gouraud", 0xcbd2_b54c_5120_bfed),
    (|s| s.mode = Mode::Phong, Some(1), "phong", 0xd42d_4e8c_3dff_decb),
    (|s| s.mode = Mode::Wire, Some(1), "lines", 0x7955_4ae4_ce5d_b062),
    (|s| s.mode = Mode::Hidden, Some(1), "lines", 0x0e0d_ed31_7ed7_4999),
    (
        |s| (s.mode, s.smooth_lines) = (Mode::Wire, true),
        Some(1),
        "smooth-lines",
        0x25bd_8e57_6645_66b1,
    ),
    (|s| s.mode = Mode::Points, Some(1), "points", 0x3c24_6d34_5aeb_d762),
    (|s| s.material.two_sided = true, Some(1), "two-sided", 0xae84_d268_d503_3d92),
    (|s| s.coloured = true, Some(1), "vertex-colours", 0x1607_973f_6c23_0445),
    (|s| s.material.specular = Q16::ONE, Some(1), "all-lights", 0x6afe_047c_f33e_c3b6),
    (|s| s.transform.m[0][0] *= 2, Some(1), "all-lights", 0xc2ea_0b90_b100_be11),
    (|s| s.light.colour = [255, 200, 100], None, "all-lights", 0x800b_dae7_9100_7c21),
    (
        |s| s.light.kind = LightKind::Point(Vec3::from_f64([2.0, 2.0, 2.0])),
        None,
        "all-lights",
        0x03f0_bef1_6652_9d40,
    ),
    (
        |s| (s.textured, s.texture.wrap[1]) = (true, Wrap::Mirror),
        Some(1),
        "all-textures",
        0x1830_d916_2972_6aa9,
    ),
    (
        |s| (s.textured, s.texture.filter) = (true, Filter::Bilinear),
        Some(1),
        "all-textures",
        0x7ce3_83dd_cba3_8cd1,
    ),
    (
        |s| {
            let palette = Texels::Palette8 { indices: &INDICES, palette: &TEXELS };
            (s.textured, s.texture.texels) = (true, palette);
        },
        Some(1),
        "palette-textures",
        0x1830_d916_2972_6aa9, // that of the plain texture, whose colours it has
    ),
    (
        |s| s.fog = Some(Fog::Linear { colour: [200; 3], start: Q16::ONE, end: Q16::from_int(4) }),
        None,
        "fog",
        0x7046_4dc5_4b88_1a35,
    ),
    (
        |s| s.background = Background::Image(&PICTURE),
        None,
        "background-images",
        0x97c3_7dbf_76f8_467f,
    ),
    (|s| s.settings.dither = true, None, "dither", 0x90c2_5140_f577_ba7d),
];

#[test]
fn what_is_left_out_is_named_and_the_rest_is_the_same() {
    let mut wrong = Vec::new();
    let mut expect = |name: &str, stage: &Stage, expected: Result<u64, PrepareError>| {
        let got = stage.hash();
        if got != expected {
            wrong.push(format!("{name}: {got:x?} instead of {expected:x?}"));
        }
    };
    let mut stage = Stage::plain();
    expect("plain", &stage, Ok(0xae84_d268_d503_3d92));
    stage.textured = true;
    expect("plain texture", &stage, Ok(0x1830_d916_2972_6aa9));
    for (i, (change, object, feature, hash)) in CASES.into_iter().enumerate() {
        let mut stage = Stage::plain();
        change(&mut stage);
        // Smooth lines are lines first.
        let lines = feature == "smooth-lines" && !compiled_in("lines");
        let missing = if lines { "lines" } else { feature };
        let expected = match compiled_in(feature) {
            true => Ok(hash),
            false => Err(PrepareError::Feature { object, feature: missing }),
        };
        expect(&format!("{i}, {feature}"), &stage, expected);
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn the_message_names_object_and_feature() {
    let named = PrepareError::Feature { object: Some(3), feature: "phong" }.to_string();
    assert!(named.contains("object 3") && named.contains("`phong`"), "{named}");
    let scene = PrepareError::Feature { object: None, feature: "fog" }.to_string();
    assert!(scene.contains("scene") && scene.contains("`fog`"), "{scene}");
}
