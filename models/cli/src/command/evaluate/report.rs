//! What an evaluation tells: a table for people, CSV for programs.

use comfy_table::{Table, presets};

use crate::score::{Row, Score, Totals};

/// The means in the paper's columns.
pub(super) fn table(totals: &Totals) -> String {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    let figure = |value: Option<f64>, digits: usize| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.digits$}"));
    let mut columns = vec![
        ("MAE", figure(totals.mae, 6)),
        ("MSE", totals.mse.map_or_else(|| "-".to_owned(), |v| format!("{v:.2e}"))),
        ("SSIM", figure(totals.ssim, 5)),
        ("IoU", figure(totals.iou, 5)),
        ("ARI", figure(totals.ari, 5)),
        ("exact count", figure(totals.exact_count, 4)),
        ("n", totals.n.to_string()),
        ("failed", totals.failed.len().to_string()),
    ];
    columns.extend(totals.cpu_ms.map(|ms| ("CPU ms", format!("{ms:.1}"))));
    table.set_header(columns.iter().map(|(name, _)| *name));
    table.add_row(columns.into_iter().map(|(_, value)| value));
    table.trim_fmt()
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
