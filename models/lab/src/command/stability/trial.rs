//! Runs every method on every level of a difficulty.

use alloc::sync::Arc;
use core::sync::atomic::{AtomicBool, Ordering};
use core::time::Duration;

use anyhow::{Context, Result};
use indicatif::ProgressBar;
use rayon::prelude::*;

use super::judge::{Failure, Verdict};
use super::sweep::{Case, Sweep, Who};
use super::watch::{Ended, within};
use dvp_cli::method::{Memory, Method, Precision, Runner, Setting, Start, Task, Tools};

/// A method as it is tried, by the name that the report has for it.
#[derive(Clone, Debug)]
pub(super) struct Contender {
    pub(super) name: String,
    pub(super) method: Method,
    runner: Arc<Runner>,
}

impl Contender {
    fn new(method: Method, precision: Option<Precision>, tools: &Tools) -> Result<Self> {
        let own = method.default_setting();
        let (precision, name) = match precision {
            None => (own.precision, method.name()),
            Some(Precision::F32) => (Precision::F32, format!("{} f32", method.name())),
            Some(Precision::F64) => (Precision::F64, format!("{} f64", method.name())),
        };
        let runner = Arc::new(Runner::new(method, Setting { precision, ..own }, tools)?);
        Ok(Self { name, method, runner })
    }

    /// Those of `methods` that are tried in a sweep.
    pub(super) fn of(sweep: &Sweep, methods: &[Method], tools: &Tools) -> Result<Vec<Self>> {
        let asked = methods.iter().copied();
        match sweep.who {
            Who::All => asked.map(|method| Self::new(method, None, tools)).collect(),
            Who::Starts => {
                let goes_on = |method: &Method| method.start() == Start::Scene;
                asked.filter(goes_on).map(|method| Self::new(method, None, tools)).collect()
            }
            Who::Precisions => {
                let compared = [Method::SegmentFree, Method::Lm, Method::OptP];
                let both = |method| [Precision::F32, Precision::F64].map(|precision| (method, Some(precision)));
                let pairs = asked.filter(|method| compared.contains(method)).flat_map(both);
                pairs.map(|(method, precision)| Self::new(method, precision, tools)).collect()
            }
        }
    }
}

/// One run and what came of it.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    /// Index of the level in [`Sweep::levels`].
    pub(super) level: usize,
    /// Index of the contender.
    pub(super) contender: usize,
    pub(super) seed: u64,
    pub(super) verdict: Verdict,
}

/// How many pictures, from which seed on, and how long a run may take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    pub(super) quick: bool,
    pub(super) pictures: u64,
    pub(super) seed: u64,
    pub(super) limit: Duration,
}

impl Effort {
    /// Pictures per level.
    pub(super) fn pictures_of(&self, sweep: &Sweep) -> u64 {
        self.pictures.div_ceil(sweep.thinned)
    }
}

/// All runs of a sweep, level by level and picture by picture. A method that does not end at one level is not run at harder
/// ones, and counts as endless there.
pub(super) fn run(sweep: &Sweep, contenders: &[Contender], effort: Effort, bar: &ProgressBar) -> Result<Vec<Trial>> {
    let endless: Vec<AtomicBool> = contenders.iter().map(|_| AtomicBool::new(false)).collect();
    let mut trials = Vec::new();
    for level in sweep.chosen(effort.quick) {
        let seeds = effort.seed..effort.seed + effort.pictures_of(sweep);
        let of_seed = |seed| -> Result<Vec<Trial>> {
            let named = || format!("{} {}, picture {seed}", sweep.name, sweep.levels[level]);
            let case = Arc::new((sweep.make)(sweep.levels[level], seed).with_context(named)?);
            let mut trials = Vec::with_capacity(contenders.len());
            for (contender, own) in contenders.iter().enumerate() {
                let verdict = if endless[contender].load(Ordering::Relaxed) {
                    Verdict::none(Failure::Endless)
                } else {
                    verdict_on(&case, own, seed, effort.limit).with_context(named)?
                };
                if verdict.failure == Some(Failure::Endless) {
                    endless[contender].store(true, Ordering::Relaxed);
                }
                trials.push(Trial { level, contender, seed, verdict });
                bar.inc(1);
            }
            Ok(trials)
        };
        let of_level: Vec<Vec<Trial>> = seeds.into_par_iter().map(of_seed).collect::<Result<_>>()?;
        trials.extend(of_level.into_iter().flatten());
    }
    Ok(trials)
}

fn verdict_on(case: &Arc<Case>, contender: &Contender, seed: u64, limit: Duration) -> Result<Verdict> {
    let (shared, runner) = (Arc::clone(case), Arc::clone(&contender.runner));
    let work = move || {
        let Case { image, truth, start } = &*shared;
        let task = Task { start: start.as_ref(), truth: Some(truth), seed, ..Task::of(image.view()) };
        runner.run(&task, &mut Memory::default())
    };
    match within(limit, work)? {
        Ended::Done(Ok(found)) => Verdict::of(case, &found, contender.method),
        Ended::Done(Err(_)) => Ok(Verdict::none(Failure::Refused)),
        Ended::Panicked => Ok(Verdict::none(Failure::Panicked)),
        Ended::NotInTime => Ok(Verdict::none(Failure::Endless)),
    }
}
