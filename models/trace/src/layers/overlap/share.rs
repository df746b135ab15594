//! Which stretches of a boundary are of one thing.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;

use super::heap::{Heap, extent};
use super::stretch::Stretches;
use crate::outline::Outline;
use crate::ruler::Ruler;
use crate::sample::Sample;
use crate::tuning;

/// Fewest windows of a stretch that is looked at: as many as a circle has numbers.
const SHORTEST: usize = 3;
/// Standard deviation (pixels) of the polygon through stretches that are of nothing round.
const POLYGON_SIGMA: f64 = 0.1;
/// Bits of a stretch below which two cannot be fewer: those of two circles.
const WORTH_CUTTING: f64 = 70.0;
/// Windows from one place where a stretch may be cut to the next, at first.
const STEP: usize = 3;
/// Windows of a stretch among which such a place is looked for.
const FIRST_LOOKS: usize = 48;
/// Most stretches of one boundary: more are the edge of something that is uneven.
const MOST_STRETCHES: usize = 64;

/// Things, and where the boundary was cut between them.
pub(super) struct Shared {
    pub(super) parts: Vec<Part>,
    pub(super) cuts: Vec<Vec2<f64>>,
    pub(super) stretches: Vec<Vec<Sample>>,
}

/// Stretches of one thing.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) stretches: Vec<usize>,
    /// Places that it reaches to, as pixels that nothing else covers tell.
    pub(super) held: Vec<Sample>,
    /// Windows of them.
    count: usize,
    /// The outline through them, if there is one.
    pub(super) outline: Option<Outline>,
    /// Bits of that, or of the polygon through them.
    pub(super) bits: f64,
    /// Whether windows alone tell of it.
    pub(super) is_told: bool,
}

impl Part {
    /// What is of stretches, of all that there are, and reaches to some places.
    #[inline(never)]
    pub(super) fn new(stretches: Vec<usize>, held: Vec<Sample>, of: &[Vec<Sample>], heap: &Heap<'_>) -> Self {
        let runs: Vec<Vec<Sample>> = stretches.iter().map(|&k| of[k].clone()).collect();
        let count: usize = runs.iter().map(Vec::len).sum();
        let polygon = polygon(count, heap.ruler);
        let price = |outline: &Outline| outline.bits + outline.misfit;
        let most = if count == 0 { f64::INFINITY } else { polygon };
        let (outline, is_told) =
            heap.round(&runs, &held, most).map_or((None, false), |(outline, is_told)| (Some(outline), is_told));
        let bits = outline.as_ref().map_or(polygon, price);
        Self { stretches, held, count, outline, bits, is_told }
    }

    /// A thing of which so many windows are seen.
    pub(super) fn again(outline: Outline, count: usize) -> Self {
        let bits = outline.bits + outline.misfit;
        Self { stretches: Vec::new(), held: Vec::new(), count, outline: Some(outline), bits, is_told: true }
    }

    /// Whether it may be of the same thing as another one: their outlines lie on one another, if they have such.
    fn may_join(&self, other: &Self) -> bool {
        let (Some(one), Some(other)) = (&self.outline, &other.outline) else { return true };
        let [(here, one, _), (there, other, _)] = [one, other].map(extent);
        (here - there).length() < one.max(other)
    }

    /// Bits of its outline, if it has one.
    fn known(&self) -> f64 {
        self.outline.as_ref().map_or(0.0, |_| self.bits)
    }

    /// Share of its outline that is seen; 0 without one.
    pub(super) fn seen(&self) -> f64 {
        self.outline.as_ref().map_or(0.0, |outline| self.count as f64 / extent(outline).2)
    }
}

