//! Scenes sought in the space of latents: down the gradient of L_x through the heads and the renderer, one image at a time.
//!
//! In: a trained [`Model`](crate::model::Model), an image, [`Latents`](crate::model::Latents) to start from. Out: the best
//! scene met on the way, [`Optimum`]. The model stays as it is.
//!
//! | file | holds |
//! |---|---|
//! | `opt_z` | [`OptZ`]: the descent |
//! | `random` | [`random_latents`]: starts that no encoder made, for Rand-OptZ |
//!
//! The counterpart in the space of scenes, OptP, is that of `dvp-fit`.

mod opt_z;
mod random;
#[cfg(test)]
mod tests;

pub use opt_z::{OptZ, Optimum};
pub use random::random_latents;
