//! MONet and Slot Attention: `train --model`, `evaluate --method`, `decompose`.

use std::fs;
use std::path::Path;

use crate::runner::{dvp, dvp_done, names, text};
use crate::train::losses;

/// As options name them.
const MODELS: [&str; 2] = ["monet", "slots"];

/// Arguments of a run of seconds; what follows replaces or adds options.
fn quick<'a>(model: &'a str, out: &'a Path, more: &[&'a str]) -> Vec<&'a str> {
    let mut arguments = vec!["train", "--out", text(out), "--model", model, "--size", "tiny", "--side", "16"];
    arguments.extend(["--batch", "2", "--validation", "2", "--warm-up", "2", "--steps", "6", "--save-every", "2"]);
    arguments.extend(more);
    arguments
}

#[test]
fn a_run_leaves_its_files_and_is_scored_and_drawn() {
    MODELS.into_iter().for_each(leaves_its_files_and_is_scored_and_drawn);
}

fn leaves_its_files_and_is_scored_and_drawn(model: &str) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let said = dvp_done(quick(model, &out, &[]));
    assert!(said.contains("6 steps of 2 images") && said.contains("mean absolute error on 2"), "{said}");
    let expected = [
        "best.safetensors",
        "checkpoint-00000004.safetensors",
        "checkpoint-00000006.safetensors",
        "losses.csv",
        "losses.svg",
        "run.json",
        "samples",
    ];
    assert_eq!(names(&out), expected);
    let rows = losses(&out);
    let rows: Vec<Vec<&str>> = rows.iter().map(|row| row.split(',').collect()).collect();
    assert_eq!(rows[0][6..], ["validation_mae", "validation_ari"]);
    let error: f64 = rows.last().unwrap()[6].parse().unwrap();
    assert!((0.0..1.0).contains(&error), "{rows:?}");

    let best = out.join("best.safetensors");
    let method = ["--method", model, "--model", text(&best), "--json"];
    let scored = dvp_done(["evaluate", "--generated", "3"].into_iter().chain(method));
    let totals: serde_json::Value = serde_json::from_str(&scored).unwrap();
    assert_eq!(totals["n"], 3);
    for figure in ["mae", "iou", "ari", "exact_count", "cpu_ms"] {
        assert!(totals[figure].as_f64().is_some_and(f64::is_finite), "{figure}: {totals}");
    }
    // Label maps as truth, and a picture that is not square.
    let data = folder.path().join("data");
    dvp_done(["generate", "--count", "2", "--width", "40", "--height", "32", "--out", text(&data)]);
    let totals: serde_json::Value =
        serde_json::from_str(&dvp_done(["evaluate", text(&data)].into_iter().chain(method))).unwrap();
    assert!(totals["n"] == 2 && totals["failed"].as_array().unwrap().is_empty(), "{totals}");

    let sheet = folder.path().join("parts.png");
    dvp_done(["decompose", "--model", text(&best), "--generated", "2", "--out", text(&sheet)]);
    // Two rows of 16 pixels; picture, reconstruction, three masks, three parts; 2 pixels between.
    let picture = image::open(&sheet).unwrap();
    assert_eq!((picture.width(), picture.height()), (8 * 18 - 2, 2 * 18 - 2));
}

#[test]
fn a_run_goes_on_to_the_same_numbers() {
    MODELS.into_iter().for_each(goes_on_to_the_same_numbers);
}

fn goes_on_to_the_same_numbers(model: &str) {
    let folder = tempfile::tempdir().unwrap();
    let [whole, halves] = ["whole", "halves"].map(|name| folder.path().join(name));
    // The rate stays, so that the number of steps changes nothing before the last.
    let constant = ["--cosine", "false", "--steps", "8"];
    dvp_done(quick(model, &whole, &constant));
    dvp_done(quick(model, &halves, &["--cosine", "false", "--steps", "4"]));
    dvp_done(["train", "--out", text(&halves), "--model", model, "--resume", "--steps", "8"]);
    assert_eq!(losses(&halves), losses(&whole));
    let last = "checkpoint-00000008.safetensors";
    let weights = |run: &Path| dvp_net::train::DecomposerFile::from_bytes(&fs::read(run.join(last)).unwrap()).unwrap();
    let [one, two] = [weights(&whole), weights(&halves)].map(|file| {
        let weights = file.weights::<dvp_core::tensor::Host>(&dvp_core::tensor::HostDevice).unwrap();
        weights.iter().flat_map(|(_, tensor)| tensor.to_f64().unwrap()).collect::<Vec<f64>>()
    });
    assert_eq!(one, two);
}

