//! What the crate's docs say of candle: where one of these fails, candle has been mended and the detour can go.

use candle_core::{Device, Tensor, Var};

fn gradient(variable: &Var, result: &Tensor) -> Option<f64> {
    let gradients = result.sum_all().unwrap().backward().unwrap();
    gradients.get(variable).map(|gradient| gradient.sum_all().unwrap().to_vec0::<f32>().unwrap().into())
}

#[test]
fn derivatives_at_zero_and_of_nothing() {
    let zero = Var::new(&[0.0_f32], &Device::Cpu).unwrap();
    assert_eq!(gradient(&zero, &zero.relu().unwrap()), Some(1.0));
    assert_eq!(gradient(&zero, &zero.abs().unwrap()), Some(1.0));
    assert_eq!(gradient(&zero, &zero.affine(0.0, 1.0).unwrap()), None);
}

#[test]
fn quotients_of_small_numbers() {
    let small = Var::new(&[1e-25_f32], &Device::Cpu).unwrap();
    let found = gradient(&small, &small.detach().div(&small).unwrap()).unwrap();
    assert!(!found.is_finite(), "{found}");
}

#[test]
fn largest_of_nan() {
    let numbers = Tensor::new(&[1.0_f32, f32::NAN, 2.0], &Device::Cpu).unwrap();
    assert_eq!(numbers.max_keepdim(0).unwrap().to_vec1::<f32>().unwrap(), [2.0]);
}

#[test]
fn one_matrix_times_transposed_ones() {
    let numbers = |count: u32| Tensor::arange(0.0_f64, f64::from(count), &Device::Cpu).unwrap();
    let left = numbers(24).reshape((2, 4, 3)).unwrap().transpose(1, 2).unwrap();
    let right = numbers(8).reshape((1, 4, 2)).unwrap().broadcast_as((2, 4, 2)).unwrap();
    let values = |product: Tensor| product.flatten_all().unwrap().to_vec1::<f64>().unwrap();
    let expected = values(left.contiguous().unwrap().matmul(&right.contiguous().unwrap()).unwrap());
    assert_ne!(values(left.matmul(&right).unwrap()), expected);
    assert_eq!(values(crate::product::matmul(&left, &right).unwrap()), expected);
}

#[test]
fn convolution_with_different_remainders() {
    let images = Var::ones((1, 1, 7, 8), candle_core::DType::F32, &Device::Cpu).unwrap();
    let kernels = Tensor::ones((1, 1, 3, 3), candle_core::DType::F32, &Device::Cpu).unwrap();
    let result = images.conv2d(&kernels, 0, 2, 1, 1).unwrap();
    assert!(result.sum_all().unwrap().backward().is_err());
}
