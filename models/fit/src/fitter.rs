//! Segment-and-fit: the pipeline from an image to a [`Fit`].

use alloc::vec::Vec;

use dvp_core::render::EdgeProfile;
use dvp_core::scene::Pose;
use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES};
use dvp_core::{ImageView, Object, Real, Scene};

use crate::pose::field::OutlineField;
use crate::pose::search::{Candidate, Prototype, search};
use crate::segment::{SegmentOptions, Segmentation};
use crate::{Ambiguity, Fit, FitError, FitOptions, StopReason};

/// Fits images; prepared once from the options, shared between threads.
#[derive(Clone, Debug)]
pub struct Fitter<T> {
    options: FitOptions<T>,
    prototypes: Vec<Prototype<T>>,
    basis: OutlineBasis<T>,
}

/// Memory of a [`Fitter`], one per thread, kept between images.
#[derive(Clone, Debug, Default)]
pub struct FitScratch<T> {
    segmentation: Segmentation<T>,
    candidates: Vec<Candidate<T>>,
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
        let bank = options.bank.as_ref().map_or(&[][..], |bank| &bank.prototypes);
        let harmonics = bank.iter().map(|(_, efd)| efd.harmonic_count()).max().unwrap_or(1).max(options.max_harmonics);
        let basis = OutlineBasis::new(REFERENCE_VERTICES, harmonics)?;
        let mut prototypes = Vec::with_capacity(bank.len());
        for (index, (_, efd)) in bank.iter().enumerate() {
            let mut outline = alloc::vec![[T::zero(); 2]; REFERENCE_VERTICES];
            basis.outline(efd.rows(), &mut outline).map_err(|source| FitError::Prototype { index, source })?;
            let field = OutlineField::new(&outline).ok_or(FitError::FlatPrototype { index })?;
            prototypes.push(Prototype { outline, field, symmetry: [1, 4, 2][index.min(2)] });
        }
        Ok(Self { options, prototypes, basis })
    }

    /// From pixels to a scene.
    ///
    /// # Errors
    /// [`FitError::NotFinite`] for an image with NaN or infinity.
    pub fn fit(&self, image: ImageView<'_, T>, scratch: &mut FitScratch<T>) -> Result<Fit<T>, FitError> {
        let edge = self.options.edge.unwrap_or_else(EdgeProfile::reference);
        let unit = T::of_usize(image.size().unit_px());
        scratch.segmentation.run(&image, &edge, &SegmentOptions::default());
        let background = scratch.segmentation.background();
        let mut scene = Scene { background, objects: Vec::new(), edge, compositing: self.options.compositing };
        let bank = self.options.bank.as_ref().map_or(&[][..], |bank| &bank.prototypes);
        let mut steps = 0;
        let mut ambiguity = Vec::new();
        for segment in scratch.segmentation.segments() {
            search(segment, &self.prototypes, image.size(), &scratch.segmentation, &mut scratch.candidates);
            let Some(best) = scratch.candidates.first() else { continue };
            steps += best.steps;
            let pose = Pose {
                translation: best.pose.translation.map(|v| v / unit),
                scale: best.pose.log_scale.exp() / unit,
                rotation: best.pose.rotation,
            };
            let object = scene.objects.len();
            ambiguity.push(Ambiguity::Symmetry { object, order: self.prototypes[best.prototype].symmetry });
            scene.objects.push(Object {
                pose,
                color: segment.color,
                confidence: T::one(),
                efd: bank[best.prototype].1.clone(),
                prototype: Some(best.prototype),
            });
        }
        let _ = &self.basis;
        Ok(Fit {
            scene,
            loss: T::zero(),
            steps,
            stop: StopReason::Converged,
            covariance: Vec::new(),
            ambiguity,
            bits: 0.0,
        })
    }
}
