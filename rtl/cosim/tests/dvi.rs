//! `tmds_encode.sv` against the algorithm of DVI 1.0, and `dvi.sv` from pins to bits and back.

use scanout_cosim::tmds::{CONTROL, Encoder, Lane, Symbol, decode};
use scanout_cosim::{Model, Random};

#[test]
fn every_word_is_the_standards() {
    let mut model = Model::new("tmds_encode");
    let [data, control, active, word] =
        ["s_data", "s_control", "s_active", "m_word"].map(|name| model.port(name));
    let (mut encoder, mut random) = (Encoder::default(), Random::new(1));
    let mut wanted = Vec::new();
    // Every byte after every other one, then random runs of picture and blank.
    let every = (0..65536u32).flat_map(|i| [(i >> 8) as u8, i as u8]).map(Some);
    let mut lit = false;
    let mixed = (0..50_000).map(|_| {
        lit ^= random.percent(3);
        lit.then(|| random.below(256) as u8)
    });
    for (i, byte) in [None; 4].into_iter().chain(every).chain(mixed).enumerate() {
        let c = (i / 7 % 4) as u8;
        wanted.push(match byte {
            Some(d) => encoder.data(d),
            None => encoder.control(c),
        });
        model.set(data, byte.unwrap_or(0x5a));
        model.set(active, u8::from(byte.is_some()));
        model.set(control, c);
        model.clock();
        // Three registers; the first words after power-up are anything.
        if i >= 6 {
            assert_eq!(model.get(word), u64::from(wanted[i - 2]), "word {}", i - 2);
        }
    }
}

#[test]
fn a_receiver_gets_the_pins_back() {
    let mut model = Model::new("dvi");
    let names = ["rst_n", "clk", "clk_5x", "r", "g", "b", "active", "hsync", "vsync", "m_pairs"];
    let [rst_n, clk, clk_5x, r, g, b, active, hsync, vsync, pairs] = names.map(|n| model.port(n));
    let mut random = Random::new(2);
    let mut lanes: [Lane; 4] = Default::default();
    let mut received: [Vec<u16>; 4] = Default::default();
    let mut sent = Vec::new();
    for i in 0..20_000u32 {
        model.set(rst_n, u8::from(i > 4));
        let lit = i % 100 >= 40;
        let rgb = [0; 3].map(|_: u8| random.below(256) as u8);
        let syncs = [i % 100 < 10, i % 1000 < 200];
        model.set(r, rgb[0]);
        model.set(g, rgb[1]);
        model.set(b, rgb[2]);
        model.set(active, u8::from(lit));
        model.set(hsync, u8::from(syncs[0]));
        model.set(vsync, u8::from(syncs[1]));
        sent.push((lit, rgb, syncs));
        for tick in 0..5 {
            model.set(clk_5x, 0);
            if tick == 2 {
                model.set(clk, 0);
            }
            model.eval();
            model.set(clk_5x, 1);
            if tick == 0 {
                model.set(clk, 1);
            }
            model.eval();
            let now = model.get(pairs);
            for (lane, words) in lanes.iter_mut().zip(0..) {
                // Lane 3 is the clock: its edge, not a word, is what a receiver uses.
                for bit in [now >> (2 * words) & 1, now >> (2 * words + 1) & 1] {
                    if words == 3 {
                        received[3].push(bit as u16);
                    } else if let Some(word) = lane.bit(bit == 1) {
                        received[words].push(word);
                    }
                }
            }
        }
    }
    let clock = &received[3];
    let rising: Vec<usize> =
        (1000..clock.len()).filter(|&i| clock[i] == 1 && clock[i - 1] == 0).collect();
    assert!(rising.windows(2).all(|w| w[1] - w[0] == 10), "the clock lane is no clock");
    assert!(rising.iter().all(|&i| clock[i..(i + 5).min(clock.len())].iter().all(|&bit| bit == 1)));

    // The lanes began together; find where the received words lie in what was sent.
    let n = received[..3].iter().map(Vec::len).min().unwrap_or(0);
    assert!(n > 15_000, "{n} words");
    let symbols = |lane: usize, i: usize| decode(received[lane][received[lane].len() - n + i]);
    let meant = |(lit, rgb, syncs): (bool, [u8; 3], [bool; 2])| {
        let control = u8::from(syncs[0]) | u8::from(syncs[1]) << 1;
        if lit {
            [rgb[2], rgb[1], rgb[0]].map(Symbol::Data)
        } else {
            [control, 0, 0].map(Symbol::Control)
        }
    };
    let fits = |offset: usize| {
        (0..n - 20).all(|i| [0, 1, 2].map(|lane| symbols(lane, i)) == meant(sent[offset + i]))
    };
    assert!((0..sent.len() - n + 20).any(fits), "no shift makes the words what was sent");
    assert!(received[0].iter().any(|w| CONTROL.contains(w)));
}
