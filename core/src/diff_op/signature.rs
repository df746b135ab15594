//! What a step takes and gives: its name, the extents of its inputs and output, what it holds and keeps.

use alloc::vec::Vec;

use crate::dims::{Dims, DimsError};

/// An input of a [`DiffOp`](super::DiffOp).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OpInput {
    /// What it is called in errors.
    pub name: &'static str,
    /// Its extents per item.
    pub dims: Dims,
}

impl OpInput {
    /// An input called `name` of extents `dims`.
    ///
    /// # Errors
    /// As [`Dims::new`].
    pub fn new(name: &'static str, dims: &[usize]) -> Result<Self, DimsError> {
        Ok(Self { name, dims: Dims::new(dims)? })
    }
}

/// What a step takes and gives per item of a batch. An item's slice holds the inputs one after the other.
///
/// # Examples
/// ```
/// use dvp_core::diff_op::{OpInput, Signature};
/// use dvp_core::dims::Dims;
/// let angle = Signature::new("angle", [OpInput::new("y", &[2])?, OpInput::new("x", &[2])?], Dims::new(&[2])?);
/// let [y, x] = angle.split(&[1, 2, 3, 4]);
/// assert_eq!((y, x), (&[1, 2][..], &[3, 4][..]));
/// # Ok::<(), dvp_core::dims::DimsError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signature {
    name: &'static str,
    inputs: Vec<OpInput>,
    output: Dims,
    batch: Option<usize>,
    saved_len: usize,
}

impl Signature {
    /// A step called `name` in errors, for a batch of any length, that keeps nothing for its way back.
    #[must_use]
    pub fn new(name: &'static str, inputs: impl Into<Vec<OpInput>>, output: Dims) -> Self {
        Self { name, inputs: inputs.into(), output, batch: None, saved_len: 0 }
    }

    /// The same of a step that holds something for each of `items` items: target images, true scenes.
    #[must_use]
    pub fn for_batch(self, items: usize) -> Self {
        Self { batch: Some(items), ..self }
    }

    /// The same of a step that works out the gradient of its inputs together with a single number, and keeps it.
    #[must_use]
    pub fn keeping_gradient(self) -> Self {
        Self { saved_len: self.input_len(), ..self }
    }

    /// What the step is called in errors.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The inputs, in order.
    #[must_use]
    pub fn inputs(&self) -> &[OpInput] {
        &self.inputs
    }

    /// Extents of the output per item.
    #[must_use]
    pub fn output(&self) -> Dims {
        self.output
    }

    /// Number of items, if the step holds something for each of them; any number otherwise.
    #[must_use]
    pub fn batch(&self) -> Option<usize> {
        self.batch
    }

    /// Numbers per item that the way there leaves for the way back.
    #[must_use]
    pub fn saved_len(&self) -> usize {
        self.saved_len
    }

    /// Numbers per item of all inputs together.
    #[must_use]
    pub fn input_len(&self) -> usize {
        self.inputs.iter().map(|input| input.dims.len()).sum()
    }

    /// Cuts an item's slice into the inputs, in order. Of what is missing, inputs or numbers, there are none.
    #[must_use]
    pub fn split<'a, T, const N: usize>(&self, item: &'a [T]) -> [&'a [T]; N] {
        let mut rest = item;
        core::array::from_fn(|k| {
            let (head, tail) = rest.split_at(self.len_of(k).min(rest.len()));
            rest = tail;
            head
        })
    }

    /// As [`Self::split`], to write to.
    #[must_use]
    pub fn split_mut<'a, T, const N: usize>(&self, item: &'a mut [T]) -> [&'a mut [T]; N] {
        let mut rest = item;
        core::array::from_fn(|k| {
            let len = self.len_of(k).min(rest.len());
            let (head, tail) = core::mem::take(&mut rest).split_at_mut(len);
            rest = tail;
            head
        })
    }

    /// Extents of the inputs of `batch` items, in order.
    ///
    /// # Errors
    /// As [`Dims::new`].
    pub fn batched_inputs(&self, batch: usize) -> Result<Vec<Dims>, DimsError> {
        self.inputs.iter().map(|input| with_batch(&input.dims, batch)).collect()
    }

    /// Extents of the outputs of `batch` items.
    ///
    /// # Errors
    /// As [`Dims::new`].
    pub fn batched_output(&self, batch: usize) -> Result<Dims, DimsError> {
        with_batch(&self.output, batch)
    }

    /// Numbers per item of input `k`.
    fn len_of(&self, k: usize) -> usize {
        self.inputs.get(k).map_or(0, |input| input.dims.len())
    }
}

/// `dims` with an axis of `batch` in front.
fn with_batch(dims: &Dims, batch: usize) -> Result<Dims, DimsError> {
    let mut extents = Vec::with_capacity(1 + dims.rank());
    extents.push(batch);
    extents.extend_from_slice(dims.extents());
    Dims::new(&extents)
}
