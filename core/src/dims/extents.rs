//! The extents of an array.

use core::fmt;

/// Most axes an array may have.
pub const MAX_RANK: usize = 6;

/// The extents of an array in row-major order: the last axis is contiguous. Rank 0 is a single number.
///
/// # Examples
/// ```
/// use dvp_core::dims::Dims;
/// let images = Dims::new(&[8, 3, 128, 128])?;
/// assert_eq!((images.rank(), images.len()), (4, 8 * 3 * 128 * 128));
/// assert_eq!(images.to_string(), "[8, 3, 128, 128]");
/// # Ok::<(), dvp_core::dims::DimsError>(())
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Dims {
    rank: usize,
    /// Zero beyond the rank, so that equality is that of the extents.
    extents: [usize; MAX_RANK],
}

impl Dims {
    /// The dims of a single number.
    pub const SCALAR: Self = Self { rank: 0, extents: [0; MAX_RANK] };

    /// Dims with these extents.
    ///
    /// # Errors
    /// [`DimsError`] if there are more than [`MAX_RANK`] axes or the product overflows.
    pub fn new(extents: &[usize]) -> Result<Self, DimsError> {
        let rank = extents.len();
        if rank > MAX_RANK {
            return Err(DimsError::TooManyAxes { rank });
        }
        let mut dims = Self { rank, extents: [0; MAX_RANK] };
        dims.extents[..rank].copy_from_slice(extents);
        match extents.iter().try_fold(1_usize, |len, &extent| len.checked_mul(extent)) {
            Some(_) => Ok(dims),
            None => Err(DimsError::TooLarge { dims }),
        }
    }

    /// The extents, first axis first.
    #[must_use]
    pub fn extents(&self) -> &[usize] {
        &self.extents[..self.rank]
    }

    /// Number of axes.
    #[must_use]
    pub const fn rank(&self) -> usize {
        self.rank
    }

    /// Number of values: the product of the extents, 1 for rank 0.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a count of values, not a container")]
    pub fn len(&self) -> usize {
        self.extents().iter().product()
    }

    /// The extent of one axis; none beyond the rank.
    #[must_use]
    pub fn get(&self, axis: usize) -> Option<usize> {
        self.extents().get(axis).copied()
    }

    /// The same dims but for the extent of one axis; unchanged if there is no such axis.
    #[must_use]
    pub fn with(mut self, axis: usize, extent: usize) -> Self {
        if axis < self.rank {
            self.extents[axis] = extent;
        }
        self
    }

    /// Distance in values between neighbors along each axis; 0 beyond the rank.
    #[must_use]
    pub fn strides(&self) -> [usize; MAX_RANK] {
        let mut strides = [0; MAX_RANK];
        let mut step = 1;
        for axis in (0..self.rank).rev() {
            strides[axis] = step;
            step *= self.extents[axis];
        }
        strides
    }

    /// The dims that both broadcast to: axes are aligned at the end, and an extent of 1 or a missing axis stretches to
    /// the other's. None if two extents differ and neither is 1.
    #[must_use]
    pub fn broadcast(&self, other: &Self) -> Option<Self> {
        let rank = self.rank.max(other.rank);
        let mut result = Self { rank, extents: [0; MAX_RANK] };
        for axis in 0..rank {
            let extent = |dims: &Self| (axis + dims.rank).checked_sub(rank).map_or(1, |own| dims.extents[own]);
            result.extents[axis] = match (extent(self), extent(other)) {
                (a, b) if a == b => a,
                (1, b) => b,
                (a, 1) => a,
                _ => return None,
            };
        }
        Some(result)
    }
}

impl fmt::Display for Dims {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.extents())
    }
}

impl fmt::Debug for Dims {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Dims{:?}", self.extents())
    }
}

/// Why extents are no dims.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DimsError {
    /// More than [`MAX_RANK`] axes.
    TooManyAxes {
        /// Axes asked for.
        rank: usize,
    },
    /// The product of the extents is no `usize`.
    TooLarge {
        /// Extents asked for.
        dims: Dims,
    },
}

impl fmt::Display for DimsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooManyAxes { rank } => write!(f, "an array of {rank} axes; at most {MAX_RANK} are supported"),
            Self::TooLarge { dims } => write!(f, "an array of {dims} has more values than can be addressed"),
        }
    }
}

impl core::error::Error for DimsError {}
