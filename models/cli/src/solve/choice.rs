//! What a user calls a method, and which one that is.

use clap::ValueEnum;

use super::error::SolveError;
use super::solver::Start;
use crate::method::Method;

/// How scenes are found, as `dvp fit --method` says it: with what a fit starts from, that is a [`Method`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
#[non_exhaustive]
pub enum MethodChoice {
    /// Segmentation, distance samples, Levenberg-Marquardt; with --start net Levenberg-Marquardt from what the network sees
    #[default]
    Segment,
    /// The paper's Opt-Iter: objects one by one where the image is worst explained
    OptIter,
    /// LIVE: closed paths of cubics, one by one where the image is worst explained
    Live,
    /// LIVE with its published settings: five paths of four cubics on white
    LivePublished,
    /// The paper's OptP: Adam on pose and color from the scenes of --start
    OptP,
    /// The paper's Rand-OptP: Adam from a random scene
    RandOptP,
}

impl MethodChoice {
    /// The choice of a name: `segment`, `opt-iter`, `live`, `live-published`, `opt-p` or `rand-opt-p`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::from_str(name, false).ok()
    }

    /// Whether it is LIVE, whose objects are paths of as many cubics as one asks for.
    #[must_use]
    pub fn draws_paths(self) -> bool {
        matches!(self, Self::Live | Self::LivePublished)
    }

    pub(super) fn method(self, start: &Start, has_bank: bool) -> Result<Method, SolveError> {
        match (self, start) {
            (Self::Segment, Start::Picture) if has_bank => Ok(Method::SegmentBank),
            (Self::Segment, Start::Picture) => Ok(Method::SegmentFree),
            (Self::Segment, Start::Network(_)) => Ok(Method::NetLm),
            (Self::OptIter, Start::Picture) => Ok(Method::OptIter),
            (Self::Live, Start::Picture) => Ok(Method::Live),
            (Self::LivePublished, Start::Picture) => Ok(Method::LivePublished),
            (Self::OptP, Start::Folder(_)) => Ok(Method::OptP),
            (Self::OptP, Start::Network(_)) => Ok(Method::NetOptP),
            (Self::RandOptP, Start::Picture) => Ok(Method::RandOptP),
            (Self::OptP, Start::Picture) => Err(SolveError::Usage("--method opt-p needs --start DIR, or --start net")),
            (_, Start::Folder(_)) => Err(SolveError::Usage("--start DIR goes with --method opt-p only")),
            (_, Start::Network(_)) => Err(SolveError::Usage("--start net goes with --method segment or opt-p only")),
        }
    }
}
