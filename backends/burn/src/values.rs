//! Arrays, and how values come in and go out.

use core::fmt;

use burn::backend::flex::FlexTensor;
use burn::backend::ops::FloatTensorOps;
use burn::backend::{
    AutodiffBackend, Backend as _, BackendTensor, Dispatch, DispatchAutodiffContext, DispatchDevice, DispatchTensor,
    DispatchTensorKind, TensorMetadata, try_read_sync,
};
use burn::tensor::{DType as BurnDType, Device, Shape, TensorData};
use dvp_core::dims::Dims;
use dvp_core::real::{DType, Values, ValuesRef};
use dvp_core::tensor::BackendError;

/// An array of burn, of any rank up to [`dvp_core::dims::MAX_RANK`], in f32 or f64. Constants are without autodiff,
/// whatever device they were made on. A single number, of rank 0, has an axis of one in burn: on graphics cards burn
/// takes no tensors of rank 0.
#[derive(Clone)]
pub struct BurnArray {
    tensor: DispatchTensor,
    dims: Dims,
    dtype: DType,
}

impl BurnArray {
    /// Around a tensor of burn.
    ///
    /// # Errors
    /// If the rank is too high, or the number type is neither f32 nor f64.
    pub(crate) fn new(tensor: DispatchTensor) -> Result<Self, BackendError> {
        let dims = Dims::new(tensor.shape().as_slice()).map_err(|error| framework(&error))?;
        let dtype = match tensor.dtype() {
            BurnDType::F32 => DType::F32,
            BurnDType::F64 => DType::F64,
            other => return Err(framework(&format_args!("numbers are {other:?}; cast them to F32 or F64"))),
        };
        let tensor = if Dispatch::is_tracked(&tensor) { tensor } else { without_autodiff(tensor) };
        Ok(Self { tensor, dims, dtype })
    }

    /// The same, of rank 0 if `dims` is.
    pub(crate) fn of_rank(self, dims: &Dims) -> Self {
        if dims.rank() == 0 { Self { dims: Dims::SCALAR, ..self } } else { self }
    }

    /// Burn's tensor; cheap.
    pub(crate) fn tensor(&self) -> DispatchTensor {
        self.tensor.clone()
    }

    /// Burn's tensor, without the tape.
    pub(crate) fn constant(&self) -> DispatchTensor {
        without_autodiff(self.tensor())
    }

    /// The extents.
    pub(crate) fn dims(&self) -> Dims {
        self.dims
    }

    /// The number type.
    pub(crate) fn dtype(&self) -> DType {
        self.dtype
    }

    /// Whether the array is a parameter or was computed from one.
    pub(crate) fn is_tracked(&self) -> bool {
        self.autodiff() != DispatchAutodiffContext::Disabled
    }

    /// How burn keeps the array's tape, if at all.
    pub(crate) fn autodiff(&self) -> DispatchAutodiffContext {
        self.tensor.autodiff
    }

    /// Where the array lives, without autodiff.
    pub(crate) fn device(&self) -> Device {
        Device::new(self.tensor.device().inner())
    }
}

impl fmt::Debug for BurnArray {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (dims, dtype, device) = (self.dims, self.dtype, self.device());
        f.debug_struct("BurnArray")
            .field("dims", &dims)
            .field("dtype", &dtype)
            .field("device", &device)
            .field("tracked", &self.is_tracked())
            .finish()
    }
}

/// The values of a tensor on the host: borrowed from burn's own memory if it lives there in row-major order, copied from
/// the device otherwise.
#[derive(Clone, Debug)]
pub(crate) enum HostValues {
    Own(FlexTensor),
    Copy(TensorData),
}

impl HostValues {
    /// Of a constant tensor.
    pub(crate) fn new(tensor: DispatchTensor) -> Result<Self, BackendError> {
        match tensor.kind {
            DispatchTensorKind::Flex(BackendTensor::Float(tensor)) => Ok(Self::Own(tensor.to_contiguous())),
            _ => Ok(Self::Copy(read(tensor)?)),
        }
    }

    pub(crate) fn borrow(&self, dtype: DType) -> Result<ValuesRef<'_>, BackendError> {
        let found = match self {
            Self::Own(tensor) => tensor.dtype(),
            Self::Copy(data) => data.dtype(),
        };
        let values = match (self, dtype) {
            (Self::Own(tensor), DType::F32) => tensor.as_slice().map(ValuesRef::F32),
            (Self::Own(tensor), DType::F64) => tensor.as_slice().map(ValuesRef::F64),
            (Self::Copy(data), DType::F32) => data.as_slice().ok().map(ValuesRef::F32),
            (Self::Copy(data), DType::F64) => data.as_slice().ok().map(ValuesRef::F64),
        };
        values.ok_or_else(|| framework(&format_args!("values are {found:?}, expected {dtype}")))
    }
}

/// A constant tensor from its values.
pub(crate) fn upload(values: Values, dims: &Dims, device: &DispatchDevice) -> Result<DispatchTensor, BackendError> {
    check_dtype(values.dtype(), device)?;
    let data = match values {
        Values::F32(values) => TensorData::new(values, shape(dims)),
        Values::F64(values) => TensorData::new(values, shape(dims)),
    };
    Ok(Dispatch::float_from_data(data, device))
}

/// The values of a constant tensor.
pub(crate) fn download(tensor: DispatchTensor, dtype: DType) -> Result<Values, BackendError> {
    let data = read(tensor)?;
    match dtype {
        DType::F32 => data.try_into_vec().map(Values::F32),
        DType::F64 => data.try_into_vec().map(Values::F64),
    }
    .map_err(|error| framework(&error))
}

/// Some devices have no f64.
pub(crate) fn check_dtype(dtype: DType, device: &DispatchDevice) -> Result<(), BackendError> {
    if Dispatch::supports_dtype(device, burn_dtype(dtype)) {
        return Ok(());
    }
    Err(framework(&format_args!("{device:?} has no {dtype}; work in f32, or on the CPU (Device::flex())")))
}

pub(crate) fn burn_dtype(dtype: DType) -> BurnDType {
    match dtype {
        DType::F32 => BurnDType::F32,
        DType::F64 => BurnDType::F64,
    }
}

pub(crate) fn shape(dims: &Dims) -> Shape {
    if dims.rank() == 0 { Shape::from([1]) } else { Shape::from(dims.extents().to_vec()) }
}

/// The tensor off the tape and off the autodiff device.
pub(crate) fn without_autodiff(tensor: DispatchTensor) -> DispatchTensor {
    match tensor.autodiff {
        DispatchAutodiffContext::Disabled => tensor,
        DispatchAutodiffContext::Enabled(_) => Dispatch::inner(tensor),
    }
}

/// An error in the framework's words.
pub(crate) fn framework(error: &dyn fmt::Display) -> BackendError {
    BackendError::Framework(error.to_string())
}

fn read(tensor: DispatchTensor) -> Result<TensorData, BackendError> {
    let data = try_read_sync(Dispatch::float_into_data(tensor));
    data.ok_or_else(|| framework(&"values cannot be read from this device without waiting for it"))?
        .map_err(|error| framework(&format_args!("{error:?}")))
}
