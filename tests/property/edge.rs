//! Edge profiles: what holds for every law, and how near profiles in distance come to blur and to areas.

use dvp_core::render::{EdgeLaw, EdgeProfile};
use dvp_core::scene::PixelProfile;
use proptest::prelude::*;

fn profile() -> impl Strategy<Value = EdgeProfile<f64>> {
    let law = prop_oneof![Just(EdgeLaw::SquaredDistance), Just(EdgeLaw::Distance)];
    let by_law = (law, -0.01..0.01, 1e-4..0.05).prop_map(|(law, offset, sigma)| EdgeProfile {
        law,
        offset,
        cut: offset + 7.0 * sigma,
        sigma,
    });
    prop_oneof![8 => by_law, 1 => Just(EdgeProfile::area()), 1 => Just(EdgeProfile::reference())]
}

proptest! {
    #[test]
    fn coverage_falls_from_one_to_zero(profile in profile(), unit_px in 16.0..600.0) {
        let edge = profile.in_pixels(unit_px);
        let samples: Vec<(f64, f64)> = (-300..=300).map(|i| edge.coverage(f64::from(i) * 0.05)).collect();
        prop_assert!(samples.iter().all(|(p, slope)| (0.0..=1.0).contains(p) && *slope <= 0.0));
        prop_assert!(samples.windows(2).all(|pair| pair[1].0 <= pair[0].0));
    }

    #[test]
    fn half_is_covered_where_the_profile_says(profile in profile(), unit_px in 16.0..600.0) {
        let at = profile.half_coverage() * unit_px;
        prop_assert!((profile.in_pixels(unit_px).coverage(at).0 - 0.5).abs() < 1e-9);
    }

    #[test]
    fn distance_inverts_coverage(profile in profile(), unit_px in 16.0..600.0, coverage in 0.02..0.98) {
        let edge = profile.in_pixels(unit_px);
        prop_assert!((edge.coverage(edge.distance(coverage)).0 - coverage).abs() < 1e-9);
    }

    #[test]
    fn slopes_are_differences(profile in profile(), unit_px in 16.0..600.0, coverage in 0.02..0.98) {
        let edge = profile.in_pixels(unit_px);
        let at = edge.distance(coverage);
        // The root of a squared distance has a kink on the outline.
        prop_assume!(!edge.squared || at.abs() > 1e-3);
        let step = 1e-6 / edge.sharpness.max(1.0);
        let difference = (edge.coverage(at + step).0 - edge.coverage(at - step).0) / (2.0 * step);
        let slope = edge.coverage(at).1;
        prop_assert!((difference - slope).abs() < 1e-4 * (1.0 + slope.abs()), "{difference}, not {slope}");
    }
}

/// Largest difference between a profile and another law of distances (px), within 6 px of the outline.
fn farthest(edge: &PixelProfile<f64>, other: impl Fn(f64) -> f64) -> f64 {
    let distances = (-6000..=6000).map(|i| f64::from(i) * 1e-3);
    distances.map(|d| (edge.coverage(d).0 - other(d)).abs()).fold(0.0, f64::max)
}

/// Share of a standard normal distribution beyond x, by Simpson's rule on 4000 pieces.
fn beyond(x: f64) -> f64 {
    let density = |t: f64| (-0.5 * t * t).exp() / (2.0 * core::f64::consts::PI).sqrt();
    let step = x / 4000.0;
    let inner = (1..4000).map(|i| if i % 2 == 1 { 4.0 } else { 2.0 } * density(f64::from(i) * step)).sum::<f64>();
    0.5 - (density(0.0) + inner + density(x)) * step / 3.0
}

#[test]
fn a_profile_in_distance_is_nearly_a_gaussian_blur() {
    // Sigma 1 px at 128 px per unit: a Gaussian of 1.702 px.
    let edge = EdgeProfile::distance(1.0 / 64.0).in_pixels(128.0);
    let off = farthest(&edge, |d| beyond(d / 1.702));
    assert!(off > 0.009 && off < 0.0096, "{off}");
}

#[test]
fn an_area_profile_is_near_the_share_of_a_half_plane() {
    let edge = EdgeProfile::area().in_pixels(77.0);
    let along_the_grid = farthest(&edge, |d| (0.5 - d).clamp(0.0, 1.0));
    assert!(along_the_grid > 0.06 && along_the_grid < 0.068, "{along_the_grid}");
    // Along the diagonal a corner is cut off: (half the diagonal - d)^2.
    let corner = |d: f64| (0.5_f64.sqrt() - d.abs()).max(0.0).powi(2);
    let along_the_diagonal = farthest(&edge, |d| if d > 0.0 { corner(d) } else { 1.0 - corner(d) });
    assert!(along_the_diagonal < 0.04, "{along_the_diagonal}");
}
