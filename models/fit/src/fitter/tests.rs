use alloc::vec::Vec;

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::{Drawing, Image, ImageSize};

use super::shown::Shown;
use crate::residual::Residual;

/// A disk of 24 vertices, scene units.
fn disk([x, y]: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    let vertex = |i: u32| num_traits::Float::sin_cos(core::f64::consts::TAU * f64::from(i) / 24.0);
    (0..24).map(vertex).map(|(sin, cos)| [x + radius * cos, y + radius * sin]).collect()
}

fn drawing(disks: &[([f64; 2], f64)]) -> Drawing<f64> {
    let mut drawing = Drawing { background: [0.1, 0.2, 0.3], ..Drawing::default() };
    for (k, &(center, radius)) in (1_u32..).zip(disks) {
        drawing.push(&disk(center, radius), [0.9 / f64::from(k), 0.5, 0.1 * f64::from(k)], 1.0);
    }
    drawing
}

#[test]
fn what_is_shown_is_what_a_whole_rendering_shows() {
    // More than 2^16 pixels, not square.
    let size = ImageSize::new(360, 240).unwrap();
    let ramp = (0..size.pixels()).map(|i| f64::from(u32::try_from(i % 360).unwrap()) / 360.0);
    let image = Image::from_interleaved(size, &ramp.flat_map(|v| [v, 1.0 - v, 0.5]).collect::<Vec<_>>()).unwrap();
    let start = [([0.3, 0.3], 0.12), ([0.9, 0.5], 0.1), ([0.38, 0.35], 0.1), ([1.2, 0.2], 0.15)];
    let mut moved = start;
    moved[2] = ([0.45, 0.4], 0.09);
    let steps = [
        start.to_vec(),
        // One moves, where others overlap it.
        moved.to_vec(),
        start.to_vec(),
        // Removed, put in again, one more, half outside the view.
        [&start[..1], &start[2..]].concat(),
        start.to_vec(),
        [&start[..], &[([1.5, 0.98], 0.1)]].concat(),
        // All of it.
        Vec::new(),
        start.to_vec(),
        start.to_vec(),
    ];
    let edges = [EdgeProfile::reference(), EdgeProfile::area(), EdgeProfile::distance(0.01)];
    for setting in edges.into_iter().flat_map(|edge| [(edge, Compositing::Blend), (edge, Compositing::Over)]) {
        let (mut shown, mut residual) = (Shown::default(), Residual::default());
        for (step, disks) in steps.iter().enumerate() {
            let drawing = drawing(disks);
            let error = shown.compare(&drawing, &image.view(), setting, &mut residual).unwrap();
            let (mut whole, mut fresh) = (Shown::default(), Residual::default());
            let expected = whole.compare(&drawing, &image.view(), setting, &mut fresh).unwrap();
            assert!((error - expected).abs() < 1e-9, "step {step}: {error} instead of {expected}");
            let [bits, expected] = [&residual, &fresh].map(|residual| residual.bits(0.1));
            assert!((bits - expected).abs() < 1e-5 * expected, "step {step}: {bits} bits instead of {expected}");
        }
    }
}
