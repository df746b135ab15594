//! What holds for every image of the contour renderer.

use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile, RenderError, Renderer};
use dvp_core::{Drawing, Image, ImageSize, Real};
use dvp_tests::strategy;
use proptest::prelude::*;

fn renderer(compositing: Compositing) -> ContourRenderer<f64> {
    ContourRenderer::new(
        EdgeProfile { offset: 0.012, sigma: 0.003, cut: 0.03, ..EdgeProfile::reference() },
        compositing,
    )
}

fn compositing() -> impl Strategy<Value = Compositing> {
    prop_oneof![Just(Compositing::Blend), Just(Compositing::Over)]
}

type Objects = Vec<(Vec<[f64; 2]>, [f64; 3], f64)>;

/// Objects around an image of 24 x 24 with outlines in pixels.
fn objects() -> impl Strategy<Value = Objects> {
    let object = (strategy::star_px(), prop::array::uniform2(-8.0..8.0), strategy::color(), 0.0..1.0);
    let object = object.prop_map(|(star, shift, color, confidence)| {
        (star.iter().map(|v| [v[0] + shift[0], v[1] + shift[1]]).collect(), color, confidence)
    });
    prop::collection::vec(object, 0..5)
}

/// A drawing for an image of `unit` pixels on its shorter side, moved by `shift` pixels.
fn drawing(objects: &Objects, unit: f64, shift: [f64; 2]) -> Drawing<f64> {
    let mut drawing = Drawing { background: [0.2, 0.4, 0.6], ..Drawing::default() };
    for (outline, color, confidence) in objects {
        let outline: Vec<_> = outline.iter().map(|v| [(v[0] + shift[0]) / unit, (v[1] + shift[1]) / unit]).collect();
        drawing.push(&outline, *color, *confidence);
    }
    drawing
}

fn render(renderer: &ContourRenderer<f64>, drawing: &Drawing<f64>, size: ImageSize) -> Image<f64> {
    let mut image = Image::zeros(size);
    renderer.render(drawing, size, &mut Default::default(), image.data_mut()).unwrap();
    image
}

