//! `delay_line.sv`.

use scanout_cosim::{Model, Random};

#[test]
fn the_output_is_the_input_of_four_clocks_ago() {
    let mut model = Model::new("delay_line");
    let (s, m) = (model.port("s"), model.port("m"));
    let mut random = Random::new(1);
    let words: Vec<u64> = (0..1000).map(|_| random.below(1 << 9)).collect();
    for (i, &word) in words.iter().enumerate() {
        model.set(s, word);
        model.clock();
        if i >= 4 {
            assert_eq!(model.get(m), words[i + 1 - 4], "clock {i}");
        }
    }
}
