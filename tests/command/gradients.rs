//! `gradients`: both analyses, small, with sane numbers.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use crate::runner::{dvp, dvp_done, names, text};

/// The rows of a table by the names of its columns.
fn rows(path: &Path) -> Vec<HashMap<String, String>> {
    let table = fs::read_to_string(path).unwrap();
    let mut lines = table.lines().map(|line| line.split(',').map(str::to_owned));
    let names: Vec<String> = lines.next().unwrap().collect();
    lines.map(|cells| names.iter().cloned().zip(cells).collect()).collect()
}

fn number(row: &HashMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap()
}

#[test]
fn both_analyses_are_written_beside_the_published_ones() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("gradients");
    let size = ["--pairs", "8", "--descents", "2", "--side", "64"];
    let table = dvp_done(["gradients", "--out", text(&out)].into_iter().chain(size));
    assert_eq!(names(&out), ["cosine.csv", "cosine_mae.svg", "cosine_mse.svg", "plateau.csv", "plateau.svg"]);

    assert!(table.starts_with(&fs::read_to_string(out.join("cosine.csv")).unwrap()));
    let cosines = rows(&out.join("cosine.csv"));
    assert_eq!(cosines.len(), 2 * 6 * 11);
    for row in &cosines {
        assert!(number(row, "cosine").abs() <= 1.0 + 1e-6, "{row:?}");
        // Of numbers in [-1, 1] it is at most 1 / sqrt(n - 1).
        assert!((0.0..=0.378).contains(&number(row, "error")), "{row:?}");
        if row["aspect"] == "background" {
            assert!(number(row, "cosine") > 0.5, "both losses pull the background to its color: {row:?}");
        }
    }
    let plateaus = rows(&out.join("plateau.csv"));
    assert_eq!(plateaus.len(), 11);
    for row in &plateaus {
        assert!(number(row, "after") < number(row, "before"), "Adam makes no image worse: {row:?}");
    }
    let [near, far] = [0, 10].map(|k| number(&plateaus[k], "before"));
    assert!(far > 4.0 * near, "farther away is worse: {plateaus:?}");
    assert!(fs::read_to_string(out.join("cosine_mse.svg")).unwrap().contains("translation"));
}

#[test]
fn the_published_setting_meets_the_published_curves() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("gradients");
    dvp_done(["gradients", "--published", "--out", text(&out), "--pairs", "192", "--descents", "6"]);
    // Of 192 pairs; of 65,536 they are within 0.03 everywhere. Without slots or rounding they are 0.2 off.
    for row in rows(&out.join("cosine.csv")) {
        assert!((number(&row, "cosine") - number(&row, "published")).abs() < 0.08, "{row:?}");
    }
    let after: Vec<f64> = rows(&out.join("plateau.csv")).iter().map(|row| number(row, "after")).collect();
    assert!(after[0] < 3e-5, "with mixed shapes and confidences it ends at 1e-4: {after:?}");
    assert!(after[10] > 5e-3, "far away there is a plateau: {after:?}");
}

#[test]
fn nothing_to_average_is_said() {
    let run = dvp(["gradients", "--out", "nowhere", "--pairs", "0"]);
    assert!(run.code == 1 && run.err.contains("--pairs"), "{}", run.err);
}