/// The things that stretches are of: each is cut as long as two cost less, then those two become one again and again that cost least more by it. None if
/// there are too many, or what nothing explains costs more than twice `most` bits.
pub(super) fn share(mut left: Stretches, most: f64, heap: &Heap<'_>) -> Option<Shared> {
    let (mut parts, mut stretches) = (Vec::new(), Vec::new());
    // What nothing explains is most often long.
    while let Some(longest) = (0..left.samples.len()).max_by_key(|&k| left.samples[k].len()) {
        let stretch = left.samples.swap_remove(longest);
        // Short ones, and what only cracks tell, say nothing: pixels do.
        let is_told = |sample: &Sample| sample.sigma < tuning::CRACK_SIGMA;
        if stretch.len() < SHORTEST || !stretch.iter().any(is_told) {
            continue;
        }
        stretches.push(stretch);
        let part = Part::new(vec![parts.len()], Vec::new(), &stretches, heap);
        if let Some((cut, halves)) = cut(stretches.last()?, part.bits, &left, heap) {
            stretches.pop();
            left.samples.extend(halves);
            left.cuts.push(cut);
            continue;
        }
        if part.outline.is_none() && part.bits > 2.0 * most {
            return None;
        }
        parts.push(part);
        if stretches.len() > MOST_STRETCHES {
            return None;
        }
    }
    join(&mut parts, &stretches, heap);
    Some(Shared { parts, cuts: left.cuts, stretches })
}

/// Bits of so many windows as a polygon.
fn polygon(count: usize, ruler: &Ruler) -> f64 {
    2.0 * count as f64 * ruler.number(POLYGON_SIGMA)
}

/// Where a stretch is two that cost less than it does, `whole` bits, and these.
#[inline(never)]
fn cut(stretch: &[Sample], whole: f64, left: &Stretches, heap: &Heap<'_>) -> Option<(Vec2<f64>, Vec<Vec<Sample>>)> {
    let price = |stretch: &Vec<Sample>| Part::new(vec![0], Vec::new(), core::slice::from_ref(stretch), heap).bits;
    if whole < WORTH_CUTTING {
        return None;
    }
    let halves = |stretch: &[Sample], k: usize| {
        let halves = left.halves(stretch, stretch[k].point);
        // What nobody explains then costs what it does as a polygon.
        let left_out = stretch.len() - halves.iter().map(Vec::len).sum::<usize>();
        (halves.iter().map(price).sum::<f64>() + polygon(left_out, heap.ruler), k, halves)
    };
    // Few windows tell where.
    let every = stretch.len().div_ceil(FIRST_LOOKS);
    let few: Vec<Sample> = stretch.iter().step_by(every).copied().collect();
    let best = |places: &mut dyn Iterator<Item = usize>| {
        places.map(|k| halves(&few, k)).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k, _)| k)
    };
    let near = best(&mut (0..few.len()).step_by(STEP))?;
    let near = best(&mut (near.saturating_sub(STEP - 1)..(near + STEP).min(few.len())))?;
    let (bits, k, halves) = halves(stretch, every * near);
    (bits < whole).then(|| (stretch[k].point, halves))
}

/// Joins parts as long as that makes the description shorter.
#[inline(never)]
fn join(parts: &mut Vec<Part>, stretches: &[Vec<Sample>], heap: &Heap<'_>) {
    // The first stretches of two parts, the bits that joining them costs more, and the part that they make.
    let mut pairs: Vec<([usize; 2], f64, Part)> = Vec::new();
    loop {
        for (k, a) in parts.iter().enumerate() {
            for b in parts[..k].iter().filter(|b| a.may_join(b)) {
                let key = [a.stretches[0], b.stretches[0]];
                if pairs.iter().any(|pair| pair.0 == key) {
                    continue;
                }
                let both = a.stretches.iter().chain(&b.stretches).copied().collect();
                let joined = Part::new(both, Vec::new(), stretches, heap);
                let is_shorter = joined.bits < a.bits + b.bits && joined.outline.is_some();
                // What is of no outline by itself goes where it costs least, whatever it cost before.
                let more = if is_shorter { joined.bits - a.known() - b.known() } else { f64::INFINITY };
                pairs.push((key, more, joined));
            }
        }
        let best = (0..pairs.len()).min_by(|&a, &b| pairs[a].1.total_cmp(&pairs[b].1));
        let Some(best) = best.filter(|&best| pairs[best].1 < f64::INFINITY) else { return };
        let (key, _, joined) = pairs.swap_remove(best);
        let is_part = |stretch: usize| key.contains(&stretch);
        pairs.retain(|pair| !pair.0.iter().any(|&stretch| is_part(stretch)));
        parts.retain(|part| !is_part(part.stretches[0]));
        parts.push(joined);
    }
}
