//! Runs summed up: by level, where a method breaks, how, and how often without a word.

use alloc::collections::BTreeMap;

use dvp_core::Real;
use serde::Serialize;

use super::calibration::Calibration;
use super::judge::{Failure, Verdict};
use super::sweep::Sweep;
use super::trial::{Contender, Trial};

/// A level at which fewer succeed is where a method breaks.
pub(super) const BROKEN: f64 = 0.5;

/// The runs of a method at a level.
#[derive(Clone, Debug, Serialize)]
pub(super) struct LevelSummary {
    pub(super) level: f64,
    pub(super) runs: usize,
    /// Shares of the runs.
    pub(super) success: f64,
    pub(super) exact_count: f64,
    pub(super) silent: f64,
    /// Means over the runs with a result.
    pub(super) iou: f64,
    pub(super) mae: f64,
    pub(super) ari: f64,
    pub(super) cpu_ms: f64,
    /// Failures by their name.
    pub(super) failures: BTreeMap<&'static str, usize>,
}

impl LevelSummary {
    fn of(level: f64, verdicts: &[&Verdict]) -> Self {
        let runs = f64::of_usize(verdicts.len());
        let share =
            |is: &dyn Fn(&Verdict) -> bool| f64::of_usize(verdicts.iter().filter(|verdict| is(verdict)).count()) / runs;
        let mut failures = BTreeMap::new();
        for failure in verdicts.iter().filter_map(|verdict| verdict.failure) {
            *failures.entry(failure.name()).or_insert(0) += 1;
        }
        let value = |of: fn(&Verdict) -> f64| mean(verdicts.iter().map(|verdict| of(verdict)));
        Self {
            level,
            runs: verdicts.len(),
            success: share(&|verdict| verdict.failure.is_none()),
            exact_count: share(&|verdict| verdict.count_is_right),
            silent: share(&Verdict::is_silent),
            iou: value(|verdict| verdict.iou),
            mae: value(|verdict| verdict.mae),
            ari: value(|verdict| verdict.ari),
            cpu_ms: value(|verdict| verdict.cpu_ms),
            failures,
        }
    }
}

/// Mean of the finite values; NaN if there are none.
fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let finite = values.filter(|value| value.is_finite());
    let (sum, count) = finite.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// A method in a sweep.
#[derive(Clone, Debug, Serialize)]
pub(super) struct MethodSummary {
    pub(super) method: String,
    /// The first level at which it breaks.
    pub(super) breaks_at: Option<f64>,
    /// How it fails there: the most frequent way.
    pub(super) by: Option<&'static str>,
    pub(super) levels: Vec<LevelSummary>,
    pub(super) calibration: Calibration,
}

/// A sweep and its runs.
#[derive(Clone, Debug, Serialize)]
pub(super) struct SweepSummary {
    pub(super) name: &'static str,
    pub(super) title: &'static str,
    pub(super) axis: &'static str,
    pub(super) methods: Vec<MethodSummary>,
}

impl SweepSummary {
    pub(super) fn of(sweep: &Sweep, contenders: &[Contender], trials: &[Trial], quick: bool) -> Self {
        let method = |(index, contender): (usize, &Contender)| {
            let own = || trials.iter().filter(move |trial| trial.contender == index);
            let at = |level: usize| -> Vec<&Verdict> {
                own().filter(|trial| trial.level == level).map(|trial| &trial.verdict).collect()
            };
            let chosen = sweep.chosen(quick).into_iter();
            let levels: Vec<LevelSummary> =
                chosen.map(|level| LevelSummary::of(sweep.levels[level], &at(level))).collect();
            let broken = levels.iter().find(|level| level.success < BROKEN);
            MethodSummary {
                method: contender.name.clone(),
                breaks_at: broken.map(|level| level.level),
                by: broken.and_then(|level| worst(&level.failures)),
                calibration: Calibration::of(own().map(|trial| &trial.verdict)),
                levels,
            }
        };
        let Sweep { name, title, axis, .. } = *sweep;
        Self { name, title, axis, methods: contenders.iter().enumerate().map(method).collect() }
    }

    /// Levels from easy to hard.
    pub(super) fn levels(&self) -> Vec<f64> {
        let of = |method: &MethodSummary| method.levels.iter().map(|level| level.level).collect();
        self.methods.first().map_or_else(Vec::new, of)
    }

    /// Failures that are bugs whatever the level: name of the method, what, how often.
    pub(super) fn bugs(&self) -> Vec<(&str, &'static str, usize)> {
        let bugs = [Failure::Panicked, Failure::Endless, Failure::NotFinite];
        let count = |method: &MethodSummary, bug: Failure| {
            method.levels.iter().filter_map(|level| level.failures.get(bug.name())).sum::<usize>()
        };
        let all =
            self.methods.iter().flat_map(|method| bugs.map(|bug| (&*method.method, bug.name(), count(method, bug))));
        all.filter(|(_, _, count)| *count > 0).collect()
    }
}

/// The most frequent way to fail.
fn worst(failures: &BTreeMap<&'static str, usize>) -> Option<&'static str> {
    failures.iter().max_by_key(|(_, count)| **count).map(|(name, _)| *name)
}

/// A level as the axis has it: at most four digits, powers of ten where there are many zeros.
pub(super) fn label(level: f64) -> String {
    let is_long = level != 0.0 && level.abs() < 1e-3;
    if is_long { format!("{level:.0e}") } else { format!("{level}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_summed_up_by_hand() {
        let good =
            Verdict { failure: None, count_is_right: true, iou: 1.0, mae: 0.1, ..Verdict::none(Failure::Refused) };
        let silent = Verdict { iou: 0.5, mae: 0.3, ..Verdict::none(Failure::WrongPose) };
        let refused = Verdict::none(Failure::Refused);
        let level = LevelSummary::of(2.0, &[&good, &silent, &refused, &refused]);
        assert_eq!((level.runs, level.failures["refused"], level.failures["wrong pose"]), (4, 2, 1));
        assert!((level.success - 0.25).abs() < 1e-12 && (level.silent - 0.25).abs() < 1e-12);
        // A run without a result has no error, but an IoU of 0.
        assert!((level.mae - 0.2).abs() < 1e-12 && (level.iou - 0.375).abs() < 1e-12);
        assert_eq!(worst(&level.failures), Some("refused"));
        let calibration = Calibration::of([&good, &silent, &refused]);
        assert_eq!((calibration.failed_silently, calibration.failed_doubted), (1, 1));
    }

    #[test]
    fn labels_are_short() {
        assert_eq!([0.0, 0.075, 2048.0, 3e-5, 1.0].map(label), ["0", "0.075", "2048", "3e-5", "1"]);
    }
}
