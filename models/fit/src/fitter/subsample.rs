//! Large pictures with wide edges: every k-th pixel tells all.
//!
//! A fit needs an edge of a few pixels; one of twenty costs time, and its shallow slopes look flat. Pixels are taken, not
//! averaged: edges keep their profile. What is found is then held against the whole picture; if that shows more misses, all
//! of it is fitted.

use dvp_core::render::{EdgeLaw, EdgeProfile};
use dvp_core::{Image, ImageSize, ImageView, Real};

use super::run::visible_error;
use super::{FitScratch, Fitter};
use crate::segment::EdgeSample;
use crate::tuning::{MISSES, MISSES_EACH, SHARP_BEND, SUBSAMPLED_UNIT_PX, WIDE_EDGES_FEW};
use crate::{Fit, FitError, StopReason};

/// What rounding to 8 bits may add to a difference of two pixels.
const ROUNDING: f64 = 1.1 / 255.0;
/// Neighbors to each side over which contrast is taken.
const AROUND: usize = 3;
/// Rows, and columns, that are looked at to judge edges.
const LINES: usize = 256;

/// Which pixels of an image are looked at: those at `first` + k `stride` in both directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Subsampling {
    stride: usize,
    size: ImageSize,
    /// Size of what is left.
    small: ImageSize,
}

impl Subsampling {
    /// The widest stride, a power of 2, whose pixels tell those between; none if that is every pixel.
    pub(crate) fn of<T: Real>(image: &ImageView<'_, T>) -> Option<Self> {
        let size = image.size();
        let mut stride = 1;
        while size.unit_px() / (2 * stride) >= SUBSAMPLED_UNIT_PX && has_wide_edges(image, stride) {
            stride *= 2;
        }
        Self::every(stride, size)
    }

    /// Twice as many pixels in both directions; none if that is every pixel.
    fn finer(&self) -> Option<Self> {
        Self::every(self.stride / 2, self.size)
    }

    fn every(stride: usize, size: ImageSize) -> Option<Self> {
        let left = |side: usize| (side - stride / 2).div_ceil(stride);
        let small = (stride > 1).then(|| ImageSize::new(left(size.width()), left(size.height())).ok())??;
        Some(Self { stride, size, small })
    }

    /// The pixels looked at.
    pub(crate) fn image<T: Real>(&self, image: &ImageView<'_, T>) -> Image<T> {
        let mut out = Image::zeros(self.small);
        let (width, first) = (self.size.width(), self.stride / 2);
        for (channel, plane) in out.data_mut().chunks_exact_mut(self.small.pixels()).enumerate() {
            let rows = image.channel(channel).chunks_exact(width).skip(first).step_by(self.stride);
            for (small, row) in plane.chunks_exact_mut(self.small.width()).zip(rows) {
                let taken = row.iter().skip(first).step_by(self.stride);
                small.iter_mut().zip(taken).for_each(|(small, &value)| *small = value);
            }
        }
        out
    }

    /// Pixels of the image per pixel looked at, and where in the image the origin of those lies.
    fn similarity<T: Real>(&self) -> (T, T) {
        // The center of a pixel, 1/2, is that of the one at `first`.
        let half = T::of(0.5);
        let stride = T::of_usize(self.stride);
        (stride, T::of_usize(self.stride / 2) + half - stride * half)
    }

    /// A fit of the pixels looked at, as one of the image.
    pub(crate) fn restore<T: Real>(&self, mut fit: Fit<T>) -> Fit<T> {
        let (stride, origin) = self.similarity::<T>();
        let [unit, small] = [self.size, self.small].map(|size| T::of_usize(size.unit_px()));
        let units = stride * small / unit;
        let scene = &mut fit.scene;
        for object in &mut scene.objects {
            object.pose.translation = object.pose.translation.map(|x| x * units + origin / unit);
            object.pose.scale *= units;
        }
        if scene.edge.law == EdgeLaw::Area {
            // Edges of a pixel here are edges of a stride there.
            scene.edge = EdgeProfile::distance(scene.edge.sigma * T::of(2.0) / small);
        }
        scene.edge = scene.edge.magnified(units);
        for covariance in &mut fit.covariance {
            for (k, value) in covariance.iter_mut().enumerate() {
                let positions = usize::from(k / 5 < 2) + usize::from(k % 5 < 2);
                (0..positions).for_each(|_| *value *= units);
            }
        }
        fit
    }

    /// Whether a fit of the pixels looked at, which visibly misses `seen` of them, is one of the image, of which it misses `missed`.
    pub(crate) fn holds(&self, seen: usize, missed: usize) -> bool {
        let each = (self.stride * self.stride) as f64;
        missed as f64 <= MISSES + MISSES_EACH * each * seen as f64
    }

