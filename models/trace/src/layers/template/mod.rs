//! How the outline of a thing lies on what is seen of another one, in another place and size.
//!
//! Three straight stretches of what is seen tell of a shift and a scale, each on a side of the outline; where there are not so many, two and a
//! place beside them, at a corner that hides more than it shows. What agrees best with a few places is refined on all.

#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::geometry::{LineSegment, Similarity};
use dvp_core::sort;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::elimination::solve;
use crate::sample::Sample;
use crate::tuning;

/// Straight stretches of a boundary that are held against a template first: three of them make a guess.
const STRETCHES: usize = 6;
/// Stretches that tell by themselves: one of them may be of something else.
const ENOUGH: usize = 4;
/// Edges of a template that each of them may be of: the longest ones.
const LIKE: usize = 3;
/// Places beside them that are held against a template, too: where little is seen, two sides and a corner of it do.
const LOOSE: usize = 4;
/// Pixels that a straight stretch may be off its direction.
const STRAIGHT: f64 = 0.5;
/// Fewest samples of a straight stretch.
const FEWEST: usize = 3;
/// Sine of the angle up to which a stretch may be an edge of a template: of five windows in a row it is known to a few degrees.
const ALIKE: f64 = 0.1;
/// Most that one thing is larger than another.
const MOST_SCALE: f64 = 4.0;
/// Squared pixels that a place may be off before how far counts no more.
const FAR2: f64 = 0.25;
/// Share of the places that may be of something else.
const MOST_OTHER: f64 = 1.0 / 3.0;
/// Most steps of the refinement.
const STEPS: usize = 6;
/// Squares of standard deviations: a refinement that gains less in a step has ended.
const LEAST_GAIN: f64 = 0.01;

/// What is seen of the boundary of a thing.
pub(super) struct Seen {
    pub(super) samples: Vec<Sample>,
    /// The longest straight stretches of it, at most [`STRETCHES`].
    stretches: Vec<Stretch>,
    /// Places beside them, at most [`LOOSE`].
    loose: Vec<Vec2<f64>>,
}

/// A straight stretch of a boundary: its direction, and its first, middle and last place.
struct Stretch {
    direction: Vec2<f64>,
    places: [Vec2<f64>; 3],
    count: usize,
}

/// How an outline is moved: made larger about the origin, and then shifted.
#[derive(Clone, Copy)]
struct Move {
    scale: f64,
    shift: Vec2<f64>,
}

/// A place and the sides of an outline that it may lie on.
type Like<'a> = (Vec2<f64>, Vec<&'a LineSegment<f64>>);

impl Seen {
    /// What samples show of a boundary; `sides`: of the outlines that were drawn through them.
    pub(super) fn new(samples: Vec<Sample>, sides: &[LineSegment<f64>]) -> Self {
        // Those of a curve are short.
        let sides: Vec<&LineSegment<f64>> = sides.iter().filter(|side| side.along.length() >= FEWEST as f64).collect();
        let mut on_side: Vec<Vec<(f64, Vec2<f64>)>> = sides.iter().map(|_| Vec::new()).collect();
        let mut beside = Vec::new();
        for sample in &samples {
            let offs = sides.iter().map(|side| side.nearest(sample.point)).enumerate();
            let nearest = offs.min_by(|a, b| a.1.offset.length_squared().total_cmp(&b.1.offset.length_squared()));
            match nearest {
                Some((at, nearest)) if nearest.distance() < STRAIGHT => on_side[at].push((nearest.share, sample.point)),
                _ => beside.push(sample.point),
            }
        }
        let stretch = |(side, mut on): (&&LineSegment<f64>, Vec<(f64, Vec2<f64>)>)| {
            sort::ascending(&mut on, |on| on.0);
            let [first, .., last] = on[..] else { return None };
            let places = [first, on[on.len() / 2], last].map(|on| on.1);
            let direction = side.along.normalized()?;
            (on.len() >= FEWEST).then_some(Stretch { direction, places, count: on.len() })
        };
        let mut stretches: Vec<Stretch> = sides.iter().zip(on_side).filter_map(stretch).collect();
        sort::descending(&mut stretches, |stretch| stretch.count as f64);
        stretches.truncate(STRETCHES);
        let step = beside.len().div_ceil(LOOSE).max(1);
        Self { samples, stretches, loose: beside.into_iter().step_by(step).collect() }
    }

