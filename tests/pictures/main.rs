//! The picture set: pictures that resvg draws of our SVGs, and MDS-HR with noise, JPEG, twins and cropped objects, fitted and
//! scored by the command. A test per case; each prints its row of the table. Cases that are known to fall short are run too: one
//! that got worse fails, and one that now holds fails until it is off their list.
#![expect(clippy::unwrap_used, reason = "what fails here is a failed test")]

extern crate alloc;

use alloc::collections::BTreeSet;

use dvp_tests::picture_set::{ARI_TOLERANCE, CASES, CaseScore, PictureScore, Shortfall, score_case, table_head};

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
    touching: "touching",
    empty: "empty",
    cells: "cells",
    coins: "coins",
    cropped_by_the_border: "cropped by the border",
    crowd_of_30: "crowd of 30",
    crowd_of_200: "crowd of 200",
    flat_16_bits: "flat, 16 bits",
    flat_palette: "flat, palette",
    flat_blur_15: "flat, blur 1.5 px",
    flat_noise_001: "flat, noise 0.01",
    flat_noise_003: "flat, noise 0.03",
    flat_noise_005: "flat, noise 0.05",
    mds_hr_noise_001: "MDS-HR, noise 0.01",
    mds_hr_noise_003: "MDS-HR, noise 0.03",
    mds_hr_noise_005: "MDS-HR, noise 0.05",
    mds_hr_bank: "MDS-HR, bank",
    mds_hr_noise_001_bank: "MDS-HR, noise 0.01, bank",
    mds_hr_noise_003_bank: "MDS-HR, noise 0.03, bank",
    mds_hr_noise_005_bank: "MDS-HR, noise 0.05, bank",
    mds_hr_jpeg_50_bank: "MDS-HR, JPEG 50, bank",
    mds_hr_twins_015_bank: "MDS-HR twins 0.15, bank",
    mds_hr_twins_010_bank: "MDS-HR twins 0.10, bank",
    mds_hr_twins_010: "MDS-HR twins 0.10",
    mds_hr_twins_015: "MDS-HR twins 0.15",
    mds_hr_cropped_bank: "MDS-HR cropped, bank",
    crowd_of_80: "crowd of 80",
    thin: "thin",
    three_px: "3 px",
    mds_hr: "MDS-HR",
    mds_hr_cropped: "MDS-HR cropped",
    mds_hr_jpeg_50: "MDS-HR, JPEG 50",
    flat_jpeg_50: "flat, JPEG 50",
    occlusion_noise_003: "occlusion, noise 0.03",
    occlusion: "occlusion",
    gray: "gray",
    sprites: "sprites",
    alpha: "alpha",
}

/// A known failure is run as well: it must be as good as recorded, and must not hold.
fn check_short(shortfall: &Shortfall) {
    let case = CASES.iter().find(|case| case.name == shortfall.name).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let score = score_case(case, folder.path()).unwrap();
    eprintln!("{} (known failure: {})", score.row(), shortfall.reason);
    shortfall.check(&score).unwrap();
}

macro_rules! known_failures {
    ($list:ident: $($test:ident: $name:literal, ari $ari:literal, right $right:literal, $reason:literal;)*) => {
        /// Cases that fall short of their thresholds, with what they reach and the reason.
        const $list: &[Shortfall] = &[$(Shortfall { name: $name, ari: $ari, right: $right, reason: $reason }),*];
        $(#[test] fn $test() { check_short($list.iter().find(|short| short.name == $name).unwrap()); })*
    };
}

known_failures! { SHORT:
    twins: "twins", ari 0.8753, right 0, "two crossed bars are one outline";
    flat_blur_08: "flat, blur 0.8 px", ari 0.9919, right 12, "two objects of one color side by side are read as one";
    // It passes with zones of .05 of the noise in place of `COMPRESSED_ZONE`, at the price of 26 of 160 scenes in JPEGs.
    occlusion_scaled_down: "occlusion, scaled down", ari 0.9984, right 13,
        "rims along edges are read as objects, or hide some";
    // Of 2026-11-28 it was 7, at an ARI of .9741; before and since 8, at one of .9707.
    occlusion_jpeg_50: "occlusion, JPEG 50", ari 0.9707, right 8, "ringing is read as objects, or hides them";
    flat_scaled_down: "flat, scaled down", ari 0.9971, right 12,
        "rims of upright scaled edges are read as faces in one picture";
    rings_and_holes: "rings and holes", ari 0.7830, right 0,
        "a hole is no thing here, where it is painted over in the truth";
    translucent: "translucent", ari 0.9570, right 1,
        "what two colors make where they overlap is read as a thing";
}

/// A score of ten pictures of "thin" of this ARI, so many of them counted right.
fn made_up(ari: f64, right: usize) -> CaseScore {
    let case = *CASES.iter().find(|case| case.name == "thin").unwrap();
    let picture = |i| PictureScore {
        stem: format!("{i}"),
        mae: 0.0,
        iou: 1.0,
        ari,
        objects: 3,
        found: if i < right { 3 } else { 2 },
        ms: 1.0,
    };
    CaseScore { case, pictures: (0..10).map(picture).collect(), failures: String::new() }
}

#[test]
fn a_known_failure_that_got_worse_or_holds_fails() {
    let short = Shortfall { name: "thin", ari: 0.99, right: 8, reason: "made up" };
    short.check(&made_up(0.99, 8)).unwrap();
    short.check(&made_up(0.99 - 0.9 * ARI_TOLERANCE, 9)).unwrap();
    let complaint = |score| short.check(&score).unwrap_err();
    assert!(complaint(made_up(0.99 - 1.1 * ARI_TOLERANCE, 8)).contains("got worse"));
    assert!(complaint(made_up(0.99, 7)).contains("got worse"));
    assert!(complaint(made_up(f64::NAN, 8)).contains("got worse"));
    assert!(complaint(CaseScore { failures: "no.png: refused".into(), ..made_up(0.99, 10) }).contains("got worse"));
    assert!(complaint(made_up(0.99, 10)).contains("now passes: take it off the list"));
}

#[test]
fn every_case_is_tested_or_known_to_fall_short() {
    let listed: Vec<&str> = HELD.iter().copied().chain(SHORT.iter().map(|short| short.name)).collect();
    let names: BTreeSet<&str> = CASES.iter().map(|case| case.name).collect();
    assert_eq!(listed.iter().copied().collect::<BTreeSet<_>>(), names);
    assert_eq!(listed.len(), names.len(), "a case is listed twice");
}
