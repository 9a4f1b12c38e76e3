//! The monitor itself, on signals that are right and on signals that are wrong.

use scanout_cosim::monitor::{Axis, Mode, Monitor, Seen};

const SMALL: Mode = Mode {
    horizontal: Axis { active: 8, front: 2, sync: 3, back: 4, positive: false },
    vertical: Axis { active: 5, front: 1, sync: 2, back: 3, positive: true },
};

/// Three frames of a mode, lit all over, seen by a monitor that expects `SMALL`.
fn see(sent: Mode, mut disturb: impl FnMut(usize, &mut (bool, bool, [u8; 3]))) -> Vec<Seen> {
    let (h, v) = (sent.horizontal, sent.vertical);
    let mut monitor = Monitor::new(SMALL);
    let mut seen = Vec::new();
    for i in 0..sent.clocks() * 4 + 1 {
        let (x, y) = (i % h.total(), i / h.total() % v.total());
        let pulse = |axis: Axis, at: usize| {
            let begin = axis.active + axis.front;
            (begin..begin + axis.sync).contains(&at) == axis.positive
        };
        let lit = x < h.active && y < v.active;
        let rgb = if lit { [x as u8 + 1, y as u8 + 1, 9] } else { [0; 3] };
        let mut pins = (pulse(h, x), pulse(v, y), rgb);
        disturb(i, &mut pins);
        seen.extend(monitor.clock(pins.0, pins.1, pins.2));
    }
    seen
}

fn faults(sent: Mode) -> Vec<String> {
    let seen = see(sent, |_, _| ());
    assert!(!seen.is_empty(), "no frame was seen");
    seen[0].faults.clone()
}

#[test]
fn a_right_signal_is_measured_and_its_picture_rebuilt() {
    for seen in see(SMALL, |_, _| ()) {
        assert_eq!(seen.faults, [""; 0]);
        assert_eq!(seen.measured, SMALL);
        let picture = (0..40u8).map(|i| [i % 8 + 1, i / 8 + 1, 9]);
        assert!(seen.pixels.iter().copied().eq(picture));
    }
    assert!((Mode::VGA.refresh(25.175e6) - 59.94).abs() < 0.001);
    assert!((Mode::SVGA.refresh(40e6) - 60.317).abs() < 0.001);
}

#[test]
fn what_is_wrong_is_said() {
    let with = |change: &dyn Fn(&mut Mode)| {
        let mut mode = SMALL;
        change(&mut mode);
        faults(mode).join("; ")
    };
    let has = |text: String, part: &str| assert!(text.contains(part), "{part}: {text}");
    has(
        with(&|m| m.horizontal.positive = true),
        "the horizontal sync is positive, the mode's is negative",
    );
    has(
        with(&|m| m.vertical.positive = false),
        "the vertical sync is negative, the mode's is positive",
    );
    has(with(&|m| m.horizontal.sync = 4), "the horizontal sync is 4 clocks, the mode's is 3");
    has(with(&|m| m.vertical.sync = 1), "the vertical sync is 1 lines, the mode's is 2");
    has(with(&|m| m.horizontal.front = 3), "a line is 18 clocks, the mode's is 17");
    has(with(&|m| m.vertical.back = 4), "a frame is 12 lines, the mode's is 11");
    // The right total, but the picture is in the wrong place.
    let shifted = |m: &mut Mode| (m.horizontal.front, m.horizontal.back) = (1, 5);
    has(with(&shifted), "light outside of the picture, at pixel 8 of line 0");
    let lower = |m: &mut Mode| (m.vertical.front, m.vertical.back) = (0, 4);
    has(with(&lower), "light outside of the picture, at pixel 0 of line 5");
}

#[test]
fn a_disturbed_line_and_light_in_the_blank_are_found() {
    let clocks = SMALL.clocks();
    let late = see(SMALL, |i, pins| {
        // In one line the horizontal sync begins a clock late.
        if i == 2 * clocks + 3 * 17 + 10 {
            pins.0 = true;
        }
    });
    let text: Vec<String> = late.iter().flat_map(|s| s.faults.clone()).collect();
    assert!(text.iter().any(|t| t.contains("the horizontal sync of line")), "{text:?}");
    let lit = see(SMALL, |i, pins| {
        if i == 2 * clocks + 3 * 17 + 12 {
            pins.2 = [1, 0, 0];
        }
    });
    let text: Vec<String> = lit.iter().flat_map(|s| s.faults.clone()).collect();
    assert_eq!(text.len(), 1);
    assert!(text[0].contains("light outside of the picture"), "{text:?}");
    let none = see(SMALL, |_, pins| pins.0 = true);
    assert!(none[0].faults[0].contains("no horizontal sync"));
}
