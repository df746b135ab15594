use crate::dims::ImageSize;
use crate::render::{Compositing, ContourRenderer, EdgeProfile, PixelLoss, Renderer};
use crate::scene::{Drawing, DrawingGrad};
use crate::{Image, ImageView};

/// Two objects that cover all of a 2 x 1 image: red, then blue with confidence `f`; the background is white.
fn two(f: f64) -> Drawing<f64> {
    let mut drawing = Drawing { background: [1.0; 3], ..Drawing::default() };
    let all = [[-1.0, -1.0], [4.0, -1.0], [4.0, 3.0], [-1.0, 3.0]];
    drawing.push(&all, [1.0, 0.0, 0.0], 1.0);
    drawing.push(&all, [0.0, 0.0, 1.0], f);
    drawing
}

fn pixel(f: f64, compositing: Compositing) -> [f64; 3] {
    let size = ImageSize::new(2, 1).unwrap();
    let mut image = Image::zeros(size);
    let renderer = ContourRenderer::new(EdgeProfile::reference(), compositing);
    renderer.render(&two(f), size, &mut Default::default(), image.data_mut()).unwrap();
    image.view().pixel(1)
}

fn assert_close(found: [f64; 3], expected: [f64; 3]) {
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}, not {expected:?}");
}

#[test]
fn blend_is_the_mean_of_two_confident_objects() {
    assert_close(pixel(1.0, Compositing::Blend), [0.5, 0.0, 0.5]);
    // With confidence 0.8 the second weighs e^-2 = 0.1353; red alone makes alpha 1.
    let w = (-2.0_f64).exp();
    assert_close(pixel(0.8, Compositing::Blend), [1.0 / (1.0 + w), 0.0, w / (1.0 + w)]);
}

#[test]
fn over_paints_the_later_object_on_top() {
    assert_close(pixel(1.0, Compositing::Over), [0.0, 0.0, 1.0]);
    assert_close(pixel(0.8, Compositing::Over), [0.2, 0.0, 0.8]);
}

#[test]
fn losses_are_means_over_values() {
    // The image is (0.5, 0, 0.5) twice, the target (0.25, 0, 0.5) and (0.5, 0.2, 0.5): |d| sums to 0.45, d^2 to
    // 0.1025, over 6.
    let size = ImageSize::new(2, 1).unwrap();
    let target = [0.25, 0.5, 0.0, 0.2, 0.5, 0.5];
    let target = ImageView::new(size, &target).unwrap();
    let drawing = two(1.0);
    for (loss, expected) in [(PixelLoss::Mae, 0.45 / 6.0), (PixelLoss::Mse, 0.1025 / 6.0)] {
        let mut grad = DrawingGrad::default();
        grad.reset(&drawing);
        let renderer = ContourRenderer::default();
        let value = renderer.loss_and_grad(&drawing, target, loss, &mut Default::default(), &mut grad).unwrap();
        assert!((value - expected).abs() < 1e-12, "{value}, not {expected}");
        // Red of the first object has half of the weight in both pixels, and red is off in the first only.
        let slope = if loss == PixelLoss::Mae { 1.0 } else { 2.0 * 0.25 };
        assert!((grad.colors[0][0] - 0.5 * slope / 6.0).abs() < 1e-12, "{:?}", grad.colors);
    }
}
