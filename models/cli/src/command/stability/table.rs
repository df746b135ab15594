//! Results as tables: CSV files, and text for people.

use core::fmt::Write as _;

use comfy_table::{Table, presets};
use dvp_fit::Doubts;

use super::calibration::PARAMETERS;
use super::summary::{MethodSummary, SweepSummary, label};
use super::sweep::Sweep;
use super::trial::{Contender, Trial};

/// A number as CSV has it; NaN is an empty field.
fn field(value: f64) -> String {
    if value.is_finite() { format!("{value:.6}") } else { String::new() }
}

/// The head of the table of runs.
pub(super) fn runs_head() -> String {
    let doubts = Doubts::default().named().map(|(name, _)| format!("doubts_{name}")).join(",");
    format!("sweep,level,method,picture,failure,iou,mae,ari,cpu_ms,stop,unexplained,{doubts}\n")
}

/// The rows of a sweep in the table of runs.
pub(super) fn runs(sweep: &Sweep, contenders: &[Contender], trials: &[Trial]) -> String {
    let mut text = String::new();
    for trial in trials {
        let (own, doubts) = (&trial.verdict, trial.verdict.doubts);
        let failure = own.failure.map_or("", |failure| failure.name());
        let stop = own.stop.map_or_else(String::new, |stop| format!("{stop:?}"));
        let (level, method) = (sweep.levels[trial.level], &contenders[trial.contender].name);
        let numbers = [own.iou, own.mae, own.ari, own.cpu_ms].map(field).join(",");
        let said = doubts.named().map(|(_, is)| u8::from(is).to_string());
        let _ = writeln!(
            text,
            "{},{level},{method},{},{failure},{numbers},{stop},{},{}",
            sweep.name,
            trial.seed,
            field(own.unexplained),
            said.join(",")
        );
    }
    text
}

/// The table of levels.
pub(super) fn levels(sweeps: &[SweepSummary]) -> String {
    let mut text =
        "sweep,level,method,runs,success,exact_count,silent_failures,iou,mae,ari,cpu_ms,failures\n".to_owned();
    for sweep in sweeps {
        for method in &sweep.methods {
            for level in &method.levels {
                let numbers = [level.success, level.exact_count, level.silent, level.iou, level.mae, level.ari];
                let failures: Vec<String> = level.failures.iter().map(|(name, n)| format!("{name} {n}")).collect();
                let _ = writeln!(
                    text,
                    "{},{},{},{},{},{},{}",
                    sweep.name,
                    level.level,
                    method.method,
                    level.runs,
                    numbers.map(field).join(","),
                    field(level.cpu_ms),
                    failures.join("; ")
                );
            }
        }
    }
    text
}

/// The table of calibration.
pub(super) fn calibration(sweeps: &[SweepSummary]) -> String {
    let mut text = "sweep,method,failed_doubted,failed_silently,succeeded_doubted,succeeded_surely".to_owned();
    for name in PARAMETERS.map(|name| name.replace(' ', "_")) {
        let _ = write!(text, ",{name}_stated,{name}_within_1,{name}_within_2");
    }
    text.push('\n');
    for sweep in sweeps {
        for MethodSummary { method, calibration, .. } in &sweep.methods {
            let outcomes = [
                calibration.failed_doubted,
                calibration.failed_silently,
                calibration.succeeded_doubted,
                calibration.succeeded_surely,
            ];
            let _ = write!(text, "{},{method},{}", sweep.name, outcomes.map(|n| n.to_string()).join(","));
            for within in calibration.stated {
                let _ = write!(text, ",{},{},{}", within.stated, within.one, within.two);
            }
            text.push('\n');
        }
    }
    text
}

/// Where a method breaks, and how: "0.05: wrong count", or a dash.
pub(super) fn break_point(method: &MethodSummary) -> String {
    let by = method.by.unwrap_or("failure");
    method.breaks_at.map_or_else(|| "-".to_owned(), |level| format!("{}: {by}", label(level)))
}

/// Names of all methods, in the order in which they come.
pub(super) fn methods(sweeps: &[SweepSummary]) -> Vec<&str> {
    let mut names: Vec<&str> = Vec::new();
    for method in sweeps.iter().flat_map(|sweep| &sweep.methods) {
        if !names.contains(&&*method.method) {
            names.push(&method.method);
        }
    }
    names
}

/// Break points for people, a row per sweep and a column per method; then what is a bug whatever the level.
pub(super) fn breaks(sweeps: &[SweepSummary]) -> String {
    let names = methods(sweeps);
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN);
    table.set_header(core::iter::once("breaks at").chain(names.iter().copied()));
    let mut bugs = String::new();
    for sweep in sweeps {
        let own = names.iter().map(|name| sweep.methods.iter().find(|method| method.method == *name));
        let cells = own.map(|method| method.map_or_else(String::new, break_point));
        table.add_row(core::iter::once(sweep.name.to_owned()).chain(cells));
        for (method, what, count) in sweep.bugs() {
            let _ = write!(bugs, "\n{}, {method}: {count} x {what}", sweep.name);
        }
    }
    format!("{}{bugs}", table.trim_fmt())
}
