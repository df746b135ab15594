//! `prototypes`: a bank that `fit` and `generate` read, the same on any number of threads, and a chart.

use std::fs;

use crate::runner::{dvp, dvp_done, names, text};

#[test]
fn a_bank_is_learned_and_used() {
    let folder = tempfile::tempdir().unwrap();
    let [data, bank, again, chart, out] =
        ["data", "bank.json", "again.json", "silhouette.svg", "out"].map(|name| folder.path().join(name));
    dvp_done(["generate", "--count", "24", "--out", text(&data)]);
    let table = dvp_done([
        "prototypes",
        text(&data),
        "-o",
        text(&bank),
        "--chart",
        text(&chart),
        "--max-shapes",
        "8",
        "--threads",
        "1",
    ]);
    assert!(table.contains("shape 3") && table.contains("24 pictures") && !table.contains("shape 4"), "{table}");
    let svg = fs::read_to_string(&chart).unwrap();
    assert!(svg.contains("</svg>") && svg.contains("mean silhouette") && svg.matches("<circle").count() == 7, "{svg}");
    let json =
        dvp_done(["prototypes", text(&data), "-o", text(&again), "--max-shapes", "8", "--json", "--threads", "2"]);
    let report: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(report["shapes"].as_array().unwrap().len(), 3);
    assert_eq!(report["silhouettes"].as_array().unwrap().len(), 7);
    assert!(fs::read(&bank).unwrap() == fs::read(&again).unwrap(), "threads change the bank");
    let picture = data.join("00000.png");
    dvp_done(["fit", text(&picture), "--bank", text(&bank), "--out", text(&out)]);
    assert!(names(&out).contains(&"00000.json".to_owned()));
}

#[test]
fn what_cannot_be_learned_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("data");
    let bank = folder.path().join("bank.json");
    let run = dvp(["prototypes", text(folder.path()), "-o", text(&bank)]);
    assert!(run.code == 1 && run.err.contains("no picture"), "{}", run.err);
    dvp_done(["generate", "--count", "1", "--visible", "1", "--out", text(&data)]);
    let run = dvp(["prototypes", text(&data), "-o", text(&bank)]);
    assert!(run.code == 1 && run.err.contains("add pictures"), "{}", run.err);
    let run = dvp(["prototypes", text(&data), "-o", text(&bank), "--chart", "chart.png"]);
    assert!(run.code == 1 && run.err.contains(".svg") && !bank.exists(), "{}", run.err);
}
