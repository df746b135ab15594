//! What is tracked, what is refused, and tapes that go on through conversions.

use burn::tensor::Device;
use dvp_core::diff_op::{Atan2, DiffOp, OpInput, Signature};
use dvp_core::real::{DType, Real};
use dvp_core::tensor::Tensor;

use crate::{Burn, from_burn, to_burn};

#[test]
fn tracked_is_what_depends_on_a_parameter() {
    let device = Device::flex().autodiff();
    let constant = Tensor::<Burn>::new(vec![1.0, -2.0, 0.0], &[3], &device).unwrap();
    let x = constant.parameter().unwrap();
    assert!(!constant.is_tracked() && x.is_tracked());
    assert!(!constant.mul(&constant).unwrap().is_tracked());
    assert!(x.mul(&constant).unwrap().is_tracked());
    for untracked in [
        x.detach().unwrap(),
        x.cast(DType::F32).unwrap(),
        x.greater(&constant).unwrap(),
        x.max_detached(0).unwrap(),
        x.mul(&x).unwrap().detach().unwrap(),
    ] {
        assert!(!untracked.is_tracked(), "{untracked:?}");
    }
    assert_eq!(x.device(), constant.device());
    assert_eq!(format!("{:?}", x.device()), format!("{:?}", constant.device()));
    let f = x.abs().unwrap().add(&x.relu().unwrap()).unwrap().sum_all().unwrap();
    let gradients = f.backward().unwrap();
    assert_eq!(gradients.of(&x).unwrap().to_f64().unwrap(), [2.0, -1.0, 0.0], "the derivative of both is 0 at 0");
    assert!(gradients.of(&constant).is_none() && !gradients.of(&x).unwrap().is_tracked());
    let error = f.backward().unwrap_err().to_string();
    assert!(error.contains("already been consumed"), "{error}");
}

#[test]
fn numbers_are_not_rounded_to_f32() {
    let third = 1.0 / 3.0;
    let x = Tensor::<Burn>::new(vec![0.1], &[], &Device::flex()).unwrap();
    let y =
        x.affine(third, third).unwrap().mul(&Tensor::full(third, &[], DType::F64, &Device::flex()).unwrap()).unwrap();
    assert_eq!(y.number().unwrap().to_bits(), ((0.1 * third + third) * third).to_bits());
    let rounded = x.cast(DType::F32).unwrap().number().unwrap();
    assert_eq!(rounded.to_bits(), f64::from(0.1_f32).to_bits());
}

/// Halves its input; the way back of a negative number is refused.
#[derive(Debug)]
struct Half {
    signature: Signature,
}

impl Half {
    fn new() -> Self {
        let x = OpInput::new("x", &[1]).unwrap();
        Self { signature: Signature::new("half", [x], x.dims).keeping_gradient() }
    }
}

#[derive(Debug)]
struct Negative;

impl core::fmt::Display for Negative {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("negative")
    }
}

impl core::error::Error for Negative {}

impl<T: Real> DiffOp<T> for Half {
    type Scratch = ();
    type Error = Negative;

    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn forward(&self, _: usize, input: &[T], output: &mut [T], saved: &mut [T], (): &mut ()) -> Result<(), Negative> {
        // What is saved is seen in the output: whether it is asked for is what the test looks at.
        output[0] = input[0] * T::of(0.5) + if saved.is_empty() { T::zero() } else { T::of(100.0) };
        if input[0] > T::of(10.0) { Err(Negative) } else { Ok(()) }
    }

    fn vjp(&self, _: usize, input: &[T], _: &[T], grad: &[T], to: &mut [T], (): &mut ()) -> Result<(), Negative> {
        to[0] += grad[0] * T::of(0.5);
        if input[0] < T::zero() { Err(Negative) } else { Ok(()) }
    }
}

