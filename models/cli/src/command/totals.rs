//! Means of the scores of many images.

use dvp_core::metric::MaskOverlap;
use serde::Serialize;

use super::score::Score;
use super::statistics::mean;

/// One image of the data set.
pub(super) struct Row {
    pub(super) stem: String,
    pub(super) result: Result<Score, String>,
}

/// An image that was not scored.
#[derive(Debug, Serialize)]
pub(super) struct Failure {
    stem: String,
    error: String,
}

/// The paper's columns.
#[derive(Debug, Serialize)]
pub(super) struct Totals {
    /// Images scored.
    pub(super) n: usize,
    pub(super) mae: Option<f64>,
    pub(super) mse: Option<f64>,
    pub(super) ssim: Option<f64>,
    /// Of the union masks, pooled over all images.
    pub(super) iou: Option<f64>,
    pub(super) ari: Option<f64>,
    /// Share of images with the right number of objects.
    pub(super) exact_count: Option<f64>,
    /// Mean processor time per image of predictions that were made here.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) cpu_ms: Option<f64>,
    pub(super) failed: Vec<Failure>,
}

impl Totals {
    pub(super) fn of(rows: &[Row]) -> Self {
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
