//! Data sets: the same bytes every time, and pictures that `render` draws again.

use std::fs;

use dvp::format::read_picture;
use dvp_core::{Image, ImageView, Real};

use crate::runner::{dvp, dvp_done, names, text};

#[test]
fn the_same_options_give_the_same_bytes_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b] = ["a", "b"].map(|name| folder.path().join(name));
    dvp_done(["generate", "--count", "5", "--out", text(&a), "--threads", "1"]);
    dvp_done(["generate", "--count", "5", "--out", text(&b), "--threads", "3"]);
    assert_eq!(
        names(&a),
        ["00000.png", "00001.png", "00002.png", "00003.png", "00004.png", "bank.json", "scenes.jsonl"]
    );
    for name in names(&a) {
        assert!(fs::read(a.join(&name)).unwrap() == fs::read(b.join(&name)).unwrap(), "{name} differs");
    }
    let again = dvp(["generate", "--out", text(&a)]);
    assert!(again.code == 1 && again.err.contains("--overwrite"), "{}", again.err);
}

#[test]
fn render_draws_generated_pictures_again() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("data");
    let again = folder.path().join("again.png");
    for preset in ["mds-hr", "multi-dsprites"] {
        dvp_done(["generate", "--count", "3", "--preset", preset, "--overwrite", "--out", text(&data)]);
        for index in ["0", "2"] {
            let scenes = data.join("scenes.jsonl");
            dvp_done(["render", text(&scenes), "--index", index, "-o", text(&again)]);
            let first = fs::read(data.join(format!("0000{index}.png"))).unwrap();
            assert!(first == fs::read(&again).unwrap(), "{preset} {index}");
        }
    }
}

#[test]
fn hard_edges_have_no_mixed_pixels() {
    let folder = tempfile::tempdir().unwrap();
    dvp_done(["generate", "--count", "4", "--preset", "multi-dsprites", "--out", text(folder.path())]);
    for index in 0..4 {
        let image: Image<f32> = read_picture(&folder.path().join(format!("0000{index}.png")), 64 * 64).unwrap().image;
        // At most five objects and a background: six colors.
        let colors = colors(image.view());
        assert!((2..=6).contains(&colors), "{colors} colors");
    }
}

/// Mean absolute difference between two renderers' pictures of one scene.
fn difference(renderers: [&str; 2], edge: &[&str]) -> f64 {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("data");
    dvp_done(["generate", "--count", "1", "--seed", "5", "--out", text(&data)].into_iter().chain(edge.iter().copied()));
    let [a, b] = renderers.map(|renderer| {
        let file = folder.path().join(format!("{renderer}.png"));
        let scenes = data.join("scenes.jsonl");
        dvp_done(["render", text(&scenes), "--index", "0", "--renderer", renderer, "-o", text(&file)]);
        read_picture::<f64>(&file, 128 * 128).unwrap().image
    });
    let total: f64 = a.data().iter().zip(b.data()).map(|(a, b)| (a - b).abs()).sum();
    total / f64::of_usize(a.data().len())
}

#[test]
fn every_renderer_draws_about_the_same() {
    // Seams only: 5e-5 to 7e-4 on the images of MDS-HR.
    let seams = difference(["contour", "triangles"], &[]);
    assert!(seams > 0.0 && seams < 1e-3, "{seams}");
    // An offset of 0 puts the visible edge on the outline, where renderers without an edge profile draw it.
    let thin = ["--edge-offset", "0", "--edge-sigma", "1e-5", "--compositing", "over"];
    let [exact, hard] = ["exact", "hard"].map(|renderer| difference(["contour", renderer], &thin));
    assert!(exact > 0.0 && exact < 0.002, "{exact}");
    assert!(hard > exact && hard < 0.004, "{exact} {hard}");
}

#[test]
fn wrong_settings_name_the_option() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("data");
    for (option, value, code) in [
        ("--visible", "4..1", 1),
        ("--visible", "many", 2),
        ("--scale", "0.3..0.1", 2),
        ("--scale", "0..0.1", 1),
        ("--margin", "0.7", 1),
        ("--width", "0", 1),
        ("--vertices", "2", 2),
        ("--bank", "none", 1),
        ("--bank", "missing.json", 1),
    ] {
        let run = dvp(["generate", "--out", text(&out), option, value]);
        assert_eq!(run.code, code, "{option} {value}: {}", run.err);
        let named = run.err.contains(option) || run.err.contains(value);
        assert!(named && names(&out).is_empty(), "{option} {value}: {}", run.err);
    }
}

fn colors(image: ImageView<'_, f32>) -> usize {
    let pixels = 0..image.size().pixels();
    let mut colors: Vec<[u32; 3]> = pixels.map(|i| image.pixel(i).map(f32::to_bits)).collect();
    colors.sort_unstable();
    colors.dedup();
    colors.len()
}
