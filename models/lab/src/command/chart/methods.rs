//! Methods, run by turns on every image.

use alloc::sync::Arc;

use anyhow::Result;
use dvp_fit::{Bank, FitOptions};
use dvp_net::propose::Proposer;

use crate::command::pictures::Picture;
use dvp_cli::command::in_words;
use dvp_cli::command::progress;
use dvp_cli::method::{Memory, Method, Runner, Setting, Task, Tools, seed_of};
use dvp_cli::paint::Painter;
use dvp_cli::score::{Row, Totals};
use dvp_cli::score::{Score, Scratch, Truth, score};
use dvp_cli::statistics::Quartiles;

/// What a method did on all images.
pub(super) struct Charted {
    pub(super) method: Method,
    pub(super) setting: Setting,
    /// Means; images on which it failed are in no mean.
    pub(super) totals: Totals,
    /// Per image.
    pub(super) mae: Quartiles,
    /// Processor time per image.
    pub(super) ms: Quartiles,
}

impl Charted {
    /// Median time (ms) and mean absolute error; NaN if no image was scored.
    pub(super) fn mae_point(&self) -> (f64, f64) {
        (self.ms.median, self.totals.mae.unwrap_or(f64::NAN))
    }

    /// Median time (ms) and 1 - ARI.
    pub(super) fn ari_point(&self) -> (f64, f64) {
        (self.ms.median, self.totals.ari.map_or(f64::NAN, |ari| 1.0 - ari))
    }
}

/// Runs every method on every picture on this thread, each picture starting with another method: whatever slows the
/// machine down for a while hurts all alike. Each method sees the first picture twice; the first time is not counted, it
/// makes memory.
pub(super) fn run(
    settings: &[(Method, Setting)],
    pictures: &[Picture],
    bank: Bank<f32>,
    network: Proposer,
    seed: u64,
) -> Result<Vec<Charted>> {
    let options = FitOptions::default().with_bank(Some(bank));
    let tools = Tools { options, network: Some(Arc::new(network)) };
    let new = |&(method, setting): &(Method, Setting)| Runner::new(method, setting, &tools);
    let runners: Vec<Runner> = settings.iter().map(new).collect::<Result<_, _>>()?;
    let mut rows: Vec<Vec<Row>> = runners.iter().map(|_| Vec::with_capacity(pictures.len())).collect();
    let mut scratch = (Scratch::default(), Memory::default());
    if let Some(first) = pictures.first() {
        for runner in &runners {
            // What fails here fails again below, and is counted there.
            let _ = try_one(runner, first, seed, &mut scratch);
        }
    }
    let bar = progress::bar(pictures.len() as u64, 0);
    for (turn, picture) in pictures.iter().enumerate() {
        for k in 0..runners.len() {
            let k = (k + turn) % runners.len();
            let result = try_one(&runners[k], picture, seed, &mut scratch).map_err(|error| in_words(&error));
            rows[k].push(Row { stem: picture.stem.clone(), result });
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    let charted = settings.iter().zip(&rows).map(|(&(method, setting), rows)| {
        let of = |value: fn(&Score) -> Option<f64>| {
            Quartiles::of(rows.iter().filter_map(|row| row.result.as_ref().ok()).filter_map(value).collect())
        };
        let (mae, ms) = (of(|score| Some(score.mae)), of(|score| score.cpu_ms));
        Charted { method, setting, totals: Totals::of(rows), mae, ms }
    });
    Ok(charted.collect())
}

fn try_one(runner: &Runner, picture: &Picture, seed: u64, memory: &mut (Scratch, Memory)) -> Result<Score> {
    let (scratch, memory) = memory;
    let (image, truth) = (picture.image.view(), &picture.truth);
    let task = Task { truth: Some(truth), seed: seed_of(&picture.stem, seed), ..Task::of(image) };
    let found = runner.run(&task, memory)?;
    let scenes = [&found.fit.scene, &found.there];
    let mut score = score(&Painter::default(), image, Some(&Truth::Scene(truth)), scenes, scratch)?;
    score.cpu_ms = Some(found.cpu.as_secs_f64() * 1e3);
    Ok(score)
}
