use alloc::vec::Vec;

use dvp_core::{Image, ImageSize, Real};

use super::{AREA, BlockCode, CodeScratch, LUMA, SIDE, basis, step, transform};

const WIDTH: usize = 64;

/// A light square on a dark ground, gray.
fn square(light: f64) -> Vec<f64> {
    let inside = |x: usize| (11..37).contains(&x);
    (0..WIDTH * WIDTH).map(|i| if inside(i % WIDTH) && inside(i / WIDTH) { light } else { 0.3 }).collect()
}

fn gray(plane: &[f64]) -> Image<f64> {
    let values: Vec<f64> = plane.iter().flat_map(|&value| [value; 3]).collect();
    Image::from_interleaved(ImageSize::new(WIDTH, WIDTH).unwrap(), &values).unwrap()
}

/// What a coder of the given quality makes of a gray plane.
fn coded(plane: &[f64], quality: u16) -> Vec<f64> {
    let basis = basis::<f64>();
    let mut out = plane.to_vec();
    for at in 0..AREA {
        let first = at / (WIDTH / SIDE) * SIDE * WIDTH + at % (WIDTH / SIDE) * SIDE;
        let place = |i: usize| first + i / SIDE * WIDTH + i % SIDE;
        let coefficients = transform(&basis, &core::array::from_fn(|i| plane[place(i)] - 128.0 / 255.0));
        for i in 0..AREA {
            let sum: f64 = (0..AREA)
                .map(|k| {
                    let step = step(LUMA[k], quality) / 255.0;
                    let kept = (coefficients[k] / step).round() * step;
                    kept * basis[k / SIDE][i / SIDE] * basis[k % SIDE][i % SIDE]
                })
                .sum();
            out[place(i)] = ((sum * 255.0 + 128.0).round() / 255.0).clamp(0.0, 1.0);
        }
    }
    out
}

#[test]
fn the_transform_keeps_lengths() {
    let block: [f64; AREA] = core::array::from_fn(|i| f64::of_usize(i * i % 17));
    let square = |values: &[f64; AREA]| values.iter().map(|v| v * v).sum::<f64>();
    assert!((square(&transform(&basis(), &block)) - square(&block)).abs() < 1e-9);
}

#[test]
fn steps_are_found_and_uncoded_pictures_have_none() {
    for quality in [50, 75] {
        let image = gray(&coded(&square(0.7), quality));
        let code = BlockCode::of(&image.view()).unwrap();
        assert!((code.luma[0] * 255.0 - step(16, quality)).abs() < 1e-9, "{quality}");
    }
    assert!(BlockCode::of(&gray(&square(0.7)).view()).is_none());
}

#[test]
fn what_was_coded_is_explained_and_faint_objects_are_not() {
    for light in [0.7, 0.36] {
        let image = gray(&coded(&square(light), 50));
        let code = BlockCode::of(&gray(&coded(&square(0.7), 50)).view()).unwrap();
        let mut scratch = CodeScratch::default();
        let truth = code.bits(&image.view(), gray(&square(light)).data(), &mut scratch);
        let without = code.bits(&image.view(), gray(&square(0.3)).data(), &mut scratch);
        assert!(truth < 1.0 && without > 50.0, "{truth} {without}");
    }
}
