//! A scene as one flat vector, and back: what the optimizers of the paper move.
//!
//! In: a scene and the gradient of a loss with respect to it. Out: the vector and its gradient; after a step, the scene
//! again, made admissible. Layout: background (3); then per object translation (2), scale, rotation pair (sine,
//! cosine), color (3) and, if shapes are free, the descriptors row by row. Confidences are not moved.
//!
//! | file | |
//! |---|---|
//! | `renormalize` | descriptors back to A_1 = 1, C_1 = 0, the pose taking up what they lose |
//!
//! Proved by `tests/property/optim.rs` and `tests/gradient/optim.rs`.

mod renormalize;
#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use dvp_core::scene::{ObjectGrad, rotation_from_pair, rotation_from_pair_vjp};
use dvp_core::{Object, Real, Scene, SceneGrad};

pub use renormalize::renormalize;

/// Smallest scale an object is allowed, scene units: at 0 every gradient of the shape is 0, below it the outline is
/// reflected. An eighth of a pixel at 128 pixels.
pub const MIN_SCALE: f64 = 1e-3;

const BACKGROUND: usize = 3;
const POSE_AND_COLOR: usize = 8;

/// Which parameters move.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Free {
    /// Background, translation, scale, rotation, color.
    PoseAndColor,
    /// These and the descriptors of every shape.
    PoseColorAndShape,
}

/// The vector of a scene and the gradient of the same layout.
#[derive(Clone, Debug)]
pub struct Parameters<T> {
    free: Free,
    values: Vec<T>,
    gradient: Vec<T>,
}

impl<T: Real> Parameters<T> {
    /// An empty vector with room for nothing; [`Self::load`] fills it.
    #[must_use]
    pub fn new() -> Self {
        Self { free: Free::PoseAndColor, values: Vec::new(), gradient: Vec::new() }
    }

    /// Takes the values of `scene`; allocates only if it is larger than any before. The pair starts at unit length.
    pub fn load(&mut self, scene: &Scene<T>, free: Free) {
        self.free = free;
        self.values.clear();
        self.values.extend_from_slice(&scene.background);
        for object in &scene.objects {
            let (sin, cos) = object.pose.rotation.sin_cos();
            self.values.extend_from_slice(&object.pose.translation);
            self.values.extend_from_slice(&[object.pose.scale, sin, cos]);
            self.values.extend_from_slice(&object.color());
            if free == Free::PoseColorAndShape {
                self.values.extend_from_slice(object.efd_rows().as_flattened());
            }
        }
        self.gradient.clear();
        self.gradient.resize(self.values.len(), T::zero());
    }

    /// Replaces the gradient by that of the scene, pulled back through the rotation pair.
    ///
    /// *Dimensions*: `grad` in the layout of the scene last loaded; what it lacks keeps its old gradient.
    pub fn pull_back(&mut self, grad: &SceneGrad<T>) {
        let (background, mut rest) = self.gradient.split_at_mut(BACKGROUND);
        background.copy_from_slice(&grad.background);
        let mut values = &self.values[BACKGROUND..];
        for object in &grad.objects {
            let len = object_len(self.free, object.efd_rows().len());
            let (Some((slot, tail)), Some((value, value_tail))) =
                (rest.split_at_mut_checked(len), values.split_at_checked(len))
            else {
                return;
            };
            pull_back_object(object, value, slot);
            (rest, values) = (tail, value_tail);
        }
    }

    /// Makes the values admissible: colors into \[0, 1\], scales to at least [`MIN_SCALE`], descriptors to unit size by
    /// [`renormalize`]. `scene`, the one last loaded, tells the numbers of harmonics. Allocates nothing.
    pub fn settle(&mut self, scene: &Scene<T>) {
        let (background, mut rest) = self.values.split_at_mut(BACKGROUND);
        into_unit(background);
        for object in &scene.objects {
            let len = object_len(self.free, object.efd_rows().len());
            let Some((slot, tail)) = rest.split_at_mut_checked(len) else {
                return;
            };
            settle_object(slot);
            rest = tail;
        }
    }

    /// Writes the values to `scene`, the one last loaded or its like. Allocates nothing.
    pub fn store(&self, scene: &mut Scene<T>) {
        let (background, mut rest) = self.values.split_at(BACKGROUND);
        scene.background.copy_from_slice(background);
        for object in &mut scene.objects {
            let len = object_len(self.free, object.efd_rows().len());
            let Some((slot, tail)) = rest.split_at_checked(len) else {
                return;
            };
            store_object(slot, object);
            rest = tail;
        }
    }

    /// The vector.
    #[must_use]
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// The gradient last pulled back.
    #[must_use]
    pub fn gradient(&self) -> &[T] {
        &self.gradient
    }

    /// The vector to write to and its gradient.
    #[must_use]
    pub fn values_and_gradient(&mut self) -> (&mut [T], &[T]) {
        (&mut self.values, &self.gradient)
    }
}

impl<T: Real> Default for Parameters<T> {
    fn default() -> Self {
        Self::new()
    }
}

fn object_len(free: Free, harmonic_count: usize) -> usize {
    match free {
        Free::PoseAndColor => POSE_AND_COLOR,
        Free::PoseColorAndShape => POSE_AND_COLOR + 4 * harmonic_count,
    }
}

fn pull_back_object<T: Real>(grad: &ObjectGrad<T>, values: &[T], slot: &mut [T]) {
    let mut pair = [T::zero(); 2];
    rotation_from_pair_vjp([values[3], values[4]], grad.rotation, &mut pair);
    slot[..2].copy_from_slice(&grad.translation);
    slot[2] = grad.scale;
    slot[3..5].copy_from_slice(&pair);
    slot[5..POSE_AND_COLOR].copy_from_slice(&grad.color);
    if slot.len() > POSE_AND_COLOR {
        slot[POSE_AND_COLOR..].copy_from_slice(grad.efd_rows().as_flattened());
    }
}

fn settle_object<T: Real>(slot: &mut [T]) {
    // A comparison, not a maximum, for the same reason as in `into_unit`.
    if slot[2] < T::of(MIN_SCALE) {
        slot[2] = T::of(MIN_SCALE);
    }
    into_unit(&mut slot[5..POSE_AND_COLOR]);
    let (head, shape) = slot.split_at_mut(POSE_AND_COLOR);
    let (rows, _) = shape.as_chunks_mut::<4>();
    if !rows.is_empty() {
        let (sin, cos) = renormalize(rows, &mut head[2]).sin_cos();
        (head[3], head[4]) = (head[3] * cos + head[4] * sin, head[4] * cos - head[3] * sin);
    }
}

fn store_object<T: Real>(slot: &[T], object: &mut Object<T>) {
    object.pose.translation.copy_from_slice(&slot[..2]);
    object.pose.scale = slot[2];
    object.pose.rotation = rotation_from_pair([slot[3], slot[4]]);
    object.paint.set_color([slot[5], slot[6], slot[7]]);
    if slot.len() > POSE_AND_COLOR
        && let Some(efd) = object.shape.efd_mut()
    {
        efd.rows_mut().as_flattened_mut().copy_from_slice(&slot[POSE_AND_COLOR..]);
    }
}

// NaN stays NaN, so that the renderer reports it.
fn into_unit<T: Real>(colors: &mut [T]) {
    for value in colors {
        *value = num_traits::clamp(*value, T::zero(), T::one());
    }
}
