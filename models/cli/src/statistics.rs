//! Means and quantiles of the figures of many images.

use serde::Serialize;

/// The mean; none of no values.
#[must_use]
pub fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    (count > 0.0).then(|| sum / count)
}

/// The smallest value that at least `percent` percent of the sorted values do not exceed; 0 if there are none.
#[must_use]
pub fn quantile(sorted: &[f64], percent: usize) -> f64 {
    let rank = (sorted.len() * percent).div_ceil(100);
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or(0.0)
}

/// The median and the quartiles beside it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Quartiles {
    /// A quarter of the values is not above it.
    pub low: f64,
    /// Half of the values are not above it.
    pub median: f64,
    /// Three quarters of the values are not above it.
    pub high: f64,
}

impl Quartiles {
    /// Those of values in any order; zeros if there are none.
    #[must_use]
    pub fn of(mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        let [low, median, high] = [25, 50, 75].map(|percent| quantile(&values, percent));
        Self { low, median, high }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_of_four() {
        let quartiles = Quartiles::of(vec![4.0, 1.0, 3.0, 2.0]);
        assert_eq!(quartiles, Quartiles { low: 1.0, median: 2.0, high: 3.0 });
        assert_eq!(Quartiles::of(Vec::new()), Quartiles::default());
        assert_eq!((mean([1.0, 2.0].into_iter()), mean([].into_iter())), (Some(1.5), None));
    }
}
