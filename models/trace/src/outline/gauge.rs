//! One curve of a chain, ready to be held against many samples: what it misses each by, and the slopes of that.

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::chain::{Chain, Curve};
use super::cubic::{at, basis, nearer, unit};
use super::track::LEAST_COSINE;
use crate::sample::Sample;

/// Most numbers that a curve has: four points.
pub(super) const MOST_NUMBERS: usize = 8;

/// A curve, and what all samples need of it.
pub(super) struct Gauge {
    form: Form,
    /// Of each of the curve's numbers: its place among all numbers of the chain, rising; those of both ends are among them.
    places: [usize; MOST_NUMBERS],
    count: usize,
    /// Where the numbers of the first point, those between the points, and those of the last point stand in `places`.
    slots: [usize; 3],
}

enum Form {
    Cubic([Vec2<f64>; 4]),
    /// A line or an arc, from its middle.
    Circle {
        middle: Vec2<f64>,
        chord: Vec2<f64>,
        bulge: f64,
        is_arc: bool,
    },
}

impl Gauge {
    /// Curve `k` of a chain whose numbers stand at `places`.
    pub(super) fn of(chain: &Chain, k: usize, places: &[usize]) -> Self {
        let next = chain.next(k);
        let (first, last) = (places[k], places[next]);
        let own = chain.curves[k].number_count();
        // The curve that closes a ring ends at its first number, and one that is the whole ring ends where it starts.
        let (slots, count) = match last.cmp(&first) {
            core::cmp::Ordering::Less => ([2, 4, 0], own + 4),
            core::cmp::Ordering::Equal => ([0, 2, 0], own + 2),
            core::cmp::Ordering::Greater => ([0, 2, own + 2], own + 4),
        };
        let mut gauge = Self { form: Form::of(chain, k), places: [0; MOST_NUMBERS], count, slots };
        for axis in 0..2 {
            gauge.places[slots[0] + axis] = first + axis;
            gauge.places[slots[2] + axis] = last + axis;
        }
        for number in 0..own {
            gauge.places[slots[1] + number] = first + 2 + number;
        }
        gauge
    }

    /// Places of the curve's numbers, rising.
    pub(super) fn places(&self) -> &[usize] {
        &self.places[..self.count]
    }

    /// By how much the curve passes `sample` along its axis, in its sigmas, and the slopes of that by the numbers at [`Self::places`]. `t` is
    /// the sample's parameter on a cubic, made better. None where the curve has no length.
    #[inline]
    pub(super) fn misfit(&self, sample: &Sample, t: &mut f64) -> Option<(f64, [f64; MOST_NUMBERS])> {
        let mut slopes = [0.0; MOST_NUMBERS];
        let [from, own, to] = self.slots;
        let mut add = |slot: usize, slope: Vec2<f64>| {
            slopes[slot] += slope.x;
            slopes[slot + 1] += slope.y;
        };
        match &self.form {
            Form::Cubic(cubic) => {
                *t = nearer(cubic, sample.point, *t);
                let (place, velocity) = at(cubic, *t);
                let across = unit(velocity)?.perp();
                let across = across / (held(across.dot(sample.axis), 1.0) * sample.sigma);
                let share = basis(*t);
                for (share, slot) in share.into_iter().zip([from, own, own + 2, to]) {
                    add(slot, across * share);
                }
                Some(((place - sample.point).dot(across), slopes))
            }
            // The circle through both ends is where g = bulge (|q|^2 - |c|^2 / 4) + (bulge^2 - 1) / 2 (c x q) is 0: c the chord, q from its
            // middle to the point. At bulge 0 it is the straight line: no case of its own.
            &Form::Circle { middle, chord, bulge, is_arc } => {
                let q = sample.point - middle;
                let (quarter, cross) = (q.length_squared() - 0.25 * chord.length_squared(), chord.cross(q));
                let factor = 0.5 * (bulge * bulge - 1.0);
                let g = bulge * quarter + factor * cross;
                let by_q = q * (2.0 * bulge) + chord.perp() * factor;
                let by_chord = chord * (-0.5 * bulge) - q.perp() * factor;
                let steepness = by_q.length_squared().sqrt();
                let along = held(by_q.dot(sample.axis), steepness) * sample.sigma;
                if steepness <= 0.0 || !along.is_finite() {
                    return None;
                }
                let scale = -1.0 / along;
                add(from, (by_q * -0.5 - by_chord) * scale);
                add(to, (by_q * -0.5 + by_chord) * scale);
                if is_arc {
                    slopes[own] = (quarter + bulge * cross) * scale;
                }
                Some((g * scale, slopes))
            }
        }
    }
}

impl Form {
    fn of(chain: &Chain, k: usize) -> Self {
        let [from, to] = [k, chain.next(k)].map(|point| chain.points[point]);
        let circle = |bulge, is_arc| Self::Circle { middle: (from + to) * 0.5, chord: to - from, bulge, is_arc };
        match chain.curves[k] {
            Curve::Line => circle(0.0, false),
            Curve::Arc(bulge) => circle(bulge, true),
            Curve::Cubic([a, b]) => Self::Cubic([from, a, b, to]),
        }
    }
}

/// A component of a vector of given length, away from 0.
fn held(component: f64, length: f64) -> f64 {
    let least = LEAST_COSINE * length;
    if component.abs() >= least { component } else { least.copysign(component) }
}
