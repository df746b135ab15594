//! What a fit takes: settings, the shapes it may use, and why it may refuse.

use alloc::string::String;
use alloc::vec::Vec;

use dvp_core::loss::LossError;
use dvp_core::render::{Compositing, EdgeProfile, RenderError};
use dvp_core::shape::{Efd, ShapeError};
use dvp_core::{ImageView, Real};

use crate::price::Prices;

/// Shapes that objects are known to have.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Bank<T> {
    /// Name and normalized descriptors per prototype.
    pub prototypes: Vec<(String, Efd<T>)>,
}

impl<T> Bank<T> {
    /// A bank of these prototypes: names, and normalized descriptors.
    #[must_use]
    pub fn new(prototypes: Vec<(String, Efd<T>)>) -> Self {
        Self { prototypes }
    }
}

impl<T: Real> Bank<T> {
    /// The bank in another precision, every number rounded to the nearest.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Bank<U> {
        Bank { prototypes: self.prototypes.iter().map(|(name, shape)| (name.clone(), shape.cast())).collect() }
    }
}

/// Settings of [`Fitter`](crate::Fitter): the default, and what is changed of it.
///
/// # Examples
/// ```
/// use dvp_core::render::Compositing;
/// use dvp_fit::FitOptions;
/// let options = FitOptions::<f32>::default().with_max_objects(12).with_compositing(Some(Compositing::Over));
/// assert_eq!(options.max_objects, 12);
/// assert_eq!(options.bank, None);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct FitOptions<T> {
    /// The shapes objects have; none: shapes are unknown and fitted freely.
    pub bank: Option<Bank<T>>,
    /// More objects than this are not reported; those of the largest marginal gain stay.
    pub max_objects: usize,
    /// Most harmonics of a free shape.
    pub max_harmonics: usize,
    /// Most joint Levenberg-Marquardt steps per image; 0 leaves the objects as they were found one by one.
    pub max_steps: usize,
    /// Edge profile of the picture; none: estimated from its soft pixels (the reference renderer's, area coverage, hard pixels,
    /// or blur of any softness).
    pub edge: Option<EdgeProfile<T>>,
    /// How overlapping objects mix; none: as the picture shows.
    pub compositing: Option<Compositing>,
    /// What objects and harmonics must pay; to be left as it is but to see what prices are good for.
    pub prices: Prices,
}

impl<T: Real> Default for FitOptions<T> {
    fn default() -> Self {
        Self {
            bank: None,
            max_objects: 256,
            max_harmonics: 31,
            max_steps: 10,
            edge: None,
            compositing: None,
            prices: Prices::default(),
        }
    }
}

impl<T: Real> FitOptions<T> {
    /// The same with [`Self::bank`].
    #[must_use]
    pub fn with_bank(self, bank: Option<Bank<T>>) -> Self {
        Self { bank, ..self }
    }

    /// The same with [`Self::max_objects`].
    #[must_use]
    pub fn with_max_objects(self, max_objects: usize) -> Self {
        Self { max_objects, ..self }
    }

    /// The same with [`Self::max_harmonics`].
    #[must_use]
    pub fn with_max_harmonics(self, max_harmonics: usize) -> Self {
        Self { max_harmonics, ..self }
    }

    /// The same with [`Self::max_steps`].
    #[must_use]
    pub fn with_max_steps(self, max_steps: usize) -> Self {
        Self { max_steps, ..self }
    }

    /// The same with [`Self::edge`].
    #[must_use]
    pub fn with_edge(self, edge: Option<EdgeProfile<T>>) -> Self {
        Self { edge, ..self }
    }

    /// The same with [`Self::compositing`].
    #[must_use]
    pub fn with_compositing(self, compositing: Option<Compositing>) -> Self {
        Self { compositing, ..self }
    }

    /// The same with [`Self::prices`].
    #[must_use]
    pub fn with_prices(self, prices: Prices) -> Self {
        Self { prices, ..self }
    }

