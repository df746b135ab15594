//! Products of matrices as one node, without gradients of constants.

use candle_core::backend::BackendStorage;
use candle_core::{CpuStorage, CudaStorage, CustomOp2, Layout, Result, Shape, Tensor};

/// batch x m x k times batch x k x n.
pub(crate) fn matmul(a: &Tensor, b: &Tensor) -> Result<Tensor> {
    let (batch, m, k) = a.dims3()?;
    let n = b.dim(2)?;
    let (a, b) = (dense(a)?, dense(b)?);
    // candle stacks the rows of all matrices of `a` if `b` is one matrix for all, but takes them to be row by row.
    let a = if b.stride()[0] == 0 && order(&a) != Some(Order::Rows) { a.contiguous()? } else { a };
    a.apply_op2(&b, Product { batch, m, k, n })
}

#[derive(Clone, Copy, PartialEq)]
enum Order {
    Rows,
    Columns,
}

/// Whether the numbers of each matrix stand row by row or column by column, without gaps.
fn order(array: &Tensor) -> Option<Order> {
    let (&[_, rows, columns], &[_, row, column]) = (array.dims(), array.stride()) else { return None };
    // The stride of an axis of extent 1 says nothing.
    let is = |stride: usize, extent: usize, dense: usize| extent == 1 || stride == dense;
    if is(column, columns, 1) && is(row, rows, columns) {
        Some(Order::Rows)
    } else {
        (is(row, rows, 1) && is(column, columns, rows)).then_some(Order::Columns)
    }
}

/// Matrices that candle multiplies as they are: each without gaps. One matrix for the whole batch is not copied.
fn dense(array: &Tensor) -> Result<Tensor> {
    if order(array).is_some() { Ok(array.clone()) } else { array.contiguous() }
}

struct Product {
    batch: usize,
    m: usize,
    k: usize,
    n: usize,
}

impl Product {
    fn forward<S: BackendStorage>(&self, a: &S, a_layout: &Layout, b: &S, b_layout: &Layout) -> Result<(S, Shape)> {
        let Self { batch, m, k, n } = *self;
        Ok((a.matmul(b, (batch, m, n, k), a_layout, b_layout)?, Shape::from((batch, m, n))))
    }
}

impl CustomOp2 for Product {
    fn name(&self) -> &'static str {
        "matmul"
    }

    fn cpu_fwd(&self, a: &CpuStorage, la: &Layout, b: &CpuStorage, lb: &Layout) -> Result<(CpuStorage, Shape)> {
        self.forward(a, la, b, lb)
    }

    fn cuda_fwd(&self, a: &CudaStorage, la: &Layout, b: &CudaStorage, lb: &Layout) -> Result<(CudaStorage, Shape)> {
        self.forward(a, la, b, lb)
    }

    fn bwd(&self, a: &Tensor, b: &Tensor, _: &Tensor, grad: &Tensor) -> Result<(Option<Tensor>, Option<Tensor>)> {
        let for_a = a.track_op().then(|| matmul(grad, &b.detach().transpose(1, 2)?)).transpose()?;
        let for_b = b.track_op().then(|| matmul(&a.detach().transpose(1, 2)?, grad)).transpose()?;
        Ok((for_a, for_b))
    }
}
