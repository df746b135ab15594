//! SVG against pixels: what resvg draws is what our renderer paints.

use std::fs;

use dvp::format::{DataSet, read_picture};
use dvp::paint::Painter;
use dvp_core::{Image, Real, Scene};
use dvp_tests::draw_svg::draw_svg;

use crate::runner::{dvp_done, text};

fn mean_difference(a: &Image<f64>, b: &Image<f64>) -> f64 {
    let total: f64 = a.data().iter().zip(b.data()).map(|(a, b)| (a - b).abs()).sum();
    total / f64::of_usize(a.data().len())
}

/// Mean absolute error of the SVG of each of 24 random scenes with `visible` objects, and its length in bytes.
fn errors(visible: &str, options: &[&str]) -> Vec<(f64, usize)> {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("data");
    let generate = ["generate", "--count", "24", "--visible", visible, "--out", text(&data)];
    dvp_done(generate.into_iter().chain(options.iter().copied()));
    let set = DataSet::<f64>::open(&data).unwrap();
    let svg = folder.path().join("scene.svg");
    let samples = set.samples.iter().enumerate().map(|(index, sample)| {
        let scenes = data.join("scenes.jsonl");
        dvp_done(["render", text(&scenes), "--index", &index.to_string(), "-o", text(&svg)]);
        let drawn = fs::read_to_string(&svg).unwrap();
        let (json, place) = sample.scene.as_ref().unwrap();
        let scene: Scene<f64> = json.to_scene(Some(&set.bank), place).unwrap();
        let image = Painter::default().paint(&scene, json.size(place).unwrap().unwrap()).unwrap();
        (mean_difference(&draw_svg(&drawn).unwrap(), &image), drawn.len())
    });
    samples.collect()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = f64::of_usize(values.len());
    values.sum::<f64>() / count
}

#[test]
fn without_overlap_the_visible_edge_is_where_the_renderer_has_it() {
    // Plain polygons at the outline score 0.01, with the stroke 0.0011 (colors of 8 bits alone cost 0.00098).
    let errors = errors("1", &[]);
    let mean = mean(errors.iter().map(|&(error, _)| error));
    assert!(mean < 0.00125, "{mean}: {errors:?}");
}

#[test]
fn overlaps_show_the_mean_color() {
    let errors = errors("3..4", &["--scale", "0.25..0.35"]);
    let mean = mean(errors.iter().map(|&(error, _)| error));
    assert!(mean < 0.0022, "{mean}: {errors:?}");
}

#[test]
fn occlusion_follows_the_painter_order() {
    let errors = errors("3..4", &["--scale", "0.25..0.35", "--compositing", "over"]);
    let mean = mean(errors.iter().map(|&(error, _)| error));
    assert!(mean < 0.0022, "{mean}: {errors:?}");
}

#[test]
fn files_are_compact() {
    let errors = errors("1", &[]);
    let mean = mean(errors.iter().map(|&(_, bytes)| f64::of_usize(bytes)));
    // Measured 636; the 64 vertices of one outline alone are about 900 at this precision.
    assert!(mean < 800.0, "{mean} bytes");
}

#[test]
fn fits_come_with_an_svg_that_looks_like_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let [data, out] = ["data", "out"].map(|name| folder.path().join(name));
    dvp_done(["generate", "--count", "1", "--visible", "1", "--out", text(&data)]);
    let picture = data.join("00000.png");
    dvp_done(["fit", text(&picture), "--bank", "mdshr", "--out", text(&out)]);
    let drawn = draw_svg(&fs::read_to_string(out.join("00000.svg")).unwrap()).unwrap();
    let error = mean_difference(&drawn, &read_picture(&picture, 1 << 20).unwrap().image);
    assert!(error < 0.002, "{error}");
}
