//! The sort that all types share.

use dvp_core::sort::{ascending, descending};
use proptest::prelude::*;

proptest! {
    #[test]
    fn it_sorts_as_the_stable_sort_of_the_standard_library(keys in prop::collection::vec(-4_i8..4, 0..40)) {
        let numbered: Vec<(i8, usize)> = keys.into_iter().zip(0..).collect();
        let (mut up, mut down) = (numbered.clone(), numbered.clone());
        ascending(&mut up, |item| f64::from(item.0));
        descending(&mut down, |item| f64::from(item.0));
        let (mut expected_up, mut expected_down) = (numbered.clone(), numbered);
        expected_up.sort_by_key(|item| item.0);
        expected_down.sort_by_key(|item| core::cmp::Reverse(item.0));
        prop_assert_eq!(up, expected_up);
        prop_assert_eq!(down, expected_down);
    }
}
