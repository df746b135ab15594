//! The picture set: pictures that resvg draws of our SVGs, and MDS-HR with noise, JPEG, twins and cropped objects, fitted and
//! scored by the command. A test per case; each prints its row of the table.
#![expect(clippy::unwrap_used, reason = "what fails here is a failed test")]

use std::collections::BTreeSet;

use dvp_tests::picture_set::{CASES, score_case, table_head};

/// Fits and scores one case and asserts its thresholds.
fn check(name: &str) {
    let case = CASES.iter().find(|case| case.name == name).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let score = score_case(case, folder.path()).unwrap();
    eprintln!("{}", score.row());
    assert!(!score.pictures.is_empty() || !score.failures.is_empty(), "no pictures");
    assert!(score.holds(), "{}\n{}\n{}", table_head(), score.row(), score.worst());
}

macro_rules! cases {
    ($list:ident: $($test:ident: $name:literal,)*) => {
        /// Cases with a test.
        const $list: &[&str] = &[$($name),*];
        $(#[test] fn $test() { check($name); })*
    };
}

cases! { HELD:
    flat: "flat",
    empty: "empty",
}

/// Cases that fall short of their thresholds, with the reason.
const SHORT: &[(&str, &str)] = &[];

#[test]
fn every_case_is_tested_or_known_to_fall_short() {
    let listed: Vec<&str> = HELD.iter().copied().chain(SHORT.iter().map(|(name, _)| *name)).collect();
    let names: BTreeSet<&str> = CASES.iter().map(|case| case.name).collect();
    assert_eq!(listed.iter().copied().collect::<BTreeSet<_>>(), names);
    assert_eq!(listed.len(), names.len(), "a case is listed twice");
}
