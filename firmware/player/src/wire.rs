//! A display's wires over a serial line. Emulators have no ST7789, so an emulated board's SPI bytes and the level of D/C
//! leave through a UART, and the PC decodes them with the display model.
//!
//! A record is a head of two bytes and its bytes:
//!
//! | bit of the head, big-endian | meaning |
//! |---|---|
//! | 15 | level of D/C |
//! | 14 | the frame is finished; no bytes follow |
//! | 13 - 0 | number of bytes, 1 - 16383 |

/// Most bytes in a record.
pub const MOST: usize = 0x3fff;
/// The head of the record that ends a frame.
pub const END: [u8; 2] = [0x40, 0];

/// The head of a record of `length` bytes, 1 to [`MOST`].
pub fn head(data: bool, length: usize) -> [u8; 2] {
    (u16::from(data) << 15 | (length & MOST) as u16).to_be_bytes()
}

/// Cuts bytes into records and hands their heads and bytes to `send`.
///
/// # Errors
/// What `send` says.
pub fn records<E>(
    data: bool,
    bytes: &[u8],
    mut send: impl FnMut(&[u8]) -> Result<(), E>,
) -> Result<(), E> {
    for piece in bytes.chunks(MOST) {
        send(&head(data, piece.len()))?;
        send(piece)?;
    }
    Ok(())
}

/// The other end: bytes of the serial line, in any pieces, to a display model.
#[cfg(feature = "std")]
#[derive(Debug)]
pub struct Decoder {
    /// The display.
    pub model: scanout_display::model::DisplayModel,
    head: Option<u8>,
    data: bool,
    left: usize,
}

#[cfg(feature = "std")]
impl Decoder {
    /// A decoder before the first byte, over a display just powered on.
    pub fn new(model: scanout_display::model::DisplayModel) -> Self {
        Decoder { model, head: None, data: false, left: 0 }
    }

    /// Takes a byte; true when it ended a frame.
    ///
    /// # Errors
    /// What the display makes nonsense of.
    pub fn feed(&mut self, byte: u8) -> Result<bool, scanout_display::model::ModelError> {
        if self.left > 0 {
            self.left -= 1;
            return self.model.feed(byte, self.data).map(|()| false);
        }
        let Some(high) = self.head.take() else {
            self.head = Some(byte);
            return Ok(false);
        };
        let head = u16::from_be_bytes([high, byte]);
        self.data = head & 0x8000 != 0;
        self.left = usize::from(head) & MOST;
        Ok(head & 0x4000 != 0)
    }
}

#[cfg(all(test, feature = "std"))]
mod tests {
    use super::*;
    use scanout_display::model::{DisplayModel, Glass};

    #[test]
    fn records_come_apart_as_they_were() {
        let mut line = std::vec::Vec::new();
        let mut send = |bytes: &[u8]| -> Result<(), ()> {
            line.extend_from_slice(bytes);
            Ok(())
        };
        records(false, &[0x11], &mut send).unwrap();
        records(false, &[0x2c], &mut send).unwrap();
        records(true, &[0; 40_000], &mut send).unwrap();
        send(&END).unwrap();
        let mut decoder = Decoder::new(DisplayModel::new(Glass::default()));
        let ends: usize = line.iter().map(|&b| usize::from(decoder.feed(b).unwrap())).sum();
        assert_eq!(ends, 1);
        assert_eq!(
            (decoder.model.counts().commands, decoder.model.counts().pixel_bytes),
            (2, 40_000)
        );
        assert_eq!(line.len(), 3 + 3 + 40_000 + 3 * 2 + 2);
    }
}
