//! The operations of the trait.

use dvp_core::real::DType;
use dvp_core::tensor::{Host, HostDevice, Stride, Tensor, Unary};

use super::{assert_close, outcome};
use crate::{Candle, CandleDevice, convolution};

#[test]
fn functions_of_one_number() {
    for function in Unary::ALL {
        // Logarithm and root want positive numbers.
        agree!([&[5, 7]], |x| x[0].mul(&x[0])?.affine(1.0, 0.1)?.unary(function));
    }
    for function in [Unary::Abs, Unary::Cos, Unary::Erf, Unary::Exp, Unary::Relu, Unary::Sin, Unary::Tanh] {
        agree!([&[5, 7]], |x| x[0].transpose()?.unary(function));
    }
    agree!([&[3, 5]], |x| x[0].affine(1.0 / 3.0, 1e-9)?.transpose()?.affine(-0.1, 0.7));
    agree!([&[3, 5]], |x| x[0].affine(0.0, 0.7));
}

#[test]
fn kinks_have_derivative_0() {
    for function in [Unary::Abs, Unary::Relu] {
        let zero = Tensor::<Candle>::new(vec![0.0_f32, -0.0, 2.0, -2.0], &[4], &CandleDevice::CPU).unwrap();
        let zero = zero.parameter().unwrap();
        let gradients = zero.unary(function).unwrap().sum_all().unwrap().backward().unwrap();
        let negative = if function == Unary::Abs { -1.0 } else { 0.0 };
        assert_eq!(gradients.of(&zero).unwrap().to_f64().unwrap(), [0.0, 0.0, 1.0, negative]);
    }
}

#[test]
fn functions_of_two_numbers() {
    agree!([&[3, 5], &[3, 5]], |x| x[0].add(&x[1])?.mul(&x[0]));
    agree!([&[3, 1, 4], &[1, 5, 1]], |x| x[0].mul(&x[1]));
    agree!([&[2, 3, 5], &[5]], |x| x[0].sub(&x[1])?.mul(&x[1]));
    agree!([&[7], &[2, 3, 1]], |x| x[1].sub(&x[0]));
    agree!([&[4, 3], &[3, 1]], |x| x[0].transpose()?.div(&x[1].mul(&x[1])?.affine(1.0, 0.5)?));
    agree!([&[3, 3]], |x| x[0].div(&x[0].transpose()?.exp()?)?.add(&x[0]));
    agree!([&[3, 1], &[1, 4]], |x| x[0].expand(&[3, 4])?.mul(&x[1].expand(&[3, 4])?.sub(&x[0])?));
    agree!([&[3, 1], &[1, 4]], |x| x[0].greater(&x[1]));
}

#[test]
fn quotients_of_small_numbers_keep_their_gradient() {
    // d (a / b) / db = -a / b^2; b^2 is 0 in f32.
    let number = |value: f32| Tensor::<Candle>::new(vec![value], &[1], &CandleDevice::CPU).unwrap();
    let (a, b) = (number(1e-25), number(1e-25).parameter().unwrap());
    let gradient = a.div(&b).unwrap().backward().unwrap().of(&b).unwrap().number().unwrap();
    assert!((gradient / -1e25 - 1.0).abs() < 1e-6, "{gradient}");
}

#[test]
fn layout() {
    agree!([&[2, 3, 5]], |x| x[0].permute(&[2, 0, 1])?.reshape(&[10, 3])?.mul(&x[0].reshape(&[10, 3])?));
    agree!([&[1, 3, 1]], |x| x[0].expand(&[4, 2, 3, 5])?.permute(&[3, 1, 0, 2]));
    agree!([&[4, 7]], |x| x[0].slice(1, 2, 3)?.mul(&x[0].transpose()?.slice(0, 0, 3)?.transpose()?));
    agree!([&[2, 3], &[2, 4], &[1, 1]], |x| Tensor::concat(&[&x[0], &x[1], &x[2].expand(&[2, 2])?, &x[0]], 1));
    agree!([&[3, 2], &[4, 3]], |x| Tensor::concat(&[&x[0].transpose()?, &x[1]], 0));
    agree!([&[2, 3, 4], &[2, 4, 5]], |x| Tensor::concat(&[&x[0].permute(&[0, 2, 1])?, &x[1]], 2));
    agree!([&[3, 4]], |x| x[0].transpose()?.select(0, &[3, 1, 1])?.mul(&x[0].transpose()?.select(0, &[0, 1, 3])?));
    agree!([&[2, 3, 2]], |x| x[0].select(1, &[2, 2, 0, 1, 2]));
    agree!([&[2, 3]], |x| x[0].mul(&x[0].detach()?));
}

#[test]
fn sums_and_largest_numbers() {
    for axis in 0..3 {
        agree!([&[3, 5, 7]], |x| x[0].sum(axis)?.mul(&x[0]));
        agree!([&[3, 7, 5]], |x| x[0].permute(&[2, 0, 1])?.sum(axis));
        agree!([&[3, 7, 5]], |x| x[0].permute(&[2, 0, 1])?.max_detached(axis));
        agree!([&[3, 5, 7]], |x| x[0].softmax(axis)?.mul(&x[0].log_softmax(axis)?));
    }
    agree!([&[3, 5, 7]], |x| x[0].max(1)?.add(&x[0]));
    agree!([&[4, 9]], |x| x[0].layer_norm(1e-5)?.gelu());
    agree!([&[2, 3, 7, 5]], |x| x[0].max_pool2d(3, Stride { step: 2, padding: 1 }));
}

