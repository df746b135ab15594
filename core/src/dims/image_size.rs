//! Width and height of an image.

use core::fmt;

/// Most pixels an image may have: 2^28, a square of 16384. Above it a header is more likely wrong than large.
pub const MAX_PIXELS: usize = 1 << 28;

/// Width and height in pixels, both at least 1 and their product at most [`MAX_PIXELS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ImageSize {
    width: usize,
    height: usize,
}

impl ImageSize {
    /// A size of `width` columns and `height` rows.
    ///
    /// # Errors
    /// [`SizeError`] if a side is 0 or the product is above [`MAX_PIXELS`].
    pub const fn new(width: usize, height: usize) -> Result<Self, SizeError> {
        if width == 0 || height == 0 {
            return Err(SizeError::Empty { width, height });
        }
        match width.checked_mul(height) {
            Some(pixels) if pixels <= MAX_PIXELS => Ok(Self { width, height }),
            _ => Err(SizeError::TooLarge { width, height }),
        }
    }

    /// Number of columns.
    #[must_use]
    pub const fn width(self) -> usize {
        self.width
    }

    /// Number of rows.
    #[must_use]
    pub const fn height(self) -> usize {
        self.height
    }

    /// Number of pixels, rows x columns.
    #[must_use]
    pub const fn pixels(self) -> usize {
        self.width * self.height
    }

    /// Pixels per scene unit: the shorter side.
    #[must_use]
    pub const fn unit_px(self) -> usize {
        if self.width < self.height { self.width } else { self.height }
    }
}

/// Why a pair of numbers is no image size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SizeError {
    /// A side is zero.
    Empty {
        /// Columns asked for.
        width: usize,
        /// Rows asked for.
        height: usize,
    },
    /// More than [`MAX_PIXELS`] pixels.
    TooLarge {
        /// Columns asked for.
        width: usize,
        /// Rows asked for.
        height: usize,
    },
}

impl fmt::Display for SizeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty { width, height } => {
                write!(f, "an image of {width} x {height} pixels is empty; both sides must be at least 1")
            }
            Self::TooLarge { width, height } => {
                write!(f, "an image of {width} x {height} pixels is above the limit of {MAX_PIXELS}; scale it down")
            }
        }
    }
}

impl core::error::Error for SizeError {}
