//! `parsimony`: a tiny one counts what it should, its files are well-formed; the drawings of others stand beside ours.

use std::fs;

use resvg::usvg::{Options, Tree};
use serde_json::Value;

use crate::rows::{cell, number, rows};
use crate::runner::{Run, dvp, dvp_done, names, text};

/// Traced as one square on a ground: two paths of 8 numbers.
const DRAWING: &str = "<svg xmlns=\"http://www.w3.org/2000/svg\"><path d=\"M0 0 L1 0 L1 1 L0 1Z\" fill=\"#fff\"/>\
                       <path d=\"M2 2 L3 2 L3 3 L2 3Z\" fill=\"#000\"/></svg>";

#[test]
fn a_tiny_report_has_everything() {
    let folder = tempfile::tempdir().unwrap();
    let [out, traced] = ["parsimony", "traced"].map(|name| folder.path().join(name));
    fs::create_dir(&traced).unwrap();
    let stems = ["00000", "00001", "empty-00000"];
    for stem in stems {
        fs::write(traced.join(format!("{stem}.svg")), DRAWING).unwrap();
    }
    let run = dvp([
        "parsimony",
        "--quick",
        "--images",
        "2",
        "--json",
        "--machine",
        "a <test>",
        "--traced",
        text(&traced),
        "--out",
        text(&out),
    ]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert_eq!(
        names(&out),
        ["bits.png", "bits.svg", "images.csv", "index.html", "parsimony.csv", "pictures", "prices.csv"]
    );
    assert_eq!(names(&out.join("pictures")), stems.map(|stem| format!("{stem}.png")));

    let methods = rows(&out.join("parsimony.csv"));
    let named: Vec<&str> = methods.iter().map(|row| cell(row, "method")).collect();
    assert_eq!(named, ["segment-bank", "segment-free", "opt-p", "opt-iter", "net", "net-lm", "vtracer"]);
    let bank = &methods[0];
    for (name, expected) in [("exact_count", 1.0), ("exact_count_of_0", 1.0), ("bits_ratio", 1.0), ("surplus", 0.0)] {
        assert!((number(bank, name) - expected).abs() < 1e-9, "{name}: {bank:?}");
    }
    assert!(number(&methods[1], "bits_ratio") <= 1.2, "{:?}", methods[1]);
    let drawn = &methods[6];
    assert_eq!((number(drawn, "svg_coordinates"), number(drawn, "exact_count_of_0")), (16.0, 0.0));
    assert_eq!(cell(drawn, "bits"), "");

    let prices = rows(&out.join("prices.csv"));
    for (set, most) in [("clean", 7), ("noisy", 9), ("twins", 7)] {
        assert_eq!(prices.iter().filter(|row| cell(row, "set") == set).count(), most, "{set}");
    }
    assert_eq!(rows(&out.join("images.csv")).len(), 6 * stems.len());

    let page = fs::read_to_string(out.join("index.html")).unwrap();
    assert_eq!(page.matches("<svg").count(), 1);
    assert!(page.contains("a &lt;test&gt;") && page.contains("dvp parsimony --out DIR --quick --images 2"));
    assert!(!page.contains("src=") && !page.contains("<link"), "one file alone");
    let svg = fs::read(out.join("bits.svg")).unwrap();
    assert!(Tree::from_data(&svg, &Options::default()).is_ok());
    let json: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(json["methods"].as_array().unwrap().len(), methods.len());
    assert_eq!(json["methods"][0]["method"], "segment-bank");
}

#[test]
fn a_data_set_is_counted_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let [data, out] = ["data", "out"].map(|name| folder.path().join(name));
    dvp_done(["generate", "--count", "2", "--out", text(&data)]);
    dvp_done(["parsimony", "--quick", "--data", text(&data), "--out", text(&out)]);
    assert_eq!(names(&out.join("pictures")), ["00000.png", "00001.png"]);
    assert_eq!(cell(&rows(&out.join("parsimony.csv"))[0], "exact_count_of_0"), "");
}

#[test]
fn what_cannot_be_counted_is_said() {
    let refused = |arguments: &[&str]| -> Run {
        dvp(["parsimony", "--quick", "--out", "nowhere"].iter().chain(arguments).copied())
    };
    let run = refused(&["--images", "0"]);
    assert!(run.code == 1 && run.err.contains("--images"), "{}", run.err);
    let folder = tempfile::tempdir().unwrap();
    let run = refused(&["--images", "1", "--traced", text(folder.path())]);
    assert!(run.code == 1 && run.err.contains("00000.svg"), "{}", run.err);
    fs::write(folder.path().join("00000.svg"), "<svg/>").unwrap();
    fs::write(folder.path().join("empty-00000.svg"), DRAWING).unwrap();
    let run = refused(&["--images", "1", "--traced", text(folder.path())]);
    assert!(run.code == 1 && run.err.contains("no <path>"), "{}", run.err);
}
