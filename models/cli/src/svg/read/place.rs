//! Figures to shapes of a scene: what stays of a kind under a transform is of that kind.

use dvp_core::geometry::Vec2;
use dvp_core::shape::{
    AnyShape, Circle, Ellipse, FillRule, Path, PathRing, Polygon, Rectangle, RegularPolygon, Segment, ShapeError, Star,
};
use dvp_core::{Pose, Real};
use kurbo::{Affine, Arc, Point, SvgArc};

use super::figure::Figure;

/// Directions and lengths that differ by less than this share are the same: transforms come in 32 bits.
const EQUAL: f64 = 1e-5;

/// A polygon whose class says so is regular if no corner is farther than this from its place, pixels.
const REGULAR_PX: f64 = 2e-3;

/// A shape and where it stands.
pub(super) use dvp_core::scene::Placed;

/// A transform to scene units, and what it keeps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) affine: Affine,
    /// Scene units per pixel.
    pub(super) px: f64,
    /// Where the axes go.
    columns: [Vec2<f64>; 2],
}

impl Frame {
    pub(super) fn new(affine: Affine, px: f64) -> Self {
        let [a, b, c, d, _, _] = affine.as_coeffs();
        Self { affine, px, columns: [Vec2::new(a, b), Vec2::new(c, d)] }
    }

    /// The length of what has length 1 along the axes.
    fn scales(&self) -> [f64; 2] {
        self.columns.map(Vec2::length)
    }

    /// Whether right angles between the axes stay so.
    fn keeps_axes(&self) -> bool {
        let [x, y] = self.scales();
        self.columns[0].dot(self.columns[1]).abs() <= EQUAL * x * y
    }

    /// The factor of all lengths, if there is one; turned over or not.
    pub(super) fn similarity(&self) -> Option<f64> {
        let [x, y] = self.scales();
        (self.keeps_axes() && (x - y).abs() <= EQUAL * x).then_some(x)
    }

    /// Whether it takes everything to a line or a point, and nothing is seen.
    pub(super) fn is_flat(&self) -> bool {
        let [x, y] = self.scales();
        self.affine.determinant().abs() <= f64::from(f32::EPSILON) * x * y
    }

    /// About the factor of lengths.
    pub(super) fn scale(&self) -> f64 {
        self.affine.determinant().abs().sqrt()
    }

    pub(super) fn point(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        array(self.affine * Point::new(x, y))
    }

    fn upright(&self, center: [f64; 2]) -> Pose<f64> {
        Pose { translation: self.point(center), scale: 1.0, rotation: self.columns[0].angle() }
    }

    /// A figure that is filled by a rule, as the shape that it is; `tolerance` for curves that have to become cubics, in the figure's
    /// units. None for figures without any area.
    ///
    /// # Errors
    /// [`ShapeError`] if the numbers of the figure describe no shape.
    pub(super) fn fill(&self, figure: &Figure, rule: FillRule, tolerance: f64) -> Result<Option<Placed>, ShapeError> {
        let placed = match figure {
            Figure::Ellipse { center, radii, is_circle } => Some(self.ellipse(*center, *radii, *is_circle)),
            Figure::Rectangle { corner, size, radii } => self.rectangle(*corner, *size, *radii),
            Figure::Polygon { points, class } => self.polygon(points, class.as_deref(), rule),
            Figure::Path { rings, class } if class.as_deref() == Some("polygon") => self.polygons(rings),
            Figure::Path { .. } => None,
        };
        if placed.is_some() {
            return Ok(placed);
        }
        let rings = self.rings(&figure.rings(tolerance), tolerance);
        // One straight line encloses nothing; beside others it stays, so that a path comes back as it was written.
        let encloses =
            |ring: &PathRing<f64>| ring.points.len() > 2 || ring.segments.iter().any(|s| *s != Segment::Line);
        if !rings.iter().any(encloses) {
            return Ok(None);
        }
        let path = Path { fill: rule, ..Path::new(rings)? };
        Ok(Some((path.into(), Pose::identity())))
    }

