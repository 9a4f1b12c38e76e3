//! The network source under load: 100,000 malformed and 10,000 valid packets a second, for two seconds.

mod support;

use std::net::UdpSocket;
use std::time::{Duration, Instant};

use scanout_head::opentrack::{Opentrack, encode};
use scanout_head::source::Source;
use support::Random;

/// What nobody should send: lengths from 0 to 1400, numbers that aren't finite, places beyond belief.
fn malformed(random: &mut Random, kind: u64) -> Vec<u8> {
    match kind % 4 {
        0 => vec![0x5a; (random.unit() * 48.0) as usize],
        1 => vec![0xa5; 49 + (random.unit() * 1351.0) as usize],
        2 => {
            let mut packet = encode([1.0, 2.0, 3.0]).to_vec();
            let slot = (random.unit() * 6.0) as usize;
            packet[slot * 8..][..8].copy_from_slice(&f64::NAN.to_le_bytes());
            packet
        }
        _ => encode([random.between(1e6, 1e300), 0.0, 0.0]).to_vec(),
    }
}

#[test]
fn floods_move_the_eye_only_where_valid_packets_say() {
    let epoch = Instant::now();
    let mut source = Opentrack::bind("127.0.0.1:0".parse().unwrap(), epoch).unwrap();
    let to = source.address();
    let seconds = 2.0;
    let sender = std::thread::spawn(move || {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        let mut random = Random(7);
        let (mut bad, mut good) = (0u64, 0u64);
        let start = Instant::now();
        while start.elapsed().as_secs_f64() < seconds {
            // A slow machine sends fewer, never faster than 110,000 a second.
            let due = (start.elapsed().as_secs_f64() * 110_000.0) as u64;
            while bad + good < due && start.elapsed().as_secs_f64() < seconds {
                if (bad + good) % 11 == 0 {
                    good += 1;
                    let x = good as f64 / 100.0;
                    let _ = socket.send_to(&encode([x, -x, 500.0]), to);
                } else {
                    bad += 1;
                    let _ = socket.send_to(&malformed(&mut random, bad), to);
                }
            }
            std::thread::sleep(Duration::from_micros(200));
        }
        (bad, good)
    });
    let (mut polls, mut samples, mut last, mut slowest) = (0, 0, 0.0, Duration::ZERO);
    while !sender.is_finished() {
        let start = Instant::now();
        let sample = source.poll(epoch.elapsed().as_secs_f64());
        slowest = slowest.max(start.elapsed());
        polls += 1;
        if let Some(sample) = sample {
            let [x, y, z] = sample.eye.expect("a packet never says that nobody is there");
            assert!(
                x == -y && z == 500.0 && x > last,
                "a place nobody sent: {x} {y} {z} after {last}"
            );
            assert!(sample.time <= epoch.elapsed().as_secs_f64());
            (samples, last) = (samples + 1, x);
        }
        std::thread::sleep(Duration::from_millis(4));
    }
    let (bad, good) = sender.join().unwrap();
    // After the flood the next packet counts.
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let end = Instant::now();
    let found = loop {
        socket.send_to(&encode([-777.0, 0.0, 600.0]), to).unwrap();
        std::thread::sleep(Duration::from_millis(2));
        match source.poll(0.0) {
            Some(sample) if sample.eye == Some([-777.0, 0.0, 600.0]) => break true,
            _ if end.elapsed() > Duration::from_secs(5) => break false,
            _ => {}
        }
    };
    let counts = source.counts();
    println!(
        "sent {bad} malformed and {good} valid packets in {seconds} s; read {} and {}; {samples} samples in {polls} polls, \
         the slowest {slowest:?}",
        counts.dropped, counts.good
    );
    assert!(found, "the source must live after the flood");
    assert!(bad > 20_000 && good > 2_000, "a flood: {bad} {good}");
    assert!(samples > 20 && counts.dropped > 1_000 && counts.good > 100, "{counts:?}");
    assert!(counts.dropped <= bad && counts.good <= good + 3_000);
    let notice = source.notice().expect("the user is told");
    assert!(notice.contains("were dropped") && source.notice().is_none(), "{notice}");
}

#[test]
fn a_port_in_use_is_an_error_and_a_dropped_listener_frees_it() {
    let epoch = Instant::now();
    let first = Opentrack::bind("127.0.0.1:0".parse().unwrap(), epoch).unwrap();
    let address = first.address();
    assert!(Opentrack::bind(address, epoch).is_err());
    drop(first);
    assert!(Opentrack::bind(address, epoch).is_ok());
}
