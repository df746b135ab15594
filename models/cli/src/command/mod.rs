//! The sub-commands: arguments, threads, tables.
//!
//! Results go to the first stream (standard output), complaints and progress to the second (standard error). Exit codes:
//! 0 if all was done, 1 if something failed (everything else was done all the same), 2 for wrong usage.

#[cfg(feature = "lab")]
mod chart;
mod drawing;
mod evaluate;
mod fit;
mod generate;
mod generated;
#[cfg(feature = "lab")]
mod gradients;
#[cfg(feature = "lab")]
mod html;
mod options;
#[cfg(feature = "lab")]
mod parsimony;
#[cfg(feature = "lab")]
mod pictures;
mod progress;
mod prototypes;
mod refine;
mod render;
#[cfg(feature = "lab")]
mod stability;
mod train;

use std::ffi::OsString;
use std::io::Write;

use anyhow::Result;
use clap::{Parser, Subcommand};

/// Where a command writes.
struct Console<'a> {
    out: &'a mut (dyn Write + Send),
    err: &'a mut (dyn Write + Send),
}

/// What a command came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    /// All was done.
    Done,
    /// Some inputs failed; each was reported.
    Partly,
}

/// Turns pictures into the flat objects they are made of, and back.
#[derive(Debug, Parser)]
#[command(name = "dvp", version, before_help = "Example: dvp fit picture.png --out out")]
#[cfg_attr(
    not(feature = "lab"),
    command(after_help = "Built without the laboratory (chart, gradients, parsimony, stability): --features lab")
)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Generate(generate::Arguments),
    Render(render::Arguments),
    Fit(fit::Arguments),
    Refine(refine::Arguments),
    Prototypes(prototypes::Arguments),
    Train(train::Arguments),
    Evaluate(evaluate::Arguments),
    #[cfg(feature = "lab")]
    Gradients(gradients::Arguments),
    #[cfg(feature = "lab")]
    Stability(stability::Arguments),
    #[cfg(feature = "lab")]
    Chart(chart::Arguments),
    #[cfg(feature = "lab")]
    Parsimony(parsimony::Arguments),
}

/// Runs the command with the arguments `args` (the program's name first) and returns its exit code.
pub fn run(args: impl IntoIterator<Item = OsString>, out: &mut (dyn Write + Send), err: &mut (dyn Write + Send)) -> u8 {
    let cli = match Cli::try_parse_from(args) {
        Ok(cli) => cli,
        Err(error) => {
            // Help and version come as "errors" too, for standard output and with code 0.
            let stream: &mut (dyn Write + Send) = if error.use_stderr() { err } else { out };
            let _ = write!(stream, "{}", error.render());
            return u8::from(error.use_stderr()) * 2;
        }
    };
    let mut console = Console { out, err };
    match dispatch(cli.command, &mut console) {
        Ok(Outcome::Done) => 0,
        Ok(Outcome::Partly) => 1,
        Err(error) => {
            // Nobody is left to tell if this fails.
            let _ = writeln!(console.err, "error: {}", in_words(&error));
            1
        }
    }
}

/// An error and its causes as one line of text, the outermost first. Causes that the text tells already are left out: many errors
/// say in their own sentence what caused them.
fn in_words(error: &anyhow::Error) -> String {
    error.chain().map(ToString::to_string).fold(String::new(), |text, cause| match text.as_str() {
        "" => cause,
        told if told.contains(&cause) => text,
        _ => format!("{text}: {cause}"),
    })
}

fn dispatch(command: Command, console: &mut Console<'_>) -> Result<Outcome> {
    match command {
        Command::Generate(arguments) => generate::run(&arguments, console),
        Command::Render(arguments) => render::run(&arguments, console),
        Command::Fit(arguments) => fit::run(&arguments, console),
        Command::Refine(arguments) => refine::run(&arguments, console),
        Command::Prototypes(arguments) => prototypes::run(&arguments, console),
        Command::Train(arguments) => train::run(&arguments, console),
        Command::Evaluate(arguments) => evaluate::run(&arguments, console),
        #[cfg(feature = "lab")]
        Command::Gradients(arguments) => gradients::run(&arguments, console),
        #[cfg(feature = "lab")]
        Command::Stability(arguments) => stability::run(&arguments, console),
        #[cfg(feature = "lab")]
        Command::Chart(arguments) => chart::run(&arguments, console),
        #[cfg(feature = "lab")]
        Command::Parsimony(arguments) => parsimony::run(&arguments, console),
    }
}
