//! `dvp fit`: what it writes, says and refuses.

use std::fs;

use dvp::format::{BitDepth, DataSet, Place, ShapeJson, encode_png, read_scene};
use dvp_core::Scene;
use serde_json::Value;

use crate::runner::{dvp, dvp_done, names, text};

#[test]
fn known_shapes_are_found_where_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let [data, out] = ["data", "out"].map(|name| folder.path().join(name));
    // Spread out, so that no object hides another.
    dvp_done([
        "generate",
        "--count",
        "6",
        "--visible",
        "2",
        "--scale",
        "0.1..0.15",
        "--margin",
        "0.2",
        "--out",
        text(&data),
    ]);
    let run = dvp(["fit", text(&data), "--bank", "mdshr", "--out", text(&out), "--json"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let said: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!((&said["summary"]["images"], &said["summary"]["objects"]), (&6.into(), &12.into()));
    assert!(said["images"][0]["cpu_ms"].as_f64().unwrap() > 0.0 && said["images"][0]["stop"].is_string());
    let set = DataSet::<f64>::open(&data).unwrap();
    for sample in &set.samples {
        let (json, place) = sample.scene.as_ref().unwrap();
        let truth: Scene<f64> = json.to_scene(Some(&set.bank), place).unwrap();
        let path = out.join(format!("{}.json", sample.stem));
        let json = read_scene(&path).unwrap();
        let found: Scene<f64> = json.to_scene(None, &Place::file(&path)).unwrap();
        for object in &truth.objects {
            let apart = |other: &dvp_core::Object<f64>| {
                let [dx, dy] = [0, 1].map(|i| other.pose.translation[i] - object.pose.translation[i]);
                // A hundredth of the image is 1.3 px.
                dx.hypot(dy) < 0.01 && other.prototype() == object.prototype()
            };
            assert!(found.objects.iter().any(apart), "{}: {object:?} is not in {found:?}", sample.stem);
        }
        assert!(!json.objects.is_empty());
        for object in &json.objects {
            let ShapeJson::Prototype { prototype, symmetry, .. } = object.shape else { panic!("{object:?}") };
            assert_eq!(symmetry, Some([1, 4, 2][prototype]));
        }
    }
}

#[test]
fn files_with_one_stem_do_not_replace_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let [data, out] = ["data", "out"].map(|name| folder.path().join(name));
    dvp_done(["generate", "--count", "1", "--width", "48", "--out", text(&data)]);
    let png = data.join("00000.png");
    let bmp = data.join("00000.bmp");
    image::open(&png).unwrap().save(&bmp).unwrap();
    let other = folder.path().join("other");
    fs::create_dir(&other).unwrap();
    fs::copy(&png, other.join("00000.png")).unwrap();
    let pattern = format!("{}/*.png", text(&other));
    dvp_done(["fit", text(&png), text(&bmp), text(&data), &pattern, "--out", text(&out), "--no-svg", "--no-png"]);
    assert_eq!(names(&out), ["00000.bmp.json", "00000.png-2.json", "00000.png.json"]);
}

#[test]
fn inputs_are_not_replaced() {
    let folder = tempfile::tempdir().unwrap();
    dvp_done(["generate", "--count", "1", "--width", "48", "--out", text(folder.path())]);
    let before = fs::read(folder.path().join("00000.png")).unwrap();
    let run = dvp(["fit", text(folder.path()), "--out", text(folder.path())]);
    assert!(run.code == 1 && run.err.contains("--no-png"), "{}", run.err);
    assert!(before == fs::read(folder.path().join("00000.png")).unwrap());
    dvp_done(["fit", text(folder.path()), "--out", text(folder.path()), "--no-png"]);
    assert!(names(folder.path()).contains(&"00000.svg".to_owned()));
}

#[test]
fn every_method_runs_and_the_number_of_threads_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let [data, start] = ["data", "start"].map(|name| folder.path().join(name));
    dvp_done(["generate", "--count", "2", "--width", "32", "--visible", "1", "--out", text(&data)]);
    dvp_done(["fit", text(&data), "--bank", "mdshr", "--out", text(&start), "--no-png", "--no-svg"]);
    for method in ["segment", "opt-iter", "live", "live-published", "opt-p", "rand-opt-p"] {
        let mut texts = Vec::new();
        for threads in ["1", "2"] {
            let out = folder.path().join(format!("{method}-{threads}"));
            let mut arguments = vec!["fit", text(&data), "--method", method, "--objects", "1", "--threads", threads];
            arguments.extend(["--out", text(&out), "--no-svg", "--no-png"]);
            if method == "opt-p" {
                arguments.extend(["--start", text(&start)]);
            }
            dvp_done(arguments);
            texts.push(["00000.json", "00001.json"].map(|name| fs::read(out.join(name)).unwrap()));
        }
        assert!(texts[0] == texts[1], "{method}");
    }
    let run = dvp(["fit", text(&data), "--method", "opt-p", "--out", text(&start)]);
    assert!(run.code == 1 && run.err.contains("--start"), "{}", run.err);
}

