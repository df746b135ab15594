//! Joint refinement of all poses and colors by Levenberg-Marquardt on pixels, with analytic Jacobians.
//!
//! In: an image and objects near the truth. Out: the same objects, moved. `assemble` makes the normal equations from the
//! pixels near outlines, [`refine`] takes damped steps, and [`continue_sigma`] does so at softer edges first, which widens the
//! basin from about a pixel to several.

mod assemble;
#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use dvp_core::render::{Compositing, EdgeLaw, EdgeProfile};
use dvp_core::{ImageView, Real};

use crate::StopReason;
use crate::cholesky::{factor, packed, solve};
use crate::pose::gauss_newton::PosePx;
use crate::pose::search::Prototype;

pub(crate) use assemble::JointScratch;

/// Parameters per object: x, y, log scale, rotation, red, green, blue.
pub(crate) const PER_OBJECT: usize = 7;
/// Beyond this many objects the equations of different objects are solved apart.
const MAX_DENSE: usize = 12;

/// One object of the refinement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JointObject<T> {
    /// Index into the shapes of the problem.
    pub(crate) shape: usize,
    pub(crate) pose: PosePx<T>,
    pub(crate) color: [T; 3],
    pub(crate) confidence: T,
}

/// All that is refined.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct JointScene<T> {
    pub(crate) background: [T; 3],
    pub(crate) objects: Vec<JointObject<T>>,
}

/// What does not change while refining.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointProblem<'a, T> {
    pub(crate) image: ImageView<'a, T>,
    pub(crate) shapes: &'a [Prototype<T>],
    pub(crate) edge: EdgeProfile<T>,
    pub(crate) compositing: Compositing,
    /// Whether colors and background move too.
    pub(crate) colors: bool,
    /// Whether wide bands may be looked at on a grid instead of pixel by pixel, and steps end early: for softened edges.
    pub(crate) coarse: bool,
    /// Residual of a channel at which a pixel loses most of its say (Geman-McClure).
    pub(crate) width: T,
}

/// What a refinement did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct JointResult<T> {
    /// Robust sum of squared residuals over the pixels near outlines.
    pub(crate) cost: T,
    pub(crate) steps: usize,
    pub(crate) stop: StopReason,
}

/// Damped steps at the edge profile of the problem.
pub(crate) fn refine<T: Real>(
    problem: &JointProblem<'_, T>,
    scene: &mut JointScene<T>,
    max_steps: usize,
    scratch: &mut JointScratch<T>,
) -> JointResult<T> {
    let n = scene.objects.len() * PER_OBJECT + 3;
    let mut cost = scratch.assemble(problem, scene);
    let mut damping = T::of(1e-3);
    let mut tried = core::mem::take(&mut scratch.tried);
    let mut result = JointResult { cost, steps: 0, stop: StopReason::StepLimit };
    let mut fresh = true;
    let tolerance = T::of(if problem.coarse { 1e-2 } else { 1e-4 });
    while result.steps < max_steps {
        result.steps += 1;
        if !fresh {
            scratch.assemble(problem, scene);
        }
        let solved = scratch.solve(n, damping, problem.colors);
        let next = if solved {
            moved(scene, &scratch.step, problem.colors, &mut tried);
            scratch.assemble(problem, &tried)
        } else {
            T::infinity()
        };
        fresh = next < cost;
        if fresh {
            core::mem::swap(scene, &mut tried);
            let gain = cost - next;
            let done = gain <= tolerance * cost;
            cost = next;
            damping *= T::of(0.2);
            if done {
                result.stop = StopReason::Converged;
                break;
            }
        } else {
            damping *= T::of(8.0);
            if damping > T::of(1e3) {
                result.stop = StopReason::Stalled;
                break;
            }
        }
    }
    scratch.tried = tried;
    result.cost = cost;
    result
}

/// Refines at softer edges first: at sigma times each of `factors` (times its square root where the edge's law takes sigma as a
/// length), one after the other. The last factor should be 1. The width of the robust loss grows with the root of the factor,
/// because a soft edge is off by more.
pub(crate) fn continue_sigma<T: Real>(
    problem: &JointProblem<'_, T>,
    scene: &mut JointScene<T>,
    factors: &[f64],
    max_steps: usize,
    scratch: &mut JointScratch<T>,
) -> JointResult<T> {
    let mut steps = 0;
    let mut result = JointResult { cost: T::infinity(), steps: 0, stop: StopReason::StepLimit };
    for &factor in factors {
        let softer = if problem.edge.law == EdgeLaw::SquaredDistance { T::of(factor) } else { T::of(factor).sqrt() };
        let sigma = problem.edge.sigma * softer;
        let cut = problem.edge.offset + (problem.edge.cut - problem.edge.offset) * softer;
        let width = problem.width * T::of(factor).sqrt();
        let softened =
            JointProblem { edge: EdgeProfile { sigma, cut, ..problem.edge }, coarse: factor > 1.0, width, ..*problem };
        result = refine(&softened, scene, max_steps, scratch);
        steps += result.steps;
    }
    JointResult { steps, ..result }
}

fn moved<T: Real>(scene: &JointScene<T>, step: &[T], colors: bool, out: &mut JointScene<T>) {
    let limit = T::of(0.5);
    out.background = scene.background;
    out.objects.clear();
    for (object, step) in scene.objects.iter().zip(step.chunks_exact(PER_OBJECT)) {
        let mut object = *object;
        object.pose.translation[0] -= step[0];
        object.pose.translation[1] -= step[1];
        object.pose.log_scale -= step[2].max(-limit).min(limit);
        object.pose.rotation -= step[3].max(-limit).min(limit);
        if colors {
            for (value, &change) in object.color.iter_mut().zip(&step[4..]) {
                *value = (*value - change).max(T::zero()).min(T::one());
            }
        }
        out.objects.push(object);
    }
    if colors {
        let at = scene.objects.len() * PER_OBJECT;
        for (value, &change) in out.background.iter_mut().zip(&step[at..]) {
            *value = (*value - change).max(T::zero()).min(T::one());
        }
    }
}

impl<T: Real> JointScratch<T> {
    /// Solves (H + damping diag H) step = gradient; false if it is not positive definite.
    fn solve(&mut self, n: usize, damping: T, colors: bool) -> bool {
        self.damped.clear();
        self.damped.extend_from_slice(&self.hessian);
        let objects = (n - 3) / PER_OBJECT;
        let floor = T::of(1e-9);
        for i in 0..n {
            let fixed = !colors && (i >= objects * PER_OBJECT || i % PER_OBJECT >= 4);
            let at = packed(i, i);
            let diagonal = self.damped[at];
            self.damped[at] = diagonal + damping * diagonal + if fixed { T::one() } else { floor };
            if !fixed && i / PER_OBJECT < objects && objects > MAX_DENSE {
                // Objects apart: drop what couples them.
                let own = i / PER_OBJECT * PER_OBJECT;
                self.damped[packed(i, 0)..packed(i, own)].fill(T::zero());
            }
        }
        self.step.clear();
        self.step.extend_from_slice(&self.gradient);
        if !factor(&mut self.damped, n) {
            return false;
        }
        solve(&self.damped, n, &mut self.step);
        self.step.iter().all(|value| value.is_finite())
    }
}
