//! Rows with their place on the fronts: CSV, JSON, a table, and what a budget buys.

use serde_json::{Value, json};

use super::methods::Charted;
use super::pareto::{front, within};
use super::published::PUBLISHED;
use super::renderers::Rendered;
use crate::command::report::{Cells, header, text_table};
use dvp_cli::method::{Method, Precision, Setting, Start};

/// Budgets per image that are answered, ms.
const BUDGETS_MS: [f64; 5] = [0.3, 1.2, 5.0, 25.0, 100.0];

/// All methods; those that were given a start near the truth have fronts of their own.
pub(super) struct Report {
    pub(super) rows: Vec<Charted>,
    /// Mean absolute error of the true scenes.
    pub(super) floor: f64,
    /// By mean absolute error, of what starts from the image alone; indices into the rows, by time.
    pub(super) mae_front: Vec<usize>,
    /// By 1 - ARI.
    pub(super) ari_front: Vec<usize>,
    /// By mean absolute error, of what was given a start.
    pub(super) given_mae_front: Vec<usize>,
    /// By 1 - ARI.
    pub(super) given_ari_front: Vec<usize>,
}

/// A method and its steps, as people read it.
pub(super) fn label(method: Method, setting: Setting) -> String {
    let steps = if method == Method::Net { String::new() } else { format!(" {}", setting.steps) };
    let precision = if setting.precision == Precision::F64 { " f64" } else { "" };
    format!("{}{steps}{precision}", method.name())
}

fn precision_name(precision: Precision) -> &'static str {
    match precision {
        Precision::F32 => "f32",
        Precision::F64 => "f64",
    }
}

fn start_name(start: Start) -> &'static str {
    match start {
        Start::Image => "image",
        Start::Scene => "near truth",
        Start::Random => "random",
        Start::Network => "network",
    }
}

impl Report {
    pub(super) fn of(rows: Vec<Charted>, floor: f64) -> Self {
        let front_of = |given: bool, point: fn(&Charted) -> (f64, f64)| {
            let points: Vec<(f64, f64)> = rows
                .iter()
                .map(|row| if (row.method.start() == Start::Scene) == given { point(row) } else { (f64::NAN, 0.0) })
                .collect();
            front(&points)
        };
        let [mae_front, given_mae_front] = [false, true].map(|given| front_of(given, Charted::mae_point));
        let [ari_front, given_ari_front] = [false, true].map(|given| front_of(given, Charted::ari_point));
        Self { rows, floor, mae_front, ari_front, given_mae_front, given_ari_front }
    }

    /// Images on which some method failed, counted once for each.
    pub(super) fn failed(&self) -> usize {
        self.rows.iter().map(|row| row.totals.failed.len()).sum()
    }

    /// Which fronts a row is on: by MAE, by ARI.
    fn fronts(&self, k: usize) -> [bool; 2] {
        [[&self.mae_front, &self.given_mae_front], [&self.ari_front, &self.given_ari_front]]
            .map(|fronts| fronts.iter().any(|front| front.contains(&k)))
    }

