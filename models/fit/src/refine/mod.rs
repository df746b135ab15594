//! Joint second-order refinement from a given start: the counterpart of [`crate::opt_p`] that needs tens of steps
//! instead of hundreds.
//!
//! In: an image and a scene near its truth. Out: the same objects with the poses and colors at which the image is
//! explained best; shapes and confidences stay. `scratch` knows shapes and draws, `covariance` inverts the normal
//! equations. `tests/property/refine.rs` shows how far off a start may be.

mod covariance;
mod scratch;

use dvp_core::{ImageView, Real, Scene};
use dvp_trace::noise::noise_level;

use crate::joint::{JointProblem, continue_sigma};
use crate::marginal_gain::marginal_gains;
use crate::options::check_values;
use crate::pose::search::Prototype;
use crate::price::scene_bits;
use crate::residual::Residual;
use crate::segment::PIXEL_NOISE;
use crate::{Fit, FitError};
use covariance::covariances;
pub use scratch::RefineScratch;
use scratch::to_scene;

/// Settings of the refinement: Levenberg-Marquardt at softer edges first, which widens the basin from about a pixel to
/// several.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Refine {
    /// The edge's sigma is multiplied by these, one after the other; the last one should be 1.
    pub factors: &'static [f64],
    /// Most steps per factor.
    pub max_steps: usize,
    /// Residual of a channel at which a pixel loses most of its say (Geman-McClure), at factor 1; it grows with the root
    /// of the factor.
    pub width: f64,
}

impl Default for Refine {
    fn default() -> Self {
        Self { factors: &[64.0, 16.0, 4.0, 1.0], max_steps: 12, width: 0.05 }
    }
}

impl Refine {
    /// The same with [`Self::factors`].
    #[must_use]
    pub fn with_factors(self, factors: &'static [f64]) -> Self {
        Self { factors, ..self }
    }

    /// The same with [`Self::max_steps`].
    #[must_use]
    pub fn with_max_steps(self, max_steps: usize) -> Self {
        Self { max_steps, ..self }
    }

    /// The same with [`Self::width`].
    #[must_use]
    pub fn with_width(self, width: f64) -> Self {
        Self { width, ..self }
    }

    /// The scene that Levenberg-Marquardt ends at, or `start` if that explains the image better.
    ///
    /// Translation, scale, rotation, colors and the background move, shapes and confidences stay. An outline that
    /// crosses itself is filled by the side of its nearest edge. Without objects nothing moves.
    ///
    /// # Errors
    /// [`FitError`] if the image or the start is not finite, a scale is not above 0, an outline encloses no area, or a
    /// setting is out of range.
    #[inline(never)]
    pub fn fit<T: Real>(
        &self,
        image: ImageView<'_, T>,
        start: &Scene<T>,
        scratch: &mut RefineScratch<T>,
    ) -> Result<Fit<T>, FitError> {
        self.check(&image)?;
        let start_loss = scratch.compare(start, image)?;
        let unit = T::of_usize(image.size().unit_px());
        let mut posed = scratch.posed(start, unit)?;
        let mut moved = posed.clone();
        let problem = self.problem(image, start, &scratch.shapes);
        let result = continue_sigma(&problem, &mut moved, self.factors, self.max_steps, &mut scratch.joint);
        let mut scene = to_scene(start, &moved, unit);
        let mut loss = scratch.compare(&scene, image)?;
        if loss < start_loss {
            posed = moved;
        } else {
            scene = start.clone();
            loss = scratch.compare(&scene, image)?;
        }
        let problem = self.problem(image, start, &scratch.shapes);
        scratch.joint.assemble(&problem, &posed);
        let noise = noise_level(&image, &mut scratch.differences).max(T::of(PIXEL_NOISE));
        let covariance = covariances(&mut scratch.joint, posed.objects.len(), unit, noise);
        let bits = scene_bits(&scene, scratch.shapes.len()) + scratch.residual.bits(T::of(PIXEL_NOISE));
        let expected_iou = scratch.expected_iou(&posed, &covariance, image.size());
        let ambiguity = scratch.ambiguities(&posed, image, unit);
        let (unexplained, total) = Residual::unexplained(&image, &scratch.pixels, noise);
        let marginal_gain = marginal_gains(&scratch.drawing, &image, scene.compositing, total);
        let (steps, stop) = (result.steps, result.stop);
        Ok(Fit {
            scene,
            loss,
            steps,
            stop,
            covariance,
            expected_iou,
            ambiguity,
            unexplained,
            marginal_gain,
            noise,
            bits,
        })
    }

    fn problem<'a, T: Real>(
        &self,
        image: ImageView<'a, T>,
        start: &Scene<T>,
        shapes: &'a [Prototype<T>],
    ) -> JointProblem<'a, T> {
        let (edge, compositing) = (start.edge, start.compositing);
        JointProblem { image, shapes, edge, compositing, colors: true, coarse: false, width: T::of(self.width) }
    }

    fn check<T: Real>(&self, image: &ImageView<'_, T>) -> Result<(), FitError> {
        check_values(image)?;
        if self.factors.is_empty() || self.factors.iter().any(|factor| !(factor.is_finite() && *factor > 0.0)) {
            return Err(FitError::Setting { what: "factors", must: "at least one, each finite and above 0" });
        }
        if !(self.width.is_finite() && self.width > 0.0) {
            return Err(FitError::Setting { what: "width", must: "finite and above 0" });
        }
        Ok(())
    }
}
