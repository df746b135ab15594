//! The command on few difficulties: files, tables, sanity; never times.

use std::fs;

use clap::Parser;
use dvp_cli::command;

use crate::command::Command;

/// The laboratory as a program of its own.
#[derive(Debug, Parser)]
struct Program {
    #[command(subcommand)]
    command: Command,
}

/// Runs `dvp` with the words and returns code and both streams.
fn dvp(words: &[&str]) -> (u8, String, String) {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let words = core::iter::once("dvp").chain(words.iter().copied()).map(Into::into);
    let code = command::run(words, &mut out, &mut err, |program: &Program, console| program.command.run(console));
    (code, String::from_utf8(out).unwrap(), String::from_utf8(err).unwrap())
}

#[test]
fn a_tiny_report_has_its_parts_and_makes_sense() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("report");
    let sweeps = ["--sweep", "noise", "displacement"];
    let methods = ["--method", "segment-bank", "lm-continuation"];
    let size = ["--quick", "--pictures", "2", "--machine", "a <test>"];
    let words = ["stability", "--out", out.to_str().unwrap()].into_iter().chain(sweeps).chain(methods).chain(size);
    let (code, table, errors) = dvp(&words.collect::<Vec<_>>());
    assert_eq!((code, &*errors), (0, ""), "{table}");
    assert!(table.contains("| noise") && table.contains("segment-bank"), "{table}");

    let levels = fs::read_to_string(out.join("levels.csv")).unwrap();
    let rows: Vec<Vec<&str>> = levels.lines().skip(1).map(|line| line.split(',').collect()).collect();
    // Six levels of noise by two methods, and five displacements by the one that has a start.
    assert_eq!(rows.len(), 6 * 2 + 5, "{levels}");
    let success = |row: &[&str]| row[4].parse::<f64>().unwrap();
    assert!(success(&rows[0]) > 0.9, "without noise nothing fails: {levels}");
    let displaced: Vec<f64> = rows.iter().filter(|row| row[0] == "displacement").map(|row| success(row)).collect();
    assert!(displaced[0] > 0.9 && displaced[4] < 0.5, "half a pixel is near, half the picture is far: {levels}");
    assert_eq!(fs::read_to_string(out.join("runs.csv")).unwrap().lines().count(), 1 + 2 * rows.len());
    assert_eq!(fs::read_to_string(out.join("calibration.csv")).unwrap().lines().count(), 1 + 3);

    let page = fs::read_to_string(out.join("index.html")).unwrap();
    for part in ["Break points", "Calibration", "<svg", "Start displaced", "a &lt;test&gt;"] {
        assert!(page.contains(part), "{part}");
    }
    for chart in ["noise.svg", "displacement.svg"] {
        let svg = fs::read_to_string(out.join(chart)).unwrap();
        assert!(svg.starts_with("<svg") && svg.contains("lm-continuation") && svg.contains("success"), "{chart}");
    }
}

#[test]
fn what_cannot_be_tried_is_said() {
    let (code, _, errors) = dvp(&["stability", "--out", "nowhere", "--sweep", "rotation", "--method", "opt-iter"]);
    assert!(code == 1 && errors.contains("--method"), "{errors}");
    let (code, _, errors) = dvp(&["stability", "--out", "nowhere", "--sweep", "weather"]);
    assert!(code == 2 && errors.contains("displacement"), "{errors}");
    let words = ["stability", "--out", "nowhere", "--sweep", "noise", "--pictures", "1"];
    let model = ["--model", "nowhere.safetensors"];
    let (code, _, errors) = dvp(&[&words[..], &["--method", "segment-bank"], &model].concat());
    assert!(code == 1 && errors.contains("asks a network"), "{errors}");
    let (code, _, errors) = dvp(&[&words[..], &["--method", "net-lm"], &model].concat());
    assert!(code == 1 && errors.contains("nowhere.safetensors"), "{errors}");
}
