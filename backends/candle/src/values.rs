//! Values in and out, extents, number types, devices.

use candle_core::backend::BackendStorage;
use candle_core::{CpuStorage, Error, Layout, Tensor};
use dvp_core::dims::Dims;
use dvp_core::real::{DType, Real, Values, ValuesRef};
use dvp_core::tensor::BackendError;

/// Where candle keeps an array. Equal if the location is: two handles of one GPU go together.
#[derive(Clone, Debug)]
pub struct CandleDevice(pub candle_core::Device);

impl CandleDevice {
    /// The processor's own memory.
    pub const CPU: Self = Self(candle_core::Device::Cpu);
}

impl PartialEq for CandleDevice {
    fn eq(&self, other: &Self) -> bool {
        self.0.location() == other.0.location()
    }
}

impl Default for CandleDevice {
    fn default() -> Self {
        Self::CPU
    }
}

/// What candle refused, in its own words; without the backtrace that it may carry.
pub(crate) fn refused(error: Error) -> BackendError {
    match error {
        Error::WithBacktrace { inner, .. } => refused(*inner),
        error => BackendError::Framework(error.to_string()),
    }
}

pub(crate) fn upload(values: Values, extents: &[usize], device: &candle_core::Device) -> candle_core::Result<Tensor> {
    match values {
        Values::F32(values) => Tensor::from_vec(values, extents, device),
        Values::F64(values) => Tensor::from_vec(values, extents, device),
    }
}

/// The values in row-major order.
pub(crate) fn download(array: &Tensor) -> candle_core::Result<Values> {
    let flat = array.detach().flatten_all()?;
    Ok(match dtype(array) {
        DType::F32 => Values::F32(flat.to_vec1()?),
        DType::F64 => Values::F64(flat.to_vec1()?),
    })
}

pub(crate) fn dims(array: &Tensor) -> Dims {
    // No operation makes more axes than its operands have; arrays of others are checked where they come in.
    Dims::new(array.dims()).unwrap_or(Dims::SCALAR)
}

pub(crate) fn dtype(array: &Tensor) -> DType {
    if array.dtype() == candle_core::DType::F64 { DType::F64 } else { DType::F32 }
}

pub(crate) fn candle_dtype(dtype: DType) -> candle_core::DType {
    match dtype {
        DType::F32 => candle_core::DType::F32,
        DType::F64 => candle_core::DType::F64,
    }
}

/// The values of a contiguous array, where they are; none if it is not contiguous or holds other types.
pub(crate) fn borrow<'a>(storage: &'a CpuStorage, layout: &Layout) -> Option<ValuesRef<'a>> {
    let (start, end) = layout.contiguous_offsets()?;
    match storage {
        CpuStorage::F32(values) => values.get(start..end).map(ValuesRef::F32),
        CpuStorage::F64(values) => values.get(start..end).map(ValuesRef::F64),
        _ => None,
    }
}

pub(crate) fn storage(values: Values) -> CpuStorage {
    match values {
        Values::F32(values) => CpuStorage::F32(values),
        Values::F64(values) => CpuStorage::F64(values),
    }
}

/// All numbers of one type.
pub(crate) fn slice<T: Real>(storage: &CpuStorage) -> candle_core::Result<&[T]> {
    let values = match storage {
        CpuStorage::F32(values) => T::borrow_values(ValuesRef::F32(values)),
        CpuStorage::F64(values) => T::borrow_values(ValuesRef::F64(values)),
        _ => None,
    };
    values.ok_or_else(|| Error::UnsupportedDTypeForOp(storage.dtype(), "a step of the core"))
}

/// As [`slice`], with what holds them.
pub(crate) fn typed<T: Real>(storage: CpuStorage) -> candle_core::Result<Vec<T>> {
    let dtype = storage.dtype();
    let values = match storage {
        CpuStorage::F32(values) => T::from_values(Values::F32(values)),
        CpuStorage::F64(values) => T::from_values(Values::F64(values)),
        _ => None,
    };
    values.ok_or(Error::UnsupportedDTypeForOp(dtype, "a step of the core"))
}
