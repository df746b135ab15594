//! OptP: Adam on pose and color from a given start, the paper's refinement of a predicted scene.

use alloc::vec;

use dvp_core::render::{PixelLoss, Renderer};
use dvp_core::{ImageView, Real, Scene};

use crate::Fit;
use crate::adam::descent::{Descent, DescentError, Outcome, Stage};
use crate::parameters::Free;

/// Settings of OptP; the defaults are the paper's.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OptP {
    /// Adam steps.
    pub steps: usize,
    /// Learning rate at the start.
    pub learning_rate: f64,
    /// What falls.
    pub loss: PixelLoss,
}

impl Default for OptP {
    fn default() -> Self {
        Self { steps: 100, learning_rate: 0.01, loss: PixelLoss::Mae }
    }
}

impl OptP {
    /// The same with [`Self::steps`].
    #[must_use]
    pub fn with_steps(self, steps: usize) -> Self {
        Self { steps, ..self }
    }

    /// The best scene that Adam meets on its way from `start`: translation, scale, rotation, colors and background move,
    /// shapes and confidences stay.
    ///
    /// The fit's loss is [`Self::loss`]. Its covariance and ambiguity are empty: a first-order descent learns neither; its
    /// description length is not computed (NaN). Whether it is any good, what it leaves unexplained tells.
    ///
    /// # Errors
    /// [`DescentError`] as [`Descent::run`].
    ///
    /// *Source*: the paper, TI-TP-OptP.
    #[inline(never)]
    pub fn fit<T: Real, R: Renderer<T>>(
        &self,
        descent: &mut Descent<'_, T, R>,
        image: ImageView<'_, T>,
        start: &Scene<T>,
    ) -> Result<Fit<T>, DescentError> {
        let mut scene = start.clone();
        let stage = Stage {
            steps: self.steps,
            learning_rate: self.learning_rate,
            free: Free::PoseAndColor,
            loss: self.loss,
            contour_length: 0.0,
        };
        let outcome = descent.run(image, &mut scene, &stage)?;
        fit_of(descent, image, scene, outcome, self.steps)
    }
}

/// What a descent came to.
pub(crate) fn fit_of<T: Real, R: Renderer<T>>(
    descent: &mut Descent<'_, T, R>,
    image: ImageView<'_, T>,
    scene: Scene<T>,
    outcome: Outcome<T>,
    steps: usize,
) -> Result<Fit<T>, DescentError> {
    let mut painted = vec![T::zero(); image.data().len()];
    descent.paint(&scene, image, &mut painted)?;
    Ok(Fit { loss: outcome.loss, steps, ..Fit::of_painted(scene, descent.drawing(), &image, &painted) })
}
