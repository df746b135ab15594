//! Segment-and-fit: the pipeline from an image to a [`Fit`].

use alloc::vec::Vec;

use dvp_core::render::contour::ContourRenderer;
use dvp_core::render::{EdgeProfile, Renderer};
use dvp_core::scene::Pose;

use dvp_core::shape::{OutlineBasis, REFERENCE_VERTICES, SYMMETRY_TOLERANCE, Symmetry};
use dvp_core::{Drawing, Efd, ImageView, Object, Real, Scene};

use crate::joint::{JointObject, JointProblem, JointScene, JointScratch, refine};
use crate::pose::field::OutlineField;
use crate::pose::search::{Candidate, Effort, Prototype, search};
use crate::residual::Residual;
use crate::segment::{EdgeKind, EdgeSample, SegmentOptions, Segmentation};
use crate::free::basis::Basis;
use crate::free::grow::{grow, hold_outside};
use crate::free::outline_fit::OutlineScratch;
use crate::free::start::{StartScratch, shrink, trace};
use crate::{Ambiguity, Fit, FitError, FitOptions, StopReason};

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
    free: OutlineScratch<T>,
    samples: Vec<EdgeSample<T>>,
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
            free: OutlineScratch::default(),
            samples: Vec::new(),
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

/// An object whose rendering misses the image by this much in some channel ...
const VISIBLE_ERROR: f64 = 0.03;
/// ... in more than this many pixels is searched for again, with more starts.
const VISIBLE_PIXELS: usize = 4;
/// Candidates of the wide search that are rendered.
const RENDERED_CANDIDATES: usize = 8;

impl<T: Real> Fitter<T> {
    /// Prepares the shapes of the bank.
    ///
    /// # Errors
    /// [`FitError`] if a prototype is no closed shape or a setting is out of range.
    pub fn new(options: FitOptions<T>) -> Result<Self, FitError> {
        let bank = options.bank.as_ref().map_or(&[][..], |bank| &bank.prototypes);
        let harmonics = bank.iter().map(|(_, efd)| efd.harmonic_count()).max().unwrap_or(1);
        let outlines = OutlineBasis::new(REFERENCE_VERTICES, harmonics.max(options.max_harmonics).max(1))?;
        let mut prototypes = Vec::with_capacity(bank.len());
        for (index, (_, efd)) in bank.iter().enumerate() {
            let mut outline = alloc::vec![[T::zero(); 2]; REFERENCE_VERTICES];
            outlines.outline(efd.rows(), &mut outline).map_err(|source| FitError::Prototype { index, source })?;
            let field = OutlineField::new(&outline).ok_or(FitError::FlatPrototype { index })?;
            let symmetry = symmetry_order(efd);
            prototypes.push(Prototype { outline, field, symmetry });
        }
        let basis = Basis::new(REFERENCE_VERTICES, options.max_harmonics);
        Ok(Self { options, prototypes, outlines, basis })
    }

