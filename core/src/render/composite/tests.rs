use alloc::vec;

use crate::dims::ImageSize;
use crate::image::RgbaImage;
use crate::render::{Compositing, ContourRenderer, EdgeProfile, PixelLoss, RenderError, Renderer};
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

/// Premultiplied red, green, blue and alpha of two objects that cover all of a 2 x 1 image, and the gradient of the sum of all
/// values.
fn rgba(confidences: [f64; 2], compositing: Compositing) -> ([f64; 4], DrawingGrad<f64>) {
    let size = ImageSize::new(2, 1).unwrap();
    let mut drawing = two(confidences[1]);
    drawing.confidences[0] = confidences[0];
    let renderer = ContourRenderer::new(EdgeProfile::reference(), compositing);
    let mut image = RgbaImage::transparent(size);
    renderer.render_rgba(&drawing, size, &mut Default::default(), image.data_mut()).unwrap();
    let mut grad = DrawingGrad::default();
    grad.reset(&drawing);
    renderer.render_rgba_vjp(&drawing, size, &mut Default::default(), &[1.0; 8], &mut grad).unwrap();
    ([0, 1, 2, 3].map(|c| image.view().channel(c)[1]), grad)
}

#[test]
fn alpha_is_what_the_objects_cover() {
    // 1 - 0.5 x 0.4 = 0.8, whichever way they mix. Over: red 0.5 x 0.4, blue 0.6; by the red object's confidence the sum of
    // color and alpha, 0.4 f + 0.6 + 1 - 0.4 (1 - f), has the slope 0.8, in each of two pixels.
    let (found, grad) = rgba([0.5, 0.6], Compositing::Over);
    assert_close([found[0], found[2], found[3]], [0.2, 0.6, 0.8]);
    assert!((grad.confidences[0] - 1.6).abs() < 1e-12, "{grad:?}");
    assert_close(grad.colors[0], [0.4; 3]);
    // Blend: the mean color with weights of e^-5 and e^-4, times alpha.
    let (found, grad) = rgba([0.5, 0.6], Compositing::Blend);
    let red = 0.8 / (1.0 + 1.0_f64.exp());
    assert_close([found[0], found[2], found[3]], [red, 0.8 - red, 0.8]);
    assert_close(grad.background, [0.0; 3]);
    // The mean color sums to 1 whatever the weights: color and alpha have the slope 0.4 each, in two pixels.
    assert!((grad.confidences[0] - 1.6).abs() < 1e-12, "{grad:?}");
}

#[test]
fn nothing_is_transparent() {
    let size = ImageSize::new(20, 3).unwrap();
    let drawing = Drawing { background: [0.3, 0.5, 0.7], ..Drawing::default() };
    let mut image = vec![9.0; 4 * size.pixels()];
    ContourRenderer::default().render_rgba(&drawing, size, &mut Default::default(), &mut image).unwrap();
    assert_eq!(RgbaImage::from_premultiplied(size, image.clone()).unwrap(), RgbaImage::transparent(size));
    let refused = ContourRenderer::default().render_rgba(&drawing, size, &mut Default::default(), &mut image[1..]);
    assert_eq!(refused, Err(RenderError::Length { what: "image", expected: 240, len: 239 }));
}

#[test]
fn losses_against_rgba_count_four_channels() {
    // The image is (0.2, 0, 0.6, 0.8) twice; the target is clear on the left and half clear white, (0.5, 0.5, 0.5, 0.5), on
    // the right: |d| sums to 1.6 and 0.3 + 0.5 + 0.1 + 0.3 = 1.2, over 8 values.
    let size = ImageSize::new(2, 1).unwrap();
    let target = RgbaImage::from_straight(size, &[0.3, 0.2, 0.1, 0.0, 1.0, 1.0, 1.0, 0.5]).unwrap();
    let mut drawing = two(0.6);
    drawing.confidences[0] = 0.5;
    let renderer = ContourRenderer::new(EdgeProfile::reference(), Compositing::Over);
    let mut grad = DrawingGrad::default();
    grad.reset(&drawing);
    let scratch = &mut Default::default();
    let value = renderer.loss_and_grad(&drawing, target.view(), PixelLoss::Mae, scratch, &mut grad).unwrap();
    assert!((value - 2.8 / 8.0).abs() < 1e-12, "{value}");
    assert!((renderer.loss(&drawing, target.view(), PixelLoss::Mae, scratch).unwrap() - value).abs() < 1e-15);
    // Red of the first object: 0.2 per unit in both pixels, above the target on the left and below it on the right.
    assert!(grad.colors[0][0].abs() < 1e-12, "{grad:?}");
    // Alpha and blue of the second: blue is above by 0.6 and 0.1.
    assert!((grad.colors[1][2] - 2.0 * 0.6 / 8.0).abs() < 1e-12, "{grad:?}");
}
