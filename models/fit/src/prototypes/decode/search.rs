//! The prototype and the pose that meet a demand.

use alloc::vec::Vec;
use core::f64::consts::TAU;

use dvp_core::Real;
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES, ShapeError};

use super::demand::{Demand, Verdict};
use crate::Bank;
use crate::pose::field::OutlineField;
use crate::pose::gauss_newton::{PosePx, wrapped};
use crate::pose::search::Prototype;
use crate::prototypes::Form;

/// Start angles over a full turn; fewer for shapes that look alike after a part of it.
const STARTS: usize = 16;
/// Fewest start angles.
const LEAST_STARTS: usize = 5;
/// Sizes tried of what may go on unseen, relative to what is seen, along one side.
const OPEN_SIZES: [f64; 6] = [1.0, 1.1, 1.22, 1.4, 1.7, 2.2];
/// Starts of each prototype that are refined.
const KEPT: usize = 4;
/// Steps from a start.
const STEPS: usize = 14;
/// Pixels that are wrong as that many hidden ones: of two poses that explain what is seen, the one that hides less is nearer.
const HIDDEN_PER_WRONG: f64 = 50.0;
/// Forms closer than this (root mean square, radii) are one shape turned.
const SAME_SHAPE: f64 = 0.03;
/// Turns (radians) of copies of one shape that are told apart.
const UPRIGHT: f64 = 0.2;

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
    pub(super) fn best(&self, demand: &Demand<'_>) -> Option<Posed> {
        let posed = (0..self.count()).flat_map(|prototype| self.posed(prototype, demand));
        posed.reduce(|best, next| if self.is_better(&next, &best) { next } else { best })
    }

    /// Whether `a` explains more than `b`. Of copies of one shape in several turns the one that need not be turned does.
    fn is_better(&self, a: &Posed, b: &Posed) -> bool {
        let wrong = |posed: &Posed| {
            f64::of_usize(posed.verdict.wrong) + f64::of_usize(posed.verdict.hidden) / HIDDEN_PER_WRONG
        };
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
    fn posed(&self, prototype: usize, demand: &Demand<'_>) -> Vec<Posed> {
        let Prototype { field, symmetry, .. } = &self.prototypes[prototype];
        let scale = (demand.area / field.area).sqrt();
        let radius = (demand.area / core::f64::consts::PI).sqrt();
        let sizes = if demand.is_open() { &OPEN_SIZES[..] } else { &OPEN_SIZES[..1] };
        let angles = if *symmetry == 0 { 1 } else { (STARTS / symmetry).max(LEAST_STARTS) };
        let mut starts: Vec<(f64, PosePx<f64>)> = Vec::new();
        for &size in sizes {
            for angle in 0..angles {
                let rotation = self.period(prototype) * f64::of_usize(angle) / f64::of_usize(angles);
                let scale = scale * size;
                let (sin, cos) = rotation.sin_cos();
                let [x, y] = field.centroid.map(|v| v * scale);
                // What is hidden lies beyond what is seen.
                let beyond = demand.onward.map(|v| v * (size - 1.0) * radius);
                let translation = [
                    demand.center[0] + beyond[0] - (cos * x - sin * y),
                    demand.center[1] + beyond[1] - (sin * x + cos * y),
                ];
                let pose = PosePx { translation, log_scale: scale.ln(), rotation };
                starts.push((demand.cost(&pose, field), pose));
            }
        }
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        let refined = starts.into_iter().take(KEPT).map(|(_, pose)| self.refined(prototype, pose, demand));
        refined.collect()
    }

    /// The pose near a start.
    pub(super) fn refined(&self, prototype: usize, pose: PosePx<f64>, demand: &Demand<'_>) -> Posed {
        let field = &self.prototypes[prototype].field;
        let (pose, cost) = demand.refined(pose, field, STEPS);
        Posed { prototype, pose, verdict: demand.judge(&pose, field), cost }
    }
}
