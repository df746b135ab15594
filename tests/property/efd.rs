//! Invariants of descriptors, their normal form and their measures.

use core::f64::consts::PI;

use dvp_core::{Efd, Pose, Real};
use dvp_tests::strategy::{self, outline};
use proptest::prelude::*;

/// Largest difference of two descriptors' numbers.
fn difference(a: &Efd<f64>, b: &Efd<f64>) -> f64 {
    assert_eq!(a.harmonic_count(), b.harmonic_count());
    let pairs = a.rows().as_flattened().iter().zip(b.rows().as_flattened());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The same, over the two normal forms that one outline has.
fn difference_up_to_half_turn(a: &Efd<f64>, b: &Efd<f64>) -> f64 {
    difference(a, b).min(difference(a, &b.half_turn()))
}

/// How far the first harmonic is from a circle: 0 there, where the normal form has no phase.
fn elongation(efd: &Efd<f64>) -> f64 {
    efd.normalize().map_or(0.0, |normalized| 1.0 - normalized.efd.rows()[0][3].abs())
}

fn shoelace(polygon: &[[f64; 2]]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(|([x0, y0], [x1, y1])| (x0 * y1 - x1 * y0) / 2.0).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn error_falls_with_harmonics(contour in strategy::star_polygon(3..40)) {
        let (efd, _) = Efd::from_contour(&contour, 24).unwrap();
        let full = outline(&efd, 97);
        let mut previous = f64::INFINITY;
        for count in 0..=24 {
            // 96 points resolve products of 24 harmonics, so that the mean over them is the integral.
            let cut = outline(&efd.resized(count).resized(24), 97);
            let pairs = full[..96].as_flattened().iter().zip(cut[..96].as_flattened());
            let measured = (pairs.map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / 96.0).sqrt();
            let stated = efd.truncation_error(count);
            prop_assert!((measured - stated).abs() < 1e-7, "{count} harmonics: {measured}, stated {stated}");
            prop_assert!(stated <= previous);
            prop_assert!(efd.harmonics_needed(stated * (1.0 + 1e-9)) <= count);
            if stated > 1e-9 {
                prop_assert!(efd.harmonics_needed(stated * (1.0 - 1e-9)) > count);
            }
            previous = stated;
        }
    }

    #[test]
    fn many_harmonics_are_the_polygon(contour in strategy::star_polygon(3..12)) {
        let (efd, center) = Efd::from_contour(&contour, 80).unwrap();
        let area = shoelace(&contour);
        prop_assert!((efd.signed_area() - area).abs() < 0.01 * (1.0 + area), "{} for {area}", efd.signed_area());
        // Every corner is near the outline.
        let outline = outline(&efd, 641);
        for corner in &contour {
            let distances = outline.iter().map(|v| (v[0] + center[0] - corner[0]).hypot(v[1] + center[1] - corner[1]));
            prop_assert!(distances.fold(f64::INFINITY, f64::min) < 0.03);
        }
    }

    #[test]
    fn area_and_perimeter_are_those_of_the_outline(efd in strategy::efd(1..10)) {
        // 2000 edges: relative error (2 pi n / 2000)^2 / 6 = 2e-4 of harmonic n = 10.
        let dense = outline(&efd, 2001);
        let shoelace = shoelace(&dense);
        prop_assert!((efd.signed_area() - shoelace).abs() < 1e-4, "{} for {shoelace}", efd.signed_area());
        let length: f64 = dense.windows(2).map(|v| (v[1][0] - v[0][0]).hypot(v[1][1] - v[0][1])).sum();
        prop_assert!((efd.perimeter() - length).abs() < 0.01 * length, "{} for {length}", efd.perimeter());
    }

    #[test]
    fn normalizing_twice_is_once(efd in strategy::efd(1..12)) {
        let once = efd.normalize().unwrap().efd;
        let first = once.rows()[0];
        prop_assert!((first[0] - 1.0).abs() < 1e-12 && first[1].abs() < 1e-12 && first[2].abs() < 1e-12);
        prop_assert!(first[3].abs() <= 1.0 + 1e-12);
        prop_assume!(elongation(&efd) > 1e-4);
        prop_assert!(difference(&once, &once.normalize().unwrap().efd) < 1e-9);
    }

    #[test]
    fn nothing_is_lost_by_normalizing(efd in strategy::efd(1..12)) {
        let normalized = efd.normalize().unwrap();
        prop_assert!(difference(&normalized.restore(), &efd) < 1e-11);
        // The pose alone restores the outline but for its starting point, which the phase is.
        let mut posed = normalized.efd.clone();
        posed.shift(-normalized.phase);
        let pose = Pose { translation: [0.0; 2], scale: normalized.scale, rotation: normalized.rotation };
        let mut moved = outline(&posed, 33);
        pose.transform(&mut moved);
        for (moved, raw) in moved.iter().zip(outline(&efd, 33)) {
            prop_assert!((moved[0] - raw[0]).abs() + (moved[1] - raw[1]).abs() < 1e-11);
        }
    }

    #[test]
    fn normal_form_ignores_pose_and_start(
        contour in strategy::star_polygon(3..30),
        pose in strategy::pose(),
        start in 0_usize..30,
    ) {
        let (efd, center) = Efd::from_contour(&contour, 10).unwrap();
        prop_assume!(elongation(&efd) > 1e-3);
        let mut moved = contour.clone();
        moved.rotate_left(start % contour.len());
        pose.transform(&mut moved);
        // A vertex twice, and the first one again at the end, are the same polygon.
        moved.insert(1, moved[0]);
        moved.push(moved[0]);
        let (moved, moved_center) = Efd::from_contour(&moved, 10).unwrap();
        let expected = f64::xy(pose.transform_point(f64::vec2(center[0], center[1])));
        prop_assert!((moved_center[0] - expected[0]).hypot(moved_center[1] - expected[1]) < 1e-12);
        let (a, b) = (efd.normalize().unwrap(), moved.normalize().unwrap());
        prop_assert!(difference_up_to_half_turn(&a.efd, &b.efd) < 1e-9);
        prop_assert!((b.scale - a.scale * pose.scale).abs() < 1e-12);
        let turn = (b.rotation - a.rotation - pose.rotation) / PI;
        prop_assert!((turn - turn.round()).abs() < 1e-9, "angle off by {turn} half turns");
    }

    #[test]
    fn any_contour_gives_numbers_or_an_error(contour in strategy::wild_outline()) {
        if let Ok((efd, center)) = Efd::from_contour(&contour, 9) {
            prop_assert!(efd.rows().as_flattened().iter().chain(&center).all(|value| value.is_finite()));
            if let Ok(normalized) = efd.normalize() {
                prop_assert!(normalized.efd.rows().as_flattened().iter().all(|value| value.is_finite()));
            }
        }
    }
}