#[test]
#[cfg(feature = "frameworks")]
fn burn_and_candle_learn_the_same() {
    MODELS.into_iter().for_each(learns_the_same_on_burn_and_candle);
}

#[cfg(feature = "frameworks")]
fn learns_the_same_on_burn_and_candle(model: &str) {
    let folder = tempfile::tempdir().unwrap();
    let all = ["host", "burn", "candle"].map(|backend| {
        let out = folder.path().join(backend);
        dvp_done(quick(model, &out, &["--backend", backend]));
        losses(&out)
    });
    for other in &all[1..] {
        assert_eq!(other.len(), all[0].len());
        for (row, expected) in other.iter().zip(&all[0]).skip(1) {
            // The loss: in so few steps rounding has not grown yet (see `tests/backend`).
            let [own, host] = [row, expected].map(|row| row.split(',').nth(1).unwrap().parse::<f64>().unwrap());
            assert!((own - host).abs() < 5e-6 * host.abs().max(1.0), "{row:?} {expected:?}");
        }
    }
}

#[test]
fn what_does_not_fit_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    for model in MODELS {
        let learns = format!("--model {model} learns from images alone");
        for (more, words) in [
            (&["--mode", "gp"][..], "leave --mode away"),
            (&["--threads", "2"], &learns),
            (&["--degraded", "0.5"], "leave --degraded away"),
            (&["--bank", "mdshr"], "leave --bank away"),
            (&["--side", "15"], if model == "monet" { "side is 15" } else { "encoder_step is 2" }),
            (&["--size", "huge"], "--size huge"),
            (&["--steps", "0"], "at least 1"),
            (&["--model", "scene"], "--side is for --model monet and slots"),
        ] {
            let run = dvp(quick(model, &out, more));
            assert!(run.code != 0 && run.err.contains(words), "{model} {more:?}: {}", run.err);
            assert!(!out.exists(), "{more:?}: nothing is written before it is known to work");
        }
    }
    // Sizes of the other.
    let sizes = folder.path().join("sizes.json");
    let config = dvp_net::decompose::DecomposerConfig::Monet(dvp_net::decompose::monet::MonetConfig::tiny(16));
    fs::write(&sizes, serde_json::to_string(&config).unwrap()).unwrap();
    let run = dvp(quick("slots", &out, &["--size", text(&sizes)]));
    assert!(run.code != 0 && run.err.contains("sizes of monet, with --model slots"), "{}", run.err);

    let scene = folder.path().join("scene");
    let mut small = vec!["train", "--out", text(&scene), "--size", "tiny", "--batch", "2", "--validation", "2"];
    small.extend(["--steps", "1"]);
    dvp_done(small);
    let scene = scene.join("best.safetensors");
    for (model, other) in [("monet", "slots"), ("slots", "monet")] {
        let run = folder.path().join(model);
        dvp_done(quick(model, &run, &["--steps", "2"]));
        let best = run.join("best.safetensors");
        let (needed, not_this) =
            (format!("--method {model} needs"), format!("weights of --method {model}, not {other}"));
        for (arguments, words) in [
            (&["evaluate", "--generated", "1", "--method", model][..], &needed[..]),
            (&["evaluate", "--generated", "1", "--method", model, "--model", text(&scene)], "best.safetensors"),
            (&["evaluate", "--generated", "1", "--model", text(&best)], "best.safetensors"),
            (&["evaluate", "--generated", "1", "--method", other, "--model", text(&best)], &not_this),
            (&["evaluate", "--generated", "1", "--method", model, "--model", text(&best), "--then", "opt-p"], "--then"),
            (&["decompose", "--model", text(&best), "--generated", "1", "--out", "parts.jpg"], ".png"),
            (&["decompose", "--model", text(&best), "--generated", "0", "--out", "parts.png"], "at least 1"),
            (&["decompose", "--model", "nowhere", "--generated", "1", "--out", "parts.png"], "nowhere"),
        ] {
            let run = dvp(arguments.iter().copied());
            assert!(run.code != 0 && run.err.contains(words), "{arguments:?}: {}", run.err);
        }
    }
    assert!(!Path::new("parts.png").exists());
}
