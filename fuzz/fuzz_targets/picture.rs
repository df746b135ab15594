//! Pictures that may be drawings (sheets one over the other, strays, lines, transparent or coded): one scene with finite numbers, whichever of the two fits it takes.
#![no_main]

use arbitrary::Arbitrary;
use dvp_core::{Image, ImageSize, Shape as _};
use dvp_fit::picture::{Known, PictureScratch, fit_picture};
use dvp_fit::{FitOptions, Fitter};
use libfuzzer_sys::fuzz_target;

/// What is painted, one over the other; places and sizes in pixels.
#[derive(Arbitrary, Debug)]
enum Stroke {
    Sheet { at: [u8; 2], size: [u8; 2], color: u8 },
    Disk { at: [u8; 2], radius: u8, color: u8 },
    Line { from: [u8; 2], to: [u8; 2], color: u8 },
    Stray { at: [u8; 2], color: u8 },
}

#[derive(Arbitrary, Debug)]
struct Input {
    size: [u8; 2],
    background: u8,
    strokes: Vec<Stroke>,
    is_transparent: bool,
    coded: bool,
}

/// Four levels to a channel.
fn color(code: u8) -> [f32; 3] {
    [code % 4, code / 4 % 4, code / 16 % 4].map(|level| f32::from(level) / 3.0)
}

fuzz_target!(|input: Input| {
    let [width, height] = input.size.map(|side| 1 + usize::from(side % 64));
    let mut pixels = vec![color(input.background); width * height];
    for stroke in input.strokes.iter().take(24) {
        let (inside, code): (Box<dyn Fn(f32, f32) -> f32>, u8) = match *stroke {
            Stroke::Sheet { at, size, color } => {
                let [left, top, across, down] = [at[0], at[1], size[0], size[1]].map(|v| f32::from(v) / 4.0);
                (Box::new(move |x, y| f32::from(u8::from(x >= left && x < left + across && y >= top && y < top + down))), color)
            }
            Stroke::Disk { at, radius, color } => {
                let [x0, y0, radius] = [at[0], at[1], radius].map(|v| f32::from(v) / 4.0);
                (Box::new(move |x, y| (radius - (x - x0).hypot(y - y0) + 0.5).clamp(0.0, 1.0)), color)
            }
            Stroke::Line { from, to, color } => {
                let [x0, y0, x1, y1] = [from[0], from[1], to[0], to[1]].map(|v| f32::from(v) / 4.0);
                let (dx, dy) = (x1 - x0, y1 - y0);
                let length = dx.hypot(dy).max(0.1);
                (Box::new(move |x, y| {
                    let t = (((x - x0) * dx + (y - y0) * dy) / (length * length)).clamp(0.0, 1.0);
                    (1.0 - (x - x0 - t * dx).hypot(y - y0 - t * dy)).clamp(0.0, 1.0)
                }), color)
            }
            Stroke::Stray { at, color } => {
                let [x0, y0] = at.map(|v| f32::from(v % 64) + 0.5);
                (Box::new(move |x, y| f32::from(u8::from((x - x0).abs() < 0.5 && (y - y0).abs() < 0.5))), color)
            }
        };
        let paint = color(code);
        for (i, pixel) in pixels.iter_mut().enumerate() {
            let share = inside((i % width) as f32 + 0.5, (i / width) as f32 + 0.5);
            for (value, paint) in pixel.iter_mut().zip(paint) {
                *value += share * (paint - *value);
            }
        }
    }
    for value in pixels.as_flattened_mut() {
        *value = (*value * 255.0).round() / 255.0;
    }
    let size = ImageSize::new(width, height).expect("sides of 1 to 64");
    let image = Image::from_interleaved(size, pixels.as_flattened()).expect("finite, 3 values per pixel");
    let known = Known::default().with_matte(input.is_transparent.then(|| color(input.background))).with_coded(input.coded);
    let fitter = Fitter::new(FitOptions::default()).expect("the defaults");
    let Ok(fit) = fit_picture(&fitter, image.view(), &known, &mut PictureScratch::default()) else { return };
    assert!(fit.loss.is_finite() && !fit.bits.is_nan());
    for object in &fit.scene.objects {
        let mut shape = Vec::new();
        object.shape.numbers(&mut shape);
        let pose = &object.pose;
        let numbers = pose.translation.iter().chain([&pose.scale, &pose.rotation, &object.confidence]);
        let color = object.color();
        assert!(numbers.chain(&color).chain(&shape).all(|v| v.is_finite()), "{object:?}");
    }
});
