//! The `scanout` program. Everything it does is in the library beside it.

use std::process::ExitCode;

fn main() -> ExitCode {
    scanout_cli::run(std::env::args_os())
}
