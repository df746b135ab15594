//! Scores: exact where prediction and truth are the same, failures counted.

use std::fs;
use std::path::Path;

use dvp::format::{DataSet, read_picture};
use dvp::paint::Painter;
use dvp_core::render::hard::{HardMask, object_index};
use dvp_core::render::{Compositing, TileRenderer};
use dvp_core::{ImageSize, Scene};
use image::{ImageBuffer, Luma, Rgb, RgbImage, RgbaImage};
use serde_json::Value;

use crate::runner::{Run, dvp, dvp_done, names, text};

/// A data set, and its true scenes as predictions.
fn truth_as_prediction(folder: &Path, preset: &str) -> (String, String) {
    let [data, predictions] = ["data", "predictions"].map(|name| folder.join(name));
    dvp_done(["generate", "--count", "6", "--preset", preset, "--out", text(&data)]);
    fs::create_dir(&predictions).unwrap();
    for (sample, line) in DataSet::<f64>::open(&data)
        .unwrap()
        .samples
        .iter()
        .zip(fs::read_to_string(data.join("scenes.jsonl")).unwrap().lines())
    {
        fs::write(predictions.join(format!("{}.json", sample.stem)), line).unwrap();
    }
    (text(&data).to_owned(), text(&predictions).to_owned())
}

fn figures(run: &Run) -> Value {
    serde_json::from_str(&run.out).unwrap_or_else(|error| panic!("{error}: {} {}", run.out, run.err))
}

#[test]
fn the_truth_scores_exactly() {
    for preset in ["mds-hr", "multi-dsprites"] {
        let folder = tempfile::tempdir().unwrap();
        let (data, predictions) = truth_as_prediction(folder.path(), preset);
        let run = dvp(["evaluate", &predictions, &data, "--against", "float", "--json"]);
        let expected = serde_json::json!({
            "n": 6, "mae": 0.0, "mse": 0.0, "ssim": 1.0, "iou": 1.0, "ari": 1.0, "exact_count": 1.0, "failed": []
        });
        let mut figures = figures(&run);
        // A window of equal pixels gives 1 up to rounding.
        assert!((figures["ssim"].as_f64().unwrap() - 1.0).abs() < 1e-6);
        figures["ssim"] = 1.0.into();
        assert_eq!((run.code, figures), (0, expected));
    }
}

#[test]
fn eight_bits_cost_a_quarter_step() {
    let folder = tempfile::tempdir().unwrap();
    let (data, predictions) = truth_as_prediction(folder.path(), "mds-hr");
    let mae = figures(&dvp(["evaluate", &predictions, &data, "--json"]))["mae"].as_f64().unwrap();
    // Rounding errors are at most half a step of 1/255, a quarter on average; flat areas share theirs.
    assert!((0.02 / 255.0..0.5 / 255.0).contains(&mae), "{mae}");
}

#[test]
fn failures_are_listed_and_in_no_mean() {
    let folder = tempfile::tempdir().unwrap();
    let (data, predictions) = truth_as_prediction(folder.path(), "mds-hr");
    let predicted = |stem: &str| Path::new(&predictions).join(format!("{stem}.json"));
    fs::remove_file(predicted("00001")).unwrap();
    fs::write(predicted("00002"), "{\"what\": NaN}").unwrap();
    let wide = fs::read_to_string(predicted("00003")).unwrap().replace("\"width\":128", "\"width\":64");
    fs::write(predicted("00003"), wide).unwrap();
    let csv = folder.path().join("figures.csv");
    let run = dvp(["evaluate", &predictions, &data, "--against", "float", "--json", "--csv", text(&csv)]);
    let figures = figures(&run);
    assert_eq!((run.code, &figures["n"], &figures["mae"]), (1, &3.into(), &0.0.into()));
    let stems: Vec<&Value> = figures["failed"].as_array().unwrap().iter().map(|failure| &failure["stem"]).collect();
    assert_eq!(stems, ["00001", "00002", "00003"]);
    for part in ["00001: no prediction", "00002: ", "not a scene", "predicted 64 x 128 pixels for 128 x 128"] {
        assert!(run.err.contains(part), "'{}' lacks '{part}'", run.err);
    }
    let csv = fs::read_to_string(csv).unwrap();
    assert_eq!(csv.lines().count(), 7, "{csv}");
    assert!(csv.lines().nth(1).unwrap().starts_with("00000,0,0,1"), "{csv}");
}

#[test]
fn pictures_without_scenes_get_image_metrics() {
    let folder = tempfile::tempdir().unwrap();
    let (data, predictions) = truth_as_prediction(folder.path(), "mds-hr");
    fs::remove_file(Path::new(&data).join("scenes.jsonl")).unwrap();
    let run = dvp(["evaluate", &predictions, &data, "--json"]);
    let figures = figures(&run);
    assert_eq!((&figures["n"], &figures["iou"], run.code), (&6.into(), &Value::Null, 0));
    let table = dvp_done(["evaluate", &predictions, &data]);
    assert!(table.contains("exact count") && table.contains(" - "), "{table}");
}

