//! Things of a drawing that it does not need: thin ones that hardly change what is painted.
//!
//! What is seen of something in a row of pixels beside an edge may be read as a thing before it is known what lies there. Once all things are whole,
//! as others show that they are, the rest paints such a row as well.

#[cfg(test)]
mod tests;

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::{Drawing, Image, ImageView, Scene};
use dvp_trace::Traced;
use dvp_trace::missed::{channels, misfit_bits};
use dvp_trace::tuning::{CODED_CONTRAST, LEAST_CONTRAST, THING_BITS};

use super::parts::{Parts, is_thin};
use crate::FitError;
use crate::paint::Canvas;

/// Times as far, squared, as the picture may be from what is painted without a thing that is not needed, where it would lie: twice as far is what edges
/// that were told in two pieces miss.
const MOST_MISSED: f64 = 4.0;

/// What a drawing paints, and which of its things are thin.
pub(super) struct Spare {
    painted: [Vec<f32>; 3],
    thin: Vec<usize>,
}

impl Spare {
    /// The thin things of a drawing that is painted; none if it has none.
    #[inline(never)]
    pub(super) fn of(drawing: &Drawing<f32>, painted: &Image<f32>) -> Option<Self> {
        let size = painted.size();
        let thin: Vec<usize> = (0..drawing.object_count()).filter(|&k| is_thin(drawing, k, size)).collect();
        let painted = || channels(&painted.view(), &(0..size.pixels())).map(<[f32]>::to_vec);
        (!thin.is_empty()).then(|| Self { painted: painted(), thin })
    }

    /// Leaves out those that the picture is as well described without.
    #[inline(never)]
    pub(super) fn leave_out(
        &self,
        traced: &mut Traced,
        drawing: &Drawing<f32>,
        image: &ImageView<'_, f32>,
        canvas: &mut Canvas<f32>,
    ) -> Result<(), FitError> {
        let is_thin = |k: &usize| self.thin.binary_search(k).is_ok();
        let objects = traced.scene.objects.iter().enumerate();
        let objects = objects.filter(|(k, _)| !is_thin(k)).map(|(_, object)| object.clone()).collect();
        let (painted, _) = canvas.paint(&Scene { objects, ..traced.scene.clone() }, image.size())?;
        let all = 0..image.size().pixels();
        let [before, after] = [self.painted.each_ref().map(Vec::as_slice), channels(&painted.view(), &all)];
        let mut parts = Parts::of([before, after], 0, image.size());
        let of_part: Vec<Option<u32>> = self.thin.iter().map(|&k| parts.part_of(drawing, k)).collect();
        let step = if traced.coded { CODED_CONTRAST } else { LEAST_CONTRAST };
        let image = channels(image, &all);
        let mut missed = |painted| {
            let sigmas2 = parts.missed(image, painted, |off| (off / step).powi(2));
            (sigmas2, parts.missed(image, painted, |off| misfit_bits(off, step)))
        };
        let [(before, bits_before), (after, bits_after)] = [before, after].map(&mut missed);
        let is_needed = |part: usize| {
            bits_after[part] - bits_before[part] > THING_BITS || after[part] > MOST_MISSED * before[part] + 1.0
        };
        let mut is_left = vec![true; traced.scene.objects.len()];
        for (&k, part) in self.thin.iter().zip(&of_part) {
            is_left[k] = part.is_some_and(|part| is_needed(parts.root(part)));
        }
        let [mut of_objects, mut of_covariances] = [is_left.iter(), is_left.iter()];
        traced.scene.objects.retain(|_| of_objects.next() == Some(&true));
        traced.covariances.retain(|_| of_covariances.next() == Some(&true));
        Ok(())
    }
}
