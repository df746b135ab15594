//! Two images of one size.

use super::LossError;
use crate::dims::ImageSize;
use crate::image::ImageView;
use crate::real::Real;

/// An image and its target, of the same size.
#[derive(Clone, Copy, Debug)]
pub struct ImagePair<'a, T> {
    image: ImageView<'a, T>,
    target: ImageView<'a, T>,
}

impl<'a, T: Real> ImagePair<'a, T> {
    /// Pairs two images.
    ///
    /// # Errors
    /// [`LossError::Sizes`] if the sizes differ.
    pub fn new(image: ImageView<'a, T>, target: ImageView<'a, T>) -> Result<Self, LossError> {
        if image.size() != target.size() {
            return Err(LossError::Sizes { image: image.size(), target: target.size() });
        }
        Ok(Self { image, target })
    }

    /// Width and height of both.
    #[must_use]
    pub fn size(&self) -> ImageSize {
        self.image.size()
    }

    /// The judged image, the one that gradients are for.
    #[must_use]
    pub fn image(&self) -> ImageView<'a, T> {
        self.image
    }

    /// What it is judged by.
    #[must_use]
    pub fn target(&self) -> ImageView<'a, T> {
        self.target
    }
}
