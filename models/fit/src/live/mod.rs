//! LIVE: closed paths of cubics, added one by one where the picture is worst explained, all of them moved after each addition.
//!
//! In: an image. Out: a scene of paths. The paper's baseline of another house, on the renderers of this one.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`Live`]: the settings, and layer after layer |
//! | `start` | the path that a shape starts as |
//! | `focus` | the loss that looks near outlines |
//! | `crossing` | the price on cubics that turn back on themselves |
//! | `descent` | Adam on points, colors and opacities |
//!
//! Proved by `tests/gradient/live.rs` and `tests/property/live.rs`; measured by `dvp chart`.

pub mod crossing;
pub mod descent;
pub mod focus;
mod start;
#[cfg(test)]
mod tests;

use dvp_core::geometry::Px;
use dvp_core::render::{Compositing, EdgeProfile, PixelLoss};
use dvp_core::{ImageView, Real, Scene};

use self::descent::{PathDescent, PathLoss, PathStage};
use crate::adam::descent::DescentError;
use crate::opt_iter::background::BackgroundStart;
use crate::opt_iter::blob::{BlobFinder, BlobSize};
use crate::{Fit, StopReason};

pub use start::PathStart;

/// Settings of LIVE; the defaults are ours, the published ones [`Self::published`]. To change some: start with either, set fields.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Live {
    /// Most shapes.
    pub shape_count: usize,
    /// Cubics of each shape; at least 2.
    pub segment_count: usize,
    /// As what a shape starts.
    pub start: PathStart,
    /// The color of the background, which moves in the last stage; none: white, which stays.
    pub background: Option<BackgroundStart>,
    /// Whether opacities move.
    pub opacity: bool,
    /// Steps after each addition.
    pub layer_steps: usize,
    /// Steps at the end, on the mean absolute error of all pixels.
    pub finish_steps: usize,
    /// Adam's rate for points at the start of a layer: about how far one moves in a step.
    pub point_rate: Px<f64>,
    /// Adam's rate for colors and opacities at the start of a layer.
    pub color_rate: f64,
    /// Rates fall evenly to this share of theirs in the last step of a layer.
    pub last_rate: f64,
    /// Pixels farther from every outline do not count in a layer.
    pub reach: Px<f64>,
    /// Steps from one weighing of the pixels to the next; at least 1.
    pub weigh_every: usize,
    /// Weight of the price on crossings.
    pub crossing: f64,
    /// A shape that takes away no more than this share of the squared error of the background alone goes again, and ends the
    /// search; none: all stay.
    pub least_gain: Option<f64>,
}

impl Default for Live {
    fn default() -> Self {
        Self {
            shape_count: 8,
            segment_count: 4,
            start: PathStart::Ellipse,
            background: Some(BackgroundStart::Mode),
            opacity: false,
            layer_steps: 60,
            finish_steps: 100,
            point_rate: Px(0.5),
            color_rate: 0.01,
            last_rate: 0.1,
            reach: Px(10.0),
            weigh_every: 5,
            crossing: 0.01,
            least_gain: Some(0.005),
        }
    }
}

impl Live {
    /// The published settings: five circles of radius 5 px on white that stays, 500 steps after each addition, points at a rate of 1 px
    /// and colors of 0.01, pixels weighed anew in every step, every shape kept. How the rates fall it does not publish: here to a tenth.
    #[must_use]
    pub fn published() -> Self {
        Self {
            shape_count: 5,
            start: PathStart::Circle(Px(5.0)),
            background: None,
            opacity: true,
            layer_steps: 500,
            finish_steps: 0,
            point_rate: Px(1.0),
            weigh_every: 1,
            least_gain: None,
            ..Self::default()
        }
    }

    /// The scene of paths found for `image`, painted with these edges and this mixing; later shapes lie in front.
    ///
    /// The next shape starts at the largest blob: the connected region of one color, not yet explained, with the most pixels.
    /// After each layer the scene is the one met with the smallest squared error. Stops early with [`StopReason::Empty`] where nothing
    /// is left to explain, with [`StopReason::Converged`] where a shape brought too little. The fit's loss is the mean absolute error;
    /// covariance, ambiguity and description length as in [`OptP::fit`](crate::opt_p::OptP::fit).
    ///
    /// # Errors
    /// [`DescentError`] if the image or the edge profile holds a number that is not finite.
    ///
    /// *Source*: Ma et al., Towards Layer-wise Image Vectorization, CVPR 2022: its layers, its losses, its start at the largest
    /// component. Polygons of the cubics and their gradients are this crate's renderer's, even-odd.
    #[inline(never)]
    pub fn fit<T: Real>(
        &self,
        image: ImageView<'_, T>,
        edge: EdgeProfile<T>,
        compositing: Compositing,
    ) -> Result<Fit<T>, DescentError> {
        let background = self.background.map_or([T::one(); 3], |start| start.color(image));
        let mut scene = Scene { edge, compositing, ..Scene::empty(background) };
        let mut descent = PathDescent::new(image, edge, compositing)?;
        let mut finder = BlobFinder::new();
        let mut error = descent.paint(&scene, PixelLoss::Mse)?;
        let least_gain = self.least_gain.map(|share| error * T::of(share));
        let (mut steps, mut stop) = (0, StopReason::StepLimit);
        let layer = self.layer();
        for _ in 0..self.shape_count {
            let Some(blob) = finder.largest_by(BlobSize::Pixels, image, descent.painted()) else {
                stop = StopReason::Empty;
                break;
            };
            let before = scene.clone();
            scene.objects.push(self.start.object(&blob, self.segment_count, image.size()));
            descent.run(&mut scene, &layer)?;
            steps += layer.steps;
            let now = descent.paint(&scene, PixelLoss::Mse)?;
            if least_gain.is_some_and(|gain| error - now <= gain) {
                scene = before;
                stop = StopReason::Converged;
                break;
            }
            error = now;
        }
        if self.finish_steps > 0 {
            let loss = PathLoss::Even(PixelLoss::Mae);
            let finish = PathStage { steps: self.finish_steps, loss, background: self.background.is_some(), ..layer };
            descent.run(&mut scene, &finish)?;
            steps += finish.steps;
        }
        let loss = descent.paint(&scene, PixelLoss::Mae)?;
        Ok(Fit { loss, steps, stop, ..Fit::of_painted(scene, descent.drawing(), &image, descent.painted()) })
    }

    fn layer(&self) -> PathStage {
        PathStage {
            steps: self.layer_steps,
            point_rate: self.point_rate,
            color_rate: self.color_rate,
            last_rate: self.last_rate,
            loss: PathLoss::Focused { reach: self.reach, every: self.weigh_every },
            crossing: self.crossing,
            background: false,
            opacity: self.opacity,
        }
    }
}