    /// A sample of the pixels looked at, as one of the image.
    pub(crate) fn restore_sample<T: Real>(&self, sample: &EdgeSample<T>) -> EdgeSample<T> {
        let (stride, origin) = self.similarity::<T>();
        EdgeSample {
            point: sample.point.map(|x| x * stride + origin),
            distance: sample.distance * stride,
            weight: sample.weight / stride,
        }
    }
}

impl<T: Real> Fitter<T> {
    /// A fit of the pixels that `subsampling` takes, of more of them while those do not show flat objects; none if it does
    /// not hold for the whole image.
    pub(super) fn fit_subsampled(
        &self,
        image: ImageView<'_, T>,
        subsampling: Subsampling,
        scratch: &mut FitScratch<T>,
    ) -> Result<Option<Fit<T>>, FitError> {
        let (mut best, mut seen) = self.fit_every(image, subsampling, scratch)?;
        let mut taken = subsampling;
        while best.stop == StopReason::NotFlat
            && let Some(finer) = taken.finer()
        {
            let (fit, missed) = self.fit_every(image, finer, scratch)?;
            if fit.unexplained >= best.unexplained {
                break;
            }
            (best, seen, taken) = (fit, missed, finer);
        }
        scratch.subsampling = Some(taken);
        let (loss, missed) = self.misses(&best, &image, scratch)?;
        best.loss = loss;
        Ok(taken.holds(seen, missed).then_some(best))
    }

    /// A fit of the pixels taken, as one of the image, and how many of them it visibly misses.
    fn fit_every(
        &self,
        image: ImageView<'_, T>,
        subsampling: Subsampling,
        scratch: &mut FitScratch<T>,
    ) -> Result<(Fit<T>, usize), FitError> {
        scratch.forget();
        let small = subsampling.image(&image);
        let fit = self.best_reading(small.view(), scratch)?;
        let (_, missed) = self.misses(&fit, &small.view(), scratch)?;
        Ok((subsampling.restore(fit), missed))
    }

    /// Mean absolute error of a fit's rendering, and how many pixels it visibly misses.
    pub(crate) fn misses(
        &self,
        fit: &Fit<T>,
        image: &ImageView<'_, T>,
        scratch: &mut FitScratch<T>,
    ) -> Result<(T, usize), FitError> {
        let FitScratch { drawing, shown, residual, .. } = scratch;
        fit.scene.draw(&self.outlines, drawing)?;
        shown.forget();
        let loss = shown.compare(drawing, image, (fit.scene.edge, fit.scene.compositing), residual)?;
        shown.forget();
        Ok((loss, residual.count_all_above(visible_error(fit.noise))))
    }
}

/// Whether the pixels at every `stride` go over edges in several steps: hardly one of those on a slope is sharp.
fn has_wide_edges<T: Real>(image: &ImageView<'_, T>, stride: usize) -> bool {
    let [width, height] = [image.size().width(), image.size().height()].map(|side| side / stride);
    let inner = |side: usize| AROUND..side.saturating_sub(AROUND);
    let [columns_apart, rows_apart] = [width, height].map(|side| (side / LINES).max(1));
    let (mut sharp, mut sloped) = (0, 0);
    for channel in 0..3 {
        let plane = image.channel(channel);
        let value = |x: usize, y: usize| plane[(y * image.size().width() + x) * stride];
        // Row by row in both directions, as the values lie in memory.
        for y in 0..height {
            if y % rows_apart == 0 {
                inner(width).for_each(|x| count_sharp(|at| value(at, y), x, &mut sharp, &mut sloped));
            }
            if inner(height).contains(&y) {
                (0..width)
                    .step_by(columns_apart)
                    .for_each(|x| count_sharp(|at| value(x, at), y, &mut sharp, &mut sloped));
            }
        }
    }
    sharp * WIDE_EDGES_FEW <= sloped
}

/// Counts the value at a place of a line if it is on a slope, and if it is sharp.
fn count_sharp<T: Real>(value: impl Fn(usize) -> T, at: usize, sharp: &mut usize, sloped: &mut usize) {
    let rounding = T::of(ROUNDING);
    let [before, own, after] = [value(at - 1), value(at), value(at + 1)];
    if (after - before).abs() <= rounding && (own - before).abs() <= rounding {
        return;
    }
    *sloped += 1;
    let off = (own - T::of(0.5) * (before + after)).abs();
    if off > rounding {
        let ends = (T::infinity(), T::neg_infinity());
        let window = (at - AROUND..=at + AROUND).map(&value);
        let (low, high) = window.fold(ends, |(low, high), value| (low.min(value), high.max(value)));
        *sharp += usize::from(off > T::of(SHARP_BEND) * (high - low));
    }
}
