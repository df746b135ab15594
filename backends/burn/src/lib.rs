//! The core's tensors and differentiable steps on burn.
//!
//! In: a [`Device`](burn::tensor::Device) of burn, chosen at run time, and whatever is written on
//! [`Tensor`](dvp_core::tensor::Tensor). Out: the same computed by burn. Each [`DiffOp`](dvp_core::diff_op::DiffOp) of the
//! core (outlines, poses, images, losses) is one node of burn's tape with the core's own way back, on every device.
//!
//! A step of the core inside a model of burn, trained by burn's optimizers: [`from_burn`], [`Tensor::apply`], [`to_burn`].
//!
//! ```
//! use burn::tensor::{Device, Tensor as BurnTensor};
//! use dvp_burn::{from_burn, to_burn};
//! use dvp_core::diff_op::Atan2;
//! use dvp_core::tensor::Tensor;
//!
//! // Burn's tensors, here two pairs (y, x), with gradients by burn.
//! let device = Device::flex().autodiff();
//! let y = BurnTensor::<2>::from_floats([[1.0], [0.0]], &device).require_grad();
//! let x = BurnTensor::<2>::from_floats([[0.0], [2.0]], &device);
//! // A step of the core: one item per row, f32 as the tensors are.
//! let angles = Tensor::apply::<f32, _>(Atan2::new(&[1])?, &[&from_burn(y.clone())?, &from_burn(x)?])?;
//! // And on in burn: d angle / dy = x / (x^2 + y^2).
//! let gradients = to_burn::<2>(&angles)?.sum().backward();
//! let gradient = y.grad(&gradients).map(|gradient| gradient.into_data().try_into_vec::<f32>());
//! assert_eq!(gradient, Some(Ok(vec![0.0, 0.5])));
//! # Ok::<(), dvp_core::tensor::TensorError>(())
//! ```
//!
//! `examples/fit_image.rs` fits a scene to an image this way.
//!
//! # Devices
//!
//! `Device::flex()`, burn's CPU backend, is always there. The feature `wgpu` adds graphics cards by Vulkan, Metal or DirectX
//! and builds anywhere; `cuda` needs CUDA's libraries, and the network while it is built. With either the first step takes
//! long, most of a minute on an NVIDIA H200: of kernels that do the same, each is tried. Graphics cards mostly have no
//! f64: [`Backend::upload`](dvp_core::tensor::Backend::upload) says so. Steps of the core run on the CPU: their inputs are
//! copied there and their outputs back, 0.8 MB per image of 256 x 256 pixels and direction. The tests here passed on Vulkan
//! played by the CPU (llvmpipe, Debian's `mesa-vulkan-drivers`) before kernels were tried, which is slow there: `cargo test -p dvp-burn --features wgpu --lib`.
//!
//! # Speed
//!
#![doc = include_str!("../speed.md")]
//!
//! # Limits
//!
//! - Burn's tape is used up by its first walk back; a second is an error, as is mixing tensors made with and without
//!   burn's gradient checkpointing.
//! - On graphics cards the way back of arrays without numbers is a panic of burn's, returned as an error.
//! - A step that refuses an item on the way back cannot stop burn: the gradient of its whole input is NaN.
//! - Tensors that share a parameter share a tape, which one thread at a time walks: a parameter per thread.
//! - Derivatives of a quotient square the divisor, which is 0 in f32 below 1e-23.
//! - f32 and f64 only, up to rank [`MAX_RANK`](dvp_core::dims::MAX_RANK).
//!
//! | file | holds |
//! |---|---|
//! | `backend` | [`Burn`]: the operations, by burn's own |
//! | `values` | [`BurnArray`]; values in and out, number types |
//! | `host_op` | any step of the core as one node |
//! | `convolution` | convolution |
//! | `gradient` | parameters and the walk back |
//! | `convert` | [`from_burn`], [`to_burn`] |
//!
//! Shown by `tests/backend`: every operation and its gradient on host, burn and candle against central differences.
//!
//! [`Tensor::apply`]: dvp_core::tensor::Tensor::apply

extern crate alloc;

mod backend;
mod convert;
mod convolution;
mod gradient;
mod host_op;
#[cfg(test)]
mod tests;
mod values;

pub use backend::Burn;
pub use convert::{from_burn, to_burn};
pub use gradient::BurnGradients;
pub use values::BurnArray;
