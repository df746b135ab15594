//! What a decomposer makes of images.

use dvp_core::tensor::{Backend, Tensor};
use dvp_core::{Image, ImageSize};

use crate::error::NetError;

/// Share of the pixels that the smallest object holds: parts that hold less belong to the background.
const SMALLEST: f64 = 0.002;

/// The parts of a batch of images, as tensors.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Parts<B: Backend> {
    /// Logarithms of the masks, which sum to 1 over the slots: batch x slots x height x width.
    pub log_masks: Tensor<B>,
    /// What the parts show, in \[0, 1\]: batch x slots x 3 x height x width.
    pub colors: Tensor<B>,
}

/// The parts of one image.
#[derive(Clone, Debug, PartialEq)]
pub struct PartsOf {
    size: ImageSize,
    /// slots x pixels.
    masks: Vec<f32>,
    /// slots x 3 x pixels.
    colors: Vec<f32>,
}

impl<B: Backend> Parts<B> {
    /// Those of each image.
    ///
    /// # Errors
    /// If the framework refuses to hand out its values.
    pub fn of_images(&self) -> Result<Vec<PartsOf>, NetError> {
        let &[batch, _, h, w] = self.log_masks.dims().extents() else {
            let must = "must be batch x slots x height x width";
            return Err(NetError::Input { input: "masks", dims: *self.log_masks.dims(), must });
        };
        let Ok(size) = ImageSize::new(w, h) else { return Ok(Vec::new()) };
        let [masks, colors] = [self.log_masks.to_f64()?, self.colors.to_f64()?];
        let each = |values: &[f64], k: usize, of: &dyn Fn(f64) -> f64| -> Vec<f32> {
            let len = values.len() / batch.max(1);
            #[expect(clippy::cast_possible_truncation, reason = "shares and colors")]
            values[k * len..(k + 1) * len].iter().map(|&value| of(value) as f32).collect()
        };
        let image = |k| PartsOf {
            size,
            masks: each(&masks, k, &f64::exp),
            colors: each(&colors, k, &|color| color.clamp(0.0, 1.0)),
        };
        Ok((0..batch).map(image).collect())
    }
}

impl PartsOf {
    /// Parts from masks, slots x pixels, and colors, slots x 3 x pixels, by planes.
    pub(super) fn new(size: ImageSize, masks: Vec<f32>, colors: Vec<f32>) -> Self {
        Self { size, masks, colors }
    }

    /// The size of the image.
    #[must_use]
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// How many there are, empty ones counted.
    #[must_use]
    pub fn slots(&self) -> usize {
        self.masks.len() / self.size.pixels()
    }

    /// The mask of each, a share per pixel.
    pub fn masks(&self) -> impl ExactSizeIterator<Item = &[f32]> {
        self.masks.chunks_exact(self.size.pixels())
    }

    /// What each shows, 3 x pixels, under its mask or not.
    pub fn colors(&self) -> impl ExactSizeIterator<Item = &[f32]> {
        self.colors.chunks_exact(3 * self.size.pixels())
    }

    /// All parts together: the mean of their colors, weighted by their masks.
    #[must_use]
    pub fn reconstruction(&self) -> Image<f32> {
        let mut image = Image::zeros(self.size);
        for (mask, colors) in self.masks().zip(self.colors()) {
            for (sums, colors) in image.data_mut().chunks_exact_mut(mask.len()).zip(colors.chunks_exact(mask.len())) {
                sums.iter_mut().zip(mask).zip(colors).for_each(|((sum, share), color)| *sum += share * color);
            }
        }
        image
    }

    /// Which object each pixel shows: 0 for the background, else k for the k-th object.
    ///
    /// A pixel is of the part with the largest share of it. The part with the most pixels is the background; parts with fewer
    /// than two pixels of a thousand belong to it.
    #[must_use]
    pub fn labels(&self) -> Vec<u32> {
        let largest = |pixel: usize| {
            let share = |slot: usize| self.masks[slot * self.size.pixels() + pixel];
            (1..self.slots()).fold(0, |best, slot| if share(slot) > share(best) { slot } else { best })
        };
        let owners: Vec<usize> = (0..self.size.pixels()).map(largest).collect();
        let mut counts = vec![0_usize; self.slots()];
        owners.iter().for_each(|&owner| counts[owner] += 1);
        let background = (0..self.slots()).max_by_key(|&slot| (counts[slot], core::cmp::Reverse(slot)));
        let least = SMALLEST * self.size.pixels() as f64;
        let mut names = vec![0_u32; self.slots()];
        let objects = (0..self.slots()).filter(|&slot| Some(slot) != background && counts[slot] as f64 >= least);
        objects.zip(1..).for_each(|(slot, name)| names[slot] = name);
        owners.into_iter().map(|owner| names[owner]).collect()
    }
}
