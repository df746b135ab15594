//! Outlines through what is seen of a layer, led around what they must not hide.

use alloc::collections::BTreeMap;
use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::PathRing;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::complete::{Completed, Completion, Place};
use super::walk::{self, Walk};
use super::{link, raster, sheet, visible};
use crate::boundary::Ring;
use crate::outline::{Outline, OutlineShape};
use crate::partition::OUTSIDE;
use crate::sample::RingSamples;
use crate::tuning;

/// Bits that tell of a sheet as large as the picture: that it is one, and of which kind.
const FRAME_BITS: f64 = 8.0;

/// Most ways to link the parts of one thing that are tried.
const MOST_LINKED: usize = 4;

/// Outlines that are led around what they must not hide, round by round.
struct Led<'a> {
    /// The boundaries, as they are followed in the end.
    walks: Vec<Walk<'a>>,
    /// The first outlines that agree, if any do.
    found: Option<Completed>,
    /// Those before.
    wrong: Vec<Wrong>,
}

/// Outlines that get pixels wrong, and which.
struct Wrong {
    completed: Completed,
    pixels: Vec<[usize; 2]>,
}

impl Completion<'_> {
    /// [`Completion::outlines`] of a group that was not asked for at a place like this before.
    pub(super) fn completed(&self, place: &Place<'_>) -> Completed {
        let (group, rank) = (place.faces, place.rank);
        let samples = walk::samples(&self.walks(group, rank));
        // What is not hidden has no boundary but its own.
        let is_seen =
            |at: Vec2<f64>| self.pure_face(at).is_some_and(|face| group.contains(&face) || !place.is_behind(face));
        let most = if group.len() > 1 { MOST_LINKED } else { 1 };
        let linked = link::relinked(&samples, is_seen, most).into_iter().map(|samples| self.framed(&samples));
        let agrees = |completed: &Completed| self.check(&completed.outlines, place).is_ok();
        let mut found = shortest(linked.filter(agrees));
        let walked = self.fit(&samples);
        let pixels = match self.check(&walked.outlines, place) {
            Ok(()) => return found.filter(|linked| linked.bits <= walked.bits).unwrap_or(walked),
            Err(pixels) => pixels,
        };
        let bordered = sheet::bordered(&samples, self.partition.size, is_seen).map(|bordered| self.fit(&bordered));
        found = shortest(found.into_iter().chain(bordered.filter(agrees)));
        let mut walks = Vec::new();
        let mut wrong = vec![Wrong { completed: walked, pixels: pixels.clone() }];
        // What is hidden goes along what hides it. Where that leads nowhere, cracks tell the boundary first, and what is hidden may go anywhere still;
        // not in pictures with long boundaries, where few of those that fail do so for want of a short side.
        let ways: &[bool] = if self.has_time() { &[false, true] } else { &[false] };
        for &fills in ways {
            if let Some(led) = self.led(self.walks(group, rank), pixels.clone(), fills, place) {
                found = shortest(found.into_iter().chain(led.found));
                wrong.extend(led.wrong);
                walks = led.walks;
            }
            if found.is_some() {
                break;
            }
        }
        found.unwrap_or_else(|| self.cheapest(walks, wrong, place))
    }

    /// Outlines that are led around what they must not hide, from those on that get `pixels` wrong; none where nothing is to be filled though it
    /// should be (`fills`).
    fn led<'a>(
        &self,
        mut walks: Vec<Walk<'a>>,
        mut pixels: Vec<[usize; 2]>,
        fills: bool,
        place: &Place<'_>,
    ) -> Option<Led<'a>> {
        let mut is_filled = fills && walk::fill(&mut walks, &pixels);
        if fills && !is_filled {
            return None;
        }
        let mut wrong = Vec::new();
        // Long boundaries are not led around without end. With a quarter of that the description of two flags of 160 doubled; without a bound layers
        // took up to 39 rounds.
        let count: usize = walk::samples(&walks).iter().flat_map(|ring| &ring.runs).map(Vec::len).sum();
        for _ in 0..=tuning::MOST_TRIED * tuning::MOST_TRIED_SAMPLES / count.max(1) {
            if !is_filled && !walk::pin(&mut walks, &pixels) {
                break;
            }
            let completed = self.fit(&walk::samples(&walks));
            match self.check(&completed.outlines, place) {
                Ok(()) => return Some(Led { walks, found: Some(completed), wrong }),
                Err(still) => pixels.clone_from(&still),
            }
            wrong.push(Wrong { completed, pixels: pixels.clone() });
            is_filled = fills && walk::fill(&mut walks, &pixels);
        }
        Some(Led { walks, found: None, wrong })
    }

    /// The cheapest of outlines of which none agrees, with what their wrong pixels cost, and of polygons through the samples themselves.
    fn cheapest(&self, mut walks: Vec<Walk<'_>>, wrong: Vec<Wrong>, place: &Place<'_>) -> Completed {
        walks.retain(|walk| !walk.is_filled);
        let traced = Completed::new(walks.iter().map(|walk| self.traced(walk.ring)).collect(), false);
        // Of many boundaries most are right as they are.
        let blamed = wrong.last().map(|wrong| walk::blamed(&walks, &wrong.pixels)).unwrap_or_default();
        let parts = walks.iter().zip(blamed).filter_map(|(walk, is_blamed)| match is_blamed {
            true => Some(self.traced(walk.ring)),
            false => self.memo.fit_closed(&walk.samples(), &self.ruler),
        });
        let parts = Completed::new(parts.collect(), false);
        let parts = self.check(&parts.outlines, place).is_ok().then_some(parts);
        let priced = wrong.into_iter().map(|wrong| self.priced(wrong, place.faces)).chain(parts);
        priced.fold(traced, |best, other| if other.bits < best.bits { other } else { best })
    }

    /// Outlines that get pixels wrong, with what these cost: where colors are alike, or a coder has changed them, less than the corners of a
    /// polygon that gets them right.
    fn priced(&self, Wrong { completed, pixels: wrong }: Wrong, own: &[u32]) -> Completed {
        let mut pixels: BTreeMap<u32, usize> = BTreeMap::new();
        wrong.iter().for_each(|&at| *pixels.entry(self.partition.face_at(at)).or_default() += 1);
        let chi2 = |(&face, &count): (&u32, &usize)| {
            // What else may be shown where its own face is missed is not known: the worst of what is beside.
            let shown = if own.contains(&face) { &self.neighbors[face as usize][..] } else { own };
            let color = self.partition.color(face);
            let contrast2 = |other: &u32| (0..3).map(|c| (self.partition.color(*other)[c] - color[c]).powi(2)).sum();
            count as f64 * shown.iter().map(contrast2).fold(0.0, f64::max) / self.partition.sigma.powi(2)
        };
        let bits = completed.bits + self.ruler.misfit(pixels.iter().map(chi2).sum());
        // Without outlines nothing is explained.
        let bits = if completed.outlines.is_empty() { f64::INFINITY } else { bits };
        Completed { bits, agrees: false, ..completed }
    }

    /// The outlines through samples.
    fn fit(&self, samples: &[RingSamples]) -> Completed {
        let outlines = samples.iter().filter_map(|samples| self.memo.fit_closed(samples, &self.ruler));
        Completed::new(outlines.filter(|outline| !raster::is_nothing(outline)).collect(), true)
    }

    /// The outlines through samples, within that of the picture where they go around what they leave free: corners around a disk are a
    /// sheet with an opening.
    fn framed(&self, samples: &[RingSamples]) -> Completed {
        let mut completed = self.fit(samples);
        if samples.iter().map(link::area).sum::<f64>() < 0.0 {
            let [width, height] = self.partition.size.map(|side| side as f64);
            let points = vec![[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
            let shape = OutlineShape::Path(PathRing::polygon(points));
            completed.bits += FRAME_BITS;
            completed.outlines.push(Outline { shape, bits: FRAME_BITS, misfit: 0.0, covariance: Vec::new() });
        }
        completed
    }

    /// The face at a place if nothing else has a share there.
    fn pure_face(&self, at: Vec2<f64>) -> Option<u32> {
        let [x, y] = [at.x as usize, at.y as usize];
        let face = self.partition.face_at([x, y]);
        (face != OUTSIDE && self.partition.shares[y * self.partition.size[0] + x] >= tuning::PURE_SHARE).then_some(face)
    }

    /// The last resort: the polygon through the samples themselves.
    fn traced(&self, ring: &Ring) -> Outline {
        let RingSamples { runs, .. } = visible::samples(ring, &vec![None; ring.steps.len()], &[]);
        let mut points: Vec<[f64; 2]> = runs.iter().flatten().map(|sample| sample.point.to_array()).collect();
        if points.len() < 3 {
            points = ring.steps.iter().map(|step| step.crack.start.map(|value| value as f64)).collect();
        }
        let bits = 2.0 * points.len() as f64 * self.ruler.number(0.1);
        Outline { shape: OutlineShape::Path(PathRing::polygon(points)), bits, misfit: 0.0, covariance: Vec::new() }
    }
}

/// The first of those with the fewest bits.
fn shortest(outlines: impl Iterator<Item = Completed>) -> Option<Completed> {
    outlines.min_by(|a, b| a.bits.total_cmp(&b.bits))
}
