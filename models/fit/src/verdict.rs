//! Whether a fit doubts itself: its covariance, ambiguities, stop reason, objects and unexplained rest as yes or no.

use alloc::vec::Vec;
use core::f64::consts::PI;

use dvp_core::image::distance;
use dvp_core::render::Compositing;
use dvp_core::{Efd, Object, Real, Scene};

use crate::tuning::{FAINT_OBJECT, IDLE_SHARE, ONE_COLOR, UNEXPLAINED_SHARE, WIDE_POSITION, WIDE_SIZE};
use crate::{Ambiguity, Fit, StopReason};

/// What a fit says against itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Doubts {
    /// A position or a size is uncertain: either alone may bring the object below an IoU of 0.9.
    pub pose: bool,
    /// An object is cropped, hidden in part, merged with another one, or may have another shape. Symmetry alone is no doubt.
    pub ambiguity: bool,
    /// The optimization stopped before it was done, the picture is not flat, or no scene is better than one flat color. Descents by Adam take all their steps, and
    /// say nothing by it.
    pub stop: bool,
    /// More than a hundredth of the picture's variance is explained neither by the scene nor by noise.
    pub unexplained: bool,
    /// There may be one object fewer: the marginal gain of one is below a thousandth, or it touches another of its
    /// color, or, where overlaps blend, has the mean color of two that it touches and that touch each other.
    pub redundant: bool,
    /// The color of an object is less than five steps of 8 bits from that of the background.
    pub faint: bool,
}

impl Doubts {
    /// Every doubt with its name.
    #[must_use]
    pub fn named(self) -> [(&'static str, bool); 6] {
        [
            ("pose", self.pose),
            ("ambiguity", self.ambiguity),
            ("stop", self.stop),
            ("unexplained", self.unexplained),
            ("redundant", self.redundant),
            ("faint", self.faint),
        ]
    }

    /// Whether there is one.
    #[must_use]
    pub fn any(self) -> bool {
        self.named().iter().any(|&(_, is)| is)
    }
}

impl<T: Real> Fit<T> {
    /// What the fit says against itself, as yes or no. `dvp stability` counts how often it is right.
    #[must_use]
    pub fn doubts(&self) -> Doubts {
        let is_wide = |(block, object): (&[T; 25], &Object<T>)| {
            let [x, y, size] = [0, 6, 12].map(|k| block[k].as_f64().max(0.0));
            let radius = squared_radius(object);
            // Only descriptors tell a radius here.
            let is_loose = radius > 0.0 && x.max(y) > WIDE_POSITION * WIDE_POSITION * radius;
            is_loose || size > WIDE_SIZE * WIDE_SIZE
        };
        let is_open = |ambiguity: &Ambiguity| !matches!(ambiguity, Ambiguity::Symmetry { .. });
        let is_faint = |object: &Object<T>| distance(object.color(), self.scene.background) < T::of(FAINT_OBJECT);
        Doubts {
            pose: self.covariance.iter().zip(&self.scene.objects).any(is_wide),
            ambiguity: self.ambiguity.iter().any(is_open),
            stop: match self.stop {
                StopReason::Converged | StopReason::Empty => false,
                StopReason::StepLimit => !self.covariance.is_empty(),
                StopReason::Stalled | StopReason::NotFlat | StopReason::NoBetterThanFlat => true,
            },
            unexplained: self.unexplained > UNEXPLAINED_SHARE,
            redundant: self.marginal_gain.iter().any(|&share| share < IDLE_SHARE) || may_be_fewer(&self.scene),
            faint: self.scene.objects.iter().any(is_faint),
        }
    }
}

/// Squared radius of the disk that is as large as an object, scene units.
fn squared_radius<T: Real>(object: &Object<T>) -> f64 {
    let scale = object.pose.scale.as_f64();
    scale * scale * object.shape.efd().map_or(T::zero(), Efd::signed_area).as_f64().abs() / PI
}

/// Whether two objects may be one, or one what two others show where they overlap.
fn may_be_fewer<T: Real>(scene: &Scene<T>) -> bool {
    let objects = &scene.objects;
    let radii: Vec<T> = objects.iter().map(|object| T::of(squared_radius(object)).sqrt()).collect();
    let pairs = || (0..objects.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
    let touch = |a: usize, b: usize| {
        let [p, q] = [a, b].map(|k| objects[k].pose.translation);
        (p[0] - q[0]).hypot(p[1] - q[1]) < radii[a] + radii[b]
    };
    let is_like = |k: usize, color: [T; 3]| distance(objects[k].color(), color) < T::of(ONE_COLOR);
    let mean =
        |a: usize, b: usize| core::array::from_fn(|c| T::of(0.5) * (objects[a].color()[c] + objects[b].color()[c]));
    let is_overlap = |a: usize, b: usize| {
        let own = mean(a, b);
        (0..objects.len()).any(|k| k != a && k != b && touch(a, k) && touch(k, b) && is_like(k, own))
    };
    pairs().any(|(a, b)| {
        touch(a, b) && (is_like(a, objects[b].color()) || scene.compositing == Compositing::Blend && is_overlap(a, b))
    })
}
