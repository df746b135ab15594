use alloc::vec;
use alloc::vec::Vec;

use proptest::prelude::*;

use super::{cut_loops, first_crossing};

#[test]
fn a_spur_at_a_corner_is_cut_off_where_it_crosses() {
    let mut square =
        vec![[0.0, 0.0], [4.0, 0.0], [8.0, 0.0], [8.0, 4.0], [8.0, 8.0], [4.0, 8.0], [0.0, 8.0], [0.0, 4.0]];
    let whole = square.clone();
    assert!(!cut_loops(&mut square));
    assert_eq!(square, whole, "nothing crosses");
    // Beyond the corner (8, 8) and back across the side that comes to it.
    square.splice(4..5, [[8.0, 10.0], [6.0, 10.0], [10.0, 7.0], [7.0, 7.0]]);
    // Wherever the ring begins.
    for first in 0..square.len() {
        let mut ring = square.clone();
        ring.rotate_left(first);
        assert!(cut_loops(&mut ring));
        assert_eq!(first_crossing(&ring), None);
        assert!(ring.iter().all(|&[_, y]| y <= 8.0), "from {first}: {ring:?}");
        let kept = whole.iter().filter(|corner| corner[0] + corner[1] < 16.0).all(|corner| ring.contains(corner));
        assert!(kept, "from {first}: {ring:?}");
    }
}

proptest! {
    #[test]
    fn nothing_crosses_afterwards(ring in prop::collection::vec([0.0_f64..9.0, 0.0_f64..9.0], 0..24)) {
        let mut cut = ring.clone();
        let did = cut_loops(&mut cut);
        prop_assert_eq!(first_crossing(&cut), None);
        prop_assert_eq!(did, first_crossing(&ring).is_some());
        prop_assert!(did || cut == ring);
    }

    #[test]
    fn stars_are_left_as_they_are(radii in prop::collection::vec(0.5_f64..9.0, 3..40)) {
        let step = core::f64::consts::TAU / radii.len() as f64;
        let star: Vec<[f64; 2]> =
            radii.iter().enumerate().map(|(i, r)| [r * (i as f64 * step).cos(), r * (i as f64 * step).sin()]).collect();
        let mut cut = star.clone();
        prop_assert!(!cut_loops(&mut cut));
        prop_assert_eq!(cut, star);
    }
}
