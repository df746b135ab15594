//! Means over images, and what of them is asked for.

use serde_json::{Map, Value, json};

use super::traced::Drawn;
use super::trial::{Contender, Figures, Trial};
use crate::command::report::{Cells, header};
use dvp_cli::statistics::mean;

/// Asked of a method: images of the right count, also of those without objects, and bits in units of the true scene's.
const EXACT: f64 = 0.999;
const EXACT_EMPTY: f64 = 1.0;
pub(super) const MOST_BITS: f64 = 1.2;

/// Means of a method over all images of a set. Of bits, harmonics, shapes, numbers and drawings: over those with objects.
#[derive(Clone, Debug, Default)]
pub(super) struct Summary {
    /// `clean` or `noisy`.
    pub(super) set: &'static str,
    pub(super) method: String,
    pub(super) without: &'static str,
    pub(super) law: &'static str,
    pub(super) images: usize,
    pub(super) failed: Vec<String>,
    /// Share of the images with objects in which as many are found.
    pub(super) exact: Option<f64>,
    /// Share of the images without objects in which none is found.
    pub(super) exact_empty: Option<f64>,
    pub(super) surplus: Option<f64>,
    pub(super) missing: Option<f64>,
    pub(super) painted: Option<f64>,
    pub(super) harmonics: [Option<f64>; 2],
    pub(super) shapes: [Option<f64>; 2],
    pub(super) numbers: [Option<f64>; 2],
    pub(super) bits: [Option<f64>; 2],
    /// Bits in units of those of the true scene: mean, share of images above what is asked, and without shared shapes.
    pub(super) ratio: Option<f64>,
    pub(super) over: Option<f64>,
    pub(super) own_ratio: Option<f64>,
    pub(super) left_bits: [Option<f64>; 2],
    /// Bits with those of what is left, in units of the same for the true scene.
    pub(super) total_ratio: Option<f64>,
    pub(super) mae: Option<f64>,
    pub(super) coordinates: [Option<f64>; 2],
    pub(super) svg_bytes: [Option<f64>; 2],
    pub(super) ms: Option<f64>,
}

