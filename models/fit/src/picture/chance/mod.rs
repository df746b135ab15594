//! Things of a drawing that was read under noise, which that noise explains as well.
//!
//! What is averaged keeps spots and stripes of it, and some become things. Such a thing brings the drawing nearer to the picture by less than a thing costs
//! beside its outline.

#[cfg(test)]
mod tests;

use alloc::vec;
use alloc::vec::Vec;
use core::f64::consts::LN_2;

use dvp_core::render::ContourRenderer;
use dvp_core::{ImageView, Scene};
use dvp_trace::Traced;
use dvp_trace::noise::noise_level;
use dvp_trace::tuning::THING_BITS;

use crate::FitError;
use crate::colors::repeated;
use crate::marginal_gain::squared_errors;
use crate::paint::Canvas;

/// Things that pay so many times what they cost by a first count, in whole pixels, are not asked again.
const CLEARLY: f64 = 3.0;

/// Leaves out of a drawing, painted with the edges of `scene`, what does not pay for itself.
#[inline(never)]
pub(super) fn leave_out(
    traced: &mut Traced,
    scene: &Scene<f32>,
    image: &ImageView<'_, f32>,
    canvas: &mut Canvas<f32>,
) -> Result<(), FitError> {
    // Squares to bits, at the noise of the picture: of textures more was averaged away, which they show.
    let noise = f64::from(noise_level(image, &mut Vec::new())).min(traced.noise);
    let bits = 0.5 / (noise * noise * LN_2 * repeated(image));
    let (painted, drawing) = canvas.paint(scene, image.size())?;
    let gains = squared_errors(&drawing, image, scene.compositing);
    let is_asked: Vec<bool> = gains.into_iter().map(|gain| bits * gain < CLEARLY * THING_BITS).collect();
    if !is_asked.contains(&true) {
        return Ok(());
    }
    let before = painted.clone();
    let rest = scene.objects.iter().zip(&is_asked).filter(|(_, is_asked)| !**is_asked);
    let rest = Scene { objects: rest.map(|(object, _)| object.clone()).collect(), ..scene.clone() };
    let (after, _) = canvas.paint(&rest, image.size())?;
    let mut gains = vec![0.0; is_asked.len()];
    let renderer = ContourRenderer::new(scene.edge, scene.compositing);
    renderer.visit_coverage(&drawing, image.size(), &mut Default::default(), |object, first, coverage| {
        if !is_asked[object] {
            return;
        }
        for (i, _) in (first..).zip(coverage).filter(|(_, coverage)| **coverage > 0.0) {
            let seen = image.pixel(i);
            let squares = |shown: [f32; 3]| (0..3).map(|c| f64::from(shown[c] - seen[c]).powi(2)).sum::<f64>();
            gains[object] += squares(after.view().pixel(i)) - squares(before.view().pixel(i));
        }
    })?;
    let is_left = is_asked.iter().zip(gains).map(|(is_asked, gain)| !is_asked || bits * gain >= THING_BITS);
    let is_left: Vec<bool> = is_left.collect();
    let [mut of_objects, mut of_covariances] = [is_left.iter(), is_left.iter()];
    traced.scene.objects.retain(|_| of_objects.next() == Some(&true));
    traced.covariances.retain(|_| of_covariances.next() == Some(&true));
    Ok(())
}
