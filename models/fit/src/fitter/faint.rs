//! Pictures whose objects are so faint that they passed for flat: stretched to full contrast, in which rounding to 8 bits
//! is as coarse as it is, and fitted again.

use alloc::vec::Vec;

use dvp_core::{ImageView, Real, Scene};

use super::{FitScratch, Fitter};
use crate::colors::is_rounded;
use crate::segment::{PIXEL_NOISE, SegmentOptions};
use crate::stretched::Stretched;
use crate::tuning::FAINT_CONTRAST;
use crate::{Fit, FitError};

/// Half a step of 8 bits. Pictures of less contrast are one color, whatever their numbers.
const HALF_STEP: f64 = 0.5 / 255.0;
/// Of a step, the standard deviation of rounding.
const ROUNDING: f64 = 0.2887;

/// A picture at full contrast.
struct Faint<T> {
    stretched: Stretched<T>,
    /// Most that rounding moves a value.
    rounding: T,
}

impl<T: Real> Faint<T> {
    /// None of a picture of one color, or of one that is not faint.
    fn of(image: &ImageView<'_, T>) -> Option<Self> {
        let ends = |channel: &[T]| {
            channel.iter().fold((T::infinity(), T::neg_infinity()), |(low, high), &v| (low.min(v), high.max(v)))
        };
        let ends = [0, 1, 2].map(|c| ends(image.channel(c)));
        let range = ends.iter().map(|(low, high)| *high - *low).fold(T::zero(), T::max);
        if range <= T::of(HALF_STEP) || range > T::of(FAINT_CONTRAST) {
            return None;
        }
        let gain = T::one() / range;
        let rounding = if is_rounded(image.data().iter().copied()) { T::of(HALF_STEP) * gain } else { T::zero() };
        Some(Self { stretched: Stretched::new(image, ends.map(|(low, _)| low), T::zero(), gain), rounding })
    }

    fn options(&self) -> SegmentOptions<T> {
        let default = SegmentOptions::<T>::default();
        SegmentOptions {
            line_tolerance: default.line_tolerance.max(self.rounding),
            noise: T::of(PIXEL_NOISE).max(T::of(2.0 * ROUNDING) * self.rounding),
            ..default
        }
    }
}

impl<T: Real> Fitter<T> {
    /// `empty`, the fit of a picture without objects, or one of faint objects if that is the shorter description; none if
    /// the picture is not faint.
    pub(super) fn or_faint(
        &self,
        image: ImageView<'_, T>,
        empty: &Fit<T>,
        scratch: &mut FitScratch<T>,
    ) -> Result<Option<Fit<T>>, FitError> {
        let Some(whole) = Faint::of(&image) else { return Ok(None) };
        let view = whole.stretched.image.view();
        scratch.shown.forget();
        scratch.code = None;
        if !scratch.segmentation.read(&view, &whole.options()) {
            return Ok(Some(empty.clone()));
        }
        let faint = self.fit_reading(view, true, scratch)?;
        let scene = Scene { objects: Vec::new(), ..faint.scene.clone() };
        let flat = Fit { scene, ..faint.clone() };
        let is_shorter = faint.bits < self.bits_at(view, &flat, faint.noise, scratch)?;
        scratch.shown.forget();
        Ok(Some(if is_shorter { whole.stretched.undo(faint) } else { empty.clone() }))
    }
}
