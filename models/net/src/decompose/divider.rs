//! A trained decomposer as something to look with, on the host.

use dvp_core::tensor::{Host, HostDevice};
use dvp_core::{Image, ImageView};

use super::{Decomposer, DecomposerConfig, PartsOf};
use crate::error::NetError;
use crate::scene_steps::image_tensor;
use crate::square::Square;
use crate::train::DecomposerFile;

/// A decomposer that divides pictures of any size.
///
/// Decomposers take squares of one side. A picture of another size is put on a square as large as its longer side, in the
/// middle, on the median color of its border, and resampled (bicubic, averaged where it shrinks); masks and colors are
/// resampled back.
#[derive(Clone, Debug)]
pub struct Divider {
    config: DecomposerConfig,
    decomposer: Decomposer<Host>,
}

impl Divider {
    /// The decomposer of a file of weights, given by its bytes.
    ///
    /// # Errors
    /// As [`DecomposerFile::from_bytes`] and [`DecomposerFile::decomposer`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, NetError> {
        let file = DecomposerFile::from_bytes(bytes)?;
        Ok(Self { config: file.config().clone(), decomposer: file.decomposer(&HostDevice)? })
    }

    /// The sizes of the decomposer.
    #[must_use]
    pub fn config(&self) -> &DecomposerConfig {
        &self.config
    }

    /// The parts of a picture, in its size.
    ///
    /// # Errors
    /// [`NetError::Image`] for a picture with NaN or infinity.
    pub fn divide(&self, image: ImageView<'_, f32>) -> Result<PartsOf, NetError> {
        let side = self.config.side();
        let (square, target) = Square::of(image, side)?;
        let images = image_tensor(core::slice::from_ref(&target), &HostDevice)?;
        let mut parts = self.decomposer.parts(&images)?.of_images()?;
        let parts = parts.pop().ok_or_else(|| NetError::Batch { must: "must hold at least one image".into() })?;
        if (image.size().width(), image.size().height()) == (side, side) {
            return Ok(parts);
        }
        let back = |planes: &[f32]| -> Vec<f32> {
            planes.chunks_exact(side * side).flat_map(|plane| square.plane_to_picture(plane, side)).collect()
        };
        let mut masks: Vec<f32> = parts.masks().flat_map(back).collect();
        let colors = parts.colors().flat_map(back).collect();
        share(&mut masks, image.size().pixels());
        Ok(PartsOf::new(image.size(), masks, colors))
    }
}

/// Masks, by planes of `pixels`, so that they sum to 1 again.
fn share(masks: &mut [f32], pixels: usize) {
    let mut sums = vec![0.0_f32; pixels];
    masks.chunks_exact(pixels).for_each(|mask| sums.iter_mut().zip(mask).for_each(|(sum, share)| *sum += share));
    for mask in masks.chunks_exact_mut(pixels) {
        mask.iter_mut().zip(&sums).filter(|(_, sum)| **sum > 0.0).for_each(|(share, sum)| *share /= sum);
    }
}

/// A picture as a decomposer for squares of `side` pixels sees it; see [`Divider`].
///
/// # Errors
/// [`NetError::Image`] for a picture with NaN or infinity.
pub fn on_square(image: ImageView<'_, f32>, side: usize) -> Result<Image<f32>, NetError> {
    Ok(Square::of(image, side)?.1)
}
