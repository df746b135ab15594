//! What decomposers take: images of their side, and chance.

use dvp_core::tensor::{Backend, Tensor, TensorError};
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use crate::error::{NetError, require};
use crate::initial::normal;

/// How many images there are, batch x 3 x side x side.
///
/// # Errors
/// [`NetError::Input`] for other extents, or none.
pub(super) fn batch_of<B: Backend>(images: &Tensor<B>, side: usize) -> Result<usize, NetError> {
    match *images.dims().extents() {
        [batch, 3, h, w] if h == side && w == side && batch > 0 => Ok(batch),
        _ => {
            let must = "must be batch x 3 x side x side, with the side of the model's sizes";
            Err(NetError::Input { input: "images", dims: *images.dims(), must })
        }
    }
}

/// Numbers from the standard normal distribution, the same for the same `chance` on every backend; in the type and on the device of
/// `like`.
///
/// # Errors
/// If the framework refuses.
pub(super) fn noise<B: Backend>(like: &Tensor<B>, extents: &[usize], chance: u64) -> Result<Tensor<B>, TensorError> {
    let mut rng = ChaCha8Rng::seed_from_u64(chance);
    like.like((0..extents.iter().product()).map(|_| normal(&mut rng)).collect(), extents)
}

/// Refuses numbers of channels of which no convolutions can be made.
///
/// # Errors
/// [`NetError::Config`].
pub(super) fn check_channels(key: &'static str, channels: &[usize]) -> Result<(), NetError> {
    let some = !channels.is_empty() && channels.len() < 16 && !channels.contains(&0);
    require(some, key, format!("{channels:?}"), "must be one to 15 numbers, none of them 0")
}

/// Refuses steps that do not tile the side.
///
/// # Errors
/// [`NetError::Config`].
pub(super) fn check_step(key: &'static str, step: usize, side: usize) -> Result<(), NetError> {
    require(step > 0 && side.is_multiple_of(step), key, step, "must divide the side")
}
