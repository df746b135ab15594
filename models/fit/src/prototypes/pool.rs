//! A better bank from posed members: the edge samples of all of them, brought into one frame, show more of a shape than
//! any one of them.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES, ShapeError};
use dvp_core::{Efd, ImageSize, Object, Real};
use num_traits::Float;

use super::MAX_HARMONICS;
use super::decode::WholeObject;
use super::form::Form;
use super::learn::SYMMETRIC;
use crate::fitter::FitScratch;
use crate::free::basis::Basis;
use crate::free::foot::{EdgeLanes, foot};
use crate::free::outline_fit::{FreeOutline, OutlineScratch, OutlineSettings, Target, refine};
use crate::pose::gauss_newton::Frame;
use crate::segment::{EdgeSample, PIXEL_NOISE, Segment};
use crate::{Bank, Fit, FitError};

/// Units of the pool's frame per unit of an outline: what outline fits call a pixel is a hundredth of a radius.
const FRAME: f64 = 100.0;
/// Samples of one object that are taken.
const SAMPLES_PER_OBJECT: usize = 256;
/// Samples of one prototype beyond which no more are needed.
const SAMPLES_PER_PROTOTYPE: usize = 30_000;
/// An object whose samples are off its outline by more (px, root mean square) was not posed well.
const WELL_POSED_PX: f64 = 0.35;
/// Samples that decide which segment is an object's.
const PROBES: usize = 24;
/// A segment's color is an object's if no channel differs by more.
const SAME_COLOR: f64 = 0.02;
/// Fewer samples than this do not make a shape better.
const FEW_SAMPLES: usize = 500;
/// Residual at which a sample loses most of its say, frame units.
const WIDTHS: [f64; 3] = [4.0, 1.5, 1.5];
/// The same where pixels are not mixed, which tell edges to half a pixel.
const HARD_WIDTHS: [f64; 3] = [12.0, 8.0, 8.0];
/// How far inside or outside of an outline the middle of a pixel is wanted, px: first as far as an edge between two pixels is on the mean, then so
/// little that those near it have a say. Where an outline is right, as many on either side are.
const MARGINS_PX: [f64; 3] = [0.5, 0.3, 0.2];
/// How far an edge between two pixels may be off (standard deviation, px): it is anywhere between their middles.
const STEP_PX: f64 = 0.29;
/// A prototype whose first harmonic is turned by more (radians) stands as it was learned.
const STANDS: f64 = 1e-3;
/// Gauss-Newton steps per width.
const STEPS: usize = 12;
/// Pull of high harmonics to 0, of no weight beside thousands of samples.
const SMOOTHNESS: f64 = 1e-3;

/// Edge samples of posed objects per prototype, in the frame of its outline.
#[derive(Clone, Debug)]
pub struct Pool<T> {
    bank: Bank<T>,
    outlines: Vec<Vec<[f64; 2]>>,
    samples: Vec<Vec<EdgeSample<f64>>>,
    lanes: EdgeLanes<f64>,
    /// Whether samples are those of pixels that are not mixed.
    hard: bool,
}

impl<T: Real> Pool<T> {
    /// An empty pool for fits with `bank`.
    ///
    /// # Errors
    /// [`ShapeError`] if a prototype is no outline.
    #[inline(never)]
    pub fn new(bank: &Bank<T>) -> Result<Self, ShapeError> {
        let harmonics = bank.prototypes.iter().map(|(_, efd)| efd.harmonic_count()).max().unwrap_or(0);
        let basis = OutlineBasis::<f64>::new(REFERENCE_VERTICES, harmonics.max(1))?;
        let mut outlines = Vec::new();
        for (_, efd) in &bank.prototypes {
            let mut outline = vec![[0.0; 2]; REFERENCE_VERTICES];
            basis.outline(&rows(efd), &mut outline)?;
            outline.iter_mut().for_each(|v| *v = v.map(|x| x * FRAME));
            outlines.push(outline);
        }
        let samples = vec![Vec::new(); bank.prototypes.len()];
        Ok(Self { bank: bank.clone(), outlines, samples, lanes: EdgeLanes::default(), hard: false })
    }

