//! Which sets of objects share pixels.

use alloc::collections::BTreeSet;

use dvp_core::geometry::{Bounds, Vec2};
use dvp_core::sort;

/// Rows that are looked at per pixel, and most rows of all: overlaps that fall between two of them may be missed.
const ROWS_PER_PX: f64 = 2.0;
const MOST_ROWS: f64 = 2048.0;

/// Overlaps narrower than this, pixels, are not worth a color of their own.
const NARROWEST_PX: f64 = 0.05;

/// Most sets that are found, and most objects of one: each set becomes an element with a mask for all of its objects but one, and
/// many objects in one place have more sets than memory holds.
pub(super) const MOST_SETS: usize = 4096;
pub(super) const MOST_IN_SET: usize = 16;

/// What an object covers, pixels: closed polygons under the even-odd rule, fattened by `reach`.
pub(super) struct Body {
    pub(super) rings: Vec<Vec<Vec2<f64>>>,
    pub(super) reach: f64,
}

/// From left to right.
type Span = [f64; 2];

impl Body {
    fn bounds(&self) -> Option<Bounds<f64>> {
        let bounds = Bounds::of(self.rings.iter().flatten().copied())?;
        let reach = Vec2::new(self.reach, self.reach);
        Some(Bounds { min: bounds.min - reach, max: bounds.max + reach })
    }

    /// What is covered of a row, in order and without overlaps.
    fn spans(&self, y: f64, crossings: &mut Vec<f64>, spans: &mut Vec<Span>) {
        crossings.clear();
        spans.clear();
        for ring in &self.rings {
            let ends = ring.iter().skip(1).chain(ring.first());
            for (&from, &to) in ring.iter().zip(ends) {
                if (from.y > y) != (to.y > y) {
                    crossings.push(from.x + (to.x - from.x) * ((y - from.y) / (to.y - from.y)));
                }
                if self.reach > 0.0 {
                    spans.extend(near(from, to, y, self.reach));
                }
            }
        }
        crossings.sort_unstable_by(f64::total_cmp);
        spans.extend(crossings.as_chunks().0);
        sort::ascending(spans, |span| span[0]);
        spans.dedup_by(|next, span| {
            let meet = next[0] <= span[1];
            if meet {
                span[1] = span[1].max(next[1]);
            }
            meet
        });
    }
}

/// The part of a row within `reach` of an edge.
fn near(from: Vec2<f64>, to: Vec2<f64>, y: f64, reach: f64) -> Option<Span> {
    if y < from.y.min(to.y) - reach || y > from.y.max(to.y) + reach {
        return None;
    }
    let mut span = [f64::INFINITY, f64::NEG_INFINITY];
    let mut include = |x: f64| span = [span[0].min(x), span[1].max(x)];
    for end in [from, to] {
        let half = reach * reach - (y - end.y) * (y - end.y);
        if half >= 0.0 {
            include(end.x - half.sqrt());
            include(end.x + half.sqrt());
        }
    }
    if let Some(direction) = (to - from).normalized() {
        for side in [direction.perp() * reach, direction.perp() * -reach] {
            let (start, end) = (from + side, to + side);
            if (start.y > y) != (end.y > y) {
                include(start.x + (end.x - start.x) * ((y - start.y) / (end.y - start.y)));
            }
        }
    }
    (span[0] <= span[1]).then_some(span)
}

/// Sets of bodies that share pixels.
#[derive(Debug, PartialEq)]
pub(super) struct Shared {
    /// Smaller ones first.
    pub(super) sets: Vec<Vec<usize>>,
    /// Whether there are no others.
    pub(super) is_complete: bool,
}

/// The sets of two to [`MOST_IN_SET`] bodies that some point of a `width` x `height` image lies in, the upper [`MOST_SETS`] of them.
pub(super) fn shared_regions(bodies: &[&Body], width: f64, height: f64) -> Shared {
    let bounds: Vec<Option<Bounds<f64>>> = bodies.iter().map(|body| body.bounds()).collect();
    let meets_other = |k: usize| {
        let others = bounds.iter().enumerate().filter(|&(other, _)| other != k);
        others.filter_map(|(_, other)| Some((bounds[k]?, (*other)?))).any(|(a, b)| meet(&a, &b))
    };
    let candidates: Vec<(usize, Bounds<f64>)> =
        (0..bodies.len()).filter(|&k| meets_other(k)).filter_map(|k| Some((k, bounds[k]?))).collect();
    let (mut sets, mut is_complete) = (BTreeSet::new(), true);
    let step = (1.0 / ROWS_PER_PX).max(height / MOST_ROWS);
    let (mut crossings, mut spans, mut events) = (Vec::new(), Vec::new(), Vec::new());
    let mut y = 0.5 * step;
    while y < height && candidates.len() > 1 {
        events.clear();
        for &(k, bounds) in candidates.iter().filter(|(_, bounds)| (bounds.min.y..=bounds.max.y).contains(&y)) {
            if bounds.min.x < width && bounds.max.x > 0.0 {
                bodies[k].spans(y, &mut crossings, &mut spans);
                events.extend(spans.iter().flat_map(|&[left, right]| [(left, k), (right, k)]));
            }
        }
        y += step;
        sort::ascending(&mut events, |event| event.0);
        let mut inside = BTreeSet::new();
        for (here, next) in events.iter().zip(events.iter().skip(1)) {
            if !inside.remove(&here.1) {
                inside.insert(here.1);
            }
            let seen = next.0.min(width) - here.0.max(0.0);
            if inside.len() < 2 || seen <= NARROWEST_PX {
                continue;
            }
            if inside.len() > MOST_IN_SET {
                is_complete = false;
                continue;
            }
            let set: Vec<usize> = inside.iter().copied().collect();
            if sets.len() < MOST_SETS {
                sets.insert(set);
            } else if !sets.contains(&set) {
                is_complete = false;
            }
        }
    }
    let mut sets: Vec<Vec<usize>> = sets.into_iter().collect();
    sort::ascending(&mut sets, |set| set.len() as f64);
    Shared { sets, is_complete }
}

fn meet(a: &Bounds<f64>, b: &Bounds<f64>) -> bool {
    a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y
}
