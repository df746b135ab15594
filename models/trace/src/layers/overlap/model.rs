//! Straight things without a corner inward that the picture shows.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::contour::signed_area;
use dvp_core::geometry::{Bounds, LineSegment};
use dvp_core::shape::{PathRing, Piece, Segment};
use dvp_core::sort;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::super::complete::Completed;
use super::stretch::LEAST_TURN;
use crate::outline::{Outline, OutlineShape};
use crate::ruler::Ruler;
use crate::stroke::piece::{direction, pieces};
use crate::tuning;

/// Most sides of a model.
const MOST_SIDES: usize = 8;
/// Shortest side of a model, pixels: between its corners three windows tell its direction.
const SHORTEST_SIDE: f64 = 5.0;
/// Most kinds, those of which there are most things.
const MOST_KINDS: usize = 4;
/// Sides that differ by less (pixels) may be of one model.
const ALIKE: f64 = 0.3;
/// Sine of the angle between two parts of one side, at most.
const STRAIGHT: f64 = 0.05;
/// Sides whose lengths are off by less (pixels) from whole numbers were put on the grid of pixels.
const ON_GRID: f64 = 0.02;

/// A straight thing.
#[derive(Clone)]
pub(super) struct Model {
    pub(super) shape: OutlineShape,
    /// Its sides, the thing on the right of each.
    pub(super) sides: Vec<LineSegment<f64>>,
    pub(super) bounds: Bounds<f64>,
    /// Whether one of them is seen whole.
    pub(super) is_whole: bool,
    /// By how many pixels its sides may be longer than those of the thing that is seen.
    pub(super) longer: f64,
    /// How many things are like it.
    count: usize,
}

/// The kinds of what is painted in one color, the rarest first, each as the models that may be of it: what is seen whole, and what is seen but for a
/// corner. Of two models that explain as much the later is better.
pub(super) fn kinds<'a>(painted: impl Iterator<Item = &'a Completed>) -> Vec<Vec<Model>> {
    let mut models: Vec<Model> = Vec::new();
    for completed in painted.filter(|completed| completed.agrees) {
        let whole = Model::whole(completed);
        let hidden = completed.outlines.iter().flat_map(Model::but_for_a_corner);
        for model in whole.into_iter().chain(hidden) {
            match models.iter_mut().find(|other| other.is_like(&model)) {
                Some(other) if other.is_whole || !model.is_whole => other.count += 1,
                Some(other) => *other = Model { count: other.count + 1, ..model },
                None => models.push(model),
            }
        }
    }
    sort::descending(&mut models, |model| (2 * model.count + usize::from(model.is_whole)) as f64);
    models.truncate(MOST_KINDS);
    let kind = |model: &Model| model.on_grid().into_iter().chain([model.clone()]).collect();
    models.iter().rev().map(kind).collect()
}

impl Model {
    /// A polygon, the thing on the right of its sides; none if it turns inward anywhere, or has many sides or short ones.
    fn new(corners: &[[f64; 2]]) -> Option<Self> {
        let sides: Vec<LineSegment<f64>> = LineSegment::closed(corners).collect();
        let next = sides.iter().cycle().skip(1);
        let is_outward = sides.iter().zip(next).all(|(side, next)| side.along.cross(next.along) > 0.0);
        let are_told = sides.len() <= MOST_SIDES && sides.iter().all(|side| side.along.length() >= SHORTEST_SIDE);
        let ring = PathRing { points: corners.to_vec(), segments: alloc::vec![Segment::Line; corners.len()] };
        let shape = rectangle(&sides).unwrap_or(OutlineShape::Path(ring));
        let bounds = Bounds::of_vertices(corners)?;
        (is_outward && are_told).then_some(Self { shape, sides, bounds, is_whole: false, longer: 0.0, count: 1 })
    }

    /// What is seen whole.
    fn whole(completed: &Completed) -> Option<Self> {
        let [outline] = &completed.outlines[..] else { return None };
        let is_round = matches!(outline.shape, OutlineShape::Circle { .. } | OutlineShape::Ellipse { .. });
        let mut corners: Vec<[f64; 2]> = completed.sides().iter().map(|side| side.from.to_array()).collect();
        if signed_area(&corners) < 0.0 {
            corners.reverse();
        }
        let model = Self::new(&corners).filter(|_| !is_round)?;
        Some(Self { shape: outline.shape.clone(), is_whole: true, ..model })
    }

