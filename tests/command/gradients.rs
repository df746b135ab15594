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
fn nothing_to_average_is_said() {
    let run = dvp(["gradients", "--out", "nowhere", "--pairs", "0"]);
    assert!(run.code == 1 && run.err.contains("--pairs"), "{}", run.err);
}
