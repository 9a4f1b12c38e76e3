//! Asking the terminal, over /dev/tty in raw mode, with a timeout.
//!
//! | question | answer that means yes |
//! |---|---|
//! | kitty graphics: `ESC _ G i=31,s=1,v=1,a=q,t=d,f=24;AAAA ESC \` | `ESC _ G i=31;OK ESC \` |
//! | set a 24-bit background, then DECRQSS: `ESC P $ q m ESC \` | `ESC P 1 $ r ... 48:2: ... ESC \` |
//! | DA1: `ESC [ c`, which every terminal answers, so it goes last | `ESC [ ? ... ;4; ... c` is sixel |

use super::Abilities;

/// Finds the answers in what the terminal sent back.
#[cfg_attr(not(any(unix, test)), expect(dead_code))]
fn parse(reply: &[u8]) -> Abilities {
    let reply = String::from_utf8_lossy(reply);
    let da1 = device_attributes(&reply);
    let colours = reply.split("\x1bP1$r").nth(1).and_then(|rest| rest.split('\x1b').next());
    Abilities {
        answers: da1.is_some() || colours.is_some(),
        kitty: reply.contains("\x1b_Gi=31;OK"),
        sixel: da1.is_some_and(|list| list.split(';').any(|attribute| attribute == "4")),
        colour24: colours.is_some_and(|sgr| sgr.contains("48:2:") || sgr.contains("48;2;")),
        ..Abilities::UNKNOWN
    }
}

/// The list inside `ESC [ ? list c`.
fn device_attributes(reply: &str) -> Option<&str> {
    reply.split("\x1b[?").skip(1).find_map(|rest| {
        let end = rest.find(|c: char| !c.is_ascii_digit() && c != ';')?;
        rest[end..].starts_with('c').then_some(&rest[..end])
    })
}

/// Asks the controlling terminal, or when not `aloud` only the system for its size. Where there is none, or no answer in time,
/// the abilities are those of a plain stream.
#[cfg(unix)]
pub fn ask(aloud: bool) -> Abilities {
    let reply = if aloud { unix::converse() } else { None };
    let asked = reply.map_or(Abilities::UNKNOWN, |reply| parse(&reply));
    let (cells, cell) = unix::size().unwrap_or((asked.cells, asked.cell));
    Abilities { cells, cell, ..asked }
}

/// Where terminals can't be asked this way (Windows), text with 24-bit colours is supposed.
#[cfg(not(unix))]
pub fn ask(aloud: bool) -> Abilities {
    Abilities { answers: aloud, colour24: aloud, ..Abilities::UNKNOWN }
}

#[cfg(unix)]
mod unix {
    use std::fs::{File, OpenOptions};
    use std::io::{Read, Write};
    use std::time::{Duration, Instant};

    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    use rustix::termios::{OptionalActions, Termios, tcgetattr, tcgetwinsize, tcsetattr};

    /// Long enough for a slow ssh connection; a terminal in the same machine answers within a millisecond.
    const TIMEOUT: Duration = Duration::from_millis(1000);

    const QUESTIONS: &[u8] = b"\x1b_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\x1b\\\
        \x1b[48:2:1:2:3m\x1bP$qm\x1b\\\x1b[0m\
        \x1b[c";

    /// Puts the terminal's mode back.
    struct Raw<'a>(&'a File, Termios);

    impl Drop for Raw<'_> {
        fn drop(&mut self) {
            let _ = tcsetattr(self.0, OptionalActions::Flush, &self.1);
        }
    }

    /// Sends the questions and reads until DA1's answer or the timeout.
    pub fn converse() -> Option<Vec<u8>> {
        let tty = OpenOptions::new().read(true).write(true).open("/dev/tty").ok()?;
        let before = tcgetattr(&tty).ok()?;
        let mut raw = before.clone();
        raw.make_raw();
        tcsetattr(&tty, OptionalActions::Flush, &raw).ok()?;
        let _guard = Raw(&tty, before);
        (&tty).write_all(QUESTIONS).ok()?;
        let reply = read_answers(&tty);
        // Whatever a terminal that doesn't know the questions has printed goes away.
        (&tty).write_all(b"\r\x1b[K").ok()?;
        Some(reply)
    }

    fn read_answers(mut tty: &File) -> Vec<u8> {
        let end = Instant::now() + TIMEOUT;
        let mut reply = Vec::new();
        loop {
            let left = end.saturating_duration_since(Instant::now());
            let Ok(timeout) = Timespec::try_from(left) else { break };
            let mut fds = [PollFd::new(&tty, PollFlags::IN)];
            if !matches!(poll(&mut fds, Some(&timeout)), Ok(1..)) {
                break;
            }
            let mut chunk = [0; 256];
            match tty.read(&mut chunk) {
                Ok(count @ 1..) => reply.extend_from_slice(&chunk[..count]),
                _ => break,
            }
            let text = String::from_utf8_lossy(&reply);
            if super::device_attributes(&text).is_some() || reply.len() > 4096 {
                break;
            }
        }
        reply
    }

    /// Size in characters, and of a character in pixels.
    pub fn size() -> Option<((usize, usize), (usize, usize))> {
        let size = tcgetwinsize(std::io::stdout()).ok()?;
        let [columns, rows] = [size.ws_col, size.ws_row].map(usize::from);
        if columns == 0 || rows == 0 {
            return None;
        }
        let cell = match [size.ws_xpixel, size.ws_ypixel].map(usize::from) {
            [x, y] if x >= columns && y >= rows => (x / columns, y / rows),
            _ => super::Abilities::UNKNOWN.cell,
        };
        Some(((columns, rows), cell))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kitty_with_colours() {
        let reply = b"\x1b_Gi=31;OK\x1b\\\x1bP1$r0;48:2:1:2:3m\x1b\\\x1b[?62;c";
        let got = parse(reply);
        assert!(got.kitty && got.colour24 && got.answers && !got.sixel);
    }

    #[test]
    fn sixel_is_attribute_4_and_not_14_or_42() {
        assert!(parse(b"\x1b[?62;4;22c").sixel);
        assert!(parse(b"\x1b[?4c").sixel);
        assert!(!parse(b"\x1b[?62;14;42c").sixel);
        assert!(!parse(b"\x1b[?1;2").answers, "cut short");
    }

    #[test]
    fn a_refusal_and_typed_keys_are_no_yes() {
        let got = parse(b"ls\x1b_Gi=31;ENOTSUPPORTED\x1b\\\x1bP0$r\x1b\\\x1b[?6c");
        assert!(got.answers && !got.kitty && !got.colour24 && !got.sixel);
    }
}
