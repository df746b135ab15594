//! The field's benchmarks: from generated pictures to shapes, fits and scores, and refusals that say what to do.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::runner::{dvp, dvp_done, names, text};

/// The rows of an evaluation: connected components, and the predictions.
fn rows(predictions: &Path, data: &Path, suite: &str) -> [Value; 2] {
    let out = dvp_done(["evaluate", text(predictions), text(data), "--suite", suite, "--json"]);
    let report: Value = serde_json::from_str(&out).unwrap();
    [report["rows"][0].clone(), report["rows"][1].clone()]
}

fn figure(row: &Value, column: &str) -> f64 {
    row[column].as_f64().unwrap_or_else(|| panic!("no {column} in {row}"))
}

/// The true scenes as predictions.
fn truth(data: &Path, predictions: &Path) {
    fs::create_dir(predictions).unwrap();
    for (index, line) in fs::read_to_string(data.join("scenes.jsonl")).unwrap().lines().enumerate() {
        fs::write(predictions.join(format!("{index:05}.json")), line).unwrap();
    }
}

#[test]
fn the_truth_scores_full_on_every_suite() {
    for suite in ["csr", "multi-dsprites", "tetrominoes"] {
        let folder = tempfile::tempdir().unwrap();
        let [data, predictions] = ["data", "predictions"].map(|name| folder.path().join(name));
        dvp_done(["generate", "--preset", suite, "--count", "6", "--out", text(&data)]);
        truth(&data, &predictions);
        let [components, found] = rows(&predictions, &data, suite);
        assert_eq!(components["name"], "connected components of equal color");
        assert_eq!((found["name"].as_str(), figure(&found, "n")), (Some("predictions"), 6.0));
        for column in ["ari_foreground", "ari", "exact_count", "iou", "f1"] {
            assert!((figure(&found, column) - 1.0).abs() < 1e-12, "{suite}: {column} {found}");
        }
        // Pieces of tetrominoes never hide one another; connected components know no order.
        assert_eq!(found["order"].as_f64(), (suite != "tetrominoes").then_some(1.0));
        assert_eq!((&components["order"], &components["class_accuracy"]), (&Value::Null, &Value::Null));
        let table = dvp_done(["evaluate", text(&predictions), text(&data), "--suite", suite]);
        assert!(
            ["ARI-FG", "OCA", "OOA", "F1", "connected components"].iter().all(|part| table.contains(part)),
            "{table}"
        );
    }
}

#[test]
fn turned_pieces_are_learned_from_pictures_alone_and_found_again() {
    let folder = tempfile::tempdir().unwrap();
    let [pictures, data, bank, out] = ["pictures", "data", "bank.json", "out"].map(|name| folder.path().join(name));
    dvp_done(["generate", "--preset", "tetrominoes", "--count", "150", "--seed", "31", "--out", text(&pictures)]);
    dvp_done(["generate", "--preset", "tetrominoes", "--count", "12", "--seed", "32", "--out", text(&data)]);
    let json = dvp_done(["prototypes", text(&pictures), "-o", text(&bank), "--upright", "--json"]);
    let report: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(report["shapes"].as_array().unwrap().len(), 17, "{json}");
    dvp_done(["fit", text(&data), "--bank", text(&bank), "--out", text(&out), "--no-svg", "--no-png"]);
    let [components, found] = rows(&out, &data, "tetrominoes");
    for column in ["ari_foreground", "ari", "exact_count", "iou", "f1"] {
        let (ours, theirs) = (figure(&found, column), figure(&components, column));
        assert!(ours >= theirs && ours > 0.999, "{column}: {ours}, connected components {theirs}");
    }
    assert!(figure(&found, "class_accuracy") > 0.99, "{found}");
}

#[test]
fn a_learned_bank_does_not_lose_to_none() {
    let folder = tempfile::tempdir().unwrap();
    let [pictures, data, bank] = ["pictures", "data", "bank.json"].map(|name| folder.path().join(name));
    dvp_done(["generate", "--preset", "multi-dsprites", "--count", "80", "--seed", "33", "--out", text(&pictures)]);
    dvp_done(["generate", "--preset", "multi-dsprites", "--count", "12", "--seed", "34", "--out", text(&data)]);
    dvp_done(["prototypes", text(&pictures), "-o", text(&bank)]);
    let scored = |name: &str, options: &[&str]| {
        let out = folder.path().join(name);
        dvp_done(
            ["fit", text(&data), "--out", text(&out), "--no-svg", "--no-png"]
                .into_iter()
                .chain(options.iter().copied()),
        );
        let [_, found] = rows(&out, &data, "multi-dsprites");
        found
    };
    let (free, learned) = (scored("free", &[]), scored("learned", &["--bank", text(&bank)]));
    for column in ["exact_count", "iou", "f1"] {
        let (with, without) = (figure(&learned, column), figure(&free, column));
        assert!(with >= without, "{column}: {with} with the bank, {without} without");
    }
    // Free outlines follow every pixel, shapes that were learned from 80 pictures leave about one in 500 along an outline to the other side.
    for column in ["ari_foreground", "ari"] {
        let (with, without) = (figure(&learned, column), figure(&free, column));
        assert!(with >= without - 0.004, "{column}: {with} with the bank, {without} without");
    }
    assert!(figure(&learned, "class_accuracy") > 0.9, "{learned}");
}

#[test]
fn what_does_not_go_together_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let [data, file] = ["data", "set.tfrecords"].map(|name| folder.path().join(name));
    fs::write(&file, "no records at all").unwrap();
    let refused = |args: &[&str], parts: &[&str]| {
        let run = dvp(args.iter().copied());
        assert!(run.code != 0 && parts.iter().all(|part| run.err.contains(part)), "{args:?}: {}", run.err);
    };
    let (out, from) = (text(&data), text(&file));
    refused(&["generate", "--preset", "tetrominoes", "--scale", "1..2", "--out", out], &["leave all away"]);
    refused(&["generate", "--from", from, "--out", out], &["--preset multi-dsprites, tetrominoes or csr"]);
    refused(&["generate", "--preset", "csr", "--from", from, "--out", out], &["set.tfrecords", "no readable .npz"]);
    refused(&["generate", "--preset", "tetrominoes", "--from", from, "--out", out], &["record 1", "set.tfrecords"]);
    refused(&["generate", "--preset", "csr", "--from", from, "--width", "9", "--out", out], &["as they are"]);
    assert!(!data.exists(), "nothing is half-written");
    refused(&["evaluate", out, "--suite", "csr"], &["DATA"]);
    dvp_done(["generate", "--preset", "csr", "--count", "2", "--out", out]);
    assert_eq!(names(&data), ["00000.png", "00001.png", "classes.json", "scenes.jsonl"]);
    let predictions = folder.path().join("predictions");
    truth(&data, &predictions);
    fs::remove_file(predictions.join("00001.json")).unwrap();
    refused(&["evaluate", text(&predictions), out, "--suite", "csr"], &["00001: no prediction"]);
}
