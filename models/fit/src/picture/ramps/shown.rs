//! Colors that leveling has moved: those that the picture shows.

use alloc::vec;

use dvp_core::render::ContourRenderer;
use dvp_core::{Drawing, Image, ImageView, Real as _, Scene};

use crate::FitError;

/// How far the leveled picture may be from the picture on the mean where a thing is seen that leveling has not moved, of 1: what it rounds away.
const MOVED: f64 = 1.5 / 255.0;

/// Moves the colors of flat things by what the scene, painted, misses where they are seen: of those things that the leveled picture shows in another
/// color than the picture, since what shades a ramp moves with the color that stands for it. Whether any has moved.
pub(super) fn recolor(
    scene: &mut Scene<f32>,
    (drawing, painted): (&Drawing<f32>, &Image<f32>),
    leveled: &ImageView<'_, f32>,
    image: &ImageView<'_, f32>,
) -> Result<bool, FitError> {
    let (size, renderer) = (image.size(), ContourRenderer::new(scene.edge, scene.compositing));
    let mut seen = vec![usize::MAX; size.pixels()];
    renderer.visit_coverage(drawing, size, &mut Default::default(), |object, pixel, coverage| {
        for (seen, _) in seen[pixel..].iter_mut().zip(coverage).filter(|(_, coverage)| **coverage >= 0.5) {
            *seen = object;
        }
    })?;
    let mut sums = vec![Sums::default(); scene.objects.len()];
    renderer.visit_coverage(drawing, size, &mut Default::default(), |object, pixel, coverage| {
        for (i, &coverage) in (pixel..).zip(coverage).filter(|(i, _)| seen[*i] == object) {
            let (shown, moved, missed) = (image.pixel(i), leveled.pixel(i), painted.view().pixel(i));
            let share = coverage * drawing.confidences[object];
            let sums = &mut sums[object];
            sums.pixels += 1.0;
            sums.shares += f64::from(share * share);
            for c in 0..3 {
                sums.moved[c] += f64::from(shown[c] - moved[c]);
                sums.missed[c] += f64::from(share * (shown[c] - missed[c]));
            }
        }
    })?;
    let mut is_any = false;
    for (object, sums) in scene.objects.iter_mut().zip(&sums) {
        let is_moved = sums.moved.iter().any(|moved| moved.abs() > MOVED * sums.pixels);
        if object.paint.ramp().is_some() || !is_moved || sums.shares <= 0.0 {
            continue;
        }
        let color = object.color();
        object
            .paint
            .set_color(core::array::from_fn(|c| (color[c] + f32::of(sums.missed[c] / sums.shares)).clamp(0.0, 1.0)));
        is_any = true;
    }
    Ok(is_any)
}

/// Sums over the pixels where a thing is seen; in f64, for these may be millions.
#[derive(Clone, Copy, Default)]
struct Sums {
    pixels: f64,
    /// Squares of the shares of the pixels that it has.
    shares: f64,
    /// What the picture has more than the leveled one.
    moved: [f64; 3],
    /// What the painted scene misses, by share.
    missed: [f64; 3],
}
