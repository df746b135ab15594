//! The sub-commands: arguments, threads, tables.
//!
//! In: the words of a command line. Out: files, tables, an exit code. [`Command`] holds the sub-commands of this crate; a program
//! that has more of them (`dvp` with its laboratory) puts its own beside them and hands both to [`run`].
//!
//! Results go to the first stream (standard output), complaints and progress to the second (standard error). Exit codes:
//! 0 if all was done, 1 if something failed (everything else was done all the same), 2 for wrong usage.
//!
//! Proved by `tests/command`, which runs the program.

mod decompose;
mod drawing;
mod evaluate;
mod fit;
mod generate;
pub mod generated;
pub mod options;
pub mod progress;
mod prototypes;
mod refine;
mod render;
mod sheet;
mod train;

use std::ffi::OsString;
use std::io::Write;

use anyhow::Result;
use clap::{Parser, Subcommand};

/// Where a command writes.
#[expect(missing_debug_implementations, reason = "streams have none")]
pub struct Console<'a> {
    /// Results: standard output.
    pub out: &'a mut (dyn Write + Send),
    /// Complaints: standard error.
    pub err: &'a mut (dyn Write + Send),
}

/// What a command came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All was done.
    Done,
    /// Some inputs failed; each was reported.
    Partly,
}

/// A sub-command with its arguments.
#[derive(Debug, Subcommand)]
#[expect(missing_docs, reason = "each has the text of its arguments, which is its help")]
#[non_exhaustive]
pub enum Command {
    Generate(generate::Arguments),
    Render(render::Arguments),
    Fit(fit::Arguments),
    Refine(refine::Arguments),
    Prototypes(prototypes::Arguments),
    Train(train::Arguments),
    Evaluate(evaluate::Arguments),
    Decompose(decompose::Arguments),
}

impl Command {
    /// Does it.
    ///
    /// # Errors
    /// What kept the command from its work. Failures of single inputs are none: they are reported, and the outcome says so.
    pub fn run(&self, console: &mut Console<'_>) -> Result<Outcome> {
        match self {
            Self::Generate(arguments) => generate::run(arguments, console),
            Self::Render(arguments) => render::run(arguments, console),
            Self::Fit(arguments) => fit::run(arguments, console),
            Self::Refine(arguments) => refine::run(arguments, console),
            Self::Prototypes(arguments) => prototypes::run(arguments, console),
            Self::Train(arguments) => train::run(arguments, console),
            Self::Evaluate(arguments) => evaluate::run(arguments, console),
            Self::Decompose(arguments) => decompose::run(arguments, console),
        }
    }
}

/// Reads the arguments `args` (the program's name first) as `P`, does with them what `work` says, and returns the exit code.
pub fn run<P: Parser>(
    args: impl IntoIterator<Item = OsString>,
    out: &mut (dyn Write + Send),
    err: &mut (dyn Write + Send),
    work: impl FnOnce(&P, &mut Console<'_>) -> Result<Outcome>,
) -> u8 {
    let program = match P::try_parse_from(args) {
        Ok(program) => program,
        Err(error) => {
            // Help and version come as "errors" too, for standard output and with code 0.
            let stream: &mut (dyn Write + Send) = if error.use_stderr() { err } else { out };
            let _ = write!(stream, "{}", error.render());
            return u8::from(error.use_stderr()) * 2;
        }
    };
    let mut console = Console { out, err };
    match work(&program, &mut console) {
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
#[must_use]
pub fn in_words(error: &anyhow::Error) -> String {
    error.chain().map(ToString::to_string).fold(String::new(), |text, cause| match text.as_str() {
        "" => cause,
        told if told.contains(&cause) => text,
        _ => format!("{text}: {cause}"),
    })
}
