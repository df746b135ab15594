//! From one image to its scene by optimisation.
//!
//! ```text
//! image -> segment -> pose | free -> joint refinement -> scene, with its doubt
//! ```
//!
//! | module | comes in | goes out |
//! |---|---|---|
//! | `segment` | an image | objects as colors and distance samples along their outlines |
//! | `pose` | samples, a bank | prototype and pose |
//! | `split` | samples of a segment that no single shape explains | several shapes of one color and their poses |
//! | `free` | samples, no bank | elliptic Fourier descriptors, as few as the samples support |
//! | `fitter` | all of it | a [`Fit`] |
//! | [`picture`] | a picture of any kind | a [`Fit`]: as a drawing (`dvp-trace`) or as segments |
//! | [`paint`] | a scene | its image |
//! | [`prototypes`] | fits without a bank | the few shapes they share, a [`Bank`] |
//! | [`masks`] | a label map of another program | an outline per label |
//! | [`refine`] | an image, a start | a [`Fit`] by Levenberg-Marquardt |
//! | [`scene_refine`] | an image, a drawing near it | the drawing with every number refined |
//! | [`opt_p`], [`opt_iter`], [`rand_opt_p`] | an image, for OptP and Rand-OptP a start | a [`Fit`] by the paper's Adam |
//! | [`live`] | an image | a [`Fit`] of closed paths, layer by layer |
//!
//! `tuning` holds the numbers of the first five that were chosen.
//!
//! # Features
//!
//! `std` (default) brings the platform's maths and the faster kernels of `dvp-core`; without it everything works with `alloc`.
#![no_std]

extern crate alloc;

/// The example of the README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}

pub mod adam;
pub mod live;
pub mod masks;
pub mod opt_iter;
pub mod opt_p;
pub mod paint;
pub mod parameters;
pub mod picture;
pub mod prototypes;
pub mod rand_opt_p;
pub mod refine;
pub mod scene_refine;

mod block_code;
mod cholesky;
mod colors;
mod covariance;
mod doubt;
mod fitter;
mod free;
#[doc(hidden)]
pub mod instances;
mod joint;
mod marginal_gain;
mod options;
mod pose;
mod price;
mod residual;
mod segment;
mod split;
mod split_mix;
mod stretched;
#[cfg(test)]
mod tests;
mod tuning;
mod verdict;

use alloc::vec::Vec;

use dvp_core::{Drawing, ImageView, Real, Scene};

/// Noise of pictures, and pictures without it.
pub use dvp_trace::noise;

pub use fitter::{FitScratch, Fitter, fit_image};
pub use options::{Bank, FitError, FitOptions};
pub use price::{Prices, scene_bits};
pub use residual::Unexplained;
pub use verdict::Doubts;

/// Why a fit stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum StopReason {
    /// The step or the gain fell below the tolerance.
    Converged,
    /// The number of steps was used up.
    StepLimit,
    /// No damping made the loss fall.
    Stalled,
    /// Nothing to fit: the image is one flat color.
    Empty,
    /// The picture is not flat (a gradient, a texture, a photo): the scene is the best one of flat colors that was found,
    /// and [`Fit::unexplained`] tells how much it leaves.
    NotFlat,
    /// No scene was found that is nearer to the picture than one flat color: the scene is that color, without an object.
    NoBetterThanFlat,
}

/// What a fit cannot tell.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Ambiguity {
    /// The angle of the object is known modulo 2 pi / order (order 0: not at all, a disk).
    Symmetry {
        /// Index of the object.
        object: usize,
        /// Symmetry order; 0 for a disk.
        order: usize,
    },
    /// The object leaves the image; the share of its outline that is visible.
    Cropped {
        /// Index of the object.
        object: usize,
        /// Visible share of the outline, [0, 1].
        visible: f64,
    },
    /// A part of the object lies behind others that are painted later: what of its outline is there is a guess.
    Hidden {
        /// Index of the object.
        object: usize,
        /// Share of the length of its outline that is hidden, (0, 1].
        share: f64,
        /// Where the guess comes from.
        completion: Completion,
    },
    /// The object has run together with another one of its color: what of its outline does not show is a guess.
    Merged {
        /// Index of the object.
        object: usize,
        /// The other object, the first of them if there are several.
        other: usize,
        /// Share of its outline that lies in none of the others, [0, 1].
        visible: f64,
    },
    /// Another prototype explains the object nearly as well.
    Twin {
        /// Index of the object.
        object: usize,
        /// The other prototype.
        prototype: usize,
        /// Its squared error over that of the one chosen; at least 1.
        ratio: f64,
    },
}

