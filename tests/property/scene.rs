//! Invariants of poses and drawings.

#![expect(clippy::float_cmp, reason = "the same arithmetic gives the same bits")]

use dvp_core::Real;
use dvp_tests::strategy;
use proptest::prelude::*;

proptest! {
    #[test]
    fn the_inverse_pose_undoes_the_pose(pose in strategy::pose(), point in prop::array::uniform2(-1.0..1.0)) {
        let there = pose.transform_point(f64::vec2(point[0], point[1]));
        let back = f64::xy(pose.inverse().unwrap().transform_point(there));
        prop_assert!((back[0] - point[0]).abs() < 1e-12 && (back[1] - point[1]).abs() < 1e-12, "{back:?}");
    }

    #[test]
    fn points_and_slices_move_alike(pose in strategy::pose(), point in prop::array::uniform2(-1.0..1.0)) {
        let mut outline = [point];
        pose.transform(&mut outline);
        prop_assert_eq!(outline[0], f64::xy(pose.transform_point(f64::vec2(point[0], point[1]))));
    }
}
