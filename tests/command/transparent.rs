//! Transparent pictures are what is drawn on them; pictures of 16 bits stay pictures of 16 bits.

#![expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "values of pictures, made to be in range")]

use std::fs;
use std::path::Path;

use dvp::format::{ShapeJson, read_scene};
use image::{ColorType, DynamicImage, ImageBuffer, Rgb, Rgba, RgbaImage};
use serde_json::Value;

use crate::runner::{dvp_done, text};

const SIDE: u32 = 64;

/// Alpha of a disk of radius 20 around the center, soft over a pixel.
fn alpha(x: u32, y: u32) -> f64 {
    let [x, y] = [x, y].map(|v| f64::from(v) + 0.5 - f64::from(SIDE) / 2.0);
    (20.5 - x.hypot(y)).clamp(0.0, 1.0)
}

/// A disk of one color on nothing; where alpha is 0 the file has no color, as most programs write it.
fn disk(color: [u8; 3]) -> RgbaImage {
    RgbaImage::from_fn(SIDE, SIDE, |x, y| match (255.0 * alpha(x, y)).round() as u8 {
        0 => Rgba([0; 4]),
        alpha => Rgba([color[0], color[1], color[2], alpha]),
    })
}

/// What `dvp fit --json` says of a picture.
fn fitted(folder: &Path, name: &str, picture: &DynamicImage) -> Value {
    let (path, out) = (folder.join(name), folder.join("out"));
    picture.save(&path).unwrap();
    let said: Value = serde_json::from_str(&dvp_done(["fit", text(&path), "--out", text(&out), "--json"])).unwrap();
    said["images"][0].clone()
}

#[test]
fn an_icon_of_any_color_on_nothing_is_found() {
    let folder = tempfile::tempdir().unwrap();
    for color in [[255; 3], [0; 3], [255, 0, 0], [10, 200, 30], [128; 3]] {
        let said = fitted(folder.path(), "icon.png", &disk(color).into());
        assert_eq!(
            (&said["objects"], &said["transparent"]),
            (&Value::from(1), &Value::from(true)),
            "{color:?}: {said}"
        );
        assert_eq!(said["doubts"], serde_json::json!([]), "{color:?}");
        let scene = read_scene(&folder.path().join("out/icon.json")).unwrap();
        let object = &scene.objects[0];
        let off =
            object.color.iter().zip(color).map(|(found, true_color)| (found * 255.0 - f64::from(true_color)).abs());
        assert!(off.fold(0.0, f64::max) < 1.0, "{:?} in place of {color:?}", object.color);
        let ShapeJson::Circle { radius } = object.shape else { panic!("{:?}", object.shape) };
        assert!((object.scale * radius * f64::from(SIDE) - 20.0).abs() < 0.1, "{radius}");
    }
}

#[test]
fn a_full_alpha_is_no_transparency() {
    let folder = tempfile::tempdir().unwrap();
    let rgb = ImageBuffer::from_fn(SIDE, SIDE, |x, y| Rgb([255 - (200.0 * alpha(x, y)).round() as u8; 3]));
    let rgb = DynamicImage::from(rgb);
    let [plain, full] = [rgb.clone(), rgb.to_rgba8().into()].map(|picture| fitted(folder.path(), "a.png", &picture));
    assert_eq!((&plain["transparent"], &full["transparent"]), (&Value::from(false), &Value::from(false)));
    assert_eq!((&plain["objects"], &plain["mae"]), (&full["objects"], &full["mae"]));
}

#[test]
fn a_picture_of_nothing_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let nothing = RgbaImage::from_fn(SIDE, SIDE, |x, _| Rgba([x as u8, 0, 0, 0]));
    let said = fitted(folder.path(), "nothing.png", &nothing.into());
    assert_eq!((&said["objects"], &said["transparent"]), (&Value::from(0), &Value::from(true)));
    assert_eq!(said["doubts"], serde_json::json!(["invisible"]));
    let picture = folder.path().join("nothing.png");
    let table = dvp_done(["fit", text(&picture), "--out", text(&folder.path().join("out"))]);
    assert!(table.contains("invisible") && table.contains("1 transparent everywhere"), "{table}");
}

