//! opentrack's "UDP over network" output: any tracker that opentrack knows, on this or another machine.
//!
//! ```text
//!  48 bytes: x y z in cm, yaw pitch roll in degrees, six little-endian f64          port 4242
//! ```
//!
//! A thread reads to the newest packet, so that nothing old waits in a queue however seldom it is asked for. Packets of another
//! size, with a number that isn't finite, or a place beyond [`FARTHEST`] are counted and dropped; the angles are not used. A
//! packet can do no more than move the eye.

use std::io;
use std::net::{SocketAddr, UdpSocket};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use crate::V3;
use crate::source::{Sample, Source};

/// The port that opentrack sends to unless told otherwise.
pub const PORT: u16 = 4242;

/// Bytes of a packet.
pub const BYTES: usize = 48;

/// The farthest place that is believed, mm along each axis.
pub const FARTHEST: f64 = 10_000.0;

/// How often the thread looks whether it should end.
const PATIENCE: Duration = Duration::from_millis(100);

/// The place in a packet, mm; `None` when the packet is not to be believed.
pub fn decode(packet: &[u8]) -> Option<V3> {
    let packet: &[u8; BYTES] = packet.try_into().ok()?;
    let mut numbers = [0.0; 6];
    for (number, bytes) in numbers.iter_mut().zip(packet.chunks_exact(8)) {
        *number = f64::from_le_bytes(bytes.try_into().ok()?);
    }
    let [x, y, z, ..] = numbers;
    let place = [x, y, z].map(|cm| cm * 10.0);
    let believed = numbers.iter().all(|n| n.is_finite())
        && place.iter().all(|mm| (-FARTHEST..=FARTHEST).contains(mm));
    believed.then_some(place)
}

/// A packet with this place, mm, and no angles: the inverse of [`decode`].
pub fn encode(place: V3) -> [u8; BYTES] {
    let mut packet = [0; BYTES];
    for (bytes, mm) in packet.chunks_exact_mut(8).zip(place) {
        bytes.copy_from_slice(&(mm / 10.0).to_le_bytes());
    }
    packet
}

/// What has arrived so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Packets believed.
    pub good: u64,
    /// Packets dropped.
    pub dropped: u64,
}

#[derive(Default)]
struct Shared {
    newest: Mutex<Option<(Instant, V3)>>,
    good: AtomicU64,
    dropped: AtomicU64,
    ends: AtomicBool,
}

/// A listener.
pub struct Opentrack {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
    address: SocketAddr,
    epoch: Instant,
    /// Packets dropped when the user was last told.
    told: u64,
}

impl Opentrack {
    /// Listens on `address`; the samples' times count from `epoch`.
    ///
    /// # Errors
    /// The address can't be listened on.
    pub fn bind(address: SocketAddr, epoch: Instant) -> io::Result<Self> {
        let socket = UdpSocket::bind(address)?;
        socket.set_read_timeout(Some(PATIENCE))?;
        let address = socket.local_addr()?;
        let shared = Arc::new(Shared::default());
        let thread = std::thread::Builder::new().name("opentrack".into()).spawn({
            let shared = shared.clone();
            move || listen(&socket, &shared)
        })?;
        Ok(Self { shared, thread: Some(thread), address, epoch, told: 0 })
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// What has arrived so far.
    pub fn counts(&self) -> Counts {
        Counts { good: self.shared.good.load(Relaxed), dropped: self.shared.dropped.load(Relaxed) }
    }
}

fn listen(socket: &UdpSocket, shared: &Shared) {
    // One byte more than a packet, so that a longer one is known by its length.
    let mut packet = [0; BYTES + 1];
    while !shared.ends.load(Relaxed) {
        match socket.recv(&mut packet) {
            Ok(length) => match decode(&packet[..length]) {
                Some(place) => {
                    shared.good.fetch_add(1, Relaxed);
                    *shared.newest.lock().unwrap_or_else(PoisonError::into_inner) =
                        Some((Instant::now(), place));
                }
                None => {
                    shared.dropped.fetch_add(1, Relaxed);
                }
            },
            Err(error) => match error.kind() {
                io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut => {}
                // Windows: a packet longer than the buffer, or an answer to a packet that nobody took.
                _ => {
                    shared.dropped.fetch_add(1, Relaxed);
                    // A socket that fails for good must not take the whole processor.
                    std::thread::sleep(Duration::from_micros(100));
                }
            },
        }
    }
}

impl Source for Opentrack {
    fn poll(&mut self, _now: f64) -> Option<Sample> {
        let newest = self.shared.newest.lock().unwrap_or_else(PoisonError::into_inner).take();
        newest.map(|(at, place)| Sample {
            time: at.saturating_duration_since(self.epoch).as_secs_f64(),
            eye: Some(place),
        })
    }

    fn silence_is_loss(&self) -> bool {
        true
    }

    fn notice(&mut self) -> Option<String> {
        let Counts { good, dropped } = self.counts();
        if self.told > 0 || dropped < 100 || good > dropped {
            return None;
        }
        self.told = dropped;
        Some(format!(
            "{dropped} packets on {} are not opentrack's 48 bytes and were dropped; choose 'UDP over network' as \
             opentrack's output",
            self.address
        ))
    }
}

impl Drop for Opentrack {
    fn drop(&mut self) {
        self.shared.ends.store(true, Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join(); // a listener that panicked has nothing more to say
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_format() {
        let mut packet = Vec::new();
        for number in [1.5f64, -2.0, 60.0, 10.0, 20.0, 30.0] {
            packet.extend(number.to_le_bytes());
        }
        assert_eq!(decode(&packet), Some([15.0, -20.0, 600.0]));
        assert_eq!(decode(&packet[..47]), None);
        packet.push(0);
        assert_eq!(decode(&packet), None);
        assert_eq!(decode(&encode([1.0, 2.0, -3.0])), Some([1.0, 2.0, -3.0]));
    }

    #[test]
    fn nonsense_is_dropped_wherever_it_stands() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for slot in 0..6 {
                let mut packet = encode([0.0; 3]);
                packet[slot * 8..][..8].copy_from_slice(&bad.to_le_bytes());
                assert_eq!(decode(&packet), None, "{bad} at {slot}");
            }
        }
        assert_eq!(decode(&encode([0.0, 1e9, 0.0])), None);
        assert!(decode(&encode([0.0, FARTHEST, 0.0])).is_some());
        assert_eq!(decode(&[]), None);
    }
}
