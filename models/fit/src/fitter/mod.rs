//! Segment-and-fit: the pipeline from an image to a [`Fit`].
//!
//! `pieces` joins what another object cuts in two, `order` decides which objects are in front, `known` poses the
//! prototypes of a bank, `unknown` fits free outlines, `twins` splits what is several objects of one color; `run` is what
//! they share: rendering (`shown`: only where something changed), colors, pruning, and the doubt that goes with the result
//! (`ambiguity`: what it leaves open). `flat` puts one color in the place of a scene that is worse. `readings` chooses between clean, noisy and faint pictures (`faint`); `subsample` takes
//! large pictures with wide edges down to the size that they need.

mod ambiguity;
mod faint;
mod flat;
mod known;
mod order;
mod pieces;
mod readings;
mod run;
mod shown;
pub(crate) mod subsample;
#[cfg(test)]
mod tests;
mod twins;
mod unknown;

use alloc::vec::Vec;

use dvp_core::render::{Compositing, EdgeLaw};
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES};
use dvp_core::{Drawing, ImageView, Real};

use crate::block_code::{BlockCode, CodeScratch};
use crate::colors::ColorScratch;
use crate::free::basis::Basis;
use crate::free::foot::EdgeLanes;
use crate::free::grow::GrowScratch;
use crate::free::start::StartScratch;
use crate::joint::JointScratch;
use crate::options::check_values;
use crate::pose::search::{Candidate, Prototype};
use crate::residual::Residual;
use crate::segment::{EdgeKind, EdgeSample, Evidence, Segmentation};
use crate::split::simple_shapes::SimpleShapes;
use crate::split::twins::TwinScratch;
use crate::{Fit, FitError, FitOptions};
use run::Run;
use shown::Shown;
use subsample::Subsampling;

/// Fits images; prepared once from the options, shared between threads.
#[derive(Clone, Debug)]
pub struct Fitter<T> {
    options: FitOptions<T>,
    prototypes: Vec<Prototype<T>>,
    outlines: OutlineBasis<T>,
    basis: Basis<T>,
}

/// Memory of a [`Fitter`], one per thread, kept between images.
#[derive(Debug, Default)]
pub struct FitScratch<T: Real> {
    segmentation: Segmentation<T>,
    candidates: Vec<Candidate<T>>,
    joint: JointScratch<T>,
    drawing: Drawing<T>,
    outline: Vec<[T; 2]>,
    shown: Shown<T>,
    residual: Residual<T>,
    start: StartScratch<T>,
    free: GrowScratch<T>,
    simple: SimpleShapes<T>,
    twins: TwinScratch<T>,
    lanes: EdgeLanes<T>,
    samples: Vec<EdgeSample<T>>,
    colors: ColorScratch<T>,
    differences: Vec<T>,
    /// The coder that wrote the image, if one is known.
    code: Option<BlockCode<T>>,
    code_bits: CodeScratch<T>,
    /// Which pixels of the image were looked at, if not all.
    subsampling: Option<Subsampling>,
}

impl<T: Real> FitScratch<T> {
    /// Forgets the last image.
    fn forget(&mut self) {
        self.shown.forget();
        self.code = None;
        self.code_bits.forget();
    }

    /// The segments of the last fit; their samples are of the pixels looked at.
    pub(crate) fn segments(&self) -> &[crate::segment::Segment<T>] {
        self.segmentation.segments()
    }

    /// A sample of a segment of the last fit, as one of the image.
    pub(crate) fn restore_sample(&self, sample: &EdgeSample<T>) -> EdgeSample<T> {
        self.subsampling.map_or(*sample, |subsampling| subsampling.restore_sample(sample))
    }
}

/// Fits one image; for many, keep a [`Fitter`] and a [`FitScratch`].
///
/// # Errors
/// As [`Fitter::new`] and [`Fitter::fit`].
pub fn fit_image<T: Real>(image: ImageView<'_, T>, options: &FitOptions<T>) -> Result<Fit<T>, FitError> {
    Fitter::new(options.clone())?.fit(image, &mut FitScratch::default())
}

impl<T: Real> Fitter<T> {
    /// The settings.
    #[must_use]
    pub fn options(&self) -> &FitOptions<T> {
        &self.options
    }

