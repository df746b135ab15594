//! A method made ready, to be run on many images.

use core::time::Duration;

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::{Image, ImageView, Real, Scene};
use dvp_fit::live::Live;
use dvp_fit::opt_iter::OptIter;
use dvp_fit::opt_p::OptP;
use dvp_fit::picture::{cut_openings, fit_picture};
use dvp_fit::rand_opt_p::RandOptP;
use dvp_fit::refine::{Refine, RefineScratch};
use dvp_fit::{Fit, FitScratch, Fitter};
use dvp_net::error::NetError;
use dvp_net::optimize::{OptZ, Optimum};
use dvp_net::propose::Proposer;
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use super::adam::{descend, random_start};
use super::error::MethodError;
use super::refine::refine;
use super::task::{Found, Memory, Task, Tools};
use super::{Method, Precision, Setting, perturbed, timed};
use crate::paint::Painter;

/// What a method found, and the processor time that it took.
type Timed<T> = Result<(Fit<T>, Duration), MethodError>;

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
    /// [`MethodError`] if the tools lack what it needs, options are out of range, or it does not know the precision.
    pub fn new(method: Method, setting: Setting, tools: &Tools) -> Result<Self, MethodError> {
        if !method.knows(setting.precision) {
            return Err(MethodError::Precision(method));
        }
        if method.needs_network() && tools.network.is_none() {
            return Err(MethodError::NeedsNetwork(method));
        }
        let own = tools.options.clone();
        let options = match method {
            Method::SegmentBank if own.bank.is_none() => return Err(MethodError::NeedsBank(method)),
            Method::SegmentBank => Some(own.with_max_steps(setting.steps)),
            Method::SegmentFree => Some(own.with_bank(None).with_max_harmonics(setting.steps)),
            _ => None,
        };
        let mut runner = Self {
            method,
            setting,
            tools: tools.clone(),
            single: None,
            #[cfg(feature = "double")]
            double: None,
        };
        if let Some(options) = options {
            match setting.precision {
                Precision::F32 => runner.single = Some(Fitter::new(options)?),
                #[cfg(feature = "double")]
                Precision::F64 => runner.double = Some(Fitter::new(options.cast())?),
            }
        }
        Ok(runner)
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

    /// What it was made ready with.
    #[must_use]
    pub fn tools(&self) -> &Tools {
        &self.tools
    }

    /// The scene of an image.
    ///
    /// # Errors
    /// [`MethodError`] if the task lacks what the method starts from, or the method refuses the image or the start.
    pub fn run(&self, task: &Task<'_>, memory: &mut Memory) -> Result<Found, MethodError> {
        let (fit, cpu) = match (&self.single, &task.known) {
            (Some(fitter), Some(known)) => {
                timed(|| Ok::<_, MethodError>(fit_picture(fitter, task.image, known, &mut memory.picture)?))?
            }
            (_, known) => {
                let (fit, cpu) = self.find(task, memory)?;
                match known.and_then(|known| known.matte) {
                    None => (fit, cpu),
                    Some(matte) => {
                        let cut = || Ok::<_, MethodError>(cut_openings(fit, task.image, matte, memory.canvas())?);
                        let (fit, more) = timed(cut)?;
                        (fit, cpu + more)
                    }
                }
            }
        };
        let mut there = fit.scene.clone();
        there.keep_visible();
        Ok(Found { fit, there, cpu })
    }

    fn find(&self, task: &Task<'_>, memory: &mut Memory) -> Timed<f32> {
        match (&self.tools.network, self.setting.precision) {
            (Some(network), _) if self.method.needs_network() => self.see(network, task, &mut memory.refine),
            (_, Precision::F32) => self.fit(self.single.as_ref(), task, &mut memory.picture.fit, &mut memory.refine),
            #[cfg(feature = "double")]
            (_, Precision::F64) => {
                let (fit, refine) = &mut memory.double;
                let (fit, cpu) = self.fit(self.double.as_ref(), task, fit, refine)?;
                Ok((fit.cast(), cpu))
            }
        }
    }

    /// Without a network.
    fn fit<T: Real>(
        &self,
        fitter: Option<&Fitter<T>>,
        task: &Task<'_>,
        scratch: &mut FitScratch<T>,
        refine: &mut RefineScratch<T>,
    ) -> Timed<T> {
        let values = task.image.data().iter().map(|value| T::of(value.as_f64())).collect();
        let image = Image::from_planar(task.image.size(), values)?;
        let (image, steps) = (image.view(), self.setting.steps);
        match (self.method, fitter) {
            (Method::SegmentBank | Method::SegmentFree, Some(fitter)) => timed(|| Ok(fitter.fit(image, scratch)?)),
            (Method::OptP, _) => {
                let (start, settings) = (self.start(task)?, OptP::default().with_steps(steps));
                descend(&start, |descent| timed(|| Ok(settings.fit(descent, image, &start)?)))
            }
            (Method::RandOptP, _) => {
                let (start, mut settings) = (self.start(task)?, RandOptP::default());
                settings.shape.0 = steps / 2;
                settings.pose.0 = steps - settings.shape.0;
                descend(&start, |descent| timed(|| Ok(settings.fit(descent, image, &start)?)))
            }
            (Method::OptIter | Method::OptIterPublished, _) => {
                let is_ours = self.method == Method::OptIter;
                let mut settings = if is_ours { OptIter::default() } else { OptIter::published() };
                let part = steps / 5;
                (settings.pose.0, settings.shape.0, settings.finish.0) = (part, steps - part, part);
                settings.object_count = task.objects.unwrap_or(settings.object_count);
                descend(&Scene::empty([T::zero(); 3]), |descent| timed(|| Ok(settings.fit(descent, image)?)))
            }
            (Method::Live | Method::LivePublished, _) => {
                let settings = self.live_settings(task);
                let compositing = self.tools.options.compositing.unwrap_or(Compositing::Over);
                timed(|| Ok(settings.fit(image, EdgeProfile::area(), compositing)?))
            }
            (Method::Lm | Method::LmContinuation, _) => {
                let (start, settings) = (self.start(task)?, self.refine_settings());
                timed(|| Ok(settings.fit(image, &start, refine)?))
            }
            // Refused by `new`.
            (method @ (Method::SegmentBank | Method::SegmentFree), None) => Err(MethodError::NeedsBank(method)),
            (method @ (Method::Net | Method::NetLm | Method::NetOptP | Method::OptZ | Method::RandOptZ), _) => {
                Err(MethodError::NeedsNetwork(method))
            }
        }
    }

    fn live_settings(&self, task: &Task<'_>) -> Live {
        let mut settings = if self.method == Method::Live { Live::default() } else { Live::published() };
        settings.layer_steps = self.setting.steps;
        settings.shape_count = task.objects.unwrap_or(settings.shape_count);
        settings.segment_count = task.segments.unwrap_or(settings.segment_count);
        settings
    }

    fn refine_settings(&self) -> Refine {
        let settings = Refine::default().with_max_steps(self.setting.steps);
        if self.method == Method::Lm { settings.with_factors(&[1.0]) } else { settings }
    }

    /// What a method goes on from that does not ask a network.
    fn start<T: Real>(&self, task: &Task<'_>) -> Result<Scene<T>, MethodError> {
        let start = match (task.start, task.truth) {
            (Some(start), _) => start.clone(),
            (None, truth) if self.method == Method::RandOptP => {
                let count = task.objects.or_else(|| truth.map(|truth| truth.objects.len()));
                let count = count.ok_or(MethodError::NeedsCount(self.method))?;
                random_start(self.tools.options.bank.as_ref(), count, task.seed)
            }
            (None, Some(truth)) => perturbed(truth, &mut ChaCha8Rng::seed_from_u64(task.seed)),
            (None, None) => return Err(MethodError::NeedsStart(self.method)),
        };
        Ok(start.cast())
    }

    /// With a network.
    fn see(&self, network: &Proposer, task: &Task<'_>, scratch: &mut RefineScratch<f32>) -> Timed<f32> {
        let (image, steps) = (task.image, self.setting.steps);
        let opt_z = OptZ::default().with_steps(steps);
        match self.method {
            Method::RandOptZ => fit_of(image, || network.rand_opt_z(image, &opt_z, task.seed)),
            Method::OptZ => fit_of(image, || network.opt_z(image, &opt_z)),
            Method::NetOptP => timed(|| {
                let start = network.objects(image)?;
                descend(&start, |descent| Ok(OptP::default().with_steps(steps).fit(descent, image, &start)?))
            }),
            Method::NetLm => timed(|| {
                let (start, options) = (network.objects(image)?, &self.tools.options);
                refine(&self.refine_settings(), image, &start, options.compositing, options.max_objects, scratch)
            }),
            _ => fit_of(image, || {
                let scene = network.objects(image)?;
                Ok(Optimum { scene, loss: f64::NAN, losses: vec![f64::NAN] })
            }),
        }
    }
}

/// What a descent of latents, or a network alone, finds, as a fit that doubts what it leaves unexplained; with the time it took.
fn fit_of(image: ImageView<'_, f32>, find: impl FnOnce() -> Result<Optimum<f32>, NetError>) -> Timed<f32> {
    let (found, cpu) = timed(|| Ok::<_, MethodError>(find()?))?;
    let painter = Painter::default();
    let (drawing, painted) = (painter.draw(&found.scene, image.size())?, painter.paint(&found.scene, image.size())?);
    let mut fit = Fit::of_painted(found.scene, &drawing, &image, painted.data());
    fit.loss = f32::of(found.loss);
    fit.steps = found.losses.len().saturating_sub(1);
    Ok((fit, cpu))
}
