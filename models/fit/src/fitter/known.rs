//! Objects whose shapes are in a bank: every prototype is posed, the best is kept, all are refined together.

use alloc::vec::Vec;

use dvp_core::scene::Pose;
use dvp_core::{Object, Real};

use super::run::{Found, FoundObject, Run};
use crate::joint::{JointObject, JointProblem, JointScene, refine};
use crate::pose::gauss_newton::{Frame, wrapped};
use crate::pose::search::{Candidate, Effort, search};
use crate::tuning::{JOINT_PIXELS, JOINT_WIDTH, MISSED_PIXELS, SURE_COST};
use crate::{Completion, FitError, StopReason};

/// Candidates of the wide search that are rendered.
const RENDERED_CANDIDATES: usize = 8;

/// Where a posed object came from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source {
    pub(super) segment: usize,
    pub(super) twin: Option<(usize, f64)>,
    /// Whether the outline lies where the samples have it.
    pub(super) sure: bool,
}

impl<T: Real> Run<'_, T> {
    /// Poses prototypes on all segments.
    pub(super) fn known_shapes(&mut self) -> Result<Found<T>, FitError> {
        let background = self.scratch.segmentation.background();
        let mut posed = JointScene { background, objects: Vec::new() };
        let mut sources = Vec::new();
        let mut steps = 0;
        for segment in self.painting_order() {
            self.search(segment, Effort::Usual);
            let Some(&best) = self.scratch.candidates.first() else { continue };
            steps += best.steps;
            let sure = best.cost < T::of(SURE_COST);
            let segment = segment as usize;
            sources.push(Source { segment, twin: twin(&self.scratch.candidates), sure });
            posed.objects.push(self.posed(&best, segment));
        }
        let mut loss = self.compare(&posed)?;
        for (at, source) in sources.iter_mut().enumerate() {
            if !source.sure && self.misses_object(&posed, at) {
                loss = self.search_again(&mut posed, at, source, loss)?;
            }
        }
        // What compression leaves along edges is no evidence of a shared outline.
        if !self.scratch.segmentation.is_compressed() {
            loss = self.split_known(&mut posed, &mut sources, loss)?;
        }
        let mut stop = StopReason::Converged;
        let everywhere = T::of_usize(self.image.size().width().max(self.image.size().height()));
        let missed = self.missed_pixels([T::zero(); 2], everywhere);
        if self.fitter.options.max_steps > 0 && missed > JOINT_PIXELS {
            let problem = JointProblem {
                image: self.image,
                shapes: &self.fitter.prototypes,
                edge: self.edge,
                compositing: self.compositing,
                colors: false,
                coarse: false,
                width: T::of(JOINT_WIDTH),
            };
            let mut moved = posed.clone();
            let result = refine(&problem, &mut moved, self.fitter.options.max_steps, &mut self.scratch.joint);
            steps += result.steps;
            stop = result.stop;
            if self.compare(&moved)? < loss {
                posed = moved;
            }
        }
        let objects = posed.objects.iter().zip(&sources);
        let objects = objects.map(|(part, source)| self.found(part, *source)).collect();
        Ok(Found { background, objects, steps, stop })
    }

    /// Fills the candidates of the scratch.
    pub(super) fn search(&mut self, segment: u32, effort: Effort) {
        let scratch = &mut *self.scratch;
        let prototypes = &self.fitter.prototypes;
        let size = self.image.size();
        search(segment, prototypes, size, &scratch.segmentation, effort, &mut scratch.candidates);
    }

    fn posed(&self, candidate: &Candidate<T>, segment: usize) -> JointObject<T> {
        let part = &self.scratch.segmentation.segments()[segment];
        let (color, confidence) = (part.color, part.confidence);
        JointObject { shape: candidate.prototype, pose: candidate.pose, color, confidence }
    }

    /// Renders and keeps the residual; returns the mean absolute error.
    pub(super) fn compare(&mut self, posed: &JointScene<T>) -> Result<T, FitError> {
        let unit = self.unit_px();
        let scratch = &mut *self.scratch;
        scratch.drawing.clear();
        scratch.drawing.background = posed.background;
        for object in &posed.objects {
            let frame = Frame::new(&object.pose);
            scratch.outline.clear();
            let unit_outline = &self.fitter.prototypes[object.shape].outline;
            scratch.outline.extend(unit_outline.iter().map(|&v| frame.to_pixels(v).map(|x| x / unit)));
            scratch.drawing.push(&scratch.outline, object.color, object.confidence);
        }
        self.compare_drawing()
    }

    /// Whether the last rendering visibly misses the image around an object.
    pub(super) fn misses_object(&self, posed: &JointScene<T>, at: usize) -> bool {
        let object = &posed.objects[at];
        let radius = self.fitter.prototypes[object.shape].field.radius;
        let reach = object.pose.log_scale.exp() * radius + T::of(2.0);
        self.missed_pixels(object.pose.translation, reach) > MISSED_PIXELS
    }

    /// Looks harder for one object; rendered candidates compete, the best stays. Returns the loss.
    fn search_again(
        &mut self,
        posed: &mut JointScene<T>,
        at: usize,
        source: &mut Source,
        loss: T,
    ) -> Result<T, FitError> {
        self.search(u32::try_from(source.segment).unwrap_or(u32::MAX), Effort::Wide);
        let mut best = (loss, posed.objects[at]);
        let count = self.scratch.candidates.len().min(RENDERED_CANDIDATES);
        for i in 0..count {
            let candidate = self.scratch.candidates[i];
            posed.objects[at] = self.posed(&candidate, source.segment);
            let loss = self.compare(posed)?;
            if loss < best.0 {
                best = (loss, posed.objects[at]);
            }
        }
        source.twin = twin(&self.scratch.candidates).filter(|&(prototype, _)| prototype != best.1.shape);
        posed.objects[at] = best.1;
        self.compare(posed)
    }

    fn found(&self, part: &JointObject<T>, source: Source) -> FoundObject<T> {
        let unit = self.unit_px();
        let bank = self.fitter.options.bank.as_ref();
        let efd = bank.and_then(|bank| bank.prototypes.get(part.shape)).map(|(_, efd)| efd.clone());
        let rotation = wrapped(part.pose.rotation, T::of(core::f64::consts::TAU));
        let pose = Pose { rotation, ..part.pose.in_scene(unit) };
        let object = Object::of_efd(pose, part.color, part.confidence, efd.unwrap_or_default(), Some(part.shape));
        FoundObject { object, segment: source.segment, twin: source.twin, completion: Completion::Prototype }
    }
}

/// The best candidate of another prototype, and its cost over that of the best.
fn twin<T: Real>(candidates: &[Candidate<T>]) -> Option<(usize, f64)> {
    let best = candidates.first()?;
    let other = candidates.iter().find(|candidate| candidate.prototype != best.prototype)?;
    let floor = T::of(1e-6);
    Some((other.prototype, (other.cost.max(floor) / best.cost.max(floor)).as_f64()))
}
