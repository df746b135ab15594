use alloc::vec::Vec;

use dvp_core::shape::REFERENCE_VERTICES;
use proptest::prelude::*;

use crate::free::basis::Basis;
use crate::free::foot::{EdgeLanes, foot};
use crate::free::outline_fit::FreeOutline;
use crate::pose::gauss_newton::{Frame, PosePx};
use crate::segment::EdgeSample;
use crate::split::overlap::Overlap;
use crate::split::pair::{Pair, PairScratch, Target};
use dvp_core::render::EdgeProfile;

/// The reference renderer's edges, and blurred ones, at 128 pixels.
fn overlaps() -> [Overlap<f64>; 2] {
    [EdgeProfile::reference(), EdgeProfile::distance(0.01)].map(|profile| Overlap(profile.in_pixels(128.0)))
}

fn pair() -> Pair<f64> {
    let outline = FreeOutline {
        center: [50.0, 52.0],
        rows: [[14.0, 1.0, -2.0, -10.0], [0.9, 1.0, -0.7, 0.8], [0.6, -0.4, 0.7, 0.6]].into(),
    };
    Pair { outline, motion: PosePx { translation: [57.0, -22.0], log_scale: 0.02, rotation: 0.7 } }
}

/// What the pixels around the union show.
fn samples(pair: &Pair<f64>, overlap: &Overlap<f64>, basis: &Basis<f64>) -> Vec<EdgeSample<f64>> {
    let (mut vertices, mut lanes) = (Vec::new(), EdgeLanes::default());
    pair.outline.write_vertices(basis, REFERENCE_VERTICES, &mut vertices);
    lanes.set(&vertices);
    let frame = Frame::new(&pair.motion);
    let mut samples = Vec::new();
    for index in 0..128 * 128_u32 {
        let point = [index % 128, index / 128].map(|v| f64::from(v) + 0.5);
        let second = frame.scale * foot(&vertices, &lanes, frame.to_unit(point)).distance;
        let distance = overlap.union([foot(&vertices, &lanes, point).distance, second]).0;
        if (0.2..1.9).contains(&distance) {
            samples.push(EdgeSample { point, distance, weight: 1.0 });
        }
    }
    samples
}

/// A step that differs from number to number.
fn step(numbers: usize, size: f64) -> Vec<f64> {
    (0..numbers).map(|i| size * ((i * 7 % 5) as f64 - 1.9)).collect()
}

#[test]
fn the_gradient_of_a_pair_is_that_of_its_cost() {
    let basis = Basis::new(REFERENCE_VERTICES, 3);
    for overlap in overlaps() {
        let truth = pair();
        let samples = samples(&truth, &overlap, &basis);
        let carried = &samples[..9];
        let target = Target { samples: &samples, carried, overlap, basis: &basis };
        let mut scratch = PairScratch::default();
        truth.normal(&target, &mut scratch);
        let numbers = scratch.gradient.len();
        let off = truth.moved(&step(numbers, 0.05));
        off.normal(&target, &mut scratch);
        let gradient = scratch.gradient.clone();
        for (i, &slope) in gradient.iter().enumerate() {
            let mut cost = |by: f64| {
                let mut step = alloc::vec![0.0; numbers];
                step[i] = -by;
                off.moved(&step).normal(&target, &mut scratch)
            };
            // Few samples change the edge that is nearest, or whether the other object shows.
            let (h, scale) = (1e-5, gradient.iter().fold(0.0, |most: f64, g| most.max(g.abs())));
            let difference = 0.5 * (cost(h) - cost(-h)) / (2.0 * h);
            assert!((slope - difference).abs() < 2e-3 * scale, "number {i}: {slope} is not {difference}");
        }
    }
}

#[test]
fn a_pair_is_found_from_nearby() {
    let basis = Basis::new(REFERENCE_VERTICES, 3);
    for overlap in overlaps() {
        let truth = pair();
        let samples = samples(&truth, &overlap, &basis);
        let target = Target { samples: &samples, carried: &[], overlap, basis: &basis };
        let mut scratch = PairScratch::default();
        let start = truth.moved(&step(2 + 4 * 3 + 4, 0.2));
        let found = start.clone().refined(&target, 8, &mut scratch);
        let [before, after] = [&start, &found].map(|pair| pair.misfit(&target, &mut scratch));
        assert!(before > 0.01 && after < 1e-6, "{before} and {after}");
        let center = truth.outline.center;
        let [[x, y], [u, v]] = [&truth, &found].map(|pair| Frame::new(&pair.motion).to_pixels(center));
        assert!((x - u).hypot(y - v) < 0.01, "{found:?}");
    }
}

#[test]
fn where_the_other_object_covers_all_nothing_is_told() {
    for overlap in overlaps() {
        assert_eq!(overlap.alone(0.5, -30.0), None);
        assert_eq!(overlap.alone(-30.0, -30.0), None);
        // On the outline squared distances have no slope to divide by.
        let (distance, slopes) = overlap.union([0.0, 1e-9]);
        assert!(distance.is_finite() && slopes.iter().all(|slope| slope.is_finite()), "{distance} {slopes:?}");
    }
}

proptest! {
    #[test]
    fn what_the_other_object_adds_is_taken_off(own in -0.5_f64..1.6, other in 0.8_f64..3.0) {
        for overlap in overlaps() {
            let (seen, slopes) = overlap.union([own, other]);
            prop_assert!(seen <= own.min(other) + 1e-9);
            // Where the pixel tells a distance, and both have a share in it.
            if let Some((alone, slope)) = overlap.alone(seen, other)
                && slopes.iter().all(|&slope| slope > 1e-3)
            {
                prop_assert!((alone - own).abs() < 5e-3, "{alone} is not {own}");
                prop_assert!((slope * slopes[0] - 1.0).abs() < 5e-2, "{slope} times {}", slopes[0]);
            }
        }
    }

    #[test]
    fn slopes_of_a_union_are_those_of_its_distance(own in 0.2_f64..1.6, other in 0.2_f64..1.6) {
        let h = 1e-6;
        for overlap in overlaps() {
            let slopes = overlap.union([own, other]).1;
            for k in 0..2 {
                let at = |by: f64| {
                    let mut distances = [own, other];
                    distances[k] += by;
                    overlap.union(distances).0
                };
                let difference = (at(h) - at(-h)) / (2.0 * h);
                // Where the farther one begins to show is a small step.
                prop_assume!(difference.abs() < 10.0);
                prop_assert!((slopes[k] - difference).abs() < 1e-3, "{} is not {difference}", slopes[k]);
            }
        }
    }
}