    /// Takes the samples of the objects of `fit`, which must be the last fit that `scratch` was used for.
    #[inline(never)]
    pub fn add(&mut self, fit: &Fit<T>, size: ImageSize, scratch: &FitScratch<T>) {
        let unit = f64::of_usize(size.unit_px());
        for object in &fit.scene.objects {
            let Some(k) = object.prototype().filter(|&k| k < self.samples.len()) else { continue };
            if self.samples[k].len() >= SAMPLES_PER_PROTOTYPE {
                continue;
            }
            let limit = WELL_POSED_PX * FRAME / (object.pose.scale.as_f64() * unit);
            let mut best: (f64, Option<&Segment<T>>) = (limit * limit, None);
            self.lanes.set(&self.outlines[k]);
            for segment in scratch.segments().iter().filter(|segment| same_color(segment.color, object.color())) {
                let squared = self.mean_squared(k, segment, object, unit, scratch);
                if squared < best.0 {
                    best = (squared, Some(segment));
                }
            }
            if let Some(segment) = best.1 {
                let stride = segment.samples.len().div_ceil(SAMPLES_PER_OBJECT).max(1);
                let taken = segment.samples.iter().step_by(stride).map(|sample| scratch.restore_sample(sample));
                let taken = taken.map(|sample| to_frame(&sample, object, unit));
                self.samples[k].extend(taken);
            }
        }
    }

    fn mean_squared(
        &mut self,
        k: usize,
        segment: &Segment<T>,
        object: &Object<T>,
        unit: f64,
        scratch: &FitScratch<T>,
    ) -> f64 {
        let stride = segment.samples.len().div_ceil(PROBES).max(1);
        let (mut sum, mut count) = (0.0, 0.0);
        for sample in segment.samples.iter().step_by(stride) {
            let sample = to_frame(&scratch.restore_sample(sample), object, unit);
            let off = foot(&self.outlines[k], &self.lanes, sample.point).distance - sample.distance;
            sum += off * off;
            count += 1.0;
        }
        if count > 0.0 { sum / count } else { f64::INFINITY }
    }

    /// Takes what an object that is seen whole shows of its shape: which pixels along its outline have their middle inside, and which outside.
    #[inline(never)]
    pub fn add_whole(&mut self, object: &WholeObject) {
        let Some(samples) = self.samples.get_mut(object.prototype) else { return };
        if samples.len() < SAMPLES_PER_PROTOTYPE {
            let frame = Frame::new(&object.pose);
            let scale = FRAME / frame.scale;
            let sample = |&(middle, is_inside): &([f64; 2], bool)| EdgeSample {
                point: frame.to_unit(middle).map(|v| v * FRAME),
                distance: if is_inside { -scale } else { scale },
                weight: PIXEL_NOISE / (STEP_PX * scale),
            };
            samples.extend(object.sides.iter().map(sample));
            self.hard = true;
        }
    }

    /// Adds the samples of another pool for the same bank.
    #[inline(never)]
    pub fn merge(&mut self, other: Self) {
        for (own, more) in self.samples.iter_mut().zip(other.samples) {
            let room = SAMPLES_PER_PROTOTYPE.saturating_sub(own.len());
            own.extend(more.into_iter().take(room));
        }
        self.hard |= other.hard;
    }

    /// The bank with each outline laid at the distances of its samples; prototypes with few samples stay as they are.
    ///
    /// # Errors
    /// [`FitError::Shape`] if a refined outline is no shape.
    #[inline(never)]
    pub fn bank(&self) -> Result<Bank<T>, FitError> {
        let basis = Basis::new(REFERENCE_VERTICES, MAX_HARMONICS);
        let mut prototypes = Vec::new();
        for ((name, efd), samples) in self.bank.prototypes.iter().zip(&self.samples) {
            let few = samples.len() < FEW_SAMPLES;
            let better = if few { efd.clone() } else { refined(efd, samples, &basis, self.hard)? };
            prototypes.push((name.clone(), better));
        }
        Ok(Bank { prototypes })
    }