    /// Prepares the shapes of the bank.
    ///
    /// # Errors
    /// [`FitError`] if a prototype is no closed shape or a setting is out of range.
    #[inline(never)]
    pub fn new(options: FitOptions<T>) -> Result<Self, FitError> {
        if !(1..=MAX_HARMONICS).contains(&options.max_harmonics) {
            return Err(FitError::Setting { what: "max_harmonics", must: "1 to 31: 64 vertices carry no more" });
        }
        if options.bank.as_ref().is_some_and(|bank| bank.prototypes.is_empty()) {
            return Err(FitError::Setting { what: "bank", must: "at least one prototype, or none for unknown shapes" });
        }
        let sigma_is_usable = |sigma: T| sigma.is_finite() && sigma > T::zero();
        if options.edge.is_some_and(|edge| !sigma_is_usable(edge.sigma)) {
            return Err(FitError::Setting { what: "edge.sigma", must: "finite and above 0" });
        }
        let bank = options.bank.as_ref().map_or(&[][..], |bank| &bank.prototypes);
        let harmonics = bank.iter().map(|(_, efd)| efd.harmonic_count()).max().unwrap_or(1);
        let outlines = OutlineBasis::new(REFERENCE_VERTICES, harmonics.max(options.max_harmonics))?;
        let mut prototypes = Vec::with_capacity(bank.len());
        for (index, (_, efd)) in bank.iter().enumerate() {
            let prototype = Prototype::new(efd, &outlines).map_err(|source| FitError::Prototype { index, source })?;
            prototypes.push(prototype.ok_or(FitError::FlatPrototype { index })?);
        }
        let basis = Basis::new(REFERENCE_VERTICES, options.max_harmonics);
        Ok(Self { options, prototypes, outlines, basis })
    }

    /// From pixels to a scene. In pictures of 512 x 512 pixels and more whose edges are many pixels wide, every k-th pixel
    /// is looked at: they tell those between. Never worse than one flat color: if no scene was found whose mean absolute error is
    /// smaller, that color is returned, and [`StopReason::NoBetterThanFlat`](crate::StopReason::NoBetterThanFlat) says so.
    ///
    /// # Errors
    /// [`FitError::NotFinite`] for an image with NaN or infinity.
    #[inline(never)]
    pub fn fit(&self, image: ImageView<'_, T>, scratch: &mut FitScratch<T>) -> Result<Fit<T>, FitError> {
        check_values(&image)?;
        scratch.forget();
        scratch.subsampling = Subsampling::of(&image);
        let subsampled = match scratch.subsampling {
            Some(subsampling) => self.fit_subsampled(image, subsampling, scratch)?,
            None => None,
        };
        let fit = match subsampled {
            Some(fit) => fit,
            None => self.fit_whole(image, scratch)?,
        };
        Ok(flat::or_flat(&image, fit, &self.options.prices))
    }

    /// A fit of every pixel.
    fn fit_whole(&self, image: ImageView<'_, T>, scratch: &mut FitScratch<T>) -> Result<Fit<T>, FitError> {
        scratch.subsampling = None;
        scratch.forget();
        self.best_reading(image, scratch)
    }

    /// How the objects seem to be composited, and a second way to try in doubt.
    fn compositings(&self, evidence: Evidence, kind: &EdgeKind<T>) -> (Compositing, Option<Compositing>) {
        if let Some(known) = self.options.compositing {
            return (known, None);
        }
        let reference = matches!(kind, EdgeKind::Profile(edge) if edge.law == EdgeLaw::SquaredDistance);
        if evidence.direct >= DIRECT_PIXELS {
            // Objects that mix in a stripe too narrow to be flat leave no mean color.
            let doubt = evidence.mean > 0 || reference;
            if doubt { (Compositing::Blend, Some(Compositing::Over)) } else { (Compositing::Over, None) }
        } else if evidence.mean == 0 && evidence.inside > 0 && !reference {
            // Drawings show one thing on another; only the reference renderer's data mixes their colors.
            (Compositing::Over, None)
        } else {
            (Compositing::Blend, None)
        }
    }

    fn fit_with(
        &self,
        image: ImageView<'_, T>,
        kind: EdgeKind<T>,
        compositing: Compositing,
        scratch: &mut FitScratch<T>,
    ) -> Result<Fit<T>, FitError> {
        let edge = kind.profile(T::of_usize(image.size().unit_px()));
        // An order decided under another edge kind is decided anew.
        if scratch.segmentation.compositing() != compositing || compositing == Compositing::Over {
            scratch.segmentation.interpret(compositing);
        }
        let mut run = Run { fitter: self, image, kind, edge, compositing, scratch };
        run.join_pieces();
        run.decide_order();
        run.scratch.segmentation.gather(image.size(), &kind);
        let found = if self.prototypes.is_empty() { run.unknown_shapes()? } else { run.known_shapes()? };
        run.finish(found)
    }
}

/// So many soft pixels between two objects without their mean color between speak for one hiding the other; objects that
/// merely touch have fewer.
const DIRECT_PIXELS: u32 = 8;

/// Harmonics that 64 vertices, two of them in one place, can carry.
const MAX_HARMONICS: usize = 31;
