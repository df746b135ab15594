//! What a method is given, and what it gives back.

use alloc::sync::Arc;
use core::time::Duration;

use dvp_core::{ImageView, Scene};
#[cfg(feature = "double")]
use dvp_fit::FitScratch;
use dvp_fit::paint::Canvas;
use dvp_fit::picture::{Known, PictureScratch};
use dvp_fit::refine::RefineScratch;
use dvp_fit::{Fit, FitOptions};
use dvp_net::propose::Proposer;

#[cfg(doc)]
use super::{Method, Setting};

/// What methods share.
#[derive(Clone, Debug, Default)]
pub struct Tools {
    /// What fits are told, [`Setting::steps`] aside. The bank: the shapes that objects may have; random scenes without one are of
    /// disks.
    pub options: FitOptions<f32>,
    /// For methods that need one.
    pub network: Option<Arc<Proposer>>,
}

/// An image, and what else a method may be told; the default of an image alone is [`Task::of`].
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// What is to be explained.
    pub image: ImageView<'a, f32>,
    /// Of a picture that somebody made: what is known of it beside its pixels. [`Method::SegmentFree`] in f32 then takes it as a
    /// drawing, if it is one, and whatever the method, openings are cut out of transparent ones. None: the pixels of a scene.
    pub known: Option<Known>,
    /// What methods go on from that need a scene near the truth; none: [`Self::truth`], perturbed.
    pub start: Option<&'a Scene<f32>>,
    /// How many objects there are, for Rand-OptP and Opt-Iter, which cannot tell; none: as many as the truth has for the one,
    /// 4 for the other. For LIVE the most; none: 8, or the 5 of its published settings.
    pub objects: Option<usize>,
    /// Cubics of each path of LIVE; none: 4.
    pub segments: Option<usize>,
    /// The true scene.
    pub truth: Option<&'a Scene<f32>>,
    /// Of what is random.
    pub seed: u64,
}

impl<'a> Task<'a> {
    /// An image alone.
    #[must_use]
    pub fn of(image: ImageView<'a, f32>) -> Self {
        Self { image, known: None, start: None, objects: None, segments: None, truth: None, seed: 0 }
    }
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
    pub(super) picture: PictureScratch,
    pub(super) refine: RefineScratch<f32>,
    #[cfg(feature = "double")]
    pub(super) double: (FitScratch<f64>, RefineScratch<f64>),
}

impl Memory {
    /// To paint what was found.
    pub fn canvas(&mut self) -> &mut Canvas<f32> {
        &mut self.picture.canvas
    }
}
