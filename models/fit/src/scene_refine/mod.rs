//! Joint refinement of a drawing: every number of every shape, pose and color is moved, through the renderer, to where
//! the drawing explains an image best; what there is, and in which order, stays.
//!
//! In: an image, RGB or RGBA, and a scene within a pixel or two of it. Out: the same scene with other numbers. `numbers`
//! turns a scene into one vector and back, `lbfgs` descends on the mean squared error. How far each number moves at first
//! follows from how much of the image it moves: the diagonal of the Gauss-Newton matrix, estimated by random probes
//! (Hutchinson's estimator), makes a shift in pixels, a turn in radians and a color comparable. A number that nothing seen
//! depends on stays where it is.
//!
//! Proved by `tests/property/scene_refine.rs`; `tests/examples/shaken_drawings.rs` measures it on drawings by artists.

mod lbfgs;
mod numbers;

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::geometry::Px;
use dvp_core::image::{CHANNELS, RGBA_CHANNELS};
use dvp_core::render::{ContourRenderer, PixelLoss, Renderer};
use dvp_core::shape::{Flattening, OutlineBasis, REFERENCE_VERTICES};
use dvp_core::sort;
use dvp_core::{Drawing, DrawingGrad, ImageSize, ImageView, Real, Scene, SceneGrad};

use self::lbfgs::{Descended, Lbfgs, Objective};
use crate::split_mix::SplitMix;
use crate::{FitError, StopReason};

/// Probes of the Gauss-Newton diagonal: each number's share is known to about 40 % then, which is enough for a scale.
const PROBES: usize = 12;
/// How closely the polygons of curves follow them while numbers move.
const TOLERANCE: Px<f64> = Px(0.01);
/// A descent that lowers the squared error by a smaller share of it is the last one.
const LEAST_ROUND: f64 = 0.02;
/// A number that moves less than this share of what the number that moves most does stays where it is.
const UNSEEN: f64 = 1e-6;
/// A number that changes the image less than this share of what the median number does is moved as if it changed that much:
/// control points that slide along their curve would else go far for nothing (damping, as of Levenberg and Marquardt).
const DAMPING: f64 = 0.1;

/// Settings of the refinement.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SceneRefine {
    /// Most steps.
    pub max_steps: usize,
    /// A step that lowers the squared error by a smaller share of it brings next to nothing; a few in a row end the
    /// refinement.
    pub least_gain: f64,
}

impl Default for SceneRefine {
    fn default() -> Self {
        Self { max_steps: 1000, least_gain: 1e-4 }
    }
}

/// A refined scene.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct RefinedScene<T> {
    /// The scene: the objects of the start, in their order, of their kinds.
    pub scene: Scene<T>,
    /// Mean squared error of the start, over pixels and channels.
    pub start_loss: T,
    /// That of the scene; never above it.
    pub loss: T,
    /// Steps taken.
    pub steps: usize,
    /// Numbers that could move.
    pub number_count: usize,
    /// Why the refinement stopped.
    pub stop: StopReason,
}

/// A step of a refinement, as those see it who watch.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct RefineStep<'a, T> {
    /// Its number, from 1; 0 is the start.
    pub step: usize,
    /// Mean squared error after it, over pixels and channels.
    pub loss: T,
    /// The scene after it.
    pub scene: &'a Scene<T>,
}

impl SceneRefine {
    /// The same with [`Self::max_steps`].
    #[must_use]
    pub fn with_max_steps(self, max_steps: usize) -> Self {
        Self { max_steps, ..self }
    }

    /// The numbers at which the drawing explains `image` best, near those of `start`.
    ///
    /// A transparent scene is compared with an RGBA image over nothing; with an RGB image every scene is drawn on its
    /// background, which moves too unless the scene is transparent.
    ///
    /// # Errors
    /// [`FitError`] if the scene holds a number that is not finite or describes no shape, [`FitError::Setting`] for an RGBA
    /// image and a scene with a background: put the image over that first.
    pub fn fit<T: Real, const N: usize>(
        &self,
        image: ImageView<'_, T, N>,
        start: &Scene<T>,
    ) -> Result<RefinedScene<T>, FitError> {
        self.fit_watched(image, start, &mut |_| ())
    }

