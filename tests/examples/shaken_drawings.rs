//! How well `dvp refine` brings drawings back whose numbers were shaken by a pixel.
//!
//! Takes SVG files. Of each, resvg draws a picture 256 px wide and one four times as wide. The drawing is read, every number of
//! its shapes and poses is moved at random by up to a pixel of the smaller picture, colors by up to 0.02. The shaken drawing and the
//! picture are files, which the command refines. Told are, at four times the size, the mean absolute errors (four channels) of the
//! drawing as read, as shaken and as refined, against resvg's picture.
//!
//! ```text
//! cargo run --release -p dvp-tests --example shaken_drawings -- --seed 7 a.svg b.svg
//! ```
//!
//! Bulges of arcs are no lengths: they move by 2 %. A shape that the shaking leaves without a boundary stays as it was.
//!
//! The figures of the README are of twenty files, five of each of four packages of npm, taken by their place in the alphabet of
//! those below 8 kB. Coats of arms are larger, and take long: the time of a step grows with the cube of the count of numbers.
//!
//! ```text
//! npm install @mdi/svg@7.4.47 @twemoji/svg@15.0.0 flag-icons@7.2.3 bootstrap-icons@1.11.3
//! for folder in @mdi/svg/svg @twemoji/svg flag-icons/flags/4x3 bootstrap-icons/icons; do
//!     find node_modules/$folder/*.svg -size -8192c | LC_ALL=C sort > names
//!     awk -v all=$(wc -l < names) 'int(5 * NR / all) > int(5 * (NR - 1) / all)' names
//! done > files
//! cargo run --release -p dvp-tests --example shaken_drawings -- --seed 20261122 $(cat files)
//! ```

#![expect(clippy::print_stdout, reason = "what it is for")]

use std::path::Path;

use dvp::format::{BitDepth, Place, SceneJson, encode_png_rgba, read_scene};
use dvp::paint::Painter;
use dvp::svg::from_svg;
use dvp_core::image::RgbaImage;
use dvp_core::shape::Shape as _;
use dvp_core::{ImageSize, Real as _, Scene};
use dvp_tests::draw_svg::draw_svg_rgba;
use rand::{RngExt as _, SeedableRng as _};
use rand_chacha::ChaCha8Rng;

/// Columns of the picture that drawings are refined on.
const WIDTH: usize = 256;
/// How much larger the errors are measured.
const LARGER: usize = 4;
/// Colors move by up to this.
const COLOR: f64 = 0.02;
/// Bulges move by up to this share.
const BULGE: f64 = 0.02;

struct Row {
    name: String,
    objects: usize,
    numbers: u64,
    steps: u64,
    seconds: f64,
    /// As read, shaken, refined.
    errors: [f64; 3],
}

impl Row {
    fn ratio(&self) -> f64 {
        self.errors[1] / self.errors[2]
    }
}

fn shaken(scene: &Scene<f64>, px: f64, rng: &mut ChaCha8Rng) -> Scene<f64> {
    let mut scene = scene.clone();
    for object in &mut scene.objects {
        let free = object.shape.pose_freedom();
        if free.translation {
            object.pose.translation.iter_mut().for_each(|value| *value += px * rng.random_range(-1.0..1.0));
        }
        let mut numbers = Vec::new();
        object.shape.numbers(&mut numbers);
        for (value, name) in numbers.iter_mut().zip(&object.shape.number_names()) {
            if name.ends_with("bulge") {
                *value *= 1.0 + BULGE * rng.random_range(-1.0..1.0);
            } else if *value != 0.0 || !name.ends_with("corner_radius") {
                // A sharp corner stays sharp: a radius cannot shrink below none.
                *value += px * rng.random_range(-1.0..1.0);
            }
        }
        let before = object.shape.clone();
        if object.shape.set_numbers(&numbers).is_err() || object.shape.boundary().is_err() {
            object.shape = before;
        }
        object.paint.colors_mut().flatten().for_each(|value| {
            *value = (*value + COLOR * rng.random_range(-1.0..1.0)).clamp(0.0, 1.0);
        });
    }
    scene
}

/// The mean absolute difference of our drawing and a picture.
fn error(scene: &Scene<f64>, truth: &RgbaImage<f64>) -> Result<f64, String> {
    let painter = Painter::default();
    let (sum, count) = if scene.transparent {
        let image = painter.paint_rgba(scene, truth.size()).map_err(|error| error.to_string())?;
        let sum: f64 = image.data().iter().zip(truth.data()).map(|(a, b)| (a - b).abs()).sum();
        (sum, image.data().len())
    } else {
        let image = painter.paint(scene, truth.size()).map_err(|error| error.to_string())?;
        let sum: f64 = image.data().iter().zip(truth.data()).map(|(a, b)| (a - b).abs()).sum();
        (sum, image.data().len())
    };
    Ok(sum / f64::of_usize(count))
}

