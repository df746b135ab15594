//! Opt-Iter: objects added one by one where the image is worst explained, all optimized after each addition.
//!
//! In: an image. Out: a scene of a fixed number of objects with free shapes. [`blob`] finds where the next object starts;
//! `tests/golden/optim.rs` and the example `optimizers` of the tests compare the outcome with the published one.

pub mod blob;
#[cfg(test)]
mod tests;

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::image::CHANNELS;
use dvp_core::render::{PixelLoss, Renderer};
use dvp_core::{Efd, ImageView, Object, Pose, Real, Scene};

use self::blob::{Blob, BlobFinder};
use crate::adam::descent::{Descent, DescentError, Outcome, Stage};
use crate::opt_p::fit_of;
use crate::parameters::Free;
use crate::{Fit, StopReason};

/// Settings of Opt-Iter; the defaults are those of its published evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// Weight of the mean contour length of the unit outlines.
    pub contour_length: f64,
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
            contour_length: 0.01,
        }
    }
}

impl OptIter {
    /// The scene found for `image`; its edge profile and compositing are the reference's, whatever the renderer's.
    ///
    /// Stops early, with [`StopReason::Empty`], only where nothing at all is left to explain. The fit's loss is the mean
    /// absolute error, without the contour length; covariance, ambiguity and description length as in
    /// [`OptP::fit`](crate::opt_p::OptP::fit).
    ///
    /// # Errors
    /// [`DescentError`] as [`Descent::run`].
    ///
    /// *Source*: the paper, Opt-Iter; the schedule is its evaluation's.
    pub fn fit<T: Real, R: Renderer<T>>(
        &self,
        descent: &mut Descent<'_, T, R>,
        image: ImageView<'_, T>,
    ) -> Result<Fit<T>, DescentError> {
        let mut finder = BlobFinder::new();
        let mut painted = vec![T::zero(); image.data().len()];
        let mut scene = Scene::empty(median_color(image));
        let mut steps = 0;
        let mut stop = StopReason::StepLimit;
        for _ in 0..self.object_count {
            descent.paint(&scene, image, &mut painted)?;
            let Some(blob) = finder.largest(image, &painted) else {
                stop = StopReason::Empty;
                break;
            };
            scene.objects.push(self.start_object(&blob));
            self.run(descent, image, &mut scene, self.pose, Free::PoseAndColor, &mut steps)?;
            self.run(descent, image, &mut scene, self.shape, Free::PoseColorAndShape, &mut steps)?;
        }
        let outcome = self.run(descent, image, &mut scene, self.finish, Free::PoseColorAndShape, &mut steps)?;
        Ok(Fit { stop, ..fit_of(scene, outcome, steps) })
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
        Object { pose, color: blob.color, confidence: T::one(), efd, prototype: None }
    }
}

/// The median of each channel; of two middle values the lower.
fn median_color<T: Real>(image: ImageView<'_, T>) -> [T; CHANNELS] {
    let mut values = Vec::new();
    core::array::from_fn(|channel| {
        values.clear();
        values.extend_from_slice(image.channel(channel));
        let middle = (values.len() - 1) / 2;
        *values.select_nth_unstable_by(middle, |a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal)).1
    })
}
