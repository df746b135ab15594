//! Color ramps: colors that change along a line or away from a center. SVG calls them gradients; here a gradient is a derivative.

use alloc::vec::Vec;

use super::Pose;
use crate::real::Real;

/// A color that a ramp reaches, and where.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ColorStop<T> {
    /// 0 at the beginning of the ramp, 1 at its end; never below that of the stop before.
    pub offset: T,
    /// RGB, [0, 1].
    pub color: [T; 3],
}

/// Which offset a point has, by points in the same frame: an object's, or scene units in a drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RampKind<T> {
    /// 0 at the first point, 1 at the second; the same along every line across the way between both.
    Linear([[T; 2]; 2]),
    /// 0 at the first point, 1 on the ellipse around it that goes through the other two, in conjugate directions: on a circle
    /// these are at right angles.
    Radial([[T; 2]; 3]),
}

/// Colors between which those of an object change from place to place.
///
/// The color at an offset is interpolated linearly, in the stored values, between the two stops around it; before the first stop
/// it is that of the first, behind the last stop that of the last. Of stops at the same offset the last one counts from there on.
/// Where the points of the kind say nothing (the two ends of a line are one, an ellipse has no area) the offset is 1 everywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct ColorRamp<T> {
    /// Which offset a point has.
    pub kind: RampKind<T>,
    /// At least one.
    pub stops: Vec<ColorStop<T>>,
}

/// Two affine functions of a point, row . (x, y, 1): the offset is the first one, or the length of both.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RampRows<T> {
    pub(crate) rows: [[T; 3]; 2],
    pub(crate) is_radial: bool,
}

/// Where an offset lies between stops.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Between<T> {
    /// The stop at or before it, the first one for offsets before all.
    pub(crate) stop: usize,
    /// How far it is on the way to the next stop, and how long that way is; none before the first stop and behind the last.
    pub(crate) way: Option<(T, T)>,
}

impl<T: Real> RampKind<T> {
    /// Its points.
    #[must_use]
    pub fn points(&self) -> &[[T; 2]] {
        match self {
            Self::Linear(points) => points,
            Self::Radial(points) => points,
        }
    }

    /// Its points, to write to.
    #[must_use]
    pub fn points_mut(&mut self) -> &mut [[T; 2]] {
        match self {
            Self::Linear(points) => points,
            Self::Radial(points) => points,
        }
    }

    /// The same kind, all points at (0, 0): a gradient to add to.
    #[must_use]
    pub fn zero(&self) -> Self {
        let mut zero = *self;
        zero.points_mut().fill([T::zero(); 2]);
        zero
    }

    /// The kind in the frame that the pose leads to.
    #[must_use]
    pub fn posed(mut self, pose: &Pose<T>) -> Self {
        pose.transform(self.points_mut());
        self
    }

    /// The offset of a point. *Derivative*: by way of [`Renderer::render_vjp`](crate::render::Renderer::render_vjp).
    #[must_use]
    pub fn offset(&self, point: [T; 2]) -> T {
        self.to_rows().offset(point).0
    }

    /// The affine functions that give the offset.
    pub(crate) fn to_rows(self) -> RampRows<T> {
        let (zero, one) = (T::zero(), T::one());
        let nothing = [[zero, zero, one], [zero; 3]];
        match self {
            Self::Linear([start, end]) => {
                let way = difference(end, start);
                let length = dot(way, way);
                let row = way.map(|v| v / length);
                let rows = if length > zero { [with_origin(row, start), [zero; 3]] } else { nothing };
                RampRows { rows, is_radial: false }
            }
            Self::Radial([center, a, b]) => {
                let (a, b) = (difference(a, center), difference(b, center));
                let area = a[0] * b[1] - a[1] * b[0];
                if area == zero || !area.is_normal() {
                    return RampRows { rows: nothing, is_radial: false };
                }
                let rows = [[b[1] / area, -b[0] / area], [-a[1] / area, a[0] / area]];
                RampRows { rows: rows.map(|row| with_origin(row, center)), is_radial: true }
            }
        }
    }

