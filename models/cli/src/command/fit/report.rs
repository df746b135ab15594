//! What a fit tells: JSON for programs, a table for people.

use comfy_table::{Table, presets};
use dvp_core::render::{EdgeLaw, EdgeProfile};
use dvp_core::{ImageSize, Real};
use dvp_fit::Fit;
use serde::Serialize;

use crate::export::MeasuredPicture;
use crate::format::{DoubtJson, INVISIBLE, ObjectKnownJson, Picture, SceneKnownJson, StopJson};
use crate::statistics::{mean, quantile};

/// Tables of more pictures than this show the summary only.
const MOST_ROWS: usize = 25;

/// What came of one picture.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    pub(super) path: String,
    /// What tables and data sets call the picture that its objects are on.
    #[serde(skip)]
    pub(super) picture: String,
    pub(super) stem: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) error: Option<String>,
    #[serde(flatten)]
    pub(super) found: Option<FoundScene>,
}

/// The figures of a fit.
#[derive(Debug, Serialize)]
pub(super) struct FoundScene {
    objects: usize,
    /// Whether the picture lets through what is behind: the color of the background is none of its own.
    transparent: bool,
    /// Mean absolute error of the reconstruction against the picture.
    mae: f32,
    /// Processor time of the fit alone.
    cpu_ms: f64,
    steps: usize,
    edge: EdgeReport,
    /// What STEM.json says of the scene as a whole.
    #[serde(flatten)]
    known: SceneKnownJson,
    /// What STEM.json says of each object.
    #[serde(rename = "known")]
    objects_known: Vec<ObjectKnownJson>,
    /// Objects by falling marginal gain.
    ranking: Vec<usize>,
    /// Per object, row by row: covariance of (x, y, log scale, rotation, log stretch).
    covariance: Vec<[f32; 25]>,
    /// What goes into the files of all pictures.
    #[serde(skip)]
    pub(super) measured: Option<MeasuredPicture>,
}

/// The edges of the picture.
#[derive(Debug, Serialize)]
struct EdgeReport {
    /// `reference`, `squared`, `area`, `hard` or `blur`.
    kind: &'static str,
    /// Pixels in which coverage falls from 0.9 to 0.1.
    width_px: f32,
}

/// Hard edges are narrower, px.
const HARD_PX: f32 = 0.2;

/// Figures over all pictures that were fitted.
#[derive(Debug, Serialize)]
pub(super) struct Summary {
    images: usize,
    failed: usize,
    objects: usize,
    mae: f64,
    /// Mean over the pictures that tell it.
    unexplained: Option<f64>,
    cpu_ms_median: f64,
    cpu_ms_p95: f64,
}

impl FoundScene {
    pub(super) fn new(fit: &Fit<f32>, picture: &Picture<f32>, cpu_ms: f64) -> Self {
        Self {
            objects: fit.scene.objects.len(),
            transparent: picture.transparent,
            mae: fit.loss,
            cpu_ms,
            steps: fit.steps,
            edge: EdgeReport::of(&fit.scene.edge, picture.image.size()),
            known: SceneKnownJson::of(fit, picture.visible),
            objects_known: ObjectKnownJson::of(fit),
            ranking: fit.ranking(),
            covariance: fit.covariance.clone(),
            measured: None,
        }
    }

    fn is_invisible(&self) -> bool {
        self.known.doubts.iter().any(|doubt| doubt == INVISIBLE)
    }

    /// Why there is no more in the scene than there is: why the fit stopped, or that there was nothing to see.
    fn stop(&self) -> String {
        if self.is_invisible() { INVISIBLE.to_owned() } else { self.known.stop.to_string() }
    }

    /// How many objects are guessed in part, and how much of the outline most.
    fn hidden(&self) -> String {
        let doubts = self.objects_known.iter().flat_map(|known| &known.doubts);
        let shares = doubts.filter_map(|doubt| match *doubt {
            DoubtJson::Hidden { share, .. } => Some(share),
            _ => None,
        });
        let (count, most) = shares.fold((0, 0.0_f64), |(count, most), share| (count + 1, most.max(share)));
        if count == 0 { String::new() } else { format!("{count}, to {:.0} %", 100.0 * most) }
    }
}

