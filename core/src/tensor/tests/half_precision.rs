//! Files of half precision: every number of F16 and BF16 by its definition, rounding by hand, what is refused.

use alloc::string::ToString;
use alloc::vec;
use alloc::vec::Vec;

use safetensors::tensor::{Dtype, TensorView, serialize};

use super::super::{Host, HostDevice, Parameters, ParametersError, Tensor, safetensors_note};
use crate::real::{DType, Values};

/// A file of one parameter, x, whose numbers have these bits.
fn file(dtype: Dtype, bits: &[u16]) -> Vec<u8> {
    let bytes: Vec<u8> = bits.iter().flat_map(|bits| bits.to_le_bytes()).collect();
    serialize([("x", TensorView::new(dtype, vec![bits.len()], &bytes).unwrap())], None).unwrap()
}

fn read(bytes: &[u8]) -> Parameters<Host> {
    Parameters::from_safetensors(bytes, &HostDevice).unwrap()
}

fn x(parameters: &Parameters<Host>) -> Vec<f64> {
    parameters.get("x").unwrap().to_f64().unwrap()
}

fn of(values: Values) -> Parameters<Host> {
    let mut parameters = Parameters::new();
    let tensor = match values {
        Values::F32(values) => Tensor::new(values.clone(), &[values.len()], &HostDevice),
        Values::F64(values) => Tensor::new(values.clone(), &[values.len()], &HostDevice),
    };
    parameters.insert("x", &tensor.unwrap()).unwrap();
    parameters
}

/// The number of a sign, an exponent and a fraction as IEEE 754 has it, by powers of two.
fn number(bits: u16, fraction_bits: u32, exponent_bits: u32) -> f64 {
    let (fraction, exponent) = (bits % (1 << fraction_bits), bits >> fraction_bits & ((1 << exponent_bits) - 1));
    let (bias, sign) = ((1 << (exponent_bits - 1)) - 1, if bits >> 15 == 1 { -1.0 } else { 1.0 });
    let share = f64::from(fraction) / f64::from(1_u32 << fraction_bits);
    sign * match exponent {
        0 => share * 2.0_f64.powi(1 - bias),
        top if top == (1 << exponent_bits) - 1 => {
            if fraction == 0 {
                f64::INFINITY
            } else {
                f64::NAN
            }
        }
        _ => (1.0 + share) * 2.0_f64.powi(i32::from(exponent) - bias),
    }
}

#[test]
fn every_number_of_half_precision_is_read_as_it_is() {
    let all: Vec<u16> = (0..=u16::MAX).collect();
    for (dtype, fraction_bits, exponent_bits) in [(Dtype::F16, 10, 5), (Dtype::BF16, 7, 8)] {
        let parameters = read(&file(dtype, &all));
        assert_eq!(parameters.get("x").unwrap().dtype(), DType::F32);
        for (bits, found) in all.iter().zip(x(&parameters)) {
            let expected = number(*bits, fraction_bits, exponent_bits);
            let same = found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan();
            assert!(same, "{dtype:?} {bits:#06x}: {found} for {expected}");
        }
    }
}

#[test]
fn what_f16_holds_comes_back_bit_for_bit() {
    // Zeros of both signs, subnormals and infinities among them; all but what is no number, whose bits may differ.
    let bits: Vec<u16> = (0..=u16::MAX).filter(|&bits| !number(bits, 10, 5).is_nan()).collect();
    let own = read(&file(Dtype::F16, &bits));
    let bytes = own.to_safetensors_half(Some("kept"), |_, _| true).unwrap();
    assert_eq!(safetensors_note(&bytes).unwrap().as_deref(), Some("kept"));
    assert!(x(&own).iter().zip(x(&read(&bytes))).all(|(a, b)| a.to_bits() == b.to_bits()));
    assert!(bytes.len() < 2 * bits.len() + 300, "{} bytes", bytes.len());
    let none = of(Values::F32(vec![f32::NAN])).to_safetensors_half(None, |_, _| true).unwrap();
    assert!(x(&read(&none))[0].is_nan());
}

#[test]
fn numbers_are_rounded_to_the_nearest_and_to_even_between_two() {
    // Above 2048 every second number is there, at 1 every 2^-10; the smallest above 0 is 2^-24, the largest 65504, and from 65520
    // on the nearest would be 2^16.
    let tiny = 2.0_f64.powi(-24);
    let pairs = [
        (2049.0, 2048.0),
        (2051.0, 2052.0),
        (1.0 + 2.0_f64.powi(-11), 1.0),
        (1.0 + 3.0 * 2.0_f64.powi(-11), 1.0 + 2.0_f64.powi(-9)),
        (-0.1, -0.099_975_585_937_5),
        (0.5 * tiny, 0.0),
        (0.75 * tiny, tiny),
        (-1.5 * tiny, -2.0 * tiny),
        (-0.0, -0.0),
        (65519.0, 65504.0),
    ];
    let given: Vec<f64> = pairs.iter().map(|pair| pair.0).collect();
    let single = Values::F64(given.clone()).cast(DType::F32);
    for own in [of(single), of(Values::F64(given))] {
        let found = x(&read(&own.to_safetensors_half(None, |_, _| true).unwrap()));
        for ((value, expected), found) in pairs.iter().zip(found) {
            assert!(found.to_bits() == expected.to_bits(), "{value}: {found} for {expected}");
        }
    }
}

#[test]
fn what_is_beyond_f16_is_refused_and_named() {
    for values in [Values::F32(vec![1.0, -65520.0]), Values::F64(vec![1.0, 1e300]), Values::F64(vec![3e38, 1e5])] {
        let error = of(values).to_safetensors_half(None, |_, _| true).unwrap_err();
        assert!(matches!(&error, ParametersError::Half { name, value } if name == "x" && value.abs() > 65519.0));
        assert!(error.to_string().contains("F16 ends at 65504"), "{error}");
    }
}

#[test]
fn only_what_is_asked_for_is_rounded() {
    let mut own = of(Values::F64(vec![0.1]));
    own.insert("y", &Tensor::new(vec![0.1_f64, 0.3], &[2, 1], &HostDevice).unwrap()).unwrap();
    let bytes = own.to_safetensors_half(None, |_, dims| dims.rank() == 2).unwrap();
    let found = read(&bytes);
    assert_eq!((x(&found), found.get("x").unwrap().dtype()), (vec![0.1], DType::F64));
    let rounded = found.get("y").unwrap().to_f64().unwrap();
    assert!((rounded[0] - 0.1).abs() < 1e-4 && rounded[0].to_bits() != 0.1_f64.to_bits());
    // Into a model of f64, whose numbers stay of that type.
    own.load_safetensors(&bytes).unwrap();
    assert_eq!(own.get("y").unwrap().dtype(), DType::F64);
    assert_eq!(own.get("y").unwrap().to_f64().unwrap(), rounded);
}

#[test]
fn cut_files_and_other_types_are_refused() {
    let bytes = file(Dtype::F16, &[0x3c00; 5]);
    for len in 0..bytes.len() {
        let error = Parameters::<Host>::from_safetensors(&bytes[..len], &HostDevice).unwrap_err();
        assert!(matches!(error, ParametersError::Format(_)), "{len} bytes: {error}");
    }
    let error = Parameters::<Host>::from_safetensors(&file(Dtype::I16, &[1]), &HostDevice).unwrap_err();
    assert_eq!(
        error.to_string(),
        "parameter x holds I16 numbers; only F16, BF16, F32 and F64 are read: convert the file"
    );
}
