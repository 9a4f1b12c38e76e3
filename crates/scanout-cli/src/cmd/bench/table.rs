//! The answers of `scanout bench`: a table that grows case by case, or JSON at the end.

use std::io::{self, Write as _};

use serde_json::{Value, json};

use super::Measured;
use super::cases::Case;
use crate::error::{Error, Result};

/// The table so far.
pub struct Table {
    json: bool,
    cases: Vec<Value>,
    /// Width of the column of names.
    width: usize,
    begun: bool,
}

impl Table {
    /// A table that is printed as it grows, or JSON.
    pub fn new(json: bool, cases: &[Case]) -> Self {
        let width = cases.iter().map(|case| case.name.len()).max().unwrap_or(0);
        Self { json, cases: Vec::new(), width, begun: false }
    }

    /// Adds a case.
    pub fn add(&mut self, case: &Case, hash: u64, measured: &[Measured]) -> Result<()> {
        if self.json {
            self.cases.extend(measured.iter().map(|m| object(case, hash, m)));
            return Ok(());
        }
        let mut text = String::new();
        if !std::mem::replace(&mut self.begun, true) {
            let head =
                ["case", "threads", "min ms", "median ms", "frames/s", "Mpixel/s", "speed-up"];
            text = line(self.width, head.map(String::from), "hash");
        }
        for (index, m) in measured.iter().enumerate() {
            let (minimum, median) = (m.minimum().as_secs_f64(), m.median().as_secs_f64());
            let columns = [
                if index == 0 { case.name.clone() } else { String::new() },
                m.threads.to_string(),
                format!("{:.3}", minimum * 1e3),
                format!("{:.3}", median * 1e3),
                format!("{:.0}", 1.0 / minimum),
                format!("{:.1}", case.pixels() as f64 / minimum / 1e6),
                if index == 0 { String::new() } else { format!("{:.2}", m.speed_up) },
            ];
            let verdict = match case.expected() {
                Some(expected) if expected == hash => " same",
                Some(_) => " DIFFERS",
                None => "",
            };
            text.push_str(&line(self.width, columns, &format!("{hash:016x}{verdict}")));
        }
        print(&text)
    }

    /// Prints what has not been printed yet.
    pub fn finish(self) -> Result<()> {
        if !self.json {
            return Ok(());
        }
        let answer = json!({
            "scanout": env!("CARGO_PKG_VERSION"),
            "machine": format!("{} {}", std::env::consts::ARCH, std::env::consts::OS),
            "processors": crate::draw::processors(),
            "optimised": !cfg!(debug_assertions),
            "cases": self.cases,
        });
        print(&format!("{answer:#}\n"))
    }
}

fn object(case: &Case, hash: u64, measured: &Measured) -> Value {
    let micros = |time: std::time::Duration| (time.as_nanos() as f64 / 1e3 * 10.0).round() / 10.0;
    let rate = 1.0 / measured.minimum().as_secs_f64();
    json!({
        "case": case.name,
        "threads": measured.threads,
        "runs": measured.times.len(),
        "minimum_us": micros(measured.minimum()),
        "median_us": micros(measured.median()),
        "frames_per_second": rate.round(),
        "pixels": case.pixels(),
        "pixels_per_second": (case.pixels() as f64 * rate).round(),
        "speed_up": (measured.speed_up * 1e3).round() / 1e3,
        "hash": format!("{hash:016x}"),
        "same": case.expected().map(|expected| expected == hash),
    })
}

fn line(width: usize, [name, threads, numbers @ ..]: [String; 7], hash: &str) -> String {
    let numbers = numbers.map(|number| format!("{number:>10}")).concat();
    format!("{name:<width$}{threads:>9}{numbers}  {hash}\n")
}

fn print(text: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(|error| Error::stdout(&error))
}
