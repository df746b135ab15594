//! Operands on different devices are refused before the backend sees them: shown on a host that has two.

use alloc::string::ToString;
use alloc::sync::Arc;
use alloc::vec::Vec;

use crate::diff_op::{Atan2, HostOp};
use crate::dims::Dims;
use crate::real::{DType, Values};
use crate::tensor::{
    Backend, BackendError, Binary, Host, HostArray, HostDevice, HostGradients, Stride, Tensor, TensorError, Unary,
};

/// Host arrays in two places.
#[derive(Clone, Debug)]
struct Twofold;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Place {
    Near,
    Far,
}

#[derive(Clone, Debug)]
struct Placed {
    array: HostArray,
    place: Place,
}

impl Placed {
    /// A result of one operand.
    fn with(&self, array: Result<HostArray, BackendError>) -> Result<Self, BackendError> {
        Ok(Self { array: array?, place: self.place })
    }

    /// A result of two, which callers have checked.
    fn with_both(&self, other: &Self, array: Result<HostArray, BackendError>) -> Result<Self, BackendError> {
        assert_eq!(self.place, other.place, "the backend was reached");
        self.with(array)
    }
}

impl Backend for Twofold {
    type Device = Place;
    type Array = Placed;
    type Gradients = HostGradients;

    const NAME: &'static str = "twofold";

    fn upload(values: Values, dims: &Dims, &place: &Place) -> Result<Placed, BackendError> {
        Ok(Placed { array: Host::upload(values, dims, &HostDevice)?, place })
    }
    fn download(array: &Placed) -> Result<Values, BackendError> {
        Host::download(&array.array)
    }
    fn dims(array: &Placed) -> Dims {
        Host::dims(&array.array)
    }
    fn dtype(array: &Placed) -> DType {
        Host::dtype(&array.array)
    }
    fn device(array: &Placed) -> Place {
        array.place
    }
    fn cast(array: &Placed, dtype: DType) -> Result<Placed, BackendError> {
        array.with(Host::cast(&array.array, dtype))
    }
    fn unary(function: Unary, array: &Placed) -> Result<Placed, BackendError> {
        array.with(Host::unary(function, &array.array))
    }
    fn affine(array: &Placed, scale: f64, offset: f64) -> Result<Placed, BackendError> {
        array.with(Host::affine(&array.array, scale, offset))
    }
    fn binary(function: Binary, a: &Placed, b: &Placed) -> Result<Placed, BackendError> {
        a.with_both(b, Host::binary(function, &a.array, &b.array))
    }
    fn greater(a: &Placed, b: &Placed) -> Result<Placed, BackendError> {
        a.with_both(b, Host::greater(&a.array, &b.array))
    }
    fn reshape(array: &Placed, dims: &Dims) -> Result<Placed, BackendError> {
        array.with(Host::reshape(&array.array, dims))
    }
    fn permute(array: &Placed, axes: &[usize]) -> Result<Placed, BackendError> {
        array.with(Host::permute(&array.array, axes))
    }
    fn expand(array: &Placed, dims: &Dims) -> Result<Placed, BackendError> {
        array.with(Host::expand(&array.array, dims))
    }
    fn slice(array: &Placed, axis: usize, start: usize, len: usize) -> Result<Placed, BackendError> {
        array.with(Host::slice(&array.array, axis, start, len))
    }
    fn concat(arrays: &[&Placed], axis: usize) -> Result<Placed, BackendError> {
        let joined = Host::concat(&arrays.iter().map(|array| &array.array).collect::<Vec<_>>(), axis);
        arrays[0].with_both(arrays[arrays.len() - 1], joined)
    }
    fn select(array: &Placed, axis: usize, indices: &[usize]) -> Result<Placed, BackendError> {
        array.with(Host::select(&array.array, axis, indices))
    }
    fn sum(array: &Placed, axis: usize) -> Result<Placed, BackendError> {
        array.with(Host::sum(&array.array, axis))
    }
    fn max(array: &Placed, axis: usize) -> Result<Placed, BackendError> {
        array.with(Host::max(&array.array, axis))
    }
    fn matmul(a: &Placed, b: &Placed) -> Result<Placed, BackendError> {
        a.with_both(b, Host::matmul(&a.array, &b.array))
    }
    fn conv2d(images: &Placed, kernels: &Placed, stride: Stride) -> Result<Placed, BackendError> {
        images.with_both(kernels, Host::conv2d(&images.array, &kernels.array, stride))
    }
    fn host_op(op: &Arc<dyn HostOp>, input: &Placed) -> Result<Placed, BackendError> {
        input.with(Host::host_op(op, &input.array))
    }
    fn parameter(array: &Placed) -> Result<Placed, BackendError> {
        array.with(Host::parameter(&array.array))
    }
    fn detach(array: &Placed) -> Result<Placed, BackendError> {
        array.with(Host::detach(&array.array))
    }
    fn is_tracked(array: &Placed) -> bool {
        Host::is_tracked(&array.array)
    }
    fn backward(number: &Placed) -> Result<HostGradients, BackendError> {
        Host::backward(&number.array)
    }
    fn gradient(gradients: &HostGradients, parameter: &Placed) -> Option<Placed> {
        Some(Placed { array: Host::gradient(gradients, &parameter.array)?, place: parameter.place })
    }
}

