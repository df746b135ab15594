//! `chart`: a tiny one has every method, its front is one, its files are well-formed. Times are not looked at.

use alloc::collections::BTreeSet;
use std::fs;
use std::path::Path;

use dvp::method::Method;
use resvg::usvg::{Options, Tree};
use serde_json::Value;

use crate::rows::{cell, number, rows};
use crate::runner::{Run, dvp, dvp_done, names, text};

#[test]
fn a_tiny_chart_has_everything() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("chart");
    let run = dvp(["chart", "--quick", "--images", "2", "--json", "--machine", "a <test>", "--out", text(&out)]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert_eq!(
        names(&out),
        [
            "index.html",
            "methods.csv",
            "methods_ari.png",
            "methods_ari.svg",
            "methods_mae.png",
            "methods_mae.svg",
            "renderers.csv",
            "renderers.png",
            "renderers.svg",
        ]
    );
    let all = rows(&out.join("methods.csv"));
    every_method_is_sane(&all);
    the_front_is_one(&all);
    renderers_are_sane(&rows(&out.join("renderers.csv")));
    files_are_well_formed(&out);
    let json: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(json["methods"].as_array().unwrap().len(), measured(&all).count());
    assert!(json["budgets"][0].as_str().unwrap().starts_with("0.3 ms buy"), "{}", json["budgets"]);
}

/// Rows that were measured here.
fn measured(all: &[Vec<(String, String)>]) -> impl Iterator<Item = &Vec<(String, String)>> {
    all.iter().filter(|row| cell(row, "hardware") == "this" && cell(row, "method") != "truth")
}

fn every_method_is_sane(all: &[Vec<(String, String)>]) {
    let charted: BTreeSet<&str> = all.iter().map(|row| cell(row, "method")).collect();
    for method in Method::all() {
        assert!(charted.contains(method.name().as_str()), "{charted:?}");
    }
    assert_eq!(all.iter().filter(|row| cell(row, "hardware") == "other").count(), 13, "the published rows");
    for row in measured(all) {
        assert_eq!((cell(row, "images"), cell(row, "failed")), ("2", "0"), "{row:?}");
        assert!((0.0..1.0).contains(&number(row, "mae")) && number(row, "ari") <= 1.0, "{row:?}");
        let times = ["ms_q1", "ms_median", "ms_q3"].map(|name| number(row, name));
        assert!(times[0] > 0.0 && times.is_sorted(), "{row:?}");
        let floor = all.iter().find(|row| cell(row, "method") == "truth").map(|row| number(row, "mae")).unwrap();
        assert!(floor > 0.0 && floor < 1e-3, "the seams of triangles: {floor}");
        if cell(row, "method") == "segment-bank" {
            assert!(number(row, "mae") < 2.0 * floor && number(row, "ari") > 0.99, "{row:?}");
        }
    }
}

fn the_front_is_one(all: &[Vec<(String, String)>]) {
    for (front, error) in [("front_mae", "mae"), ("front_ari", "ari")] {
        for given in [false, true] {
            let rows: Vec<_> =
                measured(all).filter(|row| (cell(row, "starts_from") == "near truth") == given).collect();
            let point = |row: &[(String, String)]| {
                let value = number(row, error);
                (number(row, "ms_median"), if error == "ari" { -value } else { value })
            };
            assert!(rows.iter().any(|row| cell(row, front) == "1"));
            for row in &rows {
                let (time, loss) = point(row);
                // Times in the file are rounded: only what is clearly better counts.
                let beaten = rows.iter().map(|other| point(other)).any(|(t, l)| t < time - 1e-3 && l < loss);
                assert!(!(beaten && cell(row, front) == "1"), "{front}: {row:?}");
            }
        }
    }
}

fn renderers_are_sane(rows: &[Vec<(String, String)>]) {
    let sweep = |name: &str| rows.iter().filter(|row| cell(row, "sweep") == name).collect::<Vec<_>>();
    for name in ["vertices", "harmonics", "band"] {
        let errors: Vec<f64> = sweep(name).iter().map(|row| number(row, "mae")).collect();
        assert!(errors.len() > 4 && errors[0] > 2.0 * errors[errors.len() - 1], "{name}: {errors:?}");
    }
    let painted: BTreeSet<&str> = sweep("renderer").iter().map(|row| cell(row, "value")).collect();
    assert_eq!(painted.into_iter().collect::<Vec<_>>(), ["contour", "exact", "hard", "triangles"]);
    let backends: BTreeSet<&str> = sweep("tensor-only").iter().map(|row| cell(row, "value")).collect();
    let expected = if cfg!(feature = "frameworks") { 3 } else { 1 };
    assert_eq!(backends.len(), expected, "host, burn and candle: {backends:?}");
    for row in rows {
        assert!(number(row, "forward_ms_median") > 0.0 && number(row, "backward_ms_median") > 0.0, "{row:?}");
    }
}

fn files_are_well_formed(out: &Path) {
    let page = fs::read_to_string(out.join("index.html")).unwrap();
    assert_eq!(page.matches("<svg").count(), 3);
    assert!(page.contains("a &lt;test&gt;") && page.contains("dvp chart --out DIR --quick --images 2"));
    assert!(!page.contains("src=") && !page.contains("<link"), "one file alone");
    for name in ["methods_mae", "methods_ari", "renderers"] {
        let svg = fs::read(out.join(format!("{name}.svg"))).unwrap();
        let size = Tree::from_data(&svg, &Options::default()).unwrap().size().to_int_size();
        let png = image::open(out.join(format!("{name}.png"))).unwrap();
        assert_eq!([png.width(), png.height()], [2 * size.width(), 2 * size.height()], "{name}");
    }
}

#[test]
fn what_cannot_be_charted_is_said() {
    let refused = |arguments: &[&str]| -> Run { dvp(["chart", "--out", "nowhere"].iter().chain(arguments).copied()) };
    let run = refused(&["--images", "0"]);
    assert!(run.code == 1 && run.err.contains("--images"), "{}", run.err);
    let folder = tempfile::tempdir().unwrap();
    dvp_done(["generate", "--count", "2", "--out", text(folder.path())]);
    fs::remove_file(folder.path().join("scenes.jsonl")).unwrap();
    let run = refused(&["--data", text(folder.path())]);
    assert!(run.code == 1 && run.err.contains("scenes.jsonl"), "{}", run.err);
}
