//! Why a method found no scene.

use std::io;
use std::path::PathBuf;

use dvp_core::image::ImageError;
use dvp_fit::FitError;
use dvp_fit::adam::descent::DescentError;
use dvp_net::error::NetError;

use super::Method;
use crate::paint::PaintError;

/// Why a method was not made ready, or found no scene.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MethodError {
    /// The method does not know the precision that was asked for.
    #[error("{} computes in f32 only", .0.name())]
    Precision(Method),
    /// The method asks a network, and there is none.
    #[error("{} needs a network", .0.name())]
    NeedsNetwork(Method),
    /// The method takes shapes from a bank, and there is none.
    #[error("{} needs a bank", .0.name())]
    NeedsBank(Method),
    /// The method goes on from a scene, and there is none.
    #[error("{} needs a start, or the truth to make one from", .0.name())]
    NeedsStart(Method),
    /// The method starts from as many objects as there are, and nobody says how many.
    #[error("{} must know how many objects there are (scenes.jsonl)", .0.name())]
    NeedsCount(Method),
    /// The fit refused the picture, its options or the start.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// A descent of Adam was refused or broken off.
    #[error(transparent)]
    Descent(#[from] DescentError),
    /// The network refused the picture.
    #[error(transparent)]
    Network(#[from] NetError),
    /// What the network sees could not be painted.
    #[error(transparent)]
    Paint(#[from] PaintError),
    /// The picture cannot be had in the precision that was asked for.
    #[error(transparent)]
    Image(#[from] ImageError),
    /// No processor time can be told.
    #[error(transparent)]
    Clock(#[from] ClockError),
}

/// The system has no clock that tells the processor time of a thread.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the system has no thread clock")]
pub struct ClockError;

/// Why there is no network.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadNetworkError {
    /// The file of its weights cannot be read.
    #[error("{path} cannot be read", path = path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The file holds no network.
    #[error("{path}", path = path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: Box<NetError>,
    },
    /// The network that comes with the program is broken.
    #[error("the network that is built in")]
    BuiltIn(#[source] Box<NetError>),
}
