use alloc::vec::Vec;

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::{Image, ImageSize};

use super::{JointObject, JointProblem, JointScene, JointScratch, PER_OBJECT, refine};
use crate::cholesky::packed;
use crate::pose::field::OutlineField;
use crate::pose::gauss_newton::PosePx;
use crate::pose::search::Prototype;

/// An ellipse with a bump, 48 edges.
fn shape() -> Prototype<f64> {
    let vertex = |i: u32| {
        let angle = f64::from(i % 48) * core::f64::consts::TAU / 48.0;
        [angle.cos() + 0.15 * (2.0 * angle).cos(), -0.7 * angle.sin()]
    };
    let outline: Vec<[f64; 2]> = (0..=48).map(vertex).collect();
    let field = OutlineField::new(&outline).unwrap();
    Prototype { outline, field, symmetry: 1 }
}

/// Three objects, all overlapping, one of them half there.
fn scene() -> JointScene<f64> {
    let object = |translation, log_scale, rotation, color, confidence| JointObject {
        shape: 0,
        pose: PosePx { translation, log_scale, rotation },
        color,
        confidence,
    };
    JointScene {
        background: [0.31, 0.42, 0.63],
        objects: [
            object([14.3, 15.2], 2.1, 0.3, [0.8, 0.1, 0.2], 1.0),
            object([21.1, 18.7], 1.9, -1.1, [0.2, 0.9, 0.4], 0.6),
            object([17.8, 24.4], 2.0, 2.2, [0.1, 0.3, 0.7], 1.0),
        ]
        .into(),
    }
}

/// Smooth waves: an image that no scene explains.
fn image() -> Image<f64> {
    let size = ImageSize::new(40, 36).unwrap();
    let value = |i: u32| 0.5 + 0.4 * (0.37 * f64::from(i % 40)).sin() * (0.23 * f64::from(i / 40)).cos();
    Image::from_planar(size, (0..3 * 40 * 36).map(value).collect()).unwrap()
}

fn value(scene: &mut JointScene<f64>, lane: usize) -> &mut f64 {
    let objects = scene.objects.len();
    if lane >= PER_OBJECT * objects {
        return &mut scene.background[lane - PER_OBJECT * objects];
    }
    let object = &mut scene.objects[lane / PER_OBJECT];
    match lane % PER_OBJECT {
        at @ (0 | 1) => &mut object.pose.translation[at],
        2 => &mut object.pose.log_scale,
        3 => &mut object.pose.rotation,
        at => &mut object.color[at - 4],
    }
}

#[test]
fn the_gradient_is_that_of_half_the_cost() {
    let (shapes, image, mut scene) = ([shape()], image(), scene());
    // A softer edge than the reference's at 36 px, so that bands are several pixels wide; no cut, which is a jump.
    let edge = EdgeProfile { offset: 5e-4, sigma: 4e-3, cut: 0.1, ..EdgeProfile::reference() };
    for compositing in [Compositing::Blend, Compositing::Over] {
        let problem = JointProblem {
            image: image.view(),
            shapes: &shapes,
            edge,
            compositing,
            colors: true,
            coarse: false,
            width: 0.3,
        };
        let mut scratch = JointScratch::default();
        scratch.assemble(&problem, &scene);
        let gradient = scratch.gradient.clone();
        assert_eq!(gradient.len(), 3 * PER_OBJECT + 3);
        let largest = gradient.iter().fold(0.0_f64, |most, g| most.max(g.abs()));
        for (lane, &analytic) in gradient.iter().enumerate() {
            let mut cost = |by: f64| {
                *value(&mut scene, lane) += by;
                let cost = scratch.assemble(&problem, &scene);
                *value(&mut scene, lane) -= by;
                cost
            };
            let numeric = 0.5 * (cost(1e-6) - cost(-1e-6)) / 2e-6;
            assert!(
                (analytic - numeric).abs() < 1e-6 * (1.0 + largest),
                "{compositing:?} {lane}: {analytic} {numeric}"
            );
        }
    }
}

