//! Means of the scores of many images.

use dvp_core::metric::MaskOverlap;
use serde::Serialize;

use super::Score;
use crate::statistics::mean;

/// One image of the data set.
#[derive(Clone, Debug)]
pub struct Row {
    /// Its name.
    pub stem: String,
    /// Its scores, or why there are none.
    pub result: Result<Score, String>,
}

/// An image that was not scored.
#[derive(Clone, Debug, Serialize)]
pub struct Failure {
    /// Its name.
    pub stem: String,
    /// Why.
    pub error: String,
}

/// The paper's columns: means over the images that were scored. None where nothing is known.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Totals {
    /// Images scored.
    pub n: usize,
    /// Mean absolute error.
    pub mae: Option<f64>,
    /// Mean squared error.
    pub mse: Option<f64>,
    /// Structural similarity.
    pub ssim: Option<f64>,
    /// Of the union masks, pooled over all images.
    pub iou: Option<f64>,
    /// Adjusted Rand index.
    pub ari: Option<f64>,
    /// Share of images with the right number of objects.
    pub exact_count: Option<f64>,
    /// Mean processor time per image of predictions that were made here.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cpu_ms: Option<f64>,
    /// Images that were not scored.
    pub failed: Vec<Failure>,
}

impl Totals {
    /// Those of the images `rows`.
    #[must_use]
    pub fn of(rows: &[Row]) -> Self {
        let scores = || rows.iter().filter_map(|row| row.result.as_ref().ok());
        let masks = || scores().filter_map(|score| score.masks.as_ref());
        let mut pooled = MaskOverlap::default();
        masks().for_each(|mask| pooled.merge(&mask.overlap));
        let failed = rows.iter().filter_map(|row| {
            row.result.as_ref().err().map(|error| Failure { stem: row.stem.clone(), error: error.clone() })
        });
        Self {
            n: scores().count(),
            mae: mean(scores().map(|score| score.mae)),
            mse: mean(scores().map(|score| score.mse)),
            ssim: mean(scores().map(|score| score.ssim)),
            iou: masks().next().map(|_| pooled.iou()),
            ari: mean(masks().map(|mask| mask.ari)),
            exact_count: mean(masks().map(|mask| f64::from(u8::from(mask.true_objects == mask.found_objects)))),
            cpu_ms: mean(scores().filter_map(|score| score.cpu_ms)),
            failed: failed.collect(),
        }
    }
}
