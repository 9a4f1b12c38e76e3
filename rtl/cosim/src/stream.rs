//! Streams with valid and ready.

use crate::{Model, Port, Random};

/// The ports of a stream: PREFIX_valid, PREFIX_ready and data ports of at most 64 bits.
#[derive(Clone, Debug)]
pub struct Stream {
    /// PREFIX_valid.
    pub valid: Port,
    /// PREFIX_ready.
    pub ready: Port,
    /// PREFIX_NAME for each name, in order.
    pub data: Vec<Port>,
}

impl Stream {
    /// The stream PREFIX of a model, with these data ports.
    ///
    /// # Panics
    /// When a port is missing.
    pub fn new(model: &Model, prefix: &str, data: &[&str]) -> Stream {
        let port = |name: &str| model.port(&format!("{prefix}_{name}"));
        Stream {
            valid: port("valid"),
            ready: port("ready"),
            data: data.iter().map(|name| port(name)).collect(),
        }
    }
}

/// How often each side of a handshake waits, in percent of clocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stalls {
    /// The source offers nothing new.
    pub source: u64,
    /// The sink isn't ready.
    pub sink: u64,
}

impl Stalls {
    /// Neither ever waits.
    pub const NONE: Stalls = Stalls { source: 0, sink: 0 };
}

/// What [`exchange`] saw.
#[derive(Clone, Debug, Default)]
pub struct Exchange {
    /// The words that the sink took: a value for each data port, zero-extended.
    pub received: Vec<Vec<u64>>,
    /// Clocks from the first word that was offered to the last one that was taken.
    pub clocks: u64,
    /// Clocks from the first word that the sink took to the last one, both counted.
    pub output_clocks: u64,
}

/// Offers `words` to `source` and collects `expected` words from `sink`, then watches for `quiet` more clocks that no other
/// comes. A word is a value for each data port.
///
/// # Panics
/// When the module breaks the handshake (takes back or changes a word that is not taken yet), when words are missing after
/// `patience` clocks without any, or when there are more.
pub fn exchange(
    model: &mut Model,
    source: &Stream,
    words: &[Vec<u64>],
    sink: &Stream,
    expected: usize,
    stalls: Stalls,
    random: &mut Random,
) -> Exchange {
    const QUIET: u32 = 64;
    const PATIENCE: u32 = 100_000;
    let mut result = Exchange::default();
    let (mut next, mut offered, mut first) = (0, false, None);
    let mut pending: Option<Vec<u64>> = None;
    let (mut quiet, start) = (0, model.clocks());
    while quiet < QUIET || next < words.len() || result.received.len() < expected {
        if !offered && next < words.len() && !random.percent(stalls.source) {
            offered = true;
            for (&port, &value) in source.data.iter().zip(&words[next]) {
                model.set(port, value);
            }
        }
        let ready = !random.percent(stalls.sink);
        model.set(source.valid, u64::from(offered));
        model.set(sink.ready, u64::from(ready));
        if let Some(clk) = model.find("clk") {
            model.set(clk, 0);
        }
        model.eval();
        let taken = offered && model.get(source.ready) == 1;
        let valid = model.get(sink.valid) == 1;
        let now: Option<Vec<u64>> =
            valid.then(|| sink.data.iter().map(|&p| model.get(p)).collect());
        assert!(pending.is_none() || pending == now, "a word was taken back or changed");
        pending = now.clone().filter(|_| !ready);
        quiet += 1;
        if let Some(word) = now.filter(|_| ready) {
            quiet = 0;
            result.received.push(word);
            let clocks = model.clocks() + 1;
            result.clocks = clocks - start;
            result.output_clocks = clocks - *first.get_or_insert(model.clocks());
            assert!(result.received.len() <= expected, "more words than {expected}");
        }
        model.clock();
        if taken {
            (next, offered, quiet) = (next + 1, false, 0);
        }
        let (got, all) = (result.received.len(), words.len());
        assert!(quiet < PATIENCE, "waiting: {next} of {all} words taken, {got} of {expected} got");
    }
    model.set(source.valid, 0u64);
    result
}
