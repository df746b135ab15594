//! Copies and sums over axes of row-major arrays.

use alloc::vec;
use alloc::vec::Vec;

use super::array::by_type;
use crate::dims::{Dims, MAX_RANK};
use crate::real::{Real, Values};

/// A copy whose axis k is axis `axes[k]` of `from`, with extents `to`; axes of extent 1 stretch.
pub(super) fn copy_strided<T: Real>(x: &[T], from: &Dims, axes: &[usize], to: &[usize]) -> Vec<T> {
    let own = from.strides();
    let mut strides = [0; MAX_RANK];
    for (stride, &axis) in strides.iter_mut().zip(axes) {
        *stride = if from.extents()[axis] == 1 { 0 } else { own[axis] };
    }
    let len = to.iter().product();
    let mut copy = Vec::with_capacity(len);
    if len == 0 {
        return copy; // Rows without values may start beyond the end.
    }
    let (&inner, outer) = to.split_last().unwrap_or((&1, &[]));
    let inner_stride = strides[outer.len()];
    for_each_row(outer, &strides, |start| match inner_stride {
        0 => copy.extend(core::iter::repeat_n(x[start], inner)),
        1 => copy.extend_from_slice(&x[start..start + inner]),
        step => copy.extend(x[start..].iter().step_by(step).take(inner)),
    });
    copy
}

/// Calls `run` with the first index of each row.
fn for_each_row(outer: &[usize], strides: &[usize; MAX_RANK], mut run: impl FnMut(usize)) {
    let mut at = [0; MAX_RANK];
    let mut start = 0;
    for _ in 0..outer.iter().product() {
        run(start);
        for axis in (0..outer.len()).rev() {
            at[axis] += 1;
            start += strides[axis];
            if at[axis] < outer[axis] {
                break;
            }
            start -= at[axis] * strides[axis];
            at[axis] = 0;
        }
    }
}

/// Sums over the axes that are 1 in `to` and not in `from`, of the same rank.
pub(super) fn reduce_to(values: &Values, from: &Dims, to: &Dims) -> Values {
    let mut values = values.clone();
    let mut dims = *from;
    for axis in 0..from.rank() {
        if to.extents()[axis] != dims.extents()[axis] {
            values = by_type!(&values, x => sum(x, &dims, axis));
            dims = dims.with(axis, 1);
        }
    }
    values
}

/// Sums along an axis, in f64: the order of adding must not matter to f32.
fn sum<T: Real>(x: &[T], dims: &Dims, axis: usize) -> Vec<T> {
    let [outer, extent, inner] = around(dims, axis);
    let mut sums = vec![0.0; outer * inner];
    for (block, sums) in x.chunks_exact((extent * inner).max(1)).zip(sums.chunks_exact_mut(inner.max(1))) {
        for row in block.chunks_exact(inner.max(1)) {
            sums.iter_mut().zip(row).for_each(|(sum, &value)| *sum += value.as_f64());
        }
    }
    sums.into_iter().map(T::of).collect()
}

/// Largest numbers along an axis; NaN if there is one.
pub(super) fn largest<T: Real>(x: &[T], dims: &Dims, axis: usize) -> Vec<T> {
    let [outer, extent, inner] = around(dims, axis);
    let mut largest = vec![T::neg_infinity(); outer * inner];
    for (block, largest) in x.chunks_exact((extent * inner).max(1)).zip(largest.chunks_exact_mut(inner.max(1))) {
        for row in block.chunks_exact(inner.max(1)) {
            for (largest, &value) in largest.iter_mut().zip(row) {
                if value > *largest || value.is_nan() {
                    *largest = value;
                }
            }
        }
    }
    largest
}

/// The given indices of an axis.
pub(super) fn select<T: Real>(x: &[T], dims: &Dims, axis: usize, indices: &[usize]) -> Vec<T> {
    let [outer, extent, inner] = around(dims, axis);
    let mut chosen = Vec::with_capacity(outer * indices.len() * inner);
    for block in 0..outer {
        for &index in indices {
            chosen.extend_from_slice(&x[(block * extent + index) * inner..][..inner]);
        }
    }
    chosen
}

/// `len` indices of an axis from `start` on.
pub(super) fn cut<T: Real>(x: &[T], dims: &Dims, axis: usize, [start, len]: [usize; 2]) -> Vec<T> {
    let [outer, extent, inner] = around(dims, axis);
    let mut part = Vec::with_capacity(outer * len * inner);
    for block in x.chunks_exact((extent * inner).max(1)) {
        part.extend_from_slice(&block[start * inner..][..len * inner]);
    }
    part
}

/// Writes `part` to the indices of an axis of `whole`, of extents `dims`, from `start` on.
pub(super) fn paste(whole: &mut Values, dims: &Dims, axis: usize, start: usize, part: &Values) {
    match (whole, part) {
        (Values::F32(whole), Values::F32(part)) => paste_real(whole, dims, axis, start, part),
        (Values::F64(whole), Values::F64(part)) => paste_real(whole, dims, axis, start, part),
        _ => {}
    }
}

fn paste_real<T: Real>(whole: &mut [T], dims: &Dims, axis: usize, start: usize, part: &[T]) {
    let [outer, extent, inner] = around(dims, axis);
    let row = part.len() / outer.max(1);
    if row == 0 {
        return;
    }
    for (block, part) in whole.chunks_exact_mut(extent * inner).zip(part.chunks_exact(row)) {
        block[start * inner..][..row].copy_from_slice(part);
    }
}

/// Adds `part` to the given indices of an axis of `whole`, of extents `dims`.
pub(super) fn scatter(whole: &mut Values, dims: &Dims, axis: usize, indices: &[usize], part: &Values) {
    match (whole, part) {
        (Values::F32(whole), Values::F32(part)) => scatter_real(whole, dims, axis, indices, part),
        (Values::F64(whole), Values::F64(part)) => scatter_real(whole, dims, axis, indices, part),
        _ => {}
    }
}

fn scatter_real<T: Real>(whole: &mut [T], dims: &Dims, axis: usize, indices: &[usize], part: &[T]) {
    let [_, extent, inner] = around(dims, axis);
    for (row, part) in part.chunks_exact(inner.max(1)).enumerate() {
        let (block, index) = (row / indices.len(), indices[row % indices.len()]);
        let to = &mut whole[(block * extent + index) * inner..][..inner];
        to.iter_mut().zip(part).for_each(|(to, &value)| *to += value);
    }
}

/// Product of the extents before an axis, its extent, product of those after it.
fn around(dims: &Dims, axis: usize) -> [usize; 3] {
    let extents = dims.extents();
    [extents[..axis].iter().product(), extents[axis], extents[axis + 1..].iter().product()]
}
