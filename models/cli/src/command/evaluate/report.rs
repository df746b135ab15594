//! Means over a data set: a table for people, JSON and CSV for programs.

use comfy_table::{Table, presets};
use dvp_core::metric::MaskOverlap;
use serde::Serialize;

use super::score::Score;

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
    n: usize,
    mae: Option<f64>,
    mse: Option<f64>,
    ssim: Option<f64>,
    /// Of the union masks, pooled over all images.
    iou: Option<f64>,
    ari: Option<f64>,
    /// Share of images with the right number of objects.
    exact_count: Option<f64>,
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
            failed: failed.collect(),
        }
    }

    pub(super) fn table(&self) -> String {
        let mut table = Table::new();
        table.load_style(presets::UTF8_HORIZONTAL_ONLY);
        table.set_header(["MAE", "MSE", "SSIM", "IoU", "ARI", "exact count", "n", "failed"]);
        let figure =
            |value: Option<f64>, digits: usize| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.digits$}"));
        table.add_row([
            figure(self.mae, 6),
            self.mse.map_or_else(|| "-".to_owned(), |v| format!("{v:.2e}")),
            figure(self.ssim, 5),
            figure(self.iou, 5),
            figure(self.ari, 5),
            figure(self.exact_count, 4),
            self.n.to_string(),
            self.failed.len().to_string(),
        ]);
        table.trim_fmt()
    }
}

/// `None` for nothing.
fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let mut count = 0.0;
    let mut total = 0.0;
    for value in values {
        count += 1.0;
        total += value;
    }
    (count > 0.0).then(|| total / count)
}

/// One line per image; empty fields where a figure is not known.
pub(super) fn csv(rows: &[Row]) -> String {
    let mut text = "stem,mae,mse,ssim,iou,ari,true_objects,found_objects,error\n".to_owned();
    for row in rows {
        let stem = quoted(&row.stem);
        let line = match &row.result {
            Err(error) => format!("{stem},,,,,,,,{}\n", quoted(error)),
            Ok(Score { mae, mse, ssim, masks: None }) => format!("{stem},{mae},{mse},{ssim},,,,,\n"),
            Ok(Score { mae, mse, ssim, masks: Some(m) }) => {
                let [iou, ari] = [m.overlap.iou(), m.ari];
                format!("{stem},{mae},{mse},{ssim},{iou},{ari},{},{},\n", m.true_objects, m.found_objects)
            }
        };
        text.push_str(&line);
    }
    text
}

/// As CSV wants it where a text holds separators.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}
