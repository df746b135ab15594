//! One picture to one fit, by the chosen method.

use core::panic::AssertUnwindSafe;
use core::time::Duration;
use std::panic::catch_unwind;
use std::path::PathBuf;

use clap::ValueEnum;
use dvp_core::Scene;
use dvp_fit::opt_iter::OptIter;
use dvp_fit::paint::Canvas;
use dvp_fit::picture::{Known, PictureScratch, cut_openings, fit_picture};
use dvp_fit::refine::{Refine, RefineScratch};
use dvp_fit::{Bank, Fit, FitOptions, Fitter};
use dvp_net::propose::Proposer;

use super::error::SolveError;
use crate::format::{Picture, Place, read_scene};
use crate::method;

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
#[non_exhaustive]
pub struct Solved {
    /// The scene, and what is known of its numbers.
    pub fit: Fit<f32>,
    /// Processor time of the fit alone, with the cutting of openings, on this thread.
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
    picture: PictureScratch,
    refine: RefineScratch<f32>,
}

impl Scratch {
    /// To paint what was found.
    pub fn canvas(&mut self) -> &mut Canvas<f32> {
        &mut self.picture.canvas
    }
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
        Ok(Solved { fit: fit?, time })
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
        let matte = picture.transparent.then_some(picture.matte);
        let start = match &self.start {
            Start::Network(network) => Some(network.objects(image)?),
            _ => read,
        };
        let fit = match (self.method, start) {
            (Method::Segment, None) => {
                let known = Known { matte, coded: picture.coded };
                return Ok(fit_picture(&self.fitter, image, &known, &mut scratch.picture)?);
            }
            (Method::Segment, Some(start)) => {
                let FitOptions { compositing, max_objects, .. } = self.options;
                let (compositing, settings) = (compositing.unwrap_or_default(), Refine::default());
                method::refine(&settings, image, &start, compositing, max_objects, &mut scratch.refine)
                    .map_err(SolveError::Method)
            }
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
        }?;
        match matte {
            Some(matte) => Ok(cut_openings(fit, image, matte, scratch.canvas())?),
            None => Ok(fit),
        }
    }
}
