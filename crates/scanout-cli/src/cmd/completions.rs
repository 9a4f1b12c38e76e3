//! `scanout completions SHELL`: from the same definition as the parser.

use std::io::{self, Write};

use clap::CommandFactory;

use crate::args::{Cli, CompletionsArgs};
use crate::error::{Error, Result};

/// Writes a shell's completions to standard output.
pub fn run(args: &CompletionsArgs) -> Result<()> {
    // Into memory first: the generator panics when its sink fails.
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "scanout", &mut text);
    let mut out = io::stdout().lock();
    out.write_all(&text).and_then(|()| out.flush()).map_err(|error| Error::stdout(&error))
}
