//! Any bytes as a scene: an error, or a scene that renderers paint or refuse, and that is written and read back as it was,
//! with all that is known of it; as SVG it is written or refused.
#![no_main]

use std::path::Path;

use dvp::format::{Place, SceneJson};
use dvp::svg::to_svg;
use dvp_core::{ImageSize, Real};
use dvp_fuzz::paint;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &[u8]| {
    let place = Place::file(Path::new("fuzz.json"));
    let Ok(json) = SceneJson::parse(text, &place) else { return };
    assert_eq!(read(&json.to_line(&place).expect("what was read is written"), &place), json);
    round_trip::<f64>(&json, &place);
    round_trip::<f32>(&json, &place);
});

fn read(line: &str, place: &Place) -> SceneJson {
    SceneJson::parse(line.as_bytes(), place).expect("what was written is read")
}

fn round_trip<T: Real>(json: &SceneJson, place: &Place) {
    let (Ok(scene), Ok(size)) = (json.to_scene::<T>(None, place), json.size(place)) else { return };
    let size = size.unwrap_or(ImageSize::new(8, 8).expect("8 x 8 is a size"));
    let written = SceneJson::from_scene(&scene, size).expect("every kind is written");
    let again = read(&written.to_line(place).expect("numbers that were checked are written"), place);
    assert_eq!(again, written);
    assert!(again.to_scene::<T>(None, place).expect("and is a scene") == scene);
    paint(&scene);
    let _ = to_svg(&scene, ImageSize::new(24, 16).expect("24 x 16 is a size"), None);
}
