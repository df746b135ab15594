//! Convolution as one node. On the processor image by image: windows as columns, which stay in the cache, times the
//! kernels; on the way back the columns are made again. On a GPU candle's own.
//!
//! Not candle's own on the processor: forward and backward take 5.5 times as long, and fail where rows and columns leave
//! different remainders.

use alloc::sync::Arc;

use candle_core::backend::BackendStorage;
use candle_core::{CpuStorage, CudaStorage, CustomOp2, Error, Layout, Result, Shape, Storage, Tensor};
use dvp_core::diff_op::DiffOp;
use dvp_core::real::Real;
use dvp_core::tensor::{Stride, Unfold};
use rayon::prelude::*;

use crate::values::{slice, storage, typed, upload};

/// Groups of images whose gradients of the kernels are summed one after the other: their number is fixed so that sums do
/// not depend on the number of threads.
const GROUPS: usize = 16;

/// Cross-correlation of images, batch x c x h x w, with kernels o x c x kh x kw.
pub(crate) fn conv2d(images: &Tensor, kernels: &Tensor, stride: Stride) -> Result<Tensor> {
    if !images.device().is_cpu() {
        return fitted(images, kernels, stride)?.conv2d(kernels, 0, stride.step, 1, 1);
    }
    let (batch, c, h, w) = images.dims4()?;
    let (o, _, kh, kw) = kernels.dims4()?;
    let [rows, columns] = [stride.windows(h, kh), stride.windows(w, kw)];
    let unfold = Unfold::new([c, h, w], [kh, kw], stride).map_err(Error::wrap)?;
    let sizes = Sizes { pixels: c * h * w, o, depth: c * kh * kw, windows: rows * columns };
    let node = Convolution { unfold: Arc::new(unfold), sizes, result: Shape::from((batch, o, rows, columns)) };
    images.contiguous()?.apply_op2(&kernels.contiguous()?, node)
}

/// The images with their padding, without the last rows and columns if no window reaches them: candle's gradient takes
/// for granted that rows and columns leave the same remainder, now 0.
pub(crate) fn fitted(images: &Tensor, kernels: &Tensor, stride: Stride) -> Result<Tensor> {
    let mut fitted = images.clone();
    for axis in [2, 3] {
        let (len, extent) = (images.dim(axis)?, kernels.dim(axis)?);
        let needed = (stride.windows(len, extent).max(1) - 1) * stride.step + extent;
        let behind = needed.saturating_sub(stride.padding + len);
        fitted = fitted.pad_with_zeros(axis, stride.padding, behind)?.narrow(axis, 0, needed)?;
    }
    Ok(fitted)
}

/// Numbers of values.
#[derive(Clone, Copy)]
struct Sizes {
    /// Of an image.
    pixels: usize,
    /// Of a window's result: output channels.
    o: usize,
    /// Of a window.
    depth: usize,
    /// Windows of an image.
    windows: usize,
}

struct Convolution {
    unfold: Arc<Unfold>,
    sizes: Sizes,
    result: Shape,
}

/// Numbers of a contiguous array, from `start` on.
#[derive(Clone, Copy)]
struct Stored<'a> {
    numbers: &'a CpuStorage,
    start: usize,
}

impl Stored<'_> {
    /// The layout of a matrix that stands `skip` numbers behind the first.
    fn matrix(&self, skip: usize, rows: usize, columns: usize) -> Layout {
        Layout::contiguous_with_offset((1, rows, columns), self.start + skip)
    }
}

impl Convolution {
    /// Sets `columns`, depth x windows, to those of `image`.
    fn unfold<T: Real>(&self, image: &[T], columns: &mut [T]) {
        let Ok(()) = self.unfold.forward(0, image, columns, &mut [], &mut ());
    }

    fn forward<T: Real>(&self, images: &[T], kernels: Stored<'_>) -> Result<CpuStorage> {
        let Sizes { pixels, o, depth, windows } = self.sizes;
        let (weights, below) = (kernels.matrix(0, o, depth), Layout::contiguous((1, depth, windows)));
        let mut results = vec![T::zero(); self.result.elem_count()];
        let each = results.par_chunks_exact_mut((o * windows).max(1)).zip(images.par_chunks_exact(pixels.max(1)));
        each.try_for_each_init(
            || vec![T::zero(); depth * windows],
            |columns, (result, image)| {
                self.unfold(image, columns);
                let right = storage(T::into_values(core::mem::take(columns)));
                let product = kernels.numbers.matmul(&right, (1, o, windows, depth), &weights, &below)?;
                *columns = typed(right)?;
                result.copy_from_slice(slice::<T>(&product)?);
                Ok::<_, Error>(())
            },
        )?;
        Ok(storage(T::into_values(results)))
    }

