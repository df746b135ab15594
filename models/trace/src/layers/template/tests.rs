//! A polygon is found again from what is seen of it elsewhere, in another size.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::geometry::LineSegment;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::Seen;
use crate::sample::Sample;

const SIGMA: f64 = 0.02;

/// Corners of a polygon around the origin, by how far each is from it.
fn corners(radii: &[f64]) -> Vec<Vec2<f64>> {
    let angle = |k: usize| core::f64::consts::TAU * k as f64 / radii.len() as f64;
    radii.iter().enumerate().map(|(k, radius)| Vec2::from_angle(angle(k)) * *radius).collect()
}

fn sides(corners: &[Vec2<f64>]) -> Vec<LineSegment<f64>> {
    LineSegment::closed(&corners.iter().map(|corner| corner.to_array()).collect::<Vec<_>>()).collect()
}

/// Samples a pixel apart along sides.
fn samples(sides: &[LineSegment<f64>]) -> Vec<Sample> {
    let along = |side: &LineSegment<f64>| {
        let (side, count) = (*side, side.along.length() as usize);
        let point = move |k: usize| side.from + side.along * ((k as f64 + 0.5) / count as f64);
        (0..count).map(move |k| Sample::new(point(k), side.along.normalized().unwrap().perp(), SIGMA))
    };
    sides.iter().flat_map(along).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(0x9a8), ..ProptestConfig::default() })]

    #[test]
    fn an_outline_lies_where_it_was_put(
        radii in proptest::collection::vec(14.0..20.0, 5..8), scale in 0.5..2.0, x in -30.0..30.0, y in -30.0..30.0, first in 0_usize..8,
    ) {
        let corners = corners(&radii);
        let shift = Vec2::new(x, y);
        let moved: Vec<Vec2<f64>> = corners.iter().map(|corner| *corner * scale + shift).collect();
        // Three sides of it are seen, and half of the next.
        let mut seen = sides(&moved);
        seen.rotate_left(first % radii.len());
        seen.truncate(4);
        seen[3] = LineSegment::new(seen[3].from, seen[3].from + seen[3].along * 0.5);
        let (map, misfit) = Seen::new(samples(&seen), &seen).placed(&sides(&corners)).unwrap();
        prop_assert!((map.scale() / scale - 1.0).abs() < 1e-6, "{map:?}");
        prop_assert!((map.translation - shift).length() < 1e-4, "{map:?}");
        prop_assert!(misfit < 1e-6);
    }
}

#[test]
fn another_outline_has_no_place() {
    let [square, triangle] = [[20.0; 4].as_slice(), [20.0; 3].as_slice()].map(|radii| sides(&corners(radii)));
    assert!(Seen::new(samples(&square), &square).placed(&triangle).is_none());
    assert!(Seen::new(Vec::new(), &square).placed(&square).is_none());
}
