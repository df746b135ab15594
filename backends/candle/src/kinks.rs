//! |x| and max(x, 0) with derivative 0 at 0, where candle's is 1.

use candle_core::backend::BackendStorage;
use candle_core::{CpuStorage, CudaStorage, CustomOp1, Layout, Result, Shape, Tensor, op};

/// A function with a kink at 0.
#[derive(Clone, Copy)]
pub(crate) enum Kinked {
    Abs,
    Relu,
}

impl Kinked {
    pub(crate) fn of(self, array: &Tensor) -> Result<Tensor> {
        array.apply_op1(self)
    }

    fn forward<S: BackendStorage>(self, storage: &S, layout: &Layout) -> Result<(S, Shape)> {
        let result = match self {
            Self::Abs => storage.unary_impl::<op::Abs>(layout)?,
            Self::Relu => storage.unary_impl::<op::Relu>(layout)?,
        };
        Ok((result, layout.shape().clone()))
    }
}

impl CustomOp1 for Kinked {
    fn name(&self) -> &'static str {
        match self {
            Self::Abs => "abs",
            Self::Relu => "relu",
        }
    }

    fn cpu_fwd(&self, storage: &CpuStorage, layout: &Layout) -> Result<(CpuStorage, Shape)> {
        self.forward(storage, layout)
    }

    fn cuda_fwd(&self, storage: &CudaStorage, layout: &Layout) -> Result<(CudaStorage, Shape)> {
        self.forward(storage, layout)
    }

    fn bwd(&self, array: &Tensor, result: &Tensor, grad: &Tensor) -> Result<Option<Tensor>> {
        let derivative = match self {
            Self::Abs => array.detach().sign()?,
            // max(x, 0) is positive exactly where x is.
            Self::Relu => result.detach().sign()?,
        };
        grad.mul(&derivative).map(Some)
    }
}
