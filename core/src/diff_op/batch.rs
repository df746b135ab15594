//! A batch of items, and either number type, behind one object-safe trait.

use alloc::boxed::Box;
use alloc::vec;
use core::fmt;

use super::memory::Memory;
use super::{DiffOp, OpError, Signature};
use crate::real::{DType, Real, Values, ValuesRef};

/// A [`DiffOp`] over a batch, of a number type chosen at run time: what adapters of frameworks wrap.
pub trait HostOp: fmt::Debug + Send + Sync {
    /// What the step takes and gives, per item.
    fn signature(&self) -> &Signature;

    /// The number type it is made for.
    fn dtype(&self) -> DType;

    /// Writes the outputs of `batch` items, and what the way back needs if `save`; nothing otherwise.
    ///
    /// *Dimensions*: `input` batch x values of all inputs of an item; first result batch x values of the output.
    ///
    /// # Errors
    /// [`OpError`], naming the item; the first refused one if there are several.
    fn forward(&self, batch: usize, input: ValuesRef<'_>, save: bool) -> Result<(Values, Values), OpError>;

    /// The gradient of sum(`grad_output` x output) with respect to `input`; `saved` as [`Self::forward`] left it.
    ///
    /// # Errors
    /// As [`Self::forward`].
    fn vjp(
        &self,
        batch: usize,
        input: ValuesRef<'_>,
        saved: ValuesRef<'_>,
        grad_output: ValuesRef<'_>,
    ) -> Result<Values, OpError>;
}

/// A [`DiffOp`] as a [`HostOp`]. Items run in parallel with the feature `parallel`; results do not depend on it.
///
/// *Memory*: with the feature `std` a scratch per thread is kept from batch to batch, as long as this lives.
pub struct Batched<T: Real, O: DiffOp<T>> {
    op: O,
    memory: Memory<O::Scratch>,
}

impl<T: Real, O: DiffOp<T>> fmt::Debug for Batched<T, O> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Batched").field("op", &self.op).finish_non_exhaustive()
    }
}

impl<T: Real, O: DiffOp<T>> Batched<T, O> {
    /// Wraps `op`.
    #[must_use]
    pub fn new(op: O) -> Self {
        Self { op, memory: Memory::default() }
    }

    fn name(&self) -> &'static str {
        self.op.signature().name()
    }

    /// Numbers per item: of the inputs, of the output, kept for the way back.
    fn lens(&self) -> [usize; 3] {
        let signature = self.op.signature();
        [signature.input_len(), signature.output().len(), signature.saved_len()]
    }

    fn borrow<'a>(&self, what: &'static str, values: ValuesRef<'a>, expected: usize) -> Result<&'a [T], OpError> {
        let op = self.name();
        let found = values.dtype();
        let slice = T::borrow_values(values).ok_or(OpError::DType { op, expected: T::DTYPE, found })?;
        if slice.len() == expected { Ok(slice) } else { Err(OpError::Length { op, what, expected, len: slice.len() }) }
    }

    fn check_batch(&self, batch: usize) -> Result<(), OpError> {
        match self.signature().batch() {
            Some(expected) if expected != batch => Err(OpError::Batch { op: self.name(), expected, found: batch }),
            _ => Ok(()),
        }
    }

    fn refused(&self, item: usize, cause: O::Error) -> OpError {
        OpError::Item { op: self.name(), item, cause: Box::new(cause) }
    }
}

impl<T: Real, O: DiffOp<T>> HostOp for Batched<T, O> {
    fn signature(&self) -> &Signature {
        self.op.signature()
    }

    fn dtype(&self) -> DType {
        T::DTYPE
    }

    fn forward(&self, batch: usize, input: ValuesRef<'_>, save: bool) -> Result<(Values, Values), OpError> {
        let [width, height, depth] = self.lens();
        let depth = if save { depth } else { 0 };
        self.check_batch(batch)?;
        let input = self.borrow("input", input, batch * width)?;
        let mut output = vec![T::zero(); batch * height];
        let mut saved = vec![T::zero(); batch * depth];
        for_each_item(
            batch,
            &self.memory,
            [(&mut output, height), (&mut saved, depth)],
            |item, [output, saved], scratch| {
                let input = &input[item * width..][..width];
                self.op.forward(item, input, output, saved, scratch).map_err(|cause| self.refused(item, cause))
            },
        )?;
        Ok((T::into_values(output), T::into_values(saved)))
    }

    fn vjp(
        &self,
        batch: usize,
        input: ValuesRef<'_>,
        saved: ValuesRef<'_>,
        grad_output: ValuesRef<'_>,
    ) -> Result<Values, OpError> {
        let [width, height, depth] = self.lens();
        self.check_batch(batch)?;
        let input = self.borrow("input", input, batch * width)?;
        let saved = self.borrow("what forward saved", saved, batch * depth)?;
        let grad_output = self.borrow("gradient of the output", grad_output, batch * height)?;
        let mut grad = vec![T::zero(); batch * width];
        for_each_item(batch, &self.memory, [(&mut grad, width), (&mut [], 0)], |item, [grad, _], scratch| {
            let of_item = |values: &'_ [T], len: usize| item * len..(item * len + len).min(values.len());
            let (input, saved) = (&input[of_item(input, width)], &saved[of_item(saved, depth)]);
            let grad_output = &grad_output[of_item(grad_output, height)];
            self.op.vjp(item, input, saved, grad_output, grad, scratch).map_err(|cause| self.refused(item, cause))
        })?;
        Ok(T::into_values(grad))
    }
}

/// Calls `run` with every item's parts of two slices, given with their length per item; the first error in order of items.
#[cfg(not(feature = "parallel"))]
fn for_each_item<T: Real, S: Default>(
    batch: usize,
    memory: &Memory<S>,
    [(first, first_len), (second, second_len)]: [(&mut [T], usize); 2],
    run: impl Fn(usize, [&mut [T]; 2], &mut S) -> Result<(), OpError>,
) -> Result<(), OpError> {
    let mut scratch = memory.take();
    let (mut first, mut second) = (first, second);
    for item in 0..batch {
        let (head, tail) = core::mem::take(&mut first).split_at_mut(first_len);
        let (second_head, second_tail) = core::mem::take(&mut second).split_at_mut(second_len);
        (first, second) = (tail, second_tail);
        run(item, [head, second_head], &mut scratch)?;
    }
    Ok(())
}

/// As without the feature `parallel`, items side by side: a scratch per thread's run of items.
#[cfg(feature = "parallel")]
fn for_each_item<T: Real, S: Default + Send>(
    batch: usize,
    memory: &Memory<S>,
    [(first, first_len), (second, second_len)]: [(&mut [T], usize); 2],
    run: impl Fn(usize, [&mut [T]; 2], &mut S) -> Result<(), OpError> + Sync,
) -> Result<(), OpError> {
    use alloc::vec::Vec;
    use rayon::prelude::*;

    let mut items = Vec::with_capacity(batch);
    let (mut first, mut second) = (first, second);
    for item in 0..batch {
        let (head, tail) = core::mem::take(&mut first).split_at_mut(first_len);
        let (second_head, second_tail) = core::mem::take(&mut second).split_at_mut(second_len);
        (first, second) = (tail, second_tail);
        items.push((item, [head, second_head]));
    }
    let done: Vec<Result<(), OpError>> =
        items.into_par_iter().map_init(|| memory.take(), |scratch, (item, parts)| run(item, parts, scratch)).collect();
    done.into_iter().collect()
}
