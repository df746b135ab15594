//! Sums, means and largest numbers along axes.

use super::backend::Backend;
use super::error::TensorError;
use super::handle::Tensor;

impl<B: Backend> Tensor<B> {
    /// Sums along `axis`, which keeps extent 1.
    ///
    /// # Errors
    /// [`TensorError::Axis`].
    pub fn sum(&self, axis: usize) -> Result<Self, TensorError> {
        self.check_axis("sum", axis)?;
        Self::wrap("sum", B::sum(self.array(), axis))
    }

    /// Means along `axis`, which keeps extent 1.
    ///
    /// # Errors
    /// [`TensorError::Axis`]; [`TensorError::Operand`] if its extent is 0.
    pub fn mean(&self, axis: usize) -> Result<Self, TensorError> {
        let extent = self.filled_axis("mean", axis)?;
        self.sum(axis)?.affine(reciprocal(extent), 0.0)
    }

    /// The sum of all numbers, of rank 0.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn sum_all(&self) -> Result<Self, TensorError> {
        self.reshape(&[self.dims().len()])?.sum(0)?.reshape(&[])
    }

    /// The mean of all numbers, of rank 0.
    ///
    /// # Errors
    /// [`TensorError::Operand`] if there are none.
    pub fn mean_all(&self) -> Result<Self, TensorError> {
        match self.dims().len() {
            0 => Err(self.operand("mean", "must not be empty")),
            len => self.sum_all()?.affine(reciprocal(len), 0.0),
        }
    }

    /// Largest numbers along `axis`, which keeps extent 1.
    ///
    /// *Derivative*: that of the largest number; split evenly among equals.
    ///
    /// # Errors
    /// [`TensorError::Axis`]; [`TensorError::Operand`] if its extent is 0.
    pub fn max(&self, axis: usize) -> Result<Self, TensorError> {
        let largest = self.max_detached(axis)?;
        if !B::is_tracked(self.array()) {
            return Ok(largest);
        }
        // 1 for the largest numbers, 0 elsewhere: largest > x is 0 for them.
        let chosen = largest.greater(self)?.affine(-1.0, 1.0)?;
        let share = chosen.div(&chosen.sum(axis)?)?;
        self.mul(&share)?.sum(axis)
    }

    /// Largest numbers along `axis`, which keeps extent 1, as constants.
    ///
    /// # Errors
    /// As [`Self::max`].
    pub fn max_detached(&self, axis: usize) -> Result<Self, TensorError> {
        self.filled_axis("max", axis)?;
        Self::wrap("max", B::max(self.array(), axis))
    }

    fn filled_axis(&self, op: &'static str, axis: usize) -> Result<usize, TensorError> {
        match self.check_axis(op, axis)? {
            0 => Err(self.operand(op, "the axis must not be empty")),
            extent => Ok(extent),
        }
    }
}

#[expect(clippy::cast_precision_loss, reason = "counts of values that fit in memory")]
fn reciprocal(count: usize) -> f64 {
    1.0 / count as f64
}
