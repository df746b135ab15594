//! Adam on the points, colors and opacities of a scene of paths.
//!
//! In: an image and a scene. Out: the best scene met. One step is: draw, paint, weigh the errors, pull back, Adam. Nothing
//! but the polygons of the cubics is allocated in it.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::geometry::Px;
use dvp_core::render::{Compositing, ContourRenderer, EdgeProfile, PixelLoss, Renderer};
use dvp_core::shape::{Flattening, OutlineBasis, Shape as _};
use dvp_core::{Drawing, DrawingGrad, ImageView, Real, Scene, SceneGrad};

use super::crossing::crossing_and_grad;
use super::focus::Focus;
use crate::adam::descent::DescentError;
use crate::adam::{Adam, AdamSettings};

/// How closely the polygons of cubics follow them while points move.
const TOLERANCE: Px<f64> = Px(0.02);

/// What falls, beside the price on crossings.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PathLoss {
    /// The squared error of pixels near the outlines, weighted by [`Focus`].
    Focused {
        /// Pixels farther from every outline do not count.
        reach: Px<f64>,
        /// Steps from one weighing to the next; at least 1.
        every: usize,
    },
    /// A mean over all pixels.
    Even(PixelLoss),
}

/// One run of Adam with fresh moments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathStage {
    /// Steps to take.
    pub steps: usize,
    /// Adam's rate for points at the start: about how far one moves in a step.
    pub point_rate: Px<f64>,
    /// Adam's rate for colors and opacities at the start.
    pub color_rate: f64,
    /// Both rates fall evenly to this share of theirs in the last step.
    pub last_rate: f64,
    /// What falls.
    pub loss: PathLoss,
    /// Weight of the price on crossings, [`crossing_and_grad`].
    pub crossing: f64,
    /// Whether the background moves.
    pub background: bool,
    /// Whether opacities move.
    pub opacity: bool,
}

/// The memory of a descent, kept from stage to stage.
#[derive(Debug)]
pub struct PathDescent<'a, T: Real> {
    image: ImageView<'a, T>,
    renderer: ContourRenderer<T>,
    basis: OutlineBasis<T>,
    scratch: <ContourRenderer<T> as Renderer<T>>::Scratch,
    focus: Focus<T>,
    drawing: Drawing<T>,
    drawing_grad: DrawingGrad<T>,
    scene_grad: SceneGrad<T>,
    painted: Vec<T>,
    grad_image: Vec<T>,
    points: Moved<T>,
    colors: Moved<T>,
}

/// Numbers that move alike, and how.
#[derive(Debug, Default)]
struct Moved<T> {
    values: Vec<T>,
    gradient: Vec<T>,
    adam: Adam<T>,
}

impl<'a, T: Real> PathDescent<'a, T> {
    /// A descent toward `image`, painted with these edges and this mixing.
    ///
    /// # Errors
    /// As [`OutlineBasis::new`]; numbers out of range are refused when a scene is painted.
    pub fn new(image: ImageView<'a, T>, edge: EdgeProfile<T>, compositing: Compositing) -> Result<Self, DescentError> {
        let moved = || Moved { adam: Adam::new(AdamSettings::default(), 0), ..Moved::default() };
        Ok(Self {
            image,
            renderer: ContourRenderer::new(edge, compositing),
            // Paths have no descriptors: the smallest table.
            basis: OutlineBasis::new(4, 1)?,
            scratch: Default::default(),
            focus: Focus::new(),
            drawing: Drawing::default(),
            drawing_grad: DrawingGrad::default(),
            scene_grad: SceneGrad::default(),
            painted: vec![T::zero(); image.data().len()],
            grad_image: vec![T::zero(); image.data().len()],
            points: moved(),
            colors: moved(),
        })
    }

    /// Paints `scene`, with edges and mixing of the descent, and returns its mean error.
    ///
    /// # Errors
    /// [`DescentError`] if the scene or the image holds a number that is not finite.
    pub fn paint(&mut self, scene: &Scene<T>, loss: PixelLoss) -> Result<T, DescentError> {
        self.draw(scene)?;
        self.renderer.render(&self.drawing, self.image.size(), &mut self.scratch, &mut self.painted)?;
        let error = self.renderer.loss(&self.drawing, self.image, loss, &mut self.scratch)?;
        if error.is_finite() { Ok(error) } else { Err(DescentError::NotFinite { step: 0 }) }
    }

    /// What was last painted, planar.
    #[must_use]
    pub fn painted(&self) -> &[T] {
        &self.painted
    }

    /// The outlines last painted.
    #[must_use]
    pub fn drawing(&self) -> &Drawing<T> {
        &self.drawing
    }

    /// The gradient that [`Self::objective`] left.
    #[must_use]
    pub fn gradient(&self) -> &SceneGrad<T> {
        &self.scene_grad
    }

    /// Weighs the pixels anew for [`PathLoss::Focused`], by the distance to the outlines of `scene`.
    ///
    /// # Errors
    /// [`DescentError::Shape`] if a path is none.
    pub fn focus_on(&mut self, scene: &Scene<T>, reach: Px<f64>) -> Result<(), DescentError> {
        self.draw(scene)?;
        self.focus.measure(&self.drawing, self.image.size(), Px(T::of(reach.0)));
        Ok(())
    }

    /// What a stage makes small, at `scene`, with the weights last measured; leaves its gradient.
    ///
    /// # Errors
    /// As [`Self::paint`].
    pub fn objective(&mut self, scene: &Scene<T>, stage: &PathStage) -> Result<T, DescentError> {
        Ok(self.evaluate(scene, stage)?.objective)
    }

