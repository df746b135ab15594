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
    assert!(!score.pictures.is_empty(), "{}", score.failures);
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
    rings: "rings and holes",
    touching: "touching",
    empty: "empty",
    cells: "cells",
    sprites: "sprites",
    gray: "gray",
    cropped_by_the_border: "cropped by the border",
    crowd_of_30: "crowd of 30",
    crowd_of_80: "crowd of 80",
    crowd_of_200: "crowd of 200",
    sixteen_bits: "flat, 16 bits",
    palette: "flat, palette",
    mds_hr: "MDS-HR",
    mds_hr_cropped: "MDS-HR cropped",
    mds_hr_bank: "MDS-HR, bank",
    twins: "twins",
    mds_hr_twins: "MDS-HR twins 0.15",
    mds_hr_close_twins: "MDS-HR twins 0.10",
    mds_hr_twins_bank: "MDS-HR twins 0.15, bank",
    mds_hr_close_twins_bank: "MDS-HR twins 0.10, bank",
    mds_hr_cropped_bank: "MDS-HR cropped, bank",
}

/// Cases that fall short of their thresholds, with the reason.
const SHORT: &[(&str, &str)] = &[
    ("occlusion", "what a front object cuts in two is found as two objects"),
    ("translucent", "one of five fails"),
    ("thin", "lines without a flat pixel are not found"),
    ("3 px", "objects without a flat pixel are not found"),
    ("coins", "rim and core of similar colors"),
    ("alpha", "a small object on a large one"),
    ("flat, blur 0.8 px", "softness is not estimated"),
    ("flat, blur 1.5 px", "softness is not estimated"),
    ("flat, noise 0.01", "noise hides flat regions"),
    ("flat, noise 0.03", "noise hides flat regions"),
    ("flat, noise 0.05", "noise hides flat regions"),
    ("flat, JPEG 50", "ringing is read as objects"),
    ("occlusion, noise 0.03", "noise hides flat regions"),
    ("occlusion, JPEG 50", "ringing is read as objects"),
    ("MDS-HR, noise 0.01", "noise hides flat regions"),
    ("MDS-HR, noise 0.03", "noise hides flat regions"),
    ("MDS-HR, noise 0.05", "noise hides flat regions"),
    ("MDS-HR, JPEG 50", "ringing is read as objects"),
    ("MDS-HR, noise 0.01, bank", "noise hides flat regions"),
    ("MDS-HR, noise 0.03, bank", "noise hides flat regions"),
    ("MDS-HR, noise 0.05, bank", "noise hides flat regions"),
    ("MDS-HR, JPEG 50, bank", "ringing is read as objects"),
];

#[test]
fn every_case_is_tested_or_known_to_fall_short() {
    let listed: Vec<&str> = HELD.iter().copied().chain(SHORT.iter().map(|(name, _)| *name)).collect();
    let names: BTreeSet<&str> = CASES.iter().map(|case| case.name).collect();
    assert_eq!(listed.iter().copied().collect::<BTreeSet<_>>(), names);
    assert_eq!(listed.len(), names.len(), "a case is listed twice");
}
