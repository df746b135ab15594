use super::{MaskOverlap, MetricError, Ownership, RandIndexScratch, Tally, adjusted_rand_index};

fn ari(a: &[u8], b: &[u8]) -> f64 {
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
