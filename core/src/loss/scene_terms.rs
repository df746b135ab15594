//! The terms of L_p, by parameter.

use crate::real::Real;

/// A number per term of L_p: its value, or its weight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct SceneTerms<T> {
    /// Mean binary cross entropy of the confidences of all slots; 1 is right for the matched ones, 0 for the others.
    pub confidence: T,
    /// Mean squared difference of the translations' components.
    pub translation: T,
    /// Mean squared difference of the scales.
    pub scale: T,
    /// Mean price of the turns, see [`RotationTerm`](super::RotationTerm).
    pub rotation: T,
    /// Mean squared difference of the colors' channels.
    pub color: T,
    /// Mean squared difference of the coordinates of the unit outlines' vertices.
    pub shape: T,
    /// Mean squared difference of the backgrounds' channels.
    pub background: T,
}

impl<T: Real> SceneTerms<T> {
    /// The sum of all terms.
    #[must_use]
    pub fn sum(&self) -> T {
        self.confidence + self.translation + self.scale + self.rotation + self.color + self.shape + self.background
    }

    /// Adds `factor` times `other`.
    pub(super) fn add_scaled(&mut self, other: &Self, factor: T) {
        self.confidence += other.confidence * factor;
        self.translation += other.translation * factor;
        self.scale += other.scale * factor;
        self.rotation += other.rotation * factor;
        self.color += other.color * factor;
        self.shape += other.shape * factor;
        self.background += other.background * factor;
    }

    /// Term by term, times the weights.
    pub(super) fn weighted(&self, weights: &Self) -> Self {
        Self {
            confidence: self.confidence * weights.confidence,
            translation: self.translation * weights.translation,
            scale: self.scale * weights.scale,
            rotation: self.rotation * weights.rotation,
            color: self.color * weights.color,
            shape: self.shape * weights.shape,
            background: self.background * weights.background,
        }
    }
}
