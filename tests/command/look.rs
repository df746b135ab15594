//! Second looks: `train --model look`, `evaluate --look`, `--looks`.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::runner::{dvp, dvp_done, names, text};
use crate::train::losses;

/// Arguments of a run of seconds; what follows replaces or adds options.
fn quick<'a>(out: &'a Path, more: &[&'a str]) -> Vec<&'a str> {
    let mut arguments = vec!["train", "--out", text(out), "--model", "look", "--size", "tiny", "--batch", "2"];
    arguments.extend(["--validation", "2", "--warm-up", "2", "--steps", "6", "--save-every", "2"]);
    arguments.extend(more);
    arguments
}

fn scored(more: &[&str]) -> Value {
    let mut arguments = vec!["evaluate", "--generated", "24", "--seed", "99", "--json"];
    arguments.extend(more);
    let mut said: Value = serde_json::from_str(&dvp_done(arguments)).unwrap();
    said.as_object_mut().unwrap().remove("cpu_ms").unwrap();
    said
}

#[test]
fn a_run_leaves_its_files_and_goes_on_to_the_same_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let [whole, halves, data] = ["whole", "halves", "data"].map(|name| folder.path().join(name));
    let said = dvp_done(quick(&whole, &[]));
    assert!(said.contains("6 steps of 2 images") && said.contains("what objects are off by on"), "{said}");
    let files = ["best.safetensors", "checkpoint-00000004.safetensors", "checkpoint-00000006.safetensors"];
    assert_eq!(names(&whole), [&files[..], &["losses.csv", "losses.svg", "run.json", "samples"]].concat());
    assert!(losses(&whole)[0].ends_with("validation_moves,validation_shapes"));
    assert!(fs::read_to_string(whole.join("losses.svg")).unwrap().contains("error, validation"));
    // Stopped after a checkpoint.
    let file = |run: &Path, name: &str| -> PathBuf { run.join(name) };
    fs::create_dir(&halves).unwrap();
    for name in ["run.json", "losses.csv", "checkpoint-00000004.safetensors"] {
        fs::copy(file(&whole, name), file(&halves, name)).unwrap();
    }
    dvp_done(["train", "--out", text(&halves), "--resume"]);
    assert_eq!(losses(&halves), losses(&whole));
    let last = "checkpoint-00000006.safetensors";
    assert_eq!(fs::read(file(&halves, last)).unwrap(), fs::read(file(&whole, last)).unwrap());
    // From pictures with scenes, and from weights of another run.
    dvp_done(["generate", "--count", "5", "--width", "32", "--out", text(&data)]);
    let (start, own) = (whole.join("best.safetensors"), folder.path().join("own"));
    dvp_done(quick(&own, &["--data", text(&data), "--start", text(&start), "--steps", "2"]));
    fs::remove_file(data.join("scenes.jsonl")).unwrap();
    let run = dvp(quick(&folder.path().join("none"), &["--data", text(&data)]));
    assert!(run.code == 1 && run.err.contains("learns from scenes"), "{}", run.err);
}

#[test]
fn what_comes_along_puts_objects_right() {
    let [never, once, usual] = [&["--looks", "0"][..], &["--looks", "1"], &[]].map(scored);
    let figure = |said: &Value, name: &str| said[name].as_f64().unwrap();
    for name in ["iou", "ari", "ssim"] {
        let [never, once, usual] = [&never, &once, &usual].map(|said| figure(said, name));
        assert!(never < once && once < usual, "{name}: {never} {once} {usual}");
    }
    // The published row TI-TP (tests/report/training.md).
    assert!(figure(&usual, "iou") > 0.8884 && figure(&usual, "ari") > 0.8693, "{usual}");
    assert_eq!(scored(&["--looks", "3"]), usual);
}

#[test]
fn looks_of_ones_own_and_what_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let [run, other] = ["run", "other"].map(|name| folder.path().join(name));
    dvp_done(quick(&run, &["--steps", "2"]));
    let look = run.join("best.safetensors");
    let said = scored(&["--look", text(&look), "--looks", "1"]);
    assert!(said["n"] == 24 && said != scored(&["--looks", "1"]), "{said}");
    dvp_done(quick(&other, &["--steps", "2", "--harmonics", "5"]));
    let (look, other) = (text(&look), other.join("best.safetensors"));
    for (arguments, said) in [
        (&["--look", text(&other)][..], "other shapes"),
        (&["--look", "nowhere"], "nowhere cannot be read"),
        (&["--model", look], "note"),
        (&["--method", "live", "--looks", "1"], "--looks"),
    ] {
        let run = dvp(["evaluate", "--generated", "1"].iter().chain(arguments).copied());
        assert!(run.code == 1 && run.err.contains(said), "{arguments:?}: {}{}", run.out, run.err);
    }
    for (option, value) in [("--mode", "gp"), ("--side", "64"), ("--threads", "2")] {
        let run = dvp(quick(&folder.path().join("none"), &[option, value]));
        assert!(run.code == 1 && run.err.contains(option), "{option}: {}", run.err);
    }
}
