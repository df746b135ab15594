//! Steps of the core as nodes, and candle's own graph around them.

use alloc::sync::Arc;

use dvp_core::diff_op::{Atan2, Batched, DiffOp, HostOp, OpInput, Signature};
use dvp_core::dims::{Dims, DimsError};
use dvp_core::real::DType;
use dvp_core::tensor::{Backend, Host, HostDevice, Tensor, TensorError};

use super::{assert_close, numbers, outcome};
use crate::{Candle, CandleDevice, from_candle, to_candle};

#[test]
fn steps_of_the_core() {
    fn angles<B: Backend>(x: &Tensor<B>, y: &Tensor<B>) -> Result<Tensor<B>, TensorError> {
        match x.dtype() {
            DType::F32 => Tensor::apply::<f32, _>(Atan2::new(&[3])?, &[y, x]),
            DType::F64 => Tensor::apply::<f64, _>(Atan2::new(&[3])?, &[y, x]),
        }
    }
    agree!([&[4, 3], &[3, 4]], |x| angles(&x[0].exp()?, &x[1].transpose()?)?.mul(&x[0]));
    agree!([&[1, 3]], |x| angles(&x[0].expand(&[5, 3])?, &x[0].expand(&[5, 3])?.exp()?));
}

/// Refuses every second item, forward or backward.
#[derive(Debug)]
struct Refuses {
    signature: Signature,
    backward: bool,
}

impl Refuses {
    fn shared(backward: bool) -> Result<Arc<dyn HostOp>, DimsError> {
        let signature = Signature::new("refuses", [OpInput::new("x", &[2])?], Dims::SCALAR).keeping_gradient();
        Ok(Arc::new(Batched::<f64, _>::new(Self { signature, backward })))
    }
}

impl DiffOp<f64> for Refuses {
    type Scratch = ();
    type Error = DimsError;

    fn signature(&self) -> &Signature {
        &self.signature
    }
    fn forward(&self, item: usize, _: &[f64], _: &mut [f64], saved: &mut [f64], (): &mut ()) -> Result<(), DimsError> {
        saved.fill(1.0);
        if item == 1 && !self.backward { Err(Dims::new(&[1; 9]).unwrap_err()) } else { Ok(()) }
    }
    fn vjp(
        &self,
        item: usize,
        _: &[f64],
        saved: &[f64],
        _: &[f64],
        _: &mut [f64],
        (): &mut (),
    ) -> Result<(), DimsError> {
        assert_eq!(saved, [1.0; 2]);
        if item == 1 { Err(Dims::new(&[1; 9]).unwrap_err()) } else { Ok(()) }
    }
}

#[test]
fn candles_own_graph_goes_through() {
    // d/dx sum(angle(y, x^2)^2) with x candle's own variable, the squares candle's, the angle a step of the core.
    let device = candle_core::Device::Cpu;
    let x = candle_core::Var::from_vec(numbers(3, 1), (1, 3), &device).unwrap();
    let y = candle_core::Tensor::from_vec(numbers(3, 2), (1, 3), &device).unwrap();
    let squares = from_candle(&x.sqr().unwrap()).unwrap();
    let angles = Tensor::apply::<f64, _>(Atan2::new(&[3]).unwrap(), &[&from_candle(&y).unwrap(), &squares]).unwrap();
    let gradients = to_candle(&angles).sqr().unwrap().sum_all().unwrap().backward().unwrap();
    let found = gradients.get(&x).unwrap().flatten_all().unwrap().to_vec1::<f64>().unwrap();
    let expected = numbers(3, 1).into_iter().zip(numbers(3, 2)).map(|(x, y)| {
        let square = x * x;
        2.0 * y.atan2(square) * (-y / (square * square + y * y)) * 2.0 * x
    });
    assert_close("own graph", &[found], &[expected.collect()], 1e-14);
}

#[test]
fn numbers_of_other_types_are_refused() {
    let device = candle_core::Device::Cpu;
    let whole = candle_core::Tensor::zeros((2, 2), candle_core::DType::U32, &device).unwrap();
    let error = from_candle(&whole).unwrap_err().to_string();
    assert_eq!(error, "from_candle on candle: numbers are U32; cast them to F32 or F64");
    let deep = candle_core::Tensor::zeros(vec![1; 7], candle_core::DType::F32, &device).unwrap();
    assert!(matches!(from_candle(&deep), Err(TensorError::NoDims(_))));
}

#[test]
fn refused_items_are_errors_in_the_steps_own_words() {
    let words = Dims::new(&[1; 9]).unwrap_err().to_string();
    let input = Tensor::<Candle>::new(vec![0.0_f64; 4], &[2, 2], &CandleDevice::CPU).unwrap().parameter().unwrap();
    let error = Tensor::apply_shared(&Refuses::shared(false).unwrap(), &[&input]).unwrap_err().to_string();
    assert!(error.contains(&format!("refuses, item 1: {words}")), "{error}");
    let output = Tensor::apply_shared(&Refuses::shared(true).unwrap(), &[&input]).unwrap();
    let error = output.sum_all().unwrap().backward().unwrap_err().to_string();
    assert!(error.contains(&format!("refuses, item 1: {words}")), "{error}");
}