#[test]
fn float_pixels_come_from_a_numpy_file() {
    let folder = tempfile::tempdir().unwrap();
    let (data, predictions) = truth_as_prediction(folder.path(), "mds-hr");
    // Two of the six pictures as (2, 128, 128, 3) bytes: only these are scored, and equal to their PNGs.
    let mut array = b"\x93NUMPY\x01\x00".to_vec();
    let header = format!("{:<117}\n", "{'descr': '|u1', 'fortran_order': False, 'shape': (2, 128, 128, 3), }");
    array.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    array.extend(header.as_bytes());
    for name in ["00000.png", "00001.png"] {
        let image = read_picture::<f64>(&Path::new(&data).join(name), 1 << 20).unwrap().image.to_interleaved();
        array.extend(
            image
                .iter()
                .map(|value| u8::try_from((0..=255).find(|&b| f64::from(b) / 255.0 >= *value).unwrap()).unwrap()),
        );
    }
    let npy = folder.path().join("float.npy");
    fs::write(&npy, array).unwrap();
    let from_npy = figures(&dvp(["evaluate", &predictions, &data, "--npy", text(&npy), "--json"]));
    for extra in 2..6 {
        fs::remove_file(Path::new(&predictions).join(format!("0000{extra}.json"))).unwrap();
    }
    let from_png = figures(&dvp(["evaluate", &predictions, &data, "--json"]));
    assert_eq!((&from_npy["n"], &from_npy["mae"]), (&2.into(), &from_png["mae"]));
    assert!(names(folder.path()).contains(&"float.npy".to_owned()));
}

#[test]
fn more_objects_than_a_byte_can_number_are_scored() {
    let folder = tempfile::tempdir().unwrap();
    let [data, predictions] = ["data", "predictions"].map(|name| folder.path().join(name));
    let crowd = ["--visible", "300", "--slots", "300", "--width", "256", "--scale", "0.01..0.03"];
    let generate = ["generate", "--count", "1", "--preset", "multi-dsprites", "--out", text(&data)];
    dvp_done(generate.into_iter().chain(crowd));
    fs::create_dir(&predictions).unwrap();
    fs::copy(data.join("scenes.jsonl"), predictions.join("00000.json")).unwrap();
    let csv = folder.path().join("figures.csv");
    dvp_done(["evaluate", text(&predictions), text(&data), "--csv", text(&csv)]);
    let csv = fs::read_to_string(csv).unwrap();
    let fields: Vec<&str> = csv.lines().nth(1).unwrap().split(',').collect();
    // Some are hidden altogether; the rest is seen on both sides.
    let [iou, ari, objects, found] = [4, 5, 6, 7].map(|i| fields[i].parse::<f64>().unwrap());
    assert!(objects > 255.0 && objects <= 300.0, "{csv}");
    assert_eq!([iou, ari, found].map(f64::to_bits), [1.0, 1.0, objects].map(f64::to_bits), "{csv}");
}

/// The topmost object of each pixel, from 1, of a scene of hard-edged objects.
fn label_map(scene: &Scene<f32>, side: usize) -> Vec<u32> {
    let size = ImageSize::new(side, side).unwrap();
    let drawing = Painter::default().draw(scene, size).unwrap();
    let mut coverage = vec![0.0; drawing.object_count() * size.pixels()];
    let renderer = TileRenderer { coverage: HardMask, compositing: Compositing::Over };
    renderer.object_coverage(&drawing, size, &mut Default::default(), &mut coverage).unwrap();
    let mut index = vec![0; size.pixels()];
    object_index(&coverage, &drawing.confidences, &mut index).unwrap();
    index
}

#[test]
fn label_maps_stand_in_for_scenes() {
    let folder = tempfile::tempdir().unwrap();
    let (data, predictions) = truth_as_prediction(folder.path(), "multi-dsprites");
    let set = DataSet::<f32>::open(Path::new(&data)).unwrap();
    for (k, sample) in set.samples.iter().enumerate() {
        let (json, place) = sample.scene.as_ref().unwrap();
        let labels = label_map(&json.to_scene(Some(&set.bank), place).unwrap(), 64);
        let path = Path::new(&data).join(format!("{}.labels.png", sample.stem));
        let at = |x: u32, y: u32| labels[usize::try_from(y * 64 + x).unwrap()];
        // By turns gray of 16 and of 8 bits with labels of all sizes, and colors.
        match k % 3 {
            0 => ImageBuffer::from_fn(64, 64, |x, y| Luma([u16::try_from(at(x, y) * 9001).unwrap()])).save(path),
            1 => ImageBuffer::from_fn(64, 64, |x, y| Luma([u8::try_from(at(x, y) * 40).unwrap()])).save(path),
            _ => RgbImage::from_fn(64, 64, |x, y| {
                Rgb([0, 1, u8::try_from(at(x, y)).unwrap()].map(|v| v * u8::from(at(x, y) > 0)))
            })
            .save(path),
        }
        .unwrap();
    }
    fs::remove_file(Path::new(&data).join("scenes.jsonl")).unwrap();
    let run = dvp(["evaluate", &predictions, &data, "--json"]);
    let figures = figures(&run);
    assert_eq!((run.code, &figures["n"]), (0, &6.into()), "{}", run.err);
    assert_eq!((&figures["iou"], &figures["ari"], &figures["exact_count"]), (&1.0.into(), &1.0.into(), &1.0.into()));
    // Label maps are no pictures.
    let out = folder.path().join("out");
    dvp_done(["fit", &data, "--out", text(&out), "--no-svg", "--no-png"]);
    assert_eq!(names(&out).len(), 6);
}

#[test]
fn bad_label_maps_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (data, predictions) = truth_as_prediction(folder.path(), "multi-dsprites");
    RgbaImage::new(64, 64).save(Path::new(&data).join("00001.labels.png")).unwrap();
    RgbImage::new(64, 32).save(Path::new(&data).join("00003.labels.png")).unwrap();
    let run = dvp(["evaluate", &predictions, &data, "--json"]);
    assert_eq!((run.code, &figures(&run)["n"]), (1, &4.into()));
    for part in ["Rgba8 are no labels", "64 x 32 labels for 64 x 64 pixels"] {
        assert!(run.err.contains(part), "'{}' lacks '{part}'", run.err);
    }
}
