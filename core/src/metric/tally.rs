//! All metrics of a data set, image by image.

use super::{MaskOverlap, MetricError, Ownership, RandIndexScratch, adjusted_rand_index};
use crate::loss::{ImagePair, Loss, Ssim, SsimScratch};
use crate::real::Real;
use crate::render::PixelLoss;

/// The columns of the paper's table, for one image or as means over images.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Scores {
    /// Mean of the absolute differences, RGB in \[0, 1\].
    pub mae: f64,
    /// Mean of the squared differences.
    pub mse: f64,
    /// Structural similarity.
    pub ssim: f64,
    /// Intersection over union of the union masks; over several images of their pooled pixels.
    pub iou: f64,
    /// Adjusted Rand index, mean over images.
    pub ari: f64,
}

/// Sums up the scores of images; with memory that is kept between images.
#[derive(Clone, Debug)]
pub struct Tally<T> {
    images: usize,
    /// Sums over images; `iou` is not used.
    sums: Scores,
    overlap: MaskOverlap,
    ssim: Ssim<T>,
    ssim_scratch: SsimScratch<T>,
    rand_scratch: RandIndexScratch,
}

impl<T: Real> Default for Tally<T> {
    fn default() -> Self {
        Self {
            images: 0,
            sums: Scores::default(),
            overlap: MaskOverlap::default(),
            ssim: Ssim::default(),
            ssim_scratch: SsimScratch::default(),
            rand_scratch: RandIndexScratch::default(),
        }
    }
}

impl<T: Real> Tally<T> {
    /// Adds an image with the pixels that the objects of its scene and of the true scene own; returns its own scores.
    ///
    /// # Errors
    /// [`MetricError`] if sizes differ or a side is below the window of SSIM; then nothing was added.
    #[inline(never)]
    pub fn add(
        &mut self,
        pair: ImagePair<'_, T>,
        owned: &Ownership,
        truly_owned: &Ownership,
    ) -> Result<Scores, MetricError> {
        for (what, owned) in [("ownership of the image", owned), ("ownership of the target", truly_owned)] {
            let (expected, len) = (pair.size().pixels(), owned.pixels());
            if expected != len {
                return Err(MetricError::Length { what, expected, len });
            }
        }
        let mut overlap = MaskOverlap::default();
        overlap.add(owned.union(), truly_owned.union());
        let scores = Scores {
            mae: PixelLoss::Mae.value(pair, &mut ())?.as_f64(),
            mse: PixelLoss::Mse.value(pair, &mut ())?.as_f64(),
            ssim: self.ssim.similarity(pair, &mut self.ssim_scratch)?.as_f64(),
            iou: overlap.iou(),
            ari: adjusted_rand_index(owned.index(), truly_owned.index(), &mut self.rand_scratch)?,
        };
        self.images += 1;
        self.overlap.merge(&overlap);
        self.sums.mae += scores.mae;
        self.sums.mse += scores.mse;
        self.sums.ssim += scores.ssim;
        self.sums.ari += scores.ari;
        Ok(scores)
    }

    /// Adds what another tally has seen.
    pub fn merge(&mut self, other: &Self) {
        self.images += other.images;
        self.overlap.merge(&other.overlap);
        self.sums.mae += other.sums.mae;
        self.sums.mse += other.sums.mse;
        self.sums.ssim += other.sums.ssim;
        self.sums.ari += other.sums.ari;
    }

    /// Number of images added.
    #[must_use]
    pub fn images(&self) -> usize {
        self.images
    }

    /// The scores of all images so far; none without an image.
    #[must_use]
    pub fn scores(&self) -> Option<Scores> {
        if self.images == 0 {
            return None;
        }
        let count = f64::of_usize(self.images);
        Some(Scores {
            mae: self.sums.mae / count,
            mse: self.sums.mse / count,
            ssim: self.sums.ssim / count,
            iou: self.overlap.iou(),
            ari: self.sums.ari / count,
        })
    }
}