fn tensor(extents: &[usize], place: Place) -> Tensor<Twofold> {
    Tensor::full(0.5, extents, DType::F64, &place).unwrap()
}

/// Every operation of two tensors or more: the first in one place, the second in the other.
fn results(first: Place, second: Place) -> Vec<Result<Tensor<Twofold>, TensorError>> {
    let (a, b) = (tensor(&[2, 2], first), tensor(&[2, 2], second));
    let (image, kernel) = (tensor(&[1, 1, 3, 3], first), tensor(&[1, 1, 2, 2], second));
    let mut results: Vec<_> = Binary::ALL.into_iter().map(|function| a.binary(function, &b)).collect();
    results.extend([
        a.greater(&b),
        a.matmul(&b),
        a.linear(&b, &tensor(&[2], first)),
        image.conv2d(&kernel, Stride { step: 1, padding: 0 }),
        Tensor::concat(&[&a, &b], 0),
        Tensor::concat(&[&a, &a, &b], 1),
        Tensor::apply::<f64, _>(Atan2::new(&[2]).unwrap(), &[&a, &b]),
    ]);
    results
}

#[test]
fn operands_on_two_devices_are_refused_and_both_are_named() {
    for (first, second) in [(Place::Near, Place::Far), (Place::Far, Place::Near)] {
        let words = alloc::format!(" of a tensor on {first:?} and one on {second:?}: move one of the operands");
        let results = results(first, second);
        assert_eq!(results.len(), 11);
        for (k, result) in results.into_iter().enumerate() {
            let error = result.unwrap_err();
            assert!(matches!(&error, TensorError::Devices { .. }), "number {k}: {error:?}");
            assert!(error.to_string().ends_with(&words), "number {k}: {error}");
        }
    }
    let add = tensor(&[1], Place::Near).add(&tensor(&[1], Place::Far)).unwrap_err().to_string();
    assert_eq!(add, "add of a tensor on Near and one on Far: move one of the operands");
}

#[test]
fn operands_on_one_device_stay_there() {
    for place in [Place::Near, Place::Far] {
        for result in results(place, place) {
            assert_eq!(result.unwrap().device(), place);
        }
    }
    // The way back too.
    let x = tensor(&[2], Place::Far).parameter().unwrap();
    let gradients = x.mul(&x).unwrap().sum_all().unwrap().backward().unwrap();
    assert_eq!(gradients.of(&x).unwrap().device(), Place::Far);
}
