//! The paper's L_p: predicted objects are matched to the true ones, then compared parameter by parameter.

use super::scene_loss_vjp::scene_loss_vjp;
use super::scene_match::SceneLossScratch;
use super::{Loss, LossError, RotationTerm, SceneTerms, check_length};
use crate::matching::MatchingCost;
use crate::real::Real;
use crate::scene::{Scene, SceneGrad};
use crate::shape::{Efd, OutlineBasis, ShapeError};

/// Predicted scenes and the true ones, pair by pair.
#[derive(Clone, Copy, Debug)]
pub struct ScenePairs<'a, T> {
    predictions: &'a [Scene<T>],
    truths: &'a [Scene<T>],
}

impl<'a, T: Real> ScenePairs<'a, T> {
    /// Pairs scenes by position; of a true scene the objects with a confidence above 1/2 count.
    ///
    /// # Errors
    /// [`LossError::Length`] if the counts differ, [`LossError::Zero`] without a pair.
    pub fn new(predictions: &'a [Scene<T>], truths: &'a [Scene<T>]) -> Result<Self, LossError> {
        check_length("predicted scenes", predictions, truths.len())?;
        if truths.is_empty() { Err(LossError::Zero { what: "scene pairs" }) } else { Ok(Self { predictions, truths }) }
    }

    /// The judged scenes, the ones that gradients are for.
    #[must_use]
    pub fn predictions(&self) -> &'a [Scene<T>] {
        self.predictions
    }

    /// What they are judged by.
    #[must_use]
    pub fn truths(&self) -> &'a [Scene<T>] {
        self.truths
    }
}

/// L_p of a batch: the weighted sum of its [`SceneTerms`]. The matching is not differentiated: it is constant almost
/// everywhere.
///
/// *Source*: the paper's equation for L_p, with means over objects as in the reference implementation.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneLoss<T> {
    /// Weight of each term.
    pub weights: SceneTerms<T>,
    /// What predicted objects are matched by.
    pub matching: MatchingCost<T>,
    /// The form of the rotation term.
    pub rotation: RotationTerm,
    /// The count c for which a scene of n true objects weighs sqrt(n / c); every scene weighs 1 if there is none. A scene
    /// without a true object weighs 0 under such a rule.
    pub typical_count: Option<T>,
    pub(super) basis: OutlineBasis<T>,
}

impl<T: Real> SceneLoss<T> {
    /// The reference's settings for shapes of up to `harmonic_count` harmonics: weights 5 on translation and 0.05 on
    /// rotation, outlines compared at `vertex_count` points
    /// ([`REFERENCE_VERTICES`](crate::shape::REFERENCE_VERTICES)), typical count 2.5, and [`RotationTerm::Modulo`] (the
    /// reference's own form is [`RotationTerm::EveryOrder`]).
    ///
    /// # Errors
    /// As [`OutlineBasis::new`].
    pub fn reference(vertex_count: usize, harmonic_count: usize) -> Result<Self, ShapeError> {
        let one = T::one();
        Ok(Self {
            weights: SceneTerms {
                confidence: one,
                translation: T::of(5.0),
                scale: one,
                rotation: T::of(0.05),
                color: one,
                shape: one,
                background: one,
            },
            matching: MatchingCost::reference(),
            rotation: RotationTerm::default(),
            typical_count: Some(T::of(2.5)),
            basis: OutlineBasis::new(vertex_count, harmonic_count)?,
        })
    }

    /// The paper as printed, where that is a matter of settings: 0.01 on confidence in the matching, and
    /// [`RotationTerm::Printed`].
    ///
    /// # Errors
    /// As [`OutlineBasis::new`].
    pub fn printed(vertex_count: usize, harmonic_count: usize) -> Result<Self, ShapeError> {
        let reference = Self::reference(vertex_count, harmonic_count)?;
        Ok(Self { matching: MatchingCost::printed(), rotation: RotationTerm::Printed, ..reference })
    }

    /// The terms of the batch, weighted: their sum is the loss.
    ///
    /// # Errors
    /// As [`Loss::value`].
    pub fn terms(
        &self,
        pairs: ScenePairs<'_, T>,
        scratch: &mut SceneLossScratch<T>,
    ) -> Result<SceneTerms<T>, LossError> {
        scratch.match_all(&self.matching, pairs)?;
        let mut total = SceneTerms::default();
        for (pair, (prediction, truth)) in pairs.predictions.iter().zip(pairs.truths).enumerate() {
            let terms = self.pair_terms(prediction, truth, pair, scratch)?;
            if !terms.sum().is_finite() {
                return Err(LossError::NotFinite { pair });
            }
            total.add_scaled(&terms, self.pair_weight(scratch.of_pair(pair).len(), pairs));
        }
        Ok(total.weighted(&self.weights))
    }

