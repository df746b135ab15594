//! Pictures that are not flat, such as photographs: cut into regions of one color, which are drawn.

#[cfg(test)]
mod tests;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use alloc::vec::Vec;

use dvp_core::{Image, ImageSize, ImageView, Real as _};
use dvp_trace::noise::noise_level;
use dvp_trace::ramps::clear_share;
use dvp_trace::regions::regions;
use dvp_trace::trace_regions;

use super::{CLEARLY_WORSE, PictureScratch, of_painted, shorter};
use crate::tuning::NOT_FLAT_SHARE;
use crate::{Fit, FitError, StopReason};

/// Most pixels that are cut, about: what a few hundred regions are is seen in as many, and more take seconds.
const MOST_PIXELS: usize = 1 << 18;

/// Share of the edges that are clear in any photograph: in pictures that were blurred there are fewer.
const CLEAR: f64 = 0.1;

/// A fit that leaves no more unexplained than flat pictures do, or that of regions, at most `most`, if these are nearer to the picture: with more things
/// than the fit has much nearer, unless that explains nothing. What a coder leaves (`is_coded`) is no things: there the shorter description is taken.
/// Of a picture that was blurred bands are none either.
#[inline(never)]
pub(super) fn or_regions(
    fit: Fit<f32>,
    image: ImageView<'_, f32>,
    (most, is_coded): (usize, bool),
    scratch: &mut PictureScratch,
) -> Result<Fit<f32>, FitError> {
    if fit.unexplained <= NOT_FLAT_SHARE || clear_share(&image) < CLEAR {
        return Ok(fit);
    }
    let size = image.size();
    let side = f64::of_usize(size.pixels().div_ceil(MOST_PIXELS)).sqrt().ceil().to_count();
    let Some(small) = shrunk(&image, side) else { return Ok(fit) };
    let noise = f64::from(noise_level(&small.view(), &mut Vec::new()));
    // One of them is the background.
    let Ok(mut traced) = trace_regions(&regions(&small.view(), most.saturating_add(1), noise)) else { return Ok(fit) };
    let units = f32::of_usize(side * small.size().unit_px()) / f32::of_usize(size.unit_px());
    for object in &mut traced.scene.objects {
        object.pose.translation = object.pose.translation.map(|at| at * units);
        object.pose.scale *= units;
    }
    let (painted, drawing) = scratch.canvas.paint(&traced.scene, size)?;
    let cut = of_painted(&traced.scene, &drawing, painted, image)?;
    let cut = Fit { bits: traced.bits, stop: StopReason::NotFlat, ..cut };
    if is_coded {
        return shorter(fit, cut, image, &mut scratch.canvas);
    }
    let is_more = cut.scene.objects.len() > fit.scene.objects.len();
    let factor = if is_more { CLEARLY_WORSE.powf(1.0 - f32::of(fit.unexplained)) } else { 1.0 };
    Ok(if factor * cut.loss < fit.loss { cut } else { fit })
}

/// The means of blocks of `side` x `side` pixels; of fewer at the borders on the right and below.
fn shrunk(image: &ImageView<'_, f32>, side: usize) -> Option<Image<f32>> {
    let (width, height) = (image.size().width(), image.size().height());
    let mut small = Image::zeros(ImageSize::new(width.div_ceil(side), height.div_ceil(side)).ok()?);
    let (columns, pixels) = (small.size().width(), small.size().pixels());
    for (c, plane) in small.data_mut().chunks_exact_mut(pixels).enumerate() {
        let rows = image.channel(c).chunks(side * width);
        for (block, row) in rows.zip(plane.chunks_exact_mut(columns)) {
            for (x, mean) in row.iter_mut().enumerate() {
                let parts = block.chunks_exact(width).map(|line| &line[x * side..width.min((x + 1) * side)]);
                let (sum, count) = parts.flatten().fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
                *mean = sum / count;
            }
        }
    }
    Some(small)
}