    /// Moves `scene` toward the image; it ends as the one with the smallest error over all pixels (mean squared where the loss
    /// is focused), the start and the last step included.
    ///
    /// # Errors
    /// As [`Self::paint`], and [`DescentError::NotFinite`] if the loss overflows; `scene` is then somewhere on the way.
    pub fn run(&mut self, scene: &mut Scene<T>, stage: &PathStage) -> Result<(), DescentError> {
        self.load(scene, stage);
        for moved in [&mut self.points, &mut self.colors] {
            moved.adam.reset(moved.values.len());
        }
        let mut best = (T::infinity(), scene.clone());
        for step in 0..=stage.steps {
            if let PathLoss::Focused { reach, every } = stage.loss
                && step % every.max(1) == 0
            {
                self.focus_on(scene, reach)?;
            }
            let Errors { objective, even } = self.evaluate(scene, stage)?;
            if !objective.is_finite() {
                return Err(DescentError::NotFinite { step });
            }
            if even < best.0 {
                best.0 = even;
                best.1.clone_from(scene);
            }
            if step < stage.steps {
                let share = f64::of_usize(step) / f64::of_usize(stage.steps);
                let rate = 1.0 - share * (1.0 - stage.last_rate);
                self.load_gradient(stage);
                self.points.step(stage.point_rate.0 * rate);
                self.colors.step(stage.color_rate * rate);
                self.store(scene, stage)?;
            }
        }
        *scene = best.1;
        Ok(())
    }

    fn how(&self) -> Flattening<'_, T> {
        Flattening::new(&self.basis, T::of(TOLERANCE.to_scene_length(self.image.size())))
    }

    fn draw(&mut self, scene: &Scene<T>) -> Result<(), DescentError> {
        let mut drawing = core::mem::take(&mut self.drawing);
        let drawn = scene.draw(self.how(), &mut drawing);
        self.drawing = drawing;
        Ok(drawn?)
    }

    fn evaluate(&mut self, scene: &Scene<T>, stage: &PathStage) -> Result<Errors<T>, DescentError> {
        self.draw(scene)?;
        self.drawing_grad.reset(&self.drawing);
        self.scene_grad.reset(scene);
        let Self { renderer, drawing, drawing_grad, scratch, image, painted, grad_image, .. } = self;
        let size = image.size();
        let Errors { objective, even } = match stage.loss {
            PathLoss::Focused { .. } => {
                renderer.render(drawing, size, scratch, painted)?;
                let errors = self.focus.errors_and_grad(*image, painted, grad_image);
                renderer.render_vjp(drawing, size, scratch, grad_image, drawing_grad)?;
                errors
            }
            PathLoss::Even(loss) => {
                let loss = renderer.loss_and_grad(drawing, *image, loss, scratch, drawing_grad)?;
                Errors { objective: loss, even: loss }
            }
        };
        let mut grad = core::mem::take(&mut self.scene_grad);
        let pulled = scene.draw_vjp(self.how(), &self.drawing_grad, &mut grad);
        let crossing = crossing_and_grad(&scene.objects, T::of(stage.crossing), &mut grad);
        self.scene_grad = grad;
        pulled?;
        Ok(Errors { objective: objective + crossing, even })
    }

    /// Points in pixels, so that Adam's rate is a length; colors and opacities as they are.
    fn load(&mut self, scene: &Scene<T>, stage: &PathStage) {
        let unit = T::of_usize(self.image.size().unit_px());
        let (points, colors) = (&mut self.points.values, &mut self.colors.values);
        points.clear();
        colors.clear();
        colors.extend(scene.background.into_iter().filter(|_| stage.background));
        for object in &scene.objects {
            object.shape.numbers(points);
            colors.extend(object.color());
            colors.extend(stage.opacity.then_some(object.confidence));
        }
        points.iter_mut().for_each(|value| *value *= unit);
    }

    fn load_gradient(&mut self, stage: &PathStage) {
        let unit = T::of_usize(self.image.size().unit_px());
        let (points, colors) = (&mut self.points.gradient, &mut self.colors.gradient);
        points.clear();
        colors.clear();
        colors.extend(self.scene_grad.background.into_iter().filter(|_| stage.background));
        for object in &self.scene_grad.objects {
            points.extend(object.numbers.iter().map(|&slope| slope / unit));
            colors.extend(object.color);
            colors.extend(stage.opacity.then_some(object.confidence));
        }
    }

    fn store(&self, scene: &mut Scene<T>, stage: &PathStage) -> Result<(), DescentError> {
        let unit = T::of_usize(self.image.size().unit_px());
        let numbers: Vec<T> = self.points.values.iter().map(|&value| value / unit).collect();
        let mut numbers = &numbers[..];
        let mut colors = self.colors.values.iter().map(|value| value.max(T::zero()).min(T::one()));
        let mut take = |place: &mut T| {
            if let Some(value) = colors.next() {
                *place = value;
            }
        };
        if stage.background {
            scene.background.iter_mut().for_each(&mut take);
        }
        for object in &mut scene.objects {
            let (own, rest) = numbers.split_at(object.shape.number_count().min(numbers.len()));
            numbers = rest;
            object.shape.set_numbers(own)?;
            let mut color = object.color();
            color.iter_mut().for_each(&mut take);
            object.paint.set_color(color);
            if stage.opacity {
                take(&mut object.confidence);
            }
        }
        Ok(())
    }
}

/// What falls, and the error over all pixels alike.
#[derive(Clone, Copy, Debug)]
pub(super) struct Errors<T> {
    pub(super) objective: T,
    pub(super) even: T,
}

impl<T: Real> Moved<T> {
    fn step(&mut self, rate: f64) {
        self.adam.step(&mut self.values, &self.gradient, rate);
    }
}
