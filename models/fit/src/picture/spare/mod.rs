//! Things of a drawing that it does not need: thin ones that hardly change what is painted.
//!
//! What is seen of something in a row of pixels beside an edge may be read as a thing before it is known what lies there. Once all things are whole,
//! as others show that they are, the rest paints such a row as well.

#[cfg(test)]
mod tests;

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use dvp_core::{Drawing, Image, ImageView, Scene};
use dvp_trace::Traced;
use dvp_trace::missed::{channels, misfit_bits};
use dvp_trace::tuning::{CODED_CONTRAST, LEAST_CONTRAST, PIXEL_BITS, THING_BITS};

use super::parts::{Parts, is_thin, off, rows, walk};
use crate::FitError;
use crate::paint::Canvas;

/// Times as far, squared, as the picture may be from what is painted without a thing that is not needed, where it would lie: twice as far is what an edge
/// misses that is told as part of a whole, not for itself.
const MOST_MISSED: f64 = 4.0;

/// What a drawing paints, and which of its things are thin.
pub(super) struct Spare {
    thin: Vec<usize>,
    /// The pixels of the rows that these lie in.
    within: Range<usize>,
    /// What is painted there, channel by channel.
    painted: [Vec<f32>; 3],
}

impl Spare {
    /// The thin things of a drawing that is painted; none if it has none.
    #[inline(never)]
    pub(super) fn of(drawing: &Drawing<f32>, painted: &Image<f32>) -> Option<Self> {
        let size = painted.size();
        let thin: Vec<usize> = (0..drawing.object_count()).filter(|&k| is_thin(drawing, k, size)).collect();
        let mut lie = size.pixels()..0;
        let mut walk = |k: usize| walk(drawing, k, size, &mut |i, _| lie = lie.start.min(i)..lie.end.max(i));
        thin.iter().for_each(|&k| walk(k));
        if lie.start > lie.end {
            return None;
        }
        // Pixels beside an outline are changed by it, too.
        let within = rows(&lie, 1, size);
        let painted = channels(&painted.view(), &within).map(<[f32]>::to_vec);
        Some(Self { thin, within, painted })
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
        let [before, after] = [self.painted.each_ref().map(Vec::as_slice), channels(&painted.view(), &self.within)];
        let mut parts = Parts::of([before, after], self.within.start, image.size());
        let of_part: Vec<Option<u32>> = self.thin.iter().map(|&k| parts.part_of(drawing, k)).collect();
        let step = if traced.coded { CODED_CONTRAST } else { LEAST_CONTRAST };
        let image = channels(image, &self.within);
        let mut without = vec![Without::default(); parts.count()];
        for (i, part) in parts.pixels() {
            without[part].add([before, after].map(|painted| off(image, painted, i)), step);
        }
        let mut is_left = vec![true; traced.scene.objects.len()];
        for (&k, part) in self.thin.iter().zip(&of_part) {
            is_left[k] = part.is_some_and(|part| !without[parts.root(part)].is_as_good());
        }
        let [mut of_objects, mut of_doubts] = [is_left.iter(), is_left.iter()];
        traced.scene.objects.retain(|_| of_objects.next() == Some(&true));
        traced.doubts.retain(|_| of_doubts.next() == Some(&true));
        Ok(())
    }
}

/// How a part of the picture is described with its thin things, and without them.
#[derive(Clone, Copy, Default)]
struct Without {
    /// Squares of the steps by which pixels are off.
    steps2: [f64; 2],
    /// Bits that are missed without them.
    missed: f64,
    /// Most of them in one pixel.
    worst: f64,
}

impl Without {
    /// Adds a pixel that is off by so much with them, and by so much without.
    fn add(&mut self, offs: [f64; 2], step: f64) {
        let [with, without] = offs.map(|off| misfit_bits(off, step));
        let steps = offs.map(|off| off / step);
        self.steps2.iter_mut().zip(steps).for_each(|(sum, steps)| *sum += steps * steps);
        self.missed += without - with;
        self.worst = self.worst.max(without - with);
    }

    /// Whether it is as well described without them: no pixel shows something else, all together miss less than a thing costs, and nothing is much
    /// farther off than before.
    fn is_as_good(&self) -> bool {
        let [with, without] = self.steps2;
        self.worst <= 0.5 * PIXEL_BITS && self.missed <= THING_BITS && without <= MOST_MISSED * with + 1.0
    }
}
