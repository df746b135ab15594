//! Operations made of others: one definition for all backends, whatever their own can do or get wrong.

use super::backend::{Backend, Stride, Unary};
use super::error::TensorError;
use super::handle::Tensor;
use super::unfold::Unfold;
use crate::real::DType;

impl<B: Backend> Tensor<B> {
    /// 1 / (1 + e^-x), by the hyperbolic tangent: neither it nor its gradient overflows.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn sigmoid(&self) -> Result<Self, TensorError> {
        self.affine(0.5, 0.0)?.tanh()?.affine(0.5, 0.5)
    }

    /// Numbers below `low` as `low`, above `high` as `high`.
    ///
    /// *Derivative*: 1 between the two, 0 outside and at both.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn clamp(&self, low: f64, high: f64) -> Result<Self, TensorError> {
        let above = self.affine(1.0, -low)?.relu()?;
        above.sub(&self.affine(1.0, -high)?.relu()?)?.affine(1.0, low)
    }

    /// x Phi(x), Phi the distribution of the normal distribution: GELU without approximation.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn gelu(&self) -> Result<Self, TensorError> {
        let phi = self.affine(core::f64::consts::FRAC_1_SQRT_2, 0.0)?.unary(Unary::Erf)?.affine(0.5, 0.5)?;
        self.mul(&phi)
    }

    /// Positive numbers along `axis` that sum to 1 and go as e^x.
    ///
    /// # Errors
    /// As [`Self::max`].
    pub fn softmax(&self, axis: usize) -> Result<Self, TensorError> {
        let powers = self.sub(&self.max_detached(axis)?)?.exp()?;
        powers.div(&powers.sum(axis)?)
    }

    /// The logarithm of [`Self::softmax`].
    ///
    /// # Errors
    /// As [`Self::max`].
    pub fn log_softmax(&self, axis: usize) -> Result<Self, TensorError> {
        let shifted = self.sub(&self.max_detached(axis)?)?;
        shifted.sub(&shifted.exp()?.sum(axis)?.log()?)
    }

    /// Numbers of the last axis minus their mean, over the root of their variance + `epsilon`; without weights.
    ///
    /// # Errors
    /// As [`Self::mean`]; [`TensorError::Operand`] for rank 0.
    pub fn layer_norm(&self, epsilon: f64) -> Result<Self, TensorError> {
        let Some(axis) = self.dims().rank().checked_sub(1) else {
            return Err(self.operand("layer_norm", "needs at least one axis"));
        };
        let centered = self.sub(&self.mean(axis)?)?;
        let variance = centered.mul(&centered)?.mean(axis)?;
        centered.div(&variance.affine(1.0, epsilon)?.sqrt()?)
    }

    /// x w + b: `weights` inputs x outputs, `bias` outputs.
    ///
    /// # Errors
    /// As [`Self::matmul`] and [`Self::add`].
    pub fn linear(&self, weights: &Self, bias: &Self) -> Result<Self, TensorError> {
        self.matmul(weights)?.add(bias)
    }

    /// The largest number of each window of `side` x `side` pixels; images batch x c x h x w. Padding never wins.
    ///
    /// *Derivative*: as [`Self::max`].
    ///
    /// # Errors
    /// As [`Unfold::new`]; [`TensorError::Operand`] if the rank is not 4 or no window fits.
    pub fn max_pool2d(&self, side: usize, stride: Stride) -> Result<Self, TensorError> {
        let &[batch, c, h, w] = self.dims().extents() else {
            return Err(self.operand("max_pool2d", "images must be batch x c x h x w"));
        };
        let (rows, columns) = (stride.windows(h, side), stride.windows(w, side));
        if side == 0 || rows == 0 || columns == 0 || stride.padding >= side {
            let must =
                "the window must fit into the padded image and be larger than the padding, with steps of at least 1";
            return Err(self.operand("max_pool2d", must));
        }
        let op = Unfold::new([c, h, w], [side, side], stride)?.with_padding(f64::MIN);
        let windows = match self.dtype() {
            DType::F32 => Self::apply::<f32, _>(op.with_padding(f64::from(f32::MIN)), &[self])?,
            DType::F64 => Self::apply::<f64, _>(op, &[self])?,
        };
        let windows = windows.reshape(&[batch, c, side * side, rows * columns])?;
        windows.max(2)?.reshape(&[batch, c, rows, columns])
    }
}
