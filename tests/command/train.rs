//! `train`: what it writes, and that it goes on to the same numbers whatever stopped it.

use core::time::Duration;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use dvp_net::encoder::EncoderConfig;
use dvp_net::model::ModelConfig;

use crate::interrupted::spawned;
use crate::runner::{dvp, dvp_done, names, text};

/// Arguments of a run of seconds; what follows replaces or adds options.
fn quick<'a>(out: &'a Path, more: &[&'a str]) -> Vec<&'a str> {
    let mut arguments = vec!["train", "--out", text(out), "--size", "tiny", "--batch", "2", "--validation", "2"];
    arguments.extend(["--warm-up", "2", "--steps", "6", "--save-every", "2"]);
    arguments.extend(more);
    arguments
}

/// The newest checkpoint.
fn newest(out: &Path) -> PathBuf {
    let name = names(out).into_iter().rfind(|name| name.starts_with("checkpoint-")).unwrap();
    out.join(name)
}

/// The columns of `losses.csv` that time does not change.
pub(crate) fn losses(out: &Path) -> Vec<String> {
    let csv = fs::read_to_string(out.join("losses.csv")).unwrap();
    let timeless = |line: &str| {
        let fields: Vec<&str> = line.split(',').enumerate().filter(|(k, _)| *k != 6).map(|(_, field)| field).collect();
        fields.join(",")
    };
    csv.lines().map(timeless).collect()
}

#[test]
fn a_run_leaves_all_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let said = dvp_done(quick(&out, &[]));
    assert!(said.contains("6 steps of 2 images") && said.contains("best.safetensors"), "{said}");
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
    assert_eq!(names(&out.join("samples")), ["00000002.png", "00000004.png", "00000006.png"]);
    assert!(fs::read_to_string(out.join("losses.svg")).unwrap().contains("image loss, validation"));
    assert_eq!(losses(&out).len(), 1 + 3);
    let again = dvp(quick(&out, &[]));
    assert!(again.code == 1 && again.err.contains("--resume"), "{}", again.err);
}

#[cfg(feature = "frameworks")]
#[test]
fn every_mode_runs_on_every_backend_to_the_same_losses() {
    let folder = tempfile::tempdir().unwrap();
    let start = folder.path().join("start");
    dvp_done(quick(&start, &["--steps", "2"]));
    let weights = start.join("best.safetensors");
    for mode in ["ti", "gp", "gi", "gp-gi", "tp", "ti+", "ti-tp"] {
        let all: Vec<Vec<Vec<f64>>> = ["host", "burn", "candle"]
            .iter()
            .map(|backend| {
                let out = folder.path().join(format!("{mode}-{backend}"));
                let mut more = vec!["--mode", mode, "--backend", backend, "--steps", "2", "--save-every", "1"];
                if mode.starts_with("ti") && mode != "ti" {
                    more.extend(["--start", text(&weights)]);
                }
                dvp_done(quick(&out, &more));
                let row = |line: &String| line.split(',').map(|field| field.parse().unwrap_or(0.0)).collect();
                losses(&out)[1..].iter().map(row).collect()
            })
            .collect();
        for other in &all[1..] {
            for (row, expected) in other.iter().zip(&all[0]) {
                // The loss, which is written to six digits; rounding of f32 in its last.
                assert!((row[1] - expected[1]).abs() < 2e-5 * (1.0 + expected[1]), "{mode}: {row:?} {expected:?}");
            }
        }
    }
}

#[test]
fn settings_in_a_file_are_those_of_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let [one, two] = ["one", "two"].map(|name| folder.path().join(name));
    dvp_done(quick(&one, &["--mode", "gi", "--seed", "5", "--steps", "2"]));
    dvp_done(["train", "--out", text(&two), "--config", text(&one.join("run.json"))]);
    assert_eq!(losses(&two), losses(&one));
    assert_eq!(fs::read(one.join("run.json")).unwrap(), fs::read(two.join("run.json")).unwrap());
    let wrong = folder.path().join("wrong.json");
    fs::write(&wrong, "{\"step\": 3}").unwrap();
    let run = dvp(["train", "--out", text(&two), "--config", text(&wrong), "--resume"]);
    assert!(run.code == 1 && run.err.contains("wrong.json") && run.err.contains("step"), "{}", run.err);
}