proptest! {
    #[test]
    fn pixels_stay_between_the_colors(objects in objects(), compositing in compositing()) {
        let size = ImageSize::new(24, 24).unwrap();
        let drawing = drawing(&objects, 24.0, [0.0; 2]);
        let image = render(&renderer(compositing), &drawing, size);
        for channel in 0..3 {
            let colors = || drawing.colors.iter().map(|c| c[channel]).chain([drawing.background[channel]]);
            let (low, high) = (colors().fold(1.0, f64::min), colors().fold(0.0, f64::max));
            for &value in image.view().channel(channel) {
                prop_assert!((low - 1e-12..=high + 1e-12).contains(&value), "{value} outside of [{low}, {high}]");
            }
        }
    }

    #[test]
    fn without_confidence_only_the_background_is_left(mut objects in objects(), compositing in compositing()) {
        objects.iter_mut().for_each(|object| object.2 = 0.0);
        let size = ImageSize::new(24, 24).unwrap();
        let image = render(&renderer(compositing), &drawing(&objects, 24.0, [0.0; 2]), size);
        for (channel, b) in [0.2_f64, 0.4, 0.6].into_iter().enumerate() {
            prop_assert!(image.view().channel(channel).iter().all(|&v| v.to_bits() == b.to_bits()));
        }
    }

    #[test]
    fn a_whole_pixel_shift_shifts_the_image(
        objects in objects(),
        compositing in compositing(),
        (right, down) in (0_usize..20, 0_usize..20),
    ) {
        // A window of the larger image must be the smaller one; both have 24 pixels per scene unit.
        let (small, large) = (ImageSize::new(24, 40).unwrap(), ImageSize::new(24, 60).unwrap());
        let renderer = renderer(compositing);
        let here = render(&renderer, &drawing(&objects, 24.0, [0.0; 2]), small);
        let moved = render(&renderer, &drawing(&objects, 24.0, [right as f64, down as f64]), large);
        for (row, column) in (0..40).flat_map(|row| (0..24 - right).map(move |column| (row, column))) {
            let (a, b) = (here.view().pixel(row * 24 + column), moved.view().pixel((row + down) * 24 + column + right));
            for channel in 0..3 {
                // Rounding of the coordinates, times the steepest edge; a pixel on the very cut is a rare exception.
                prop_assert!((a[channel] - b[channel]).abs() < 1e-9, "({row}, {column}): {a:?}, {b:?}");
            }
        }
    }

    #[test]
    fn order_does_not_matter_under_blend(objects in objects(), turn in 0_usize..5) {
        let size = ImageSize::new(24, 24).unwrap();
        let mut turned = objects.clone();
        turned.rotate_left(turn.min(objects.len()));
        let renderer = renderer(Compositing::Blend);
        let a = render(&renderer, &drawing(&objects, 24.0, [0.0; 2]), size);
        let b = render(&renderer, &drawing(&turned, 24.0, [0.0; 2]), size);
        for (a, b) in a.data().iter().zip(b.data()) {
            prop_assert!((a - b).abs() < 1e-12);
        }
    }

    #[test]
    fn a_used_scratch_paints_the_same(
        (first, second) in (objects(), objects()),
        compositing in compositing(),
        (width, height) in (1_usize..50, 1_usize..50),
    ) {
        let renderer = renderer(compositing);
        let mut scratch = Default::default();
        let (before, size) = (ImageSize::new(24, 24).unwrap(), ImageSize::new(width, height).unwrap());
        renderer.render(&drawing(&first, 24.0, [0.0; 2]), before, &mut scratch, Image::zeros(before).data_mut()).unwrap();
        let second = drawing(&second, 24.0, [0.0; 2]);
        let mut image = Image::zeros(size);
        renderer.render(&second, size, &mut scratch, image.data_mut()).unwrap();
        prop_assert_eq!(image, render(&renderer, &second, size));
    }

    #[test]
    fn single_precision_paints_the_same_image(objects in objects(), compositing in compositing()) {
        let size = ImageSize::new(24, 24).unwrap();
        let drawing = drawing(&objects, 24.0, [0.0; 2]);
        let reference = render(&renderer(compositing), &drawing, size);
        let single = Drawing {
            background: drawing.background.map(f32::of),
            vertices: drawing.vertices.iter().map(|v| v.map(f32::of)).collect(),
            starts: drawing.starts.clone(),
            breaks: drawing.breaks.clone(),
            colors: drawing.colors.iter().map(|c| c.map(f32::of)).collect(),
            confidences: drawing.confidences.iter().map(|&f| f32::of(f)).collect(),
            ..Drawing::default()
        };
        let edge = EdgeProfile { offset: 0.012, sigma: 0.003, cut: 0.03, ..EdgeProfile::reference() };
        let mut image = Image::zeros(size);
        ContourRenderer::new(edge, compositing).render(&single, size, &mut Default::default(), image.data_mut()).unwrap();
        // Rounded coordinates move an edge by 1e-6 px; pixels may cross the cut, where coverage jumps by 0.0025.
        for (a, &b) in reference.data().iter().zip(image.data()) {
            prop_assert!((a - f64::from(b)).abs() < 0.003, "{a}, {b}");
        }
    }
}

#[test]
fn settings_out_of_range_are_refused() {
    let size = ImageSize::new(4, 4).unwrap();
    for (offset, sigma, cut) in [(0.0, 1e-40, 1.0), (0.0, -1.0, 1.0), (f64::NAN, 1.0, 1.0), (0.0, 1.0, f64::INFINITY)] {
        let renderer =
            ContourRenderer::new(EdgeProfile { offset, sigma, cut, ..EdgeProfile::reference() }, Compositing::Blend);
        let refused = renderer.render(&Drawing::default(), size, &mut Default::default(), &mut [0.0; 48]);
        assert!(matches!(refused, Err(RenderError::Setting { .. })), "{refused:?}");
    }
}

#[test]
fn slices_of_the_wrong_length_are_refused() {
    let size = ImageSize::new(4, 4).unwrap();
    let renderer = renderer(Compositing::Blend);
    let refused = renderer.render(&Drawing::default(), size, &mut Default::default(), &mut [0.0; 47]);
    assert_eq!(refused, Err(RenderError::Length { what: "image", expected: 48, len: 47 }));
    let mut lost = Drawing::default();
    lost.push(&[[0.1, 0.1], [0.9, 0.1], [0.5, 0.9]], [1.0; 3], 1.0);
    lost.confidences.clear();
    let refused = renderer.render(&lost, size, &mut Default::default(), &mut [0.0; 48]);
    assert_eq!(refused, Err(RenderError::Length { what: "confidences", expected: 1, len: 0 }));
}