    /// Adds to `grad`, of the same kind, the gradient of the points, given that of the rows of [`Self::to_rows`].
    pub(crate) fn to_rows_vjp(self, grad_rows: &[[T; 3]; 2], grad: &mut Self) {
        let RampRows { rows, is_radial } = self.to_rows();
        let origin = self.points()[0];
        let points = grad.points_mut();
        // The last number of a row is -(the others) . origin.
        let mut own = [[T::zero(); 2]; 2];
        for ((own, row), grad_row) in own.iter_mut().zip(&rows).zip(grad_rows) {
            for i in 0..2 {
                points[0][i] -= grad_row[2] * row[i];
                own[i] = grad_row[i] - grad_row[2] * origin[i];
            }
        }
        let ways = match self {
            Self::Linear([start, end]) => {
                let way = difference(end, start);
                let length = dot(way, way);
                if length <= T::zero() {
                    return;
                }
                let twice = T::of(2.0) * dot(own[0], way) / length;
                [[0, 1].map(|i| (own[0][i] - twice * way[i]) / length), [T::zero(); 2]]
            }
            // The rows are the inverse of the matrix whose columns are the ways: its gradient is -R^T G R^T.
            Self::Radial(_) if is_radial => {
                let [[p, q, _], [r, s, _]] = rows;
                let [[a, b], [c, d]] = own;
                let turned = [[p * a + r * c, p * b + r * d], [q * a + s * c, q * b + s * d]];
                let entry = |i: usize, row: [T; 2]| -dot(turned[i], row);
                [[entry(0, [p, q]), entry(1, [p, q])], [entry(0, [r, s]), entry(1, [r, s])]]
            }
            Self::Radial(_) => return,
        };
        for (end, way) in ways.iter().enumerate().take(points.len() - 1) {
            for i in 0..2 {
                points[end + 1][i] += way[i];
                points[0][i] -= way[i];
            }
        }
    }

    /// The same kind in another precision, every number rounded to the nearest.
    #[must_use]
    pub fn cast<U: Real>(&self) -> RampKind<U> {
        let number = |v: T| U::of(v.as_f64());
        match self {
            Self::Linear(points) => RampKind::Linear(points.map(|point| point.map(number))),
            Self::Radial(points) => RampKind::Radial(points.map(|point| point.map(number))),
        }
    }
}

impl<T: Real> RampRows<T> {
    /// The offset of a point, and the values of both rows.
    #[inline(always)]
    pub(crate) fn offset(&self, [x, y]: [T; 2]) -> (T, [T; 2]) {
        let values = self.rows.map(|[a, b, c]| a * x + b * y + c);
        let offset = if self.is_radial { dot(values, values).sqrt() } else { values[0] };
        (offset, values)
    }
}

impl<T: Real> ColorRamp<T> {
    /// The color at an offset, RGB; black without stops.
    #[must_use]
    pub fn color_at(&self, offset: T) -> [T; 3] {
        color_at(&self.stops, offset)
    }

    /// Appends what may move on its own: the points, then the colors of the stops. Offsets stay, which the points can do for.
    pub fn numbers(&self, out: &mut Vec<T>) {
        out.extend(self.kind.points().as_flattened());
        out.extend(self.stops.iter().flat_map(|stop| stop.color));
    }

    /// What may move on its own, in the order of [`Self::numbers`], to write to.
    pub fn numbers_mut(&mut self) -> impl Iterator<Item = &mut T> {
        let points = self.kind.points_mut().as_flattened_mut().iter_mut();
        points.chain(self.stops.iter_mut().flat_map(|stop| &mut stop.color))
    }

    /// Zeros in the same layout: a gradient to add to.
    #[must_use]
    pub fn zero(&self) -> Self {
        Self { kind: self.kind.zero(), stops: alloc::vec![ColorStop::default(); self.stops.len()] }
    }
}

/// The color of stops at an offset.
#[inline(always)]
pub(crate) fn color_at<T: Real>(stops: &[ColorStop<T>], offset: T) -> [T; 3] {
    let Between { stop, way } = between(stops, offset);
    let Some(first) = stops.get(stop) else { return [T::zero(); 3] };
    way.map_or(first.color, |(share, _)| {
        let next = &stops[stop + 1].color;
        [0, 1, 2].map(|i| first.color[i] + share * (next[i] - first.color[i]))
    })
}

/// Where an offset lies between stops.
#[inline(always)]
pub(crate) fn between<T: Real>(stops: &[ColorStop<T>], offset: T) -> Between<T> {
    let passed = stops.iter().take_while(|stop| stop.offset <= offset).count();
    if passed == 0 || passed == stops.len() {
        return Between { stop: passed.saturating_sub(1), way: None };
    }
    let start = stops[passed - 1].offset;
    // The next stop is beyond the offset, so that the way has a length.
    let length = stops[passed].offset - start;
    Between { stop: passed - 1, way: Some(((offset - start) / length, length)) }
}

fn difference<T: Real>(a: [T; 2], b: [T; 2]) -> [T; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

#[inline(always)]
fn dot<T: Real>(a: [T; 2], b: [T; 2]) -> T {
    a[0] * b[0] + a[1] * b[1]
}

/// A row that is 0 at `origin`.
fn with_origin<T: Real>(row: [T; 2], origin: [T; 2]) -> [T; 3] {
    [row[0], row[1], -dot(row, origin)]
}