/// What completes the hidden part of an outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Completion {
    /// The prototype that fits what is seen.
    Prototype,
    /// What is seen repeats itself when it is turned: the shape has this symmetry order (0: a disk).
    Rotation {
        /// Symmetry order; 0 for a disk.
        order: usize,
    },
    /// Nothing but the shortest way across.
    Straight,
}

/// The result of a fit, with its doubt. One of a scene of another origin is made by [`Fit::of_painted`]; its fields can be set then.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Fit<T> {
    /// The scene found.
    pub scene: Scene<T>,
    /// Mean absolute error of its rendering against the image, over the pixels looked at (see [`Fitter::fit`]).
    pub loss: T,
    /// Optimiser steps (LM or Adam) in all.
    pub steps: usize,
    /// Why the last optimisation stopped.
    pub stop: StopReason,
    /// Per object, row-major 5 x 5: covariance of (x, y, log scale, rotation, log stretch) from the normal equations. The stretch, the
    /// square root of width over height along the object's own axes, is that of ellipses in drawings; other shapes keep theirs (zeros).
    pub covariance: Vec<[T; 25]>,
    /// Per object, the intersection over union to expect of what is seen of it and what is there, [0, 1], if it is off by what its pose and
    /// its outline may be off by. Empty if it is not known, NaN of an object about which nothing is.
    pub expected_iou: Vec<T>,
    /// What remains open.
    pub ambiguity: Vec<Ambiguity>,
    /// Share of the picture's variance that neither the scene nor noise explains, [0, 1]; NaN if it was not counted.
    pub unexplained: f64,
    /// Per object, the share of the picture's variance that would be unexplained in addition if it alone were left out.
    /// Negative if the picture would be met better without it; empty if it was not counted. Pixels count as covered in whole
    /// or not at all.
    pub marginal_gain: Vec<f64>,
    /// Standard deviation of a channel that was taken for noise: at least the rounding of 8 bits; NaN if it was not estimated.
    pub noise: T,
    /// Description length of the scene and what it leaves unexplained, in bits; NaN if it was not counted.
    pub bits: f64,
}

impl<T: Real> Fit<T> {
    /// A scene of any origin, drawn as `drawing` and painted as `painted` (planar, as long as the image's data): what it
    /// leaves unexplained and the marginal gain of its objects. It knows neither loss (NaN) nor steps (0, at their limit), covariance,
    /// ambiguity or description length (NaN).
    #[must_use]
    #[inline(never)]
    pub fn of_painted(scene: Scene<T>, drawing: &Drawing<T>, image: &ImageView<'_, T>, painted: &[T]) -> Self {
        let Unexplained { share, noise, variance, .. } = Unexplained::without_bits(image, painted);
        Self {
            loss: T::nan(),
            steps: 0,
            stop: StopReason::StepLimit,
            covariance: Vec::new(),
            expected_iou: Vec::new(),
            ambiguity: Vec::new(),
            unexplained: share,
            marginal_gain: marginal_gain::marginal_gains(drawing, image, scene.compositing, variance),
            noise,
            bits: f64::NAN,
            scene,
        }
    }
}

impl<T: Real> Fit<T> {
    /// The fit in another precision.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Fit<U> {
        let number = |value: T| U::of(value.as_f64());
        Fit {
            scene: self.scene.cast(),
            loss: number(self.loss),
            steps: self.steps,
            stop: self.stop,
            covariance: self.covariance.iter().map(|block| block.map(number)).collect(),
            expected_iou: self.expected_iou.iter().copied().map(number).collect(),
            ambiguity: self.ambiguity.clone(),
            unexplained: self.unexplained,
            marginal_gain: self.marginal_gain.clone(),
            noise: number(self.noise),
            bits: self.bits,
        }
    }
}

impl<T> Fit<T> {
    /// Indices of the objects by falling marginal gain. The scene itself is in the order in which it is painted.
    #[must_use]
    pub fn ranking(&self) -> Vec<usize> {
        marginal_gain::ranking(&self.marginal_gain)
    }
}
