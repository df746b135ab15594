//! The prototype and the pose that meet a demand.

use alloc::vec::Vec;
use core::f64::consts::TAU;

use dvp_core::Real;
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES, ShapeError};
use dvp_core::sort;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::demand::{Demand, Verdict};
use crate::Bank;
use crate::pose::field::OutlineField;
use crate::pose::gauss_newton::{Frame, PosePx, wrapped};
use crate::pose::search::Prototype;
use crate::prototypes::Form;

/// Start angles over a full turn; fewer for shapes that look alike after a part of it.
const STARTS: usize = 16;
/// Fewest start angles.
const LEAST_STARTS: usize = 5;
/// Sizes tried of what may go on unseen, relative to what is seen, along one side.
const OPEN_SIZES: [f64; 7] = [1.0, 1.1, 1.22, 1.4, 1.65, 2.0, 2.5];
/// Steps from a start.
const STEPS: usize = 14;
/// Pixels that are wrong as that many hidden ones: of two poses that explain what is seen, the one that hides less is nearer.
const HIDDEN_PER_WRONG: f64 = 50.0;
/// Steps from a pose to others around it: px along both axes, logarithm of the size, radians.
const AROUND: [[f64; 4]; 8] = [
    [0.3, 0.0, 0.0, 0.0],
    [-0.3, 0.0, 0.0, 0.0],
    [0.0, 0.3, 0.0, 0.0],
    [0.0, -0.3, 0.0, 0.0],
    [0.0, 0.0, 0.04, 0.0],
    [0.0, 0.0, -0.04, 0.0],
    [0.0, 0.0, 0.0, 0.06],
    [0.0, 0.0, 0.0, -0.06],
];
/// Forms closer than this (root mean square, radii) are one shape turned.
const SAME_SHAPE: f64 = 0.03;
/// Turns (radians) of copies of one shape that are told apart.
const UPRIGHT: f64 = 0.2;

/// How hard to look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Effort {
    Usual,
    /// More starts, and more of them refined.
    Wide,
}

/// A pose to begin with.
struct Start {
    prototype: usize,
    pose: PosePx<f64>,
    cost: f64,
}

/// Prototypes ready to be searched for.
#[derive(Clone, Debug)]
pub(super) struct Shapes {
    prototypes: Vec<Prototype<f64>>,
    /// Per prototype, the first one that is the same shape, turned or not.
    kinds: Vec<usize>,
}

/// A prototype at a pose, and how it meets its demand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Posed {
    pub(super) prototype: usize,
    pub(super) pose: PosePx<f64>,
    pub(super) verdict: Verdict,
    /// What is wrong between the middles of pixels, px^2.
    cost: f64,
}

impl Shapes {
    /// The shapes of a bank; none if one of them encloses nothing.
    pub(super) fn new<T: Real>(bank: &Bank<T>) -> Result<Option<Self>, ShapeError> {
        let (mut prototypes, mut forms): (Vec<Prototype<f64>>, Vec<Form>) = (Vec::new(), Vec::new());
        let mut kinds = Vec::new();
        for (_, efd) in &bank.prototypes {
            let efd = efd.cast::<f64>();
            let basis = OutlineBasis::<f64>::new(REFERENCE_VERTICES, efd.harmonic_count().max(1))?;
            let (Some(prototype), Ok(form)) = (Prototype::new(&efd, &basis)?, Form::new(&efd)) else {
                return Ok(None);
            };
            let kind = forms.iter().position(|other| other.distance(&form, false) < SAME_SHAPE);
            kinds.push(kind.unwrap_or(forms.len()));
            prototypes.push(prototype);
            forms.push(form);
        }
        Ok(Some(Self { prototypes, kinds }))
    }

    pub(super) fn count(&self) -> usize {
        self.prototypes.len()
    }

    pub(super) fn field(&self, prototype: usize) -> &OutlineField<f64> {
        &self.prototypes[prototype].field
    }

    /// The symmetry order of a prototype; 0: every rotation.
    pub(super) fn symmetry(&self, prototype: usize) -> usize {
        self.prototypes[prototype].symmetry
    }

    /// The outline of a prototype, in its own frame.
    pub(super) fn outline(&self, prototype: usize) -> &[[f64; 2]] {
        &self.prototypes[prototype].outline
    }

    /// The box of a prototype's outline: its least and its largest coordinates.
    pub(super) fn bounds(&self, prototype: usize) -> [[f64; 2]; 2] {
        let vertices = &self.prototypes[prototype].outline;
        let of = |pick: fn(f64, f64) -> f64, start| [0, 1].map(|c| vertices.iter().fold(start, |a, v| pick(a, v[c])));
        [of(f64::min, f64::INFINITY), of(f64::max, f64::NEG_INFINITY)]
    }

    /// The period of the angle of a prototype.
    fn period(&self, prototype: usize) -> f64 {
        TAU / f64::of_usize(self.prototypes[prototype].symmetry.max(1))
    }