#[test]
fn a_killed_run_goes_on_to_the_same_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, killed] = ["whole", "killed"].map(|name| folder.path().join(name));
    let many = ["--steps", "40", "--save-every", "4"];
    dvp_done(quick(&whole, &many));
    let mut child = spawned(&quick(&killed, &many));
    let patience = Instant::now();
    while !names(&killed).iter().any(|name| name.starts_with("checkpoint-")) {
        assert!(patience.elapsed() < Duration::from_secs(120), "no checkpoint was written");
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    // Run on a machine that is fast enough, it may have ended.
    dvp_done(["train", "--out", text(&killed), "--resume"]);
    assert_eq!(losses(&killed), losses(&whole));
    assert_eq!(fs::read(newest(&killed)).unwrap(), fs::read(newest(&whole)).unwrap());
}

/// Sizes of a model whose encoder, a transformer of vision, keeps its weights.
fn with_frozen_encoder() -> ModelConfig {
    let paper = ModelConfig::paper();
    let EncoderConfig::Vit(mut encoder) = paper.encoder else { panic!("{:?}", paper.encoder) };
    encoder.side = 28;
    (encoder.model.hidden_size, encoder.model.num_hidden_layers, encoder.model.num_attention_heads) = (16, 1, 2);
    let mut config = ModelConfig::tiny();
    (config.encoder, config.batch_norm) = (EncoderConfig::Vit(encoder), true);
    config
}

#[test]
fn features_of_a_frozen_encoder_are_kept_and_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let [kept, again] = ["kept", "again"].map(|name| folder.path().join(name));
    let sizes = folder.path().join("sizes.json");
    fs::write(&sizes, serde_json::to_string(&with_frozen_encoder()).unwrap()).unwrap();
    let run = ["--size", text(&sizes), "--scenes", "4", "--mode", "gp-gi"];
    // Three batches of two see two images again.
    dvp_done(quick(&kept, &run));
    assert_eq!(names(&kept.join("features")).len(), 4);
    // The same run with features that are damaged or gone when it goes on.
    dvp_done(quick(&again, &[&run[..], &["--steps", "2"]].concat()));
    let features = names(&again.join("features"));
    assert_eq!(features.len(), 4);
    fs::write(again.join("features").join(&features[0]), b"damaged").unwrap();
    fs::remove_file(again.join("features").join(&features[1])).unwrap();
    let settings = fs::read_to_string(again.join("run.json")).unwrap();
    fs::write(again.join("run.json"), settings.replace("\"steps\": 2", "\"steps\": 6")).unwrap();
    dvp_done(["train", "--out", text(&again), "--resume"]);
    let values = |run: &Path| {
        let folder = run.join("features");
        names(&folder).iter().map(|name| fs::read(folder.join(name)).unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(values(&again), values(&kept));
}

#[test]
fn a_damaged_checkpoint_is_named_and_the_one_before_it_taken() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, damaged] = ["whole", "damaged"].map(|name| folder.path().join(name));
    dvp_done(quick(&whole, &["--steps", "8"]));
    dvp_done(quick(&damaged, &["--steps", "6", "--cosine", "false"]));
    dvp_done(["train", "--out", text(&whole), "--resume"]);
    let newest = newest(&damaged);
    let mut bytes = fs::read(&newest).unwrap();
    let place = bytes.len() - 100;
    bytes[place] ^= 1;
    fs::write(&newest, &bytes).unwrap();
    let before = losses(&damaged);
    let run = dvp(["train", "--out", text(&damaged), "--resume"]);
    assert!(run.code == 0 && run.err.contains("checkpoint-00000006.safetensors: damaged"), "{}", run.err);
    assert_eq!(losses(&damaged), before, "steps 5 and 6 again, from step 4");

    for name in names(&damaged).iter().filter(|name| name.starts_with("checkpoint-")) {
        fs::write(damaged.join(name), b"no model").unwrap();
    }
    let run = dvp(["train", "--out", text(&damaged), "--resume"]);
    assert!(run.code == 1 && run.err.contains("no checkpoint that can be read"), "{}", run.err);
}

