//! Draws `pictures/gallery.png` and prints the table that goes with it in the README: six kinds of pictures, each with its
//! reconstruction and with the outlines found over it.
//!
//! `cargo run --release -p dvp-tests --example gallery`

use core::error::Error;
use core::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::Path;

use dvp::format::{BitDepth, Place, encode_png, read_picture, read_scene, write_atomic};
use dvp::paint::Painter;
use dvp_core::{Image, ImageSize, Real, Scene};
use dvp_tests::picture_set::{Finish, crowd, score_folder};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

type Failure = Box<dyn Error>;

/// Screen pixels of a panel, between panels, and between the pictures of a row.
const PANEL: [usize; 2] = [320, 256];
const GAP: usize = 8;
const WIDE_GAP: usize = 32;

/// Pictures per row.
const ACROSS: usize = 2;

/// Screen pixels per pixel of small pictures.
const ZOOM: usize = 2;

/// Title, SVG, and what happens to the picture.
const KINDS: [(&str, &str, Finish); 5] = [
    ("diagram", "flat/bar_chart", Finish::Png),
    ("occlusion", "occlusion/tree", Finish::Png),
    ("cells", "cells/red_cells", Finish::Png),
    ("noise 0.05", "coins/table", Finish::Noise(0.05)),
    ("JPEG, quality 50", "flat/leaf", Finish::Jpeg(50)),
];

/// The sixth kind is drawn at random.
const CROWD: (&str, u32, usize) = ("crowd", 256, 80);

fn main() -> Result<(), Failure> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let temporary = tempfile::tempdir()?;
    let (data, out) = (temporary.path().join("data"), temporary.path().join("out"));
    fs::create_dir(&data)?;
    let mut titles = Vec::new();
    for (title, source, finish) in KINDS {
        let text = fs::read_to_string(root.join("pictures").join(source).with_extension("svg"))?;
        finish.write_drawn(&data, &format!("{}", titles.len()), &text, 1)?;
        titles.push(title);
    }
    let (title, side, count) = CROWD;
    Finish::Png.write_drawn(&data, &format!("{}", titles.len()), &crowd(side, count, 1), 1)?;
    titles.push(title);

    let (scores, failures) = score_folder(temporary.path(), &[])?;
    let mut screen = std::io::stdout().lock();
    writeln!(screen, "| picture | pixels | objects | found | MAE | ARI | ms |\n|---|---|---|---|---|---|---|")?;
    let rows = titles.len().div_ceil(ACROSS);
    let sides = [ACROSS * (3 * PANEL[0] + 2 * GAP + WIDE_GAP) - WIDE_GAP, rows * (PANEL[1] + GAP) - GAP];
    let mut sheet = Image::<f64>::zeros(ImageSize::new(sides[0], sides[1])?);
    sheet.data_mut().fill(1.0);
    for score in &scores {
        let index: usize = score.stem.parse()?;
        let input = read_picture::<f64>(&data.join(format!("{index}.png")), 1 << 24)?.image;
        let (width, height) = (input.size().width(), input.size().height());
        writeln!(
            screen,
            "| {} | {width} x {height} | {} | {} | {:.4} | {:.3} | {:.1} |",
            titles[index], score.objects, score.found, score.mae, score.ari, score.ms
        )?;
        let zoom = if ZOOM * width <= PANEL[0] && ZOOM * height <= PANEL[1] { ZOOM } else { 1 };
        let json = out.join(format!("{index}.json"));
        let scene: Scene<f64> = read_scene(&json)?.to_scene(None, &Place::file(&json))?;
        let outlines = with_outlines(&enlarged(&input, zoom)?, &scene, zoom)?;
        let painted = read_picture(&out.join(format!("{index}.png")), 1 << 24)?.image;
        let left = index % ACROSS * (3 * PANEL[0] + 2 * GAP + WIDE_GAP);
        let top = index / ACROSS * (PANEL[1] + GAP);
        for (panel, k) in [enlarged(&input, zoom)?, enlarged(&painted, zoom)?, outlines].iter().zip(0..) {
            put(&mut sheet, panel, [left + k * (PANEL[0] + GAP), top]);
        }
    }
    write!(screen, "{failures}")?;
    // Smaller than the command cares to make it: the file is committed.
    let sheet = image::load_from_memory(&encode_png(sheet.view(), BitDepth::Eight)?)?;
    let mut png = Vec::new();
    sheet.write_with_encoder(PngEncoder::new_with_quality(&mut png, CompressionType::Best, FilterType::Adaptive))?;
    write_atomic(&root.join("../pictures/gallery.png"), &png)?;
    Ok(())
}

fn enlarged(image: &Image<f64>, zoom: usize) -> Result<Image<f64>, Failure> {
    let (width, height) = (image.size().width(), image.size().height());
    let mut large = Image::zeros(ImageSize::new(width * zoom, height * zoom)?);
    for (i, value) in large.data_mut().iter_mut().enumerate() {
        let (row, column) = (i / (width * zoom) / zoom, i % (width * zoom) / zoom);
        // Rows of all three planes follow each other.
        *value = image.data()[row * width + column];
    }
    Ok(large)
}

/// The outlines of the scene, dark with a light rim, over the faded picture.
fn with_outlines(picture: &Image<f64>, scene: &Scene<f64>, zoom: usize) -> Result<Image<f64>, Failure> {
    let (width, height) = (picture.size().width(), picture.size().height());
    let unit = f64::of_usize(picture.size().unit_px());
    let drawing = Painter::default().draw(scene, picture.size())?;
    let mut text = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\">");
    for k in 0..drawing.object_count() {
        let mut points = String::new();
        for [x, y] in &drawing.vertices[drawing.starts[k]..drawing.starts[k + 1]] {
            write!(points, "{:.2},{:.2} ", x * unit, y * unit)?;
        }
        for (color, wide) in [("#fff", 2 * zoom), ("#d0006f", zoom)] {
            write!(text, "<polygon points=\"{points}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{wide}\"/>")?;
        }
    }
    text.push_str("</svg>");
    let tree = Tree::from_str(&text, &Options::default())?;
    let [columns, rows] = [width, height].map(u32::try_from);
    let mut lines = Pixmap::new(columns?, rows?).ok_or("an empty picture")?;
    resvg::render(&tree, Transform::identity(), &mut lines.as_mut());
    let mut image = picture.clone();
    for (channel, plane) in image.data_mut().chunks_exact_mut(width * height).enumerate() {
        for (value, line) in plane.iter_mut().zip(lines.pixels()) {
            let over = [line.red(), line.green(), line.blue()][channel];
            let faded = 0.6 + 0.4 * *value;
            *value = f64::from(over) / 255.0 + faded * (1.0 - f64::from(line.alpha()) / 255.0);
        }
    }
    Ok(image)
}

/// Puts a picture into the middle of the panel at `corner`; what does not fit is cut.
fn put(sheet: &mut Image<f64>, picture: &Image<f64>, corner: [usize; 2]) {
    let (across, down) = (sheet.size().width(), sheet.size().height());
    let (width, height) = (picture.size().width(), picture.size().height());
    let left = corner[0] + PANEL[0].saturating_sub(width) / 2;
    let top = corner[1] + PANEL[1].saturating_sub(height) / 2;
    let (columns, rows) = (width.min(across - left), height.min(down - top));
    for (i, line) in picture.data().chunks(width).enumerate().filter(|(i, _)| i % height < rows) {
        let start = (i / height * down + top + i % height) * across + left;
        sheet.data_mut()[start..start + columns].copy_from_slice(&line[..columns]);
    }
}