    /// From pixels to a scene.
    ///
    /// # Errors
    /// [`FitError::NotFinite`] for an image with NaN or infinity.
    pub fn fit(&self, image: ImageView<'_, T>, scratch: &mut FitScratch<T>) -> Result<Fit<T>, FitError> {
        scratch.segmentation.read(&image, &SegmentOptions::default());
        let kind = self.options.edge.map_or_else(|| scratch.segmentation.edge_kind(), EdgeKind::Profile);
        scratch.segmentation.gather(image.size(), &kind);
        let edge = kind.profile(T::of_usize(image.size().unit_px()));
        if self.options.bank.is_none() {
            return self.fit_free(&image, edge, scratch);
        }
        let mut found = JointScene { background: scratch.segmentation.background(), objects: Vec::new() };
        let mut steps = 0;
        let mut sources = Vec::new();
        for (index, segment) in scratch.segmentation.segments().iter().enumerate() {
            let effort = Effort::Usual;
            search(segment, &self.prototypes, image.size(), &scratch.segmentation, effort, &mut scratch.candidates);
            let Some(best) = scratch.candidates.first() else { continue };
            steps += best.steps;
            sources.push(index);
            found.objects.push(joint_object(best, segment.color));
        }
        let mut loss = self.compare(&image, edge, &found, scratch)?;
        for at in 0..found.objects.len() {
            if self.misses(&image, &found, at, scratch) {
                loss = self.search_again(&image, edge, &mut found, at, sources[at], loss, scratch)?;
            }
        }
        let mut stop = StopReason::Converged;
        let refined = found.objects.len() <= 64 && self.options.max_steps > 0 && loss > T::of(4e-4);
        if refined {
            let problem = JointProblem {
                image,
                shapes: &self.prototypes,
                edge,
                compositing: self.options.compositing,
                colors: false,
                width: T::of(0.05),
            };
            let mut moved = found.clone();
            let result = refine(&problem, &mut moved, self.options.max_steps, &mut scratch.joint);
            steps += result.steps;
            stop = result.stop;
            let after = self.compare(&image, edge, &moved, scratch)?;
            if after < loss {
                (found, loss) = (moved, after);
            }
        }
        Ok(self.report(&image, edge, &found, loss, steps, stop))
    }

    fn fit_free(
        &self,
        image: &ImageView<'_, T>,
        edge: EdgeProfile<T>,
        scratch: &mut FitScratch<T>,
    ) -> Result<Fit<T>, FitError> {
        let unit = T::of_usize(image.size().unit_px());
        let (width, height) = (T::of_usize(image.size().width()), T::of_usize(image.size().height()));
        let mut scene = Scene {
            background: scratch.segmentation.background(),
            objects: Vec::new(),
            edge,
            compositing: self.options.compositing,
        };
        let mut steps = 0;
        for (index, segment) in (0..).zip(scratch.segmentation.segments()) {
            let Some(contour) = trace(segment, index, &scratch.segmentation, image.size(), &mut scratch.start) else {
                continue;
            };
            scratch.samples.clear();
            scratch.samples.extend_from_slice(&segment.samples);
            if segment.border > 0 {
                hold_outside(&contour, width, height, &mut scratch.samples);
            }
            let (most, vertices) = (self.options.max_harmonics, REFERENCE_VERTICES);
            let half_coverage = edge.offset.max(T::zero()).sqrt() * unit * T::of(0.5);
            let contour = shrink(&contour, half_coverage);
            let grown = grow(&contour, &scratch.samples, &self.basis, vertices, most, &mut scratch.free);
            let Some(grown) = grown else { continue };
            steps += grown.steps;
            let Ok(normal) = Efd::new(grown.outline.rows).normalize() else { continue };
            scene.objects.push(Object {
                pose: Pose {
                    translation: grown.outline.center.map(|v| v / unit),
                    scale: normal.scale / unit,
                    rotation: normal.rotation,
                },
                color: segment.color,
                confidence: T::one(),
                efd: normal.efd,
                prototype: None,
            });
        }
        scene.draw(&self.outlines, &mut scratch.drawing)?;
        let loss = self.compare_drawing(image, edge, scratch)?;
        let stop = StopReason::Converged;
        Ok(Fit { scene, loss, steps, stop, covariance: Vec::new(), ambiguity: Vec::new(), bits: 0.0 })
    }

    /// Renders `found` and keeps its residual; returns the mean absolute error.
    fn compare(
        &self,
        image: &ImageView<'_, T>,
        edge: EdgeProfile<T>,
        found: &JointScene<T>,
        scratch: &mut FitScratch<T>,
    ) -> Result<T, FitError> {
        let unit = T::of_usize(image.size().unit_px());
        scratch.drawing.clear();
        scratch.drawing.background = found.background;
        for object in &found.objects {
            let frame = crate::pose::gauss_newton::Frame::new(&object.pose);
            scratch.outline.clear();
            let unit_outline = &self.prototypes[object.shape].outline;
            scratch.outline.extend(unit_outline.iter().map(|&v| frame.to_pixels(v).map(|x| x / unit)));
            scratch.drawing.push(&scratch.outline, object.color, object.confidence);
        }
        self.compare_drawing(image, edge, scratch)
    }

