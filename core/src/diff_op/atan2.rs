//! The angle of a pair, as one differentiable step: some frameworks have no atan2, or no gradient for it.

use core::convert::Infallible;

use super::{DiffOp, OpInput, Signature};
use crate::dims::{Dims, DimsError};
use crate::real::Real;

/// Angles of pairs (y, x), in radians, (-pi, pi].
///
/// *Derivative*: (x, -y) / (x^2 + y^2) for (y, x); taken as 0 at the origin, where there is none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Atan2 {
    signature: Signature,
}

impl Atan2 {
    /// Angles of `dims` pairs per item; two inputs, y and x.
    ///
    /// # Errors
    /// As [`Dims::new`].
    pub fn new(dims: &[usize]) -> Result<Self, DimsError> {
        let inputs = [OpInput::new("y", dims)?, OpInput::new("x", dims)?];
        Ok(Self { signature: Signature::new("atan2", inputs, Dims::new(dims)?) })
    }
}

impl<T: Real> DiffOp<T> for Atan2 {
    type Scratch = ();
    type Error = Infallible;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(&self, _: usize, input: &[T], output: &mut [T], _: &mut [T], (): &mut ()) -> Result<(), Infallible> {
        let [y, x] = self.signature.split(input);
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
        let [y, x] = self.signature.split(input);
        let [grad_y, grad_x] = self.signature.split_mut(grad_input);
        for (i, &grad) in grad_output.iter().enumerate() {
            let [for_y, for_x] = atan2_vjp([y[i], x[i]], grad);
            grad_y[i] += for_y;
            grad_x[i] += for_x;
        }
        Ok(())
    }
}

/// The gradient of `grad` x atan2(y, x) with respect to (y, x); 0 at the origin, where there is none.
pub(crate) fn atan2_vjp<T: Real>([y, x]: [T; 2], grad: T) -> [T; 2] {
    let square = x * x + y * y;
    if square > T::zero() { [grad * x / square, -(grad * y / square)] } else { [T::zero(); 2] }
}
