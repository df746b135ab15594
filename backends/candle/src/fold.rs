//! Sums and largest numbers along an axis. candle's own divide twice for every number unless the axis is the last, and
//! its largest number passes over NaN.

use candle_core::backend::BackendStorage;
use candle_core::op::ReduceOp;
use candle_core::{CpuStorage, CudaStorage, CustomOp1, Error, Layout, Result, Shape, Tensor};
use dvp_core::real::Real;

/// Sums along an axis, which keeps extent 1.
pub(crate) fn sum(array: &Tensor, axis: usize) -> Result<Tensor> {
    array.contiguous()?.apply_op1(Fold { kind: Kind::Sum, axis })
}

/// Largest numbers along an axis, which keeps extent 1; without gradient.
pub(crate) fn max(array: &Tensor, axis: usize) -> Result<Tensor> {
    array.detach().contiguous()?.apply_op1_no_bwd(&Fold { kind: Kind::Max, axis })
}

/// Sums over the axes that were stretched from `extents`, of the same rank.
pub(crate) fn sum_to(array: &Tensor, extents: &[usize]) -> Result<Tensor> {
    let mut sums = array.contiguous()?;
    // The last axis first: its sums are the fastest.
    for (axis, &extent) in extents.iter().enumerate().rev() {
        if extent != sums.dims()[axis] {
            sums = sums.apply_op1_no_bwd(&Fold { kind: Kind::Sum, axis })?;
        }
    }
    Ok(sums)
}

#[derive(Clone, Copy)]
enum Kind {
    Sum,
    Max,
}

struct Fold {
    kind: Kind,
    axis: usize,
}

impl Fold {
    fn shape(&self, layout: &Layout) -> Shape {
        let mut extents = layout.dims().to_vec();
        extents[self.axis] = 1;
        Shape::from(extents)
    }

    fn fold<T: Real>(&self, values: &[T], layout: &Layout) -> Result<Vec<T>> {
        let (start, end) = layout.contiguous_offsets().ok_or(Error::RequiresContiguous { op: self.name() })?;
        let values = &values[start..end];
        let extents = layout.dims();
        let inner = extents[self.axis + 1..].iter().product();
        let outer = extents[..self.axis].iter().product();
        Ok(match self.kind {
            Kind::Sum => rows(values, [outer, extents[self.axis], inner], T::zero(), |sum, value| sum + value),
            Kind::Max => rows(values, [outer, extents[self.axis], inner], T::neg_infinity(), |largest, value| {
                if value > largest || value.is_nan() { value } else { largest }
            }),
        })
    }
}

impl CustomOp1 for Fold {
    fn name(&self) -> &'static str {
        match self.kind {
            Kind::Sum => "sum",
            Kind::Max => "max",
        }
    }

    fn cpu_fwd(&self, storage: &CpuStorage, layout: &Layout) -> Result<(CpuStorage, Shape)> {
        let folded = match (self.kind, storage) {
            // candle's sums along the last axis of contiguous numbers are vectorized.
            (Kind::Sum, _) if self.axis + 1 == layout.dims().len() && layout.is_contiguous() => {
                storage.reduce_op(ReduceOp::Sum, layout, &[self.axis])?
            }
            (_, CpuStorage::F32(values)) => CpuStorage::F32(self.fold(values, layout)?),
            (_, CpuStorage::F64(values)) => CpuStorage::F64(self.fold(values, layout)?),
            _ => return Err(Error::UnsupportedDTypeForOp(storage.dtype(), self.name())),
        };
        Ok((folded, self.shape(layout)))
    }

    fn cuda_fwd(&self, storage: &CudaStorage, layout: &Layout) -> Result<(CudaStorage, Shape)> {
        let op = match self.kind {
            Kind::Sum => ReduceOp::Sum,
            Kind::Max => ReduceOp::Max,
        };
        Ok((storage.reduce_op(op, layout, &[self.axis])?, self.shape(layout)))
    }

    fn bwd(&self, array: &Tensor, _: &Tensor, grad: &Tensor) -> Result<Option<Tensor>> {
        grad.broadcast_as(array.shape()).map(Some)
    }
}

/// Folds the middle axis of outer x extent x inner numbers.
fn rows<T: Real>(values: &[T], [outer, extent, inner]: [usize; 3], start: T, fold: impl Fn(T, T) -> T) -> Vec<T> {
    let mut folded = vec![start; outer * inner];
    let blocks = values.chunks_exact((extent * inner).max(1));
    for (block, folded) in blocks.zip(folded.chunks_exact_mut(inner.max(1))) {
        for row in block.chunks_exact(inner.max(1)) {
            for (folded, &value) in folded.iter_mut().zip(row) {
                *folded = fold(*folded, value);
            }
        }
    }
    folded
}
