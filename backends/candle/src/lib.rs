//! The core's tensors and differentiable steps on candle.
//!
//! In: a [`CandleDevice`], and whatever is written on [`Tensor`](dvp_core::tensor::Tensor). Out: the same computed by
//! candle. Each [`DiffOp`](dvp_core::diff_op::DiffOp) of the core (outlines, poses, images, losses) is one node of candle's
//! graph with the core's own way back, on every device.
//!
//! A step of the core inside a model of candle, trained by candle's optimizers: [`from_candle`], [`Tensor::apply`],
//! [`to_candle`].
//!
//! ```
//! use candle_core::{Device, Tensor as CandleTensor, Var};
//! use dvp_candle::{from_candle, to_candle};
//! use dvp_core::diff_op::Atan2;
//! use dvp_core::tensor::Tensor;
//!
//! // candle's tensors, here two pairs (y, x), with gradients by candle.
//! let y = Var::new(&[[1.0_f32], [0.0]], &Device::Cpu)?;
//! let x = CandleTensor::new(&[[0.0_f32], [2.0]], &Device::Cpu)?;
//! // A step of the core: one item per row, f32 as the tensors are.
//! let angles = Tensor::apply::<f32, _>(Atan2::new(&[1])?, &[&from_candle(&y)?, &from_candle(&x)?])?;
//! // And on in candle: d angle / dy = x / (x^2 + y^2).
//! let gradients = to_candle(&angles).sum_all()?.backward()?;
//! let gradient = gradients.get(&y).map(|gradient| gradient.to_vec2::<f32>()).transpose()?;
//! assert_eq!(gradient, Some(vec![vec![0.0], vec![0.5]]));
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
//!
//! `examples/fit_image.rs` fits a scene to an image this way.
//!
//! # What candle gets wrong, and what is done instead
//!
//! All of candle 0.11.1; the version is pinned.
//!
//! | candle | here |
//! |---|---|
//! | derivative of \|x\| and max(x, 0) at 0 is 1 | 0, a node of its own |
//! | derivative of a / b squares b, which is 0 in f32 below 1e-23 | by (a / b) / b |
//! | what is scaled by 0 has no gradient at all | it is 0 |
//! | sums along another axis than the last, and those on the way back of broadcasting, divide twice for every number | row by row |
//! | the largest number passes over NaN | is NaN |
//! | gradients of constants are worked out and thrown away | not by products, convolution and broadcasting |
//! | one matrix times a batch of transposed ones: wrong numbers without an error | the batch is copied row by row first |
//! | convolution: no gradient if rows and columns leave different remainders; forward and backward take 5.5 times as long | a node of its own on the CPU; on a GPU padded and cut so that nothing remains |
//! | gradient of max_pool2d wrong; softmax_last_dim and layer_norm of candle-nn without one; no atan2 | composed of the operations above by the core, which has its own atan2 |
//!
//! The convolution: 3 to 16 to 32 to 64 channels by kernels of 3 x 3 with steps of 2, 32 images of 128 x 128, f32, one
//! thread: 24 ms forward and 90 ms forward and backward; candle's own 78 ms and 499 ms; windows of the whole batch as
//! columns, then products, 52 ms and 169 ms; one product for the whole batch 81 ms and 214 ms (processor time, least of 9).
//!
//! # Speed
//!
#![doc = include_str!("../speed.md")]
//!
//! # Devices
//!
//! The CPU is always there. The feature `cuda` adds NVIDIA's GPUs and needs the CUDA toolkit to build. Steps of the core
//! run on the CPU: their inputs are copied there and their outputs back, 0.8 MB per image of 256 x 256 pixels and direction.
//!
//! # Limits
//!
//! - f32 and f64 only, up to rank [`MAX_RANK`](dvp_core::dims::MAX_RANK). Make tensors of candle's with [`from_candle`],
//!   which checks that; [`Tensor::from_array`](dvp_core::tensor::Tensor::from_array) cannot.
//! - candle's optimizers change a [`Var`](candle_core::Var) in place, and with it every tensor that shares its memory:
//!   reshaped, sliced, detached. Take gradients before the step, and make such tensors again after it.
//! - candle walks its graph by recursion: 40 000 nodes in a row exhaust a stack of 8 MB (20 000 do not).
//! - No derivatives of derivatives. No Metal.
//!
//! | file | holds |
//! |---|---|
//! | `backend` | [`Candle`]: the operations |
//! | `values` | [`CandleDevice`]; values in and out, number types |
//! | `host_op` | any step of the core as one node |
//! | `convolution`, `product` | convolution, products of matrices |
//! | `arithmetic`, `kinks`, `fold` | pairs of numbers with broadcasting, \|x\| and max(x, 0), sums and largest numbers |
//! | `gradient` | parameters and the way back |
//! | `convert` | [`from_candle`], [`to_candle`] |
//!
//! Shown by `tests/`, every operation and its gradient against the host's, and by `tests/backend` of the workspace: the same
//! on host, burn and candle against central differences.
//!
//! [`Tensor::apply`]: dvp_core::tensor::Tensor::apply

extern crate alloc;

mod arithmetic;
mod backend;
mod convert;
mod convolution;
mod fold;
mod gradient;
mod host_op;
mod kinks;
mod product;
#[cfg(test)]
mod tests;
mod values;

pub use backend::Candle;
pub use convert::{from_candle, to_candle};
pub use values::CandleDevice;
