//! What holds for every RGBA image.

use core::fmt::Debug;

use dvp_core::image::RgbaImage;
use dvp_core::render::{
    Compositing, ContourDistance, CoverageModel, ExactArea, HardMask, PixelLoss, Renderer, SoftTriangles, TileRenderer,
};
use dvp_core::{Drawing, Image, ImageSize};
use dvp_tests::strategy;
use proptest::prelude::*;

/// Not a multiple of a chunk, not square.
fn size() -> ImageSize {
    ImageSize::new(27, 24).unwrap()
}

/// Up to four objects of several rings each.
fn drawing() -> impl Strategy<Value = Drawing<f64>> {
    let object = (strategy::rings_px(), strategy::color(), 0.0..1.0);
    (prop::collection::vec(object, 0..5), strategy::color()).prop_map(|(objects, background)| {
        let mut drawing = Drawing { background, ..Drawing::default() };
        for (mut outline, color, confidence) in objects {
            outline.vertices.as_flattened_mut().iter_mut().for_each(|x| *x /= 24.0);
            drawing.push_rings(outline.rings(), color, confidence);
        }
        drawing
    })
}

fn compositing() -> impl Strategy<Value = Compositing> {
    prop_oneof![Just(Compositing::Blend), Just(Compositing::Over)]
}

/// An RGBA image and the RGB image of the same drawing.
fn both<C: CoverageModel<f64> + Debug>(
    coverage: C,
    compositing: Compositing,
    drawing: &Drawing<f64>,
) -> (RgbaImage<f64>, Image<f64>) {
    let renderer = TileRenderer { coverage, compositing };
    let (mut clear, mut opaque, mut scratch) =
        (RgbaImage::transparent(size()), Image::zeros(size()), Default::default());
    renderer.render_rgba(drawing, size(), &mut scratch, clear.data_mut()).unwrap();
    renderer.render(drawing, size(), &mut scratch, opaque.data_mut()).unwrap();
    (clear, opaque)
}

fn each(compositing: Compositing, drawing: &Drawing<f64>) -> [(RgbaImage<f64>, Image<f64>); 4] {
    [
        both(ContourDistance::default(), compositing, drawing),
        both(ExactArea, compositing, drawing),
        both(HardMask, compositing, drawing),
        both(SoftTriangles::default(), compositing, drawing),
    ]
}

proptest! {
    #[test]
    fn on_the_background_it_is_the_rgb_image(drawing in drawing(), compositing in compositing()) {
        for (clear, opaque) in each(compositing, &drawing) {
            for (a, b) in clear.on(drawing.background).data().iter().zip(opaque.data()) {
                prop_assert!((a - b).abs() < 1e-12, "{a}, {b}");
            }
        }
    }

    #[test]
    fn the_background_does_not_matter(drawing in drawing(), compositing in compositing(), other in strategy::color()) {
        let moved = Drawing { background: other, ..drawing.clone() };
        for ((a, _), (b, _)) in each(compositing, &drawing).iter().zip(&each(compositing, &moved)) {
            prop_assert_eq!(a, b);
        }
    }

    #[test]
    fn colors_stay_below_alpha(drawing in drawing(), compositing in compositing()) {
        for (clear, _) in each(compositing, &drawing) {
            let view = clear.view();
            for (i, &alpha) in view.channel(3).iter().enumerate() {
                prop_assert!((0.0..=1.0 + 1e-12).contains(&alpha), "{alpha}");
                for channel in 0..3 {
                    let value = view.channel(channel)[i];
                    prop_assert!(value >= 0.0 && value <= alpha + 1e-12, "{value} of {alpha}");
                }
            }
        }
    }

    #[test]
    fn straight_colors_and_back(drawing in drawing(), compositing in compositing()) {
        for (clear, _) in each(compositing, &drawing) {
            let straight = clear.to_straight();
            prop_assert!(straight.iter().all(|v| (0.0..=1.0 + 1e-9).contains(v)));
            let again = RgbaImage::from_straight(size(), &straight).unwrap();
            for (a, b) in clear.data().iter().zip(again.data()) {
                prop_assert!((a - b).abs() < 1e-15, "{a}, {b}");
            }
        }
    }

    #[test]
    fn losses_are_means_over_four_channels(drawing in drawing(), compositing in compositing(), target in drawing()) {
        let renderer = TileRenderer { coverage: ContourDistance::default(), compositing };
        let (image, _) = both(ContourDistance::default(), compositing, &drawing);
        let (target, _) = both(ExactArea, compositing, &target);
        let differences = || image.data().iter().zip(target.data()).map(|(a, b)| a - b);
        let count = image.data().len() as f64;
        let expected = [
            (PixelLoss::Mae, differences().map(f64::abs).sum::<f64>() / count),
            (PixelLoss::Mse, differences().map(|d| d * d).sum::<f64>() / count),
        ];
        for (loss, expected) in expected {
            let mut scratch = Default::default();
            let alone = renderer.loss(&drawing, target.view(), loss, &mut scratch).unwrap();
            prop_assert!((alone - expected).abs() < 1e-12, "{alone}, not {expected}");
        }
    }
}
