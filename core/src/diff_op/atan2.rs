//! The angle of a pair, as one differentiable step: some frameworks have no atan2, or no gradient for it.

use core::convert::Infallible;

use super::{DiffOp, OpInput, split, split_mut};
use crate::dims::{Dims, DimsError};
use crate::real::Real;

/// Angles of pairs (y, x), in radians, (-pi, pi].
///
/// *Derivative*: (x, -y) / (x^2 + y^2) for (y, x); taken as 0 at the origin, where there is none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Atan2 {
    inputs: [OpInput; 2],
}

impl Atan2 {
    /// Angles of `dims` pairs per item; two inputs, y and x.
    ///
    /// # Errors
    /// As [`Dims::new`].
    pub fn new(dims: &[usize]) -> Result<Self, DimsError> {
        Ok(Self { inputs: [OpInput::new("y", dims)?, OpInput::new("x", dims)?] })
    }
}

impl<T: Real> DiffOp<T> for Atan2 {
    type Scratch = ();
    type Error = Infallible;

    fn name(&self) -> &'static str {
        "atan2"
    }

    fn inputs(&self) -> &[OpInput] {
        &self.inputs
    }

    fn output(&self) -> Dims {
        self.inputs[0].dims
    }

    fn forward(&self, _: usize, input: &[T], output: &mut [T], _: &mut [T], (): &mut ()) -> Result<(), Infallible> {
        let [y, x] = split(&self.inputs, input);
        for ((angle, &y), &x) in output.iter_mut().zip(y).zip(x) {
            *angle = y.atan2(x);
        }
        Ok(())
    }

    fn vjp(
        &self,
        _: usize,
        input: &[T],
        _: &[T],
        grad_output: &[T],
        grad_input: &mut [T],
        (): &mut (),
    ) -> Result<(), Infallible> {
        let [y, x] = split(&self.inputs, input);
        let [grad_y, grad_x] = split_mut(&self.inputs, grad_input);
        for (i, &grad) in grad_output.iter().enumerate() {
            let square = x[i] * x[i] + y[i] * y[i];
            if square > T::zero() {
                grad_y[i] += grad * x[i] / square;
                grad_x[i] -= grad * y[i] / square;
            }
        }
        Ok(())
    }
}