#[test]
fn steps_save_only_for_parameters_and_say_why_they_refuse() {
    let rows = |values: &[f64]| Tensor::<Burn>::new(values.to_vec(), &[values.len(), 1], &Device::flex()).unwrap();
    let constant = Tensor::apply::<f64, _>(Half::new(), &[&rows(&[1.0, 3.0])]).unwrap();
    assert_eq!((constant.to_f64().unwrap(), constant.is_tracked()), (vec![0.5, 1.5], false));

    let x = rows(&[1.0, 3.0]).parameter().unwrap();
    let tracked = Tensor::apply::<f64, _>(Half::new(), &[&x]).unwrap();
    assert_eq!((tracked.to_f64().unwrap(), tracked.is_tracked()), (vec![100.5, 101.5], true));
    let gradients = tracked.sum_all().unwrap().backward().unwrap();
    assert_eq!(gradients.of(&x).unwrap().to_f64().unwrap(), [0.5, 0.5]);

    let refused = Tensor::apply::<f64, _>(Half::new(), &[&rows(&[1.0, 11.0])]).unwrap_err().to_string();
    assert_eq!(refused, "half on burn: half, item 1: negative");

    let x = rows(&[1.0, -3.0]).parameter().unwrap();
    let gradients = Tensor::apply::<f64, _>(Half::new(), &[&x]).unwrap().sum_all().unwrap().backward().unwrap();
    assert!(gradients.of(&x).unwrap().to_f64().unwrap().iter().all(|grad| grad.is_nan()));
}

#[test]
fn tapes_go_on_through_conversions() {
    use burn::Tensor as BurnTensor;

    let device = Device::flex().autodiff();
    let x = BurnTensor::<2>::from_floats([[1.0, 2.0], [3.0, 4.0]], &device).require_grad();
    let constant = BurnTensor::<1>::from_floats([10.0, 100.0], &device);
    let inside = from_burn(x.clone() * 2.0).unwrap();
    let weights = from_burn(constant).unwrap();
    assert!(inside.is_tracked() && !weights.is_tracked());
    let loss = inside.mul(&weights).unwrap().sum_all().unwrap();
    let gradients = (to_burn::<1>(&loss).unwrap() * 3.0).backward();
    let gradient: Vec<f32> = x.grad(&gradients).unwrap().into_data().try_into_vec().unwrap();
    assert_eq!(gradient, [60.0, 600.0, 60.0, 600.0]);

    let error = to_burn::<3>(&inside).unwrap_err().to_string();
    assert_eq!(error, "to_burn of [2, 2]: must have the rank of the tensor asked for; reshape it");
    let deep = BurnTensor::<7>::ones([1; 7], &device);
    assert!(from_burn(deep).unwrap_err().to_string().starts_with("from_burn on burn: "));
    let halves = BurnTensor::<1>::ones([1], (&device, burn::tensor::DType::F16));
    let error = from_burn(halves).unwrap_err().to_string();
    assert_eq!(error, "from_burn on burn: numbers are F16; cast them to F32 or F64");
}

#[test]
fn tapes_with_and_without_checkpointing_do_not_meet() {
    use burn::Tensor as BurnTensor;

    let device = Device::flex().autodiff();
    let plain = from_burn(BurnTensor::<1>::ones([2], &device).require_grad()).unwrap();
    let sparing = BurnTensor::<1>::ones([2], &device.gradient_checkpointing()).require_grad();
    let sparing = from_burn(sparing).unwrap();
    let error = plain.mul(&sparing).unwrap_err().to_string();
    assert!(error.starts_with("mul on burn: one operand is computed with burn's gradient checkpointing"), "{error}");
    // By itself it is as good as the other.
    let rows = sparing.affine(2.0, 0.0).unwrap().reshape(&[2, 1]).unwrap();
    let angles = Tensor::apply::<f32, _>(Atan2::new(&[1]).unwrap(), &[&rows, &rows]).unwrap();
    let gradients = angles.mul(&angles).unwrap().sum_all().unwrap().backward().unwrap();
    assert_eq!(gradients.of(&sparing).unwrap().to_f64().unwrap(), [0.0, 0.0]);
}

#[test]
fn nothing_is_larger_than_nan() {
    let x = Tensor::<Burn>::new(vec![1.0, f64::NAN, 3.0, 2.0], &[2, 2], &Device::flex()).unwrap();
    let largest = x.max(1).unwrap().to_f64().unwrap();
    assert!(largest[0].is_nan() && largest[1].to_bits() == 3.0_f64.to_bits(), "{largest:?}");
}
