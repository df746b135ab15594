//! Drawings that went through a coder of photographs are drawings: no stain is an object, no ringing a number.

use std::fs;

use dvp::spoil::jpeg;
use dvp_tests::draw_svg::draw_svg;
use image::RgbImage;
use serde_json::Value;

use crate::runner::{dvp_done, text};

/// A face and its hair of the same brightness, a ring over both, a rectangle, and a square of a few pixels.
const DRAWING: &str = r##"<svg xmlns="http://www.w3.org/2000/svg" width="256" height="256">
<rect width="256" height="256" fill="#ffffff"/>
<circle cx="92" cy="90" r="62" fill="#ffe51e"/>
<circle cx="104" cy="128" r="54" fill="#f3d2a2"/>
<path d="M206 40a30 30 0 1 0 .01 0zM206 54a16 16 0 1 1 -.01 0z" fill="#66221a" fill-rule="evenodd"/>
<rect x="150" y="170" width="90" height="50" fill="#3b94d9"/>
<rect x="40" y="214" width="12" height="12" fill="#444444"/>
</svg>"##;

/// Kind and color of what was drawn, from back to front; no kind where brightness is the same on both sides of a boundary, which a coder
/// leaves too vague to be that of a circle.
const DRAWN: [(&str, [f64; 3]); 5] = [
    ("circle", [255.0, 229.0, 30.0]),
    ("", [243.0, 210.0, 162.0]),
    ("stroke", [102.0, 34.0, 26.0]),
    ("rectangle", [59.0, 148.0, 217.0]),
    ("rectangle", [68.0, 68.0, 68.0]),
];

#[test]
fn stains_and_ringing_are_no_objects() {
    let folder = tempfile::tempdir().unwrap();
    let drawn = draw_svg(DRAWING).unwrap();
    let picture = RgbImage::from_fn(256, 256, |x, y| {
        let pixel = drawn.view().pixel(usize::try_from(y * 256 + x).unwrap());
        image::Rgb(pixel.map(|value| format!("{:.0}", 255.0 * value).parse().unwrap()))
    });
    for quality in [60, 80, 95] {
        let path = folder.path().join("coded.jpg");
        fs::write(&path, jpeg(&picture, quality).unwrap()).unwrap();
        let out = folder.path().join("out");
        dvp_done(["fit", text(&path), "--out", text(&out)]);
        let scene: Value = serde_json::from_str(&fs::read_to_string(out.join("coded.json")).unwrap()).unwrap();
        let objects = scene["objects"].as_array().unwrap();
        let found: Vec<(&str, [f64; 3])> = objects
            .iter()
            .map(|object| {
                let channel = |c: usize| (255.0 * object["color"][c].as_f64().unwrap()).round();
                (object["kind"].as_str().unwrap(), [channel(0), channel(1), channel(2)])
            })
            .collect();
        assert_eq!(found.len(), DRAWN.len(), "quality {quality}: {found:?}");
        for (kind, color) in DRAWN {
            let is_it = |other: &&(&str, [f64; 3])| (0..3).all(|c| (other.1[c] - color[c]).abs() < 8.0);
            let found_kind = found.iter().find(is_it).map(|found| found.0);
            let is_right = found_kind.is_some() && (kind.is_empty() || found_kind == Some(kind));
            assert!(is_right, "quality {quality}: {kind} {color:?} in {found:?}");
        }
    }
}
