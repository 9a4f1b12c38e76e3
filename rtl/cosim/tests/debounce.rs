//! `debounce.sv` against system C's rule.

use scanout_cosim::{Model, Random};

/// Stable clocks in the configuration of the test.
const STABLE: u32 = 100;

#[test]
fn the_level_follows_a_pin_that_is_stable_long_enough() {
    let mut model = Model::new("debounce");
    let [pin, level, pressed] = ["pin", "level", "pressed"].map(|name| model.port(name));
    let mut random = Random::new(1);
    model.reset();
    // The rule, on the pin as it was two clocks of synchronisation ago.
    let (mut clean, mut same) = (false, 0);
    let (mut delayed, mut now, mut left) = ([false; 2], false, 0);
    let (mut presses, mut bounces) = (0, 0);
    for clock in 0..400_000 {
        if left == 0 {
            now = !now;
            // Around the limit, to the clock; and contacts that bounce.
            left = match random.below(4) {
                0 => STABLE as u64 + random.below(3) - 1,
                1 => 1 + random.below(300),
                _ => 1 + random.below(20),
            };
            bounces += u32::from(left < u64::from(STABLE));
        }
        left -= 1;
        model.set(pin, u8::from(now));
        let seen = delayed[1];
        delayed = [now, delayed[0]];
        model.clock();
        let was = clean;
        same = if seen == clean { 0 } else { same + 1 };
        if same == STABLE {
            (clean, same) = (seen, 0);
        }
        assert_eq!(model.get(level) == 1, clean, "clock {clock}");
        assert_eq!(model.get(pressed) == 1, clean && !was, "clock {clock}");
        presses += u32::from(clean && !was);
    }
    assert!(presses > 500 && bounces > 3000, "{presses} presses, {bounces} bounces");
}