    /// The shift and scale with which `edges` agree with it, and by how much they miss it, squares of standard deviations, each up to a bound; none
    /// where they do not.
    pub(super) fn placed(&self, edges: &[LineSegment<f64>]) -> Option<(Similarity<f64>, f64)> {
        let (moved, misfit) = refined(self.guess(edges)?, edges, &self.samples)?;
        let map = Similarity { turn: Vec2::new(moved.scale, 0.0), translation: moved.shift, ..Similarity::identity() };
        Some((map, misfit))
    }

    /// The move that agrees with most of a few places.
    fn guess(&self, edges: &[LineSegment<f64>]) -> Option<Move> {
        let stretches = self.stretches.iter().flat_map(|stretch| stretch.places);
        let places: Vec<Vec2<f64>> = stretches.chain(self.loose.iter().copied()).collect();
        let like: Vec<Like<'_>> = self.stretches.iter().map(|stretch| stretch.like(edges)).collect();
        let mut best = Best { edges, off: FAR2 * MOST_OTHER * places.len() as f64, places, moved: None };
        for (k, c) in like.iter().enumerate() {
            for (j, b) in like[..k].iter().enumerate() {
                like[..j].iter().for_each(|a| best.ask([a, b, c]));
            }
        }
        // Where sides could tell, nothing else is asked.
        if best.moved.is_none() && like.len() < ENOUGH {
            let longest = longest(edges.iter(), LIKE * LIKE);
            for c in self.loose.iter().map(|&place| (place, longest.clone())) {
                for (k, b) in like.iter().enumerate() {
                    like[..k].iter().for_each(|a| best.ask([a, b, &c]));
                }
            }
        }
        best.moved
    }
}

impl Stretch {
    /// Its middle, and the longest of some edges that have its direction.
    fn like<'a>(&self, edges: &'a [LineSegment<f64>]) -> Like<'a> {
        let is_like = |edge: &&LineSegment<f64>| {
            edge.along.normalized().is_some_and(|along| along.cross(self.direction).abs() < ALIKE)
        };
        (self.places[1], longest(edges.iter().filter(is_like), LIKE))
    }
}

/// The longest of some edges, at most so many.
fn longest<'a>(edges: impl Iterator<Item = &'a LineSegment<f64>>, most: usize) -> Vec<&'a LineSegment<f64>> {
    let mut edges: Vec<_> = edges.collect();
    sort::descending(&mut edges, |edge| edge.along.length_squared());
    edges.truncate(most);
    edges
}

/// The best of the moves that were asked for.
struct Best<'a> {
    edges: &'a [LineSegment<f64>],
    places: Vec<Vec2<f64>>,
    moved: Option<Move>,
    /// Squared pixels by which it is off all places, each up to [`FAR2`].
    off: f64,
}

impl Best<'_> {
    /// Asks for the moves that bring an edge to each of three places.
    fn ask(&mut self, [(at_a, like_a), (at_b, like_b), (at_c, like_c)]: [&Like<'_>; 3]) {
        for a in like_a {
            for b in like_b {
                for c in like_c {
                    let moved = Move::through([(*at_a, a), (*at_b, b), (*at_c, c)]);
                    let off = moved.map_or(self.off, |moved| moved.off(self.edges, &self.places, self.off));
                    if off < self.off {
                        (self.moved, self.off) = (moved, off);
                    }
                }
            }
        }
    }
}

impl Move {
    /// That of these numbers; none if it makes things too large or too small.
    fn new([scale, x, y]: [f64; 3]) -> Option<Self> {
        (1.0 / MOST_SCALE..=MOST_SCALE).contains(&scale).then_some(Self { scale, shift: Vec2::new(x, y) })
    }

