//! `scanout man`: one page for the program and all its commands, from the same definition as the parser.

use std::io::{self, Write};

use clap::CommandFactory;
use clap_mangen::Man;

use crate::args::Cli;
use crate::error::{Error, Result};

/// Writes the man page to standard output.
pub fn run() -> Result<()> {
    let page = page().map_err(|error| Error::stdout(&error))?;
    let mut out = io::stdout().lock();
    out.write_all(&page).and_then(|()| out.flush()).map_err(|error| Error::stdout(&error))
}

fn page() -> io::Result<Vec<u8>> {
    let mut command = Cli::command();
    command.build();
    let man = Man::new(command.clone());
    let mut page = Vec::new();
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    for sub in command.get_subcommands().filter(|sub| sub.get_name() != "help") {
        let name = sub.get_name().to_uppercase();
        writeln!(page, ".SH \"SCANOUT {name}\"")?;
        let about = sub.get_about().map(ToString::to_string).unwrap_or_default();
        writeln!(page, "{about}.\n.PP")?;
        // Each command's options as a section of its own, the headings one level down.
        let mut options = Vec::new();
        Man::new(sub.clone()).render_synopsis_section(&mut options)?;
        Man::new(sub.clone()).render_options_section(&mut options)?;
        let text = String::from_utf8_lossy(&options).replace(".SH ", ".SS ");
        page.extend_from_slice(text.as_bytes());
    }
    man.render_extra_section(&mut page)?;
    man.render_version_section(&mut page)?;
    Ok(page)
}
