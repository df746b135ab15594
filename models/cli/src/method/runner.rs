//! A method made ready, to be run on many images.

use alloc::sync::Arc;
use core::time::Duration;

use anyhow::{Context, Result, bail};
use cpu_time::ThreadTime;
use dvp_core::render::Compositing;
use dvp_core::{Image, ImageView, Real, Scene};
use dvp_fit::opt_iter::OptIter;
use dvp_fit::opt_p::OptP;
use dvp_fit::rand_opt_p::RandOptP;
use dvp_fit::refine::{Refine, RefineScratch};
use dvp_fit::{Bank, Fit, FitOptions, FitScratch, Fitter};
use dvp_net::optimize::{OptZ, Optimum};
use dvp_net::propose::Proposer;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use super::{Method, Precision, Setting, adam, perturbed, precision, refine};
use crate::paint::Painter;

/// What methods share.
#[derive(Clone, Debug, Default)]
pub struct Tools {
    /// The shapes that objects may have; random scenes without one are of disks.
    pub bank: Option<Bank<f32>>,
    /// For methods that need one.
    pub network: Option<Arc<Proposer>>,
}

/// An image, and what else a method may be told.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// What is to be explained.
    pub image: ImageView<'a, f32>,
    /// What methods go on from that need a scene near the truth; none: [`Self::truth`], perturbed.
    pub start: Option<&'a Scene<f32>>,
    /// The true scene: tells Rand-OptP how many objects there are.
    pub truth: Option<&'a Scene<f32>>,
    /// Of what is random.
    pub seed: u64,
}

/// What a method found.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Found {
    /// The scene that is painted (of latents with every slot, opaque as it is confident), how it was reached, and what the
    /// method itself doubts. What a method does not know is empty or NaN; a network alone takes no step.
    pub fit: Fit<f32>,
    /// Its objects of a confidence above 1/2: those that count.
    pub there: Scene<f32>,
    /// Processor time on this thread, without what is prepared once.
    pub cpu: Duration,
}

/// Memory of one thread, for any runner.
#[derive(Debug, Default)]
pub struct Memory {
    single: Scratch<f32>,
    #[cfg(feature = "double")]
    double: Scratch<f64>,
}

#[derive(Debug, Default)]
struct Scratch<T: Real> {
    fit: FitScratch<T>,
    refine: RefineScratch<T>,
}

/// A method with its setting, made ready; threads share it.
#[derive(Debug)]
pub struct Runner {
    method: Method,
    setting: Setting,
    tools: Tools,
    single: Option<Fitter<f32>>,
    #[cfg(feature = "double")]
    double: Option<Fitter<f64>>,
}

impl Runner {
    /// Prepares `method`.
    ///
    /// # Errors
    /// If the tools lack what it needs, or it does not know the precision.
    pub fn new(method: Method, setting: Setting, tools: &Tools) -> Result<Self> {
        let name = method.name();
        if !method.knows(setting.precision) {
            bail!("{name} computes in f32 only");
        }
        if method.needs_network() && tools.network.is_none() {
            bail!("{name} needs a network");
        }
        if method == Method::SegmentBank && tools.bank.is_none() {
            bail!("{name} needs a bank");
        }
        let mut runner = Self {
            method,
            setting,
            tools: tools.clone(),
            single: None,
            #[cfg(feature = "double")]
            double: None,
        };
        if matches!(method, Method::SegmentBank | Method::SegmentFree) {
            match setting.precision {
                Precision::F32 => runner.single = Some(runner.fitter()?),
                #[cfg(feature = "double")]
                Precision::F64 => runner.double = Some(runner.fitter()?),
            }
        }
        Ok(runner)
    }

    fn fitter<T: Real>(&self) -> Result<Fitter<T>> {
        let options = match &self.tools.bank {
            Some(bank) if self.method == Method::SegmentBank => {
                FitOptions { bank: Some(precision::bank(bank)), max_steps: self.setting.steps, ..Default::default() }
            }
            _ => FitOptions { max_harmonics: self.setting.steps, ..Default::default() },
        };
        Ok(Fitter::new(options)?)
    }

    /// The method.
    #[must_use]
    pub fn method(&self) -> Method {
        self.method
    }

    /// How it is run.
    #[must_use]
    pub fn setting(&self) -> Setting {
        self.setting
    }

    /// The scene of an image.
    ///
    /// # Errors
    /// If the task lacks what the method starts from, or the method refuses the image or the start.
    pub fn run(&self, task: &Task<'_>, memory: &mut Memory) -> Result<Found> {
        let (fit, cpu) = match (&self.tools.network, self.setting.precision) {
            (Some(network), _) if self.method.needs_network() => self.see(network, task, &mut memory.single)?,
            (_, Precision::F32) => self.fit(self.single.as_ref(), task, &mut memory.single)?,
            #[cfg(feature = "double")]
            (_, Precision::F64) => {
                let (fit, cpu) = self.fit(self.double.as_ref(), task, &mut memory.double)?;
                (fit.cast(), cpu)
            }
        };
        let mut there = fit.scene.clone();
        there.keep_visible();
        Ok(Found { fit, there, cpu })
    }

