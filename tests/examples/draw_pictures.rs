//! Draws `pictures/*.svg` as PNG with resvg: `cargo run -p dvp-tests --example draw_pictures`.

use core::error::Error;
use std::fs;
use std::path::Path;

use dvp::format::{BitDepth, encode_png, write_atomic};
use dvp_tests::draw_svg::draw_svg;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../pictures");
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|ending| ending == "svg") {
            let image = draw_svg(&fs::read_to_string(&path)?)?;
            write_atomic(&path.with_extension("png"), &encode_png(image.view(), BitDepth::Eight)?)?;
        }
    }
    Ok(())
}
