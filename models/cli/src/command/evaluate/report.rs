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
    /// Mean processor time per image of predictions that were made here.
    #[serde(skip_serializing_if = "Option::is_none")]
    cpu_ms: Option<f64>,
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

    pub(super) fn table(&self) -> String {
        let mut table = Table::new();
        table.load_style(presets::UTF8_HORIZONTAL_ONLY);
        let figure =
            |value: Option<f64>, digits: usize| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.digits$}"));
        let mut columns = vec![
            ("MAE", figure(self.mae, 6)),
            ("MSE", self.mse.map_or_else(|| "-".to_owned(), |v| format!("{v:.2e}"))),
            ("SSIM", figure(self.ssim, 5)),
            ("IoU", figure(self.iou, 5)),
            ("ARI", figure(self.ari, 5)),
            ("exact count", figure(self.exact_count, 4)),
            ("n", self.n.to_string()),
            ("failed", self.failed.len().to_string()),
        ];
        columns.extend(self.cpu_ms.map(|ms| ("CPU ms", format!("{ms:.1}"))));
        table.set_header(columns.iter().map(|(name, _)| *name));
        table.add_row(columns.into_iter().map(|(_, value)| value));
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

/// One line per image; empty fields where a figure is not known. Times, if predictions were made here, stand last.
pub(super) fn csv(rows: &[Row]) -> String {
    let timed = rows.iter().any(|row| row.result.as_ref().is_ok_and(|score| score.cpu_ms.is_some()));
    let mut text = "stem,mae,mse,ssim,iou,ari,true_objects,found_objects,error".to_owned();
    text.push_str(if timed { ",cpu_ms\n" } else { "\n" });
    for row in rows {
        let stem = quoted(&row.stem);
        let line = match &row.result {
            Err(error) => format!("{stem},,,,,,,,{}", quoted(error)),
            Ok(Score { mae, mse, ssim, masks: None, .. }) => format!("{stem},{mae},{mse},{ssim},,,,,"),
            Ok(Score { mae, mse, ssim, masks: Some(m), .. }) => {
                let [iou, ari] = [m.overlap.iou(), m.ari];
                format!("{stem},{mae},{mse},{ssim},{iou},{ari},{},{},", m.true_objects, m.found_objects)
            }
        };
        text.push_str(&line);
        if timed {
            let cpu_ms = row.result.as_ref().ok().and_then(|score| score.cpu_ms);
            text.push_str(&cpu_ms.map_or_else(|| ",".to_owned(), |ms| format!(",{ms}")));
        }
        text.push('\n');
    }
    text
}

/// As CSV wants it where a text holds separators.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}