impl EdgeReport {
    fn of(edge: &EdgeProfile<f32>, size: ImageSize) -> Self {
        let profile = edge.in_pixels(f32::of_usize(size.unit_px()));
        let width_px = profile.distance(0.1) - profile.distance(0.9);
        let kind = match edge.law {
            EdgeLaw::Area => "area",
            EdgeLaw::Distance if width_px < HARD_PX => "hard",
            EdgeLaw::Distance => "blur",
            EdgeLaw::SquaredDistance if *edge == EdgeProfile::reference() => "reference",
            EdgeLaw::SquaredDistance => "squared",
        };
        Self { kind, width_px }
    }
}

impl Summary {
    pub(super) fn of(reports: &[Report]) -> Self {
        let found = || reports.iter().filter_map(|report| report.found.as_ref());
        let count = found().count();
        let mut times: Vec<f64> = found().map(|found| found.cpu_ms).collect();
        times.sort_by(f64::total_cmp);
        Self {
            images: count,
            failed: reports.len() - count,
            objects: found().map(|found| found.objects).sum(),
            mae: mean(found().map(|found| f64::from(found.mae))).unwrap_or(0.0),
            unexplained: mean(found().filter_map(|found| found.known.unexplained)),
            cpu_ms_median: quantile(&times, 50),
            cpu_ms_p95: quantile(&times, 95),
        }
    }
}

/// A share as percent; a dash for none.
fn percent(share: Option<f64>) -> String {
    share.map_or_else(|| "-".to_owned(), |share| format!("{:.2} %", 100.0 * share))
}

/// Pictures and summary as one JSON text.
pub(super) fn json(reports: &[Report]) -> serde_json::Result<String> {
    #[derive(Serialize)]
    struct All<'a> {
        images: &'a [Report],
        summary: Summary,
    }
    serde_json::to_string_pretty(&All { images: reports, summary: Summary::of(reports) })
}

/// A table of the pictures, if they are few, and the summary.
pub(super) fn table(reports: &[Report]) -> String {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header(["picture", "objects", "MAE", "unexplained", "CPU ms", "steps", "stop", "edge", "hidden"]);
    let summary = Summary::of(reports);
    if reports.len() <= MOST_ROWS {
        for report in reports {
            match &report.found {
                Some(found) => table.add_row([
                    report.path.clone(),
                    found.objects.to_string(),
                    format!("{:.5}", found.mae),
                    percent(found.known.unexplained),
                    format!("{:.2}", found.cpu_ms),
                    found.steps.to_string(),
                    found.stop(),
                    format!("{} {:.1} px", found.edge.kind, found.edge.width_px),
                    found.hidden(),
                ]),
                None => table.add_row([report.path.as_str(), "failed"]),
            };
        }
    }
    if reports.len() != 1 {
        table.add_row([
            format!("all {}", summary.images),
            summary.objects.to_string(),
            format!("{:.5}", summary.mae),
            percent(summary.unexplained),
            format!("{:.2} (p95 {:.2})", summary.cpu_ms_median, summary.cpu_ms_p95),
        ]);
    }
    let count =
        |is: &dyn Fn(&FoundScene) -> bool| reports.iter().filter_map(|r| r.found.as_ref()).filter(|f| is(f)).count();
    let remarks = [
        (summary.failed, "failed"),
        (
            count(&|found| found.known.stop == StopJson::NoBetterThanFlat),
            "no better than one flat color, which is their scene",
        ),
        (count(&FoundScene::is_invisible), "transparent everywhere: nothing is visible"),
    ];
    let remarks = remarks.into_iter().filter(|(count, _)| *count > 0);
    let remarks: String = remarks.map(|(count, remark)| format!("\n{count} {remark}")).collect();
    format!("{}{remarks}", table.trim_fmt())
}
