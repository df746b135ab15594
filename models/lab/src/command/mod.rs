//! The sub-commands of the laboratory.

mod arguments;
mod chart;
mod gradients;
mod parsimony;
mod pictures;
mod report;
mod stability;

use anyhow::Result;
use clap::Subcommand;
use dvp_cli::command::{Console, Outcome};

/// A sub-command with its arguments.
#[derive(Debug, Subcommand)]
#[expect(missing_docs, reason = "each has the text of its arguments, which is its help")]
#[non_exhaustive]
pub enum Command {
    Gradients(gradients::Arguments),
    Stability(stability::Arguments),
    Chart(chart::Arguments),
    Parsimony(parsimony::Arguments),
}

impl Command {
    /// Does it.
    ///
    /// # Errors
    /// What kept the command from its work. Failures of single images are none: they are counted, and the outcome says so.
    pub fn run(&self, console: &mut Console<'_>) -> Result<Outcome> {
        match self {
            Self::Gradients(arguments) => gradients::run(arguments, console),
            Self::Stability(arguments) => stability::run(arguments, console),
            Self::Chart(arguments) => chart::run(arguments, console),
            Self::Parsimony(arguments) => parsimony::run(arguments, console),
        }
    }
}
