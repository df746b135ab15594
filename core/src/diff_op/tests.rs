//! Batches of steps, their number types and their errors.

use alloc::string::ToString;

use super::{Atan2, Batched, HostOp};
use crate::real::{DType, Values};

#[test]
fn angles_and_their_gradients() {
    // atan2(1, 1) = pi / 4, gradient (1/2, -1/2); at the origin both are taken as 0. Items are (y, y, x, x).
    let op = Batched::<f64, _>::new(Atan2::new(&[2]).unwrap());
    let input = Values::F64([1.0, 0.0, 1.0, 0.0].to_vec());
    let (angles, saved) = op.forward(1, input.as_ref(), true).unwrap();
    assert_eq!(angles.to_f64(), [core::f64::consts::FRAC_PI_4, 0.0]);
    let ones = Values::F64([1.0, 1.0].to_vec());
    let grad = op.vjp(1, input.as_ref(), saved.as_ref(), ones.as_ref()).unwrap();
    assert_eq!(grad.to_f64(), [0.5, 0.0, -0.5, 0.0]);
}

#[test]
fn wrong_lengths_and_types_are_refused() {
    let op = Batched::<f32, _>::new(Atan2::new(&[2]).unwrap());
    let message = |values: Values| op.forward(1, values.as_ref(), false).unwrap_err().to_string();
    assert_eq!(message(Values::zeros(DType::F32, 3)), "atan2: input has 3 values, needs 4");
    assert_eq!(
        message(Values::zeros(DType::F64, 4)),
        "atan2: made for f32, got f64; make the op in the tensors' type, or cast them"
    );
}
