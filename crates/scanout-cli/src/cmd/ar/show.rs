//! Frames in a window, or in the terminal where there is none.

use std::time::{Duration, Instant};

use scanout_video::Source;

use super::Augmenter;
use crate::args::Terminal;
use crate::args::ar::ArArgs;
use crate::error::{Error, Result};
use crate::image_out::Picture;
use crate::narrate;
use crate::terminal;
use crate::window::{self, Content, Input, NoWindow, Setting};

struct Player {
    augmenter: Augmenter,
    source: Source,
    shown: Picture,
    ended: bool,
    clock: Option<Instant>,
    time: f64,
    title: String,
}

impl Player {
    /// Goes on to the frame that is due; without waiting when the source is live.
    fn advance(&mut self) -> Result<()> {
        let started = *self.clock.get_or_insert_with(Instant::now);
        if !self.source.is_live() && started.elapsed().as_secs_f64() < self.time {
            return Ok(());
        }
        match self.augmenter.next(&mut self.source, &mut None) {
            Some(step) => (self.shown, self.time) = step?,
            None => self.ended = true,
        }
        Ok(())
    }
}

impl Content for Player {
    fn draw(&mut self, width: u16, height: u16, _: f64) -> Result<Picture> {
        if !self.ended {
            self.advance()?;
        }
        Ok(self.shown.stretched(width.into(), height.into()))
    }

    fn input(&mut self, _: Input) {}

    fn moves(&self) -> bool {
        !self.ended
    }

    fn title(&self) -> String {
        self.title.clone()
    }

    fn rate(&mut self, _: f64, _: f64) {}
}

/// Shows the film until it or the window ends.
pub fn run(args: &ArArgs, mut augmenter: Augmenter, mut source: Source) -> Result<()> {
    let Some(first) = augmenter.next(&mut source, &mut None) else {
        return augmenter.summary(&source, None);
    };
    let (shown, time) = first?;
    let side = |n: usize| n.clamp(1, 4096) as u16;
    let size = (side(shown.width), side(shown.height));
    let title = args.marker.to_string();
    let mut player = Player { augmenter, source, shown, ended: false, clock: None, time, title };
    let why = if args.terminal == Terminal::Auto {
        match window::run(&mut player, Setting { size, frames: None }) {
            Ok(outcome) => {
                outcome?;
                return player.augmenter.summary(&player.source, None);
            }
            Err(NoWindow(why)) => Some(why),
        }
    } else {
        None
    };
    if !terminal::will_show(args.terminal) {
        let why = why.unwrap_or_else(|| "the terminal is not to be used".into());
        return Err(Error::failed("window", why, "write frames with -o OUT or poses with --json"));
    }
    if let Some(why) = why {
        narrate!("scanout: no window ({why}), so frames are shown in the terminal");
    }
    in_terminal(args, player)
}

/// A few frames a second: terminals are slow, and a live source mustn't wait.
fn in_terminal(args: &ArArgs, mut player: Player) -> Result<()> {
    let pause = Duration::from_millis(100);
    let mut last: Option<Instant> = None;
    loop {
        if last.is_none_or(|last| last.elapsed() >= pause) {
            terminal::show(&player.shown, args.terminal, 0)?;
            last = Some(Instant::now());
        }
        match player.augmenter.next(&mut player.source, &mut None) {
            Some(step) => player.shown = step?.0,
            None => break,
        }
    }
    terminal::show(&player.shown, args.terminal, 0)?;
    player.augmenter.summary(&player.source, None)
}
