//! How losses fell.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use crate::chart::{Chart, Line};
use crate::format::write_atomic;

/// The first line of `losses.csv` where scenes are learned.
const OF_SCENES: &str =
    "step,loss,image_loss,parameter_loss,gradient,rate,seconds,validation_image_loss,validation_parameter_loss";
/// And where parts are.
const OF_PARTS: &str = "step,loss,pixels,latents,gradient,rate,seconds,validation_mae,validation_ari";
/// And where second looks are.
const OF_LOOKS: &str = "step,loss,moves,shapes,gradient,rate,seconds,validation_moves,validation_shapes";

/// What a line of the curves says of a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) step: u64,
    /// Mean since the last line.
    pub(super) loss: f64,
    /// Two of the terms of the loss of this step.
    pub(super) terms: [Option<f64>; 2],
    pub(super) gradient: f64,
    pub(super) rate: f64,
    pub(super) seconds: f64,
    /// On the validation images, where they were looked at; runs are judged by the first.
    pub(super) seen: [Option<f64>; 2],
}

/// A line of `losses.csv`.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    step: u64,
    loss: f64,
    validation: Option<f64>,
    text: String,
}

/// Losses of a run so far.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curves {
    header: &'static str,
    rows: Vec<Row>,
}

impl Curves {
    pub(super) fn of_scenes() -> Self {
        Self { header: OF_SCENES, rows: Vec::new() }
    }

    pub(super) fn of_parts() -> Self {
        Self { header: OF_PARTS, rows: Vec::new() }
    }

    pub(super) fn of_looks() -> Self {
        Self { header: OF_LOOKS, rows: Vec::new() }
    }

    /// Reads what a run left up to and with step `last`.
    pub(super) fn read(&mut self, path: &Path, last: u64) -> Result<()> {
        let text = fs::read_to_string(path).with_context(|| format!("{} cannot be read", path.display()))?;
        let row = |line: &str| {
            let fields: Vec<&str> = line.split(',').collect();
            let number = |k: usize| fields.get(k)?.parse::<f64>().ok();
            let step = fields.first()?.parse().ok()?;
            Some(Row { step, loss: number(1)?, validation: number(7), text: line.to_owned() })
        };
        self.rows = text.lines().skip(1).filter_map(row).filter(|row| row.step <= last).collect();
        Ok(())
    }

    /// Seconds that the run had taken at its last line.
    pub(super) fn seconds(&self) -> f64 {
        let field = |row: &Row| row.text.split(',').nth(6)?.parse().ok();
        self.rows.last().and_then(field).unwrap_or(0.0)
    }

    /// The smallest error of the validation images.
    pub(super) fn best(&self) -> Option<f64> {
        self.rows.iter().filter_map(|row| row.validation).min_by(f64::total_cmp)
    }

    /// Adds a line.
    pub(super) fn push(&mut self, entry: &Entry) {
        let Entry { step, loss, terms, gradient, rate, seconds, seen } = *entry;
        let show = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.6}"));
        let [[first, second], [error, other]] = [terms.map(show), seen.map(show)];
        let text = format!("{step},{loss:.6},{first},{second},{gradient:.4},{rate:.3e},{seconds:.1},{error},{other}");
        self.rows.push(Row { step, loss, validation: seen[0], text });
    }

    /// Writes `losses.csv` and `losses.svg`.
    pub(super) fn write(&self, csv: &Path, svg: &Path) -> Result<()> {
        let lines: Vec<&str> = [self.header].into_iter().chain(self.rows.iter().map(|row| row.text.as_str())).collect();
        write_atomic(csv, (lines.join("\n") + "\n").as_bytes())?;
        #[expect(clippy::cast_precision_loss, reason = "steps are fewer than 2^53")]
        let at = |row: &Row| row.step as f64;
        let training = self.rows.iter().map(|row| (at(row), row.loss)).collect();
        let seen = self.rows.iter().filter_map(|row| Some((at(row), row.validation?))).collect();
        let line = |name: &str, points| Line { name: name.to_owned(), points, ..Line::default() };
        let error = if self.header == OF_LOOKS { "error, validation" } else { "image loss, validation" };
        let lines = vec![line("training loss", training), line(error, seen)];
        Chart { title: "Losses", x: "step", y: "loss", lines, log: true }.write(svg)
    }
}