#[test]
fn products() {
    agree!([&[3, 5], &[5, 7]], |x| x[0].matmul(&x[1]));
    agree!([&[2, 3, 5], &[2, 5, 3]], |x| x[0].matmul(&x[1])?.matmul(&x[0]));
    agree!([&[2, 5, 3], &[2, 7, 5]], |x| x[0].transpose()?.matmul(&x[1].transpose()?));
    // One matrix for the whole batch, as it is and on its side; the other one too.
    agree!([&[4, 3, 5], &[1, 5, 2]], |x| x[0].matmul(&x[1]));
    agree!([&[4, 5, 3], &[1, 2, 5]], |x| x[0].transpose()?.matmul(&x[1].transpose()?));
    agree!([&[1, 3, 5], &[4, 5, 2]], |x| x[0].matmul(&x[1])?.sum(0));
    agree!([&[3, 1, 2, 5], &[4, 5, 2]], |x| x[0].matmul(&x[1]));
    // Matrices with gaps, and the same number all over.
    agree!([&[2, 3, 9], &[2, 9, 4]], |x| x[0].slice(2, 1, 5)?.matmul(&x[1].slice(1, 3, 5)?));
    agree!([&[2, 3, 1], &[2, 1, 1]], |x| x[0].expand(&[2, 3, 4])?.matmul(&x[1].expand(&[2, 4, 6])?));
    agree!([&[1, 1, 5], &[1, 5, 1]], |x| x[0].matmul(&x[1]));
}

#[test]
fn nothing_at_all() {
    agree!([&[0, 3]], |x| x[0].sum(0)?.add(&x[0].exp()?.sum(0)?));
    agree!([&[3, 0]], |x| x[0].transpose()?.sum(0)?.relu());
    agree!([&[2, 3, 0], &[2, 0, 5]], |x| x[0].matmul(&x[1]));
    agree!([&[2, 0, 3], &[3, 5]], |x| x[0].matmul(&x[1]));
    agree!([&[4, 3]], |x| x[0].slice(0, 2, 0)?.reshape(&[3, 0])?.sum(1));
    agree!([&[4, 3], &[4, 0]], |x| Tensor::concat(&[&x[0], &x[1], &x[0]], 1));
    agree!([&[4, 3]], |x| x[0].select(1, &[])?.sum(1));
    agree!([&[0, 2, 5, 5], &[3, 2, 2, 2]], |x| x[0].conv2d(&x[1], Stride { step: 1, padding: 0 }));
    agree!([&[]], |x| x[0].mul(&x[0])?.permute(&[]));
    agree!([&[]], |x| x[0].reshape(&[1, 1])?.expand(&[2, 3])?.tanh());
}

/// Rows, columns, side of the kernels, step, padding: remainders that differ, where candle's own gradient fails; windows
/// smaller than the step.
const SIZES: [(usize, usize, usize, usize, usize); 6] =
    [(7, 8, 3, 2, 1), (9, 7, 3, 3, 0), (5, 6, 2, 3, 1), (6, 5, 1, 2, 0), (8, 8, 3, 1, 1), (6, 9, 3, 5, 3)];

#[test]
fn convolution() {
    // Rows and columns that leave different remainders, where candle's own gradient fails.
    for (h, w, side, step, padding) in
        [(7, 8, 3, 2, 1), (9, 7, 3, 3, 0), (5, 6, 2, 3, 1), (6, 5, 1, 2, 0), (8, 8, 3, 1, 1)]
    {
        let stride = Stride { step, padding };
        agree!([&[3, 2, h, w], &[4, 2, side, side]], |x| x[0].conv2d(&x[1], stride));
    }
    let stride = Stride { step: 2, padding: 1 };
    agree!([&[2, 7, 6, 3], &[3, 4, 2, 3]], |x| {
        x[0].permute(&[0, 3, 1, 2])?.conv2d(&x[1].permute(&[1, 0, 2, 3])?, stride)
    });
    agree!([&[2, 2, 5, 5]], |x| x[0].conv2d(&x[0].slice(2, 0, 3)?, stride));
    // More images than groups, and slices that start later.
    agree!([&[39, 1, 3, 4], &[2, 1, 2, 2]], |x| x[0].slice(0, 1, 37)?.conv2d(&x[1].slice(0, 1, 1)?, stride));
}

#[test]
fn convolution_by_candle_fits_its_images() {
    // What a GPU runs, here on the processor: candle's own convolution of images that leave no remainder.
    let device = CandleDevice::CPU;
    for (h, w, side, step, padding) in SIZES {
        let stride = Stride { step, padding };
        let extents: [&[usize]; 2] = [&[3, 2, h, w], &[4, 2, side, side]];
        let ours = outcome::<Candle>(&extents, DType::F64, &device, |x| x[0].conv2d(&x[1], stride));
        let own = outcome::<Candle>(&extents, DType::F64, &device, |x| {
            let fitted = convolution::fitted(x[0].array(), x[1].array(), stride).unwrap();
            Ok(Tensor::from_array(fitted.conv2d(x[1].array(), 0, step, 1, 1).unwrap()))
        });
        assert_close("fitted", &own, &ours, 1e-14);
    }
}
