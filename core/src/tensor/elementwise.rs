//! Operations number by number, and pair by pair with broadcasting.

use super::backend::{Backend, BackendError, Binary, Unary};
use super::error::TensorError;
use super::handle::Tensor;
use crate::dims::Dims;

impl Binary {
    /// The name in errors.
    const fn name(self) -> &'static str {
        match self {
            Self::Add => "add",
            Self::Div => "div",
            Self::Mul => "mul",
            Self::Sub => "sub",
        }
    }
}

impl Unary {
    /// The name in errors.
    const fn name(self) -> &'static str {
        match self {
            Self::Abs => "abs",
            Self::Cos => "cos",
            Self::Erf => "erf",
            Self::Exp => "exp",
            Self::Log => "log",
            Self::Relu => "relu",
            Self::Sin => "sin",
            Self::Sqrt => "sqrt",
            Self::Tanh => "tanh",
        }
    }
}

impl<B: Backend> Tensor<B> {
    /// The function of every number.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn unary(&self, function: Unary) -> Result<Self, TensorError> {
        Self::wrap(function.name(), B::unary(function, self.array()))
    }

    /// The function of pairs of numbers; axes are aligned at the end, and an extent of 1 or a missing axis stretches.
    ///
    /// # Errors
    /// [`TensorError::Dims`] if the extents do not broadcast; [`TensorError::DTypes`], [`TensorError::Devices`].
    pub fn binary(&self, function: Binary, other: &Self) -> Result<Self, TensorError> {
        self.pairwise(function.name(), other, |a, b| B::binary(function, a, b))
    }

    /// a + b, with broadcasting.
    ///
    /// # Errors
    /// As [`Self::binary`].
    pub fn add(&self, other: &Self) -> Result<Self, TensorError> {
        self.binary(Binary::Add, other)
    }

    /// a - b, with broadcasting.
    ///
    /// # Errors
    /// As [`Self::binary`].
    pub fn sub(&self, other: &Self) -> Result<Self, TensorError> {
        self.binary(Binary::Sub, other)
    }

    /// a b, with broadcasting.
    ///
    /// # Errors
    /// As [`Self::binary`].
    pub fn mul(&self, other: &Self) -> Result<Self, TensorError> {
        self.binary(Binary::Mul, other)
    }

    /// a / b, with broadcasting.
    ///
    /// # Errors
    /// As [`Self::binary`].
    pub fn div(&self, other: &Self) -> Result<Self, TensorError> {
        self.binary(Binary::Div, other)
    }

    /// 1 where a > b, 0 elsewhere, with broadcasting; a constant.
    ///
    /// # Errors
    /// As [`Self::binary`].
    pub fn greater(&self, other: &Self) -> Result<Self, TensorError> {
        self.pairwise("greater", other, B::greater)
    }

    /// scale x + offset.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn affine(&self, scale: f64, offset: f64) -> Result<Self, TensorError> {
        Self::wrap("affine", B::affine(self.array(), scale, offset))
    }

    /// |x|; derivative 0 at 0.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn abs(&self) -> Result<Self, TensorError> {
        self.unary(Unary::Abs)
    }

    /// e^x.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn exp(&self) -> Result<Self, TensorError> {
        self.unary(Unary::Exp)
    }

    /// Natural logarithm.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn log(&self) -> Result<Self, TensorError> {
        self.unary(Unary::Log)
    }

    /// max(x, 0); derivative 0 at 0.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn relu(&self) -> Result<Self, TensorError> {
        self.unary(Unary::Relu)
    }

    /// Square root; its derivative at 0 is infinite.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn sqrt(&self) -> Result<Self, TensorError> {
        self.unary(Unary::Sqrt)
    }

    /// Hyperbolic tangent.
    ///
    /// # Errors
    /// If the framework refuses.
    pub fn tanh(&self) -> Result<Self, TensorError> {
        self.unary(Unary::Tanh)
    }

    fn pairwise(
        &self,
        op: &'static str,
        other: &Self,
        run: impl Fn(&B::Array, &B::Array) -> Result<B::Array, BackendError>,
    ) -> Result<Self, TensorError> {
        self.check_pair(op, other)?;
        if self.dims().broadcast(other.dims()).is_none() {
            let must = "each extent must equal the other's or be 1";
            return Err(TensorError::dims(op, self.dims(), other.dims(), must));
        }
        let rank = self.dims().rank().max(other.dims().rank());
        Self::wrap(op, run(self.with_rank(rank)?.array(), other.with_rank(rank)?.array()))
    }

    /// The same tensor with axes of extent 1 in front, up to `rank`.
    pub(super) fn with_rank(&self, rank: usize) -> Result<Self, TensorError> {
        let missing = rank.saturating_sub(self.dims().rank());
        if missing == 0 {
            return Ok(self.clone());
        }
        let mut extents = alloc::vec![1; missing];
        extents.extend_from_slice(self.dims().extents());
        self.reshape(Dims::new(&extents)?.extents())
    }
}
