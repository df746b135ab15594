//! Path data to rings: lines, circular arcs and cubics in the numbers of the file.

use dvp_core::shape::{PathRing, Segment};
use kurbo::{Arc, Point, SvgArc, Vec2};
use svgtypes::{PathParser, PathSegment};

use super::place::array;

/// Radii that differ less than this share of them are equal.
const EQUAL: f64 = 1e-9;

/// A ring is closed where it comes back this near to its start, as a share of the start's distance from the origin or of 1 if that is
/// less: relative coordinates do not add up to zero exactly. A last line so short would have any direction.
const BACK: f64 = 1e-9;

/// The rings of path data up to its first error, and whether there is one. Cubics for elliptical arcs stray at most `tolerance`
/// from them, in the units of the data.
pub(super) fn rings(data: &str, tolerance: f64) -> (Vec<PathRing<f64>>, bool) {
    let mut pen = Pen { tolerance, ..Pen::default() };
    for segment in PathParser::from(data) {
        match segment {
            Ok(segment) => pen.follow(segment),
            Err(_) => return (pen.finish(), true),
        }
    }
    (pen.finish(), false)
}

#[derive(Default)]
struct Pen {
    tolerance: f64,
    rings: Vec<PathRing<f64>>,
    /// The ring under way; one point more than segments.
    ring: PathRing<f64>,
    /// Where the pen is, and where a closed ring takes it.
    here: Point,
    start: Point,
    /// The last control point, if the segment before was a cubic or a quadratic.
    cubic_control: Option<Point>,
    quadratic_control: Option<Point>,
}

impl Pen {
    fn follow(&mut self, segment: PathSegment) {
        let base = if segment.is_abs() { Vec2::ZERO } else { self.here.to_vec2() };
        let at = |x: f64, y: f64| Point::new(x, y) + base;
        let [cubic, quadratic] = [self.cubic_control.take(), self.quadratic_control.take()];
        let reflected = |control: Option<Point>, here: Point| control.map_or(here, |control| here + (here - control));
        match segment {
            PathSegment::MoveTo { x, y, .. } => {
                self.end_ring();
                self.here = at(x, y);
                self.start = self.here;
            }
            PathSegment::LineTo { x, y, .. } => self.push(Segment::Line, at(x, y)),
            PathSegment::HorizontalLineTo { x, .. } => self.push(Segment::Line, Point::new(x + base.x, self.here.y)),
            PathSegment::VerticalLineTo { y, .. } => self.push(Segment::Line, Point::new(self.here.x, y + base.y)),
            PathSegment::CurveTo { x1, y1, x2, y2, x, y, .. } => self.cubic(at(x1, y1), at(x2, y2), at(x, y)),
            PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
                self.cubic(reflected(cubic, self.here), at(x2, y2), at(x, y));
            }
            PathSegment::Quadratic { x1, y1, x, y, .. } => self.quadratic(at(x1, y1), at(x, y)),
            PathSegment::SmoothQuadratic { x, y, .. } => self.quadratic(reflected(quadratic, self.here), at(x, y)),
            PathSegment::EllipticalArc { rx, ry, x_axis_rotation, large_arc, sweep, x, y, .. } => {
                let radii = Vec2::new(rx.abs(), ry.abs());
                let x_rotation = x_axis_rotation.to_radians();
                self.arc(&SvgArc { from: self.here, to: at(x, y), radii, x_rotation, large_arc, sweep });
            }
            PathSegment::ClosePath { .. } => self.close(),
        }
    }

    fn push(&mut self, segment: Segment<f64>, to: Point) {
        if self.ring.points.is_empty() {
            self.ring.points.push(array(self.here));
        }
        self.ring.segments.push(segment);
        self.ring.points.push(array(to));
        self.here = to;
    }

    fn cubic(&mut self, first: Point, second: Point, to: Point) {
        self.push(Segment::Cubic { controls: [first, second].map(array) }, to);
        self.cubic_control = Some(second);
    }

    /// A quadratic, as the cubic that is the same curve.
    fn quadratic(&mut self, control: Point, to: Point) {
        let [first, second] = [self.here, to].map(|end| end.lerp(control, 2.0 / 3.0));
        self.push(Segment::Cubic { controls: [first, second].map(array) }, to);
        self.quadratic_control = Some(control);
    }

    fn arc(&mut self, arc: &SvgArc) {
        let chord = (arc.to - arc.from).hypot();
        if chord <= 0.0 {
            return;
        }
        let Vec2 { x: rx, y: ry } = arc.radii;
        if rx <= 0.0 || ry <= 0.0 {
            self.push(Segment::Line, arc.to);
        } else if (rx - ry).abs() <= EQUAL * rx {
            let bulge = bulge(chord, rx, arc.large_arc);
            self.push(Segment::Arc { bulge: if arc.sweep { bulge } else { -bulge } }, arc.to);
        } else if let Some(exact) = Arc::from_svg_arc(arc) {
            let (mut end, mut curves) = (arc.from, Vec::new());
            // Radii of millions would otherwise be cut into thousands.
            exact.to_cubic_beziers(self.tolerance.max(1e-9 * rx.max(ry)), |first, second, to| {
                curves.push([first, second, to]);
                end = to;
            });
            // The last one ends at the very numbers of the file.
            let last = curves.len().saturating_sub(1);
            for (k, [first, second, to]) in curves.into_iter().enumerate() {
                let controls = [first, second].map(array);
                self.push(Segment::Cubic { controls }, if k == last { arc.to } else { to });
            }
        }
    }

    fn close(&mut self) {
        if self.ring.points.is_empty() {
            self.ring.points.push(array(self.here));
        }
        let is_back = (self.here - self.start).hypot() <= BACK * self.start.to_vec2().hypot().max(1.0);
        if is_back && self.ring.points.len() > 1 {
            // The last segment leads to the very first point.
            self.ring.points.pop();
        } else {
            self.ring.segments.push(Segment::Line);
        }
        self.rings.push(core::mem::take(&mut self.ring));
        self.here = self.start;
    }

    fn end_ring(&mut self) {
        let ring = core::mem::take(&mut self.ring);
        if !ring.segments.is_empty() {
            self.rings.push(ring);
        }
        self.start = self.here;
    }

    fn finish(mut self) -> Vec<PathRing<f64>> {
        self.end_ring();
        self.rings
    }
}

/// tan(sweep / 4) of the arc of a circle over a chord; a radius that is too small is taken as half the chord.
fn bulge(chord: f64, radius: f64, is_large: bool) -> f64 {
    let half = 0.5 * chord;
    let radius = radius.max(half);
    let below = ((radius - half) * (radius + half)).sqrt();
    if is_large { (radius + below) / half } else { half / (radius + below) }
}
