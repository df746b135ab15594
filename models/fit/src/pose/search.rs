//! From a segment to the pose of a prototype without a start: many cheap starts, the best few refined.

use alloc::vec::Vec;

use dvp_core::shape::{OutlineBasis, SYMMETRY_TOLERANCE, ShapeError, Symmetry};
use dvp_core::{Efd, ImageSize, Real, sort};

use super::equations::{Robustness, SampleLanes};
use super::field::OutlineField;
use super::gauss_newton::{Frame, PosePx};
use crate::segment::{Segment, Segmentation};
use crate::tuning::{FINISH_SAMPLES, FULL_TURN_STARTS, SEARCH_SAMPLES, START_WIDTH_PX, START_WIDTH_SHARE};

/// Sizes tried for an object that leaves the image, relative to its visible part.
const CROPPED_SIZES: [f64; 4] = [1.0, 1.3, 1.7, 2.4];

/// Sizes of the wide search.
const WIDE_SIZES: [f64; 9] = [0.6, 0.8, 1.0, 1.25, 1.5, 1.8, 2.2, 2.7, 3.3];
/// Most starts of one prototype that are refined.
const MOST_KEPT: usize = 10;

/// How residuals count in the last steps.
fn fine<T: Real>() -> Robustness<T> {
    Robustness { width_px: T::of(0.3), rough: false }
}

/// What a search tries.
#[derive(Clone, Copy, Debug)]
struct Plan {
    /// Sizes relative to the visible part.
    sizes: &'static [f64],
    /// Angles over a full turn.
    starts: usize,
    /// Starts per prototype that are refined; at most [`MOST_KEPT`].
    keep: usize,
    /// Steps with wide and with narrow residuals.
    steps: [usize; 2],
    /// Whether distances to first order, which starts are compared by, will do for refining until the last steps: for objects
    /// that show their whole outline. Of others, what is seen tells poses apart by too little.
    rough: bool,
}

/// A shape ready to be searched for.
#[derive(Clone, Debug)]
pub(crate) struct Prototype<T> {
    /// Unit outline, closed.
    pub(crate) outline: Vec<[T; 2]>,
    pub(crate) field: OutlineField<T>,
    /// Symmetry order; 0: every rotation.
    pub(crate) symmetry: usize,
}

impl<T: Real> Prototype<T> {
    /// The shape of descriptors; none if it encloses nothing.
    pub(crate) fn new(efd: &Efd<T>, basis: &OutlineBasis<T>) -> Result<Option<Self>, ShapeError> {
        let mut outline = alloc::vec![[T::zero(); 2]; basis.vertex_count()];
        basis.outline(efd.rows(), &mut outline)?;
        let field = OutlineField::new(&outline);
        Ok(field.map(|field| Self { outline, field, symmetry: symmetry_order(efd) }))
    }
}

/// Symmetry order of a shape, 0 for a disk.
pub(crate) fn symmetry_order<T: Real>(efd: &Efd<T>) -> usize {
    match efd.symmetry(T::of(SYMMETRY_TOLERANCE)) {
        Symmetry::Finite(order) => order,
        Symmetry::Continuous => 0,
    }
}

/// A prototype at a pose, with its robust mean squared distance error.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate<T> {
    pub(crate) prototype: usize,
    pub(crate) pose: PosePx<T>,
    /// px^2, weighted by slope, plus the price of outline where the image is flat.
    pub(crate) cost: T,
    pub(crate) steps: usize,
}

/// How hard to look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effort {
    /// A few starts per prototype.
    Usual,
    /// More angles, more sizes, more of the starts refined: for objects that the usual search missed.
    Wide,
}

