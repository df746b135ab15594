//! The program: the sub-commands of [`dvp_cli`] and, with the feature `lab`, those of the laboratory.

use std::ffi::OsString;
use std::io::Write;

use clap::{Parser, Subcommand};

/// Turns pictures into the flat objects they are made of, and back.
#[derive(Debug, Parser)]
#[command(name = "dvp", version, before_help = "Example: dvp fit picture.png --out out")]
#[cfg_attr(
    not(feature = "lab"),
    command(after_help = "Built without the laboratory (chart, gradients, parsimony, stability): --features lab")
)]
struct Program {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    #[command(flatten)]
    Own(Box<dvp_cli::command::Command>),
    #[cfg(feature = "lab")]
    #[command(flatten)]
    Lab(Box<dvp_lab::command::Command>),
}

/// Runs the command with the arguments `args` (the program's name first) and returns its exit code: 0 if all was done, 1 if
/// something failed (everything else was done all the same), 2 for wrong usage. Results go to `out`, complaints to `err`.
pub fn run(args: impl IntoIterator<Item = OsString>, out: &mut (dyn Write + Send), err: &mut (dyn Write + Send)) -> u8 {
    dvp_cli::command::run(args, out, err, |program: &Program, console| match &program.command {
        Command::Own(command) => command.run(console),
        #[cfg(feature = "lab")]
        Command::Lab(command) => command.run(console),
    })
}
