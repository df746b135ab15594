//! Scenes: a background and objects, and the drawing (posed outlines with colors) that renderers take.
//!
//! | file | forward | backward |
//! |---|---|---|
//! | `pose` | unit outline to scene units, [`Pose::transform`]; (sin, cos) pair to angle | `pose_vjp` |
//! | `pose_op` | poses as a step of a batch, [`PoseOp`] | same file |
//! | `edge` | how coverage falls off, [`EdgeProfile`] | |
//! | `compositing` | how objects mix, [`Compositing`] | same file, [`Compositing::slopes`] |
//! | `paint` | flat colors, and what moves a color, [`Paint`] | |
//! | `ramp` | colors that change from place to place, [`ColorRamp`] | same file, and the renderers' |
//! | `cast` | scenes in another precision, [`Scene::cast`] | |
//! | `region` | what shapes have in common or not, [`Region`] | |
//! | `draw` | scene to drawing, [`Scene::draw`] | `draw_vjp`, [`Scene::draw_vjp`] |

mod cast;
mod compositing;
mod draw;
mod draw_vjp;
mod edge;
mod paint;
mod pose;
mod pose_op;
mod pose_vjp;
mod ramp;
mod region;
#[cfg(test)]
mod tests;

use alloc::vec::Vec;
use core::ops::Range;

use crate::real::Real;
use crate::shape::{AnyShape, Efd, Rings, Shape as _};

pub use compositing::{Compositing, Layer};
pub use edge::{EdgeLaw, EdgeProfile, PixelProfile};
pub use paint::Paint;
pub use pose::rotation_from_pair;
pub use pose_op::PoseOp;
pub use pose_vjp::{PoseGrad, rotation_from_pair_vjp};
pub(crate) use ramp::{Between, RampRows, between, color_at};
pub use ramp::{ColorRamp, ColorStop, RampKind};
pub use region::{Placed, Region};

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

/// One object: a shape, where it stands, what it is filled with.
#[derive(Clone, Debug, PartialEq)]
pub struct Object<T> {
    /// What it encloses, in its own frame.
    pub shape: AnyShape<T>,
    /// Position, size and angle.
    pub pose: Pose<T>,
    /// What it is filled with.
    pub paint: Paint<T>,
    /// Probability of being there, and opacity; [0, 1].
    pub confidence: T,
}

/// A background, objects, and how they are painted.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene<T> {
    /// RGB, [0, 1]. Of a transparent scene: what it is shown on where an image has no alpha.
    pub background: [T; 3],
    /// Whether there is nothing behind the objects: images with alpha are clear there.
    pub transparent: bool,
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
    /// With respect to [`Object::color`]: of a ramp, to a color that is added to all of its stops.
    pub color: [T; 3],
    /// With respect to the ramp, where the paint is one; in the object's frame.
    pub ramp: Option<ColorRamp<T>>,
    /// With respect to `confidence`.
    pub confidence: T,
    /// With respect to the numbers of `shape`; of descriptors a_1, b_1, c_1, d_1, a_2, ...
    pub numbers: Vec<T>,
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
    /// Where rings begin that are not the first of their object, rising: what an object encloses is what lies inside
    /// of an odd number of its rings.
    pub breaks: Vec<usize>,
    /// RGB per object; not looked at where a ramp paints it.
    pub colors: Vec<[T; 3]>,
    /// Per object, [0, 1].
    pub confidences: Vec<T>,
    /// What paints the objects that have no one color, rising by object.
    pub ramps: Vec<DrawnRamp<T>>,
    /// The stops of all ramps.
    pub stops: Vec<ColorStop<T>>,
}

/// What paints an object of a [`Drawing`] in more than one color.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnRamp<T> {
    /// Which object.
    pub object: usize,
    /// Where the offsets lie, scene units.
    pub kind: RampKind<T>,
    /// Its part of `stops`.
    pub stops: Range<usize>,
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
    /// With respect to the points of `ramps`.
    pub ramps: Vec<RampKind<T>>,
    /// With respect to `stops`.
    pub stops: Vec<ColorStop<T>>,
}

impl<T: Real> Object<T> {
    /// An object made of descriptors, those of a bank's prototype if `prototype` names one.
    #[must_use]
    pub fn of_efd(pose: Pose<T>, color: [T; 3], confidence: T, efd: Efd<T>, prototype: Option<usize>) -> Self {
        Self { shape: AnyShape::of_efd(efd, prototype), pose, paint: Paint::Flat(color), confidence }
    }