/// Poses of every prototype that could explain segment `object`, best first; empty if it has too few samples.
pub(crate) fn search<T: Real>(
    object: u32,
    prototypes: &[Prototype<T>],
    size: ImageSize,
    segmentation: &Segmentation<T>,
    effort: Effort,
    out: &mut Vec<Candidate<T>>,
) {
    out.clear();
    let Some(segment) = segmentation.segments().get(object as usize) else { return };
    if segment.samples.len() < 4 || segment.pixels == 0 {
        return;
    }
    let cropped = segment.border > 0;
    let shown = effort == Effort::Usual && !cropped && !segmentation.may_go_on(object);
    let (starts, steps) = (FULL_TURN_STARTS, [4, 5]);
    let plan = match (effort, cropped) {
        (Effort::Usual, false) => Plan { sizes: &CROPPED_SIZES[..1], starts, keep: 2, steps, rough: shown },
        (Effort::Usual, true) => Plan { sizes: &CROPPED_SIZES, starts, keep: 3, steps, rough: shown },
        (Effort::Wide, _) => {
            Plan { sizes: &WIDE_SIZES, starts: 3 * starts, keep: MOST_KEPT, steps: [12, 8], rough: shown }
        }
    };
    let samples = &segment.samples;
    let few = SampleLanes::new(samples, 1 + samples.len() / SEARCH_SAMPLES, false);
    // Starts are off by a share of the size: in large pictures by more than the pixels that usually do.
    let least = T::of(START_WIDTH_PX);
    let share = T::of(START_WIDTH_SHARE) * visible_radius(segment);
    let wider = (effort == Effort::Wide && share > least).then_some(share);
    for prototype in prototypes.iter().enumerate() {
        for width_px in [Some(least), wider].into_iter().flatten() {
            rough(segment, &few, prototype, size, plan, width_px, out);
        }
    }
    // The best of the rough ones are worth all samples.
    sort::ascending(out, |candidate| candidate.cost.as_f64());
    let Some(best) = out.first().map(|candidate| candidate.cost) else { return };
    let worth = if effort == Effort::Wide { T::of(0.4) } else { T::of(0.01) };
    out.retain(|candidate| candidate.cost <= T::of(8.0) * best + worth);
    let [most, all] = [1 + samples.len() / FINISH_SAMPLES, 1].map(|stride| SampleLanes::new(samples, stride, true));
    let mut kept = 0;
    for i in 0..out.len() {
        // Two starts that ended in one pose are one candidate, now or at the end.
        if out[..kept].iter().any(|c| same(c, &out[i])) {
            continue;
        }
        let refined = finish(out[i], (&most, plan.rough), &all, object, prototypes, size, segmentation);
        let twin = out[..kept].iter().any(|c| same(c, &refined));
        if !twin {
            out[kept] = refined;
            kept += 1;
        }
    }
    out.truncate(kept);
    sort::ascending(out, |candidate| candidate.cost.as_f64());
}

fn same<T: Real>(a: &Candidate<T>, b: &Candidate<T>) -> bool {
    let near = |x: T, y: T, tolerance: f64| (x - y).abs() <= T::of(tolerance);
    a.prototype == b.prototype
        && near(a.pose.translation[0], b.pose.translation[0], 0.2)
        && near(a.pose.translation[1], b.pose.translation[1], 0.2)
        && near(a.pose.log_scale, b.pose.log_scale, 0.02)
        && near(a.pose.rotation, b.pose.rotation, 0.02)
}

/// Adds up to `keep` refined starts of one prototype; residuals count up to `width_px`, in the last steps to half of it.
fn rough<T: Real>(
    segment: &Segment<T>,
    samples: &SampleLanes<T>,
    (index, prototype): (usize, &Prototype<T>),
    size: ImageSize,
    plan: Plan,
    width_px: T,
    out: &mut Vec<Candidate<T>>,
) {
    let [wide, narrow] = [1.0, 0.5].map(|share| Robustness { width_px: T::of(share) * width_px, rough: plan.rough });
    let turns = prototype.symmetry.max(1);
    let starts = if prototype.symmetry == 0 { 1 } else { plan.starts.div_ceil(turns).max(3) };
    let range = T::of(2.0 * core::f64::consts::PI) / T::of_usize(turns);
    let field = &prototype.field;
    let mut best: [Option<(T, PosePx<T>)>; MOST_KEPT] = [None; MOST_KEPT];
    for &enlarged in plan.sizes {
        for i in 0..starts {
            let rotation = range * T::of_usize(i) / T::of_usize(starts);
            let pose = start(segment, field, size, T::of(enlarged), rotation);
            insert(&mut best[..plan.keep], pose.cost(field, samples, Robustness { rough: true, ..wide }), pose);
        }
    }
    for (_, pose) in best.into_iter().flatten() {
        let (pose, _, first) = pose.refine(field, samples, wide, plan.steps[0]);
        let (pose, cost, second) = pose.refine(field, samples, narrow, plan.steps[1]);
        out.push(Candidate { prototype: index, pose, cost, steps: first + second });
    }
}

/// Keeps a pose in a short list of the best, ascending.
pub(crate) fn insert<T: Real>(best: &mut [Option<(T, PosePx<T>)>], cost: T, pose: PosePx<T>) {
    let mut entry = Some((cost, pose));
    for slot in best {
        let better = match (&entry, &slot) {
            (Some((cost, _)), Some((held, _))) => cost < held,
            (Some(_), None) => true,
            _ => false,
        };
        if better {
            core::mem::swap(slot, &mut entry);
        }
    }
}

