//! The measures of the field's benchmarks over many pictures.

use dvp_core::matching::MatchingError;
use serde::Serialize;

use super::classes::Confusion;
use super::objects::{ObjectScore, Share};
use crate::statistics::mean;

/// Columns of the field's benchmarks. None where nothing is known.
#[derive(Clone, Debug, Serialize)]
pub struct ObjectTotals {
    /// Pictures scored.
    pub n: usize,
    /// Adjusted Rand index of the pixels of true objects, mean over the pictures.
    pub ari_foreground: Option<f64>,
    /// Adjusted Rand index of all pixels, mean over the pictures.
    pub ari: Option<f64>,
    /// Share of pictures with the right number of objects.
    pub exact_count: Option<f64>,
    /// Share of pairs of overlapping objects whose order is right, weighted; over all pictures.
    pub order: Option<f64>,
    /// Of whole objects, mean over those of all pictures.
    pub iou: Option<f64>,
    /// Of whole objects, mean over those of all pictures.
    pub f1: Option<f64>,
    /// Mean accuracy of the classes, over the pixels of all pictures.
    pub class_accuracy: Option<f64>,
}

impl ObjectTotals {
    /// Those of `scores`.
    ///
    /// # Errors
    /// [`MatchingError`], which counts of pixels do not bring about.
    pub fn of<'a>(scores: impl Iterator<Item = &'a ObjectScore> + Clone) -> Result<Self, MatchingError> {
        let pooled = |share: fn(&ObjectScore) -> Share| {
            let mut sum = Share::default();
            scores.clone().for_each(|score| sum.add(share(score)));
            sum.mean()
        };
        let mut classes = Confusion::default();
        scores.clone().for_each(|score| classes.merge(&score.classes));
        Ok(Self {
            n: scores.clone().count(),
            ari_foreground: mean(scores.clone().map(|score| score.ari_foreground)),
            ari: mean(scores.clone().map(|score| score.ari)),
            exact_count: mean(
                scores.clone().map(|score| f64::from(u8::from(score.true_objects == score.found_objects))),
            ),
            order: pooled(|score| score.order),
            iou: pooled(|score| score.iou),
            f1: pooled(|score| score.f1),
            class_accuracy: classes.mean_accuracy()?,
        })
    }
}
