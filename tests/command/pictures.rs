//! The pictures shipped in `pictures/`: drawn by resvg from the SVG beside them.

use std::fs;
use std::path::{Path, PathBuf};

use dvp::format::{encode_png, read_picture};
use dvp_tests::draw_svg::draw_svg;

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
        let shipped = read_picture::<f64>(&source.with_extension("png"), 1 << 20).unwrap();
        // Another processor may round a pixel differently.
        let differences = drawn.data().iter().zip(shipped.data()).map(|(a, b)| (a - b).abs());
        let largest = differences.fold(0.0, f64::max);
        assert!(largest < 1.5 / 255.0, "{}: run the example draw_pictures", source.display());
        assert!(!encode_png(drawn.view()).unwrap().is_empty());
    }
}
