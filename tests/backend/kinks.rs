//! Points without a derivative: what is taken instead is the same everywhere.

use dvp_core::diff_op::Atan2;
use dvp_core::real::DType;
use dvp_core::tensor::{Stride, Tensor, TensorError, Unary};

use crate::check::close;
use crate::registry::{Outcome, Tally, Tested, on_every_backend};

/// The gradient of the sum of what `f` makes of `values`.
fn gradient<B: Tested>(
    values: &[f64],
    extents: &[usize],
    dtype: DType,
    f: impl FnOnce(&Tensor<B>) -> Result<Tensor<B>, TensorError>,
) -> Result<Vec<f64>, TensorError> {
    let x = Tensor::<B>::new(values.to_vec(), extents, &B::place())?.cast(dtype)?.parameter()?;
    f(&x)?.sum_all()?.backward()?.of(&x).unwrap().to_f64()
}

fn kinks<B: Tested>(tally: &Tally) -> Outcome {
    for dtype in [DType::F32, DType::F64] {
        let zeros = [0.0, -0.0, 1.0, -1.0];
        let of = |function| gradient::<B>(&zeros, &[4], dtype, |x| x.unary(function));
        close(tally, "|x| at 0", &of(Unary::Abs)?, &[0.0, 0.0, 1.0, -1.0], 0.0)?;
        close(tally, "relu at 0", &of(Unary::Relu)?, &[0.0, 0.0, 1.0, 0.0], 0.0)?;

        let root = gradient::<B>(&[0.0, 4.0], &[2], dtype, |x| x.sqrt())?;
        tally.check(root == [f64::INFINITY, 0.25], || format!("root at 0: {root:?}"))?;

        // Two of the three in the first row, all of the second, one of the third.
        let ties = [2.0, 1.0, 2.0, 5.0, 5.0, 5.0, -1.0, -2.0, -3.0];
        let third = 1.0 / 3.0;
        let shares = [0.5, 0.0, 0.5, third, third, third, 1.0, 0.0, 0.0];
        // f32 rounds 1/3.
        close(tally, "ties", &gradient::<B>(&ties, &[3, 3], dtype, |x| x.max(1))?, &shares, 1e-7)?;

        // One window of four zeros, and one of two zeros (the padding never shares).
        let pooled =
            gradient::<B>(&[0.0; 6], &[1, 1, 2, 3], dtype, |x| x.max_pool2d(2, Stride { step: 2, padding: 0 }))?;
        close(tally, "ties in a window", &pooled, &[0.25, 0.25, 0.0, 0.25, 0.25, 0.0], 0.0)?;
        let padded =
            gradient::<B>(&[0.0; 2], &[1, 1, 1, 2], dtype, |x| x.max_pool2d(2, Stride { step: 2, padding: 1 }))?;
        close(tally, "padding never wins", &padded, &[1.0, 1.0], 0.0)?;

        let origin = gradient::<B>(&[0.0, 1.0], &[1, 2], dtype, |y| {
            let x = y.affine(0.0, 0.0)?;
            match dtype {
                DType::F32 => Tensor::apply::<f32, _>(Atan2::new(&[2])?, &[y, &x]),
                DType::F64 => Tensor::apply::<f64, _>(Atan2::new(&[2])?, &[y, &x]),
            }
        })?;
        close(tally, "angle at the origin", &origin, &[0.0, 0.0], 0.0)?;
    }
    Ok(())
}

#[test]
fn kinks_everywhere() {
    on_every_backend!(kinks);
}
