//! Drawings refined on pictures: an SVG whose numbers were shaken comes back as the SVG that it was.

use std::fs;
use std::path::Path;

use dvp::format::{BitDepth, Place, encode_png, encode_png_rgba, read_picture_rgba, read_scene};
use dvp_core::image::RgbaImage;
use dvp_core::shape::{AnyShape, Shape as _};
use dvp_tests::draw_svg::draw_svg_rgba;
use serde_json::Value;

use crate::runner::{dvp, dvp_done, text};

const RIGHT: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 48 32" width="48" height="32">
<circle cx="12" cy="16" r="8" fill="#d02030"/>
<rect x="24" y="6" width="16" height="12" rx="3" fill="#2050c0"/>
<path d="M6 28 L20 26 L42 27.5" fill="none" stroke="#108040" stroke-width="3" stroke-linecap="round"/>
</svg>"##;

const WRONG: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 48 32" width="48" height="32">
<circle cx="12.4" cy="15.7" r="7.6" fill="#d83820"/>
<rect x="23.6" y="6.3" width="16.5" height="11.6" rx="2.6" fill="#2858b0"/>
<path d="M6.3 27.7 L20 26.4 L41.7 27.2" fill="none" stroke="#188848" stroke-width="3.4" stroke-linecap="round"/>
</svg>"##;

/// The picture that resvg draws of an SVG, as a file.
fn picture(path: &Path, svg: &str, width: usize) -> RgbaImage<f64> {
    let image = draw_svg_rgba(svg, width).unwrap();
    fs::write(path, encode_png_rgba(&image, BitDepth::Eight).unwrap()).unwrap();
    image
}

/// A picture with its alpha.
fn read(path: &Path) -> RgbaImage<f64> {
    read_picture_rgba(path, 1 << 20).unwrap()
}

fn error(a: &RgbaImage<f64>, b: &RgbaImage<f64>) -> f64 {
    a.data().iter().zip(b.data()).map(|(a, b)| (a - b).abs()).sum::<f64>() / a.data().len() as f64
}

#[test]
fn a_shaken_drawing_comes_back() {
    let folder = tempfile::tempdir().unwrap();
    let [drawing, target, better] = ["drawing.svg", "picture.png", "better.svg"].map(|name| folder.path().join(name));
    fs::write(&drawing, WRONG).unwrap();
    picture(&target, RIGHT, 96);
    let said = dvp_done(["refine", text(&drawing), text(&target), "-o", text(&better), "--json"]);
    let said: Value = serde_json::from_str(&said).unwrap();
    assert_eq!((&said["objects"], &said["stop"]), (&Value::from(3), &Value::from("converged")), "{said}");
    let (before, after) = (said["rms_before"].as_f64().unwrap(), said["rms_after"].as_f64().unwrap());
    assert!(after < 0.1 * before, "{said}");
    let found = fs::read_to_string(&better).unwrap();
    for element in ["<circle ", "<rect ", "stroke-linecap=\"round\"", "width=\"48\"", "height=\"32\""] {
        assert!(found.contains(element), "no {element}: {found}");
    }
    let [right, wrong, better] = [RIGHT, WRONG, &found].map(|svg| draw_svg_rgba(svg, 4 * 48).unwrap());
    let (before, after) = (error(&wrong, &right), error(&better, &right));
    assert!(after < 0.1 * before, "{before} -> {after}: {found}");
}

#[test]
fn scenes_are_refined_and_written_as_scenes_and_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let [svg, drawing, target, better, drawn] =
        ["drawing.svg", "drawing.json", "picture.png", "better.json", "better.png"]
            .map(|name| folder.path().join(name));
    fs::write(&svg, WRONG).unwrap();
    dvp_done(["render", text(&svg), "-o", text(&drawing)]);
    let right = picture(&target, RIGHT, 96);
    dvp_done(["refine", text(&drawing), text(&target), "-o", text(&better)]);
    let scene = read_scene(&better).unwrap();
    assert_eq!((scene.width, scene.height, scene.background), (Some(48), Some(32), None));
    let scene = scene.to_scene::<f64>(None, &Place::file(&better)).unwrap();
    let kinds: Vec<&str> = scene.objects.iter().map(|object| object.shape.kind()).collect();
    assert_eq!(kinds, ["circle", "rectangle", "stroke"]);
    let said = dvp_done(["refine", text(&drawing), text(&target), "-o", text(&drawn)]);
    assert!(said.contains("root mean squared error") && said.contains("converged"), "{said}");
    let found = read(&drawn);
    assert_eq!(found.size(), right.size());
    assert!(error(&found, &right) < 2e-3, "{}", error(&found, &right));
}

