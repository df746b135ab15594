//! Scenes: a background and objects, and the drawing (posed outlines with colors) that renderers take.
//!
//! | file | forward | backward |
//! |---|---|---|
//! | `pose` | unit outline to scene units, [`Pose::transform`]; (sin, cos) pair to angle | `pose_vjp` |
//! | `pose_op` | poses as a step of a batch, [`PoseOp`] | same file |
//! | `edge` | how coverage falls off, [`EdgeProfile`] | |
//! | `compositing` | how objects mix, [`Compositing`] | |
//! | `draw` | scene to drawing, [`Scene::draw`] | `draw_vjp`, [`Scene::draw_vjp`] |

mod compositing;
mod draw;
mod draw_vjp;
mod edge;
mod pose;
mod pose_op;
mod pose_vjp;
#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use crate::real::Real;
use crate::shape::Efd;

pub use compositing::Compositing;
pub use edge::{EdgeLaw, EdgeProfile, PixelProfile};
pub use pose::rotation_from_pair;
pub use pose_op::PoseOp;
pub use pose_vjp::{PoseGrad, rotation_from_pair_vjp};

/// Where a unit outline stands: v' = scale R(rotation) v + translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<T> {
    /// Center, scene units (the shorter image side is 1).
    pub translation: [T; 2],
    /// Scene units per unit of the outline.
    pub scale: T,
    /// Radians; R = [[cos, -sin], [sin, cos]] with y down.
    pub rotation: T,
}

/// One flat object.
#[derive(Clone, Debug, PartialEq)]
pub struct Object<T> {
    /// Position, size and angle.
    pub pose: Pose<T>,
    /// RGB, [0, 1].
    pub color: [T; 3],
    /// Probability of being there, and opacity; [0, 1].
    pub confidence: T,
    /// Shape of the unit outline.
    pub efd: Efd<T>,
    /// Index into the bank the shape was taken from.
    pub prototype: Option<usize>,
}

/// A background, objects, and how they are painted.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene<T> {
    /// RGB, [0, 1].
    pub background: [T; 3],
    /// Under `over` compositing later objects hide earlier ones; under `blend` the order has no effect.
    pub objects: Vec<Object<T>>,
    /// How coverage falls off at an outline.
    pub edge: EdgeProfile<T>,
    /// How overlapping objects mix.
    pub compositing: Compositing,
}

/// Gradient of a scalar with respect to one [`Object`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjectGrad<T> {
    /// With respect to `pose.translation`.
    pub translation: [T; 2],
    /// With respect to `pose.scale`.
    pub scale: T,
    /// With respect to `pose.rotation`, per radian.
    pub rotation: T,
    /// With respect to `color`.
    pub color: [T; 3],
    /// With respect to `confidence`.
    pub confidence: T,
    /// With respect to `efd`, row by row.
    pub efd: Vec<[T; 4]>,
}

/// Gradient of a scalar with respect to a [`Scene`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneGrad<T> {
    /// With respect to `background`.
    pub background: [T; 3],
    /// Object by object.
    pub objects: Vec<ObjectGrad<T>>,
}

/// What a renderer paints: closed polygons in scene units with color and confidence.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing<T> {
    /// RGB, [0, 1].
    pub background: [T; 3],
    /// The outlines one after the other, scene units.
    pub vertices: Vec<[T; 2]>,
    /// Object k owns `vertices[starts[k]..starts[k + 1]]`; one longer than the number of objects (empty: no objects).
    pub starts: Vec<usize>,
    /// RGB per object.
    pub colors: Vec<[T; 3]>,
    /// Per object, [0, 1].
    pub confidences: Vec<T>,
}

/// Gradient of a scalar with respect to a [`Drawing`]; same layout.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DrawingGrad<T> {
    /// With respect to `background`.
    pub background: [T; 3],
    /// With respect to `vertices`.
    pub vertices: Vec<[T; 2]>,
    /// With respect to `colors`.
    pub colors: Vec<[T; 3]>,
    /// With respect to `confidences`.
    pub confidences: Vec<T>,
}

impl<T: Real> Scene<T> {
    /// A background without objects, in the reference system's edge profile and compositing.
    #[must_use]
    pub fn empty(background: [T; 3]) -> Self {
        Self { background, objects: Vec::new(), edge: EdgeProfile::reference(), compositing: Compositing::default() }
    }

    /// Rounds confidences: objects of more than 1/2 are there, the others are taken out.
    pub fn keep_visible(&mut self) {
        self.objects.retain(|object| object.confidence > T::of(0.5));
        self.objects.iter_mut().for_each(|object| object.confidence = T::one());
    }
}

impl<T: Real> SceneGrad<T> {
    /// Zeros in the layout of `scene`; keeps the memory.
    pub fn reset(&mut self, scene: &Scene<T>) {
        let zero = T::zero();
        self.background = [zero; 3];
        self.objects.resize(scene.objects.len(), ObjectGrad::default());
        for (grad, object) in self.objects.iter_mut().zip(&scene.objects) {
            let mut efd = core::mem::take(&mut grad.efd);
            efd.clear();
            efd.resize(object.efd.harmonic_count(), [zero; 4]);
            *grad = ObjectGrad { efd, ..ObjectGrad::default() };
        }
    }
}

impl<T: Real> Drawing<T> {
    /// Number of objects.
    #[must_use]
    pub fn object_count(&self) -> usize {
        self.colors.len()
    }

    /// The outline of object `k`, scene units.
    ///
    /// # Panics
    /// If there is no object `k`.
    #[must_use]
    pub fn outline(&self, k: usize) -> &[[T; 2]] {
        &self.vertices[self.starts[k]..self.starts[k + 1]]
    }

    /// Removes everything, keeps the memory.
    pub fn clear(&mut self) {
        self.background = [T::zero(); 3];
        self.vertices.clear();
        self.starts.clear();
        self.starts.push(0);
        self.colors.clear();
        self.confidences.clear();
    }

    /// Appends an object.
    pub fn push(&mut self, outline: &[[T; 2]], color: [T; 3], confidence: T) {
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        self.vertices.extend_from_slice(outline);
        self.starts.push(self.vertices.len());
        self.colors.push(color);
        self.confidences.push(confidence);
    }
}

impl<T: Real> DrawingGrad<T> {
    /// Zeros in the layout of `drawing`; keeps the memory.
    pub fn reset(&mut self, drawing: &Drawing<T>) {
        let zero = T::zero();
        self.background = [zero; 3];
        self.vertices.clear();
        self.vertices.resize(drawing.vertices.len(), [zero; 2]);
        self.colors.clear();
        self.colors.resize(drawing.colors.len(), [zero; 3]);
        self.confidences.clear();
        self.confidences.resize(drawing.confidences.len(), zero);
    }
}