    /// The move that brings three edges to three points.
    fn through(three: [(Vec2<f64>, &LineSegment<f64>); 3]) -> Option<Self> {
        let mut matrix = [[0.0; 3]; 3];
        let mut right = [0.0; 3];
        for (k, (point, edge)) in three.into_iter().enumerate() {
            let normal = edge.along.perp();
            matrix[k] = [normal.dot(edge.from), normal.x, normal.y];
            right[k] = normal.dot(point);
        }
        let moved = Self::new(solve(matrix, right)?)?;
        // On the edges themselves, not on what they would go on as.
        let is_on = |(point, edge): &(Vec2<f64>, &LineSegment<f64>)| {
            let far = (moved.back(*point) - edge.from).dot(edge.along) * edge.inverse_squared;
            (0.0..=1.0).contains(&far)
        };
        three.iter().all(is_on).then_some(moved)
    }

    /// The point that it brings to this one.
    fn back(&self, point: Vec2<f64>) -> Vec2<f64> {
        (point - self.shift) / self.scale
    }

    /// The edge that lies nearest to a point, and from there to the point.
    fn nearest<'a>(
        &self,
        edges: &'a [LineSegment<f64>],
        point: Vec2<f64>,
    ) -> Option<(&'a LineSegment<f64>, Vec2<f64>)> {
        let at = self.back(point);
        let mut nearest = None;
        let mut least = f64::INFINITY;
        for edge in edges {
            let offset = edge.nearest(at).offset;
            let off2 = offset.length_squared();
            if off2 < least {
                (nearest, least) = (Some((edge, offset)), off2);
            }
        }
        let (edge, offset) = nearest?;
        Some((edge, offset * self.scale))
    }

    /// Squared pixels by which it is off places, each up to [`FAR2`]; no more are asked once they are `limit`.
    fn off(&self, edges: &[LineSegment<f64>], places: &[Vec2<f64>], limit: f64) -> f64 {
        let mut sum = 0.0;
        let far2 = FAR2 / (self.scale * self.scale);
        for &point in places {
            let at = self.back(point);
            let off2 = edges.iter().fold(far2, |off2, edge| off2.min(edge.nearest(at).offset.length_squared()));
            sum += off2 * self.scale * self.scale;
            if sum >= limit {
                break;
            }
        }
        sum
    }
}

/// The same, nearest to all samples; and by how much it misses them, squares of standard deviations, each up to a bound.
fn refined(mut moved: Move, edges: &[LineSegment<f64>], samples: &[Sample]) -> Option<(Move, f64)> {
    let (mut before, mut steps) = (f64::INFINITY, 0);
    loop {
        let mut matrix = [[0.0; 3]; 3];
        let mut right = [0.0; 3];
        let mut chi2 = 0.0;
        for sample in samples {
            let (edge, off) = moved.nearest(edges, sample.point)?;
            let normal = edge.along.normalized()?.perp();
            // What is known is the position along the axis of the window.
            let sigma = (sample.sigma * normal.dot(sample.axis).abs()).hypot(tuning::RENDERER_SIGMA);
            let sigmas = off.length() / sigma;
            // Windows at the ends of what is seen have a third thing in them: what is off by more tells nothing.
            let weight = (tuning::OUTLINE_HUBER / sigmas.max(tuning::OUTLINE_HUBER)).powi(2);
            chi2 += weight * sigmas * sigmas;
            let on = (sample.point - off - moved.shift) / moved.scale;
            let row = [normal.dot(on), normal.x, normal.y].map(|value| value / sigma);
            for i in 0..3 {
                right[i] += weight * row[i] * off.dot(normal) / sigma;
                for j in 0..3 {
                    matrix[i][j] += weight * row[i] * row[j];
                }
            }
        }
        if steps == STEPS || (before - chi2).abs() < LEAST_GAIN {
            return Some((moved, chi2));
        }
        (before, steps) = (chi2, steps + 1);
        let [scale, x, y] = solve(matrix, right)?;
        moved = Move::new([moved.scale + scale, moved.shift.x + x, moved.shift.y + y])?;
    }
}
