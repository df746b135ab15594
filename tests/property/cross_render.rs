//! One scene against all renderers, and what every renderer must do with bad input.

use core::fmt::Debug;

use dvp_core::diff_op::{Batched, HostOp as _};
use dvp_core::real::Values;
use dvp_core::render::{
    Compositing, ContourDistance, CoverageModel, EdgeProfile, ExactArea, HardMask, PixelLoss, RenderError,
    RenderLossOp, Renderer, SoftTriangles, TileRenderer,
};
use dvp_core::shape::OutlineBasis;
use dvp_core::{Drawing, Efd, Image, ImageSize, Object, Pose, Scene};
use dvp_tests::coverage::{coverage, coverage_vjp, drawing};
use dvp_tests::strategy;
use proptest::prelude::*;

const SIDE: usize = 128;

/// Four objects that overlap, leave the view and are half confident; outlines without self-crossings.
fn scene() -> Drawing<f64> {
    let circle = vec![[1.0, 0.0, 0.0, -1.0]];
    let bean = vec![[0.8, 0.0, 0.1, -0.6], [0.1, 0.15, 0.0, 0.1]];
    let objects = [
        ([0.35, 0.40], 0.25, 0.3, [0.9, 0.1, 0.2], 1.0, circle.clone()),
        ([0.55, 0.55], 0.28, 1.2, [0.1, 0.6, 0.9], 1.0, bean.clone()),
        ([0.95, 0.20], 0.20, 0.0, [0.8, 0.8, 0.1], 1.0, circle),
        ([0.25, 0.80], 0.22, 2.5, [0.2, 0.9, 0.4], 0.8, bean),
    ];
    let objects = objects.map(|(translation, scale, rotation, color, confidence, rows)| {
        let pose = Pose { translation, scale, rotation };
        Object::of_efd(pose, color, confidence, Efd::new(rows), None)
    });
    let mut drawing = Drawing::default();
    let scene = Scene { objects: objects.into(), ..Scene::empty([0.3, 0.3, 0.35]) };
    scene.draw(&OutlineBasis::new(64, 2).unwrap(), &mut drawing).unwrap();
    drawing
}

fn render<C: CoverageModel<f64>>(model: C) -> Vec<f64> {
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let mut image = Image::zeros(size);
    let renderer = TileRenderer { coverage: model, compositing: Default::default() };
    renderer.render(&scene(), size, &mut Default::default(), image.data_mut()).unwrap();
    image.data().to_vec()
}

/// A profile that is half covered on the outline and as steep there as area coverage is wide.
fn sharp() -> EdgeProfile<f64> {
    // A pixel is 1/64 of the doubled frame; the squared half pixel is 6.1e-5.
    EdgeProfile { offset: 0.0, sigma: 2e-5, cut: 4e-4, ..EdgeProfile::reference() }
}

#[test]
fn one_scene_against_all_renderers() {
    let contour = render(ContourDistance::default());
    let contour_sharp = render(ContourDistance::new(sharp()));
    let triangles = render(SoftTriangles::default());
    let triangles_sharp = render(SoftTriangles { edge: sharp(), ..SoftTriangles::default() });
    let exact = render(ExactArea);
    let hard = render(HardMask);
    // (pair, most mean error, most error, what the difference is).
    let table = [
        ("contour, triangles", &contour, &triangles, 3e-4, 0.005, "seams: coverage dips to 0.993"),
        ("contour sharp, exact", &contour_sharp, &exact, 9e-4, 0.1, "a logistic of the squared distance is no area"),
        ("triangles sharp, exact", &triangles_sharp, &exact, 1.6e-2, 0.35, "seams: coverage dips to 1/2"),
        ("hard, exact", &hard, &exact, 3.5e-3, 0.4, "half of a pixel is lost or won"),
        ("contour, exact", &contour, &exact, 1.9e-2, 0.65, "fattened by 1.43 px"),
    ];
    let mut failures = String::new();
    for (pair, a, b, most_mean, most, why) in table {
        let errors = || a.iter().zip(b.iter()).map(|(a, b): (&f64, &f64)| (a - b).abs());
        let mean = errors().sum::<f64>() / a.len() as f64;
        let worst = errors().fold(0.0, f64::max);
        if !(mean <= most_mean && worst <= most) {
            failures += &format!("{pair} ({why}): mean {mean:e} of {most_mean:e}, worst {worst:e} of {most:e}\n");
        }
        assert!(worst > 0.0, "{pair}: these are the same image");
    }
    assert!(failures.is_empty(), "{failures}");
}

