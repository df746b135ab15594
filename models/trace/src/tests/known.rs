//! What is stated of circles and ellipses: how far their numbers may be off.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::shape::{AnyShape, Ellipse};
use dvp_core::{Image, Vec2};

use super::{BLUE, SIZE, WHITE, size};
use crate::{Known, ObjectDoubt, PoseCovariance, trace};

/// Places in a column of pixels at which an ellipse is cut: polygons of the renderers would be off by as much as what is stated.
const CUTS: usize = 128;

/// The picture of an ellipse, each pixel as much of it as is covered, in 8 bits.
fn painted(place: [f64; 2], radii: [f64; 2], angle: f64) -> Image<f32> {
    let axes = [Vec2::from_angle(angle) / radii[0], Vec2::from_angle(angle).perp() / radii[1]];
    let mut covered = vec![0.0; SIZE * SIZE];
    for cut in 0..SIZE * CUTS {
        // Along the column |from + y along|^2 = 1 in a plane in which it is the unit circle.
        let x = (cut as f64 + 0.5) / CUTS as f64 - place[0];
        let from = Vec2::new(axes[0].x * x, axes[1].x * x);
        let along = Vec2::new(axes[0].y, axes[1].y);
        let (steep, middle) = (along.length_squared(), from.dot(along));
        let square = middle * middle - steep * (from.length_squared() - 1.0);
        if square <= 0.0 {
            continue;
        }
        let ends = [-1.0, 1.0].map(|sign| place[1] + (sign * square.sqrt() - middle) / steep);
        for y in ends[0] as usize..=ends[1] as usize {
            let share = ends[1].min(y as f64 + 1.0) - ends[0].max(y as f64);
            covered[y * SIZE + cut / CUTS] += share / CUTS as f64;
        }
    }
    let mixed = |c: usize| {
        let [back, front] = [WHITE[c], BLUE[c]].map(|value| (f64::from(value) * 255.0).round());
        covered.iter().map(move |share| ((back + (front - back) * share).round() / 255.0) as f32)
    };
    let pixels: Vec<f32> = (0..3).flat_map(mixed).collect();
    Image::from_planar(size(), pixels).unwrap()
}

/// Errors of a drawing of one ellipse in stated standard deviations: of x, y, angle, and both axes.
fn errors(place: [f64; 2], radii: [f64; 2], angle: f64) -> [f64; 5] {
    let traced = trace(&painted(place, radii, angle).view(), &Known::default()).unwrap();
    let ([found], [ObjectDoubt { pose: Some(PoseCovariance { numbers, .. }), .. }]) =
        (&traced.scene.objects[..], &traced.doubts[..])
    else {
        panic!("one object, and what is known of it: {radii:?} at {angle}")
    };
    let AnyShape::Ellipse(Ellipse { radii: sides }) = found.shape else { panic!("{:?}", found.shape) };
    let unit = SIZE as f64;
    let is_turned = sides[0] < sides[1];
    let sides = if is_turned { [sides[1], sides[0]] } else { sides };
    let turn = f64::from(found.pose.rotation) + if is_turned { 0.5 * core::f64::consts::PI } else { 0.0 };
    let off = |k: usize| (f64::from(found.pose.translation[k]) - place[k] / unit) / numbers[k][k].sqrt();
    // The logarithm of an axis is that of the scale and that of the stretch, which belongs to the first side.
    let axis = |k: usize| {
        let sign = if (k == 0) == is_turned { -1.0 } else { 1.0 };
        let variance = numbers[2][2] + numbers[4][4] + 2.0 * sign * numbers[2][4];
        (f64::from(sides[k]) * unit / radii[k]).ln() / variance.sqrt()
    };
    let half_turns = ((turn - angle) / core::f64::consts::PI).round();
    let of_angle = (turn - angle - half_turns * core::f64::consts::PI) / numbers[3][3].sqrt();
    [off(0), off(1), of_angle, axis(0), axis(1)]
}

#[test]
fn stated_deviations_are_those_of_the_numbers() {
    const COUNT: usize = 120;
    let mut squares = [0.0; 5];
    for k in 0..COUNT {
        // Multiples of roots of primes, without what is whole of them: spread evenly.
        let between = |prime: f64, low: f64, high: f64| low + (high - low) * (k as f64 * prime.sqrt()).fract();
        let long = between(2.0, 10.0, 30.0);
        let radii = [long, long * between(3.0, 0.35, 0.85)];
        let place = [5.0, 7.0].map(|prime| between(prime, long + 3.0, SIZE as f64 - long - 3.0));
        let found = errors(place, radii, between(11.0, 0.1, 1.4));
        for (sum, error) in squares.iter_mut().zip(found) {
            *sum += error * error / COUNT as f64;
        }
    }
    // A root mean square of 120 is within 13 % of its own in 95 of 100 draws, of five of them together in 85.
    assert!(squares.iter().all(|square: &f64| (0.8..1.25).contains(&square.sqrt())), "{squares:?}");
}

#[test]
fn tips_of_slender_ellipses_are_known_too() {
    // Radii of curvature at the tips of 1.2 px: no window there is like a parabola, and the picture is as exact as others.
    for k in 0..8 {
        let angle = 0.05 + 0.2 * f64::from(k);
        let found = errors([40.3, 51.8], [11.0, 3.6], angle);
        assert!(found.iter().all(|error| error.abs() < 4.0), "{found:?} at {angle}");
    }
}
