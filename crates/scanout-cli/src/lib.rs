//! The `scanout` program: renders meshes on the command line, in a window or in the terminal, without a GPU.
//!
//! This crate turns files and options into a [`scanout::scene::Scene`] and the pipeline's pixels into files, terminal
//! pictures and windows. It computes no pixel itself.
//!
//! | module | does |
//! |---|---|
//! | [`args`], [`values`] | the command line, one definition for parser, help, man page and completions |
//! | [`cmd`] | one module a command |
//! | [`scene_builder`] | models and options to a scene; fits the camera |
//! | [`draw`] | drives the pipeline: bands, threads, formats |
//! | [`blank`] | tells why there is nothing to be seen |
//! | [`stereo`] | two eyes to one picture |
//! | [`image_out`], [`animation`], [`compare`] | pictures in files: PNG, PPM, raw, GIF, APNG; differences |
//! | [`terminal`] | pictures in a terminal: kitty, sixel, half blocks, characters |
//! | [`window`] | pictures in a window |
//! | [`progress`] | a bar, on a terminal only |
//!
//! Standard output carries results only; narration goes to standard error. Exit codes: 0 done, 1 failed or pictures
//! differ, 2 command line not understood. A reader that closes our pipe is no error.

pub mod animation;
pub mod args;
pub mod blank;
pub mod cmd;
pub mod compare;
pub mod draw;
pub mod error;
pub mod image_out;
pub mod progress;
pub mod scene_builder;
pub mod stereo;
pub mod terminal;
pub mod values;
pub mod window;

use std::ffi::OsString;
use std::io::Write as _;
use std::process::ExitCode;

use clap::Parser;

use crate::args::{Cli, Command};
use crate::error::{Error, Result};

/// Runs the program with its arguments, the first being its own name.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(error) => return report_usage(&error),
    };
    match dispatch(cli) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            if matches!(error, Error::Usage(_) | Error::Failed(_)) {
                narrate!("scanout: {error}");
            }
            error.exit_code().into()
        }
    }
}

fn dispatch(cli: Cli) -> Result<()> {
    match cli.command.unwrap_or(Command::Demo(args::DemoArgs::standard())) {
        Command::Demo(args) => cmd::demo::run(&args),
        Command::Render(args) => cmd::render::run(&args),
        Command::View(args) => cmd::view::run(&args),
        Command::Window(args) => cmd::window::run(&args),
        Command::Turntable(args) => cmd::turntable::run(&args),
        Command::Info(args) => cmd::info::run(&args),
        Command::Bake(args) => cmd::bake::run(&args),
        Command::Marker(args) => cmd::marker::run(&args),
        Command::Ar(args) => cmd::ar::run(&args),
        Command::Calibrate(args) => cmd::calibrate::run(&args),
        Command::Lines(args) => cmd::lines::run(&args),
        Command::Bench(args) => cmd::bench::run(&args),
        Command::Completions(args) => cmd::completions::run(&args),
        Command::Man => cmd::man::run(),
    }
}

/// Help and version go to standard output with code 0; a wrong line is one line on standard error with code 2.
fn report_usage(error: &clap::Error) -> ExitCode {
    if !error.use_stderr() {
        let printed = error.print().and_then(|()| std::io::stdout().flush());
        return match printed.map_err(|error| Error::stdout(&error)) {
            Ok(()) | Err(Error::BrokenPipe) => ExitCode::SUCCESS, // a closed pipe is the reader's right
            Err(error) => {
                narrate!("scanout: {error}");
                error.exit_code().into()
            }
        };
    }
    let text = error.to_string();
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let mut what = lines.next().unwrap_or_default().trim_start_matches("error: ").to_string();
    let mut remedy = None;
    let mut missing = Vec::new();
    for line in lines {
        if let Some(tip) = line.strip_prefix("tip: ") {
            remedy.get_or_insert(tip.to_string());
        } else if let Some(values) = line.strip_prefix("[possible values: ") {
            remedy.get_or_insert(format!("one of {}", values.trim_end_matches(']')));
        } else if what.ends_with(':') && !line.starts_with("Usage") {
            missing.push(line.to_string());
        }
        if line.starts_with("Usage") {
            break;
        }
    }
    if !missing.is_empty() {
        what = format!("{what} {}", missing.join(", "));
    }
    let remedy =
        remedy.unwrap_or_else(|| "run 'scanout --help' or 'scanout COMMAND --help'".into());
    narrate!("scanout: {what}; {remedy}");
    ExitCode::from(2)
}

/// Writes a line to standard error; a closed standard error is no error.
#[macro_export]
macro_rules! narrate {
    ($($arg:tt)*) => {{
        use std::io::Write as _;
        let _ = writeln!(std::io::stderr(), $($arg)*);
    }};
}