    /// Renders the drawing of the scratch and keeps its residual; returns the mean absolute error.
    fn compare_drawing(
        &self,
        image: &ImageView<'_, T>,
        edge: EdgeProfile<T>,
        scratch: &mut FitScratch<T>,
    ) -> Result<T, FitError> {
        scratch.pixels.resize(image.data().len(), T::zero());
        let renderer = ContourRenderer::new(edge, self.options.compositing);
        renderer.render(&scratch.drawing, image.size(), &mut scratch.render, &mut scratch.pixels)?;
        Ok(scratch.residual.measure(image, &scratch.pixels))
    }

    fn misses(&self, image: &ImageView<'_, T>, found: &JointScene<T>, at: usize, scratch: &FitScratch<T>) -> bool {
        let object = &found.objects[at];
        let reach = object.pose.log_scale.exp() * self.prototypes[object.shape].field.radius + T::of(2.0);
        let missed = scratch.residual.count_above(image.size(), object.pose.translation, reach, T::of(VISIBLE_ERROR));
        missed > VISIBLE_PIXELS
    }

    #[expect(clippy::too_many_arguments, reason = "one step of the pipeline, its state is named piece by piece")]
    fn search_again(
        &self,
        image: &ImageView<'_, T>,
        edge: EdgeProfile<T>,
        found: &mut JointScene<T>,
        at: usize,
        source: usize,
        loss: T,
        scratch: &mut FitScratch<T>,
    ) -> Result<T, FitError> {
        let mut candidates = core::mem::take(&mut scratch.candidates);
        let segment = &scratch.segmentation.segments()[source];
        search(segment, &self.prototypes, image.size(), &scratch.segmentation, Effort::Wide, &mut candidates);
        let color = segment.color;
        let mut best = (loss, found.objects[at]);
        for candidate in candidates.iter().take(RENDERED_CANDIDATES) {
            found.objects[at] = joint_object(candidate, color);
            let loss = self.compare(image, edge, found, scratch)?;
            if loss < best.0 {
                best = (loss, found.objects[at]);
            }
        }
        scratch.candidates = candidates;
        found.objects[at] = best.1;
        self.compare(image, edge, found, scratch)
    }

    fn report(
        &self,
        image: &ImageView<'_, T>,
        edge: EdgeProfile<T>,
        found: &JointScene<T>,
        loss: T,
        steps: usize,
        stop: StopReason,
    ) -> Fit<T> {
        let unit = T::of_usize(image.size().unit_px());
        let bank = self.options.bank.as_ref().map_or(&[][..], |bank| &bank.prototypes);
        let mut ambiguity = Vec::new();
        let objects = found.objects.iter().enumerate().map(|(object, part)| {
            ambiguity.push(Ambiguity::Symmetry { object, order: self.prototypes[part.shape].symmetry });
            Object {
                pose: Pose {
                    translation: part.pose.translation.map(|v| v / unit),
                    scale: part.pose.log_scale.exp() / unit,
                    rotation: part.pose.rotation,
                },
                color: part.color,
                confidence: part.confidence,
                efd: bank[part.shape].1.clone(),
                prototype: Some(part.shape),
            }
        });
        let scene = Scene {
            background: found.background,
            objects: objects.collect(),
            edge,
            compositing: self.options.compositing,
        };
        Fit { scene, loss, steps, stop, covariance: Vec::new(), ambiguity, bits: 0.0 }
    }
}

fn joint_object<T: Real>(candidate: &Candidate<T>, color: [T; 3]) -> JointObject<T> {
    JointObject { shape: candidate.prototype, pose: candidate.pose, color, confidence: T::one() }
}

/// Symmetry order of a shape, 0 for a disk.
fn symmetry_order<T: Real>(efd: &Efd<T>) -> usize {
    match efd.symmetry(T::of(SYMMETRY_TOLERANCE)) {
        Symmetry::Finite(order) => order,
        Symmetry::Continuous => 0,
    }
}
