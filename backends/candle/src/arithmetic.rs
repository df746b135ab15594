//! Functions of two numbers with broadcasting, as one node each.
//!
//! candle's own broadcasting puts a node per stretched operand into the graph, sums their gradients number by number with
//! two divisions each, and computes gradients of constants too; the gradient of its quotient squares the divisor, which
//! is 0 in f32 from 1e-23 on.

use candle_core::backend::BackendStorage;
use candle_core::{CpuStorage, CudaStorage, CustomOp2, Layout, Result, Shape, Tensor, op};
use dvp_core::tensor::Binary;

use crate::fold;

/// The function of pairs of numbers; extents of 1 stretch.
pub(crate) fn binary(function: Binary, a: &Tensor, b: &Tensor) -> Result<Tensor> {
    let shape = a.shape().broadcast_shape_binary_op(b.shape(), "binary")?;
    a.apply_op2(b, Arithmetic { function, shape })
}

/// scale x + offset. candle takes what is scaled by 0 for a constant; its gradient is 0, but it has one.
pub(crate) fn affine(array: &Tensor, scale: f64, offset: f64) -> Result<Tensor> {
    if scale == 0.0 {
        let zero = Tensor::zeros(vec![1; array.rank()], array.dtype(), array.device())?;
        return binary(Binary::Mul, array, &zero)?.affine(1.0, offset);
    }
    array.affine(scale, offset)
}

struct Arithmetic {
    function: Binary,
    shape: Shape,
}

impl Arithmetic {
    fn forward<S: BackendStorage>(&self, a: &S, a_layout: &Layout, b: &S, b_layout: &Layout) -> Result<(S, Shape)> {
        let [left, right] = [a_layout.broadcast_as(&self.shape)?, b_layout.broadcast_as(&self.shape)?];
        let storage = match self.function {
            Binary::Add => a.binary_impl::<op::Add>(b, &left, &right)?,
            Binary::Div => a.binary_impl::<op::Div>(b, &left, &right)?,
            Binary::Mul => a.binary_impl::<op::Mul>(b, &left, &right)?,
            Binary::Sub => a.binary_impl::<op::Sub>(b, &left, &right)?,
        };
        Ok((storage, self.shape.clone()))
    }
}

impl CustomOp2 for Arithmetic {
    fn name(&self) -> &'static str {
        "binary"
    }

    fn cpu_fwd(&self, a: &CpuStorage, la: &Layout, b: &CpuStorage, lb: &Layout) -> Result<(CpuStorage, Shape)> {
        self.forward(a, la, b, lb)
    }

    fn cuda_fwd(&self, a: &CudaStorage, la: &Layout, b: &CudaStorage, lb: &Layout) -> Result<(CudaStorage, Shape)> {
        self.forward(a, la, b, lb)
    }

    fn bwd(&self, a: &Tensor, b: &Tensor, result: &Tensor, grad: &Tensor) -> Result<(Option<Tensor>, Option<Tensor>)> {
        let (left, right) = (a.detach(), b.detach());
        let for_a = a.track_op().then(|| match self.function {
            Binary::Add | Binary::Sub => fold::sum_to(grad, a.dims()),
            Binary::Mul => fold::sum_to(&binary(Binary::Mul, grad, &right)?, a.dims()),
            Binary::Div => fold::sum_to(&binary(Binary::Div, grad, &right)?, a.dims()),
        });
        let for_b = b.track_op().then(|| match self.function {
            Binary::Add => fold::sum_to(grad, b.dims()),
            Binary::Sub => fold::sum_to(grad, b.dims())?.neg(),
            Binary::Mul => fold::sum_to(&binary(Binary::Mul, grad, &left)?, b.dims()),
            Binary::Div => {
                let ratio = binary(Binary::Div, grad, &right)?.mul(&result.detach())?;
                fold::sum_to(&ratio, b.dims())?.neg()
            }
        });
        Ok((for_a.transpose()?, for_b.transpose()?))
    }
}