/// What `dvp refine` makes of a drawing, and what it says of that.
fn refined(
    folder: &Path,
    drawing: &Scene<f64>,
    size: ImageSize,
    picture: &RgbaImage<f64>,
) -> Result<(Scene<f64>, serde_json::Value), String> {
    let [start, target, output] = ["start.json", "picture.png", "refined.json"].map(|name| folder.join(name));
    let words = |error: &dyn core::fmt::Display| error.to_string();
    let json = SceneJson::from_scene(drawing, size).map_err(|error| words(&error))?;
    let line = json.to_line(&Place::file(&start)).map_err(|error| words(&error))?;
    std::fs::write(&start, line).map_err(|error| words(&error))?;
    let png = encode_png_rgba(picture, BitDepth::Eight).map_err(|error| words(&error))?;
    std::fs::write(&target, png).map_err(|error| words(&error))?;
    let mut arguments: Vec<std::ffi::OsString> = vec!["dvp".into(), "refine".into(), "--json".into()];
    arguments.extend([start.into(), target.into(), "-o".into(), output.clone().into()]);
    let (mut out, mut err) = (Vec::new(), Vec::new());
    if dvp::command::run(arguments, &mut out, &mut err) != 0 {
        return Err(String::from_utf8_lossy(&err).trim().to_owned());
    }
    let told = serde_json::from_slice(&out).map_err(|error| words(&error))?;
    let place = Place::file(&output);
    let scene = read_scene(&output).and_then(|json| json.to_scene(None, &place)).map_err(|error| words(&error))?;
    Ok((scene, told))
}

fn row(path: &str, seed: u64, folder: &Path) -> Result<Row, String> {
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    let drawing = from_svg(&text).map_err(|error| error.to_string())?;
    let picture = draw_svg_rgba(&text, WIDTH)?;
    let truth = draw_svg_rgba(&text, LARGER * WIDTH)?;
    let px = 1.0 / f64::of_usize(picture.size().unit_px());
    let start = shaken(&drawing.scene, px, &mut ChaCha8Rng::seed_from_u64(seed));
    let (found, told) = refined(folder, &start, drawing.size, &picture)?;
    let kinds = |scene: &Scene<f64>| scene.objects.iter().map(|object| object.shape.kind()).collect::<Vec<_>>();
    if kinds(&found) != kinds(&drawing.scene) {
        return Err("the structure changed".to_owned());
    }
    Ok(Row {
        name: path.rsplit('/').take(2).collect::<Vec<_>>().into_iter().rev().collect::<Vec<_>>().join("/"),
        objects: start.objects.len(),
        numbers: told["numbers"].as_u64().ok_or("the command tells no numbers")?,
        steps: told["steps"].as_u64().ok_or("the command tells no steps")?,
        seconds: told["seconds"].as_f64().ok_or("the command tells no seconds")?,
        errors: [error(&drawing.scene, &truth)?, error(&start, &truth)?, error(&found, &truth)?],
    })
}

fn main() -> Result<(), String> {
    let mut arguments = std::env::args().skip(1).peekable();
    let mut seed = 1;
    if arguments.next_if(|argument| argument == "--seed").is_some() {
        let text = arguments.next().ok_or("--seed needs a number")?;
        seed = text.parse().map_err(|_| format!("--seed {text}: not a whole number"))?;
    }
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    println!("drawing objects numbers steps seconds  as read   shaken  refined  ratio");
    let mut rows = Vec::new();
    for path in arguments {
        match row(&path, seed, folder.path()) {
            Ok(row) => {
                let [read, shaken, refined] = row.errors;
                let Row { name, objects, numbers, steps, seconds, .. } = &row;
                let ratio = row.ratio();
                println!(
                    "{name} {objects} {numbers} {steps} {seconds:.2}  {read:.6} {shaken:.6} {refined:.6}  {ratio:.1}"
                );
                rows.push(row);
            }
            Err(error) => println!("{path}: {error}"),
        }
    }
    if rows.is_empty() {
        return Err("no drawing; give SVG files".to_owned());
    }
    let count = f64::of_usize(rows.len());
    let mean = |value: fn(&Row) -> f64| rows.iter().map(value).sum::<f64>() / count;
    let (shaken, refined) = (mean(|row| row.errors[1]), mean(|row| row.errors[2]));
    let tenfold = rows.iter().filter(|row| row.ratio() >= 10.0).count();
    println!(
        "{} drawings: mean error {shaken:.6} -> {refined:.6}, {:.1} times less; at least tenfold in {tenfold}; \
         smallest ratio {:.1}; mean {:.2} s, longest {:.2} s",
        rows.len(),
        shaken / refined,
        rows.iter().map(Row::ratio).fold(f64::INFINITY, f64::min),
        mean(|row| row.seconds),
        rows.iter().map(|row| row.seconds).fold(0.0, f64::max)
    );
    Ok(())
}
