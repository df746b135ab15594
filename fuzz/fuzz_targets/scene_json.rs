//! Any bytes as a scene: an error or a scene that survives being written and read.
#![no_main]

use std::path::Path;

use dvp::format::{Place, SceneJson};
use dvp_core::ImageSize;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &[u8]| {
    let place = Place::file(Path::new("fuzz.json"));
    let Ok(json) = SceneJson::parse(text, &place) else { return };
    let (Ok(scene), Ok(size)) = (json.to_scene::<f64>(None, &place), json.size(&place)) else { return };
    let size = size.unwrap_or(ImageSize::new(8, 8).expect("8 x 8 is a size"));
    let line = SceneJson::from_scene(&scene, size).to_line(&place).expect("numbers that were checked are written");
    let again = SceneJson::parse(line.as_bytes(), &place).expect("what was written is read");
    assert_eq!(again.to_scene::<f64>(None, &place).expect("and is a scene").objects.len(), scene.objects.len());
});