    fn ellipse(&self, center: [f64; 2], [rx, ry]: [f64; 2], is_circle: bool) -> Placed {
        if let (true, Some(scale)) = (is_circle, self.similarity()) {
            let pose = Pose { rotation: 0.0, ..self.upright(center) };
            return (Circle { radius: rx * scale }.into(), pose);
        }
        if self.keeps_axes() {
            let [x, y] = self.scales();
            return (Ellipse { radii: [rx * x, ry * y] }.into(), self.upright(center));
        }
        let (radii, rotation) =
            (self.affine * kurbo::Ellipse::new(point_of(center), (rx, ry), 0.0)).radii_and_rotation();
        let pose = Pose { rotation, ..self.upright(center) };
        (Ellipse { radii: [radii.x, radii.y] }.into(), pose)
    }

    fn rectangle(&self, corner: [f64; 2], size: [f64; 2], [rx, ry]: [f64; 2]) -> Option<Placed> {
        let scales = self.scales();
        let radii = [rx * scales[0], ry * scales[1]];
        let is_round = (radii[0] - radii[1]).abs() <= EQUAL * radii[0];
        if !self.keeps_axes() || !is_round {
            return None;
        }
        let center = [0, 1].map(|axis| corner[axis] + 0.5 * size[axis]);
        let size = [0, 1].map(|axis| size[axis] * scales[axis]);
        Some((Rectangle::new(size, radii[0]).ok()?.into(), self.upright(center)))
    }

    fn polygon(&self, points: &[[f64; 2]], class: Option<&str>, rule: FillRule) -> Option<Placed> {
        let corners: Vec<[f64; 2]> = points.iter().map(|&point| self.point(point)).collect();
        let regular = match class {
            Some("regular_polygon") => regular(&corners, 1),
            Some("star") => regular(&corners, 2),
            _ => None,
        };
        if let Some((shape, pose, farthest)) = regular
            && farthest <= REGULAR_PX * self.px
        {
            return Some((shape, pose));
        }
        // The rule makes a difference only where sides cross.
        if rule == FillRule::NonZero && crosses_itself(&corners) {
            return None;
        }
        Some((Polygon::new(vec![corners]).ok()?.into(), Pose::identity()))
    }

    /// Rings of straight lines as one shape; none if they have curves.
    fn polygons(&self, rings: &[PathRing<f64>]) -> Option<Placed> {
        let is_straight = |ring: &PathRing<f64>| ring.is_closed() && ring.segments.iter().all(|s| *s == Segment::Line);
        if !rings.iter().all(is_straight) {
            return None;
        }
        let corners = rings.iter().map(|ring| ring.points.iter().map(|&point| self.point(point)).collect());
        Some((Polygon::new(corners.collect()).ok()?.into(), Pose::identity()))
    }

    /// Rings in scene units. Arcs stay arcs under similarities, and become cubics within `tolerance` else.
    pub(super) fn rings(&self, rings: &[PathRing<f64>], tolerance: f64) -> Vec<PathRing<f64>> {
        let keeps_arcs = self.similarity().is_some();
        let sign = self.affine.determinant().signum();
        let place = |ring: &PathRing<f64>| {
            let ring = if keeps_arcs { ring.clone() } else { without_arcs(ring, tolerance) };
            let segments = ring.segments.iter().map(|segment| match *segment {
                Segment::Arc { bulge } => Segment::Arc { bulge: bulge * sign },
                Segment::Cubic { controls } => Segment::Cubic { controls: controls.map(|point| self.point(point)) },
                other => other,
            });
            let segments = segments.collect();
            PathRing { points: ring.points.iter().map(|&point| self.point(point)).collect(), segments }
        };
        rings.iter().map(place).collect()
    }
}

pub(super) fn array(point: Point) -> [f64; 2] {
    [point.x, point.y]
}

pub(super) fn point_of([x, y]: [f64; 2]) -> Point {
    Point::new(x, y)
}

