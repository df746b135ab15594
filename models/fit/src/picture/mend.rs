//! Drawings with what they paint wrongly taken away, and what they miss painted on them.
//!
//! What is thin and drawn in pieces is taken away first, so that all of it is missed; then what is missed is painted, round by round, since things lie on
//! one another. Every part of the picture that changes on its own says whether it is shorter so, with what the drawing still misses there; where it is
//! not, all stays as it was.

use alloc::vec;
use alloc::vec::Vec;
use core::mem;
use core::ops::Range;

use dvp_core::{Drawing, Image, ImageSize, ImageView, Scene};
use dvp_trace::missed::{Missed, Painted, channels, misfit_bits};
use dvp_trace::tuning::{CODED_CONTRAST, LEAST_CONTRAST};
use dvp_trace::{ObjectDoubt, Traced};

use super::parts::{Parts, is_thin, off, price, rows, walk};
use crate::FitError;
use crate::paint::Canvas;
use crate::tuning::PIECE_WRONG;

/// Most rounds of things on one another.
const MOST_ROUNDS: usize = 4;
/// Rows around what is wrong that a thing which is added there may reach.
const MARGIN: usize = 4;

/// What is wrong with a drawing, before it is mended.
pub(super) struct Wrong {
    /// The pixels of the rows in which something is wrong.
    within: Range<usize>,
    /// What the drawing paints there, channel by channel.
    before: [Vec<f32>; 3],
    /// Which of its objects are thin, and not what the picture shows.
    is_piece: Vec<bool>,
    /// Differences of a channel up to this are none.
    step: f64,
}

/// A drawing with everything mended that is wrong with it.
struct Mended {
    /// What is kept of the drawing, then what is added.
    scene: Scene<f32>,
    drawing: Drawing<f32>,
    /// What it paints in the rows in which something was wrong.
    after: [Vec<f32>; 3],
    /// Description length of the outlines that are added, bits.
    bits: Vec<f64>,
}

impl Wrong {
    /// What is wrong with a drawing that is painted; none if nothing is.
    #[inline(never)]
    pub(super) fn of(
        traced: &Traced,
        drawing: &Drawing<f32>,
        painted: &Image<f32>,
        image: &ImageView<'_, f32>,
    ) -> Option<Self> {
        let step = if traced.coded { CODED_CONTRAST } else { LEAST_CONTRAST };
        let pair = Painted { scene: &traced.scene, image: *image, painted: painted.view(), step };
        let size = image.size();
        let off = pair.off(&(0..size.pixels()));
        let mut within = off.first().copied()?..off.last().copied()?;
        let is_piece: Vec<bool> = (0..drawing.object_count()).map(|k| is_piece(drawing, k, &off, size)).collect();
        if !is_piece.contains(&true) && !pair.may_miss(&off) {
            return None;
        }
        for k in (0..is_piece.len()).filter(|&k| is_piece[k]) {
            walk(drawing, k, size, &mut |i, _| within = within.start.min(i)..within.end.max(i));
        }
        let within = rows(&within, MARGIN, size);
        let before = channels(&painted.view(), &within).map(<[f32]>::to_vec);
        Some(Self { within, before, is_piece, step })
    }

