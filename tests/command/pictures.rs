//! The pictures shipped in `pictures/`: drawn by resvg from the SVG beside them.

use std::fs;
use std::path::{Path, PathBuf};

use dvp::format::{BitDepth, encode_png, read_picture, read_scene};
use dvp_core::Real;
use dvp_tests::draw_svg::draw_svg;

use crate::runner::{dvp_done, text};

fn sources() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../pictures");
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    paths.filter(|path| path.extension().is_some_and(|ending| ending == "svg")).collect()
}

#[test]
fn pictures_are_what_resvg_draws() {
    let sources = sources();
    assert!(!sources.is_empty());
    for source in sources {
        let drawn = draw_svg(&fs::read_to_string(&source).unwrap()).unwrap();
        let shipped = read_picture::<f64>(&source.with_extension("png"), 1 << 20).unwrap().image;
        // Another processor may round a pixel differently.
        let differences = drawn.data().iter().zip(shipped.data()).map(|(a, b)| (a - b).abs());
        let largest = differences.fold(0.0, f64::max);
        assert!(largest < 1.5 / 255.0, "{}: run the example draw_pictures", source.display());
        assert!(!encode_png(drawn.view(), BitDepth::Eight).unwrap().is_empty());
    }
}

#[test]
fn the_shipped_picture_is_taken_apart() {
    let out = tempfile::tempdir().unwrap();
    let picture = Path::new(env!("CARGO_MANIFEST_DIR")).join("../pictures/shapes.png");
    dvp_done(["fit", text(&picture), "--out", text(out.path())]);
    let found = read_scene(&out.path().join("shapes.json")).unwrap();
    // The eight fills of the SVG, whole bytes.
    let mut colors: Vec<[u8; 3]> = found.objects.iter().map(|object| object.color.map(byte)).collect();
    colors.sort_unstable();
    let expected = [
        [0x00, 0x3d, 0x5b],
        [0x2e, 0x86, 0xab],
        [0x66, 0xa1, 0x82],
        [0x6b, 0x9f, 0x83],
        [0x7d, 0x85, 0x97],
        [0x8f, 0x2d, 0x56],
        [0xd1, 0x49, 0x5b],
        [0xed, 0xae, 0x49],
    ];
    assert_eq!(colors, expected);
    // The disk and the square stand at (44, 44) and (124, 46); 192 pixels are one unit.
    for (color, center) in [(expected[6], [44.0, 44.0]), (expected[1], [124.0, 46.0])] {
        let object = found.objects.iter().find(|object| object.color.map(byte) == color).unwrap();
        let [dx, dy] = [0, 1].map(|i| object.translation[i] * 192.0 - center[i]);
        assert!(dx.hypot(dy) < 0.5, "{color:?} is off by {dx}, {dy} px");
    }
    // Drawing programs anti-alias by area, which the scene's edge only comes near to; measured 0.0006.
    let painted = read_picture::<f64>(&out.path().join("shapes.png"), 1 << 20).unwrap().image;
    let shipped = read_picture::<f64>(&picture, 1 << 20).unwrap().image;
    let total: f64 = painted.data().iter().zip(shipped.data()).map(|(a, b)| (a - b).abs()).sum();
    let mean = total / f64::of_usize(painted.data().len());
    assert!(mean < 0.0015, "{mean}");
}

/// The nearest byte; differences are not negative, so that they order as their bits.
fn byte(value: f64) -> u8 {
    (0..=u8::MAX).min_by_key(|&b| (f64::from(b) / 255.0 - value).abs().to_bits()).unwrap()
}
