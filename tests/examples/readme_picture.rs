//! Draws `pictures/fit.png`, the picture on top of the README: input, reconstruction, outlines of the SVG.
//!
//! `cargo run --release -p dvp -- fit pictures/shapes.png --out out && cargo run -p dvp-tests --example readme_picture`

use core::error::Error;
use std::fs;
use std::path::Path;

use dvp::format::{BitDepth, encode_png, write_atomic};
use dvp_core::{Image, ImageSize};
use dvp_tests::draw_svg::draw_svg;

/// Screen pixels per picture pixel, and between the panels.
const ZOOM: usize = 2;
const GAP: usize = 16;

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let (pictures, out) = (root.join("pictures"), root.join("out"));
    let input = read(&pictures.join("shapes.png"))?;
    let (width, height) = (input.size().width(), input.size().height());
    let svg = fs::read_to_string(out.join("shapes.svg"))?
        .replace(
            &format!("width=\"{width}\" height=\"{height}\" viewBox"),
            &format!("width=\"{}\" height=\"{}\" viewBox", width * ZOOM, height * ZOOM),
        )
        .replace("fill-rule=\"evenodd\" stroke=\"none\"", "fill=\"none\" stroke-width=\".06\"");
    let panels = [enlarged(&input)?, enlarged(&read(&out.join("shapes.png"))?)?, draw_svg(&svg)?];
    write_atomic(&pictures.join("fit.png"), &encode_png(side_by_side(&panels)?.view(), BitDepth::Eight)?)?;
    Ok(())
}

fn read(path: &Path) -> Result<Image<f64>, Box<dyn Error>> {
    let pixels = image::open(path)?.to_rgb8();
    let [width, height] = [pixels.width(), pixels.height()].map(usize::try_from);
    let values: Vec<f64> = pixels.as_raw().iter().map(|&value| f64::from(value) / 255.0).collect();
    Ok(Image::from_interleaved(ImageSize::new(width?, height?)?, &values)?)
}

fn enlarged(image: &Image<f64>) -> Result<Image<f64>, Box<dyn Error>> {
    let (width, height) = (image.size().width(), image.size().height());
    let mut large = Image::zeros(ImageSize::new(width * ZOOM, height * ZOOM)?);
    for (i, value) in large.data_mut().iter_mut().enumerate() {
        let (row, column) = (i / (width * ZOOM) / ZOOM, i % (width * ZOOM) / ZOOM);
        // Rows of all three planes follow each other.
        *value = image.data()[row * width + column];
    }
    Ok(large)
}

fn side_by_side(panels: &[Image<f64>]) -> Result<Image<f64>, Box<dyn Error>> {
    let height = panels.iter().map(|panel| panel.size().height()).max().unwrap_or(1);
    let width = panels.iter().map(|panel| panel.size().width() + GAP).sum::<usize>() - GAP;
    let mut sheet = Image::zeros(ImageSize::new(width, height)?);
    sheet.data_mut().fill(1.0);
    let mut left = 0;
    for panel in panels {
        let (columns, rows) = (panel.size().width(), panel.size().height());
        for (i, line) in panel.data().chunks(columns).enumerate() {
            let start = (i / rows * height + i % rows) * width + left;
            sheet.data_mut()[start..start + columns].copy_from_slice(line);
        }
        left += columns + GAP;
    }
    Ok(sheet)
}
