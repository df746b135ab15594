//! A simple fit of lines and arcs, until the ladder's is there.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::{PathRing, Segment};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::ruler::Ruler;
use crate::sample::Sample;

fn split(points: &[Vec2<f64>], first: usize, last: usize, tolerance: f64, out: &mut Vec<(usize, Segment<f64>)>) {
    let (a, b) = (points[first], points[last]);
    let chord = b - a;
    let length = chord.length().max(1e-9);
    let mut worst = (0.0, first);
    for k in first + 1..last {
        let off = ((points[k] - a).cross(chord) / length).abs();
        if off > worst.0 {
            worst = (off, k);
        }
    }
    if worst.0 <= tolerance || last - first < 3 {
        out.push((last, Segment::Line));
        return;
    }
    let middle = points[(first + last) / 2];
    // The circle through both ends and the middle.
    let (p, q) = (middle - a, b - a);
    let d = 2.0 * p.cross(q);
    if d.abs() > 1e-9 {
        let center = Vec2::new(
            (q.y * p.length_squared() - p.y * q.length_squared()) / d,
            (p.x * q.length_squared() - q.x * p.length_squared()) / d,
        );
        let radius = center.length();
        let off = points[first..=last].iter().map(|&point| ((point - a - center).length() - radius).abs()).fold(0.0, f64::max);
        if off <= tolerance {
            // tan(sweep / 4) by the angle at the middle point: half the sweep and half a turn together.
            let half = (middle - a).cross(b - middle).atan2((middle - a).dot(b - middle));
            out.push((last, Segment::Arc { bulge: (0.5 * half).tan() }));
            return;
        }
    }
    split(points, first, worst.1, tolerance, out);
    split(points, worst.1, last, tolerance, out);
}

pub(super) fn fit_open(samples: &[Sample], _ruler: &Ruler) -> Option<PathRing<f64>> {
    let points: Vec<_> = samples.iter().map(|sample| sample.point).collect();
    if points.len() < 2 {
        return None;
    }
    let mut out = Vec::new();
    split(&points, 0, points.len() - 1, 0.15, &mut out);
    let mut ring = PathRing { points: vec![points[0].to_array()], segments: Vec::new() };
    for (last, segment) in out {
        ring.points.push(points[last].to_array());
        ring.segments.push(segment);
    }
    Some(ring)
}

pub(super) fn fit_closed(samples: &[Sample], ruler: &Ruler) -> Option<PathRing<f64>> {
    let half = samples.len() / 2;
    let mut ring = fit_open(samples.get(..=half)?, ruler)?;
    let mut rest: Vec<_> = samples.get(half..)?.to_vec();
    rest.push(*samples.first()?);
    let other = fit_open(&rest, ruler)?;
    ring.points.pop();
    ring.points.extend(other.points);
    ring.points.pop();
    ring.segments.extend(other.segments);
    Some(ring)
}