/// Radius (px) of the disk with the area of what is seen of an object. Flat pixels end about 0.7 px inside the outline.
fn visible_radius<T: Real>(segment: &Segment<T>) -> T {
    (T::of_usize(segment.pixels) / T::of(core::f64::consts::PI)).sqrt() + T::of(0.7)
}

/// A start whose area is that of the segment and whose centroid is its centroid; for an enlarged object the centroid
/// moves out of the image, away from the image's center line, so that the inner rim stays where it is.
fn start<T: Real>(
    segment: &Segment<T>,
    field: &OutlineField<T>,
    size: ImageSize,
    enlarged: T,
    rotation: T,
) -> PosePx<T> {
    let count = T::of_usize(segment.pixels);
    let visible = [segment.sums[0] / count, segment.sums[1] / count];
    let radius = visible_radius(segment);
    let scale = enlarged * radius / (field.area / T::of(core::f64::consts::PI)).sqrt();
    let mut center = visible;
    let growth = radius * (enlarged - T::one());
    let (width, height) = (T::of_usize(size.width()), T::of_usize(size.height()));
    for (c, extent) in [width, height].into_iter().enumerate() {
        if visible[c] < radius {
            center[c] -= growth;
        } else if visible[c] > extent - radius {
            center[c] += growth;
        }
    }
    let (sin, cos) = rotation.sin_cos();
    let [x, y] = field.centroid;
    let translation = [center[0] - scale * (cos * x - sin * y), center[1] - scale * (sin * x + cos * y)];
    PosePx { translation, log_scale: scale.ln(), rotation }
}

/// All samples, weighted by slope; the symmetric twins of the pose are tried too, since 64 vertices at t = i / 63 are not
/// exactly symmetric.
fn finish<T: Real>(
    candidate: Candidate<T>,
    (most, rough): (&SampleLanes<T>, bool),
    all: &SampleLanes<T>,
    object: u32,
    prototypes: &[Prototype<T>],
    size: ImageSize,
    segmentation: &Segmentation<T>,
) -> Candidate<T> {
    let prototype = &prototypes[candidate.prototype];
    let field = &prototype.field;
    // A part of the samples brings the pose within reach of the last two steps.
    let (pose, _, first) = candidate.pose.refine(field, most, Robustness { rough, ..fine() }, 6);
    let (mut pose, mut cost, second) = pose.refine(field, all, fine(), 3);
    let mut steps = first + second;
    let turn = T::of(2.0 * core::f64::consts::PI) / T::of_usize(prototype.symmetry.max(1));
    let base = pose;
    let mut turned = false;
    for i in 1..prototype.symmetry {
        let twin = PosePx { rotation: base.rotation + turn * T::of_usize(i), ..base };
        let twin_cost = twin.cost(field, all, fine());
        if twin_cost < cost {
            (pose, cost, turned) = (twin, twin_cost, true);
        }
    }
    if turned {
        let (refined, refined_cost, more) = pose.refine(field, all, fine(), 4);
        (pose, cost, steps) = (refined, refined_cost, steps + more);
    }
    let surplus = outline_over_flat(&pose, prototype, object, size, segmentation);
    Candidate {
        prototype: candidate.prototype,
        pose,
        cost: cost + T::of(0.09) * surplus,
        steps: candidate.steps + steps,
    }
}

/// Share of the outline in sight that runs through flat pixels, where no outline can be.
fn outline_over_flat<T: Real>(
    pose: &PosePx<T>,
    prototype: &Prototype<T>,
    object: u32,
    size: ImageSize,
    segmentation: &Segmentation<T>,
) -> T {
    let frame = Frame::new(pose);
    let (mut visible, mut flat) = (0usize, 0usize);
    for &v in &prototype.outline {
        // A vertex moved 1 px outward: well inside the soft band.
        let length = (v[0] * v[0] + v[1] * v[1]).sqrt().max(T::of(1e-6));
        let grown = T::one() + T::one() / (length * frame.scale);
        let p = frame.to_pixels([v[0] * grown, v[1] * grown]);
        let (Some(x), Some(y)) = (p[0].floor().to_usize(), p[1].floor().to_usize()) else { continue };
        if p[0] < T::zero() || p[1] < T::zero() || x >= size.width() || y >= size.height() {
            continue;
        }
        visible += 1;
        flat += usize::from(segmentation.covers(y * size.width() + x, object).is_some());
    }
    if visible == 0 { T::zero() } else { T::of_usize(flat) / T::of_usize(visible) }
}
