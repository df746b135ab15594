//! Gradients of painted color ramps, down to the objects that have them.

use dvp_core::render::{Compositing, ExactRenderer, Renderer};
use dvp_core::scene::{ColorRamp, ColorStop, RampKind};
use dvp_core::shape::{Circle, OutlineBasis, Rectangle};
use dvp_core::{AnyShape, Drawing, DrawingGrad, ImageSize, Object, Paint, Pose, Scene, SceneGrad};
use dvp_tests::finite_difference::{compare, dot};
use proptest::prelude::*;

/// Numbers of an object, in the order of [`numbers`]: pose 4, points 4 or 6, per stop a color and an offset.
fn unflat(scene: &mut Scene<f64>, mut x: &[f64]) {
    let mut next = || x.split_off_first().copied().unwrap_or(f64::NAN);
    for object in &mut scene.objects {
        object.pose.translation.fill_with(&mut next);
        object.pose.scale = next();
        object.pose.rotation = next();
        let Paint::Ramp(ramp) = &mut object.paint else { continue };
        ramp.numbers_mut().for_each(|value| *value = next());
        ramp.stops.iter_mut().for_each(|stop| stop.offset = next());
    }
}

fn numbers(pose: [f64; 4], ramp: &ColorRamp<f64>, out: &mut Vec<f64>) {
    out.extend(pose);
    ramp.numbers(out);
    out.extend(ramp.stops.iter().map(|stop| stop.offset));
}

fn object(shape: impl Into<AnyShape<f64>>, pose: [f64; 4], kind: RampKind<f64>, colors: &[[f64; 3]]) -> Object<f64> {
    // The first stop lies behind the beginning and the last one before the end: colors before and behind stay as they are.
    let stops = colors.iter().enumerate().map(|(i, &color)| ColorStop { offset: 0.15 + 0.3 * i as f64, color });
    let [x, y, scale, rotation] = pose;
    Object {
        shape: shape.into(),
        pose: Pose { translation: [x, y], scale, rotation },
        paint: Paint::Ramp(ColorRamp { kind, stops: stops.collect() }),
        confidence: 0.9,
    }
}

/// Whether a pixel is so near to a stop, or to the center of a ramp, that a difference may step over it.
fn is_at_kink(drawing: &Drawing<f64>, i: usize, size: ImageSize) -> bool {
    let point = [i % size.width(), i / size.width()].map(|at| (at as f64 + 0.5) / size.unit_px() as f64);
    drawing.ramps.iter().any(|ramp| {
        let offset = ramp.kind.offset(point);
        let is_central = matches!(ramp.kind, RampKind::Radial(_)) && offset < 0.01;
        is_central || drawing.stops[ramp.stops.clone()].iter().any(|stop| (stop.offset - offset).abs() < 1e-3)
    })
}

fn color() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(0.0..1.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn ramps_match_differences(
        colors in prop::collection::vec(color(), 5),
        places in prop::collection::vec(0.3..0.7, 4),
        turns in prop::collection::vec(-3.0..3.0, 2),
        line in prop::array::uniform2(prop::array::uniform2(-0.8..0.8_f64)),
        rim in prop::array::uniform4(-0.2..0.2),
        over in any::<bool>(),
        alpha in any::<bool>(),
        cotangent in prop::collection::vec(-1.0..1.0, 97),
    ) {
        prop_assume!((line[0][0] - line[1][0]).hypot(line[0][1] - line[1][1]) > 0.3);
        let radial = [[0.1, -0.05], [0.9 + rim[0], rim[1]], [rim[2], 0.7 + rim[3]]];
        let compositing = if over { Compositing::Over } else { Compositing::Blend };
        // Where two objects blend, shares of a mean jump as coverage begins: there both cover everything.
        let size_of = if over { 1.0 } else { 20.0 };
        let scene = Scene {
            objects: vec![
                object(Rectangle { size: [1.4 * size_of, size_of], corner_radius: 0.1 }, [places[0], places[1], 0.4, turns[0]],
                    RampKind::Linear(line), &colors[..3]),
                object(Circle { radius: size_of }, [places[2], places[3], 0.3, turns[1]], RampKind::Radial(radial), &colors[3..]),
            ],
            compositing,
            ..Scene::empty([0.2, 0.9, 0.5])
        };
        let (size, channels) = (ImageSize::new(21, 18).unwrap(), if alpha { 4 } else { 3 });
        // Areas have no jumps, and differences no kinks to step over but those of the stops.
        let renderer = ExactRenderer { compositing, ..ExactRenderer::default() };
        let basis = OutlineBasis::new(48, 1).unwrap();
        let mut drawing = Drawing::default();
        scene.draw(&basis, &mut drawing).unwrap();
        let mut pull: Vec<f64> = cotangent.iter().copied().cycle().take(channels * size.pixels()).collect();
        for i in (0..size.pixels()).filter(|&i| is_at_kink(&drawing, i, size)) {
            (0..channels).for_each(|channel| pull[channel * size.pixels() + i] = 0.0);
        }
        let (mut grad_drawing, mut grad) = (DrawingGrad::default(), SceneGrad::default());
        grad_drawing.reset(&drawing);
        grad.reset(&scene);
        let mut scratch = Default::default();
        if alpha {
            renderer.render_rgba_vjp(&drawing, size, &mut scratch, &pull, &mut grad_drawing).unwrap();
        } else {
            renderer.render_vjp(&drawing, size, &mut scratch, &pull, &mut grad_drawing).unwrap();
        }
        scene.draw_vjp(&basis, &grad_drawing, &mut grad).unwrap();
        let (mut x, mut analytic) = (Vec::new(), Vec::new());
        for (object, grad) in scene.objects.iter().zip(&grad.objects) {
            let pose = &object.pose;
            let [a, b] = pose.translation;
            numbers([a, b, pose.scale, pose.rotation], object.paint.ramp().unwrap(), &mut x);
            let ramp = grad.ramp.as_ref().unwrap();
            numbers([grad.translation[0], grad.translation[1], grad.scale, grad.rotation], ramp, &mut analytic);
            // What moves all stops is what moves the color.
            for channel in 0..3 {
                let sum: f64 = ramp.stops.iter().map(|stop| stop.color[channel]).sum();
                prop_assert!((sum - grad.color[channel]).abs() < 1e-9);
            }
        }
        let mut moved = scene.clone();
        let mut image = vec![0.0; channels * size.pixels()];
        compare(&x, &analytic, 2e-5, |x| {
            unflat(&mut moved, x);
            moved.draw(&basis, &mut drawing).unwrap();
            if alpha {
                renderer.render_rgba(&drawing, size, &mut scratch, &mut image).unwrap();
            } else {
                renderer.render(&drawing, size, &mut scratch, &mut image).unwrap();
            }
            dot(&image, &pull)
        }).map_err(TestCaseError::fail)?;
    }
}
