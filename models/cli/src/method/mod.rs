//! The methods that find a scene: one place that says what each is called, what it starts from and how it is run, whoever asks:
//! `dvp fit` ([`crate::solve`]), `dvp evaluate`, the laboratory.
//!
//! In: a float image, for some methods a start. Out: [`Found`], with the fit's own doubt and the time it took.
//!
//! | file | holds |
//! |---|---|
//! | `mod` | [`Method`], by its name, and its [`Setting`] |
//! | `runner` | [`Runner`]: a method made ready, to be run on many images; the one place that maps names to code |
//! | `task` | [`Tools`] and [`Task`], which go in, and [`Found`], which comes out |
//! | `adam` | descents of pixels, random starts |
//! | `refine` | Levenberg-Marquardt from what a network sees |
//! | `network` | networks, read from a file or built in |
//! | `perturb` | starts near a truth |
//! | `precision` | [`Precision`] |
//! | `clock` | [`timed`] |
//! | `error` | [`MethodError`] |

mod adam;
mod clock;
mod error;
mod network;
mod perturb;
mod precision;
mod refine;
mod runner;
mod task;
#[cfg(all(test, feature = "double"))]
mod tests;

use clap::ValueEnum;

pub use adam::seed_of;
pub use clock::timed;
pub use error::{ClockError, LoadNetworkError, MethodError};
pub use network::{load as load_network, load_divider, load_looking};
pub use perturb::perturbed;
pub use precision::Precision;
pub use runner::Runner;
pub use task::{Found, Memory, Task, Tools};

/// A way from an image to a scene; the value of an option is its name in tables and files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, ValueEnum)]
pub enum Method {
    /// Segmentation, distance samples, Levenberg-Marquardt, with the shapes of a bank
    SegmentBank,
    /// The same, shapes unknown
    SegmentFree,
    /// The paper's OptP: Adam on pose and color, from a start
    OptP,
    /// Levenberg-Marquardt on pose and color at the picture's own edges, from a start
    Lm,
    /// Levenberg-Marquardt at softer edges first, from a start
    LmContinuation,
    /// The paper's Opt-Iter with our settings: objects one by one where the image is worst explained
    OptIter,
    /// The paper's Opt-Iter to the letter
    OptIterPublished,
    /// LIVE with our settings: closed paths of cubics, one by one where the image is worst explained
    Live,
    /// LIVE with its published settings: five paths of four cubics on white
    LivePublished,
    /// The paper's Rand-OptP: Adam from a random scene of as many objects as there are
    RandOptP,
    /// The paper's Rand-OptZ: Adam from random latents, through the heads of a network
    RandOptZ,
    /// What a network sees
    Net,
    /// Levenberg-Marquardt from the objects that a network sees
    NetLm,
    /// The paper's OptP from what a network sees
    NetOptP,
    /// The paper's OptZ: Adam on the latents of what a network sees
    OptZ,
}

/// What a method starts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Start {
    /// The image alone.
    Image,
    /// A scene near the truth.
    Scene,
    /// A random scene, or random latents.
    Random,
    /// What a network sees.
    Network,
}

/// How a method is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Setting {
    /// At most so many of what [`Method::steps_are`] says.
    pub steps: usize,
    /// Numbers that it computes with.
    pub precision: Precision,
}

impl Method {
    /// All of them.
    #[must_use]
    pub fn all() -> &'static [Self] {
        Self::value_variants()
    }

    /// The name, as options, tables and files have it.
    #[must_use]
    pub fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// What it starts from.
    #[must_use]
    pub fn start(self) -> Start {
        match self {
            Self::SegmentBank | Self::SegmentFree => Start::Image,
            Self::OptIter | Self::OptIterPublished | Self::Live | Self::LivePublished => Start::Image,
            Self::OptP | Self::Lm | Self::LmContinuation => Start::Scene,
            Self::RandOptP | Self::RandOptZ => Start::Random,
            Self::Net | Self::NetLm | Self::NetOptP | Self::OptZ => Start::Network,
        }
    }

    /// Whether a network is asked; such methods know f32 only.
    #[must_use]
    pub fn needs_network(self) -> bool {
        self.start() == Start::Network || self == Self::RandOptZ
    }

    /// Whether it works in `precision`.
    #[must_use]
    pub fn knows(self, precision: Precision) -> bool {
        precision == Precision::F32 || !self.needs_network()
    }

    /// What its steps are; where they do not change the result, what does.
    #[must_use]
    pub fn steps_are(self) -> &'static str {
        match self {
            Self::SegmentBank => "joint LM steps",
            Self::SegmentFree => "harmonics",
            Self::Lm => "LM steps",
            Self::LmContinuation | Self::NetLm => "LM steps per sigma",
            Self::OptIter | Self::OptIterPublished | Self::Live | Self::LivePublished => "Adam steps per object",
            Self::OptP | Self::RandOptP | Self::RandOptZ | Self::NetOptP | Self::OptZ => "Adam steps",
            Self::Net => "none",
        }
    }

    /// The steps of the paper, or those of `dvp fit`; in f32.
    #[must_use]
    pub fn default_setting(self) -> Setting {
        let steps = match self {
            Self::SegmentBank => 10,
            Self::SegmentFree => 31,
            Self::Lm => 20,
            Self::LmContinuation | Self::NetLm => 12,
            Self::OptP | Self::RandOptZ | Self::NetOptP | Self::OptZ => 100,
            Self::OptIter | Self::OptIterPublished | Self::RandOptP | Self::LivePublished => 500,
            Self::Live => 60,
            Self::Net => 0,
        };
        Setting { steps, precision: Precision::F32 }
    }
}
