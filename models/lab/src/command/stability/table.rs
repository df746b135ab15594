//! Results as tables: CSV files, and text for people.

use core::fmt::Write as _;

use comfy_table::{Table, presets};
use dvp_fit::Doubts;

use super::calibration::PARAMETERS;
use super::summary::{LevelSummary, MethodSummary, SweepSummary, label};
use super::sweep::Sweep;
use super::trial::{Contender, Trial};
use crate::command::report::{Cells, header};

/// A number as CSV has it; NaN is an empty field.
fn field(value: f64) -> String {
    if value.is_finite() { format!("{value:.6}") } else { String::new() }
}

/// The head of the table of runs.
pub(super) fn runs_head() -> Cells {
    let names =
        ["sweep", "level", "method", "picture", "failure", "iou", "mae", "ari", "cpu_ms", "stop", "unexplained"];
    let mut cells = header(names);
    cells[0].extend(Doubts::default().named().map(|(name, _)| format!("doubts_{name}")));
    cells
}

/// The rows of a sweep in the table of runs.
pub(super) fn runs(sweep: &Sweep, contenders: &[Contender], trials: &[Trial]) -> Cells {
    let row = |trial: &Trial| {
        let own = &trial.verdict;
        let what = [
            sweep.name.to_owned(),
            sweep.levels[trial.level].to_string(),
            contenders[trial.contender].name.clone(),
            trial.seed.to_string(),
            own.failure.map_or("", |failure| failure.name()).to_owned(),
        ];
        let numbers = [own.iou, own.mae, own.ari, own.cpu_ms].map(field);
        let stop = own.stop.map_or_else(String::new, |stop| format!("{stop:?}"));
        let said = own.doubts.named().map(|(_, is)| u8::from(is).to_string());
        what.into_iter().chain(numbers).chain([stop, field(own.unexplained)]).chain(said).collect()
    };
    trials.iter().map(row).collect()
}

/// The table of levels.
pub(super) fn levels(sweeps: &[SweepSummary]) -> Cells {
    let mut cells = header([
        "sweep",
        "level",
        "method",
        "runs",
        "success",
        "exact_count",
        "silent_failures",
        "iou",
        "mae",
        "ari",
        "cpu_ms",
        "failures",
    ]);
    for sweep in sweeps {
        for method in &sweep.methods {
            cells.extend(method.levels.iter().map(|level| {
                let failures: Vec<String> = level.failures.iter().map(|(name, n)| format!("{name} {n}")).collect();
                let LevelSummary { success, exact_count, silent, iou, mae, ari, cpu_ms, .. } = *level;
                let what =
                    [sweep.name.to_owned(), level.level.to_string(), method.method.clone(), level.runs.to_string()];
                let numbers = [success, exact_count, silent, iou, mae, ari, cpu_ms].map(field);
                what.into_iter().chain(numbers).chain([failures.join("; ")]).collect()
            }));
        }
    }
    cells
}

/// The table of calibration.
pub(super) fn calibration(sweeps: &[SweepSummary]) -> Cells {
    let mut cells =
        header(["sweep", "method", "failed_doubted", "failed_silently", "succeeded_doubted", "succeeded_surely"]);
    for name in PARAMETERS.map(|name| name.replace(' ', "_")) {
        cells[0].extend(["stated", "within_1", "within_2"].map(|what| format!("{name}_{what}")));
    }
    for sweep in sweeps {
        cells.extend(sweep.methods.iter().map(|MethodSummary { method, calibration, .. }| {
            let stated = calibration.stated.iter().flat_map(|within| [within.stated, within.one, within.two]);
            let counts = calibration.outcomes().into_iter().chain(stated).map(|count| count.to_string());
            [sweep.name.to_owned(), method.clone()].into_iter().chain(counts).collect()
        }));
    }
    cells
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
