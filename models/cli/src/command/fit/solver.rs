//! One picture to one fit, by the chosen method.

use core::panic::AssertUnwindSafe;
use core::time::Duration;
use std::panic::catch_unwind;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::ValueEnum;
use cpu_time::ThreadTime;
use dvp_core::render::ContourRenderer;
use dvp_core::shape::REFERENCE_VERTICES;
use dvp_core::{Efd, ImageView, Scene};
use dvp_fit::adam::descent::Descent;
use dvp_fit::opt_iter::OptIter;
use dvp_fit::opt_p::OptP;
use dvp_fit::rand_opt_p::{RandOptP, random_scene};
use dvp_fit::{Bank, Fit, FitOptions, FitScratch, Fitter};

use crate::format::{Place, read_scene};

/// How a scene is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Method {
    /// Segmentation, distance samples, Levenberg-Marquardt: no start needed
    #[default]
    Segment,
    /// The paper's Opt-Iter: objects one by one where the image is worst explained
    OptIter,
    /// The paper's OptP: Adam on pose and color from the scenes of --start
    OptP,
    /// The paper's Rand-OptP: Adam from a random scene
    RandOptP,
}

/// Everything that a method needs, shared between threads.
pub(super) struct Solver {
    pub(super) method: Method,
    pub(super) fitter: Fitter<f32>,
    pub(super) bank: Option<Bank<f32>>,
    /// Folder of `{stem}.json` to start from.
    pub(super) start: Option<PathBuf>,
    pub(super) object_count: usize,
    pub(super) seed: u64,
}

/// Memory of one thread.
pub(super) type Scratch = FitScratch<f32>;

impl Solver {
    pub(super) fn new(
        method: Method,
        options: FitOptions<f32>,
        start: Option<PathBuf>,
        object_count: usize,
        seed: u64,
    ) -> Result<Self> {
        if (method == Method::OptP) != start.is_some() {
            bail!("--method opt-p needs --start DIR, and only that method does");
        }
        let bank = options.bank.clone();
        Ok(Self { method, fitter: Fitter::new(options)?, bank, start, object_count, seed })
    }

    /// The fit, and the processor time that it took on this thread.
    pub(super) fn solve(
        &self,
        image: ImageView<'_, f32>,
        stem: &str,
        scratch: &mut Scratch,
    ) -> Result<(Fit<f32>, Duration)> {
        let start = self.start_scene(stem)?;
        let clock = ThreadTime::try_now().context("the system has no thread clock")?;
        // A defect in the fit of one picture must not cost the others.
        let fit = catch_unwind(AssertUnwindSafe(|| self.run(image, &start, scratch)));
        let time = clock.try_elapsed().context("the system has no thread clock")?;
        match fit {
            Ok(fit) => Ok((fit?, time)),
            Err(_) => {
                *scratch = Scratch::default();
                bail!("the fit failed on this picture, which is a defect of dvp; please report it with the picture")
            }
        }
    }

    /// Where a descent starts; the methods that need no start get an empty scene.
    fn start_scene(&self, stem: &str) -> Result<Scene<f32>> {
        Ok(match (self.method, &self.start) {
            (Method::OptP, Some(folder)) => {
                let path = folder.join(format!("{stem}.json"));
                read_scene(&path)?.to_scene(self.bank.as_ref(), &Place::file(&path))?
            }
            (Method::RandOptP, _) => {
                let circle = [Efd::new(vec![[1.0, 0.0, 0.0, -1.0]]).resized(OptIter::default().harmonic_count)];
                let bank: Option<Vec<_>> =
                    self.bank.as_ref().map(|bank| bank.prototypes.iter().map(|(_, efd)| efd.clone()).collect());
                let shapes = bank.as_deref().unwrap_or(&circle);
                // Every picture has its own start, whichever thread takes it.
                let seed = stem.bytes().fold(self.seed, |seed, byte| seed.wrapping_mul(31).wrapping_add(byte.into()));
                random_scene(self.object_count, shapes, seed)
            }
            _ => Scene::empty([0.0; 3]),
        })
    }

    fn run(&self, image: ImageView<'_, f32>, start: &Scene<f32>, scratch: &mut Scratch) -> Result<Fit<f32>> {
        if self.method == Method::Segment {
            return Ok(self.fitter.fit(image, scratch)?);
        }
        let renderer = ContourRenderer::new(start.edge, start.compositing);
        let opt_iter = OptIter { object_count: self.object_count, ..OptIter::default() };
        let harmonics = start.objects.iter().map(|object| object.efd.harmonic_count()).max().unwrap_or(1);
        let mut descent = Descent::new(&renderer, REFERENCE_VERTICES, harmonics.max(opt_iter.harmonic_count))?;
        Ok(match self.method {
            Method::OptP => OptP::default().fit(&mut descent, image, start)?,
            Method::RandOptP => RandOptP::default().fit(&mut descent, image, start)?,
            Method::OptIter | Method::Segment => opt_iter.fit(&mut descent, image)?,
        })
    }
}