    /// As [`Self::fit`], and tells `watch` of the start and of every step as it is taken: the drawing moves, the loss falls.
    ///
    /// # Errors
    /// As [`Self::fit`].
    #[inline(never)]
    pub fn fit_watched<T: Real, const N: usize>(
        &self,
        image: ImageView<'_, T, N>,
        start: &Scene<T>,
        watch: &mut dyn FnMut(RefineStep<'_, T>),
    ) -> Result<RefinedScene<T>, FitError> {
        if N == RGBA_CHANNELS && !start.transparent {
            return Err(FitError::Setting { what: "image", must: "RGB for a scene with a background" });
        }
        let basis = OutlineBasis::new(REFERENCE_VERTICES, start.harmonic_count().max(1))?;
        let mut drawn = Drawn::new(image, start, basis);
        let start_loss = drawn.loss_and_grad()?;
        watch(RefineStep { step: 0, loss: start_loss, scene: start });
        let mut refined = RefinedScene {
            scene: start.clone(),
            start_loss,
            loss: start_loss,
            steps: 0,
            number_count: 0,
            stop: StopReason::StepLimit,
        };
        while refined.steps < self.max_steps {
            let before = refined.loss;
            let Some(round) = self.descend(&mut drawn, &mut refined, watch)? else {
                refined.stop = StopReason::Converged;
                break;
            };
            if round.converged && before - refined.loss <= T::of(LEAST_ROUND) * before {
                refined.stop = StopReason::Converged;
                break;
            }
        }
        Ok(refined)
    }

    /// One descent from the scene of `refined`, with scales that hold there; none if no number changes the image.
    fn descend<T: Real, const N: usize>(
        &self,
        drawn: &mut Drawn<'_, T, N>,
        refined: &mut RefinedScene<T>,
        watch: &mut dyn FnMut(RefineStep<'_, T>),
    ) -> Result<Option<Descended<T>>, FitError> {
        drawn.scene.clone_from(&refined.scene);
        let mut values = Vec::new();
        numbers::load(drawn.start, &drawn.scene, &mut values);
        let scales = drawn.scales(values.len())?;
        // Numbers that nothing seen depends on keep their value: they are not part of the point.
        let movable: Vec<usize> = (0..values.len()).filter(|&i| scales[i] > T::zero()).collect();
        if movable.is_empty() {
            return Ok(None);
        }
        let mut bounds = Vec::new();
        numbers::bounds(drawn.start, &mut bounds);
        let bounds: Vec<[T; 2]> = movable.iter().map(|&i| bounds[i].map(|bound| bound / scales[i])).collect();
        let mut point: Vec<T> = movable.iter().map(|&i| values[i] / scales[i]).collect();
        // Half the sum of squares has the Gauss-Newton matrix as its Hessian: ones on the diagonal, so scaled.
        let weight = T::of(0.5) * T::of_usize(drawn.image.data().len());
        let (steps, grad) = (refined.steps, Vec::new());
        let mut scaled = Scaled { drawn, values, scales: &scales, movable: &movable, weight, grad, steps, watch };
        let descent = Lbfgs { max_steps: self.max_steps - refined.steps, least_gain: self.least_gain };
        let ended = descent.descend(&mut scaled, &bounds, &mut point);
        scaled.place(&point);
        refined.number_count = refined.number_count.max(movable.len());
        if let Some(ended) = ended {
            refined.scene.clone_from(&drawn.scene);
            refined.steps += ended.steps.max(1);
            refined.loss = ended.value / weight;
        }
        Ok(ended)
    }
}

/// A scene held against an image.
struct Drawn<'a, T: Real, const N: usize> {
    image: ImageView<'a, T, N>,
    start: &'a Scene<T>,
    scene: Scene<T>,
    basis: OutlineBasis<T>,
    renderer: ContourRenderer<T>,
    scratch: <ContourRenderer<T> as Renderer<T>>::Scratch,
    drawing: Drawing<T>,
    drawing_grad: DrawingGrad<T>,
    grad: SceneGrad<T>,
}

impl<'a, T: Real, const N: usize> Drawn<'a, T, N> {
    fn new(image: ImageView<'a, T, N>, start: &'a Scene<T>, basis: OutlineBasis<T>) -> Self {
        Self {
            image,
            start,
            scene: start.clone(),
            basis,
            renderer: ContourRenderer::new(start.edge, start.compositing),
            scratch: Default::default(),
            drawing: Drawing::default(),
            drawing_grad: DrawingGrad::default(),
            grad: SceneGrad::default(),
        }
    }

    fn how(&self) -> Flattening<'_, T> {
        let tolerance = T::of(TOLERANCE.to_scene_length(self.image.size()));
        Flattening::new(&self.basis, tolerance)
    }

    /// Draws the scene, and sets its gradients to 0.
    fn draw(&mut self) -> Result<(), FitError> {
        let mut drawing = core::mem::take(&mut self.drawing);
        let drawn = self.scene.draw(self.how(), &mut drawing);
        self.drawing = drawing;
        drawn?;
        self.drawing_grad.reset(&self.drawing);
        self.grad.reset(&self.scene);
        Ok(())
    }