    /// The color of a flat paint, RGB, [0, 1]; of a ramp the mean of its stops.
    #[inline]
    #[must_use]
    pub fn color(&self) -> [T; 3] {
        self.paint.color()
    }

    /// Rows (a_n, b_n, c_n, d_n) of the descriptors that the shape is made of; none for shapes of other kinds.
    #[must_use]
    pub fn efd_rows(&self) -> &[[T; 4]] {
        self.shape.efd().map_or(&[], Efd::rows)
    }

    /// Index into the bank that the shape was taken from.
    #[must_use]
    pub fn prototype(&self) -> Option<usize> {
        self.shape.prototype()
    }
}

impl<T> ObjectGrad<T> {
    /// The gradient of descriptors, row by row.
    #[must_use]
    pub fn efd_rows(&self) -> &[[T; 4]] {
        self.numbers.as_chunks().0
    }

    /// The gradient of descriptors, to write to.
    #[must_use]
    pub fn efd_rows_mut(&mut self) -> &mut [[T; 4]] {
        self.numbers.as_chunks_mut().0
    }
}

impl<T: Real> Scene<T> {
    /// A background without objects, in the reference system's edge profile and compositing.
    #[must_use]
    pub fn empty(background: [T; 3]) -> Self {
        Self {
            background,
            transparent: false,
            objects: Vec::new(),
            edge: EdgeProfile::reference(),
            compositing: Compositing::default(),
        }
    }

    /// Most harmonics of an object that is made of descriptors; 0 if there is none.
    #[must_use]
    pub fn harmonic_count(&self) -> usize {
        self.objects.iter().map(|object| object.efd_rows().len()).max().unwrap_or(0)
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
            let mut numbers = core::mem::take(&mut grad.numbers);
            numbers.clear();
            numbers.resize(object.shape.number_count(), zero);
            let ramp = object.paint.ramp().map(ColorRamp::zero);
            *grad = ObjectGrad { numbers, ramp, ..ObjectGrad::default() };
        }
    }
}

impl<T: Real> Drawing<T> {
    /// Number of objects.
    #[must_use]
    pub fn object_count(&self) -> usize {
        self.colors.len()
    }

    /// The vertices of object `k`, of all its rings, scene units.
    ///
    /// # Panics
    /// If there is no object `k`.
    #[must_use]
    pub fn outline(&self, k: usize) -> &[[T; 2]] {
        &self.vertices[self.starts[k]..self.starts[k + 1]]
    }

    /// The rings of object `k`, scene units.
    ///
    /// # Panics
    /// If there is no object `k`.
    #[must_use]
    pub fn rings(&self, k: usize) -> Rings<'_, T> {
        let (first, end) = (self.starts[k], self.starts[k + 1]);
        let from = self.breaks.partition_point(|&start| start <= first);
        let until = from + self.breaks[from..].partition_point(|&start| start < end);
        Rings { vertices: &self.vertices[first..end], breaks: &self.breaks[from..until], first }
    }

    /// Removes everything, keeps the memory.
    pub fn clear(&mut self) {
        self.background = [T::zero(); 3];
        self.vertices.clear();
        self.starts.clear();
        self.starts.push(0);
        self.breaks.clear();
        self.colors.clear();
        self.confidences.clear();
        self.ramps.clear();
        self.stops.clear();
    }

    /// Appends an object of one ring.
    pub fn push(&mut self, outline: &[[T; 2]], color: [T; 3], confidence: T) {
        self.push_rings(Rings::one(outline), color, confidence);
    }

    /// Appends an object of several rings.
    pub fn push_rings(&mut self, rings: Rings<'_, T>, color: [T; 3], confidence: T) {
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        let first = self.vertices.len();
        self.vertices.extend_from_slice(rings.vertices);
        self.breaks.extend(rings.breaks.iter().map(|&start| first + start - rings.first));
        self.starts.push(self.vertices.len());
        self.colors.push(color);
        self.confidences.push(confidence);
    }

    /// Paints the last object with a ramp, its points in scene units; does nothing without an object.
    pub fn paint_last(&mut self, kind: RampKind<T>, stops: &[ColorStop<T>]) {
        let Some(object) = self.object_count().checked_sub(1) else { return };
        let first = self.stops.len();
        self.stops.extend_from_slice(stops);
        self.ramps.push(DrawnRamp { object, kind, stops: first..self.stops.len() });
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
        self.ramps.clear();
        self.ramps.extend(drawing.ramps.iter().map(|ramp| ramp.kind.zero()));
        self.stops.clear();
        self.stops.resize(drawing.stops.len(), ColorStop::default());
    }
}
