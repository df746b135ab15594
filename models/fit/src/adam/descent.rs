//! Adam on the image loss of a scene, under the plateau schedule: the engine of the paper's optimizers.
//!
//! In: a target image and a start. Out: the best scene met and its loss. One step is: draw, render with gradient, pull
//! back, Adam, make admissible; nothing is allocated in it.

use alloc::vec::Vec;

use dvp_core::render::{PixelLoss, RenderError, Renderer};
use dvp_core::shape::{OutlineBasis, ShapeError};
use dvp_core::{Drawing, DrawingGrad, ImageView, Real, Scene, SceneGrad};

use super::contour_length::mean_length_and_grad;
use super::fixed_shapes::FixedShapes;
use super::{Adam, AdamSettings};
use crate::parameters::{Free, Parameters};
use dvp_core::optim::{Plateau, PlateauSettings};

/// One run of Adam with fresh moments and a fresh schedule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// Steps to take.
    pub steps: usize,
    /// Learning rate at the start.
    pub learning_rate: f64,
    /// What moves.
    pub free: Free,
    /// What falls.
    pub loss: PixelLoss,
    /// Weight of the mean contour length of the unit-scale outlines, added to the loss.
    pub contour_length: f64,
}

/// Where a stage ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome<T> {
    /// The pixel loss of the scene, without the contour length.
    pub loss: T,
    /// Pixel loss and weighted contour length: what the stage made small.
    pub objective: T,
}

/// The memory of a descent, reused from stage to stage and from image to image.
#[derive(Debug)]
pub struct Descent<'a, T: Real, R: Renderer<T>> {
    renderer: &'a R,
    basis: OutlineBasis<T>,
    shapes: FixedShapes<T>,
    scratch: R::Scratch,
    drawing: Drawing<T>,
    drawing_grad: DrawingGrad<T>,
    scene_grad: SceneGrad<T>,
    parameters: Parameters<T>,
    best: Vec<T>,
    adam: Adam<T>,
}

impl<'a, T: Real, R: Renderer<T>> Descent<'a, T, R> {
    /// Outlines of `vertex_count` vertices and up to `harmonic_count` harmonics, painted by `renderer`.
    ///
    /// # Errors
    /// [`DescentError::Shape`] if there are fewer than 4 vertices or no harmonic.
    #[inline(never)]
    pub fn new(renderer: &'a R, vertex_count: usize, harmonic_count: usize) -> Result<Self, DescentError> {
        Ok(Self {
            renderer,
            basis: OutlineBasis::new(vertex_count, harmonic_count)?,
            shapes: FixedShapes::default(),
            scratch: R::Scratch::default(),
            drawing: Drawing::default(),
            drawing_grad: DrawingGrad::default(),
            scene_grad: SceneGrad::default(),
            parameters: Parameters::new(),
            best: Vec::new(),
            adam: Adam::new(AdamSettings::default(), 0),
        })
    }

    /// Moves `scene` toward `target`; it ends as the best scene met, the start and the last step included.
    ///
    /// # Errors
    /// [`DescentError`] if the scene or the image holds a number that is not finite, or the scene has more harmonics than
    /// this descent was made for; `scene` is then somewhere on the way.
    #[inline(never)]
    pub fn run(
        &mut self,
        target: ImageView<'_, T>,
        scene: &mut Scene<T>,
        stage: &Stage,
    ) -> Result<Outcome<T>, DescentError> {
        self.parameters.load(scene, stage.free);
        self.parameters.settle(scene);
        self.parameters.store(scene);
        self.adam.reset(self.parameters.values().len());
        self.shapes.sample(scene, &self.basis)?;
        let mut schedule = Plateau::new(PlateauSettings::default(), stage.learning_rate);
        let mut best = self.evaluate(target, scene, stage, 0)?;
        self.keep();
        for step in 1..=stage.steps {
            self.parameters.pull_back(&self.scene_grad);
            let (values, gradient) = self.parameters.values_and_gradient();
            self.adam.step(values, gradient, schedule.learning_rate());
            self.parameters.settle(scene);
            self.parameters.store(scene);
            let outcome = self.evaluate(target, scene, stage, step)?;
            schedule.observe(outcome.objective.as_f64());
            if outcome.objective < best.objective {
                best = outcome;
                self.keep();
            }
        }
        self.parameters.values_and_gradient().0.copy_from_slice(&self.best);
        self.parameters.store(scene);
        Ok(best)
    }

    /// Paints `scene` into planar `image`.
    ///
    /// # Errors
    /// As [`Self::run`].
    #[inline(never)]
    pub fn paint(&mut self, scene: &Scene<T>, target: ImageView<'_, T>, image: &mut [T]) -> Result<(), DescentError> {
        scene.draw(&self.basis, &mut self.drawing)?;
        Ok(self.renderer.render(&self.drawing, target.size(), &mut self.scratch, image)?)
    }

    /// The outlines last painted.
    pub(crate) fn drawing(&self) -> &Drawing<T> {
        &self.drawing
    }

    fn keep(&mut self) {
        self.best.clear();
        self.best.extend_from_slice(self.parameters.values());
    }

    /// The losses at `scene`, and their gradient into `scene_grad`.
    fn evaluate(
        &mut self,
        target: ImageView<'_, T>,
        scene: &Scene<T>,
        stage: &Stage,
        step: usize,
    ) -> Result<Outcome<T>, DescentError> {
        match stage.free {
            Free::PoseAndColor => self.shapes.draw(scene, &mut self.drawing),
            Free::PoseColorAndShape => scene.draw(&self.basis, &mut self.drawing)?,
        }
        self.drawing_grad.reset(&self.drawing);
        self.scene_grad.reset(scene);
        let (drawing, grad) = (&self.drawing, &mut self.drawing_grad);
        let loss = self.renderer.loss_and_grad(drawing, target, stage.loss, &mut self.scratch, grad)?;
        let length = match T::of(stage.contour_length) {
            weight if weight == T::zero() => weight,
            weight => mean_length_and_grad(scene, drawing, weight, grad, &mut self.scene_grad),
        };
        let objective = loss + length;
        match stage.free {
            Free::PoseAndColor => self.shapes.draw_vjp(scene, &self.drawing_grad, &mut self.scene_grad),
            Free::PoseColorAndShape => scene.draw_vjp(&self.basis, &self.drawing_grad, &mut self.scene_grad)?,
        }
        if !objective.is_finite() {
            return Err(DescentError::NotFinite { step });
        }
        Ok(Outcome { loss, objective })
    }
}

/// Why a descent was refused or broken off.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum DescentError {
    /// The renderer refused the scene.
    Render(RenderError),
    /// The outlines could not be drawn.
    Shape(ShapeError),
    /// The loss became NaN or infinite.
    NotFinite {
        /// Steps taken before.
        step: usize,
    },
}

impl From<RenderError> for DescentError {
    fn from(error: RenderError) -> Self {
        Self::Render(error)
    }
}

impl From<ShapeError> for DescentError {
    fn from(error: ShapeError) -> Self {
        Self::Shape(error)
    }
}

impl core::fmt::Display for DescentError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Render(error) => error.fmt(f),
            Self::Shape(error) => error.fmt(f),
            Self::NotFinite { step } => {
                write!(f, "the loss is NaN or infinite after {step} steps: check the image, lower the learning rate")
            }
        }
    }
}

impl core::error::Error for DescentError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Render(error) => Some(error),
            Self::Shape(error) => Some(error),
            Self::NotFinite { .. } => None,
        }
    }
}
