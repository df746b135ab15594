//! The report as one HTML page that needs nothing beside it.

use anyhow::Result;
use maud::{Markup, html};

use super::calibration::{Calibration, PARAMETERS, Within};
use super::draw;
use super::judge::FOUND;
use super::summary::{BROKEN, MethodSummary, SweepSummary, label};
use super::table::{break_point, methods};
use super::trial::Effort;
use crate::command::report::{self, drawing, wide};

/// The page.
///
/// # Errors
/// If a chart cannot be drawn.
pub(super) fn page(sweeps: &[SweepSummary], machine: Option<&str>, effort: Effort) -> Result<String> {
    let charts: Vec<String> = sweeps.iter().map(draw::svg).collect::<Result<_>>()?;
    let body = html! {
        p {
            "A run succeeds if the number of objects is right and each agrees with the true one to an IoU of " (FOUND)
            " in what is seen of it. A method breaks at the first level where fewer than " (format!("{:.0}", 100.0 * BROKEN))
            " % succeed. A failure is silent if the result doubts nothing: no object that may lie elsewhere, no \
            stop before it was done, no unexplained rest, no object that may be one too many. "
            (effort.pictures) " pictures per level, from number " (effort.seed) "; the same scenes at all levels."
        }
        @if let Some(machine) = machine { p { "Machine: " (machine) } }
        (breaks(sweeps))
        (calibration(sweeps))
        @for (sweep, chart) in sweeps.iter().zip(&charts) {
            h2 id=(sweep.name) { (sweep.title) }
            (bugs(sweep))
            (drawing(chart))
            (levels(sweep))
        }
    };
    Ok(report::page("dvp: where methods fail", "Where methods fail", &body))
}

/// What is a bug whatever the level.
fn bugs(sweep: &SweepSummary) -> Markup {
    let bugs: Vec<String> =
        sweep.bugs().iter().map(|(method, what, count)| format!("{method}: {count} x {what}")).collect();
    html! { @if !bugs.is_empty() { p.bug { (bugs.join(", ")) } } }
}

/// Break points: a row per sweep, a column per method.
fn breaks(sweeps: &[SweepSummary]) -> Markup {
    let names = methods(sweeps);
    let at = |sweep: &SweepSummary, name: &str| {
        sweep.methods.iter().find(|method| method.method == name).map_or_else(String::new, break_point)
    };
    html! {
        h2 { "Break points" }
        p { "The level, and how most runs fail there; a dash: it does not break." }
        (wide(&html! {
            tr { th { "difficulty" } @for name in &names { th { (name) } } }
            @for sweep in sweeps {
                tr {
                    td { a href={ "#" (sweep.name) } { (sweep.title) } }
                    @for name in &names { td { (at(sweep, name)) } }
                }
            }
        }))
    }
}

/// Outcomes against doubts by method, over all sweeps.
fn calibration(sweeps: &[SweepSummary]) -> Markup {
    let outcomes = ["failed, doubted", "failed silently", "succeeded, doubted", "succeeded, sure"];
    html! {
        h2 { "Calibration" }
        (wide(&html! {
            tr {
                th { "method" }
                @for outcome in outcomes { th { (outcome) } }
                @for name in PARAMETERS { th { (name) ": within 1, 2 deviations" } }
            }
            @for (name, all) in totals(sweeps) {
                tr {
                    td { (name) }
                    @for count in all.outcomes() { td.n { (count) } }
                    @for within in all.stated { td { (shares(within)) } }
                }
            }
        }))
        p { "Of a normal distribution 68 % lie within 1 deviation and 95 % within 2." }
    }
}

/// The calibration of every method over all sweeps, in their order.
fn totals(sweeps: &[SweepSummary]) -> Vec<(String, Calibration)> {
    let mut totals: Vec<(String, Calibration)> = Vec::new();
    for MethodSummary { method, calibration, .. } in sweeps.iter().flat_map(|sweep| &sweep.methods) {
        match totals.iter_mut().find(|(name, _)| name == method) {
            Some((_, all)) => all.merge(calibration),
            None => totals.push((method.clone(), *calibration)),
        }
    }
    totals
}

/// "61 %, 90 % of 120", or nothing.
fn shares(within: Within) -> String {
    within.shares().map_or_else(String::new, |[one, two]| {
        format!("{:.0} %, {:.0} % of {}", 100.0 * one, 100.0 * two, within.stated)
    })
}

/// Success, and silent failures where there are any, by method and level.
fn levels(sweep: &SweepSummary) -> Markup {
    let silent = |share: f64| if share > 0.0 { format!(" ({:.0})", 100.0 * share) } else { String::new() };
    wide(&html! {
        tr { th { "success % (silent failures %)" } @for level in sweep.levels() { th { (label(level)) } } }
        @for method in &sweep.methods {
            tr {
                td { (method.method) }
                @for level in &method.levels { td.n { (format!("{:.0}", 100.0 * level.success)) (silent(level.silent)) } }
            }
        }
    })
}