    /// What parts of an outline show but for one corner, where the lines before and after them meet, or for the middle of one side.
    fn but_for_a_corner(outline: &Outline) -> Vec<Self> {
        let OutlineShape::Path(ring) = &outline.shape else { return Vec::new() };
        let pieces = pieces(ring);
        let count = pieces.len();
        let at = |k: usize| &pieces[k % count];
        // Whether a side leads to a corner outward.
        let turns: Vec<bool> = (0..count)
            .map(|k| {
                let are_lines = [at(k), at(k + 1)].iter().all(|piece| matches!(piece, Piece::Line { .. }));
                are_lines && direction(at(k), 1.0).cross(direction(at(k + 1), 0.0)) > LEAST_TURN
            })
            .collect();
        let firsts = (0..count).filter(|&k| turns[k] && !turns[(k + count - 1) % count]);
        let model = |first: usize| {
            let corners = (first..first + count).take_while(|&k| turns[k % count]);
            let mut corners: Vec<[f64; 2]> = corners.map(|k| at(k).to().to_array()).collect();
            let (before, after) = (at(first), at(first + corners.len()));
            // Of a side whose middle is hidden both ends are seen.
            let is_one_side = direction(before, 0.0).cross(direction(after, 1.0)).abs() < STRAIGHT;
            if !is_one_side {
                corners.push(meeting(before, after)?.to_array());
            }
            Self::new(&corners)
        };
        firsts.filter_map(model).collect()
    }

    /// Those that differ by a pixel, of a rectangle that a program may have put on the grid of pixels: equal things do so there.
    fn on_grid(&self) -> Vec<Self> {
        let OutlineShape::Rectangle { center, size: [width, height], corner_radius: 0.0, angle: 0.0 } = self.shape
        else {
            return Vec::new();
        };
        if [width, height].iter().any(|side| (side - side.round()).abs() > ON_GRID) {
            return Vec::new();
        }
        let other = |k: i32| {
            let half = Vec2::new(width + f64::from(k % 3 - 1), height + f64::from(k / 3 - 1)) * 0.5;
            let corner = |[x, y]: [f64; 2]| (center + Vec2::new(x * half.x, y * half.y)).to_array();
            Self::new(&[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(corner))
        };
        let others = (0..9).filter(|&k| k != 4).filter_map(other);
        others.map(|model| Self { is_whole: self.is_whole, longer: 1.0, ..model }).collect()
    }

    /// Whether another one is the same but for its place.
    fn is_like(&self, other: &Self) -> bool {
        let has = |side: &LineSegment<f64>| other.sides.iter().any(|other| (other.along - side.along).length() < ALIKE);
        self.sides.len() == other.sides.len() && self.sides.iter().all(has)
    }

    /// Bits of what it is: none if it is told where it is seen whole.
    pub(super) fn bits(&self, ruler: &Ruler) -> f64 {
        let numbers = if self.is_whole { 0 } else { 2 * self.sides.len() - 2 };
        numbers as f64 * ruler.number(tuning::RENDERER_SIGMA)
    }
}

/// Sides as those of a rectangle, if they are about at right angles.
fn rectangle(sides: &[LineSegment<f64>]) -> Option<OutlineShape> {
    let sides: &[LineSegment<f64>; 4] = sides.try_into().ok()?;
    // From the one that points right, so that the angle is small.
    let right = (0..4).max_by(|&a, &b| sides[a].along.x.total_cmp(&sides[b].along.x))?;
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| &sides[(right + k) % 4]);
    let (along, down) = (a.along - c.along, b.along - d.along);
    let is_right =
        (a.along + c.along).length() < ALIKE && along.dot(down).abs() < ALIKE * (along.length() + down.length());
    let center = [a, b, c, d].iter().fold(Vec2::default(), |sum, side| sum + side.from * 0.25);
    let size = [0.5 * along.length(), 0.5 * down.length()];
    let angle = along.y.atan2(along.x);
    is_right.then_some(OutlineShape::Rectangle { center, size, corner_radius: 0.0, angle })
}

/// Where the line of a side, followed back, meets that of another, followed on; none if that is not beyond both.
fn meeting(before: &Piece<f64>, after: &Piece<f64>) -> Option<Vec2<f64>> {
    let (end, back) = (before.to(), before.from() - before.to());
    let (start, on) = (after.from(), after.to() - after.from());
    let cross = back.cross(on);
    let (s, t) = ((start - end).cross(on) / cross, (start - end).cross(back) / cross);
    (s >= 1.0 && t >= 1.0 && s.is_finite()).then_some(end + back * s)
}
