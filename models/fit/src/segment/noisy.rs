//! The reading of pictures that are not clean: with noise, or compressed.

use dvp_core::{ImageView, Real};

use super::robust::RobustSettings;
use super::{PIXEL_NOISE, Segmentation, region, robust, transition};
use crate::tuning::{
    CLEAN_SHARE, COMPRESSED_COLOR, COMPRESSED_STRIP_PX, COMPRESSED_ZONE, HALO_SHARE, LEAST_COMPRESSED_NOISE,
    LINE_NOISES, RIM_BEYOND, RIM_SHARE,
};

/// Settings of [`Segmentation::read_noisy`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct NoisyOptions<T> {
    /// Standard deviation of a channel that is averaged away.
    pub(crate) noise: T,
    /// Whether that noise stands beside edges only, and is to be measured there.
    pub(crate) compressed: bool,
    /// Regions are merged until there are no more than this.
    pub(crate) most_regions: usize,
    /// What a boundary must pay, in units of the usual price.
    pub(crate) boundary: f64,
}

impl<T: Real> Segmentation<T> {
    /// As [`Self::read`], for a picture with noise.
    pub(crate) fn read_noisy(&mut self, image: &ImageView<'_, T>, options: NoisyOptions<T>) -> bool {
        let noise = options.noise.max(T::of(PIXEL_NOISE));
        let settings = if options.compressed {
            RobustSettings {
                halo: T::of(HALO_SHARE),
                strip_width: T::of(COMPRESSED_STRIP_PX),
                zone: T::of(COMPRESSED_ZONE) * noise,
                ..RobustSettings::of(noise)
            }
        } else {
            RobustSettings::of(noise)
        };
        let settings = RobustSettings { boundary: T::of(options.boundary), ..settings };
        robust::read_flat(image, settings, options.most_regions, &mut self.robust, &mut self.map);
        // Clipping at black and white moves means, and the denoised picture with them: soft pixels lie between its colors.
        let Ok(smooth) = ImageView::new(image.size(), &self.robust.smooth) else { return false };
        region::measure(&smooth, &self.map, noise, &mut self.regions, &mut self.region_scratch);
        let tolerance = T::of(LINE_NOISES) * noise + T::of(0.012);
        transition::find(&smooth, &self.map, &self.regions, tolerance, &mut self.soft, &mut self.transitions);
        region::measure(image, &self.map, noise, &mut self.regions, &mut self.region_scratch);
        self.noise = noise;
        self.compressed = options.compressed;
        if options.compressed {
            let beside_edges = self.soft.noise_across(image, &self.regions, &self.transitions);
            self.noise = beside_edges.max(T::of(LEAST_COMPRESSED_NOISE)).min(noise);
            for region in &mut self.regions {
                region.doubt = T::of(COMPRESSED_COLOR);
            }
        }
        self.reading.prepare(&self.regions, &self.transitions)
    }

    /// Whether nearly all soft pixels lie between two regions, or around a corner of one: if they do not, noise or
    /// compression made them.
    pub(crate) fn is_clean(&self) -> bool {
        T::of_usize(self.transitions.len() + self.soft.settled) >= T::of(CLEAN_SHARE) * T::of_usize(self.soft.len())
    }

    /// Whether a filter left rims along edges: to be asked after [`Self::read`].
    pub(crate) fn is_sharpened(&self) -> bool {
        let rim = |transition: &&transition::Transition<T>| {
            let beyond = (T::of(0.5) - transition.weight).abs() - T::of(0.5);
            beyond > T::of(RIM_BEYOND)
        };
        let rims = self.transitions.iter().filter(rim).count();
        T::of_usize(rims) > T::of(RIM_SHARE) * T::of_usize(self.soft.len())
    }

    /// Whether compression was averaged away.
    pub(crate) fn is_compressed(&self) -> bool {
        self.compressed
    }

    /// Number of regions.
    pub(crate) fn region_count(&self) -> usize {
        self.regions.len()
    }

    /// Whether pixels are off by more than rounding.
    pub(crate) fn is_noisy(&self) -> bool {
        self.noise > T::of(PIXEL_NOISE)
    }

    /// Standard deviation of a pixel's channel that no outline explains.
    pub(crate) fn noise(&self) -> T {
        self.noise
    }
}