    /// Mends the drawing where that makes it shorter.
    #[inline(never)]
    pub(super) fn mend(
        &self,
        traced: &mut Traced,
        drawing: &Drawing<f32>,
        image: ImageView<'_, f32>,
        canvas: &mut Canvas<f32>,
    ) -> Result<(), FitError> {
        let mended = self.mended(&traced.scene, image, canvas)?;
        let first = mended.scene.objects.len() - mended.bits.len();
        let pieces: Vec<usize> = (0..self.is_piece.len()).filter(|&k| self.is_piece[k]).collect();
        // What goes, then what comes: object `k` of a drawing, and by how many bits the scene is shorter.
        let gone = pieces.iter().map(|&k| (drawing, k, price(&traced.scene.objects[k])));
        let added = first..mended.scene.objects.len();
        let added = added.map(|k| (&mended.drawing, k, -price(&mended.scene.objects[k])));
        let is_better = self.are_better(gone.chain(added), &mended.after, &image);
        let mut is_left = vec![true; self.is_piece.len()];
        pieces.iter().zip(&is_better).for_each(|(&k, &is_gone)| is_left[k] = !is_gone);
        let objects = mem::take(&mut traced.scene.objects).into_iter().zip(mem::take(&mut traced.doubts));
        let left = objects.zip(is_left).filter(|(_, is_left)| *is_left);
        (traced.scene.objects, traced.doubts) = left.map(|(object, _)| object).unzip();
        let added = mended.scene.objects.into_iter().skip(first).zip(mended.bits);
        for ((object, bits), _) in added.zip(&is_better[pieces.len()..]).filter(|(_, is_better)| **is_better) {
            traced.scene.objects.push(object);
            traced.doubts.push(ObjectDoubt::default());
            traced.bits += bits;
        }
        Ok(())
    }

    /// The drawing without its pieces, and with what it misses then.
    fn mended(
        &self,
        scene: &Scene<f32>,
        image: ImageView<'_, f32>,
        canvas: &mut Canvas<f32>,
    ) -> Result<Mended, FitError> {
        let mut is_piece = self.is_piece.iter();
        let mut scene = scene.clone();
        scene.objects.retain(|_| is_piece.next() == Some(&false));
        let mut bits = Vec::new();
        let mut rounds = 0;
        loop {
            let (painted, drawing) = canvas.paint(&scene, image.size())?;
            let pair = Painted { scene: &scene, image, painted: painted.view(), step: self.step };
            let missed = if rounds < MOST_ROUNDS { pair.missed(&pair.off(&self.within)) } else { Vec::new() };
            if missed.is_empty() {
                let after = channels(&pair.painted, &self.within).map(<[f32]>::to_vec);
                return Ok(Mended { scene, drawing, after, bits });
            }
            rounds += 1;
            for Missed { object, bits: of_outline, .. } in missed {
                bits.push(of_outline);
                scene.objects.push(object);
            }
        }
    }

    /// Which changes make the drawing nearer to the picture and shorter, with all others of the part of the picture that changes with them.
    fn are_better<'a>(
        &self,
        changes: impl Iterator<Item = (&'a Drawing<f32>, usize, f64)>,
        after: &[Vec<f32>; 3],
        image: &ImageView<'_, f32>,
    ) -> Vec<bool> {
        let [before, after] = [&self.before, after].map(|painted| painted.each_ref().map(Vec::as_slice));
        let mut parts = Parts::of([before, after], self.within.start, image.size());
        let changes: Vec<(Option<u32>, f64)> =
            changes.map(|(drawing, k, saved)| (parts.part_of(drawing, k), saved)).collect();
        let image = channels(image, &self.within);
        let bits = |painted, i| misfit_bits(off(image, painted, i), self.step);
        let mut nearer = vec![0.0; parts.count()];
        for (i, part) in parts.pixels() {
            nearer[part] += bits(before, i) - bits(after, i);
        }
        let mut shorter = nearer.clone();
        for (part, saved) in &changes {
            part.iter().for_each(|&part| shorter[parts.root(part)] += saved);
        }

        let mut is_better = |part: u32| {
            let root = parts.root(part);
            nearer[root] > 0.0 && shorter[root] > 0.0
        };
        changes.iter().map(|(part, _)| part.is_some_and(&mut is_better)).collect()
    }
}

/// Whether object `k` is thin, and pixels along much of its outline are `off`.
fn is_piece(drawing: &Drawing<f32>, k: usize, off: &[usize], size: ImageSize) -> bool {
    if !is_thin(drawing, k, size) {
        return false;
    }
    let [mut wrong, mut all] = [0.0; 2];
    walk(drawing, k, size, &mut |i, length| {
        all += length;
        wrong += if off.binary_search(&i).is_ok() { length } else { 0.0 };
    });
    wrong > PIECE_WRONG * all
}
