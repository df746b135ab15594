//! Whether a fit doubts itself: what its objects may be off by, its stop reason, their number and the unexplained rest as yes or no.

use alloc::vec::Vec;
use core::f64::consts::PI;

use dvp_core::image::distance;
use dvp_core::render::Compositing;
use dvp_core::{Efd, Object, Real, Scene};

use crate::tuning::{IDLE_SHARE, ONE_COLOR, SURE_IOU, UNEXPLAINED_SHARE};
use crate::{Fit, StopReason};

/// What a fit says against itself: why the picture may not be what the scene says. What it cannot tell though all is well, such as what
/// lies out of the picture or behind something, is in [`Fit::ambiguity`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Doubts {
    /// What is seen of an object may well lie elsewhere: its [expected IoU](Fit::expected_iou) is below 0.95.
    pub pose: bool,
    /// The optimization stopped before it was done, the picture is not flat, or no scene is better than one flat color. Descents by Adam take all their steps, and
    /// say nothing by it.
    pub stop: bool,
    /// More than a hundredth of the picture's variance is explained neither by the scene nor by noise.
    pub unexplained: bool,
    /// There may be one object fewer: the marginal gain of one is below a thousandth, or it touches another of its
    /// color, or, where overlaps blend, has the mean color of two that it touches and that touch each other.
    pub redundant: bool,
}

impl Doubts {
    /// Every doubt with its name.
    #[must_use]
    pub fn named(self) -> [(&'static str, bool); 4] {
        [("pose", self.pose), ("stop", self.stop), ("unexplained", self.unexplained), ("redundant", self.redundant)]
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
        let is_unsure = |&iou: &T| iou < T::of(SURE_IOU);
        Doubts {
            pose: self.expected_iou.iter().any(is_unsure),
            stop: match self.stop {
                StopReason::Converged | StopReason::Empty => false,
                StopReason::StepLimit => !self.covariance.is_empty(),
                StopReason::Stalled | StopReason::NotFlat | StopReason::NoBetterThanFlat => true,
            },
            unexplained: self.unexplained > UNEXPLAINED_SHARE,
            redundant: self.marginal_gain.iter().any(|&share| share < IDLE_SHARE) || may_be_fewer(&self.scene),
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
