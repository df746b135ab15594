//! Training losses of several runs on one chart, from the `losses.csv` that `dvp train` writes.
//!
//! `cargo run --release -p dvp-tests --example loss_curves -- OUT.svg candle=RUN/losses.csv burn=RUN/losses.csv`

use core::error::Error;
use std::env;
use std::fs;
use std::path::Path;

use dvp::chart::{Chart, Line};

/// The line NAME=FILE: the mean loss of the steps before each of its points.
fn line(argument: &str) -> Result<Line, Box<dyn Error>> {
    let (name, file) = argument.split_once('=').ok_or_else(|| format!("{argument}: must be NAME=FILE"))?;
    let text = fs::read_to_string(file).map_err(|error| format!("{file}: {error}"))?;
    let mut points = Vec::new();
    for row in text.lines().skip(1) {
        let mut fields = row.split(',');
        let mut number = || fields.next().and_then(|field| field.parse().ok());
        points.push(number().zip(number()).ok_or_else(|| format!("{file}: no losses of a run: {row}"))?);
    }
    Ok(Line { name: name.to_owned(), points, ..Line::default() })
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = env::args().skip(1);
    let out = arguments.next().ok_or("usage: loss_curves OUT.svg NAME=FILE...")?;
    let lines = arguments.map(|argument| line(&argument)).collect::<Result<_, _>>()?;
    Ok(Chart { title: "Training losses", x: "step", y: "loss", lines, log: true }.write(Path::new(&out))?)
}
