//! A row of lines, arcs and cubics as numbers.

use alloc::vec::Vec;

use dvp_core::Vec2;

use crate::sample::Sample;

/// How the outline leads from one point to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Curve {
    Line,
    /// Its bulge: tan(sweep / 4).
    Arc(f64),
    /// Its two control points.
    Cubic([Vec2<f64>; 2]),
}

/// Curves from point to point; in a closed chain the last leads back to the first point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Chain {
    pub(super) points: Vec<Vec2<f64>>,
    pub(super) curves: Vec<Curve>,
    /// Of each curve: its first sample; counted on past the last sample of the track, so that they rise.
    pub(super) firsts: Vec<usize>,
    /// One past the last sample of an open chain.
    pub(super) end: usize,
    pub(super) closed: bool,
}

/// Slopes of a misfit: places of numbers and the derivatives by them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slopes {
    entries: [(usize, f64); 14],
    len: usize,
}

impl Slopes {
    pub(super) fn push(&mut self, place: usize, slope: f64) {
        if let Some(entry) = self.entries.get_mut(self.len) {
            *entry = (place, slope);
            self.len += 1;
        }
    }

    pub(super) fn entries(&self) -> &[(usize, f64)] {
        &self.entries[..self.len]
    }
}

impl Curve {
    pub(super) fn number_count(self) -> usize {
        match self {
            Self::Line => 0,
            Self::Arc(_) => 1,
            Self::Cubic(_) => 4,
        }
    }
}

impl Chain {
    /// The point after curve `k`.
    pub(super) fn next(&self, k: usize) -> usize {
        if k + 1 < self.points.len() { k + 1 } else { 0 }
    }

    /// Where the numbers of each point start; those of the curve that leaves it follow. Last, how many there are.
    pub(super) fn places(&self) -> Vec<usize> {
        let mut place = 0;
        let mut places = Vec::with_capacity(self.points.len() + 1);
        for k in 0..self.points.len() {
            places.push(place);
            place += 2 + self.curves.get(k).map_or(0, |curve| curve.number_count());
        }
        places.push(place);
        places
    }

    /// Becomes another chain, in the room that is there.
    pub(super) fn copy(&mut self, other: &Self) {
        self.points.clone_from(&other.points);
        self.curves.clone_from(&other.curves);
        self.firsts.clone_from(&other.firsts);
        (self.end, self.closed) = (other.end, other.closed);
    }

    /// Adds a change to all numbers.
    pub(super) fn shift(&mut self, change: &[f64]) {
        let mut change = change.iter().copied();
        let mut next = || change.next().unwrap_or(0.0);
        for k in 0..self.points.len() {
            self.points[k] += Vec2::new(next(), next());
            match self.curves.get_mut(k) {
                Some(Curve::Arc(bulge)) => *bulge += next(),
                Some(Curve::Cubic(controls)) => {
                    controls.iter_mut().for_each(|control| *control += Vec2::new(next(), next()));
                }
                Some(Curve::Line) | None => {}
            }
        }
    }

    /// The four points of curve `k` if it is a cubic.
    pub(super) fn cubic(&self, k: usize) -> Option<[Vec2<f64>; 4]> {
        match self.curves[k] {
            Curve::Cubic([a, b]) => Some([self.points[k], a, b, self.points[self.next(k)]]),
            _ => None,
        }
    }

    /// The directions, of length 1, in which curve `k` leaves and arrives; none without length.
    pub(super) fn directions(&self, k: usize) -> Option<[Vec2<f64>; 2]> {
        let [from, to] = [k, self.next(k)].map(|point| self.points[point]);
        let chord = (to - from).normalized();
        match self.curves[k] {
            Curve::Line => chord.map(|chord| [chord; 2]),
            Curve::Arc(bulge) => {
                // Half the sweep, by which the ends point away from the chord, is twice the angle whose tangent is the bulge.
                let half = Vec2::new(1.0 - bulge * bulge, 2.0 * bulge) / (1.0 + bulge * bulge);
                chord.map(|chord| [chord.turned(Vec2::new(half.x, -half.y)), chord.turned(half)])
            }
            Curve::Cubic([a, b]) => {
                let leave = (a - from).normalized().or_else(|| (b - from).normalized()).or(chord)?;
                let arrive = (to - b).normalized().or_else(|| (to - a).normalized()).or(chord)?;
                Some([leave, arrive])
            }
        }
    }
}

impl Sample {
    /// Whether the window of the sample may hold a corner: then it tells of both sides.
    pub(super) fn holds(&self, corner: Vec2<f64>) -> bool {
        let offset = self.point - corner;
        !self.is_exact && offset.cross(self.axis).abs() < 0.55 && offset.dot(self.axis).abs() < 2.0
    }
}
