//! The paper's cost of taking one object for another.

use alloc::vec::Vec;

use crate::real::Real;
use crate::scene::Object;

/// Weights of the distances that the matching looks at: translation, color, confidence.
///
/// *Source*: the paper's equation for C(p_i, p_j); norms are Euclidean.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct MatchingCost<T> {
    /// Per scene unit.
    pub translation: T,
    /// Per unit of RGB distance.
    pub color: T,
    /// Per unit of confidence.
    pub confidence: T,
}

impl<T: Real> MatchingCost<T> {
    /// The reference implementation's weights: 1, 0.1, 0.05.
    #[must_use]
    pub fn reference() -> Self {
        Self { translation: T::one(), color: T::of(0.1), confidence: T::of(0.05) }
    }

    /// The printed weights: 1, 0.1, 0.01.
    #[must_use]
    pub fn printed() -> Self {
        Self { confidence: T::of(0.01), ..Self::reference() }
    }

    /// The cost of taking `b` for `a`; symmetric.
    #[must_use]
    pub fn between(&self, a: &Object<T>, b: &Object<T>) -> T {
        let [x, y] = [0, 1].map(|i| a.pose.translation[i] - b.pose.translation[i]);
        let (a_rgb, b_rgb) = (a.color(), b.color());
        let rgb = [0, 1, 2].map(|i| a_rgb[i] - b_rgb[i]);
        let color = rgb.iter().map(|&v| v * v).sum::<T>().sqrt();
        self.translation * (x * x + y * y).sqrt()
            + self.color * color
            + self.confidence * (a.confidence - b.confidence).abs()
    }

    /// Writes the costs of all pairs, a row per object of `rows`, a column per object of `columns`; keeps the memory of
    /// `costs`.
    pub fn fill<'a>(&self, rows: impl IntoIterator<Item = &'a Object<T>>, columns: &[Object<T>], costs: &mut Vec<T>) {
        costs.clear();
        costs.extend(rows.into_iter().flat_map(|a| columns.iter().map(move |b| self.between(a, b))));
    }
}