    /// The best pose of all prototypes.
    pub(super) fn best(&self, demand: &Demand<'_>, effort: Effort) -> Option<Posed> {
        let (all, each) = match effort {
            Effort::Usual => (16, 3),
            Effort::Wide => (360, 40),
        };
        let mut starts: Vec<Start> = Vec::new();
        for prototype in 0..self.count() {
            let mut own = self.starts(prototype, demand, effort);
            sort::ascending(&mut own, |start| start.cost);
            starts.extend(own.into_iter().take(each));
        }
        sort::ascending(&mut starts, |start| start.cost);
        let mut best: Option<Posed> = None;
        let take = |best: &mut Option<Posed>, next: Posed| {
            if best.as_ref().is_none_or(|best| self.is_better(&next, best)) {
                *best = Some(next);
            }
        };
        for start in starts.into_iter().take(all) {
            take(&mut best, self.refined(start.prototype, start.pose, demand));
            // Nothing is better than all right.
            if best.is_some_and(|best| best.verdict == Verdict { wrong: 0, hidden: 0 }) {
                break;
            }
        }
        // Copies of the shape in other turns: one of them may explain as much without being turned.
        let found = best?;
        let kind = self.kinds[found.prototype];
        for prototype in (0..self.count()).filter(|&other| self.kinds[other] == kind && other != found.prototype) {
            let upright = self.start(prototype, demand, found.pose.log_scale, 0.0, &found);
            take(&mut best, self.refined(prototype, upright, demand));
        }
        best
    }

    /// A pose of another copy of a shape that was found, with the middle of its outline where that of the other is.
    fn start(
        &self,
        prototype: usize,
        demand: &Demand<'_>,
        log_scale: f64,
        rotation: f64,
        found: &Posed,
    ) -> PosePx<f64> {
        let [field, other] = [prototype, found.prototype].map(|prototype| &self.prototypes[prototype].field);
        let size = log_scale.exp() * (other.area / field.area).sqrt();
        let middle = Frame::new(&found.pose).to_pixels(other.centroid);
        let middle = if demand.is_open() { middle } else { demand.center };
        let (sin, cos) = rotation.sin_cos();
        let [x, y] = field.centroid.map(|v| v * size);
        let translation = [middle[0] - (cos * x - sin * y), middle[1] - (sin * x + cos * y)];
        PosePx { translation, log_scale: size.ln(), rotation }
    }

    /// Whether `a` explains more than `b`. Of copies of one shape in several turns the one that need not be turned does.
    fn is_better(&self, a: &Posed, b: &Posed) -> bool {
        let wrong =
            |posed: &Posed| f64::of_usize(posed.verdict.wrong) + f64::of_usize(posed.verdict.hidden) / HIDDEN_PER_WRONG;
        if self.kinds[a.prototype] == self.kinds[b.prototype] && a.prototype != b.prototype {
            let turned = |posed: &Posed| wrapped(posed.pose.rotation, self.period(posed.prototype)).abs() > UPRIGHT;
            let near = a.verdict.wrong.abs_diff(b.verdict.wrong) <= 2;
            if near && turned(a) != turned(b) {
                return turned(b);
            }
        }
        (wrong(a), a.cost) < (wrong(b), b.cost)
    }

    /// Poses of a prototype that may meet a demand.
    fn starts(&self, prototype: usize, demand: &Demand<'_>, effort: Effort) -> Vec<Start> {
        let Prototype { field, symmetry, .. } = &self.prototypes[prototype];
        let scale = (demand.area / field.area).sqrt();
        let radius = (demand.area / core::f64::consts::PI).sqrt();
        let sizes = if demand.is_open() { &OPEN_SIZES[..] } else { &OPEN_SIZES[..1] };
        let starts = if effort == Effort::Wide { 2 * STARTS } else { STARTS };
        let angles = if *symmetry == 0 { 1 } else { (starts / symmetry).max(LEAST_STARTS) };
        // What is hidden lies beyond what is seen, and mostly where something else is seen beside it.
        let ways: &[f64] = match (demand.is_open(), effort) {
            (true, Effort::Wide) => &[0.0, 0.6, 1.0, 1.4],
            (true, Effort::Usual) => &[1.0],
            (false, _) => &[0.0],
        };
        let mut found: Vec<Start> = Vec::new();
        for &size in sizes {
            for angle in 0..angles {
                let rotation = self.period(prototype) * f64::of_usize(angle) / f64::of_usize(angles);
                let scale = scale * size;
                let (sin, cos) = rotation.sin_cos();
                let [x, y] = field.centroid.map(|v| v * scale);
                for way in ways {
                    let beyond = demand.onward.map(|v| way * v * (size - 1.0) * radius);
                    let translation = [
                        demand.center[0] + beyond[0] - (cos * x - sin * y),
                        demand.center[1] + beyond[1] - (sin * x + cos * y),
                    ];
                    let pose = PosePx { translation, log_scale: scale.ln(), rotation };
                    found.push(Start { prototype, pose, cost: demand.cost(&pose, field) });
                }
            }
        }
        found
    }

    /// The pose near `posed` that meets a demand best, looked for from several sides: where least is wrong between the middles of pixels,
    /// some may be wrong that need not be.
    pub(super) fn settled(&self, posed: Posed, demand: &Demand<'_>) -> Posed {
        let field = &self.prototypes[posed.prototype].field;
        let mut best = Posed { verdict: demand.judge(&posed.pose, field), ..posed };
        let next = self.refined(posed.prototype, posed.pose, demand);
        if self.is_better(&next, &best) {
            best = next;
        }
        for [x, y, size, turn] in AROUND {
            if best.verdict.wrong == 0 {
                break;
            }
            let PosePx { translation, log_scale, rotation } = best.pose;
            let pose = PosePx {
                translation: [translation[0] + x, translation[1] + y],
                log_scale: log_scale + size,
                rotation: rotation + turn,
            };
            let next = self.refined(best.prototype, pose, demand);
            if self.is_better(&next, &best) {
                best = next;
            }
        }
        best
    }

    /// The pose near a start.
    pub(super) fn refined(&self, prototype: usize, pose: PosePx<f64>, demand: &Demand<'_>) -> Posed {
        let field = &self.prototypes[prototype].field;
        let (pose, cost) = demand.refined(pose, field, STEPS);
        Posed { prototype, pose, verdict: demand.judge(&pose, field), cost }
    }
}