    /// Share of a pair in the batch, by its number of true objects.
    pub(super) fn pair_weight(&self, objects: usize, pairs: ScenePairs<'_, T>) -> T {
        let weight = self.typical_count.map_or(T::one(), |count| (T::of_usize(objects) / count).sqrt());
        weight / T::of_usize(pairs.truths.len())
    }

    /// The terms of one pair, without weights.
    fn pair_terms(
        &self,
        prediction: &Scene<T>,
        truth: &Scene<T>,
        pair: usize,
        scratch: &mut SceneLossScratch<T>,
    ) -> Result<SceneTerms<T>, LossError> {
        let mut sums = SceneTerms::default();
        let range = scratch.of_pair(pair);
        let objects = range.len();
        for index in range.clone() {
            let found = scratch.matches()[index];
            let (object, other) = (&prediction.objects[found.prediction], &truth.objects[found.truth]);
            sums.translation += mean_square(object.pose.translation, other.pose.translation);
            sums.scale += mean_square([object.pose.scale], [other.pose.scale]);
            sums.rotation += self.rotation.price(&found, objects, &scratch.orders)[0];
            sums.color += mean_square(object.color(), other.color());
            self.outline_difference(object.shape.descriptors()?, other.shape.descriptors()?, scratch)?;
            let squares: T = scratch.vertices.iter().map(|&[x, y]| x * x + y * y).sum();
            sums.shape += squares / T::of_usize(2 * scratch.vertices.len());
        }
        let mut terms =
            SceneTerms { background: mean_square(prediction.background, truth.background), ..SceneTerms::default() };
        terms.add_scaled(&sums, T::of_usize(objects.max(1)).recip());
        let slots = T::of_usize(prediction.objects.len());
        for (slot, object) in prediction.objects.iter().enumerate() {
            let there = scratch.matches()[range.clone()].iter().any(|found| found.prediction == slot);
            terms.confidence += cross_entropy(object.confidence, there)? / slots;
        }
        Ok(terms)
    }

    /// Leaves the predicted outline minus the true one in `scratch.vertices`: outlines are linear in their descriptors.
    pub(super) fn outline_difference(
        &self,
        prediction: &Efd<T>,
        truth: &Efd<T>,
        scratch: &mut SceneLossScratch<T>,
    ) -> Result<(), LossError> {
        let rows = &mut scratch.rows;
        rows.clear();
        rows.resize(prediction.harmonic_count().max(truth.harmonic_count()), [T::zero(); 4]);
        for (row, values) in rows.iter_mut().zip(prediction.rows()) {
            *row = *values;
        }
        for (row, values) in rows.iter_mut().zip(truth.rows()) {
            row.iter_mut().zip(values).for_each(|(row, &value)| *row -= value);
        }
        scratch.vertices.resize(self.basis.vertex_count(), [T::zero(); 2]);
        Ok(self.basis.outline(rows, &mut scratch.vertices)?)
    }
}

impl<T: Real> Loss<T> for SceneLoss<T> {
    type Input<'a> = ScenePairs<'a, T>;
    /// One per predicted scene, in its layout ([`SceneGrad::reset`]).
    type Grad = [SceneGrad<T>];
    type Scratch = SceneLossScratch<T>;

    #[inline(never)]
    fn value(&self, pairs: ScenePairs<'_, T>, scratch: &mut SceneLossScratch<T>) -> Result<T, LossError> {
        Ok(self.terms(pairs, scratch)?.sum())
    }

    #[inline(never)]
    fn vjp(
        &self,
        pairs: ScenePairs<'_, T>,
        cotangent: T,
        scratch: &mut SceneLossScratch<T>,
        grad: &mut [SceneGrad<T>],
    ) -> Result<T, LossError> {
        check_length("scene gradients", grad, pairs.predictions.len())?;
        let value = self.value(pairs, scratch)?;
        scene_loss_vjp(self, pairs, cotangent, scratch, grad)?;
        Ok(value)
    }
}

fn mean_square<T: Real, const N: usize>(a: [T; N], b: [T; N]) -> T {
    a.iter().zip(&b).map(|(&a, &b)| (a - b) * (a - b)).sum::<T>() / T::of_usize(N)
}

/// -log of the probability given to the truth, at most 100 as in the reference's framework.
fn cross_entropy<T: Real>(confidence: T, there: bool) -> Result<T, LossError> {
    if !(T::zero() <= confidence && confidence <= T::one()) {
        return Err(LossError::OutOfRange { what: "confidence", value: confidence.as_f64(), must: "in [0, 1]" });
    }
    let log = if there { confidence.ln() } else { (-confidence).ln_1p() };
    Ok(-log.max(T::of(-100.0)))
}
