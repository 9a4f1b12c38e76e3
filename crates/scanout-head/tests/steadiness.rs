//! Filter and prediction as numbers: how much a resting head trembles, how far a moving one is behind.

mod support;

use scanout_head::one_euro::Settings;
use scanout_head::source::Sample;
use scanout_head::tracker::{Options, Tracker};
use support::Random;

/// Samples a second.
const RATE: f64 = 60.0;

/// Tremble of the tracker, standard deviation in mm.
const TREMBLE: f64 = 0.8;

/// A head's way along x, mm: at rest, to the side and back as heads move (minimum jerk, 300 mm in 0.8 s), again and again.
fn way(time: f64) -> f64 {
    let minimum_jerk = |s: f64| {
        let s = s.clamp(0.0, 1.0);
        300.0 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
    };
    let t = time % 4.0;
    minimum_jerk((t - 1.2) / 0.8) - minimum_jerk((t - 3.2) / 0.8)
}

/// Standard deviation at rest, mm; delay of the movement, ms; farthest from the true place while it moves, mm.
fn measure(options: Options) -> [f64; 3] {
    let mut random = Random(42);
    let mut tracker = Tracker::new(options);
    let (mut still, mut moving) = (Vec::new(), Vec::new());
    for i in 0..(120.0 * RATE) as usize {
        let time = i as f64 / RATE;
        let eye = Some([way(time) + TREMBLE * random.normal(), 0.0, 600.0]);
        let [x, _, _] = tracker.update(time, Some(Sample { time, eye }));
        if time < 8.0 {
            continue; // the glide from the place of rest
        }
        if (0.8..1.2).contains(&(time % 4.0)) {
            still.push(x);
        } else {
            moving.push((time, x));
        }
    }
    let mean = still.iter().sum::<f64>() / still.len() as f64;
    let tremble =
        (still.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / still.len() as f64).sqrt();
    // The delay at which the true way fits best.
    let misfit = |delay: f64| moving.iter().map(|(t, x)| (way(t - delay) - x).powi(2)).sum::<f64>();
    let delay = (-100..=200).map(|ms| f64::from(ms) / 1000.0);
    let delay = delay.min_by(|a, b| misfit(*a).total_cmp(&misfit(*b))).unwrap();
    let farthest = moving.iter().map(|(t, x)| (way(*t) - x).abs()).fold(0.0, f64::max);
    [tremble, delay * 1000.0, farthest]
}

#[test]
fn steady_at_rest_and_close_behind_when_it_moves() {
    let base = Options::default();
    let predicted = |prediction| Options { prediction, ..base };
    let slow = Settings { beta: 0.0, ..Settings::default() };
    let rows = [
        ("no filter", Options { filter: None, ..base }),
        ("filter", base),
        ("low pass of 1.5 Hz alone", Options { filter: Some(slow), ..base }),
        ("filter, 20 ms ahead", predicted(0.02)),
        ("filter, 50 ms ahead", predicted(0.05)),
    ];
    let rows = rows.map(|(name, options)| {
        let [tremble, delay, farthest] = measure(options);
        println!("{name:<26} tremble {tremble:.2} mm, delay {delay:>3.0} ms, at most {farthest:.1} mm off");
        [tremble, delay, farthest]
    });
    let [raw, filter, low_pass, ahead, far_ahead] = rows;
    assert!((raw[0] - TREMBLE).abs() < 0.08 && raw[1].abs() < 2.0, "{raw:?}");
    assert!(filter[0] < TREMBLE * 0.45 && filter[1] <= 25.0, "{filter:?}");
    assert!(low_pass[1] > 60.0, "what the filter is for: {low_pass:?}");
    assert!(
        ahead[1] < filter[1] && ahead[0] > filter[0],
        "earlier, and it trembles more: {ahead:?}"
    );
    assert!(far_ahead[1] < ahead[1] && far_ahead[0] > ahead[0], "{far_ahead:?}");
}

/// A real head: roughness (second differences, as the standard deviation of the noise that would make them, mm) before and behind the
/// filter, and its delay, axis by axis.
#[test]
fn a_real_head_becomes_smoother_and_hardly_later() {
    let file = include_str!("carphone.csv");
    let samples = scanout_head::recording::read(file.as_bytes()).unwrap();
    let measure = |options: Options| -> [[f64; 3]; 3] {
        let mut tracker = Tracker::new(options);
        let mut eyes = Vec::new();
        for sample in &samples {
            let eye = tracker.update(sample.time, Some(*sample));
            // Without the glide from the place of rest, and with both.
            if let (true, Some(raw)) = (sample.time > 1.0, sample.eye) {
                eyes.push((sample.time, raw, eye));
            }
        }
        std::array::from_fn(|axis| {
            let rough = |of: &dyn Fn(usize) -> f64| {
                let second = (2..eyes.len()).map(|i| of(i) - 2.0 * of(i - 1) + of(i - 2));
                (second.map(|d| d * d).sum::<f64>() / (6 * (eyes.len() - 2)) as f64).sqrt()
            };
            // The delay at which the raw way fits best, between samples along straight lines.
            let raw_at = |time: f64| {
                let next = eyes.partition_point(|eye| eye.0 < time).clamp(1, eyes.len() - 1);
                let ((t0, a, _), (t1, b, _)) = (&eyes[next - 1], &eyes[next]);
                a[axis] + (b[axis] - a[axis]) * ((time - t0) / (t1 - t0))
            };
            let misfit = |delay: f64| {
                let later = eyes.iter().skip(10);
                later.map(|(t, _, eye)| (raw_at(t - delay) - eye[axis]).powi(2)).sum::<f64>()
            };
            let delays = (0..=200).map(|ms| f64::from(ms) / 1000.0);
            let delay = delays.min_by(|a, b| misfit(*a).total_cmp(&misfit(*b))).unwrap();
            [rough(&|i| eyes[i].1[axis]), rough(&|i| eyes[i].2[axis]), 1000.0 * delay]
        })
    };
    let base = Options::default();
    let filtered = measure(base);
    let predicted = measure(Options { prediction: 0.05, ..base });
    for (name, rows) in [("filter", filtered), ("filter, 50 ms ahead", predicted)] {
        for (axis, [raw, smooth, delay]) in ["x", "y", "z"].iter().zip(rows) {
            println!(
                "{name:<20} {axis}: roughness {raw:.2} -> {smooth:.2} mm, delay {delay:.0} ms"
            );
        }
    }
    for ([raw, smooth, delay], [_, rougher, earlier]) in filtered.into_iter().zip(predicted) {
        assert!(smooth < 0.8 * raw && delay <= 30.0, "{filtered:?}");
        assert!(rougher > smooth && earlier < delay, "{predicted:?}");
    }
}
