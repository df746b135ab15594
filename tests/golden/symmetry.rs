//! Symmetry orders against the reference system, whose rule sees 1, 2, 3 or 4 here.
//!
//! `symmetry.json` is an excerpt of its answers: named shapes and two random tables, five harmonics each.

use alloc::collections::BTreeMap;

use dvp_core::Efd;
use dvp_core::shape::{REFERENCE_SYMMETRY_HARMONICS, REFERENCE_SYMMETRY_THRESHOLD, SYMMETRY_TOLERANCE, Symmetry};
use dvp_tests::golden::{committed, shared};
use serde::Deserialize;

#[derive(Deserialize)]
struct Case {
    name: String,
    rows: Vec<[f64; 4]>,
    order: usize,
}

#[test]
fn reference_committed() {
    let cases: Vec<Case> = committed("symmetry.json").unwrap();
    assert_eq!(cases.len(), 9);
    for case in cases {
        let efd = Efd::new(case.rows);
        let order = efd.reference_symmetry_order(REFERENCE_SYMMETRY_HARMONICS, REFERENCE_SYMMETRY_THRESHOLD);
        assert_eq!(order, case.order, "{}", case.name);
        if !case.name.starts_with("random") {
            assert_eq!(efd.symmetry(SYMMETRY_TOLERANCE), Symmetry::Finite(case.order), "exact rule, {}", case.name);
        }
    }
}

#[derive(Deserialize)]
struct Shared {
    named: BTreeMap<String, Named>,
    random: Random,
    threshold: f64,
}

#[derive(Deserialize)]
struct Named {
    efd: Vec<[f64; 4]>,
    sym_first5: usize,
    sym_first16: Option<usize>,
    sym_all64: Option<usize>,
}

#[derive(Deserialize)]
struct Random {
    efd: Vec<Vec<[f64; 4]>>,
    sym_first5: Vec<usize>,
    sym_all16: Vec<usize>,
}

#[test]
fn reference_shared() {
    let Some(Shared { named, random, threshold }) = shared("fixtures/b_symmetry.json").unwrap() else { return };
    assert_eq!((named.len(), random.efd.len()), (7, 200));
    for (name, Named { efd, sym_first5, sym_first16, sym_all64 }) in named {
        let efd = Efd::new(efd);
        for (count, expected) in [(5, Some(sym_first5)), (16, sym_first16), (64, sym_all64)] {
            let order = efd.reference_symmetry_order(count, threshold);
            assert_eq!(order, expected.unwrap_or(order), "{name}, {count} harmonics");
        }
    }
    for (i, efd) in random.efd.into_iter().enumerate() {
        let efd = Efd::new(efd);
        assert_eq!(efd.reference_symmetry_order(5, threshold), random.sym_first5[i], "random {i}");
        assert_eq!(efd.reference_symmetry_order(16, threshold), random.sym_all16[i], "random {i}");
    }
}
