//! The report as one HTML page that needs nothing beside it.

use core::fmt::Write as _;

use anyhow::Result;

use super::calibration::{Calibration, PARAMETERS, Within};
use super::draw;
use super::judge::FOUND;
use super::summary::{BROKEN, MethodSummary, SweepSummary, label};
use super::table::{break_point, methods};
use super::trial::Effort;
use crate::command::html::{END, begin, escaped};

/// The page.
///
/// # Errors
/// If a chart cannot be drawn.
pub(super) fn page(sweeps: &[SweepSummary], machine: Option<&str>, effort: Effort) -> Result<String> {
    let mut text = begin("dvp: where methods fail", "Where methods fail");
    text += &format!(
        "<p>A run succeeds if the number of objects is right and each agrees with the true one to an IoU of {FOUND} in what \
         is seen of it. A method breaks at the first level where fewer than {:.0} % succeed. A failure is silent if \
         the result doubts nothing: no wide covariance, no ambiguity (but symmetry), no stop before it was done, no \
         unexplained rest, no object that may be one too many or is faint. {} pictures per level, from number {}; the \
         same scenes at all levels.</p>\n",
        100.0 * BROKEN,
        effort.pictures,
        effort.seed
    );
    if let Some(machine) = machine {
        let _ = writeln!(text, "<p>Machine: {}</p>", escaped(machine));
    }
    breaks(&mut text, sweeps);
    calibration(&mut text, sweeps);
    for sweep in sweeps {
        let _ = writeln!(text, "<h2 id=\"{}\">{}</h2>", sweep.name, escaped(sweep.title));
        let bugs: Vec<String> =
            sweep.bugs().iter().map(|(method, what, count)| format!("{method}: {count} x {what}")).collect();
        if !bugs.is_empty() {
            let _ = writeln!(text, "<p class=\"bug\">{}</p>", bugs.join(", "));
        }
        text += &draw::svg(sweep)?;
        levels(&mut text, sweep);
    }
    text.push_str(END);
    Ok(text)
}

/// Break points: a row per sweep, a column per method.
fn breaks(text: &mut String, sweeps: &[SweepSummary]) {
    text.push_str(
        "<h2>Break points</h2>\n<p>The level, and how most runs fail there; a dash: it does not break.</p>\n",
    );
    let names = methods(sweeps);
    text.push_str("<div class=\"wide\"><table><tr><th>difficulty</th>");
    for name in &names {
        let _ = write!(text, "<th>{name}</th>");
    }
    text.push_str("</tr>\n");
    for sweep in sweeps {
        let _ = write!(text, "<tr><td><a href=\"#{}\">{}</a></td>", sweep.name, escaped(sweep.title));
        for name in &names {
            let own = sweep.methods.iter().find(|method| method.method == *name);
            let _ = write!(text, "<td>{}</td>", own.map_or_else(String::new, break_point));
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</table></div>\n");
}

/// Outcomes against doubts by method, over all sweeps.
fn calibration(text: &mut String, sweeps: &[SweepSummary]) {
    text.push_str(
        "<h2>Calibration</h2>\n<div class=\"wide\"><table><tr><th>method</th><th>failed, doubted</th>\
                   <th>failed silently</th><th>succeeded, doubted</th><th>succeeded, sure</th>",
    );
    for name in PARAMETERS {
        let _ = write!(text, "<th>{name}: within 1, 2 deviations</th>");
    }
    text.push_str("</tr>\n");
    for (name, all) in totals(sweeps) {
        let _ = write!(text, "<tr><td>{name}</td>");
        for count in [all.failed_doubted, all.failed_silently, all.succeeded_doubted, all.succeeded_surely] {
            let _ = write!(text, "<td class=\"n\">{count}</td>");
        }
        for within in all.stated {
            let _ = write!(text, "<td>{}</td>", shares(within));
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</table></div>\n<p>Of a normal distribution 68 % lie within 1 deviation and 95 % within 2.</p>\n");
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
fn levels(text: &mut String, sweep: &SweepSummary) {
    text.push_str("<div class=\"wide\"><table><tr><th>success % (silent failures %)</th>");
    for level in sweep.levels() {
        let _ = write!(text, "<th>{}</th>", label(level));
    }
    text.push_str("</tr>\n");
    for method in &sweep.methods {
        let _ = write!(text, "<tr><td>{}</td>", method.method);
        for level in &method.levels {
            let silent = if level.silent > 0.0 { format!(" ({:.0})", 100.0 * level.silent) } else { String::new() };
            let _ = write!(text, "<td class=\"n\">{:.0}{silent}</td>", 100.0 * level.success);
        }
        text.push_str("</tr>\n");
    }
    text.push_str("</table></div>\n");
}