#[test]
fn a_picture_that_is_no_better_than_flat_says_so() {
    let folder = tempfile::tempdir().unwrap();
    // A smooth spiral of two arms.
    let wave = |x: f64, y: f64| (0.8 * x.hypot(y) + 2.0 * y.atan2(x)).sin();
    let value = |x: u32, y: u32| 127.5 + 127.5 * wave(f64::from(x) - 47.5, f64::from(y) - 47.5);
    let spiral = ImageBuffer::from_fn(96, 96, |x, y| Rgb([value(x, y).round() as u8; 3]));
    let said = fitted(folder.path(), "spiral.png", &DynamicImage::from(spiral));
    assert_eq!((&said["objects"], &said["stop"]), (&Value::from(0), &Value::from("no_better_than_flat")), "{said}");
    assert!(said["doubts"].as_array().unwrap().contains(&Value::from("stop")), "{said}");
    let picture = folder.path().join("spiral.png");
    let table = dvp_done(["fit", text(&picture), "--out", text(&folder.path().join("out"))]);
    assert!(table.contains("1 no better than one flat color"), "{table}");
}

#[test]
fn reconstructions_have_the_bits_of_their_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let steps = |most: f64| move |x: u32, y: u32| 0.25 * most * (1.0 + 2.0 * alpha(x, y));
    let (eight, sixteen) = (steps(255.0), steps(65535.0));
    let gray = ImageBuffer::from_fn(SIDE, SIDE, |x, y| image::Luma([sixteen(x, y).round() as u16]));
    let color = ImageBuffer::from_fn(SIDE, SIDE, |x, y| Rgb([sixteen(x, y).round() as u16, 0, 500]));
    let floats = ImageBuffer::from_fn(SIDE, SIDE, |x, y| Rgb([eight(x, y) as f32 / 255.0; 3]));
    let bytes = ImageBuffer::from_fn(SIDE, SIDE, |x, y| image::Luma([eight(x, y).round() as u8]));
    for (name, picture, expected) in [
        ("a.png", DynamicImage::from(gray.clone()), ColorType::Rgb16),
        ("b.tiff", DynamicImage::from(gray), ColorType::Rgb16),
        ("c.png", DynamicImage::from(color), ColorType::Rgb16),
        ("d.tiff", DynamicImage::from(floats), ColorType::Rgb16),
        ("e.png", DynamicImage::from(bytes), ColorType::Rgb8),
    ] {
        let said = fitted(folder.path(), name, &picture);
        assert_eq!(said["objects"], 1, "{name}: {said}");
        let out = folder.path().join("out").join(name).with_extension("png");
        let painted = image::load_from_memory(&fs::read(&out).unwrap()).unwrap();
        assert_eq!(painted.color(), expected, "{name}");
        // Finer than 8 bits where 16 were asked for: the disk is not at a step of 1/255.
        let worst = painted.to_rgb32f().into_raw().into_iter().zip(picture.to_rgb32f().into_raw());
        let worst = worst.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 0.03, "{name}: {worst}");
    }
}

#[test]
fn what_shows_nothing_is_cut_out() {
    let folder = tempfile::tempdir().unwrap();
    // A ring, and three stripes as large as the picture whose corners are clear: the middle one may be taken for the background.
    let ring = RgbaImage::from_fn(SIDE, SIDE, |x, y| {
        let [x, y] = [x, y].map(|v| f64::from(v) + 0.5 - f64::from(SIDE) / 2.0);
        let radius = x.hypot(y);
        Rgba([20, 30, 40, (255.0 * ((24.5 - radius).clamp(0.0, 1.0) - (12.5 - radius).clamp(0.0, 1.0))).round() as u8])
    });
    let flag = RgbaImage::from_fn(SIDE, SIDE, |x, y| {
        let [dx, dy] = [x, y].map(|v| f64::from(v) + 0.5 - f64::from(SIDE) / 2.0);
        let color = if (16..48).contains(&y) { [0, 60, 180] } else { [220, 20, 40] };
        Rgba([color[0], color[1], color[2], (255.0 * (32.5 - dx.hypot(dy)).clamp(0.0, 1.0)).round() as u8])
    });
    for (name, picture) in [("ring.png", ring), ("flag.png", flag)] {
        let said = fitted(folder.path(), name, &picture.clone().into());
        assert_eq!(said["transparent"], Value::from(true), "{said}");
        let found = image::open(folder.path().join("out").join(name)).unwrap().into_rgba8();
        let apart: f64 = picture
            .pixels()
            .zip(found.pixels())
            .map(|(a, b)| {
                // Premultiplied: what is clear has no color.
                let of = |pixel: &Rgba<u8>| {
                    let [r, g, b, alpha] = pixel.0.map(|value| f64::from(value) / 255.0);
                    [r * alpha, g * alpha, b * alpha, alpha]
                };
                of(a).iter().zip(of(b)).map(|(a, b)| (a - b).abs()).sum::<f64>()
            })
            .sum();
        let mean = apart / f64::from(4 * SIDE * SIDE);
        assert!(mean < 0.005, "{name}: {mean}");
    }
}