#[test]
fn a_picture_without_alpha_is_what_the_drawing_is_put_over() {
    let folder = tempfile::tempdir().unwrap();
    let [drawing, target, better] = ["drawing.svg", "picture.png", "better.svg"].map(|name| folder.path().join(name));
    fs::write(&drawing, WRONG).unwrap();
    let right = draw_svg_rgba(RIGHT, 96).unwrap();
    let image = right.on([0.9, 0.95, 1.0]);
    fs::write(&target, encode_png(image.view(), BitDepth::Eight).unwrap()).unwrap();
    dvp_done(["refine", text(&drawing), text(&target), "-o", text(&better)]);
    let found = fs::read_to_string(&better).unwrap();
    let [right, wrong, better] = [RIGHT, WRONG, &found].map(|svg| draw_svg_rgba(svg, 4 * 48).unwrap());
    let (before, after) = (error(&wrong, &right), error(&better, &right));
    assert!(after < 0.1 * before, "{before} -> {after}: {found}");
}

#[test]
fn what_a_scene_tells_of_its_numbers_stays_while_they_do() {
    let folder = tempfile::tempdir().unwrap();
    let [picture, out, again] = ["a.png", "out", "AGAIN.JSON"].map(|name| folder.path().join(name));
    fs::write(&picture, encode_png(draw_svg_rgba(RIGHT, 96).unwrap().on([1.0; 3]).view(), BitDepth::Eight).unwrap())
        .unwrap();
    dvp_done(["fit", text(&picture), "--out", text(&out)]);
    let first = out.join("a.json");
    dvp_done(["render", text(&first), "-o", text(&again)]);
    let [first, again] = [first, again].map(|path| read_scene(&path).unwrap());
    assert!(first.known.is_some() && first.objects.iter().all(|object| object.known.is_some()), "{first:?}");
    assert_eq!((&again.known, &again.objects), (&first.known, &first.objects));
}

#[test]
fn what_cannot_be_refined_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let [drawing, target, better] = ["drawing.svg", "picture.png", "better.svg"].map(|name| folder.path().join(name));
    fs::write(&drawing, WRONG).unwrap();
    picture(&target, &RIGHT.replace("0 0 48 32", "0 0 48 40").replace("height=\"32\"", "height=\"40\""), 96);
    let refused = |arguments: &[&str], because: &str| {
        let said = dvp(arguments.iter().copied());
        assert_eq!(said.code, 1, "{arguments:?}");
        assert!(said.err.contains(because), "{}", said.err);
        assert!(!better.exists());
    };
    refused(&["refine", text(&drawing), text(&target), "-o", text(&better)], "not in the ratio");
    refused(&["refine", text(&drawing), text(&target), "-o", "better.bmp"], "must end in .png, .svg or .json");
    refused(&["refine", text(&drawing), text(&target), "-o", text(&target)], "choose another -o");
    let missing = folder.path().join("missing.png");
    refused(&["refine", text(&drawing), text(&missing), "-o", text(&better)], "missing.png");
}

#[test]
fn drawings_become_pictures_with_alpha_and_scenes_that_draw_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let [svg, json, direct, again] = ["a.svg", "a.json", "a.png", "b.png"].map(|name| folder.path().join(name));
    fs::write(&svg, RIGHT).unwrap();
    dvp_done(["render", text(&svg), "-o", text(&json)]);
    dvp_done(["render", text(&svg), "-o", text(&direct), "--width", "192"]);
    dvp_done(["render", text(&json), "-o", text(&again), "--width", "192"]);
    let pixels = image::open(&direct).unwrap().into_rgba8();
    assert_eq!(pixels.get_pixel(0, 0).0, [0; 4], "nothing is clear");
    assert_eq!(pixels.get_pixel(48, 64).0, [0xd0, 0x20, 0x30, 255]);
    let [direct, again] = [direct, again].map(|path| read(&path));
    let apart = direct.data().iter().zip(again.data()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 2.5 / 255.0, "{apart}");
    let truth = draw_svg_rgba(RIGHT, 192).unwrap();
    assert_eq!(direct.size(), truth.size());
    assert!(error(&direct, &truth) < 1e-3, "{}", error(&direct, &truth));
    let scene = read_scene(&json).unwrap().to_scene::<f64>(None, &Place::file(&json)).unwrap();
    assert!(matches!(scene.objects[0].shape, AnyShape::Circle(_)));
}
