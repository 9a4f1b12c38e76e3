//! `spin.sv` against its equation in 64 bits, with the library's sines.

use scanout::math::{Mat4, tables::SINE};
use scanout_cosim::spin::{STEPS, Spin};
use scanout_cosim::{Model, Random};

#[test]
fn each_word_of_the_matrix_is_exact() {
    let mut model = Model::new("spin");
    let names = [
        "write",
        "write_address",
        "write_word",
        "start",
        "angle",
        "right",
        "m_write",
        "m_address",
        "m_data",
        "done",
    ];
    let [write, address, word, start, angle, right, m_write, m_address, m_data, done] =
        names.map(|name| model.port(name));
    model.reset();
    let mut random = Random::new(1);
    let mut most = 0;
    for table in 0..6 {
        let mut any = || {
            let size = [1 << 29, 1 << 29, 1 << 12, 3][random.below(4) as usize];
            random.range(-size, size - 1) as i32
        };
        // Beside sensible tables: any numbers that a row may hold.
        let mut eyes = [(); 2].map(|()| Spin { words: [(); 16].map(|()| [(); 3].map(|()| any())) });
        if table == 0 {
            let view = Mat4::from_f64([(); 4].map(|()| [(); 4].map(|()| f64::from(any()) * 1e-8)));
            eyes = [0.1, -0.1].map(|tilt| Spin::new(&view, [tilt, 1.0, 0.3], 0.8));
        }
        for (i, &value) in Spin::table(&eyes[0], &eyes[1]).iter().enumerate() {
            model.set(write, 1);
            model.set(address, i as u32);
            model.set(word, value);
            model.clock();
        }
        model.set(write, 0);
        for turn in 0..150 {
            // Each quadrant's ends, and anything.
            let at = if turn < 12 {
                (turn / 3 * 256 + turn % 3 + STEPS - 1) % STEPS
            } else {
                random.below(1024) as u32
            };
            let eye = random.below(2) as usize;
            model.set(angle, at);
            model.set(right, eye as u32);
            model.set(start, 1);
            model.clock();
            model.set(start, 0);
            let mut got = [None; 16];
            let mut clocks = 0;
            while model.get(done) == 0 {
                model.clock();
                clocks += 1;
                assert!(clocks < 2000, "it never ends");
                if model.get(m_write) == 1 {
                    got[model.get(m_address) as usize] = Some(model.get_signed(m_data) as i32);
                }
            }
            most = most.max(clocks);
            let wanted = eyes[eye].matrix(at);
            assert_eq!(
                got,
                wanted.m.as_flattened().iter().map(|&v| Some(v)).collect::<Vec<_>>()[..],
                "angle {at}"
            );
        }
    }
    assert_eq!(SINE[0], 0);
    assert!(most < 1150, "{most} clocks");
}
