//! Descriptors against pyefd (f64) and the reference system (f32).

use dvp_core::Efd;
use dvp_core::shape::{MDSHR_NAMES, OutlineBasis, mdshr_bank};
use dvp_tests::golden::{committed, shared};
use serde::Deserialize;

/// Two tables agree to `tolerance` in every number.
fn assert_close<const N: usize>(a: &[[f64; N]], b: &[[f64; N]], tolerance: f64, what: &str) {
    assert_eq!(a.len(), b.len(), "{what}: tables of different length");
    for (i, (a, b)) in a.as_flattened().iter().zip(b.as_flattened()).enumerate() {
        assert!((a - b).abs() <= tolerance, "{what}, number {i}: {a} against {b}");
    }
}

#[derive(Deserialize)]
struct Case {
    contour: Vec<[f64; 2]>,
    center: [f64; 2],
    raw: Vec<[f64; 4]>,
    normalized: Vec<[f64; 4]>,
    /// Scale, angle, phase.
    transformation: [f64; 3],
}

#[test]
fn pyefd_committed() {
    let cases: Vec<Case> = committed("efd.json").unwrap();
    assert_eq!(cases.len(), 3);
    for case in &cases {
        let (efd, center) = Efd::from_contour(&case.contour, case.raw.len()).unwrap();
        assert_close(efd.rows(), &case.raw, 1e-14, "raw");
        assert_close(&[center], &[case.center], 1e-14, "center");
        let normalized = efd.normalize().unwrap();
        assert_close(normalized.efd.rows(), &case.normalized, 1e-14, "normalized");
        let removed = [[normalized.scale, normalized.rotation, normalized.phase]];
        assert_close(&removed, &[case.transformation], 1e-14, "scale, rotation, phase");
    }
}

#[derive(Deserialize)]
struct SharedCase {
    /// Both numbers of a point were f32.
    contour: Vec<[f32; 2]>,
    efd_raw: Vec<[f64; 4]>,
    efd_normalized: Vec<[f64; 4]>,
    reconstruct_64_of_normalized: Vec<[f64; 2]>,
    reconstruct_128_of_raw: Vec<[f64; 2]>,
    pyefd160_raw: Vec<[f64; 4]>,
    pyefd160_normalized: Vec<[f64; 4]>,
}

#[test]
fn reference_shared() {
    let Some(cases) = shared::<Vec<SharedCase>>("fixtures/c_efd.json").unwrap() else { return };
    assert_eq!(cases.len(), 20);
    for case in &cases {
        let contour: Vec<[f64; 2]> = case.contour.iter().map(|point| point.map(f64::from)).collect();
        let (efd, _) = Efd::from_contour(&contour, 16).unwrap();
        assert_close(efd.rows(), &case.pyefd160_raw, 1e-12, "raw, pyefd");
        let normalized = efd.normalize().unwrap().efd;
        assert_close(normalized.rows(), &case.pyefd160_normalized, 1e-12, "normalized, pyefd");
        // The reference works in f32, and n x phase loses digits with n.
        assert_close(efd.rows(), &case.efd_raw, 1e-5, "raw, reference");
        assert_close(normalized.rows(), &case.efd_normalized, 1e-5, "normalized, reference");
        for (rows, expected) in
            [(&case.efd_normalized, &case.reconstruct_64_of_normalized), (&case.efd_raw, &case.reconstruct_128_of_raw)]
        {
            let mut outline = vec![[0.0; 2]; expected.len()];
            OutlineBasis::new(expected.len(), 16).unwrap().outline(rows, &mut outline).unwrap();
            assert_close(&outline, expected, 1e-5, "outline, reference");
        }
    }
}

#[derive(Deserialize)]
struct Tables {
    order: Vec<String>,
    heart: Vec<[f64; 4]>,
    square: Vec<[f64; 4]>,
    ellipse: Vec<[f64; 4]>,
}

#[test]
fn built_in_bank_shared() {
    let Some(tables) = shared::<Tables>("mdshr/efd_tables.json").unwrap() else { return };
    assert_eq!(tables.order, MDSHR_NAMES);
    let bank = mdshr_bank::<f64>(64);
    for (efd, expected) in bank.prototypes().iter().zip([tables.heart, tables.square, tables.ellipse]) {
        // Nine digits are kept.
        assert_close(efd.rows(), &expected, 1e-9, "prototype");
    }
}
