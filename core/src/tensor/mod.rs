//! Tensors over any framework: checked here once, computed by a [`Backend`].
//!
//! In: values, extents, a device. Out: tensors and, backward, gradients of parameters. Networks, training and the
//! reference [`Adam`] are written on [`Tensor`] and run on every backend. An array's extents are [`Dims`](crate::dims::Dims):
//! *shape* is the word for geometry.
//!
//! | file | holds |
//! |---|---|
//! | `backend` | [`Backend`]: what a framework provides, about 25 unchecked operations |
//! | `handle` | [`Tensor`]: making, reading, moving |
//! | `elementwise`, `layout`, `reduce`, `product` | the operations, with their checks |
//! | `compose` | operations made of others: softmax, layer norm, GELU, pooling |
//! | `apply` | a [`DiffOp`](crate::diff_op::DiffOp) as an operation on tensors |
//! | `gradient` | parameters, [`Gradients`] |
//! | `parameters` | [`Parameters`]: named tensors; with the feature `safetensors` to and from a file's bytes |
//! | `adam` | the reference optimizer; its settings and schedule are in [`optim`](crate::optim) |
//! | `unfold` | [`Unfold`]: windows of pixels as columns, by which convolution is a product |
//! | `host` | [`Host`]: plain vectors and a tape, the backend that is always there |
//!
//! Shown by `tests/backend`: every operation and its gradient on host, burn and candle against central differences.

mod adam;
mod apply;
mod backend;
mod compose;
mod elementwise;
mod error;
mod gradient;
mod handle;
mod host;
mod layout;
mod parameters;
mod product;
mod reduce;
#[cfg(feature = "safetensors")]
mod safetensors;
#[cfg(test)]
mod tests;
mod unfold;

pub use adam::Adam;
pub use backend::{Backend, BackendError, Binary, Stride, Unary};
pub use error::TensorError;
pub use gradient::Gradients;
pub use handle::Tensor;
pub use host::{Host, HostArray, HostDevice, HostGradients};
pub use parameters::{Parameters, ParametersError};
#[cfg(feature = "safetensors")]
pub use safetensors::safetensors_note;
pub use unfold::Unfold;
