//! One picture to one fit, by the chosen method.

use core::panic::AssertUnwindSafe;
use core::time::Duration;
use std::panic::catch_unwind;
use std::path::PathBuf;

use clap::ValueEnum;
use dvp_core::loss::{ImagePair, Loss as _};
use dvp_core::render::PixelLoss;
use dvp_core::{Real as _, Scene};
use dvp_fit::opt_iter::OptIter;
use dvp_fit::refine::{Refine, RefineScratch};
use dvp_fit::{Ambiguity, Bank, Fit, FitOptions, FitScratch, Fitter, StopReason};
use dvp_net::propose::Proposer;
use dvp_trace::{Known, PoseDeviation, tuning};

use super::error::SolveError;
use super::openings;
use crate::format::{Picture, Place, read_scene};
use crate::method;
use crate::paint::{PaintScratch, Painter};

/// Where edges leave a doubt, and in coded pictures if that is the shorter description, segments are taken, whose edges are fitted, unless they miss
/// the picture by so many times as much: ringing is read as faces, which come nearer to it but are none.
const CLEARLY_WORSE: f32 = 2.0;

/// The same in coded pictures, which tell nothing of their edges, if the drawing is the shorter description.
const WORSE: f32 = 1.2;

/// How a scene is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Method {
    /// Segmentation, distance samples, Levenberg-Marquardt; with --start net Levenberg-Marquardt from what the network sees
    #[default]
    Segment,
    /// The paper's Opt-Iter: objects one by one where the image is worst explained
    OptIter,
    /// The paper's OptP: Adam on pose and color from the scenes of --start
    OptP,
    /// The paper's Rand-OptP: Adam from a random scene
    RandOptP,
}

/// What a fit starts from.
#[derive(Debug)]
pub enum Start {
    /// What the method makes of the picture itself.
    Picture,
    /// What a network sees.
    Network(Box<Proposer>),
    /// A folder of `{stem}.json`.
    Folder(PathBuf),
}

/// What was found in a picture.
#[derive(Clone, Debug)]
pub struct Solved {
    /// The scene, and what is known of its numbers.
    pub fit: Fit<f32>,
    /// Processor time of the fit alone, on this thread.
    pub time: Duration,
}

/// Everything that a method needs, shared between threads.
#[derive(Debug)]
pub struct Solver {
    method: Method,
    options: FitOptions<f32>,
    fitter: Fitter<f32>,
    start: Start,
    object_count: usize,
    seed: u64,
}

/// Memory of one thread, kept from picture to picture.
#[derive(Debug, Default)]
pub struct Scratch {
    fit: FitScratch<f32>,
    refine: RefineScratch<f32>,
    /// To paint what was found.
    pub paint: PaintScratch<f32>,
}

impl Solver {
    /// A method with its options; `object_count` objects for methods that cannot tell how many there are, random starts drawn
    /// from `seed`.
    ///
    /// # Errors
    /// [`SolveError::Usage`] for a method and a start that do not go together, [`SolveError::Fit`] for options out of range.
    pub fn new(
        method: Method,
        options: FitOptions<f32>,
        start: Start,
        object_count: usize,
        seed: u64,
    ) -> Result<Self, SolveError> {
        let problem = match (&start, method) {
            (Start::Picture, Method::OptP) => "--method opt-p needs --start DIR, or --start net",
            (Start::Folder(_), Method::OptP)
            | (Start::Network(_), Method::OptP | Method::Segment)
            | (Start::Picture, _) => "",
            (Start::Folder(_), _) => "--start DIR goes with --method opt-p only",
            (Start::Network(_), _) => "--start net goes with --method segment or opt-p only",
        };
        if !problem.is_empty() {
            return Err(SolveError::Usage(problem));
        }
        let fitter = Fitter::new(options.clone())?;
        Ok(Self { method, options, fitter, start, object_count, seed })
    }

    /// The fit of a picture, with the openings of a transparent one cut out. `stem` names it: for [`Start::Folder`] its scene is
    /// `{stem}.json`, and random starts differ by it.
    ///
    /// # Errors
    /// [`SolveError`]; of a panic in the fit [`SolveError::Defect`], with `scratch` as new.
    pub fn solve(&self, picture: &Picture<f32>, stem: &str, scratch: &mut Scratch) -> Result<Solved, SolveError> {
        let read = match &self.start {
            Start::Folder(folder) => {
                let path = folder.join(format!("{stem}.json"));
                Some(read_scene(&path)?.to_scene(self.bank(), &Place::file(&path))?)
            }
            _ => None,
        };
        // A defect in the fit of one picture must not cost the others.
        let run = || Ok(catch_unwind(AssertUnwindSafe(|| self.run(picture, read, stem, scratch))));
        let (fit, time) = method::timed(run).map_err(SolveError::Method)?;
        let Ok(fit) = fit else {
            *scratch = Scratch::default();
            return Err(SolveError::Defect);
        };
        let fit = fit?;
        let fit = if picture.transparent { openings::cut_out(fit, picture, &mut scratch.paint)? } else { fit };
        Ok(Solved { fit, time })
    }

