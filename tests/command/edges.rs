//! Edges from the picture to the files: kind and width are said, and the reconstruction has them.

use std::fs;
use std::path::Path;

use dvp::format::{BitDepth, encode_png, read_picture, read_scene};
use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile, HardRenderer, Renderer};
use dvp_core::{Drawing, Image, ImageSize, Real};
use dvp_tests::draw_svg::draw_svg;
use serde_json::Value;

use crate::runner::{dvp, text};

/// A disk, a turned square and a long upright rectangle.
fn drawing() -> Drawing<f32> {
    let mut drawing = Drawing { background: [0.9, 0.85, 0.8], ..Drawing::default() };
    let polygon = |count: u16, center: [f32; 2], half: [f32; 2], turn: f32| -> Vec<[f32; 2]> {
        let angles = (0..count).map(|i| turn + f32::from(i) / f32::from(count) * core::f32::consts::TAU);
        angles.map(|angle| [center[0] + half[0] * angle.cos(), center[1] + half[1] * angle.sin()]).collect()
    };
    drawing.push(&polygon(120, [0.3, 0.29], [0.17, 0.17], 0.0), [0.8, 0.2, 0.1], 1.0);
    drawing.push(&polygon(4, [0.71, 0.33], [0.2, 0.2], 0.3), [0.1, 0.3, 0.7], 1.0);
    let eighth = core::f32::consts::FRAC_PI_4;
    drawing.push(&polygon(4, [0.473, 0.762], [0.42, 0.16], eighth), [0.2, 0.6, 0.3], 1.0);
    drawing
}

/// The picture with edges of the kind as the fit names it, if `blur` blurred by a Gaussian of that deviation (px).
fn picture(kind: &str, deviation: f32, side: usize) -> Image<f32> {
    let size = ImageSize::new(side, side).unwrap();
    let mut image = Image::zeros(size);
    let by_profile = |edge| ContourRenderer::new(edge, Compositing::Over);
    match kind {
        "hard" => HardRenderer::default().render(&drawing(), size, &mut Default::default(), image.data_mut()),
        "reference" => {
            let renderer = by_profile(EdgeProfile::reference());
            renderer.render(&drawing(), size, &mut Default::default(), image.data_mut())
        }
        _ => by_profile(EdgeProfile::area()).render(&drawing(), size, &mut Default::default(), image.data_mut()),
    }
    .unwrap();
    if kind != "blur" {
        return image;
    }
    let side = u32::try_from(side).unwrap();
    let picture = image::RgbImage::from_raw(side, side, bytes(&image)).unwrap();
    let soft = image::imageops::blur(&picture, deviation);
    let values: Vec<f32> = soft.as_raw().iter().map(|&byte| f32::from(byte) / 255.0).collect();
    Image::from_interleaved(size, &values).unwrap()
}

fn bytes(image: &Image<f32>) -> Vec<u8> {
    let pixels = image.size().pixels();
    (0..3 * pixels)
        .map(|i| {
            let value = image.data()[i % 3 * pixels + i / 3] * 255.0;
            u8::try_from(value.round().to_count()).unwrap()
        })
        .collect()
}

fn mean_difference(a: &Image<f64>, b: &Image<f64>) -> f64 {
    a.data().iter().zip(b.data()).map(|(a, b)| (a - b).abs()).sum::<f64>() / f64::of_usize(a.data().len())
}

/// What the fit of a picture says and leaves.
#[derive(Debug)]
struct Fitted {
    kind: String,
    width_px: f64,
    objects: u64,
    version: u64,
    /// Mean absolute differences of PNG and SVG from the picture.
    png: f64,
    svg: f64,
}

fn fitted(folder: &Path, kind: &str, deviation: f32, side: usize) -> Fitted {
    let picture_path = folder.join(format!("{kind}-{deviation}-{side}.png"));
    fs::write(&picture_path, encode_png(picture(kind, deviation, side).view(), BitDepth::Eight).unwrap()).unwrap();
    let out = folder.join("out");
    let run = dvp(["fit", text(&picture_path), "--out", text(&out), "--json"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let said: Value = serde_json::from_str(&run.out).unwrap();
    let said = &said["images"][0];
    let result = |ending: &str| out.join(format!("{kind}-{deviation}-{side}.{ending}"));
    let read = |path: &Path| read_picture::<f64>(path, 1 << 20).unwrap().image;
    let drawn = draw_svg(&fs::read_to_string(result("svg")).unwrap()).unwrap();
    Fitted {
        kind: said["edge"]["kind"].as_str().unwrap().to_owned(),
        width_px: said["edge"]["width_px"].as_f64().unwrap(),
        objects: said["objects"].as_u64().unwrap(),
        version: read_scene(&result("json")).unwrap().version,
        png: mean_difference(&read(&result("png")), &read(&picture_path)),
        svg: mean_difference(&drawn, &read(&picture_path)),
    }
}

#[test]
fn kind_and_width_are_found_and_painted() {
    let folder = tempfile::tempdir().unwrap();
    // 10-90 % widths: 2.563 deviations of a Gaussian, with the 1/12 of a pixel's area; areas along the grid have 0.8.
    let gaussian = |deviation: f32| 2.563 * f64::from(deviation * deviation + 1.0 / 12.0).sqrt();
    // (side, kind, deviation, width, most error of PNG and SVG).
    for (side, kind, deviation, width, png, svg) in [
        (96, "reference", 0.0, 0.48, 0.0012, 0.0045),
        (96, "hard", 0.0, 0.11, 0.0006, 0.0040),
        (96, "area", 0.0, 0.83, 0.0011, 0.0017),
        (96, "blur", 0.5, gaussian(0.5), 0.0018, 0.0036),
        (96, "blur", 1.0, gaussian(1.0), 0.0023, 0.0052),
        (96, "blur", 1.5, gaussian(1.5), 0.0032, 0.0060),
        (200, "reference", 0.0, 1.01, 0.0008, 0.0020),
        (200, "hard", 0.0, 0.11, 0.0003, 0.0020),
        (200, "area", 0.0, 0.83, 0.0007, 0.0011),
        (200, "blur", 0.5, gaussian(0.5), 0.0007, 0.0017),
        (200, "blur", 1.0, gaussian(1.0), 0.0010, 0.0025),
        (200, "blur", 1.5, gaussian(1.5), 0.0014, 0.0032),
    ] {
        let found = fitted(folder.path(), kind, deviation, side);
        let what = format!("{side} {kind} {deviation}: {found:?}");
        assert_eq!((found.kind.as_str(), found.objects), (kind, 3), "{what}");
        assert_eq!(found.version, 3, "{what}");
        assert!((found.width_px / width - 1.0).abs() < 0.15, "{what}, not {width}");
        assert!(found.png < png && found.svg < svg, "{what}");
    }
}