    /// Gradients of the images and of the kernels, of those that are `wanted`.
    fn backward<T: Real>(
        &self,
        images: &[T],
        kernels: Stored<'_>,
        grad: Stored<'_>,
        wanted: [bool; 2],
    ) -> Result<Grads> {
        let Sizes { pixels, o, depth, windows } = self.sizes;
        let weights = kernels.matrix(0, o, depth).transpose(1, 2)?;
        let across = Layout::contiguous((1, depth, windows)).transpose(1, 2)?;
        let batch = self.result.dim(0)?;
        let group = batch.div_ceil(GROUPS).max(1);
        let mut for_images = vec![T::zero(); if wanted[0] { batch * pixels } else { 0 }];
        let mut each: Vec<&mut [T]> = for_images.chunks_exact_mut(pixels.max(1)).collect();
        each.resize_with(batch, Default::default);
        let of_group = |(at, for_images): (usize, &mut [&mut [T]])| {
            let mut columns = vec![T::zero(); depth * windows];
            let mut sum = vec![T::zero(); o * depth];
            for (item, for_image) in (at * group..).zip(for_images) {
                let own = grad.matrix(item * o * windows, o, windows);
                if wanted[1] {
                    self.unfold(&images[item * pixels..][..pixels], &mut columns);
                    let right = storage(T::into_values(core::mem::take(&mut columns)));
                    let product = grad.numbers.matmul(&right, (1, o, depth, windows), &own, &across)?;
                    columns = typed(right)?;
                    add(&mut sum, slice(&product)?);
                }
                if wanted[0] {
                    let product = kernels.numbers.matmul(grad.numbers, (1, depth, windows, o), &weights, &own)?;
                    let Ok(()) = self.unfold.vjp(0, &[], &[], slice::<T>(&product)?, for_image, &mut ());
                }
            }
            Ok(sum)
        };
        let sums = each.par_chunks_mut(group).enumerate().map(of_group).collect::<Result<Vec<_>>>()?;
        let mut for_kernels = vec![T::zero(); o * depth];
        sums.iter().for_each(|sum| add(&mut for_kernels, sum));
        Ok([T::into_values(for_images), T::into_values(for_kernels)])
    }
}

type Grads = [dvp_core::real::Values; 2];

fn add<T: Real>(sum: &mut [T], values: &[T]) {
    sum.iter_mut().zip(values).for_each(|(sum, &value)| *sum += value);
}

impl CustomOp2 for Convolution {
    fn name(&self) -> &'static str {
        "conv2d"
    }

    fn cpu_fwd(&self, a: &CpuStorage, la: &Layout, b: &CpuStorage, lb: &Layout) -> Result<(CpuStorage, Shape)> {
        let kernels = Stored { numbers: b, start: lb.start_offset() };
        let result = match a {
            CpuStorage::F32(_) => self.forward::<f32>(&slice(a)?[la.start_offset()..], kernels)?,
            _ => self.forward::<f64>(&slice(a)?[la.start_offset()..], kernels)?,
        };
        Ok((result, self.result.clone()))
    }

    fn cuda_fwd(&self, _: &CudaStorage, _: &Layout, _: &CudaStorage, _: &Layout) -> Result<(CudaStorage, Shape)> {
        Err(Error::Msg("conv2d: this node is the processor's".into()))
    }

    fn bwd(&self, a: &Tensor, b: &Tensor, _: &Tensor, grad: &Tensor) -> Result<(Option<Tensor>, Option<Tensor>)> {
        let grad = grad.contiguous()?;
        let (images, images_layout) = a.storage_and_layout();
        let (kernels, kernels_layout) = b.storage_and_layout();
        let (grad, grad_layout) = grad.storage_and_layout();
        let (Storage::Cpu(images), Storage::Cpu(kernels), Storage::Cpu(grad)) = (&*images, &*kernels, &*grad) else {
            return Err(Error::Msg("conv2d: this node is the processor's".into()));
        };
        let kernels = Stored { numbers: kernels, start: kernels_layout.start_offset() };
        let grad = Stored { numbers: grad, start: grad_layout.start_offset() };
        let start = images_layout.start_offset();
        let wanted = [a.track_op(), b.track_op()];
        let [for_images, for_kernels] = match images {
            CpuStorage::F32(_) => self.backward::<f32>(&slice(images)?[start..], kernels, grad, wanted)?,
            _ => self.backward::<f64>(&slice(images)?[start..], kernels, grad, wanted)?,
        };
        let for_images = wanted[0].then(|| upload(for_images, a.dims(), a.device())).transpose()?;
        let for_kernels = wanted[1].then(|| upload(for_kernels, b.dims(), b.device())).transpose()?;
        Ok((for_images, for_kernels))
    }
}
