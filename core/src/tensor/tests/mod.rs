//! The checks of tensors, and the host backend on numbers worked out by hand.

mod devices;
#[cfg(feature = "safetensors")]
mod half_precision;

use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;

use super::{Adam, Host, HostDevice, Parameters, Stride, Tensor, TensorError};
use crate::diff_op::Atan2;
use crate::optim::AdamSettings;
use crate::real::DType;

fn tensor(values: &[f64], extents: &[usize]) -> Tensor<Host> {
    Tensor::new(values.to_vec(), extents, &HostDevice).unwrap()
}

fn count(len: usize) -> Vec<f64> {
    (0..len).map(|k| k as f64).collect()
}

#[test]
fn errors_name_both_operands() {
    let (a, b) = (tensor(&count(6), &[2, 3]), tensor(&count(4), &[4]));
    let messages = [
        (a.add(&b), "add of [2, 3] and [4]: each extent must equal the other's or be 1"),
        (
            a.matmul(&a),
            "matmul of [2, 3] and [2, 3]: the last extent of the first must be the last but one of the second",
        ),
        (a.reshape(&[5]), "reshape of [2, 3] and [5]: both must have the same number of values"),
        (a.slice(1, 2, 2), "slice of [2, 3]: index 3 is beyond axis 1"),
        (a.sum(2), "sum of [2, 3]: there is no axis 2"),
        (a.permute(&[0, 0]), "permute of [2, 3]: axes must name each axis once"),
        (a.add(&a.cast(DType::F32).unwrap()), "add of f64 and f32 numbers: cast one of the operands"),
        (Tensor::concat(&[&a, &b], 0), "concat of [2, 3] and [4]: all extents but that of the axis must be equal"),
        (
            Tensor::apply::<f64, _>(Atan2::new(&[3]).unwrap(), &[&a]),
            "atan2 of [2, 3]: needs as many inputs as the op has",
        ),
        (
            a.conv2d(&b, Stride { step: 1, padding: 0 }),
            "conv2d of [2, 3] and [4]: images must be batch x c x h x w, kernels o x c x kh x kw",
        ),
    ];
    for (result, message) in messages {
        assert_eq!(result.unwrap_err().to_string(), message);
    }
    assert!(matches!(a.backward(), Err(TensorError::Operand { op: "backward", .. })));
    assert!(matches!(tensor(&[1.0], &[1]).backward(), Err(TensorError::Operand { op: "backward", .. })));
}

#[test]
fn layout_moves_numbers() {
    let a = tensor(&count(6), &[2, 3]);
    assert_eq!(a.transpose().unwrap().to_f64().unwrap(), [0.0, 3.0, 1.0, 4.0, 2.0, 5.0]);
    assert_eq!(a.slice(1, 1, 2).unwrap().to_f64().unwrap(), [1.0, 2.0, 4.0, 5.0]);
    assert_eq!(a.select(0, &[1, 1, 0]).unwrap().to_f64().unwrap(), [3.0, 4.0, 5.0, 3.0, 4.0, 5.0, 0.0, 1.0, 2.0]);
    assert_eq!(Tensor::concat(&[&a, &a], 1).unwrap().to_f64().unwrap()[..6], [0.0, 1.0, 2.0, 0.0, 1.0, 2.0]);
    assert_eq!(
        tensor(&[1.0, 2.0], &[2, 1]).expand(&[2, 2, 2]).unwrap().to_f64().unwrap(),
        [1.0, 1.0, 2.0, 2.0].repeat(2)
    );
}

#[test]
fn products_and_convolution_by_hand() {
    // [[0, 1, 2], [3, 4, 5]] times its transpose: rows [0, 1, 2] and [3, 4, 5] have squares 5 and 50, product 14.
    let a = tensor(&count(6), &[2, 3]);
    assert_eq!(a.matmul(&a.transpose().unwrap()).unwrap().to_f64().unwrap(), [5.0, 14.0, 14.0, 50.0]);
    // A 3 x 3 image of 0..9 and a 2 x 2 kernel of ones, padded by one, in steps of two: sums of the four corners' windows
    // that are 0, 1 + 2, 3 + 6, 4 + 5 + 7 + 8.
    let image = tensor(&count(9), &[1, 1, 3, 3]);
    let kernel = tensor(&[1.0; 4], &[1, 1, 2, 2]);
    let stride = Stride { step: 2, padding: 1 };
    let sums = image.conv2d(&kernel, stride).unwrap();
    assert_eq!((sums.dims().extents(), sums.to_f64().unwrap()), (&[1, 1, 2, 2][..], vec![0.0, 3.0, 9.0, 24.0]));
    assert_eq!(image.max_pool2d(2, stride).unwrap().to_f64().unwrap(), [0.0, 2.0, 6.0, 8.0]);
    let negative = image.affine(-1.0, -1.0).unwrap();
    assert_eq!(
        negative.max_pool2d(2, stride).unwrap().to_f64().unwrap(),
        [-1.0, -2.0, -4.0, -5.0],
        "padding never wins"
    );
}

