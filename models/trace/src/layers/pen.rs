//! Faces that a pen has drawn: strokes, where they are the shorter description.

use alloc::vec;
use alloc::vec::Vec;

use super::visible;
use crate::boundary::Ring;
use crate::outline::fit_closed;
use crate::partition::{OUTSIDE, Partition};
use crate::ruler::Ruler;
use crate::sample::RingSamples;
use crate::stroke::{StrokeFit, fit_strokes};

/// The strokes of every face that is drawn with fewer bits by a pen.
pub(super) fn find(
    partition: &Partition,
    rings: &[Vec<Ring>],
    background: u32,
    ruler: &Ruler,
) -> Vec<Option<StrokeFit>> {
    let mut pens = vec![None; partition.faces.len()];
    for (face, rings) in rings.iter().enumerate() {
        let is_cut = rings.iter().flat_map(|ring| &ring.steps).any(|step| step.other == OUTSIDE);
        if face as u32 == background || is_cut || partition.faces[face].flat == 0 {
            continue;
        }
        let samples: Vec<RingSamples> = rings.iter().map(|ring| visible::samples(ring, |_| None)).collect();
        pens[face] = fit_strokes(&samples, ruler).filter(|pen| {
            let outlines =
                samples.iter().map(|samples| fit_closed(samples, ruler).map(|outline| outline.bits + outline.misfit));
            outlines.sum::<Option<f64>>().is_none_or(|bits| pen.bits + pen.misfit < bits)
        });
    }
    pens
}
