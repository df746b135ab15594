//! Numbers whose type is chosen at run time.

use alloc::vec::Vec;
use core::fmt;

/// The type of a number, where it is chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum DType {
    /// 4 bytes, to work with.
    #[default]
    F32,
    /// 8 bytes, to check with.
    F64,
}

impl fmt::Display for DType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        })
    }
}

/// Numbers of either type.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Of type f32.
    F32(Vec<f32>),
    /// Of type f64.
    F64(Vec<f64>),
}

/// Borrowed numbers of either type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ValuesRef<'a> {
    /// Of type f32.
    F32(&'a [f32]),
    /// Of type f64.
    F64(&'a [f64]),
}

impl Values {
    /// Zeros.
    #[must_use]
    pub fn zeros(dtype: DType, len: usize) -> Self {
        match dtype {
            DType::F32 => Self::F32(alloc::vec![0.0; len]),
            DType::F64 => Self::F64(alloc::vec![0.0; len]),
        }
    }

    /// The values, borrowed.
    #[must_use]
    pub fn as_ref(&self) -> ValuesRef<'_> {
        match self {
            Self::F32(values) => ValuesRef::F32(values),
            Self::F64(values) => ValuesRef::F64(values),
        }
    }

    /// The type of the numbers.
    #[must_use]
    pub fn dtype(&self) -> DType {
        self.as_ref().dtype()
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.as_ref().len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The same numbers as f64; exact.
    #[must_use]
    pub fn to_f64(&self) -> Vec<f64> {
        match self {
            Self::F32(values) => values.iter().map(|&v| f64::from(v)).collect(),
            Self::F64(values) => values.clone(),
        }
    }

    /// The same numbers in another type, rounded to the nearest if that is f32.
    #[must_use]
    pub fn cast(self, dtype: DType) -> Self {
        match (self, dtype) {
            (Self::F64(values), DType::F32) =>
            {
                #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked for")]
                Self::F32(values.into_iter().map(|v| v as f32).collect())
            }
            (Self::F32(values), DType::F64) => Self::F64(values.into_iter().map(f64::from).collect()),
            (same, _) => same,
        }
    }
}

impl ValuesRef<'_> {
    /// The type of the numbers.
    #[must_use]
    pub fn dtype(self) -> DType {
        match self {
            Self::F32(_) => DType::F32,
            Self::F64(_) => DType::F64,
        }
    }

    /// How many there are.
    #[must_use]
    pub fn len(self) -> usize {
        match self {
            Self::F32(values) => values.len(),
            Self::F64(values) => values.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.len() == 0
    }
}
