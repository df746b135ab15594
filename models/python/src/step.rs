//! Scenes as numbers to images or losses, and the way back: what frameworks of tensors differentiate.
//!
//! An item is one scene, its numbers one after the other: shapes (objects x numbers), poses (objects x 4: x, y, scale, rotation), colors
//! (objects x 3), confidences (objects), background (3). *Units*: those of scenes, the shorter side of the image is 1.

use std::sync::{Mutex, PoisonError};

use dvp_core::image::{CHANNELS, ImageError, ImageView, RGBA_CHANNELS};
use dvp_core::render::{ContourRenderer, PixelLoss, RenderError, Renderer};
use dvp_core::scene::{DrawingGrad, ObjectGrad, SceneGrad};
use dvp_core::shape::{AnyShape, Efd, Flattening, OUTLINE_TOLERANCE, OutlineBasis, Polygon, ShapeError};
use dvp_core::{Drawing, ImageSize, Object, Pose, Real, Scene};
use rayon::prelude::*;

/// What the shapes of an item are made of.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Shapes {
    /// Rows (a, b, c, d) of so many harmonics, drawn with the vertices of the basis.
    Efd(usize),
    /// The vertices of each ring, how many there are; the rings of an object one after the other.
    Rings(Vec<usize>),
}

impl Shapes {
    /// Numbers per object.
    pub(crate) fn numbers(&self) -> usize {
        match self {
            Self::Efd(harmonics) => 4 * harmonics,
            Self::Rings(lengths) => 2 * lengths.iter().sum::<usize>(),
        }
    }
}

/// Why an item was refused.
#[derive(Debug, thiserror::Error)]
pub(crate) enum StepError {
    #[error("item {item}: {source}")]
    Shape { item: usize, source: ShapeError },
    #[error("item {item}: {source}")]
    Render { item: usize, source: RenderError },
    #[error("target of item {item}: {source}")]
    Target { item: usize, source: ImageError },
}

/// Scenes of one layout to images of one size.
pub(crate) struct Step<T: Real> {
    pub(crate) size: ImageSize,
    pub(crate) objects: usize,
    pub(crate) shapes: Shapes,
    pub(crate) rgba: bool,
    renderer: ContourRenderer<T>,
    basis: OutlineBasis<T>,
    memory: Mutex<Vec<Memory<T>>>,
}

/// Memory of one thread, kept from batch to batch.
struct Memory<T: Real> {
    scene: Scene<T>,
    drawing: Drawing<T>,
    grad: DrawingGrad<T>,
    scene_grad: SceneGrad<T>,
    renderer: <ContourRenderer<T> as Renderer<T>>::Scratch,
}

impl<T: Real> Default for Memory<T> {
    fn default() -> Self {
        Self {
            scene: Scene::empty([T::zero(); 3]),
            drawing: Drawing::default(),
            grad: DrawingGrad::default(),
            scene_grad: SceneGrad::default(),
            renderer: Default::default(),
        }
    }
}

/// Memory that goes back where it came from.
struct Lent<'a, T: Real> {
    own: Memory<T>,
    home: &'a Mutex<Vec<Memory<T>>>,
}

impl<T: Real> Drop for Lent<'_, T> {
    fn drop(&mut self) {
        self.home.lock().unwrap_or_else(PoisonError::into_inner).push(core::mem::take(&mut self.own));
    }
}

impl<T: Real> Step<T> {
    /// A step of `objects` objects per scene; outlines of descriptors have `vertices` vertices, the repeated one counted.
    pub(crate) fn new(
        size: ImageSize,
        objects: usize,
        shapes: Shapes,
        vertices: usize,
        renderer: ContourRenderer<T>,
        rgba: bool,
    ) -> Result<Self, ShapeError> {
        let harmonics = if let Shapes::Efd(harmonics) = shapes { harmonics } else { 1 };
        let basis = OutlineBasis::new(vertices, harmonics)?;
        Ok(Self { size, objects, shapes, rgba, renderer, basis, memory: Mutex::default() })
    }

    /// Numbers per item.
    pub(crate) fn width(&self) -> usize {
        self.objects * (self.shapes.numbers() + 8) + CHANNELS
    }

    /// Values per image.
    pub(crate) fn image_len(&self) -> usize {
        self.size.pixels() * if self.rgba { RGBA_CHANNELS } else { CHANNELS }
    }

