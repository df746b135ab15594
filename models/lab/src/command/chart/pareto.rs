//! The Pareto front: what nothing else beats in both time and error.

/// Indices of the points (time, error) that no other point dominates, by time. A point dominates another if it is no worse
/// in both and better in one; of equal points the first stands for all. Points that are no numbers are on no front.
pub(super) fn front(points: &[(f64, f64)]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|&k| !points[k].0.is_nan() && !points[k].1.is_nan()).collect();
    order.sort_by(|&a, &b| points[a].0.total_cmp(&points[b].0).then(points[a].1.total_cmp(&points[b].1)));
    let mut best = f64::INFINITY;
    order.retain(|&k| {
        let improves = points[k].1 < best;
        best = best.min(points[k].1);
        improves
    });
    order
}

/// The least error that can be had within `time`: the index of its point on the front.
pub(super) fn within(points: &[(f64, f64)], front: &[usize], time: f64) -> Option<usize> {
    front.iter().copied().take_while(|&k| points[k].0 <= time).last()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn dominates(a: (f64, f64), b: (f64, f64)) -> bool {
        a.0 <= b.0 && a.1 <= b.1 && (a.0 < b.0 || a.1 < b.1)
    }

    proptest! {
        #[test]
        fn no_point_of_the_front_is_dominated_and_every_other_one_is(
            // Small whole numbers: ties are common.
            points in proptest::collection::vec((0_u8..12, 0_u8..12), 0..40)
        ) {
            let points: Vec<(f64, f64)> = points.into_iter().map(|(x, y)| (x.into(), y.into())).collect();
            let front = front(&points);
            prop_assert_eq!(front.is_empty(), points.is_empty());
            prop_assert!(front.windows(2).all(|pair| points[pair[0]].0 < points[pair[1]].0));
            for (k, &point) in points.iter().enumerate() {
                let dominated = points.iter().any(|&other| dominates(other, point));
                let stands = front.iter().any(|&f| points[f] == point);
                prop_assert_eq!(stands, !dominated, "{}", k);
            }
            for time in 0..12 {
                let time = f64::from(time);
                let least = points.iter().filter(|point| point.0 <= time).map(|point| point.1).reduce(f64::min);
                prop_assert_eq!(within(&points, &front, time).map(|k| points[k].1), least);
            }
        }
    }

    #[test]
    fn what_is_no_number_is_on_no_front() {
        assert_eq!(front(&[(f64::NAN, 0.0), (1.0, f64::NAN), (2.0, 3.0)]), [2]);
    }
}
