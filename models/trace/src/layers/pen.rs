//! Faces that a pen has drawn: strokes, where they are the shorter description.

use alloc::vec;
use alloc::vec::Vec;

use super::memo::Memo;
use super::visible::{self, Hidden};
use crate::boundary::Ring;
use crate::partition::{OUTSIDE, Partition};
use crate::ruler::Ruler;
use crate::sample::RingSamples;
use crate::stroke::StrokeFit;

/// The strokes of every face that is drawn with fewer bits by a pen.
pub(super) fn find(
    partition: &Partition,
    rings: &[Vec<Ring>],
    background: u32,
    ruler: &Ruler,
    memo: &Memo,
) -> Vec<Option<StrokeFit>> {
    let mut pens = vec![None; partition.faces.len()];
    for (face, rings) in rings.iter().enumerate() {
        if face as u32 == background || partition.faces[face].flat == 0 {
            continue;
        }
        // Of a line, what lies beyond the border is not seen; an outline ends there.
        let samples = |ring: &Ring, beyond: Option<Hidden>| {
            let hidden: Vec<_> = ring.steps.iter().map(|step| beyond.filter(|_| step.other == OUTSIDE)).collect();
            visible::samples(ring, &hidden, &[])
        };
        let seen: Vec<RingSamples> = rings.iter().map(|ring| samples(ring, Some(Hidden::Free))).collect();
        pens[face] = memo.fit_strokes(&seen, ruler).filter(|pen| {
            // As soon as some of the outlines cost more there is no need for the others.
            let mut bits = 0.0;
            rings.iter().map(|ring| samples(ring, None)).any(|samples| {
                let outline = memo.fit_closed(&samples, ruler);
                bits += outline.map_or(f64::INFINITY, |outline| outline.bits + outline.misfit);
                pen.bits + pen.misfit < bits
            })
        });
    }
    pens
}
