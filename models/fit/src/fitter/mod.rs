//! Segment-and-fit: the pipeline from an image to a [`Fit`].
//!
//! `known` poses the prototypes of a bank, `unknown` fits free outlines; `run` is what both share: rendering, colors,
//! pruning, and the doubt that goes with the result.

mod known;
mod run;
mod unknown;

use alloc::vec::Vec;

use dvp_core::render::Renderer;
use dvp_core::render::contour::ContourRenderer;
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES, SYMMETRY_TOLERANCE, Symmetry};
use dvp_core::{Drawing, Efd, ImageView, Real};

use crate::colors::ColorScratch;
use crate::free::basis::Basis;
use crate::free::foot::EdgeLanes;
use crate::free::grow::GrowScratch;
use crate::free::start::StartScratch;
use crate::joint::JointScratch;
use crate::pose::field::OutlineField;
use crate::pose::search::{Candidate, Prototype};
use crate::residual::Residual;
use crate::segment::{EdgeKind, EdgeSample, SegmentOptions, Segmentation};
use crate::{Fit, FitError, FitOptions};
use run::Run;

/// Fits images; prepared once from the options, shared between threads.
#[derive(Clone, Debug)]
pub struct Fitter<T> {
    options: FitOptions<T>,
    prototypes: Vec<Prototype<T>>,
    outlines: OutlineBasis<T>,
    basis: Basis<T>,
}

/// Memory of a [`Fitter`], one per thread, kept between images.
#[derive(Debug)]
pub struct FitScratch<T: Real> {
    segmentation: Segmentation<T>,
    candidates: Vec<Candidate<T>>,
    joint: JointScratch<T>,
    drawing: Drawing<T>,
    outline: Vec<[T; 2]>,
    render: <ContourRenderer<T> as Renderer<T>>::Scratch,
    pixels: Vec<T>,
    residual: Residual<T>,
    start: StartScratch<T>,
    free: GrowScratch<T>,
    lanes: EdgeLanes<T>,
    samples: Vec<EdgeSample<T>>,
    colors: ColorScratch<T>,
}

impl<T: Real> Default for FitScratch<T> {
    fn default() -> Self {
        Self {
            segmentation: Segmentation::default(),
            candidates: Vec::new(),
            joint: JointScratch::default(),
            drawing: Drawing::default(),
            outline: Vec::new(),
            render: Default::default(),
            pixels: Vec::new(),
            residual: Residual::default(),
            start: StartScratch::default(),
            free: GrowScratch::default(),
            lanes: EdgeLanes::default(),
            samples: Vec::new(),
            colors: ColorScratch::default(),
        }
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
    /// Prepares the shapes of the bank.
    ///
    /// # Errors
    /// [`FitError`] if a prototype is no closed shape or a setting is out of range.
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
            let mut outline = alloc::vec![[T::zero(); 2]; REFERENCE_VERTICES];
            outlines.outline(efd.rows(), &mut outline).map_err(|source| FitError::Prototype { index, source })?;
            let field = OutlineField::new(&outline).ok_or(FitError::FlatPrototype { index })?;
            prototypes.push(Prototype { outline, field, symmetry: symmetry_order(efd) });
        }
        let basis = Basis::new(REFERENCE_VERTICES, options.max_harmonics);
        Ok(Self { options, prototypes, outlines, basis })
    }

    /// From pixels to a scene.
    ///
    /// # Errors
    /// [`FitError::NotFinite`] for an image with NaN or infinity.
    pub fn fit(&self, image: ImageView<'_, T>, scratch: &mut FitScratch<T>) -> Result<Fit<T>, FitError> {
        // A view may be made of an image that was written to since it was checked.
        if let Err(dvp_core::image::ImageError::NotFinite { index }) = ImageView::new(image.size(), image.data()) {
            return Err(FitError::NotFinite { index });
        }
        let readable = scratch.segmentation.read(&image, &SegmentOptions::default());
        let kinds = scratch.segmentation.edge_kinds();
        let (kind, other) = self.options.edge.map_or(kinds, |edge| (EdgeKind::Profile(edge), None));
        let fit = self.fit_with(image, kind, readable, scratch)?;
        // In doubt about the edges both readings are fitted; the shorter description wins.
        let second = other.map(|kind| self.fit_with(image, kind, readable, scratch)).transpose()?;
        Ok(second.filter(|second| second.bits < fit.bits).unwrap_or(fit))
    }

    fn fit_with(
        &self,
        image: ImageView<'_, T>,
        kind: EdgeKind<T>,
        readable: bool,
        scratch: &mut FitScratch<T>,
    ) -> Result<Fit<T>, FitError> {
        scratch.segmentation.gather(image.size(), &kind);
        let edge = kind.profile(T::of_usize(image.size().unit_px()));
        let mut run = Run { fitter: self, image, kind, edge, scratch };
        let found = if !readable {
            run.nothing()
        } else if self.prototypes.is_empty() {
            run.unknown_shapes()?
        } else {
            run.known_shapes()?
        };
        run.finish(found)
    }
}

/// Harmonics that 64 vertices, two of them in one place, can carry.
const MAX_HARMONICS: usize = 31;

/// Symmetry order of a shape, 0 for a disk.
pub(crate) fn symmetry_order<T: Real>(efd: &Efd<T>) -> usize {
    match efd.symmetry(T::of(SYMMETRY_TOLERANCE)) {
        Symmetry::Finite(order) => order,
        Symmetry::Continuous => 0,
    }
}
