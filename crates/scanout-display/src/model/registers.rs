//! The controller's registers, and where an address lies in its memory.

use super::error::Fault;
use super::{MEMORY_COLUMNS, MEMORY_ROWS};
use crate::window::Window;

/// `MADCTL`: row order.
const MY: u8 = 0x80;
/// `MADCTL`: column order.
const MX: u8 = 0x40;
/// `MADCTL`: rows and columns exchanged.
const MV: u8 = 0x20;
/// `MADCTL`: blue first.
const BGR: u8 = 0x08;

/// Bytes of a pixel, set by `COLMOD`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelSize {
    /// RGB565, two bytes, high byte first.
    Bits16,
    /// RGB666, three bytes, each channel in the top 6 bits: the controller's default.
    Bits18,
}

impl PixelSize {
    /// Bytes of a pixel.
    pub fn bytes(self) -> u8 {
        match self {
            PixelSize::Bits16 => 2,
            PixelSize::Bits18 => 3,
        }
    }
}

/// What the commands have set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Registers {
    /// Out of sleep.
    pub awake: bool,
    /// `DISPON`.
    pub on: bool,
    /// `INVON`.
    pub inverted: bool,
    /// Partial mode's first and last row, where it is on.
    pub partial: Option<[u16; 2]>,
    /// `PTLAR`, used when partial mode is entered.
    pub partial_area: [u16; 2],
    /// `MADCTL`.
    pub madctl: u8,
    /// `COLMOD`.
    pub pixel: PixelSize,
    /// `CASET` and `RASET`.
    pub window: Window,
    /// `VSCRDEF`: rows that stay on top, rows that scroll.
    pub scroll_area: [u16; 2],
    /// `VSCSAD`: the memory row shown first in the scrolling area; none outside of scroll mode.
    pub scroll_start: Option<u16>,
}

impl Registers {
    /// After power-on and after the reset pin was low.
    pub(super) const RESET: Registers = Registers {
        awake: false,
        on: false,
        inverted: false,
        partial: None,
        partial_area: [0, MEMORY_ROWS - 1],
        madctl: 0,
        pixel: PixelSize::Bits18,
        window: Window { columns: [0, MEMORY_COLUMNS - 1], rows: [0, MEMORY_ROWS - 1] },
        scroll_area: [0, MEMORY_ROWS],
        scroll_start: None,
    };

    /// Software reset keeps `MADCTL` and `COLMOD`; the window is the whole memory as `MADCTL` turns it.
    pub(super) fn software_reset(&mut self) {
        let (madctl, pixel) = (self.madctl, self.pixel);
        *self = Registers { madctl, pixel, ..Registers::RESET };
        let (columns, rows) = self.addresses();
        self.window = Window { columns: [0, columns - 1], rows: [0, rows - 1] };
    }

    /// Columns and rows that can be addressed.
    pub fn addresses(&self) -> (u16, u16) {
        if self.madctl & MV != 0 {
            (MEMORY_ROWS, MEMORY_COLUMNS)
        } else {
            (MEMORY_COLUMNS, MEMORY_ROWS)
        }
    }

    /// Whether `MADCTL` says blue first.
    pub fn bgr(&self) -> bool {
        self.madctl & BGR != 0
    }

    /// Index in the memory of address (x, y), which must be within [`addresses`](Self::addresses).
    pub(super) fn index(&self, x: u16, y: u16) -> usize {
        let (mut column, mut row) = if self.madctl & MV != 0 { (y, x) } else { (x, y) };
        if self.madctl & MX != 0 {
            column = MEMORY_COLUMNS - 1 - column;
        }
        if self.madctl & MY != 0 {
            row = MEMORY_ROWS - 1 - row;
        }
        row as usize * MEMORY_COLUMNS as usize + column as usize
    }

    /// Whether the window lies within the addresses; they may have been turned since it was set.
    pub(super) fn check_window(&self) -> Result<(), Fault> {
        let (columns, rows) = self.addresses();
        within(0x2a, self.window.columns, columns)?;
        within(0x2b, self.window.rows, rows)
    }

    /// Takes a command whose parameters are complete.
    pub(super) fn apply(&mut self, command: u8, p: &[u8]) -> Result<(), Fault> {
        let word = |i: usize| u16::from_be_bytes([p[i], p[i + 1]]);
        let (columns, rows) = self.addresses();
        match command {
            0x01 => self.software_reset(),
            0x10 => self.awake = false,
            0x11 => self.awake = true,
            0x12 => (self.partial, self.scroll_start) = (Some(self.partial_area), None),
            // Normal mode ends partial mode and scroll mode.
            0x13 => (self.partial, self.scroll_start) = (None, None),
            0x20 => self.inverted = false,
            0x21 => self.inverted = true,
            0x28 => self.on = false,
            0x29 => self.on = true,
            0x2a => {
                within(command, [word(0), word(2)], columns)?;
                self.window.columns = [word(0), word(2)];
            }
            0x2b => {
                within(command, [word(0), word(2)], rows)?;
                self.window.rows = [word(0), word(2)];
            }
            0x30 => {
                within(command, [word(0), word(2)], MEMORY_ROWS)?;
                self.partial_area = [word(0), word(2)];
                self.partial = self.partial.map(|_| self.partial_area);
            }
            0x33 => {
                let sum = word(0) as u32 + word(2) as u32 + word(4) as u32;
                if sum != MEMORY_ROWS as u32 {
                    let ends = [word(0), word(0).saturating_add(word(2))];
                    return Err(Fault::OutsideMemory { command, ends, count: MEMORY_ROWS });
                }
                self.scroll_area = [word(0), word(2)];
            }
            0x36 => self.madctl = p[0],
            0x37 => {
                within(command, [word(0); 2], MEMORY_ROWS)?;
                self.scroll_start = Some(word(0));
            }
            0x3a => {
                // The upper digit is for the RGB interface, which has no say here.
                self.pixel = match p[0] & 0x8f {
                    0x05 => PixelSize::Bits16,
                    0x06 => PixelSize::Bits18,
                    _ => return Err(Fault::BadParameter { command, value: p[0] }),
                }
            }
            _ => {}
        }
        Ok(())
    }

    /// The memory row that a row of the glass shows; `None` where partial mode leaves it dark.
    pub(super) fn shown(&self, row: u16) -> Option<u16> {
        if self.partial.is_some_and(|[first, last]| !(first..=last).contains(&row)) {
            return None;
        }
        let [top, lines] = self.scroll_area;
        let Some(start) = self.scroll_start.filter(|_| row >= top && row - top < lines) else {
            return Some(row);
        };
        // Scrolling wraps within its own rows.
        let start = start.saturating_sub(top);
        Some(top + (start + (row - top)) % lines)
    }
}

fn within(command: u8, ends: [u16; 2], count: u16) -> Result<(), Fault> {
    if ends[0] > ends[1] {
        Err(Fault::Reversed { command, ends })
    } else if ends[1] >= count {
        Err(Fault::OutsideMemory { command, ends, count })
    } else {
        Ok(())
    }
}