#[test]
fn pictures_of_a_folder_are_learned_from() {
    let folder = tempfile::tempdir().unwrap();
    let [data, ti, gp] = ["data", "ti", "gp"].map(|name| folder.path().join(name));
    dvp_done(["generate", "--count", "5", "--width", "32", "--out", text(&data)]);
    dvp_done(quick(&gp, &["--data", text(&data), "--steps", "2"]));
    fs::remove_file(data.join("scenes.jsonl")).unwrap();
    dvp_done(quick(&ti, &["--mode", "ti", "--data", text(&data), "--steps", "2"]));
    // What a preliminary model sees stands for scenes.
    let (model, reread) = (gp.join("best.safetensors"), folder.path().join("reread"));
    dvp_done(quick(&reread, &["--data", text(&data), "--preliminary", text(&model), "--steps", "2"]));
    let out = folder.path().join("none");
    let run = dvp(quick(&out, &["--data", text(&data)]));
    assert!(run.code == 1 && run.err.contains("learns from scenes"), "{}", run.err);
    assert!(!out.exists(), "nothing is written before it is known to work");
}

#[test]
fn pictures_are_spoiled_as_asked_whatever_stopped_the_run() {
    let folder = tempfile::tempdir().unwrap();
    for model in ["scene", "look"] {
        let [plain, whole, halves] =
            ["plain", "whole", "halves"].map(|name| folder.path().join(format!("{model}-{name}")));
        dvp_done(quick(&plain, &["--model", model]));
        dvp_done(quick(&whole, &["--model", model, "--degraded", "0.5"]));
        assert_ne!(losses(&plain), losses(&whole), "{model}");
        let settings = fs::read_to_string(whole.join("run.json")).unwrap();
        assert!(settings.contains("\"degraded\": 0.5"), "{settings}");
        fs::create_dir(&halves).unwrap();
        for name in ["run.json", "losses.csv", "checkpoint-00000004.safetensors"] {
            fs::copy(whole.join(name), halves.join(name)).unwrap();
        }
        dvp_done(["train", "--out", text(&halves), "--resume"]);
        assert_eq!(losses(&halves), losses(&whole), "{model}");
        // A run from before there was such a setting.
        let settings = fs::read_to_string(plain.join("run.json")).unwrap();
        let older: String =
            settings.lines().filter(|line| !line.contains("degraded")).map(|line| format!("{line}\n")).collect();
        assert!(older.len() < settings.len(), "{settings}");
        fs::write(plain.join("run.json"), older).unwrap();
        fs::remove_file(plain.join("checkpoint-00000006.safetensors")).unwrap();
        let before = losses(&plain);
        dvp_done(["train", "--out", text(&plain), "--resume"]);
        assert_eq!(losses(&plain), before, "{model}");
    }
}

#[test]
fn what_cannot_be_run_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    for (more, words) in [
        (&["--mode", "xp"][..], "the modes are ti, gp"),
        (&["--mode", "ti+"], "--start"),
        (&["--steps", "0"], "at least 1"),
        (&["--size", "huge"], "--size huge"),
        (&["--bank", "none"], "needs shapes"),
        (&["--degraded", "1.5"], "0 to 1"),
        (&["--model", "monet", "--degraded", "0.5"], "as they are"),
        (&["--start", "nowhere.safetensors"], "nowhere.safetensors"),
    ] {
        let run = dvp(quick(&out, more));
        assert!(run.code != 0 && run.err.contains(words), "{more:?}: {}", run.err);
    }
    let run = dvp(["train", "--out", text(&folder.path().join("nothing")), "--resume"]);
    assert!(run.code == 1 && run.err.contains("run.json"), "{}", run.err);
}
