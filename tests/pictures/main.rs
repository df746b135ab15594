//! The picture set: pictures that resvg draws of our SVGs, and MDS-HR with noise, JPEG, twins and cropped objects, fitted and
//! scored by the command. A test per case; each prints its row of the table.
#![expect(clippy::unwrap_used, reason = "what fails here is a failed test")]

extern crate alloc;

use alloc::collections::BTreeSet;

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
    occlusion: "occlusion",
    translucent: "translucent",
    rings_and_holes: "rings and holes",
    touching: "touching",
    empty: "empty",
    cells: "cells",
    coins: "coins",
    sprites: "sprites",
    gray: "gray",
    alpha: "alpha",
    cropped_by_the_border: "cropped by the border",
    crowd_of_30: "crowd of 30",
    crowd_of_200: "crowd of 200",
    flat_16_bits: "flat, 16 bits",
    flat_palette: "flat, palette",
    flat_noise_001: "flat, noise 0.01",
    flat_noise_003: "flat, noise 0.03",
    flat_noise_005: "flat, noise 0.05",
    flat_jpeg_50: "flat, JPEG 50",
    mds_hr: "MDS-HR",
    mds_hr_noise_001: "MDS-HR, noise 0.01",
    mds_hr_noise_003: "MDS-HR, noise 0.03",
    mds_hr_noise_005: "MDS-HR, noise 0.05",
    mds_hr_jpeg_50: "MDS-HR, JPEG 50",
    mds_hr_cropped: "MDS-HR cropped",
    mds_hr_bank: "MDS-HR, bank",
    mds_hr_noise_001_bank: "MDS-HR, noise 0.01, bank",
    mds_hr_noise_003_bank: "MDS-HR, noise 0.03, bank",
    mds_hr_noise_005_bank: "MDS-HR, noise 0.05, bank",
    mds_hr_jpeg_50_bank: "MDS-HR, JPEG 50, bank",
    mds_hr_twins_015_bank: "MDS-HR twins 0.15, bank",
    mds_hr_twins_010_bank: "MDS-HR twins 0.10, bank",
    mds_hr_cropped_bank: "MDS-HR cropped, bank",
}

/// Cases that fall short of their thresholds, with the reason.
const SHORT: &[(&str, &str)] = &[
    ("crowd of 80", "one object of 80 is not found in one of two pictures"),
    ("flat, scaled down", "rims along edges are read as objects, or hide some"),
    ("thin", "a stroke in two pieces, short ticks as ellipses"),
    ("3 px", "one dot in five is not found"),
    ("twins", "two crossed bars are one outline"),
    ("occlusion, scaled down", "rims along edges are read as objects, or hide some"),
    ("flat, blur 0.8 px", "two objects of one color side by side are read as one"),
    ("flat, blur 1.5 px", "corners that the blur rounds"),
    ("occlusion, noise 0.03", "pieces of edges are read as objects"),
    ("occlusion, JPEG 50", "ringing is read as objects, or hides them"),
    ("MDS-HR twins 0.15", "two hearts that overlap are one outline where nobody has told of hearts"),
    ("MDS-HR twins 0.10", "two hearts that overlap are one outline where nobody has told of hearts"),
];

#[test]
fn every_case_is_tested_or_known_to_fall_short() {
    let listed: Vec<&str> = HELD.iter().copied().chain(SHORT.iter().map(|(name, _)| *name)).collect();
    let names: BTreeSet<&str> = CASES.iter().map(|case| case.name).collect();
    assert_eq!(listed.iter().copied().collect::<BTreeSet<_>>(), names);
    assert_eq!(listed.len(), names.len(), "a case is listed twice");
}
