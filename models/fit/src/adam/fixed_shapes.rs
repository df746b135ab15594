//! Drawings of a scene whose shapes stay: the unit outlines are sampled once, a step only poses them.

use alloc::vec::Vec;

use dvp_core::scene::PoseGrad;
use dvp_core::shape::{OutlineBasis, ShapeError};
use dvp_core::{Drawing, DrawingGrad, Real, Scene, SceneGrad};

/// Unit outlines of the objects of a scene, one after the other.
#[derive(Clone, Debug, Default)]
pub struct FixedShapes<T> {
    units: Vec<[T; 2]>,
    // The gradient of a unit outline, which nobody asks for.
    unused: Vec<[T; 2]>,
}

impl<T: Real> FixedShapes<T> {
    /// Samples the shapes of `scene`; allocates only if there are more than ever before.
    ///
    /// # Errors
    /// [`ShapeError::TooManyHarmonics`] if an object has more harmonics than `basis`.
    pub fn sample(&mut self, scene: &Scene<T>, basis: &OutlineBasis<T>) -> Result<(), ShapeError> {
        let zero = [T::zero(); 2];
        self.units.clear();
        self.units.resize(scene.objects.len() * basis.vertex_count(), zero);
        self.unused.clear();
        self.unused.resize(basis.vertex_count(), zero);
        for (object, unit) in scene.objects.iter().zip(self.units.chunks_exact_mut(basis.vertex_count())) {
            basis.outline(object.shape.descriptors()?.rows(), unit)?;
        }
        Ok(())
    }

    /// What [`Scene::draw`] draws, as long as the shapes are those sampled. Allocates nothing once `drawing` has held one
    /// of this size. *Derivative*: [`Self::draw_vjp`].
    pub fn draw(&self, scene: &Scene<T>, drawing: &mut Drawing<T>) {
        drawing.clear();
        drawing.background = scene.background;
        for (object, unit) in scene.objects.iter().zip(self.units.chunks_exact(self.unused.len().max(1))) {
            let first = drawing.vertices.len();
            drawing.push(unit, object.color(), object.confidence);
            object.pose.transform(&mut drawing.vertices[first..]);
        }
    }

    /// What [`Scene::draw_vjp`] adds to `grad`, but for the descriptors. Allocates nothing.
    ///
    /// *Dimensions*: the gradients in the layouts of the scene and its drawing; objects beyond the shortest are left out.
    pub fn draw_vjp(&mut self, scene: &Scene<T>, grad_drawing: &DrawingGrad<T>, grad: &mut SceneGrad<T>) {
        let vertex_count = self.unused.len().max(1);
        add(&mut grad.background, grad_drawing.background);
        let units = self.units.chunks_exact(vertex_count).zip(grad_drawing.vertices.chunks_exact(vertex_count));
        let paint = grad_drawing.colors.iter().zip(&grad_drawing.confidences);
        let objects = scene.objects.iter().zip(&mut grad.objects);
        for (((object, grad), (unit, grad_outline)), (&color, &confidence)) in objects.zip(units).zip(paint) {
            let mut pose = PoseGrad::default();
            object.pose.transform_vjp(unit, grad_outline, &mut pose, &mut self.unused);
            add(&mut grad.translation, pose.translation);
            grad.scale += pose.scale;
            grad.rotation += pose.rotation;
            add(&mut grad.color, color);
            grad.confidence += confidence;
        }
    }
}

fn add<T: Real, const N: usize>(sums: &mut [T; N], values: [T; N]) {
    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
}
