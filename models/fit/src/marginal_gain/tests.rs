use alloc::vec::Vec;

use dvp_core::render::{Compositing, ExactArea, ExactRenderer, HardMask, HardRenderer, Renderer};
use dvp_core::scene::{ColorStop, DrawnRamp, RampKind};
use dvp_core::shape::Rings;
use dvp_core::{Drawing, Image, ImageSize};

use super::squared_errors;

/// Squares, the first with a hole, and a triangle, all overlapping, as confident as `confidences` says.
fn drawing(confidences: [f64; 4]) -> Drawing<f64> {
    let outlines: [&[[f64; 2]]; 4] = [
        // From the fifth vertex on, the hole.
        &[[0.1, 0.1], [0.6, 0.1], [0.6, 0.6], [0.1, 0.6], [0.2, 0.2], [0.5, 0.2], [0.5, 0.5], [0.2, 0.5]],
        &[[0.4, 0.3], [0.9, 0.3], [0.9, 0.8], [0.4, 0.8], [0.4, 0.3]],
        &[[0.3, 0.2], [0.7, 0.5], [0.2, 0.9], [0.3, 0.2]],
        &[[0.45, 0.4], [0.55, 0.4], [0.55, 0.5], [0.45, 0.5], [0.45, 0.4]],
    ];
    let mut drawing = Drawing { background: [0.9, 0.8, 0.7], ..Drawing::default() };
    for (k, outline) in outlines.into_iter().enumerate() {
        let breaks: &[usize] = if k == 0 { &[4] } else { &[] };
        let rings = Rings { breaks, ..Rings::one(outline) };
        drawing.push_rings(rings, [0.2 * k as f64, 1.0 - 0.3 * k as f64, 0.5], confidences[k]);
    }
    drawing
}

/// The drawing without one of its objects.
fn without(drawing: &Drawing<f64>, object: usize) -> Drawing<f64> {
    let mut rest = Drawing { background: drawing.background, ..Drawing::default() };
    for k in (0..drawing.object_count()).filter(|&k| k != object) {
        rest.push_rings(drawing.rings(k), drawing.colors[k], drawing.confidences[k]);
    }
    rest
}

fn squared_error(drawing: &Drawing<f64>, image: &Image<f64>, compositing: Compositing) -> f64 {
    let mut painted = Image::zeros(image.size());
    let renderer = HardRenderer { coverage: HardMask, compositing };
    renderer.render(drawing, image.size(), &mut Default::default(), painted.data_mut()).unwrap();
    painted.data().iter().zip(image.data()).map(|(a, b)| (a - b) * (a - b)).sum()
}

#[test]
fn a_gain_is_the_error_that_a_rendering_has_without_the_object() {
    let size = ImageSize::new(40, 32).unwrap();
    // Waves that no scene explains.
    let values: Vec<f64> = (0..3 * size.pixels()).map(|i| 0.5 + 0.4 * (0.37 * i as f64).sin()).collect();
    let image = Image::from_planar(size, values).unwrap();
    for confidences in [[1.0; 4], [0.5, 1.0, 0.8, 1.0], [0.9, 0.3, 0.02, 0.6], [0.0, 0.5, 0.0, 0.5]] {
        for compositing in [Compositing::Blend, Compositing::Over] {
            let drawing = drawing(confidences);
            let with = squared_error(&drawing, &image, compositing);
            for (object, gain) in squared_errors(&drawing, &image.view(), compositing).into_iter().enumerate() {
                let expected = squared_error(&without(&drawing, object), &image, compositing) - with;
                assert!(
                    (gain - expected).abs() < 1e-9 * with,
                    "object {object} of {confidences:?}, {compositing:?}: {gain} in place of {expected}"
                );
            }
        }
    }
}

#[test]
fn what_a_ramp_takes_away_is_that_of_its_colors() {
    // A sheet that goes from black to white, over the gray that it has on the mean, on a picture of itself.
    let size = ImageSize::new(64, 64).unwrap();
    let mut drawing = Drawing { background: [0.5; 3], ..Drawing::default() };
    drawing.push_rings(Rings::one(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]), [0.5; 3], 1.0);
    let stop = |offset: f64| ColorStop { offset, color: [offset; 3] };
    drawing.stops = [stop(0.0), stop(1.0)].into();
    drawing.ramps.push(DrawnRamp { object: 0, kind: RampKind::Linear([[0.0, 0.0], [1.0, 0.0]]), stops: 0..2 });
    let mut image = Image::zeros(size);
    ExactRenderer { coverage: ExactArea, compositing: Compositing::Over }
        .render(&drawing, size, &mut Default::default(), image.data_mut())
        .unwrap();
    let gain = squared_errors(&drawing, &image.view(), Compositing::Over)[0];
    let flat: f64 = image.data().iter().map(|value| (value - 0.5).powi(2)).sum();
    // Pieces of an eighth of the width leave a sixty-fourth.
    assert!((gain / flat - 63.0 / 64.0).abs() < 1e-3, "{gain} of {flat}");
}