/// The same ring with cubics within `tolerance` instead of arcs.
fn without_arcs(ring: &PathRing<f64>, tolerance: f64) -> PathRing<f64> {
    let mut cubics = PathRing::default();
    for (k, (segment, &from)) in ring.segments.iter().zip(&ring.points).enumerate() {
        cubics.points.push(from);
        let to = ring.points[(k + 1) % ring.points.len()];
        match arc_of(*segment, point_of(from), point_of(to)) {
            Some(arc) => {
                let tolerance = tolerance.max(1e-9 * arc.radii.x);
                arc.to_cubic_beziers(tolerance, |first, second, end| {
                    cubics.segments.push(Segment::Cubic { controls: [first, second].map(array) });
                    cubics.points.push(array(end));
                });
                // The end is the start of what comes next.
                cubics.points.pop();
            }
            None => cubics.segments.push(*segment),
        }
    }
    cubics.points.extend(ring.points.iter().skip(ring.segments.len()));
    cubics
}

/// The arc of a segment, if it is one.
pub(super) fn arc_of(segment: Segment<f64>, from: Point, to: Point) -> Option<Arc> {
    let Segment::Arc { bulge } = segment else { return None };
    let radius = (to - from).hypot() * (1.0 + bulge * bulge) / (4.0 * bulge.abs());
    Arc::from_svg_arc(&SvgArc {
        from,
        to,
        radii: kurbo::Vec2::new(radius, radius),
        x_rotation: 0.0,
        large_arc: bulge.abs() > 1.0,
        sweep: bulge > 0.0,
    })
}

/// The regular polygon, or for a `period` of 2 the star, nearest to the corners, and the farthest distance of a corner from it.
fn regular(corners: &[[f64; 2]], period: usize) -> Option<(AnyShape<f64>, Pose<f64>, f64)> {
    let count = corners.len();
    if count < 3 * period || !count.is_multiple_of(period) {
        return None;
    }
    let corners = || corners.iter().copied().map(Vec2::<f64>::from);
    let center = corners().fold(Vec2::default(), |sum, corner| sum + corner) / f64::of_usize(count);
    // Turned back by their places, the corners of each kind stand in one point.
    let step = core::f64::consts::TAU / f64::of_usize(count);
    let back = |k: usize, corner: Vec2<f64>| (corner - center).turned(Vec2::from_angle(-step * f64::of_usize(k)));
    let mean = |kind: usize| {
        let own = corners().enumerate().skip(kind).step_by(period).map(|(k, corner)| back(k, corner));
        own.fold(Vec2::default(), |sum, corner| sum + corner) / f64::of_usize(count / period)
    };
    let direction = mean(0).normalized()?;
    let radii = [mean(0).length(), mean(1 % period).dot(direction)];
    let off = corners().enumerate().map(|(k, corner)| (back(k, corner) - direction * radii[k % period]).length());
    let farthest = off.fold(0.0, f64::max);
    let shape = if period == 1 {
        RegularPolygon::new(count, radii[0]).ok()?.into()
    } else {
        Star::new(count / 2, radii[0], radii[1]).ok()?.into()
    };
    Some((shape, Pose { translation: center.to_array(), scale: 1.0, rotation: direction.angle() }, farthest))
}

/// Most corners of a polygon that is tested for crossings; one of more is taken to have some.
const MOST_TESTED: usize = 256;

/// Whether sides of a closed polygon cross or touch others than their neighbors.
fn crosses_itself(corners: &[[f64; 2]]) -> bool {
    let count = corners.len();
    if count > MOST_TESTED {
        return true;
    }
    let side = |k: usize| [corners[k], corners[(k + 1) % count]].map(Vec2::<f64>::from);
    let turns = |[a, b]: [Vec2<f64>; 2], p: Vec2<f64>| (b - a).cross(p - a);
    let are_apart = |[a, b]: [Vec2<f64>; 2], [c, d]: [Vec2<f64>; 2]| {
        let apart = |a: f64, b: f64, c: f64, d: f64| a.max(b) < c.min(d) || c.max(d) < a.min(b);
        apart(a.x, b.x, c.x, d.x) || apart(a.y, b.y, c.y, d.y)
    };
    let meet = |first: [Vec2<f64>; 2], second: [Vec2<f64>; 2]| {
        !are_apart(first, second)
            && turns(first, second[0]) * turns(first, second[1]) <= 0.0
            && turns(second, first[0]) * turns(second, first[1]) <= 0.0
    };
    (0..count).any(|i| (i + 2..count).any(|k| (k + 1) % count != i && meet(side(i), side(k))))
}
