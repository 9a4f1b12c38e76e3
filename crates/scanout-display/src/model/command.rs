//! The controller's commands: code, name, how many parameters.
//!
//! After the command lists of the ST7789V data sheet (Sitronix, version 1.3), tables 1 and 2 of section 9.

use core::fmt;

/// What follows a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Takes {
    /// From so many to so many parameter bytes.
    Parameters(u8, u8),
    /// Pixels until the next command.
    Pixels,
    /// The controller answers; bytes on the way to it mean nothing.
    Answer,
}

/// A command.
#[derive(Clone, Copy, Debug)]
pub(super) struct Command {
    pub code: u8,
    name: &'static str,
    pub takes: Takes,
}

const fn p(code: u8, name: &'static str, count: u8) -> Command {
    Command { code, name, takes: Takes::Parameters(count, count) }
}

const fn answer(code: u8, name: &'static str) -> Command {
    Command { code, name, takes: Takes::Answer }
}

const fn pixels(code: u8, name: &'static str) -> Command {
    Command { code, name, takes: Takes::Pixels }
}

#[rustfmt::skip] // a table
const COMMANDS: &[Command] = &[
    p(0x00, "NOP", 0), p(0x01, "SWRESET", 0),
    answer(0x04, "RDDID"), answer(0x09, "RDDST"), answer(0x0a, "RDDPM"), answer(0x0b, "RDDMADCTL"),
    answer(0x0c, "RDDCOLMOD"), answer(0x0d, "RDDIM"), answer(0x0e, "RDDSM"), answer(0x0f, "RDDSDR"),
    p(0x10, "SLPIN", 0), p(0x11, "SLPOUT", 0), p(0x12, "PTLON", 0), p(0x13, "NORON", 0),
    p(0x20, "INVOFF", 0), p(0x21, "INVON", 0), p(0x26, "GAMSET", 1),
    p(0x28, "DISPOFF", 0), p(0x29, "DISPON", 0),
    p(0x2a, "CASET", 4), p(0x2b, "RASET", 4), pixels(0x2c, "RAMWR"), answer(0x2e, "RAMRD"),
    p(0x30, "PTLAR", 4), p(0x33, "VSCRDEF", 6), p(0x34, "TEOFF", 0), p(0x35, "TEON", 1),
    p(0x36, "MADCTL", 1), p(0x37, "VSCSAD", 2), p(0x38, "IDMOFF", 0), p(0x39, "IDMON", 0),
    p(0x3a, "COLMOD", 1), pixels(0x3c, "RAMWRC"), answer(0x3e, "RAMRDC"),
    p(0x44, "STE", 2), answer(0x45, "GSCAN"),
    p(0x51, "WRDISBV", 1), answer(0x52, "RDDISBV"), p(0x53, "WRCTRLD", 1), answer(0x54, "RDCTRLD"),
    p(0x55, "WRCACE", 1), answer(0x56, "RDCABC"), p(0x5e, "WRCABCMB", 1), answer(0x5f, "RDCABCMB"),
    answer(0x68, "RDABCSDR"), answer(0xda, "RDID1"), answer(0xdb, "RDID2"), answer(0xdc, "RDID3"),
    p(0xb0, "RAMCTRL", 2), p(0xb1, "RGBCTRL", 3), p(0xb2, "PORCTRL", 5), p(0xb3, "FRCTRL1", 3),
    p(0xb5, "PARCTRL", 1), p(0xb7, "GCTRL", 1), p(0xb8, "GTADJ", 4), p(0xba, "DGMEN", 1),
    p(0xbb, "VCOMS", 1), p(0xbc, "POWSAVE", 1), p(0xbd, "DLPOFFSAVE", 1),
    p(0xc0, "LCMCTRL", 1), p(0xc1, "IDSET", 3),
    // Two in the data sheet; the second is fixed, and many drivers leave it out.
    Command { code: 0xc2, name: "VDVVRHEN", takes: Takes::Parameters(1, 2) },
    p(0xc3, "VRHS", 1), p(0xc4, "VDVS", 1), p(0xc5, "VCMOFSET", 1), p(0xc6, "FRCTRL2", 1),
    p(0xc7, "CABCCTRL", 1), p(0xc8, "REGSEL1", 1), p(0xca, "REGSEL2", 1), p(0xcc, "PWMFRSEL", 1),
    p(0xd0, "PWCTRL1", 2), p(0xd2, "VAPVANEN", 1), p(0xdf, "CMD2EN", 4),
    p(0xe0, "PVGAMCTRL", 14), p(0xe1, "NVGAMCTRL", 14), p(0xe2, "DGMLUTR", 64), p(0xe3, "DGMLUTB", 64),
    p(0xe4, "GATECTRL", 3), p(0xe7, "SPI2EN", 1), p(0xe8, "PWCTRL2", 1), p(0xe9, "EQCTRL", 3),
    p(0xec, "PROMCTRL", 1), p(0xfa, "PROMEN", 4), p(0xfc, "NVMSET", 2), p(0xfe, "PROMACT", 2),
];

/// The command of a code.
pub(super) fn find(code: u8) -> Option<Command> {
    COMMANDS.iter().copied().find(|command| command.code == code)
}

/// Name and code, for messages.
pub(super) fn name(code: u8) -> impl fmt::Display {
    struct Name(u8);
    impl fmt::Display for Name {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            let name = find(self.0).map_or("command", |command| command.name);
            write!(f, "{name} ({:02X}h)", self.0)
        }
    }
    Name(code)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_unique() {
        let mut seen = [false; 256];
        for command in COMMANDS {
            assert!(!core::mem::replace(&mut seen[command.code as usize], true), "{command:?}");
        }
    }
}