#[test]
fn live_draws_closed_paths_of_as_many_cubics_as_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let [data, out] = ["data", "out"].map(|name| folder.path().join(name));
    dvp_done(["generate", "--count", "1", "--width", "48", "--visible", "2", "--seed", "3", "--out", text(&data)]);
    let fit = |method: &'static str, options: &[&'static str]| {
        let arguments = ["fit", text(&data), "--out", text(&out), "--no-png", "--method", method, "--json"];
        let said: Value =
            serde_json::from_str(&dvp_done(arguments.into_iter().chain(options.iter().copied()))).unwrap();
        let written: Value = serde_json::from_slice(&fs::read(out.join("00000.json")).unwrap()).unwrap();
        (said["images"][0]["mae"].as_f64().unwrap(), written)
    };
    let (loss, scene) = fit("live", &["--segments", "6"]);
    assert!(loss < 0.02, "{loss}");
    let objects = scene["objects"].as_array().unwrap();
    assert!((1..=8).contains(&objects.len()), "{scene}");
    for object in objects {
        assert_eq!(object["kind"], "path");
        let ring = &object["rings"][0];
        let [points, segments] = ["points", "segments"].map(|name| ring[name].as_array().unwrap());
        assert_eq!((points.len(), segments.len()), (6, 6), "closed");
        assert!(segments.iter().all(|segment| segment["kind"] == "cubic"), "{ring}");
    }
    let (_, scene) = fit("live-published", &["--objects", "2"]);
    assert_eq!(
        (scene["objects"].as_array().unwrap().len(), &scene["background"]),
        (2, &serde_json::json!([1.0, 1.0, 1.0]))
    );
    for (options, said) in [
        (&["--method", "segment", "--segments", "4"][..], "--method live"),
        (&["--method", "live", "--start", "net"], "--start net"),
    ] {
        let run = dvp(["fit", text(&data), "--out", text(&out)].into_iter().chain(options.iter().copied()));
        assert!(run.code == 1 && run.err.contains(said), "{}", run.err);
    }
    assert_eq!(dvp(["fit", text(&data), "--out", text(&out), "--method", "live", "--segments", "1"]).code, 2);
}

#[test]
fn what_is_hidden_and_marginal_gains_are_said() {
    let folder = tempfile::tempdir().unwrap();
    let svg = concat!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="128" height="128">"#,
        r##"<rect width="128" height="128" fill="#f0f0f0"/><circle cx="50" cy="60" r="32" fill="#c03030"/>"##,
        r##"<rect x="50.5" y="20" width="60" height="80" fill="#3050a0"/></svg>"##
    );
    let image = dvp_tests::draw_svg::draw_svg(svg).unwrap();
    let values: Vec<f32> = image.data().iter().map(|&v| dvp_core::Real::as_f32(v)).collect();
    let image = dvp_core::Image::from_planar(image.size(), values).unwrap();
    let (picture, out) = (folder.path().join("half.png"), folder.path().join("out"));
    fs::write(&picture, encode_png(image.view(), BitDepth::Eight).unwrap()).unwrap();
    // A compositing that is told asks for segments, which say what completed them.
    let arguments = ["fit", text(&picture), "--out", text(&out), "--compositing", "over"];
    let said: Value = serde_json::from_str(&dvp_done(arguments.into_iter().chain(["--json"]))).unwrap();
    let found = &said["images"][0];
    let known = found["known"].as_array().unwrap();
    let doubts = known[0]["doubts"].as_array().unwrap();
    let hidden = doubts.iter().find(|doubt| doubt["kind"] == "hidden").unwrap();
    assert_eq!(hidden["completion"], serde_json::json!({"kind": "rotation", "order": 0}));
    assert!((hidden["share"].as_f64().unwrap() - 0.5).abs() < 0.03, "{hidden}");
    let gains: Vec<f64> = known.iter().map(|known| known["marginal_gain"].as_f64().unwrap()).collect();
    // The square is darker and larger than what is seen of the disk, which is painted first.
    assert!(gains.len() == 2 && gains[1] > gains[0] && gains[0] > 0.1, "{gains:?}");
    assert_eq!(found["ranking"], serde_json::json!([1, 0]));
    assert!(said["summary"]["unexplained"].as_f64().unwrap() < 0.01);
    // The file says the same, and is what the schema says.
    let written: Value = serde_json::from_slice(&fs::read(out.join("half.json")).unwrap()).unwrap();
    let in_file: Vec<&Value> = written["objects"].as_array().unwrap().iter().map(|object| &object["known"]).collect();
    assert_eq!(in_file, known.iter().collect::<Vec<_>>());
    for name in ["stop", "unexplained", "noise", "bits", "doubts"] {
        assert!(!found[name].is_null());
        assert_eq!(written["known"][name], found[name], "{name}");
    }
    let schema = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/cli/schema/scene-3.schema.json");
    let schema: Value = serde_json::from_slice(&fs::read(schema).unwrap()).unwrap();
    jsonschema::validate(&schema, &written).unwrap();
    // Deviations are those of the covariance, that of the logarithm of the scale times the scale.
    let covariance = found["covariance"][1].as_array().unwrap();
    let variance = |k: usize| covariance[6 * k].as_f64().unwrap();
    let scale = written["objects"][1]["scale"].as_f64().unwrap_or(1.0);
    let deviations = &known[1]["deviations"];
    for (deviation, expected) in [
        (&deviations["translation"][0], variance(0).sqrt()),
        (&deviations["translation"][1], variance(1).sqrt()),
        (&deviations["scale"], scale * variance(2).sqrt()),
        (&deviations["rotation"], variance(3).sqrt()),
    ] {
        let deviation = deviation.as_f64().unwrap();
        assert!(deviation > 0.0 && (deviation / expected - 1.0).abs() < 1e-5, "{deviation} {expected}");
    }
    let table = dvp_done(arguments);
    assert!(table.contains("unexplained") && table.contains("1, to "), "{table}");
}
