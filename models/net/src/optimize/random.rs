//! Latents that no encoder made.

use dvp_core::real::{DType, Values};
use dvp_core::tensor::{Backend, Tensor, TensorError};
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;

use crate::initial::normal;
use crate::model::{Latents, ModelConfig};

/// Latents of one image, every number of every slot drawn from the standard normal distribution, the same for the same
/// seed on every backend: the start of Rand-OptZ.
///
/// The transformer ends in a layer norm, which leaves numbers of mean 0 and variance 1 but for a factor and a bias that
/// are learned and near 1 and 0. The latent of the image is the mean over the slots, as the model makes it.
///
/// *Source*: the paper, Rand-OptZ ("randomly drawn from the space of latents"); it does not name the distribution.
///
/// # Errors
/// If the framework refuses.
pub fn random_latents<B: Backend>(
    config: &ModelConfig,
    seed: u64,
    dtype: DType,
    device: &B::Device,
) -> Result<Latents<B>, TensorError> {
    let (slots, width) = (config.objects(), config.transformer.d_model);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let values = Values::F64((0..slots * width).map(|_| normal(&mut rng)).collect()).cast(dtype);
    let dims = dvp_core::dims::Dims::new(&[1, slots, width])?;
    Latents::of_objects(Tensor::from_values(values, &dims, device)?)
}
