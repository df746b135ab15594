//! The chart: bits in units of the true scene's, by how much the true scene costs.

use super::spent::Law;
use super::summary::MOST_BITS;
use super::trial::{Contender, Trial};
use crate::chart::{Mark, Scatter, Series, Shape};
use dvp_cli::statistics::{Quartiles, mean};

/// Ratios below this are drawn there.
const FLOOR: f64 = 0.1;

/// A mark per method and number of true objects, at the means.
pub(super) fn chart(contenders: &[Contender], trials: &[Vec<Trial>]) -> Scatter {
    let series = contenders.iter().zip(trials).enumerate().map(|(color, (contender, trials))| Series {
        name: contender.name.clone(),
        color,
        shape: shape(contender.law),
        hollow: false,
        pale: false,
        joined: true,
        marks: marks(&contender.name, trials),
    });
    Scatter {
        title: "Bits spent, in units of the true scene's".into(),
        x: "bits of the true scene by the same law (mean and quartiles, by number of objects)".into(),
        y: "bits spent / bits of the true scene (mean)".into(),
        floor: FLOOR,
        series: series.collect(),
        fronts: Vec::new(),
        shapes: [Law::Bank, Law::Free].map(|law| (shape(law), text(law).into())).to_vec(),
        level: Some((format!("asked: at most {MOST_BITS}"), MOST_BITS)),
        strip: None,
    }
}

fn shape(law: Law) -> Shape {
    match law {
        Law::Bank => Shape::Circle,
        Law::Free => Shape::Square,
    }
}

fn text(law: Law) -> &'static str {
    match law {
        Law::Bank => "shapes of a bank",
        Law::Free => "shapes written out",
    }
}

fn marks(name: &str, trials: &[Trial]) -> Vec<Mark> {
    let all = || trials.iter().filter_map(|trial| trial.as_ref().ok());
    let most = all().map(|own| own.truth.objects).max().unwrap_or(0);
    let mark = |objects: usize| {
        let alike = || all().filter(move |own| own.truth.objects == objects);
        let truth = || alike().map(|own| own.truth.bits);
        let Quartiles { low, high, .. } = Quartiles::of(truth().collect());
        let ratio = mean(alike().map(|own| own.spent.bits / own.truth.bits))?;
        let label = (objects == most).then(|| name.to_owned());
        Some(Mark { at: (mean(truth())?, ratio), spread: Some((low, high)), label })
    };
    (1..=most).filter_map(mark).collect()
}
