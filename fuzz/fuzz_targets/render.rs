//! Every renderer on wild drawings: an error, or finite images, losses and gradients inside the range of their colors.
#![no_main]

use dvp_core::image::RgbaView;
use dvp_core::render::{
    Compositing, ContourDistance, CoverageModel, ExactArea, HardMask, PixelLoss, Renderer, SoftTriangles, TileRenderer,
};
use dvp_core::{DrawingGrad, ImageView};
use dvp_fuzz::Painting;
use libfuzzer_sys::fuzz_target;

fn paint<C: CoverageModel<f32>>(coverage: C, compositing: Compositing, painting: &Painting) {
    let Painting { drawing, size } = painting;
    let renderer = TileRenderer { coverage, compositing };
    let mut image = vec![0.0; 3 * size.pixels()];
    let mut scratch = Default::default();
    if renderer.render(drawing, *size, &mut scratch, &mut image).is_err() {
        return;
    }
    // Beyond this sums of colors may overflow, which is the caller's affair.
    if drawing.background.iter().chain(drawing.colors.as_flattened()).any(|c| c.abs() > 1e6) {
        return;
    }
    for channel in 0..3 {
        let colors = || drawing.colors.iter().map(|color| color[channel]).chain([drawing.background[channel]]);
        let (low, high) = (colors().fold(f32::MAX, f32::min), colors().fold(f32::MIN, f32::max));
        let slack = 1e-4 * (1.0 + low.abs().max(high.abs()));
        let plane = &image[channel * size.pixels()..(channel + 1) * size.pixels()];
        assert!(plane.iter().all(|&v| v >= low - slack && v <= high + slack), "{low}..{high}: {plane:?}");
    }
    let mut clear = vec![0.0; 4 * size.pixels()];
    renderer.render_rgba(drawing, *size, &mut scratch, &mut clear).expect("it was painted");
    assert!(clear.iter().all(|v| v.is_finite()));
    let alpha = &clear[3 * size.pixels()..];
    assert!(alpha.iter().all(|a| (-1e-4..=1.0 + 1e-4).contains(a)), "{alpha:?}");
    let target = vec![0.5; image.len()];
    let target = ImageView::new(*size, &target).expect("3 values per pixel");
    let mut grad = DrawingGrad::default();
    grad.reset(drawing);
    for loss in [PixelLoss::Mae, PixelLoss::Mse] {
        let value = renderer.loss_and_grad(drawing, target, loss, &mut scratch, &mut grad).expect("it was painted");
        assert!(value.is_finite());
        let target = RgbaView::premultiplied(*size, &clear).expect("4 values per pixel");
        let value = renderer.loss_and_grad(drawing, target, loss, &mut scratch, &mut grad).expect("it was painted");
        assert!(value <= 0.0, "an image is like itself: {value}");
    }
    let numbers = grad.vertices.as_flattened().iter().chain(grad.colors.as_flattened()).chain(&grad.confidences);
    assert!(numbers.chain(&grad.background).all(|v| v.is_finite()), "{grad:?}");
}

fuzz_target!(|painting: Painting| {
    for compositing in [Compositing::Blend, Compositing::Over] {
        paint(ContourDistance::default(), compositing, &painting);
        paint(SoftTriangles::default(), compositing, &painting);
        paint(ExactArea, compositing, &painting);
        paint(HardMask, compositing, &painting);
    }
});
