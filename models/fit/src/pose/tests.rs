use alloc::vec::Vec;

use super::equations::{Robustness, SampleLanes};
use super::field::OutlineField;
use super::gauss_newton::{PosePx, solve4};
use crate::segment::EdgeSample;

/// Numbers in [0, 1) from a linear congruential generator (Knuth's MMIX).
struct Numbers(u64);

impl Numbers {
    #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / 9_007_199_254_740_992.0
    }
}

/// A star of 40 vertices with radii between 0.6 and 1.2; the last one repeats the first, as outlines do.
fn star() -> Vec<[f64; 2]> {
    let vertex = |i: u32| {
        let angle = f64::from(i % 40) * core::f64::consts::TAU / 40.0;
        let radius = 0.9 + 0.3 * (3.0 * angle).cos();
        [radius * angle.cos(), radius * angle.sin()]
    };
    (0..=40).map(vertex).collect()
}

/// Distance to all edges; inside by the even-odd rule.
fn brute_force(vertices: &[[f64; 2]], [x, y]: [f64; 2]) -> f64 {
    let (mut nearest, mut inside) = (f64::INFINITY, false);
    for pair in vertices.windows(2) {
        let [[ax, ay], [bx, by]] = [pair[0], pair[1]];
        let u = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / ((bx - ax).powi(2) + (by - ay).powi(2));
        let u = u.clamp(0.0, 1.0);
        nearest = nearest.min((ax + u * (bx - ax) - x).hypot(ay + u * (by - ay) - y));
        if (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax) {
            inside = !inside;
        }
    }
    if inside { -nearest } else { nearest }
}

#[test]
fn field_is_the_distance_to_the_nearest_edge() {
    let vertices = star();
    let (reversed, mut numbers): (Vec<_>, _) = (vertices.iter().rev().copied().collect(), Numbers(7));
    for outline in [&vertices, &reversed] {
        let field = OutlineField::new(outline).unwrap();
        for _ in 0..2000 {
            let point = [0, 1].map(|_| 3.0 * numbers.next() - 1.5);
            let (expected, (found, normal)) = (brute_force(outline, point), field.distance(point));
            // The nearest edge is looked for beside that of the cell's center: off the outline it may be missed by one
            // where two stretches of outline are nearly as near, by less than the cell's size.
            let tolerance = if expected.abs() < 0.15 { 1e-12 } else { 0.06 };
            assert!((found - expected).abs() <= tolerance, "{found} is not {expected} at {point:?}");
            let (low, high) = field.distance_bounds(point);
            assert!(low <= expected && expected <= high, "{expected} is not in {low} .. {high}");
            assert!((normal[0].hypot(normal[1]) - 1.0).abs() < 1e-12);
        }
        // Outside the grid the bounds still hold.
        for _ in 0..200 {
            let point = [0, 1].map(|_| 20.0 * numbers.next() - 10.0);
            let (low, high) = field.distance_bounds(point);
            let expected = brute_force(outline, point);
            assert!(low <= expected && expected <= high, "{expected} is not in {low} .. {high}");
        }
    }
}

#[test]
fn rough_distances_are_right_to_first_order() {
    // A circle of radius 1 in a grid of cells of 1/16: the middle of a cell is at most 0.0442 away. Over that the distance from
    // a circle leaves the plane that touches it by 0.0442^2 / 2 = 0.00098 over the radius, which is at most 0.0442 less there;
    // an edge of the 512 is turned from the circle by at most 0.0061, which makes 0.0003 of it.
    let circle: Vec<[f64; 2]> =
        (0..=512).map(|i| (f64::from(i % 512) * core::f64::consts::TAU / 512.0).sin_cos().into()).collect();
    let (field, mut numbers) = (OutlineField::new(&circle).unwrap(), Numbers(11));
    for _ in 0..2000 {
        let (angle, radius) = (core::f64::consts::TAU * numbers.next(), 0.7 + 0.6 * numbers.next());
        let [x, y] = [radius * angle.cos(), radius * angle.sin()];
        let rough = field.rough(&[[x], [y]]);
        assert!(
            (rough.distance[0] - (radius - 1.0)).abs() < 0.00098 / (radius - 0.0442) + 3e-4,
            "{rough:?} at {radius}, {angle}"
        );
        // The slope is that of the middle of the cell, an angle of at most 0.0442 / 0.66 + 0.0061 off, whose cosine is 0.9973.
        let across = rough.gradient[0][0] * angle.cos() + rough.gradient[1][0] * angle.sin();
        assert!(across > 0.997, "{rough:?} at {radius}, {angle}");
    }
}

