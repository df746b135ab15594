//! Rand-OptP: the paper's ablation that starts from a random scene with the right number of objects.

use alloc::vec::Vec;
use core::f64::consts::TAU;

use dvp_core::render::{PixelLoss, Renderer};
use dvp_core::{Efd, ImageView, Object, Pose, Real, Scene};

use crate::Fit;
use crate::adam::descent::{Descent, DescentError, Stage};
use crate::opt_p::fit_of;
use crate::parameters::Free;
use crate::split_mix::SplitMix;

/// Settings of Rand-OptP; the defaults are those of its published evaluation. To change some: start with the default, set fields.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RandOptP {
    /// Steps and learning rate with fixed shapes.
    pub pose: (usize, f64),
    /// Steps and learning rate with free shapes.
    pub shape: (usize, f64),
    /// Weight of the mean contour length of the unit outlines.
    pub contour_length: f64,
}

impl Default for RandOptP {
    fn default() -> Self {
        Self { pose: (250, 0.01), shape: (250, 0.001), contour_length: 0.01 }
    }
}

impl RandOptP {
    /// The scene that Adam reaches from `start`, first with its shapes, then with free ones.
    ///
    /// The fit's loss is the mean absolute error, without the contour length. Covariance, ambiguity and description length
    /// as in [`OptP::fit`](crate::opt_p::OptP::fit).
    ///
    /// # Errors
    /// [`DescentError`] as [`Descent::run`].
    ///
    /// *Source*: the paper, Rand-OptP; the schedule is its evaluation's.
    #[inline(never)]
    pub fn fit<T: Real, R: Renderer<T>>(
        &self,
        descent: &mut Descent<'_, T, R>,
        image: ImageView<'_, T>,
        start: &Scene<T>,
    ) -> Result<Fit<T>, DescentError> {
        let mut scene = start.clone();
        let stage = |(steps, learning_rate), free| Stage {
            steps,
            learning_rate,
            free,
            loss: PixelLoss::Mae,
            contour_length: self.contour_length,
        };
        descent.run(image, &mut scene, &stage(self.pose, Free::PoseAndColor))?;
        let outcome = descent.run(image, &mut scene, &stage(self.shape, Free::PoseColorAndShape))?;
        fit_of(descent, image, scene, outcome, self.pose.0 + self.shape.0)
    }
}

/// A scene of `object_count` objects with the ranges of MDS-HR: positions in [0.05, 0.95], scales in [0.1, 0.3], any angle,
/// any color, each shape one of `shapes` by chance (none: no objects). The same seed gives the same scene, on any machine.
#[must_use]
#[inline(never)]
pub fn random_scene<T: Real>(object_count: usize, shapes: &[Efd<T>], seed: u64) -> Scene<T> {
    let mut chance = SplitMix(seed);
    let mut scene = Scene::empty(chance.color());
    if shapes.is_empty() {
        return scene;
    }
    let objects = (0..object_count).map(|_| {
        let pose = Pose {
            translation: [T::of(0.05 + 0.9 * chance.unit()), T::of(0.05 + 0.9 * chance.unit())],
            scale: T::of(0.1 + 0.2 * chance.unit()),
            rotation: T::of(TAU * chance.unit()),
        };
        let shape = chance.below(shapes.len());
        Object::of_efd(pose, chance.color(), T::one(), shapes[shape].clone(), None)
    });
    scene.objects = objects.collect::<Vec<_>>();
    scene
}