type Column = (&'static str, fn(&Summary) -> Option<f64>);

/// The figures, as files name them.
const COLUMNS: [Column; 25] = [
    ("exact_count", |own| own.exact),
    ("exact_count_of_0", |own| own.exact_empty),
    ("surplus", |own| own.surplus),
    ("missing", |own| own.missing),
    ("painted", |own| own.painted),
    ("harmonics", |own| own.harmonics[0]),
    ("true_harmonics", |own| own.harmonics[1]),
    ("shapes", |own| own.shapes[0]),
    ("true_shapes", |own| own.shapes[1]),
    ("numbers", |own| own.numbers[0]),
    ("true_numbers", |own| own.numbers[1]),
    ("bits", |own| own.bits[0]),
    ("true_bits", |own| own.bits[1]),
    ("bits_ratio", |own| own.ratio),
    ("share_above_1.2", |own| own.over),
    ("bits_ratio_shapes_unshared", |own| own.own_ratio),
    ("left_bits", |own| own.left_bits[0]),
    ("true_left_bits", |own| own.left_bits[1]),
    ("bits_and_left_ratio", |own| own.total_ratio),
    ("mae", |own| own.mae),
    ("svg_coordinates", |own| own.coordinates[0]),
    ("true_svg_coordinates", |own| own.coordinates[1]),
    ("svg_bytes", |own| own.svg_bytes[0]),
    ("true_svg_bytes", |own| own.svg_bytes[1]),
    ("cpu_ms", |own| own.ms),
];

#[expect(clippy::cast_precision_loss, reason = "counts of objects, numbers and bytes of small images")]
fn number(count: usize) -> f64 {
    count as f64
}

fn share(of: impl Iterator<Item = bool>) -> Option<f64> {
    mean(of.map(|is| f64::from(u8::from(is))))
}

impl Summary {
    pub(super) fn of(set: &'static str, contender: &Contender, trials: &[Trial]) -> Self {
        let all = || trials.iter().filter_map(|trial| trial.as_ref().ok());
        let some = || all().filter(|own| own.truth.objects > 0);
        let none = || all().filter(|own| own.truth.objects == 0);
        let is_exact = |own: &Figures| own.spent.objects == own.truth.objects;
        let both = |value: &dyn Fn(&Figures) -> [f64; 2]| {
            // A mean over no object is no number.
            [0, 1].map(|k| mean(some().map(|own| value(own)[k]).filter(|value| !value.is_nan())))
        };
        let ratio = |own: &Figures| own.spent.bits / own.truth.bits;
        Self {
            set,
            method: contender.name.clone(),
            without: contender.without,
            law: contender.law.name(),
            images: all().count(),
            failed: trials.iter().filter_map(|trial| trial.as_ref().err().cloned()).collect(),
            exact: share(some().map(is_exact)),
            exact_empty: share(none().map(is_exact)),
            surplus: mean(all().map(|own| number(own.surplus))),
            missing: mean(all().map(|own| number(own.missing))),
            painted: mean(all().map(|own| number(own.painted))),
            harmonics: both(&|own| [own.spent.harmonics, own.truth.harmonics]),
            shapes: both(&|own| [own.spent.shapes, own.truth.shapes].map(number)),
            numbers: both(&|own| [own.spent.numbers, own.truth.numbers].map(number)),
            bits: both(&|own| [own.spent.bits, own.truth.bits]),
            ratio: mean(some().map(ratio)),
            over: share(some().map(|own| ratio(own) > MOST_BITS)),
            own_ratio: mean(some().map(|own| own.spent.bits / own.own_bits)),
            left_bits: both(&|own| [own.left_bits, own.true_left_bits]),
            total_ratio: mean(
                some().map(|own| (own.spent.bits + own.left_bits) / (own.truth.bits + own.true_left_bits)),
            ),
            mae: mean(all().map(|own| own.mae)),
            coordinates: both(&|own| [own.svg, own.true_svg].map(|svg| number(svg.coordinates))),
            svg_bytes: both(&|own| [own.svg, own.true_svg].map(|svg| number(svg.bytes))),
            ms: mean(all().map(|own| own.ms)),
        }
    }

    /// Of the drawings of others, of images with so many objects: the first path is the background.
    pub(super) fn of_drawings(drawings: &[Drawn], objects: &[usize]) -> Self {
        let pairs = || drawings.iter().zip(objects);
        let exact = |(own, objects): (&Drawn, &usize)| own.paths == objects + 1;
        let of = |value: fn(&Drawn) -> usize| mean(pairs().filter(|(_, n)| **n > 0).map(|(own, _)| number(value(own))));
        let apart = |(own, objects): (&Drawn, &usize)| number(own.paths - 1) - number(*objects);
        Self {
            set: "clean",
            method: "vtracer".into(),
            law: "paths",
            images: drawings.len(),
            exact: share(pairs().filter(|(_, n)| **n > 0).map(exact)),
            exact_empty: share(pairs().filter(|(_, n)| **n == 0).map(exact)),
            surplus: mean(pairs().map(|pair| apart(pair).max(0.0))),
            missing: mean(pairs().map(|pair| (-apart(pair)).max(0.0))),
            coordinates: [of(|own| own.coordinates), None],
            svg_bytes: [of(|own| own.bytes), None],
            ..Self::default()
        }
    }

    /// What is asked of a method and not met.
    pub(super) fn misses(&self) -> Vec<String> {
        let low = [("exact count", self.exact, EXACT), ("exact count of 0 objects", self.exact_empty, EXACT_EMPTY)];
        let low = low.into_iter().filter_map(|(what, value, least)| {
            let value = value.filter(|&value| value < least)?;
            Some(format!("{}: {what} {value:.4}, asked: at least {least}", self.method))
        });
        let high = self.ratio.filter(|&ratio| ratio > MOST_BITS).map(|ratio| {
            format!("{}: {ratio:.2} times the bits of the true scene, asked: at most {MOST_BITS}", self.method)
        });
        low.chain(high).collect()
    }

    /// For programs.
    pub(super) fn json(&self) -> Value {
        let mut all: Map<String, Value> =
            COLUMNS.iter().map(|(name, value)| ((*name).to_owned(), json!(value(self)))).collect();
        let names = [("set", self.set), ("method", &self.method), ("without", self.without), ("law", self.law)];
        all.extend(names.map(|(name, value)| (name.to_owned(), json!(value))));
        all.extend([("images".to_owned(), json!(self.images)), ("failed".to_owned(), json!(self.failed))]);
        Value::Object(all)
    }
}

/// A row per summary.
pub(super) fn csv_cells(rows: &[Summary]) -> Cells {
    let names = ["set", "method", "without", "law", "images", "failed"];
    let mut cells = header(names.into_iter().chain(COLUMNS.iter().map(|(name, _)| *name)));
    for own in rows {
        let figure = |(_, value): &Column| value(own).map_or_else(String::new, |value| format!("{value:.6}"));
        let what = [own.set, &own.method, own.without, own.law].map(str::to_owned);
        let counts = [own.images, own.failed.len()].map(|count| count.to_string());
        cells.push(what.into_iter().chain(counts).chain(COLUMNS.iter().map(figure)).collect());
    }
    cells
}

/// The figures of an image and a method, as files name them; before them stand image, method and law, after them the error.
type ImageColumn = (&'static str, fn(&Figures) -> String);

const IMAGE_COLUMNS: [ImageColumn; 20] = [
    ("true_objects", |own| own.truth.objects.to_string()),
    ("objects", |own| own.spent.objects.to_string()),
    ("surplus", |own| own.surplus.to_string()),
    ("missing", |own| own.missing.to_string()),
    ("painted", |own| own.painted.to_string()),
    ("shapes", |own| own.spent.shapes.to_string()),
    ("true_shapes", |own| own.truth.shapes.to_string()),
    ("harmonics", |own| thousandths(own.spent.harmonics)),
    ("true_harmonics", |own| thousandths(own.truth.harmonics)),
    ("numbers", |own| own.spent.numbers.to_string()),
    ("true_numbers", |own| own.truth.numbers.to_string()),
    ("bits", |own| thousandths(own.spent.bits)),
    ("true_bits", |own| thousandths(own.truth.bits)),
    ("bits_ratio", |own| thousandths(own.spent.bits / own.truth.bits)),
    ("unshared_true_bits", |own| thousandths(own.own_bits)),
    ("left_bits", |own| thousandths(own.left_bits)),
    ("true_left_bits", |own| thousandths(own.true_left_bits)),
    ("mae", |own| format!("{:.3e}", own.mae)),
    ("svg_bytes", |own| own.svg.bytes.to_string()),
    ("cpu_ms", |own| thousandths(own.ms)),
];

/// To three digits after the point; nothing if it is no number.
fn thousandths(value: f64) -> String {
    if value.is_nan() { String::new() } else { format!("{value:.3}") }
}

/// A row per image and method.
pub(super) fn image_cells(contenders: &[Contender], stems: &[&str], trials: &[Vec<Trial>]) -> Cells {
    let columns = IMAGE_COLUMNS.iter().map(|(name, _)| *name);
    let mut cells = header(["image", "method", "law"].into_iter().chain(columns).chain(["error"]));
    for (contender, trials) in contenders.iter().zip(trials) {
        for (stem, trial) in stems.iter().zip(trials) {
            let what = [*stem, &contender.name, contender.law.name()].map(str::to_owned);
            let figure = |(_, value): &ImageColumn| trial.as_ref().map_or_else(|_| String::new(), value);
            let error = trial.as_ref().err().cloned().unwrap_or_default();
            cells.push(what.into_iter().chain(IMAGE_COLUMNS.iter().map(figure)).chain([error]).collect());
        }
    }
    cells
}

/// Cells for people, the header first: `found (true)` where both are known.
pub(super) fn cells(rows: &[Summary]) -> Cells {
    let names = [
        "method",
        "shapes by",
        "count",
        "of 0",
        "surplus",
        "missing",
        "painted",
        "harmonics",
        "shapes",
        "numbers",
        "bits",
        "bits/true",
        "above 1.2",
        "unshared",
        "with rest",
        "MAE",
        "SVG numbers",
        "SVG bytes",
    ];
    let row = |own: &Summary| {
        vec![
            own.method.clone(),
            own.law.to_owned(),
            figure(own.exact, 4),
            figure(own.exact_empty, 4),
            figure(own.surplus, 3),
            figure(own.missing, 3),
            figure(own.painted, 2),
            beside(own.harmonics, 1),
            beside(own.shapes, 2),
            beside(own.numbers, 1),
            beside(own.bits, 0),
            figure(own.ratio, 3),
            figure(own.over, 3),
            figure(own.own_ratio, 3),
            figure(own.total_ratio, 3),
            error(own.mae),
            beside(own.coordinates, 0),
            beside(own.svg_bytes, 0),
        ]
    };
    header(names).into_iter().chain(rows.iter().map(row)).collect()
}

/// Cells of what prices are good for.
pub(super) fn price_cells(rows: &[Summary]) -> Cells {
    let names = [
        "pictures",
        "method",
        "without",
        "count",
        "of 0",
        "surplus",
        "missing",
        "harmonics",
        "bits",
        "bits/true",
        "with rest",
        "MAE",
        "ms",
    ];
    let row = |own: &Summary| {
        vec![
            own.set.to_owned(),
            own.method.clone(),
            own.without.to_owned(),
            figure(own.exact, 4),
            figure(own.exact_empty, 4),
            figure(own.surplus, 3),
            figure(own.missing, 3),
            beside(own.harmonics, 1),
            beside(own.bits, 0),
            figure(own.ratio, 3),
            figure(own.total_ratio, 3),
            error(own.mae),
            figure(own.ms, 1),
        ]
    };
    header(names).into_iter().chain(rows.iter().map(row)).collect()
}

fn figure(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.digits$}"))
}

fn error(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), |value| format!("{value:.2e}"))
}

fn beside([found, truth]: [Option<f64>; 2], digits: usize) -> String {
    let truth = truth.map_or_else(String::new, |truth| format!(" ({truth:.digits$})"));
    figure(found, digits) + &truth
}