    /// The known shapes.
    #[must_use]
    pub fn bank(&self) -> Option<&Bank<f32>> {
        self.options.bank.as_ref()
    }

    fn run(
        &self,
        picture: &Picture<f32>,
        read: Option<Scene<f32>>,
        stem: &str,
        scratch: &mut Scratch,
    ) -> Result<Fit<f32>, SolveError> {
        let image = picture.image.view();
        let start = match &self.start {
            Start::Network(network) => Some(network.objects(image)?),
            _ => read,
        };
        match (self.method, start) {
            (Method::Segment, Some(start)) => {
                let FitOptions { compositing, max_objects, .. } = self.options;
                let (compositing, settings) = (compositing.unwrap_or_default(), Refine::default());
                method::refine(&settings, image, &start, compositing, max_objects, &mut scratch.refine)
                    .map_err(SolveError::Method)
            }
            (Method::Segment, None) => self.segment(picture, scratch),
            (Method::RandOptP, _) => {
                let seed = method::seed_of(stem, self.seed);
                let start = method::random_start(self.bank(), self.object_count, seed);
                method::rand_opt_p(image, &start).map_err(SolveError::Method)
            }
            (Method::OptP, Some(start)) => method::opt_p(image, &start).map_err(SolveError::Method),
            (Method::OptIter | Method::OptP, _) => {
                let opt_iter = OptIter { object_count: self.object_count, ..OptIter::default() };
                method::descend(&Scene::empty([0.0; 3]), |descent| Ok(opt_iter.fit(descent, image)?))
                    .map_err(SolveError::Method)
            }
        }
    }

    /// The picture as a drawing, if it is one: flat colors with clear edges, and nothing known of its objects beforehand. Else, and where edges
    /// leave a doubt and it is nearer to the picture, as segments.
    fn segment(&self, picture: &Picture<f32>, scratch: &mut Scratch) -> Result<Fit<f32>, SolveError> {
        let image = picture.image.view();
        let is_known = self.options.bank.is_some() || self.options.compositing.is_some();
        let known = Known { matte: picture.transparent.then_some(picture.matte), coded: picture.coded };
        let traced = if is_known { None } else { dvp_trace::trace(&image, &known).ok() };
        let Some(traced) = traced else { return Ok(self.fitter.fit(image, &mut scratch.fit)?) };
        let painter = Painter::default();
        let drawing = painter.draw(&traced.scene, image.size())?;
        let painted = painter.paint_in(&traced.scene, image.size(), &mut scratch.paint)?;
        let loss = PixelLoss::Mae.value(ImagePair::new(painted.view(), image)?, &mut ())?;
        let fit = Fit::of_painted(traced.scene, &drawing, &image, painted.data());
        let (covariance, ambiguity) = doubt_of_poses(&traced.deviations);
        let drawn = Fit { loss, bits: traced.bits, stop: StopReason::Converged, covariance, ambiguity, ..fit };
        // Stains of either sign: blur and profiles of their own leave too much of the other side beyond edges, filters that sharpen too little.
        let is_doubtful = traced.stained.abs() > tuning::DOUBTFUL_STAINED;
        if !is_doubtful {
            return Ok(drawn);
        }
        let segments = self.fitter.fit(image, &mut scratch.fit)?;
        let worse = if is_doubtful || segments.bits < drawn.bits { CLEARLY_WORSE } else { WORSE };
        Ok(if segments.loss < worse * drawn.loss { segments } else { drawn })
    }
}

/// What is known of poses as a fit says it: covariances of (x, y, log scale, rotation), NaN where nothing is known, and which objects
/// look alike at every angle.
fn doubt_of_poses(deviations: &[Option<PoseDeviation>]) -> (Vec<[f32; 16]>, Vec<Ambiguity>) {
    if deviations.iter().all(Option::is_none) {
        return (Vec::new(), Vec::new());
    }
    let mut ambiguity = Vec::new();
    let covariance = deviations.iter().enumerate().map(|(object, deviation)| {
        let Some(PoseDeviation { translation: [x, y], log_scale, rotation }) = *deviation else {
            return [f32::NAN; 16];
        };
        if rotation.is_none() {
            ambiguity.push(Ambiguity::Symmetry { object, order: 0 });
        }
        let mut covariance = [0.0_f32; 16];
        for (at, deviation) in [x, y, log_scale, rotation.unwrap_or(0.0)].into_iter().enumerate() {
            covariance[5 * at] = f32::of(deviation * deviation);
        }
        covariance
    });
    let covariance = covariance.collect();
    (covariance, ambiguity)
}
