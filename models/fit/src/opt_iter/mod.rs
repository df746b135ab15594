//! Opt-Iter: objects added one by one where the image is worst explained, all optimized after each addition.
//!
//! In: an image. Out: a scene of a fixed number of objects with free shapes. [`blob`] finds where the next object starts;
//! `tests/golden/optim.rs` and `dvp chart` compare the outcome with the published one.

pub mod background;
pub mod blob;
#[cfg(test)]
mod tests;

use alloc::vec;

use dvp_core::render::{PixelLoss, Renderer};
use dvp_core::{Efd, Image, ImageView, Object, Pose, Real, Scene};

use self::background::BackgroundStart;
use self::blob::{Blob, BlobFinder};
use crate::adam::descent::{Descent, DescentError, Outcome, Stage};
use crate::opt_p::fit_of;
use crate::parameters::Free;
use crate::{Fit, StopReason};

/// Settings of Opt-Iter; the defaults are those of its published evaluation, but for
/// [`Self::contour_length`], [`Self::background`] and [`Self::focus`]; see [`Self::published`]. To change some: start with the
/// default, set fields.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct OptIter {
    /// Objects to add.
    pub object_count: usize,
    /// Harmonics of each shape.
    pub harmonic_count: usize,
    /// Steps and learning rate with fixed shapes, after each addition.
    pub pose: (usize, f64),
    /// Steps and learning rate with free shapes, after these.
    pub shape: (usize, f64),
    /// Steps and learning rate with free shapes, at the end.
    pub finish: (usize, f64),
    /// Scale at which an object starts, scene units.
    pub start_scale: f64,
    /// D_1 of the ellipse as which an object starts, A_1 being 1.
    pub start_ellipse: f64,
    /// Weight of the mean contour length of the unit outlines. The published 0.01 rounds corners off: 0.004 lowers the mean
    /// absolute error by a quarter on MDS-HR.
    pub contour_length: f64,
    /// The color that the background starts with.
    pub background: BackgroundStart,
    /// Whether a new object meets its own blob first: as long as shapes are fixed, the other unexplained blobs are hidden.
    /// Without it, objects tend to swallow neighbors that have not had their turn, for good.
    pub focus: bool,
}

impl Default for OptIter {
    fn default() -> Self {
        Self {
            object_count: 4,
            harmonic_count: 16,
            pose: (100, 0.01),
            shape: (400, 0.0005),
            finish: (100, 0.0005),
            start_scale: 0.1,
            start_ellipse: -0.75,
            contour_length: 0.004,
            background: BackgroundStart::Mode,
            focus: true,
        }
    }
}

impl OptIter {
    /// The published evaluation to the letter: background from the median, no focus, contour length 0.01.
    #[must_use]
    pub fn published() -> Self {
        Self { contour_length: 0.01, background: BackgroundStart::Median, focus: false, ..Self::default() }
    }

    /// The scene found for `image`; its edge profile and compositing are the reference's, whatever the renderer's.
    ///
    /// Where the evaluation is silent: a blob is a connected region of one color, the largest is the one with the largest
    /// summed error, and its object starts with the mean color and position and along the long axis.
    ///
    /// Stops early, with [`StopReason::Empty`], only where nothing at all is left to explain. The fit's loss is the mean
    /// absolute error, without the contour length; covariance, ambiguity and description length as in
    /// [`OptP::fit`](crate::opt_p::OptP::fit).
    ///
    /// # Errors
    /// [`DescentError`] as [`Descent::run`].
    ///
    /// *Source*: the paper, Opt-Iter; the schedule is its evaluation's.
    #[inline(never)]
    pub fn fit<T: Real, R: Renderer<T>>(
        &self,
        descent: &mut Descent<'_, T, R>,
        image: ImageView<'_, T>,
    ) -> Result<Fit<T>, DescentError> {
        let mut finder = BlobFinder::new();
        let mut painted = vec![T::zero(); image.data().len()];
        let mut focused = Image::zeros(image.size());
        let mut scene = Scene::empty(self.background.color(image));
        let mut steps = 0;
        let mut stop = StopReason::StepLimit;
        for _ in 0..self.object_count {
            descent.paint(&scene, image, &mut painted)?;
            let Some(blob) = finder.largest(image, &painted) else {
                stop = StopReason::Empty;
                break;
            };
            scene.objects.push(self.start_object(&blob));
            focused.data_mut().copy_from_slice(image.data());
            if self.focus {
                finder.hide_others(&painted, focused.data_mut());
            }
            self.run(descent, focused.view(), &mut scene, self.pose, Free::PoseAndColor, &mut steps)?;
            self.run(descent, image, &mut scene, self.shape, Free::PoseColorAndShape, &mut steps)?;
        }
        let outcome = self.run(descent, image, &mut scene, self.finish, Free::PoseColorAndShape, &mut steps)?;
        Ok(Fit { stop, ..fit_of(descent, image, scene, outcome, steps)? })
    }

    fn run<T: Real, R: Renderer<T>>(
        &self,
        descent: &mut Descent<'_, T, R>,
        image: ImageView<'_, T>,
        scene: &mut Scene<T>,
        (steps, learning_rate): (usize, f64),
        free: Free,
        taken: &mut usize,
    ) -> Result<Outcome<T>, DescentError> {
        *taken += steps;
        let loss = PixelLoss::Mae;
        descent.run(image, scene, &Stage { steps, learning_rate, free, loss, contour_length: self.contour_length })
    }

    fn start_object<T: Real>(&self, blob: &Blob<T>) -> Object<T> {
        let mut efd = Efd::zeros(self.harmonic_count.max(1));
        efd.rows_mut()[0] = [T::one(), T::zero(), T::zero(), T::of(self.start_ellipse)];
        let pose = Pose { translation: blob.center, scale: T::of(self.start_scale), rotation: blob.orientation };
        Object::of_efd(pose, blob.color, T::one(), efd, None)
    }
}
