//! Invariants of the symmetry order.

use core::f64::consts::TAU;

use dvp_core::shape::{SYMMETRY_TOLERANCE, Symmetry};
use dvp_core::{Efd, Real};
use dvp_tests::strategy::outline;
use proptest::prelude::*;

/// Descriptors of sum c_m e^(i m t) over signed frequencies m, c_m = amplitude e^(i angle).
fn from_spectrum(harmonic_count: usize, spectrum: &[(i32, f64, f64)]) -> Efd<f64> {
    let mut efd = Efd::zeros(harmonic_count);
    for &(m, amplitude, angle) in spectrum {
        let (im, re) = angle.sin_cos();
        let (re, im) = (amplitude * re, amplitude * im);
        let sign = f64::from(m.signum());
        // e^(i m t) = cos nt + i sign sin nt
        let row = &mut efd.rows_mut()[m.unsigned_abs() as usize - 1];
        for (value, part) in row.iter_mut().zip([re, -sign * im, im, sign * re]) {
            *value += part;
        }
    }
    efd
}

/// A k-fold outline with 24 harmonics: the base frequency 1 or -1, its neighbors on both sides k away, all in the pattern.
fn k_fold() -> impl Strategy<Value = (usize, i32, Efd<f64>)> {
    let parts = prop::collection::vec((0.03..0.2, 0.0..TAU), 6);
    (1_i32..9, prop::bool::ANY, parts, 0.0..TAU).prop_map(|(k, forward, parts, angle)| {
        let base = if forward { 1 } else { -1 };
        let mut spectrum = vec![(base, 1.0, angle)];
        let steps = [1, -1, 2, -2, 3, -3].map(|step| base + step * k);
        // Frequency 0 is the center, which the descriptors leave out.
        let parts = steps.into_iter().zip(parts).filter(|&(m, _)| m != 0 && m.abs() <= 24);
        spectrum.extend(parts.map(|(m, (amplitude, angle))| (m, amplitude, angle)));
        (k.unsigned_abs() as usize, base, from_spectrum(24, &spectrum))
    })
}

proptest! {
    #[test]
    fn a_k_fold_outline_has_order_k((k, _, efd) in k_fold(), scale in 0.01..100.0) {
        prop_assert_eq!(efd.symmetry(SYMMETRY_TOLERANCE), Symmetry::Finite(k));
        let mut scaled = efd;
        scaled.rotate_scale(1.0, scale);
        prop_assert_eq!(scaled.symmetry(SYMMETRY_TOLERANCE), Symmetry::Finite(k));
    }

    #[test]
    fn a_turn_by_the_order_maps_the_outline_on_itself((k, _, efd) in k_fold()) {
        // 840 edges divide by every k up to 8: the turned vertices are again vertices.
        let outline = outline(&efd, 841);
        let (sin, cos) = (TAU / f64::of_usize(k)).sin_cos();
        for &[x, y] in outline.iter().step_by(17) {
            let turned = [cos * x - sin * y, sin * x + cos * y];
            let nearest = outline.iter().map(|v| (v[0] - turned[0]).hypot(v[1] - turned[1])).fold(f64::INFINITY, f64::min);
            prop_assert!(nearest < 1e-12, "order {k}: {nearest} off");
        }
    }

    #[test]
    fn one_frequency_off_the_pattern_breaks_it((k, base, efd) in k_fold(), m in 2_i32..24, angle in 0.0..TAU) {
        let distance = (m - base).unsigned_abs() as usize;
        prop_assume!(!distance.is_multiple_of(k));
        let mut broken = efd.clone();
        let extra = from_spectrum(24, &[(m, 0.05, angle)]);
        broken.rows_mut().as_flattened_mut().iter_mut().zip(extra.rows().as_flattened()).for_each(|(a, b)| *a += b);
        let Symmetry::Finite(order) = broken.symmetry(SYMMETRY_TOLERANCE) else {
            return Err(TestCaseError::fail("a circle"));
        };
        prop_assert!(order < k && k.is_multiple_of(order) && distance.is_multiple_of(order), "{order} from {k} and {distance}");
        // Below the tolerance it does not count.
        let mut bent = efd;
        bent.rows_mut().as_flattened_mut().iter_mut().zip(extra.rows().as_flattened()).for_each(|(a, b)| *a += b / 10.0);
        prop_assert_eq!(bent.symmetry(SYMMETRY_TOLERANCE), Symmetry::Finite(k));
    }

    #[test]
    fn regular_polygons_and_circles(k in 3_usize..13, radius in 0.1..10.0, turn in 0.0..TAU, reverse in prop::bool::ANY) {
        let mut polygon: Vec<[f64; 2]> = (0..k)
            .map(|i| (turn + TAU * f64::of_usize(i) / f64::of_usize(k)).sin_cos())
            .map(|(sin, cos)| [radius * cos, radius * sin])
            .collect();
        if reverse {
            polygon.reverse();
        }
        let (efd, _) = Efd::from_contour(&polygon, 2 * k).unwrap();
        // The strongest frequencies after the first are 1 / (k - 1)^2 of it.
        prop_assert_eq!(efd.symmetry(0.005), Symmetry::Finite(k));
        prop_assert_eq!(efd.resized(1).symmetry(0.005), Symmetry::Continuous);
    }
}
