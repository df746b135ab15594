//! How losses fell.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use dvp_net::train::Step;

use crate::chart::{Chart, Line};
use crate::format::write_atomic;

/// The first line of `losses.csv`.
const HEADER: &str =
    "step,loss,image_loss,parameter_loss,gradient,rate,seconds,validation_image_loss,validation_parameter_loss";

/// A line of `losses.csv`.
#[derive(Clone, Debug, PartialEq)]
struct Row {
    step: u64,
    loss: f64,
    validation: Option<f64>,
    text: String,
}

/// Losses of a run so far.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Curves {
    rows: Vec<Row>,
}

impl Curves {
    /// Reads what a run left up to and with step `last`.
    pub(super) fn read(path: &Path, last: u64) -> Result<Self> {
        let text = fs::read_to_string(path).with_context(|| format!("{} cannot be read", path.display()))?;
        let row = |line: &str| {
            let fields: Vec<&str> = line.split(',').collect();
            let number = |k: usize| fields.get(k)?.parse::<f64>().ok();
            let step = fields.first()?.parse().ok()?;
            Some(Row { step, loss: number(1)?, validation: number(7), text: line.to_owned() })
        };
        Ok(Self { rows: text.lines().skip(1).filter_map(row).filter(|row| row.step <= last).collect() })
    }

    /// Seconds that the run had taken at its last line.
    pub(super) fn seconds(&self) -> f64 {
        let field = |row: &Row| row.text.split(',').nth(6)?.parse().ok();
        self.rows.last().and_then(field).unwrap_or(0.0)
    }

    /// The smallest L_x on the validation images.
    pub(super) fn best(&self) -> Option<f64> {
        self.rows.iter().filter_map(|row| row.validation).min_by(f64::total_cmp)
    }

    /// Adds the line of a step, of mean `loss` since the last line; `seen`: losses on the validation images.
    pub(super) fn push(&mut self, step: &Step, loss: f64, seconds: f64, seen: Option<[Option<f64>; 2]>) {
        let show = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.6}"));
        let [image, parameters] = seen.unwrap_or([None; 2]);
        let text = format!(
            "{},{loss:.6},{},{},{:.4},{:.3e},{seconds:.1},{},{}",
            step.number,
            show(step.image),
            show(step.parameters),
            step.gradient,
            step.rate,
            show(image),
            show(parameters)
        );
        self.rows.push(Row { step: step.number, loss, validation: image, text });
    }

    /// Writes `losses.csv` and `losses.svg`.
    pub(super) fn write(&self, csv: &Path, svg: &Path) -> Result<()> {
        let lines: Vec<&str> = [HEADER].into_iter().chain(self.rows.iter().map(|row| row.text.as_str())).collect();
        write_atomic(csv, (lines.join("\n") + "\n").as_bytes())?;
        #[expect(clippy::cast_precision_loss, reason = "steps are fewer than 2^53")]
        let at = |row: &Row| row.step as f64;
        let training = self.rows.iter().map(|row| (at(row), row.loss)).collect();
        let seen = self.rows.iter().filter_map(|row| Some((at(row), row.validation?))).collect();
        let line = |name: &str, points| Line { name: name.to_owned(), points, ..Line::default() };
        let lines = vec![line("training loss", training), line("image loss, validation", seen)];
        Chart { title: "Losses", x: "step", y: "loss", lines, log: true }.write(svg)
    }
}