#[test]
fn products_over_nothing_are_zero() {
    let a = tensor(&count(6), &[2, 3]).parameter().unwrap();
    let nothing = a.slice(1, 0, 0).unwrap();
    let product = nothing.matmul(&nothing.transpose().unwrap()).unwrap();
    assert_eq!((product.dims().extents(), product.to_f64().unwrap()), (&[2, 2][..], vec![0.0; 4]));
    assert_eq!(product.sum_all().unwrap().backward().unwrap().of(&a).unwrap().to_f64().unwrap(), [0.0; 6]);
}

#[test]
fn gradients_of_a_used_twice_value_add_up() {
    // f = sum(x y) + sum(x), y = x^2: f' = 3 x^2 + 1.
    let x = tensor(&[1.0, -2.0], &[2]).parameter().unwrap();
    let y = x.mul(&x).unwrap();
    let f = x.mul(&y).unwrap().sum_all().unwrap().add(&x.sum_all().unwrap()).unwrap();
    assert_eq!(f.backward().unwrap().of(&x).unwrap().to_f64().unwrap(), [4.0, 13.0]);
    assert!(f.backward().unwrap().of(&x.detach().unwrap()).is_none());
}

#[test]
fn equal_maxima_share_the_gradient() {
    let x = tensor(&[3.0, 1.0, 3.0], &[3]).parameter().unwrap();
    let gradients = x.max(0).unwrap().reshape(&[]).unwrap().backward().unwrap();
    assert_eq!(gradients.of(&x).unwrap().to_f64().unwrap(), [0.5, 0.0, 0.5]);
}

#[test]
fn a_long_graph_is_dropped_without_recursion() {
    let mut x = tensor(&[1.0], &[1]).parameter().unwrap();
    for _ in 0..200_000 {
        x = x.affine(1.0, 0.0).unwrap();
    }
    drop(x);
}

#[test]
fn first_adam_step_has_the_length_of_the_rate() {
    // m / (1 - beta1) = g and v / (1 - beta2) = g^2, so that the step is lr g / (|g| + epsilon).
    let mut parameters = Parameters::<Host>::new();
    parameters.insert("x", &tensor(&[1.0, 1.0], &[2])).unwrap();
    let x = parameters.get("x").unwrap();
    let loss = x.mul(&tensor(&[2.0, -8.0], &[2])).unwrap().sum_all().unwrap();
    let gradients = parameters.gradients(&loss.backward().unwrap());
    Adam::new(AdamSettings { epsilon: 0.0, ..AdamSettings::default() })
        .step(&mut parameters, &gradients, 0.25)
        .unwrap();
    let moved = parameters.get("x").unwrap().to_f64().unwrap();
    assert!((moved[0] - 0.75).abs() < 1e-12 && (moved[1] - 1.25).abs() < 1e-12, "{moved:?}");
}

#[cfg(feature = "safetensors")]
#[test]
fn weights_come_back_bit_for_bit_and_foreign_files_change_nothing() {
    let mut own = Parameters::<Host>::new();
    own.insert("a.weight", &tensor(&[0.1, -0.0, f64::MIN_POSITIVE], &[3])).unwrap();
    own.insert("b", &tensor(&[7.0], &[]).cast(DType::F32).unwrap()).unwrap();
    let bytes = own.to_safetensors().unwrap();
    let read = Parameters::<Host>::from_safetensors(&bytes, &HostDevice).unwrap();
    for (name, tensor) in own.iter() {
        let (a, b) = (tensor.to_f64().unwrap(), read.get(name).unwrap().to_f64().unwrap());
        assert!(a.iter().zip(&b).all(|(a, b)| a.to_bits() == b.to_bits()), "{name}");
    }
    let mut other = Parameters::<Host>::new();
    other.insert("a.weight", &tensor(&[5.0], &[1])).unwrap();
    other.insert("b", &tensor(&[6.0], &[])).unwrap();
    let messages = [
        (bytes.clone(), "parameter a.weight is [3], the model needs [1]; check the model's sizes"),
        (bytes[..20].to_vec(), "not a safetensors file, or a damaged one"),
    ];
    for (bytes, message) in messages {
        let error = other.load_safetensors(&bytes).unwrap_err().to_string();
        assert!(error.starts_with(message), "{error}");
    }
    assert_eq!(other.get("a.weight").unwrap().to_f64().unwrap(), [5.0]);
}