    /// Samples per prototype.
    #[must_use]
    pub fn sample_counts(&self) -> Vec<usize> {
        self.samples.iter().map(Vec::len).collect()
    }
}

/// The outline at the sampled distances, as its 64 vertices can.
///
/// Its starting point stays: vertices lie where the samples have them, and a shift would move them off.
fn refined<T: Real>(
    efd: &Efd<T>,
    samples: &[EdgeSample<f64>],
    basis: &Basis<f64>,
    hard: bool,
) -> Result<Efd<T>, ShapeError> {
    let widths = if hard { &HARD_WIDTHS } else { &WIDTHS };
    let mut scratch = OutlineScratch::default();
    let (mut lanes, mut vertices) = (EdgeLanes::default(), Vec::new());
    // Samples that an outline is to be laid at: where they are pixels, those that are not clear of it.
    let mut asked = |outline: &FreeOutline<f64>, margin: f64| -> Vec<EdgeSample<f64>> {
        if !hard {
            return samples.to_vec();
        }
        outline.write_vertices(basis, REFERENCE_VERTICES, &mut vertices);
        lanes.set(&vertices);
        let wanted = samples.iter().map(|&sample| EdgeSample { distance: margin * sample.distance, ..sample });
        let off = |sample: &EdgeSample<f64>| foot(&vertices, &lanes, sample.point).distance - sample.distance;
        wanted.filter(|sample| off(sample) * sample.distance < 0.0).collect()
    };
    let mut lay = |rows: &[[f64; 4]]| {
        let rows = rows.iter().map(|row| row.map(|v| v * FRAME)).collect();
        let mut outline = FreeOutline { center: [0.0; 2], rows };
        for (&width_px, margin) in widths.iter().zip(MARGINS_PX) {
            let settings =
                OutlineSettings { width_px, pixel_noise: PIXEL_NOISE, smoothness: SMOOTHNESS, max_steps: STEPS };
            let samples = asked(&outline, margin);
            // Without a say of samples an outline would become smooth.
            if samples.len() >= FEW_SAMPLES {
                let target = Target { samples: &samples, basis, vertex_count: REFERENCE_VERTICES, settings };
                refine(&mut outline, &target, &mut scratch);
            }
        }
        Efd::new(outline.rows.into_iter().map(|row| row.map(|v| v / FRAME)).collect())
    };
    let stands = efd.cast::<f64>().normalize()?.rotation.abs() > STANDS;
    let mut efd: Efd<f64> = lay(&rows(&efd.resized(MAX_HARMONICS)));
    if hard {
        // Pixels tell little of fine details, and symmetric shapes show each more than once.
        efd = Form::as_it_runs(&efd).symmetrized(SYMMETRIC).0.efd(0.0);
    }
    let mut scaled = efd.clone();
    let normal = efd.normalize()?;
    // What stands as it was learned goes on to do so.
    scaled.rotate_scale(if stands { 0.0 } else { -normal.rotation }, normal.scale.recip());
    Ok(Efd::new(scaled.rows().iter().map(|row| row.map(T::of)).collect()))
}

fn rows<T: Real>(efd: &Efd<T>) -> Vec<[f64; 4]> {
    efd.rows().iter().map(|row| row.map(Real::as_f64)).collect()
}

fn same_color<T: Real>(a: [T; 3], b: [T; 3]) -> bool {
    (0..3).all(|c| (a[c] - b[c]).abs() <= T::of(SAME_COLOR))
}

/// A sample (px) as the object's outline sees it.
fn to_frame<T: Real>(sample: &EdgeSample<T>, object: &Object<T>, unit: f64) -> EdgeSample<f64> {
    let pose = &object.pose;
    let [x, y]: [f64; 2] = core::array::from_fn(|c| sample.point[c].as_f64() - pose.translation[c].as_f64() * unit);
    let scale = FRAME / (pose.scale.as_f64() * unit);
    let (sin, cos) = Float::sin_cos(pose.rotation.as_f64());
    EdgeSample {
        point: [scale * (cos * x + sin * y), scale * (cos * y - sin * x)],
        distance: scale * sample.distance.as_f64(),
        weight: sample.weight.as_f64() / scale,
    }
}