    /// Without a network.
    fn fit<T: Real>(
        &self,
        fitter: Option<&Fitter<T>>,
        task: &Task<'_>,
        scratch: &mut Scratch<T>,
    ) -> Result<(Fit<T>, Duration)> {
        let values = task.image.data().iter().map(|value| T::of(value.as_f64())).collect();
        let image = Image::from_planar(task.image.size(), values)?;
        let (image, steps) = (image.view(), self.setting.steps);
        match self.method {
            Method::OptP => {
                let start = self.start(task)?;
                let settings = OptP { steps, ..OptP::default() };
                adam::descend(&start, |descent| timed(|| Ok(settings.fit(descent, image, &start)?)))
            }
            Method::RandOptP => {
                let start = self.start(task)?;
                let RandOptP { pose, shape, contour_length } = RandOptP::default();
                let free = steps / 2;
                let settings = RandOptP { pose: (steps - free, pose.1), shape: (free, shape.1), contour_length };
                adam::descend(&start, |descent| timed(|| Ok(settings.fit(descent, image, &start)?)))
            }
            Method::OptIter | Method::OptIterPublished => {
                let own = if self.method == Method::OptIter { OptIter::default() } else { OptIter::published() };
                let part = steps / 5;
                let settings = OptIter {
                    pose: (part, own.pose.1),
                    shape: (steps - part, own.shape.1),
                    finish: (part, own.finish.1),
                    ..own
                };
                adam::descend(&Scene::empty([T::zero(); 3]), |descent| timed(|| Ok(settings.fit(descent, image)?)))
            }
            Method::Lm | Method::LmContinuation => {
                let start = self.start(task)?;
                let settings = self.refine_settings();
                timed(|| Ok(settings.fit(image, &start, &mut scratch.refine)?))
            }
            _ => {
                let fitter = fitter.context("no fitter was prepared")?;
                timed(|| Ok(fitter.fit(image, &mut scratch.fit)?))
            }
        }
    }

    fn refine_settings(&self) -> Refine {
        let own = Refine::default();
        let factors = if self.method == Method::Lm { &[1.0] } else { own.factors };
        Refine { factors, max_steps: self.setting.steps, ..own }
    }

    /// What a method goes on from that does not ask a network.
    fn start<T: Real>(&self, task: &Task<'_>) -> Result<Scene<T>> {
        let name = self.method.name();
        let start = match (task.start, task.truth) {
            (Some(start), _) => start.clone(),
            (None, Some(truth)) if self.method == Method::RandOptP => {
                adam::random_start(self.tools.bank.as_ref(), truth.objects.len(), task.seed)
            }
            (None, Some(truth)) => perturbed(truth, &mut ChaCha8Rng::seed_from_u64(task.seed)),
            (None, None) if self.method == Method::RandOptP => {
                bail!("{name} must know how many objects there are (scenes.jsonl)")
            }
            (None, None) => bail!("{name} needs a start, or the truth to make one from"),
        };
        Ok(start.cast())
    }

    /// With a network.
    fn see(&self, network: &Proposer, task: &Task<'_>, scratch: &mut Scratch<f32>) -> Result<(Fit<f32>, Duration)> {
        let (image, steps) = (task.image, self.setting.steps);
        let opt_z = OptZ { steps, ..OptZ::default() };
        match self.method {
            Method::RandOptZ => fit_of(image, timed(|| Ok(network.rand_opt_z(image, &opt_z, task.seed)?))?),
            Method::OptZ => fit_of(image, timed(|| Ok(network.opt_z(image, &opt_z)?))?),
            Method::NetOptP => {
                let settings = OptP { steps, ..OptP::default() };
                timed(|| {
                    let start = network.objects(image)?;
                    adam::descend(&start, |descent| Ok(settings.fit(descent, image, &start)?))
                })
            }
            Method::NetLm => {
                let settings = self.refine_settings();
                timed(|| {
                    let start = network.objects(image)?;
                    refine(&settings, image, &start, Compositing::default(), usize::MAX, &mut scratch.refine)
                })
            }
            _ => {
                let (scene, cpu) = timed(|| Ok(network.objects(image)?))?;
                fit_of(image, (Optimum { scene, loss: f64::NAN, losses: vec![f64::NAN] }, cpu))
            }
        }
    }
}

/// What `work` makes, and the processor time that it took on this thread.
///
/// # Errors
/// Those of `work`, or if the system has no thread clock.
pub fn timed<R>(work: impl FnOnce() -> Result<R>) -> Result<(R, Duration)> {
    const NO_CLOCK: &str = "the system has no thread clock";
    let clock = ThreadTime::try_now().context(NO_CLOCK)?;
    let result = work()?;
    Ok((result, clock.try_elapsed().context(NO_CLOCK)?))
}

/// A descent of latents, or a network alone, as a fit that doubts what it leaves unexplained; with the time it took.
fn fit_of(image: ImageView<'_, f32>, (found, cpu): (Optimum<f32>, Duration)) -> Result<(Fit<f32>, Duration)> {
    let painter = Painter::default();
    let (drawing, painted) = (painter.draw(&found.scene, image.size())?, painter.paint(&found.scene, image.size())?);
    let mut fit = Fit::of_painted(found.scene, &drawing, &image, painted.data());
    fit.loss = f32::of(found.loss);
    fit.steps = found.losses.len().saturating_sub(1);
    Ok((fit, cpu))
}