    /// A row per method and setting; then those of the true scenes and of what was published, with a time where one was measured.
    pub(super) fn csv_cells(&self) -> Cells {
        let mut cells = header([
            "method",
            "steps",
            "steps_are",
            "precision",
            "starts_from",
            "hardware",
            "images",
            "failed",
            "mae",
            "mae_q1",
            "mae_median",
            "mae_q3",
            "mse",
            "ssim",
            "iou",
            "ari",
            "exact_count",
            "ms_q1",
            "ms_median",
            "ms_q3",
            "front_mae",
            "front_ari",
        ]);
        let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.6e}"));
        for (k, row) in self.rows.iter().enumerate() {
            let Charted { method, setting, totals, mae, ms } = row;
            let what = [
                method.name(),
                setting.steps.to_string(),
                method.steps_are().to_owned(),
                precision_name(setting.precision).to_owned(),
                start_name(method.start()).to_owned(),
                "this".to_owned(),
                totals.n.to_string(),
                totals.failed.len().to_string(),
            ];
            let scores = [totals.mae, Some(mae.low), Some(mae.median), Some(mae.high), totals.mse, totals.ssim];
            let masks = [totals.iou, totals.ari, totals.exact_count];
            let times = [ms.low, ms.median, ms.high].map(|ms| format!("{ms:.4}"));
            let fronts = self.fronts(k).map(|is_on| u8::from(is_on).to_string());
            let figures = scores.into_iter().chain(masks).map(number);
            cells.push(what.into_iter().chain(figures).chain(times).chain(fronts).collect());
        }
        // Of what was not measured here little is known.
        let mut known = |values: &[(&str, String)]| {
            let value = |name: &String| values.iter().find(|(own, _)| own == name).map(|(_, value)| value.clone());
            let row = cells[0].iter().map(|name| value(name).unwrap_or_default()).collect();
            cells.push(row);
        };
        known(&[
            ("method", "truth".into()),
            ("precision", "f32".into()),
            ("starts_from", "truth".into()),
            ("hardware", "this".into()),
            ("mae", format!("{:.6e}", self.floor)),
        ]);
        for row in &PUBLISHED {
            known(&[
                ("method", format!("published {}", row.name)),
                ("hardware", "other".into()),
                ("mae", row.mae.to_string()),
                ("mse", row.mse.to_string()),
                ("ssim", row.ssim.to_string()),
                ("iou", row.iou.to_string()),
                ("ari", row.ari.to_string()),
                ("ms_median", row.ms.map_or_else(String::new, |ms| ms.to_string())),
            ]);
        }
        cells
    }

    /// What a budget buys from the image alone, and from a start near the truth; what cannot be bought.
    pub(super) fn budgets(&self) -> Vec<String> {
        let points: Vec<(f64, f64)> = self.rows.iter().map(Charted::mae_point).collect();
        let bought = |front: &[usize], budget: f64| match within(&points, front, budget) {
            Some(k) => {
                let row = &self.rows[k];
                let ari = row.totals.ari.unwrap_or(f64::NAN);
                let name = label(row.method, row.setting);
                format!("{name} (MAE {:.2e}, ARI {ari:.4}, {:.2} ms)", points[k].1, points[k].0)
            }
            None => match front.first() {
                Some(&k) => format!("nothing: the fastest is {}, {:.2} ms", self.name(k), points[k].0),
                None => "nothing".to_owned(),
            },
        };
        let line = |budget: f64| {
            let alone = bought(&self.mae_front, budget);
            format!("{budget} ms buy: {alone}; from a start near the truth: {}", bought(&self.given_mae_front, budget))
        };
        let floor = format!("the true scenes, painted as methods paint theirs: MAE {:.2e}", self.floor);
        BUDGETS_MS.into_iter().map(line).chain([floor]).collect()
    }

    pub(super) fn name(&self, k: usize) -> String {
        label(self.rows[k].method, self.rows[k].setting)
    }

    /// The cells of a table, with its header.
    pub(super) fn cells(&self) -> Cells {
        let names = ["method", "starts from", "MAE", "SSIM", "IoU", "ARI", "count", "ms median", "quartiles", "front"];
        let mut cells = header(names);
        let figure = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.4}"));
        for (k, row) in self.rows.iter().enumerate() {
            let Charted { method, totals, ms, .. } = row;
            let fronts = match self.fronts(k) {
                [true, true] => "MAE, ARI",
                [true, false] => "MAE",
                [false, true] => "ARI",
                [false, false] => "",
            };
            cells.push(vec![
                self.name(k),
                start_name(method.start()).to_owned(),
                totals.mae.map_or_else(|| "-".to_owned(), |mae| format!("{mae:.2e}")),
                figure(totals.ssim),
                figure(totals.iou),
                figure(totals.ari),
                figure(totals.exact_count),
                format!("{:.2}", ms.median),
                format!("{:.2} - {:.2}", ms.low, ms.high),
                fronts.to_owned(),
            ]);
        }
        cells
    }

    pub(super) fn table(&self) -> String {
        text_table(self.cells())
    }
}

/// A row per renderer.
pub(super) fn renderer_cells(rows: &[Rendered]) -> Cells {
    let mut cells = header([
        "sweep",
        "value",
        "precision",
        "images",
        "mae",
        "forward_ms_q1",
        "forward_ms_median",
        "forward_ms_q3",
        "backward_ms_q1",
        "backward_ms_median",
        "backward_ms_q3",
    ]);
    for Rendered { sweep, value, precision, mae, forward_ms, backward_ms, n } in rows {
        let precision = precision_name(*precision).to_owned();
        let what = [(*sweep).to_owned(), value.to_string(), precision, n.to_string(), format!("{mae:.6e}")];
        let times = [forward_ms, backward_ms].into_iter().flat_map(|ms| [ms.low, ms.median, ms.high]);
        cells.push(what.into_iter().chain(times.map(|ms| format!("{ms:.5}"))).collect());
    }
    cells
}

/// Everything, for programs.
pub(super) fn json(report: &Report, renderers: &[Rendered]) -> Value {
    let method = |(k, row): (usize, &Charted)| {
        let [front_mae, front_ari] = report.fronts(k);
        json!({
            "method": row.method.name(), "steps": row.setting.steps, "steps_are": row.method.steps_are(),
            "precision": precision_name(row.setting.precision), "starts_from": start_name(row.method.start()),
            "scores": row.totals, "mae": row.mae, "ms": row.ms, "front_mae": front_mae, "front_ari": front_ari,
        })
    };
    let rendered = |row: &Rendered| {
        json!({
            "sweep": row.sweep, "value": row.value, "precision": precision_name(row.precision), "images": row.n,
            "mae": row.mae, "forward_ms": row.forward_ms, "backward_ms": row.backward_ms,
        })
    };
    let published = PUBLISHED.iter().map(|row| {
        json!({
            "name": row.name, "mae": row.mae, "mse": row.mse, "ssim": row.ssim, "iou": row.iou, "ari": row.ari, "ms": row.ms,
        })
    });
    json!({
        "methods": report.rows.iter().enumerate().map(method).collect::<Vec<_>>(),
        "renderers": renderers.iter().map(rendered).collect::<Vec<_>>(),
        "published": published.collect::<Vec<_>>(),
        "budgets": report.budgets(), "floor_mae": report.floor,
    })
}
