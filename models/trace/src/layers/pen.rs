//! Faces that a pen has drawn: strokes, where they are the shorter description.

use alloc::vec;
use alloc::vec::Vec;

use super::visible::{self, Hidden};
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
        if face as u32 == background || partition.faces[face].flat == 0 {
            continue;
        }
        // Of a line, what lies beyond the border is not seen; an outline ends there.
        let samples = |ring: &Ring, beyond: Option<Hidden>| {
            let hidden: Vec<_> = ring.steps.iter().map(|step| beyond.filter(|_| step.other == OUTSIDE)).collect();
            visible::samples(ring, &hidden)
        };
        let seen: Vec<RingSamples> = rings.iter().map(|ring| samples(ring, Some(Hidden::Free))).collect();
        pens[face] = fit_strokes(&seen, ruler).filter(|pen| {
            let samples = rings.iter().map(|ring| samples(ring, None));
            let outlines =
                samples.map(|samples| fit_closed(&samples, ruler).map(|outline| outline.bits + outline.misfit));
            outlines.sum::<Option<f64>>().is_none_or(|bits| pen.bits + pen.misfit < bits)
        });
    }
    pens
}