    /// Pulls the gradient of the drawing back to the scene.
    fn pull_back(&mut self) -> Result<(), FitError> {
        let mut grad = core::mem::take(&mut self.grad);
        let pulled = self.scene.draw_vjp(self.how(), &self.drawing_grad, &mut grad);
        self.grad = grad;
        Ok(pulled?)
    }

    /// The mean squared error of the scene, whose gradient is left in `grad`.
    fn loss_and_grad(&mut self) -> Result<T, FitError> {
        self.draw()?;
        let Self { renderer, drawing, image, scratch, drawing_grad, .. } = self;
        let loss = renderer.loss_and_grad(drawing, *image, PixelLoss::Mse, scratch, drawing_grad)?;
        self.pull_back()?;
        Ok(loss)
    }

    /// 1 / the root of each number's entry on the diagonal of the Gauss-Newton matrix: the change of the number that
    /// changes the image by 1 in the sum of squares; 0 for numbers that hardly change it.
    ///
    /// With signs z drawn at random per pixel and channel, the mean of the squares of J^T z is that diagonal.
    fn scales(&mut self, count: usize) -> Result<Vec<T>, FitError> {
        let mut sums = vec![T::zero(); count];
        let mut values = Vec::with_capacity(count);
        let mut signs = SplitMix(1);
        for _ in 0..PROBES {
            self.draw()?;
            let probe: Vec<T> = (0..self.image.data().len()).map(|_| signs.sign()).collect();
            let Self { renderer, drawing, scratch, drawing_grad, .. } = self;
            let size: ImageSize = self.image.size();
            if N == CHANNELS {
                renderer.render_vjp(drawing, size, scratch, &probe, drawing_grad)?;
            } else {
                renderer.render_rgba_vjp(drawing, size, scratch, &probe, drawing_grad)?;
            }
            self.pull_back()?;
            numbers::load_grad(self.start, &self.grad, &mut values);
            sums.iter_mut().zip(&values).for_each(|(sum, &value)| *sum += value * value);
        }
        let most = sums.iter().copied().fold(T::zero(), T::max);
        let is_seen = |sum: T| sum > most * T::of(UNSEEN * UNSEEN);
        let mut seen: Vec<T> = sums.iter().copied().filter(|&sum| is_seen(sum)).collect();
        sort::ascending(&mut seen, |sum| sum.as_f64());
        let floor = seen.get(seen.len() / 2).copied().unwrap_or_default() * T::of(DAMPING);
        let scale = |sum: T| {
            if is_seen(sum) { (sum.max(floor) / T::of_usize(PROBES)).sqrt().recip() } else { T::zero() }
        };
        Ok(sums.into_iter().map(scale).collect())
    }
}

/// Half the sum of squared errors as a function of scaled numbers.
struct Scaled<'b, 'a, T: Real, const N: usize> {
    drawn: &'b mut Drawn<'a, T, N>,
    /// All numbers of the scene.
    values: Vec<T>,
    scales: &'b [T],
    /// Which of them are in the point.
    movable: &'b [usize],
    weight: T,
    grad: Vec<T>,
    /// Steps taken so far, in all descents.
    steps: usize,
    watch: &'b mut dyn FnMut(RefineStep<'_, T>),
}

impl<T: Real, const N: usize> Scaled<'_, '_, T, N> {
    /// Writes a point to the scene; none if a shape refuses its numbers.
    fn place(&mut self, point: &[T]) -> Option<()> {
        for (&i, &value) in self.movable.iter().zip(point) {
            self.values[i] = value * self.scales[i];
        }
        numbers::store(&self.values, self.drawn.start, &mut self.drawn.scene).ok()
    }
}

impl<T: Real, const N: usize> Objective<T> for Scaled<'_, '_, T, N> {
    fn evaluate(&mut self, point: &[T], gradient: &mut [T]) -> Option<T> {
        self.place(point)?;
        let loss = self.drawn.loss_and_grad().ok()?;
        numbers::load_grad(self.drawn.start, &self.drawn.grad, &mut self.grad);
        for (gradient, &i) in gradient.iter_mut().zip(self.movable) {
            *gradient = self.grad[i] * self.scales[i] * self.weight;
        }
        loss.is_finite().then(|| loss * self.weight)
    }

    fn stepped(&mut self, value: T) {
        self.steps += 1;
        (self.watch)(RefineStep { step: self.steps, loss: value / self.weight, scene: &self.drawn.scene });
    }
}