#[test]
fn area_and_centroid_of_a_rectangle() {
    // 2 x 1 with its center at (1.5, 0.5); the farthest corner is (2.5, 1).
    let field = OutlineField::new(&[[0.5_f64, 0.0], [2.5, 0.0], [2.5, 1.0], [0.5, 1.0], [0.5, 0.0]]).unwrap();
    assert!((field.area - 2.0).abs() < 1e-12);
    assert!((field.centroid[0] - 1.5).abs() < 1e-12 && (field.centroid[1] - 0.5).abs() < 1e-12);
    assert!((field.radius - 7.25_f64.sqrt()).abs() < 1e-12);
    assert!(OutlineField::new(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]).is_none());
    assert!(OutlineField::new(&[[1.0_f64, 1.0]; 5]).is_none());
}

/// Samples around a pose: points within 3 px of its outline, distances off by up to 0.5 px.
fn samples(field: &OutlineField<f64>, pose: &PosePx<f64>) -> Vec<EdgeSample<f64>> {
    let mut numbers = Numbers(3);
    let scale = pose.log_scale.exp();
    let mut out = Vec::new();
    while out.len() < 60 {
        let point = pose.translation.map(|t| t + 3.0 * scale * (numbers.next() - 0.5));
        let (x, y) = (point[0] - pose.translation[0], point[1] - pose.translation[1]);
        let (sin, cos) = pose.rotation.sin_cos();
        let (distance, _) = field.distance([(cos * x + sin * y) / scale, (cos * y - sin * x) / scale]);
        if distance.abs() * scale < 3.0 {
            let distance = distance * scale + numbers.next() - 0.5;
            out.push(EdgeSample { point, distance, weight: 0.2 + numbers.next() });
        }
    }
    out
}

const POSE: PosePx<f64> = PosePx { translation: [31.3, 27.9], log_scale: 2.6, rotation: 0.7 };

#[test]
fn normal_equations_hold_half_the_gradient_of_the_cost() {
    let field = OutlineField::new(&star()).unwrap();
    let samples = samples(&field, &POSE);
    for (weighted, rough) in [(false, false), (true, false), (true, true)] {
        let robustness = Robustness { width_px: 0.4, rough };
        let total: f64 = samples.iter().map(|s| if weighted { s.weight * s.weight } else { 1.0 }).sum();
        let samples = SampleLanes::new(&samples, 1, weighted);
        let normal = POSE.normal(&field, &samples, robustness);
        assert!((normal.cost - POSE.cost(&field, &samples, robustness)).abs() < 1e-14);
        let cost = |lane: usize, by: f64| {
            let mut pose = POSE;
            match lane {
                0 | 1 => pose.translation[lane] += by,
                2 => pose.log_scale += by,
                _ => pose.rotation += by,
            }
            // The mean becomes a sum; half of it, since the equations leave out the factor 2.
            0.5 * total * pose.cost(&field, &samples, robustness)
        };
        for lane in 0..4 {
            let numeric = (cost(lane, 1e-6) - cost(lane, -1e-6)) / 2e-6;
            assert!((normal.gradient[lane] - numeric).abs() < 1e-6 * (1.0 + numeric.abs()), "lane {lane}: {numeric}");
        }
    }
}

#[test]
fn refinement_finds_the_pose_of_exact_samples() {
    let field = OutlineField::new(&star()).unwrap();
    let mut samples = samples(&field, &POSE);
    let scale = POSE.log_scale.exp();
    let (sin, cos) = POSE.rotation.sin_cos();
    for sample in &mut samples {
        let (x, y) = (sample.point[0] - POSE.translation[0], sample.point[1] - POSE.translation[1]);
        sample.distance = scale * field.distance([(cos * x + sin * y) / scale, (cos * y - sin * x) / scale]).0;
    }
    let samples = SampleLanes::new(&samples, 1, false);
    let start = PosePx { translation: [33.0, 26.5], log_scale: 2.5, rotation: 0.85 };
    let (found, cost, _) = start.refine(&field, &samples, Robustness { width_px: 3.0, rough: false }, 30);
    assert!(cost < 1e-10, "{cost}");
    assert!((found.translation[0] - 31.3).abs() < 1e-4 && (found.translation[1] - 27.9).abs() < 1e-4, "{found:?}");
    assert!((found.log_scale - 2.6).abs() < 1e-5 && (found.rotation - 0.7).abs() < 1e-5, "{found:?}");
}

#[test]
fn four_equations() {
    // diag(1, 2, 4, 8) x = (1, 2, 4, 8); damping 1 doubles the diagonal.
    let mut matrix = [[0.0; 4]; 4];
    for (i, value) in [1.0, 2.0, 4.0, 8.0].into_iter().enumerate() {
        matrix[i][i] = value;
    }
    let x = solve4(&matrix, &[1.0, 2.0, 4.0, 8.0], 1.0).unwrap();
    assert!(x.iter().all(|value: &f64| (value - 0.5).abs() < 1e-15), "{x:?}");
    matrix[1][1] = 0.0;
    assert_eq!(solve4(&matrix, &[1.0, 2.0, 4.0, 8.0], 1.0), None);
}