    /// Paints the items of `input` into `images`, planar, alpha premultiplied. What stood there does not matter.
    pub(crate) fn render(&self, input: &[T], images: &mut [T]) -> Result<(), StepError> {
        let items = input.chunks(self.width()).zip(images.chunks_mut(self.image_len())).enumerate();
        let one = |lent: &mut Lent<'_, T>, (item, (input, image)): (usize, (&[T], &mut [T]))| {
            let Memory { scene, drawing, renderer, .. } = &mut lent.own;
            self.draw(item, input, scene, drawing)?;
            let painted = if self.rgba {
                self.renderer.render_rgba(drawing, self.size, renderer, image)
            } else {
                self.renderer.render(drawing, self.size, renderer, image)
            };
            painted.map_err(|source| StepError::Render { item, source })
        };
        all(items.collect(), || self.lend(), one)
    }

    /// The gradient of sum(`grad_images` x images) with respect to `input`.
    pub(crate) fn render_vjp(&self, input: &[T], grad_images: &[T]) -> Result<Vec<T>, StepError> {
        let mut grads = vec![T::zero(); input.len()];
        let width = self.width();
        let items = input.chunks(width).zip(grad_images.chunks(self.image_len()));
        let items = items.zip(grads.chunks_mut(width)).enumerate();
        type Item<'a, T> = (usize, ((&'a [T], &'a [T]), &'a mut [T]));
        let one = |lent: &mut Lent<'_, T>, (item, ((input, grad_image), own)): Item<'_, T>| {
            let Memory { scene, drawing, grad, scene_grad, renderer } = &mut lent.own;
            self.draw(item, input, scene, drawing)?;
            grad.reset(drawing);
            let pulled = if self.rgba {
                self.renderer.render_rgba_vjp(drawing, self.size, renderer, grad_image, grad)
            } else {
                self.renderer.render_vjp(drawing, self.size, renderer, grad_image, grad)
            };
            pulled.map_err(|source| StepError::Render { item, source })?;
            self.pull(item, scene, grad, scene_grad, own)
        };
        all(items.collect(), || self.lend(), one)?;
        Ok(grads)
    }

    /// The loss of each item against its target, planar as the images are, and with `backward` its gradient with respect to `input`.
    pub(crate) fn loss(
        &self,
        input: &[T],
        targets: &[T],
        loss: PixelLoss,
        backward: bool,
    ) -> Result<(Vec<T>, Vec<T>), StepError> {
        let width = self.width();
        let batch = input.len() / width;
        let mut losses = vec![T::zero(); batch];
        let mut grads = vec![T::zero(); if backward { input.len() } else { 0 }];
        // Without a way back every item has an empty gradient.
        let own_grads: Vec<&mut [T]> =
            if backward { grads.chunks_mut(width).collect() } else { (0..batch).map(|_| &mut [][..]).collect() };
        let items = input.chunks(width).zip(targets.chunks(self.image_len()));
        let items = items.zip(own_grads.into_iter().zip(&mut losses)).enumerate();
        type Item<'a, T> = (usize, ((&'a [T], &'a [T]), (&'a mut [T], &'a mut T)));
        let one = |lent: &mut Lent<'_, T>, (item, ((input, target), (own, value))): Item<'_, T>| {
            let memory = &mut lent.own;
            self.draw(item, input, &mut memory.scene, &mut memory.drawing)?;
            let refused = |source| StepError::Target { item, source };
            *value = if self.rgba {
                let target = ImageView::<T, RGBA_CHANNELS>::premultiplied(self.size, target).map_err(refused)?;
                self.compare(item, memory, target, loss, backward)?
            } else {
                self.compare(item, memory, ImageView::new(self.size, target).map_err(refused)?, loss, backward)?
            };
            if backward {
                let Memory { scene, grad, scene_grad, .. } = memory;
                self.pull(item, scene, grad, scene_grad, own)?;
            }
            Ok(())
        };
        all(items.collect(), || self.lend(), one)?;
        Ok((losses, grads))
    }

    fn compare<const N: usize>(
        &self,
        item: usize,
        memory: &mut Memory<T>,
        target: ImageView<'_, T, N>,
        loss: PixelLoss,
        backward: bool,
    ) -> Result<T, StepError> {
        let Memory { drawing, grad, renderer, .. } = memory;
        let value = if backward {
            grad.reset(drawing);
            self.renderer.loss_and_grad(drawing, target, loss, renderer, grad)
        } else {
            self.renderer.loss(drawing, target, loss, renderer)
        };
        value.map_err(|source| StepError::Render { item, source })
    }

    fn lend(&self) -> Lent<'_, T> {
        let own = self.memory.lock().unwrap_or_else(PoisonError::into_inner).pop();
        Lent { own: own.unwrap_or_default(), home: &self.memory }
    }

    /// How outlines are drawn: those of vertices as they are.
    fn how(&self) -> Flattening<'_, T> {
        Flattening::new(&self.basis, T::of(OUTLINE_TOLERANCE))
    }

    /// Takes an item's numbers as a scene and draws it.
    fn draw(&self, item: usize, input: &[T], scene: &mut Scene<T>, drawing: &mut Drawing<T>) -> Result<(), StepError> {
        let (shapes, rest) = input.split_at(self.objects * self.shapes.numbers());
        let (poses, rest) = rest.split_at(self.objects * 4);
        let (colors, rest) = rest.split_at(self.objects * CHANNELS);
        let (confidences, background) = rest.split_at(self.objects);
        scene.background.copy_from_slice(background);
        scene.objects.clear();
        let poses = poses.as_chunks().0.iter().zip(colors.as_chunks().0).zip(confidences);
        for (numbers, ((&[x, y, scale, rotation], &color), &confidence)) in
            shapes.chunks_exact(self.shapes.numbers().max(1)).zip(poses)
        {
            let pose = Pose { translation: [x, y], scale, rotation };
            scene.objects.push(Object { shape: self.shape(numbers), pose, paint: color.into(), confidence });
        }
        scene.draw(self.how(), drawing).map_err(|source| StepError::Shape { item, source })
    }

    fn shape(&self, numbers: &[T]) -> AnyShape<T> {
        match &self.shapes {
            Shapes::Efd(_) => AnyShape::of_efd(Efd::new(numbers.as_chunks().0.to_vec()), None),
            Shapes::Rings(lengths) => {
                let mut rest = numbers.as_chunks().0;
                let ring = |&length: &usize| {
                    let (ring, others) = rest.split_at(length);
                    rest = others;
                    ring.to_vec()
                };
                Polygon { rings: lengths.iter().map(ring).collect() }.into()
            }
        }
    }

    /// The gradient of a drawing in the layout of an item.
    fn pull(
        &self,
        item: usize,
        scene: &Scene<T>,
        grad: &DrawingGrad<T>,
        scene_grad: &mut SceneGrad<T>,
        own: &mut [T],
    ) -> Result<(), StepError> {
        scene_grad.reset(scene);
        scene.draw_vjp(self.how(), grad, scene_grad).map_err(|source| StepError::Shape { item, source })?;
        let (shapes, rest) = own.split_at_mut(self.objects * self.shapes.numbers());
        let (poses, rest) = rest.split_at_mut(self.objects * 4);
        let (colors, rest) = rest.split_at_mut(self.objects * CHANNELS);
        let (confidences, background) = rest.split_at_mut(self.objects);
        background.copy_from_slice(&scene_grad.background);
        let width = self.shapes.numbers();
        for (k, ObjectGrad { translation: [x, y], scale, rotation, color, confidence, numbers, ramp: _ }) in
            scene_grad.objects.iter().enumerate()
        {
            shapes[k * width..][..width].copy_from_slice(numbers);
            poses[4 * k..][..4].copy_from_slice(&[*x, *y, *scale, *rotation]);
            colors[CHANNELS * k..][..CHANNELS].copy_from_slice(color);
            confidences[k] = *confidence;
        }
        Ok(())
    }
}

/// Does `one` of all items with the memory of its thread; the first error in order of items. A single item, and all items of a
/// single thread, stay on the caller's, for which no other has to be woken.
fn all<I: Send, M>(
    items: Vec<I>,
    memory: impl Fn() -> M + Sync + Send,
    one: impl Fn(&mut M, I) -> Result<(), StepError> + Sync + Send,
) -> Result<(), StepError> {
    if items.len() < 2 || rayon::current_num_threads() == 1 {
        let mut memory = memory();
        return items.into_iter().try_for_each(|item| one(&mut memory, item));
    }
    let done: Vec<Result<(), StepError>> = items.into_par_iter().map_init(memory, one).collect();
    done.into_iter().collect()
}