/// Every renderer on one outline in pixels.
fn each(outline: &[[f64; 2]], size: ImageSize) -> [(&'static str, Result<Vec<f64>, RenderError>); 6] {
    let blurred = ContourDistance::new(EdgeProfile::distance(0.1));
    [
        ("contour", coverage(ContourDistance::default(), outline, size)),
        ("blurred contour", coverage(blurred, outline, size)),
        ("area contour", coverage(ContourDistance::new(EdgeProfile::area()), outline, size)),
        ("triangles", coverage(SoftTriangles::default(), outline, size)),
        ("exact", coverage(ExactArea, outline, size)),
        ("hard", coverage(HardMask, outline, size)),
    ]
}

/// Vertices of each object of [`losses`].
const VERTICES: usize = 24;

/// The loss of a drawing against a gray image, as a step without and with what its gradient needs.
fn losses<C: CoverageModel<f64> + Copy + Debug + Send + Sync>(
    coverage: C,
    drawing: &Drawing<f64>,
    size: ImageSize,
) -> Vec<[u64; 2]> {
    let flat =
        [drawing.vertices.as_flattened(), drawing.colors.as_flattened(), &drawing.confidences, &drawing.background];
    let flat = Values::F64(flat.concat());
    let target = Image::from_planar(size, vec![0.4; 3 * size.pixels()]).unwrap();
    let mut found = Vec::new();
    for compositing in [Compositing::Blend, Compositing::Over] {
        for loss in [PixelLoss::Mae, PixelLoss::Mse] {
            let renderer = TileRenderer { coverage, compositing };
            let op = RenderLossOp::new(renderer, loss, vec![target.clone()], drawing.object_count(), VERTICES);
            let op = Batched::<f64, _>::new(op.unwrap());
            found.push([false, true].map(|save| op.forward(1, flat.as_ref(), save).unwrap().0.to_f64()[0].to_bits()));
        }
    }
    found
}

proptest! {
    #[test]
    fn the_loss_alone_is_that_worked_out_with_its_gradient(
        scene in strategy::scene(0..5, 1..4),
        (width, height) in (1_usize..40, 1_usize..40),
    ) {
        let (size, mut drawing) = (ImageSize::new(width, height).unwrap(), Drawing::default());
        scene.draw(&OutlineBasis::new(VERTICES, 3).unwrap(), &mut drawing).unwrap();
        let all = [
            ("contour", losses(ContourDistance::default(), &drawing, size)),
            ("triangles", losses(SoftTriangles::default(), &drawing, size)),
            ("exact", losses(ExactArea, &drawing, size)),
            ("hard", losses(HardMask, &drawing, size)),
        ];
        for (name, losses) in all {
            prop_assert!(losses.iter().all(|[alone, with]| alone == with), "{}: {:x?}", name, losses);
        }
    }

    #[test]
    fn sharp_edges_agree_with_hard(star in strategy::star_px(), squared in any::<bool>()) {
        let size = ImageSize::new(24, 24).unwrap();
        let edge = if squared {
            EdgeProfile { offset: 0.0, sigma: 1e-8, cut: 1e-6, ..EdgeProfile::reference() }
        } else {
            EdgeProfile::distance(1e-5)
        };
        let hard = coverage(HardMask, &star, size).unwrap();
        let contour = coverage(ContourDistance::new(edge), &star, size).unwrap();
        let triangles = coverage(SoftTriangles { edge, ..SoftTriangles::default() }, &star, size).unwrap();
        for (i, &inside) in hard.iter().enumerate() {
            // On an edge all is open; on a seam coverage is above 1/2.
            if (contour[i] - 0.5).abs() > 0.499 {
                prop_assert_eq!(contour[i] > 0.5, inside > 0.5, "contour, pixel {}", i);
                prop_assert_eq!(triangles[i] >= 0.5, inside > 0.5, "triangles, pixel {}", i);
            }
        }
    }

    #[test]
    fn area_profiles_are_painted_exactly(star in strategy::star_px(), cotangent in prop::collection::vec(-1.0..1.0, 576)) {
        let (size, by_profile) = (ImageSize::new(24, 24).unwrap(), ContourDistance::new(EdgeProfile::area()));
        prop_assert_eq!(coverage(by_profile, &star, size).unwrap(), coverage(ExactArea, &star, size).unwrap());
        let gradients = (
            coverage_vjp(by_profile, &star, size, &cotangent).unwrap(),
            coverage_vjp(ExactArea, &star, size, &cotangent).unwrap(),
        );
        prop_assert_eq!(gradients.0, gradients.1);
    }

    #[test]
    fn whole_pixels_agree_with_hard(star in strategy::star_px()) {
        let size = ImageSize::new(24, 24).unwrap();
        let hard = coverage(HardMask, &star, size).unwrap();
        for (area, inside) in coverage(ExactArea, &star, size).unwrap().into_iter().zip(hard) {
            prop_assert!(area > 1e-9 || inside < 0.5);
            prop_assert!(area < 1.0 - 1e-9 || inside > 0.5);
        }
    }

    #[test]
    fn wild_outlines_in_any_image_stay_in_range(
        outline in strategy::wild_outline(),
        (width, height) in (1_usize..40, 1_usize..40),
    ) {
        for (name, coverage) in each(&outline, ImageSize::new(width, height).unwrap()) {
            prop_assert!(coverage.unwrap().iter().all(|p| (0.0..=1.0).contains(p)), "{}", name);
        }
    }
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    let size = ImageSize::new(8, 8).unwrap();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (name, coverage) in each(&[[1.0, 1.0], [5.0, bad], [2.0, 6.0]], size) {
            let expected = RenderError::NotFinite { what: "outline", object: Some(0) };
            assert_eq!(coverage, Err(expected), "{name}");
        }
    }
}

#[test]
fn outlines_outside_the_view_leave_the_background() {
    let size = ImageSize::new(8, 8).unwrap();
    for shift in [[-30.0, 0.0], [30.0, 0.0], [0.0, -30.0], [0.0, 30.0], [1e30, 1e30]] {
        let outline = [[1.0, 1.0], [5.0, 1.0], [2.0, 6.0]].map(|v| [v[0] + shift[0], v[1] + shift[1]]);
        for (name, coverage) in each(&outline, size) {
            assert!(coverage.unwrap().iter().all(|&p| p <= 0.0), "{name}");
        }
    }
}

#[test]
fn an_image_of_one_pixel_is_painted() {
    let size = ImageSize::new(1, 1).unwrap();
    for (name, coverage) in each(&[[-5.0, -5.0], [6.0, -5.0], [6.0, 6.0], [-5.0, 6.0]], size) {
        assert!(coverage.unwrap()[0] > 0.99, "{name}");
    }
    assert_eq!(drawing(&[[0.0_f64, 0.0]], size).object_count(), 1);
}