    /// The settings in another precision, every number rounded to the nearest.
    #[must_use]
    pub fn cast<U: Real>(&self) -> FitOptions<U> {
        FitOptions {
            bank: self.bank.as_ref().map(Bank::cast),
            max_objects: self.max_objects,
            max_harmonics: self.max_harmonics,
            max_steps: self.max_steps,
            edge: self.edge.map(|edge| edge.cast()),
            compositing: self.compositing,
            prices: self.prices,
        }
    }
}

/// Why an image was not fitted.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum FitError {
    /// A pixel is NaN or infinite.
    NotFinite {
        /// Index into the planar data.
        index: usize,
    },
    /// A pixel is so far from \[0, 1\] (a million, which half floats do not reach) that sums of squares may be infinite.
    TooLarge {
        /// Index into the planar data.
        index: usize,
    },
    /// A prototype of the bank is no shape.
    Prototype {
        /// Its index.
        index: usize,
        /// What is wrong with it.
        source: ShapeError,
    },
    /// A prototype of the bank encloses no area.
    FlatPrototype {
        /// Its index.
        index: usize,
    },
    /// An object of the start encloses no area.
    FlatObject {
        /// Its index.
        index: usize,
    },
    /// The scale of an object of the start is not above 0.
    Scale {
        /// Its index.
        index: usize,
    },
    /// A setting is out of range.
    Setting {
        /// Its name.
        what: &'static str,
        /// What it must be.
        must: &'static str,
    },
    /// A scene on the way could not be drawn.
    Shape(ShapeError),
    /// A scene on the way could not be rendered.
    Render(RenderError),
    /// The image of a scene on the way could not be compared with the picture.
    Compare(LossError),
}

/// Largest value of a channel, either side of 0: what half floats hold, and more.
const MOST_VALUE: f64 = 1e6;

/// Refuses an image with NaN or infinity, since a view may be made of an image that was written to after it was checked, or with values whose squares
/// have no sum.
pub(crate) fn check_values<T: Real>(image: &ImageView<'_, T>) -> Result<(), FitError> {
    let is_small = |value: &T| value.abs() <= T::of(MOST_VALUE);
    // All of them first, without a way out between: that is done many at a time.
    if image.data().iter().fold(true, |all, value| all & is_small(value)) {
        return Ok(());
    }
    match image.data().iter().position(|value| !is_small(value)) {
        Some(index) if image.data()[index].is_finite() => Err(FitError::TooLarge { index }),
        Some(index) => Err(FitError::NotFinite { index }),
        None => Ok(()),
    }
}

impl core::fmt::Display for FitError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::NotFinite { index } => write!(f, "image value {index} is NaN or infinite; replace it before the fit"),
            Self::TooLarge { index } => write!(
                f,
                "image value {index} is beyond a million; images are in [0, 1] by convention, scale this one before the fit"
            ),
            Self::Prototype { index, source } => write!(f, "prototype {index} of the bank: {source}"),
            Self::FlatPrototype { index } => write!(f, "prototype {index} of the bank encloses no area; remove it"),
            Self::FlatObject { index } => write!(f, "object {index} of the start encloses no area; remove it"),
            Self::Scale { index } => write!(f, "the scale of object {index} of the start must be above 0"),
            Self::Setting { what, must } => write!(f, "{what} must be {must}"),
            Self::Shape(error) => write!(f, "{error}"),
            Self::Render(error) => write!(f, "{error}"),
            Self::Compare(error) => write!(f, "{error}"),
        }
    }
}

impl core::error::Error for FitError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Prototype { source, .. } | Self::Shape(source) => Some(source),
            Self::Render(source) => Some(source),
            Self::Compare(source) => Some(source),
            _ => None,
        }
    }
}

impl From<ShapeError> for FitError {
    fn from(error: ShapeError) -> Self {
        Self::Shape(error)
    }
}

impl From<RenderError> for FitError {
    fn from(error: RenderError) -> Self {
        Self::Render(error)
    }
}

impl From<LossError> for FitError {
    fn from(error: LossError) -> Self {
        Self::Compare(error)
    }
}
