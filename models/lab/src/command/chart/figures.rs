//! The charts.

use super::methods::Charted;
use super::published::PUBLISHED;
use super::renderers::Rendered;
use super::report::{Report, label};
use crate::chart::{Mark, Scatter, Series, Shape, Strip};
use dvp_cli::method::{Method, Precision, Start};
use dvp_cli::statistics::Quartiles;

/// Lowest error that charts tell apart from none.
const FLOOR: f64 = 1e-6;

/// Mean absolute error against time.
pub(super) fn methods_mae(report: &Report) -> Scatter {
    let fronts = [&report.mae_front[..], &report.given_mae_front];
    let mut chart = methods(report, Charted::mae_point, fronts, |row| row.0, "Mean absolute error");
    if report.floor > FLOOR {
        chart.level = Some(("true scenes".into(), report.floor));
    }
    chart
}

/// 1 - ARI against time.
pub(super) fn methods_ari(report: &Report) -> Scatter {
    let fronts = [&report.ari_front[..], &report.given_ari_front];
    methods(report, Charted::ari_point, fronts, |row| 1.0 - row.1, "1 - adjusted Rand index")
}

fn shape(start: Start) -> Shape {
    match start {
        Start::Image => Shape::Circle,
        Start::Network => Shape::Square,
        Start::Random => Shape::Diamond,
        Start::Scene => Shape::Triangle,
    }
}

fn methods(
    report: &Report,
    point: fn(&Charted) -> (f64, f64),
    fronts: [&[usize]; 2],
    published: fn((f64, f64)) -> f64,
    title: &str,
) -> Scatter {
    let mut series: Vec<Series> = Vec::new();
    for (k, row) in report.rows.iter().enumerate() {
        let pale = row.setting.precision == Precision::F64;
        let on_front = fronts.iter().any(|front| front.contains(&k));
        let mark =
            Mark { at: point(row), spread: spread(row.ms), label: on_front.then(|| label(row.method, row.setting)) };
        let name = row.method.name();
        match series.last_mut() {
            Some(last) if last.name == name && last.pale == pale => last.marks.push(mark),
            _ => series.push(Series {
                color: color(row.method),
                shape: shape(row.method.start()),
                hollow: false,
                pale,
                joined: true,
                marks: vec![mark],
                name,
            }),
        }
    }
    for series in &mut series {
        // A series that is on no front is named where it ends.
        if !series.pale && series.marks.iter().all(|mark| mark.label.is_none()) {
            let name = &series.name;
            if let Some(last) = series.marks.last_mut() {
                last.label = Some(name.clone());
            }
        }
        if series.pale {
            // One name per method in the legend.
            series.name = String::new();
        }
    }
    // Pale marks below the others.
    series.sort_by_key(|series| !series.pale);
    let timed = PUBLISHED.iter().filter_map(|row| Some((row, row.ms?)));
    series.push(Series {
        name: "published, other hardware".into(),
        color: 2,
        shape: Shape::Circle,
        hollow: true,
        pale: false,
        joined: false,
        marks: timed
            .map(|(row, ms)| Mark {
                at: (ms, published((row.mae, row.ari))),
                spread: None,
                label: Some(format!("{} (published)", row.name)),
            })
            .collect(),
    });
    let untimed = PUBLISHED.iter().filter(|row| row.ms.is_none());
    let strip = untimed.map(|row| (row.name.to_owned(), published((row.mae, row.ari)))).collect();
    let steps = |front: &[usize]| front.iter().map(|&k| point(&report.rows[k])).collect();
    Scatter {
        title: format!("{title} against time per image"),
        x: "processor time per image, ms (median, quartiles)".into(),
        y: title.into(),
        floor: FLOOR,
        series,
        fronts: vec![
            ("front, image alone".into(), steps(fronts[0])),
            ("front, given a start".into(), steps(fronts[1])),
        ],
        shapes: [Start::Image, Start::Network, Start::Random, Start::Scene]
            .map(|start| {
                let text = match start {
                    Start::Image => "from the image",
                    Start::Network => "from a network",
                    Start::Random => "from a random start",
                    Start::Scene => "given a start near truth",
                };
                (shape(start), text.into())
            })
            .to_vec(),
        level: None,
        strip: Some(Strip { title: "published,\nother hardware,\nno times given".into(), marks: strip }),
    }
}

fn spread(quartiles: Quartiles) -> Option<(f64, f64)> {
    Some((quartiles.low, quartiles.high))
}

/// Methods of one kind have neighboring colors.
fn color(method: Method) -> usize {
    match method {
        Method::SegmentBank => 0,
        Method::SegmentFree => 6,
        Method::Lm => 1,
        Method::LmContinuation => 3,
        Method::OptP => 4,
        Method::OptIter => 5,
        Method::OptIterPublished => 8,
        Method::Live => 12,
        Method::LivePublished => 13,
        Method::RandOptP => 9,
        Method::RandOptZ => 10,
        Method::Net => 7,
        Method::NetLm => 1,
        Method::NetOptP => 4,
        Method::OptZ => 11,
    }
}

/// Error of renderers against the time of an image; those of tensor operations stand aside, with their times.
pub(super) fn renderers(rows: &[Rendered]) -> Scatter {
    let mut series: Vec<Series> = Vec::new();
    let (aside, rows): (Vec<&Rendered>, Vec<&Rendered>) = rows.iter().partition(|row| row.sweep == "tensor-only");
    for row in rows {
        let kinds = [("vertices", Shape::Circle), ("harmonics", Shape::Square), ("band", Shape::Diamond)];
        let known = kinds.iter().position(|(sweep, _)| *sweep == row.sweep);
        let precision = if row.precision == Precision::F64 { " f64" } else { "" };
        let label = Some(format!("{}{precision}", row.value));
        let mark = Mark { at: (row.forward_ms.median, row.mae), spread: spread(row.forward_ms), label };
        match series.last_mut() {
            Some(last) if last.name == row.sweep => last.marks.push(mark),
            _ => series.push(Series {
                name: row.sweep.into(),
                color: series.len(),
                shape: known.map_or(Shape::Triangle, |k| kinds[k].1),
                hollow: false,
                pale: false,
                joined: known.is_some(),
                marks: vec![mark],
            }),
        }
    }
    let aside = aside.iter().map(|row| (format!("{}, {:.0} ms", row.value, row.forward_ms.median), row.mae));
    Scatter {
        title: "Renderers: error against time of an image".into(),
        x: "processor time from scene to image, ms (median, quartiles)".into(),
        y: "mean absolute difference from the fine image".into(),
        floor: FLOOR,
        series,
        fronts: Vec::new(),
        shapes: Vec::new(),
        level: None,
        strip: Some(Strip { title: "tensor-only,\nby backend:\nfar to the right".into(), marks: aside.collect() }),
    }
}
