//! Outlines by the rows of pixels that they come near: of a long outline little is near any pixel.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::numbers::{Curves, FAR, square};

/// The lines that some outlines are made of, by row.
pub(super) struct Rows<'a> {
    /// Of each outline the curves, which close it.
    curves: &'a [Curves],
    /// The uppermost row.
    first: usize,
    /// Of each row, the lines that are less than [`FAR`] above or below the middles of its pixels.
    lines: Vec<Vec<Line>>,
}

/// A line from point to point of an outline.
#[derive(Clone, Copy)]
struct Line {
    ends: [Vec2<f64>; 2],
    place: Place,
}

/// Where in outlines a line is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place {
    pub(super) ring: usize,
    pub(super) curve: usize,
    pub(super) line: usize,
}

impl<'a> Rows<'a> {
    /// What the rows of pixels `rows` need; others are left out.
    pub(super) fn of(curves: &'a [Curves], rows: core::ops::Range<usize>) -> Self {
        let mut lines = vec![Vec::new(); rows.len()];
        for (place, ends) in places(curves) {
            let [top, bottom] = [ends[0].y.min(ends[1].y), ends[0].y.max(ends[1].y)];
            let row = |y: f64| (y - rows.start as f64).max(0.0).min(rows.len() as f64) as usize;
            let near = row(top - FAR - 0.5)..row((bottom + FAR + 0.5).ceil());
            lines[near].iter_mut().for_each(|row| row.push(Line { ends, place }));
        }
        Self { curves, first: rows.start, lines }
    }

    /// Those near the middle of a pixel.
    fn around(&self, at: Vec2<f64>) -> impl Iterator<Item = Line> {
        let row = (at.y as usize).checked_sub(self.first).and_then(|row| self.lines.get(row));
        row.into_iter().flatten().copied()
    }

    /// How far the nearest outline is from the middle of a pixel, pixels, [`FAR`] at most; negative if the middle is inside (even-odd).
    pub(super) fn depth(&self, at: Vec2<f64>) -> f64 {
        let Vec2 { x, y } = at;
        let (mut nearest, mut is_inside) = (FAR * FAR, false);
        for Line { ends: [from, to], .. } in self.around(at) {
            if (from.y <= y) != (to.y <= y) && from.x + (y - from.y) / (to.y - from.y) * (to.x - from.x) <= x {
                is_inside = !is_inside;
            }
            nearest = nearest.min(square(from, to, at));
        }
        if is_inside { -nearest.sqrt() } else { nearest.sqrt() }
    }

    /// The line that is nearest to the middle of a pixel.
    pub(super) fn nearest(&self, at: Vec2<f64>) -> Place {
        let mut nearest = (FAR * FAR, None);
        for Line { ends: [from, to], place } in self.around(at) {
            let square = square(from, to, at);
            if square < nearest.0 {
                nearest = (square, Some(place));
            }
        }
        // What is farther away may be in any row.
        nearest.1.unwrap_or_else(|| {
            let far = |&(_, [from, to]): &(Place, [Vec2<f64>; 2])| square(from, to, at);
            let nearest = places(self.curves).min_by(|a, b| far(a).total_cmp(&far(b)));
            nearest.map_or_else(Place::default, |(place, _)| place)
        })
    }
}

/// All lines, and where they are.
fn places(curves: &[Curves]) -> impl Iterator<Item = (Place, [Vec2<f64>; 2])> {
    curves.iter().enumerate().flat_map(|(ring, curves)| {
        curves.iter().enumerate().flat_map(move |(curve, points)| {
            let lines = points.windows(2).enumerate();
            lines.map(move |(line, pair)| (Place { ring, curve, line }, [pair[0], pair[1]]))
        })
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn rows_know_what_all_lines_know(
            points in prop::collection::vec((-4.0f64..24.0, -4.0f64..24.0), 3..12),
            [top, height] in [0usize..12, 1usize..12],
        ) {
            // Two outlines: one of curves with a line each, one that is a single curve.
            let points: Vec<Vec2<f64>> = points.into_iter().map(|(x, y)| Vec2::new(x, y)).collect();
            let closed: Vec<Vec2<f64>> = points.iter().chain(points.first()).copied().collect();
            let moved: Vec<Vec2<f64>> = closed.iter().map(|&point| point * 0.6 + Vec2::new(3.0, 1.0)).collect();
            let curves = vec![closed.windows(2).map(<[_]>::to_vec).collect(), vec![moved]];
            let rows = Rows::of(&curves, top..top + height);
            for at in (top..top + height).flat_map(|y| (0..24).map(move |x| Vec2::new(x as f64 + 0.5, y as f64 + 0.5))) {
                let all = || curves.iter().flatten().flat_map(|points| points.windows(2));
                let crossed = |pair: &&[Vec2<f64>]| {
                    let [from, to] = [pair[0], pair[1]];
                    (from.y <= at.y) != (to.y <= at.y)
                        && from.x + (at.y - from.y) / (to.y - from.y) * (to.x - from.x) <= at.x
                };
                let far = all().map(|pair| square(pair[0], pair[1], at)).fold(FAR * FAR, f64::min).sqrt();
                let sign = if all().filter(crossed).count() % 2 == 1 { -1.0 } else { 1.0 };
                prop_assert_eq!(rows.depth(at), sign * far);
                let Place { ring, curve, line } = rows.nearest(at);
                let least = all().map(|pair| square(pair[0], pair[1], at)).fold(f64::INFINITY, f64::min);
                let points = &curves[ring][curve];
                prop_assert_eq!(square(points[line], points[line + 1], at), least);
            }
        }
    }
}
