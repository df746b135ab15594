//! The median, which outvotes what does not belong.

use dvp_core::Real;

/// The median of a key of `values`, the higher of the two in the middle; none of nothing. Changes their order.
pub(crate) fn median_by<V, T: Real>(values: &mut [V], key: impl Fn(&V) -> T) -> Option<T> {
    let middle = values.len() / 2;
    if values.is_empty() {
        return None;
    }
    let order = |a: &V, b: &V| key(a).partial_cmp(&key(b)).unwrap_or(core::cmp::Ordering::Equal);
    Some(key(values.select_nth_unstable_by(middle, order).1))
}
