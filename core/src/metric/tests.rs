use alloc::string::ToString;
use alloc::vec::Vec;
use core::error::Error;

use super::{MaskOverlap, MetricError, Ownership, OwnershipRule, RandIndexScratch, Tally, adjusted_rand_index};
use crate::image::ImageError;
use crate::loss::LossError;
use crate::render::hard::{HardMask, HardScratch};
use crate::render::{Compositing, RenderError, TileRenderer};
use crate::{Drawing, ImageSize};

fn ari(a: &[u32], b: &[u32]) -> f64 {
    adjusted_rand_index(a, b, &mut RandIndexScratch::default()).unwrap()
}

#[test]
fn ownership_follows_coverage_and_confidence() {
    // Three objects over four pixels; the third is not confident enough (1/2 rounds to 0).
    let coverage = [
        [0.9, 0.1, 0.0, 0.0], //
        [0.0, 1e-30, 0.5, 0.0],
        [1.0, 1.0, 1.0, 1.0],
    ];
    let mut owned = Ownership::default();
    owned.fill(4, coverage.as_flattened(), &[1.0, 0.6, 0.5]).unwrap();
    assert_eq!(owned.index(), [1, 0, 2, 0]);
    assert!(owned.union().eq([true, true, true, false]));
    let outcome = owned.fill(4, &[0.0; 7], &[1.0, 1.0]);
    assert_eq!(outcome, Err(MetricError::Length { what: "coverage", expected: 8, len: 7 }));
}

#[test]
fn three_owners_are_still_shared() {
    let mut owned = Ownership::default();
    owned.fill(1, &[1.0; 3], &[1.0; 3]).unwrap();
    assert_eq!(owned.index(), [0]);
}

/// Two unit squares of pixels side by side, a faint one over both, and one below all that the second hides.
fn squares(compositing: Compositing, rule: OwnershipRule) -> Ownership {
    let square = |left: f32| [[left, 0.0], [left + 1.0, 0.0], [left + 1.0, 1.0], [left, 1.0]];
    let mut drawing = Drawing::default();
    for (left, confidence) in [(1.0, 1.0), (0.0, 1.0), (1.0, 0.4), (2.0, 0.005)] {
        drawing.push(&square(left), [1.0; 3], confidence);
    }
    let renderer = TileRenderer { coverage: HardMask, compositing };
    let mut owned = Ownership::default();
    let size = ImageSize::new(4, 1).unwrap();
    owned.fill_drawing(rule, &renderer, &drawing, size, &mut HardScratch::default()).unwrap();
    owned
}

#[test]
fn the_topmost_object_owns_what_is_seen() {
    // The third object hides the first; the fourth is too faint to be seen.
    let owned = squares(Compositing::Over, OwnershipRule::Seen(Compositing::Over));
    assert_eq!((owned.index(), owned.objects()), (&[2, 3, 0, 0][..], 2));
    // Mixed, both are there, and their pixel is nobody's.
    let owned = squares(Compositing::Blend, OwnershipRule::Seen(Compositing::Blend));
    assert_eq!((owned.index(), owned.objects()), (&[2, 0, 0, 0][..], 3));
    assert!(owned.union().eq([true, true, false, false]));
    // By the reference's rule the confidence decides.
    let owned = squares(Compositing::Over, OwnershipRule::Reached);
    assert_eq!((owned.index(), owned.objects()), (&[2, 1, 0, 0][..], 2));
}

#[test]
fn label_maps_own_what_they_name() {
    let mut owned = Ownership::default();
    owned.fill_labels(&[0, 70_000, 3, 3, 0, 70_000]);
    assert_eq!((owned.index(), owned.objects()), (&[0, 70_000, 3, 3, 0, 70_000][..], 2));
    assert!(owned.union().eq([false, true, true, true, false, true]));
}

#[test]
fn rand_index_of_more_pairs_than_are_kept_at_first() {
    // 9 000 pixels alternate between 6 000 pairs of labels: the list is merged on the way.
    let a: Vec<u32> = (0..9000).map(|i| i % 6000).collect();
    assert!((ari(&a, &a) - 1.0).abs() < 1e-12);
    // Joining labels by twos: 3 000 pairs of pixels together in a; in b 1 500 groups of 4 and 1 500 of 2.
    let b: Vec<u32> = a.iter().map(|label| label / 2).collect();
    let (in_a, in_b, all) = (3000.0, 1500.0 * 6.0 + 1500.0, 9000.0 * 8999.0 / 2.0);
    let expected = in_a * in_b / all;
    assert!((ari(&a, &b) - (in_a - expected) / (f64::midpoint(in_a, in_b) - expected)).abs() < 1e-12);
}

#[test]
fn overlap_is_pooled() {
    // 1 of 2 pixels, then 3 of 3: 4/5, not the mean of 1/2 and 1.
    let mut overlap = MaskOverlap::default();
    overlap.add([true, true, false], [true, false, false]);
    overlap.add([true; 3], [true; 3]);
    assert!((overlap.iou() - 0.8).abs() < 1e-15);
    assert!((MaskOverlap::default().iou() - 1.0).abs() < 1e-15);
}

#[test]
fn rand_index_of_a_small_table() {
    // Labels (0,0,1,1) and (0,0,1,2): pairs together 1, in a 2, in b 1, all 6; expected 1/3, most 3/2:
    // (1 - 1/3) / (3/2 - 1/3) = 4/7.
    assert!((ari(&[0, 0, 1, 1], &[0, 0, 1, 2]) - 4.0 / 7.0).abs() < 1e-15);
    assert!((ari(&[0, 0, 1, 1], &[7, 7, 3, 3]) - 1.0).abs() < 1e-15);
}

#[test]
fn rand_index_without_contrast() {
    assert!((ari(&[0, 0, 0], &[5, 5, 5]) - 1.0).abs() < 1e-15);
    assert!((ari(&[], &[]) - 1.0).abs() < 1e-15);
    // One side a single segment, the other not: no better than chance.
    assert!(ari(&[0, 0, 0, 0], &[0, 0, 1, 1]).abs() < 1e-15);
    assert!(adjusted_rand_index(&[0], &[0, 1], &mut RandIndexScratch::default()).is_err());
}

#[test]
fn a_tally_of_nothing_has_no_scores() {
    assert_eq!(Tally::<f32>::default().scores(), None);
}

#[test]
fn errors_hand_on_what_caused_them() {
    let image = LossError::from(ImageError::NotFinite { index: 3 });
    let metric = MetricError::from(image);
    assert_eq!(metric.source().map(ToString::to_string), Some(image.to_string()));
    let cause = ImageError::NotFinite { index: 3 };
    assert_eq!(image.source().map(ToString::to_string), Some(cause.to_string()));
    assert_eq!(
        MetricError::from(RenderError::Starts).source().map(ToString::to_string),
        Some(RenderError::Starts.to_string())
    );
    assert!(MetricError::Length { what: "coverage", expected: 8, len: 7 }.source().is_none());
}
