//! `gradients`: both analyses, small, with sane numbers.

use std::fs;

use crate::runner::{dvp, dvp_done, names, text};

#[test]
fn both_analyses_are_written_beside_the_published_ones() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("gradients");
    let size = ["--pairs", "8", "--descents", "2", "--side", "64"];
    let table = dvp_done(["gradients", "--out", text(&out)].into_iter().chain(size));
    assert_eq!(names(&out), ["cosine.csv", "cosine_mae.svg", "cosine_mse.svg", "plateau.csv", "plateau.svg"]);

    let cosines = fs::read_to_string(out.join("cosine.csv")).unwrap();
    assert!(table.starts_with(&cosines));
    let rows: Vec<Vec<&str>> = cosines.lines().skip(1).map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 2 * 6 * 11);
    let number = |row: &[&str], k: usize| row[k].parse::<f64>().unwrap();
    for row in &rows {
        assert!(number(row, 3).abs() <= 1.0 + 1e-6, "{row:?}");
        if row[1] == "background" {
            assert!(number(row, 3) > 0.5, "both losses pull the background to its color: {row:?}");
        }
    }
    let plateaus = fs::read_to_string(out.join("plateau.csv")).unwrap();
    let rows: Vec<Vec<&str>> = plateaus.lines().skip(1).map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 11);
    for row in &rows {
        assert!(number(row, 2) < number(row, 1), "Adam makes no image worse: {row:?}");
    }
    assert!(number(&rows[10], 1) > 4.0 * number(&rows[0], 1), "farther away is worse: {plateaus}");
    assert!(fs::read_to_string(out.join("cosine_mse.svg")).unwrap().contains("translation"));
}

#[test]
fn the_published_setting_meets_the_published_curves() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("gradients");
    dvp_done(["gradients", "--published", "--out", text(&out), "--pairs", "192", "--descents", "6"]);
    let rows = |name: &str| {
        let table = fs::read_to_string(out.join(name)).unwrap();
        let rows = table.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        rows.collect::<Vec<_>>()
    };
    let number = |row: &[String], k: usize| row[k].parse::<f64>().unwrap();
    // Of 192 pairs; of 2048 they are within 0.03 everywhere. Without slots or rounding they are 0.2 off.
    for row in rows("cosine.csv") {
        assert!((number(&row, 3) - number(&row, 4)).abs() < 0.08, "{row:?}");
    }
    let plateaus = rows("plateau.csv");
    assert!(number(&plateaus[0], 2) < 3e-5, "with mixed shapes and confidences it ends at 1e-4: {:?}", plateaus[0]);
    assert!(number(&plateaus[10], 2) > 5e-3, "far away there is a plateau: {:?}", plateaus[10]);
}

#[test]
fn nothing_to_average_is_said() {
    let run = dvp(["gradients", "--out", "nowhere", "--pairs", "0"]);
    assert!(run.code == 1 && run.err.contains("--pairs"), "{}", run.err);
}