#[test]
fn the_hessian_is_that_of_the_rows() {
    // At residuals of 0 it is the second derivative of half the cost: cost(x + h) = h^2 H / 2 x 2.
    let (shapes, truth) = ([shape()], scene());
    let edge = EdgeProfile { offset: 5e-4, sigma: 4e-3, cut: 0.1, ..EdgeProfile::reference() };
    let mut image = image();
    let problem = |image, width| JointProblem {
        image,
        shapes: &shapes,
        edge,
        compositing: Compositing::Blend,
        colors: true,
        coarse: false,
        width,
    };
    // The image at which all residuals vanish, pixel by pixel: the cost of an image off by 1 in one channel is 1 more.
    render(&truth, &shapes[0], edge, &mut image);
    let mut scratch = JointScratch::default();
    let cost = scratch.assemble(&problem(image.view(), 1e3), &truth);
    assert!(cost < 1e-20, "{cost}");
    let hessian = scratch.hessian.clone();
    let mut moved = truth.clone();
    for lane in [0, 2, 3, 5, 7, 9, 16, 21, 22] {
        *value(&mut moved, lane) += 1e-4;
        let cost = scratch.assemble(&problem(image.view(), 1e3), &moved);
        *value(&mut moved, lane) -= 1e-4;
        let expected = hessian[packed(lane, lane)];
        assert!((cost / 1e-8 - expected).abs() < 2e-3 * expected, "lane {lane}: {} {expected}", cost / 1e-8);
    }
}

/// The blend of the three objects, written out anew.
fn render(scene: &JointScene<f64>, shape: &Prototype<f64>, edge: EdgeProfile<f64>, image: &mut Image<f64>) {
    let size = image.size();
    let half_side = 0.5 * 36.0;
    for i in 0..size.pixels() {
        let point = [i % size.width(), i / size.width()].map(|v| f64::from(u32::try_from(v).unwrap()) + 0.5);
        let (mut total, mut sum, mut clear) = (0.0, [0.0; 3], 1.0);
        for object in &scene.objects {
            let scale = object.pose.log_scale.exp();
            let (sin, cos) = object.pose.rotation.sin_cos();
            let [x, y] = [0, 1].map(|c| (point[c] - object.pose.translation[c]) / scale);
            let d = shape.field.distance([cos * x + sin * y, cos * y - sin * x]).0 * scale / half_side;
            let coverage = if d * d.abs() > edge.cut {
                0.0
            } else {
                1.0 / (1.0 + ((d * d.abs() - edge.offset) / edge.sigma).exp())
            };
            let weight = coverage * (10.0 * (object.confidence - 1.0)).exp();
            total += weight;
            clear *= 1.0 - coverage * object.confidence;
            (0..3).for_each(|c| sum[c] += weight * object.color[c]);
        }
        for (c, sum) in sum.into_iter().enumerate() {
            let mean = sum / total.max(1e-7);
            image.data_mut()[c * size.pixels() + i] = scene.background[c] * clear + (1.0 - clear) * mean;
        }
    }
}

#[test]
fn refinement_returns_to_the_truth() {
    let (shapes, truth) = ([shape()], scene());
    let edge = EdgeProfile { offset: 5e-4, sigma: 1e-3, cut: 9.21e-3, ..EdgeProfile::reference() };
    let mut image = image();
    render(&truth, &shapes[0], edge, &mut image);
    let problem = JointProblem {
        image: image.view(),
        shapes: &shapes,
        edge,
        compositing: Compositing::Blend,
        colors: true,
        coarse: false,
        width: 0.5,
    };
    let mut moved = truth.clone();
    for lane in 0..3 * PER_OBJECT + 3 {
        let by = [0.4, -0.3, 0.03, 0.05, 0.03, -0.02, 0.01][lane % PER_OBJECT];
        *value(&mut moved, lane) += by;
    }
    let result = refine(&problem, &mut moved, 40, &mut JointScratch::default());
    assert!(result.cost < 1e-6, "{result:?}");
    for (lane, tolerance) in (0..3 * PER_OBJECT + 3).map(|lane| (lane, if lane % PER_OBJECT < 2 { 1e-2 } else { 3e-3 }))
    {
        let (found, expected) = (*value(&mut moved, lane), *value(&mut truth.clone(), lane));
        assert!((found - expected).abs() < tolerance, "lane {lane}: {found} is not {expected}");
    }
}
