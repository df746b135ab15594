//! An object as the SVG element that draws it, in pixels.

use dvp_core::geometry::Vec2;
use dvp_core::shape::{
    AnyShape, Boundary, Cap, FillRule, Flattening, Join, Outline, OutlineBasis, Path, PathRing, Piece, Shape as _,
    ShapeError, Stroke,
};
use dvp_core::{Object, Pose};

use super::curves::smooth;
use super::figure::figure;
use super::number::{FITTED, KNOWN, push, rounded, short};
use super::path_data::PathData;

/// How far a path may stray from what is painted of an outline of descriptors, pixels, rounding included.
const TOLERANCE_PX: f64 = 0.06;

/// How far polygons may stray from curves, pixels.
const FLATTENING_PX: f64 = 1.0 / 64.0;

/// SVG's own limit of miters.
const SVG_MITER_LIMIT: f64 = 4.0;

/// Turns by less than this, degrees, are none.
const LEAST_TURN: f64 = 1e-4;

/// What an element says of an object's place and form.
pub(super) struct Element {
    pub(super) tag: &'static str,
    /// Attributes, each with a space before it.
    pub(super) geometry: String,
    /// Whether its color is that of a pen.
    pub(super) is_stroke: bool,
    /// Degrees that it is turned by after it is painted, and around what.
    pub(super) turn: (f64, Vec2<f64>),
}

impl Element {
    pub(super) fn new(tag: &'static str) -> Self {
        Self { tag, geometry: String::new(), is_stroke: false, turn: (0.0, Vec2 { x: 0.0, y: 0.0 }) }
    }

    pub(super) fn numbers(mut self, numbers: &[(&str, f64)]) -> Self {
        for &(name, value) in numbers {
            self.geometry.push(' ');
            self.geometry.push_str(name);
            self.geometry.push_str("=\"");
            push(&mut self.geometry, value, KNOWN);
            self.geometry.push('"');
        }
        self
    }

    fn text(mut self, name: &str, value: &str) -> Self {
        self.geometry.extend([" ", name, "=\"", value, "\""]);
        self
    }

    /// Turns it around `center` by `degrees`; its farthest point from there is `radius` away.
    fn turned(self, degrees: f64, center: Vec2<f64>, radius: f64) -> Self {
        if degrees.abs() < LEAST_TURN {
            return self;
        }
        // As many decimals as move no point by more than 0.0005 px.
        let decimals = (3..7).find(|&decimals| radius * 8.7e-3 * 0.1_f64.powi(decimals) < 5e-4).unwrap_or(7);
        let decimals = usize::try_from(decimals).unwrap_or(7);
        let [x, y] = [center.x, center.y].map(|value| short(value, KNOWN));
        let turned = self.text("transform", &format!("rotate({} {x} {y})", short(degrees, decimals)));
        Self { turn: (degrees, center), ..turned }
    }
}

/// Whether the element of a shape is made of the rings that renderers paint; `reach` as in [`element_of`].
pub(super) fn needs_rings(shape: &AnyShape<f64>, reach: f64) -> bool {
    match shape {
        AnyShape::Stroke(stroke) => reach > 0.0 && !is_round(stroke),
        _ => shape.efd().is_some(),
    }
}

/// The element of an object, pixels its unit; `rings` are those that renderers paint, `reach` is how much it is fattened.
///
/// # Errors
/// [`ShapeError`] if the numbers describe no shape.
pub(super) fn element_of(object: &Object<f64>, rings: &[Vec<Vec2<f64>>], reach: f64) -> Result<Element, ShapeError> {
    let pose = &object.pose;
    let center = Vec2::from(pose.translation);
    let scale = pose.scale.abs();
    match &object.shape {
        AnyShape::Circle(circle) => {
            let numbers = [("cx", center.x), ("cy", center.y), ("r", (circle.radius * scale).abs())];
            Ok(Element::new("circle").numbers(&numbers))
        }
        AnyShape::Ellipse(ellipse) => {
            let (radii, degrees) = upright(ellipse.radii.map(|radius| (radius * scale).abs()), pose.rotation);
            let numbers = [("cx", center.x), ("cy", center.y), ("rx", radii[0]), ("ry", radii[1])];
            Ok(Element::new("ellipse").numbers(&numbers).turned(degrees, center, radii[0].max(radii[1])))
        }
        AnyShape::Rectangle(rectangle) => {
            let (size, degrees) = upright(rectangle.size.map(|side| (side * scale).abs()), pose.rotation);
            let corner = center - Vec2::from(size) * 0.5;
            let numbers = [("x", corner.x), ("y", corner.y), ("width", size[0]), ("height", size[1])];
            let radius = written_radius(rectangle.held_radius() * scale, size);
            let rounded = [("rx", radius)];
            let rounded = if radius > 0.0 { &rounded[..] } else { &[] };
            let element = Element::new("rect").numbers(&numbers).numbers(rounded);
            Ok(element.turned(degrees, center, 0.5 * size[0].hypot(size[1])))
        }
        AnyShape::RegularPolygon(_) | AnyShape::Star(_) => {
            let boundary = placed(object.shape.boundary()?, pose);
            Ok(Element::new("polygon").text("class", object.shape.kind()).text("points", &points(&boundary.pieces)))
        }
        AnyShape::Polygon(polygon) if polygon.rings.len() == 1 => {
            let boundary = placed(object.shape.boundary()?, pose);
            Ok(Element::new("polygon").text("fill-rule", "evenodd").text("points", &points(&boundary.pieces)))
        }
        AnyShape::Polygon(_) => {
            let boundary = placed(object.shape.boundary()?, pose);
            Ok(closed_path(&boundary, KNOWN).text("class", object.shape.kind()))
        }
        AnyShape::Path(shape) => {
            let data = lines(&placed(object.shape.boundary()?, pose), &shape.rings, reach > 0.0);
            let rule = if shape.fill == FillRule::NonZero { "nonzero" } else { "evenodd" };
            Ok(Element::new("path").text("fill-rule", rule).text("d", &data))
        }
        AnyShape::Stroke(shape) if reach <= 0.0 || is_round(shape) => stroke(shape, pose, reach),
        AnyShape::Stroke(_) => {
            let mut boundary = Boundary::default();
            rings.iter().for_each(|ring| boundary.push_polygon(ring));
            Ok(closed_path(&boundary, FITTED))
        }
        _ => Ok(closed_path(&smoothed(rings), FITTED)),
    }
}

/// The radius of a rectangle's corners, rounded down where rounding up makes it more than half of a side as it is written: readers hold
/// rx and ry to half their own sides, and different ones make no circle.
fn written_radius(radius: f64, size: [f64; 2]) -> f64 {
    let half = 0.5 * size.map(|side| rounded(side, KNOWN)).into_iter().fold(f64::INFINITY, f64::min);
    if rounded(radius, KNOWN) > half { radius - 0.5 * 0.1_f64.powi(3) } else { radius }
}

/// Path data of the rings of a path; open ones with the line that closes them if a pen has to follow it.
fn lines(boundary: &Boundary<f64>, rings: &[PathRing<f64>], closes_all: bool) -> String {
    let mut data = PathData::new(KNOWN);
    let rings = rings.iter().filter(|ring| !ring.points.is_empty());
    for (pieces, ring) in boundary.rings().zip(rings) {
        // The boundary has one line more where a ring is open: the one that closes it. A dot has only that.
        let is_whole = closes_all || ring.segments.is_empty();
        let own = if is_whole { pieces } else { &pieces[..ring.segments.len()] };
        data.ring(own, closes_all || ring.is_closed());
    }
    data.into_text()
}

/// Whether a fattened stroke is a wider stroke.
fn is_round(stroke: &Stroke<f64>) -> bool {
    let has_ends = stroke.rings.iter().any(|ring| !ring.is_closed());
    stroke.join == Join::Round && (stroke.cap == Cap::Round || !has_ends)
}

fn stroke(stroke: &Stroke<f64>, pose: &Pose<f64>, reach: f64) -> Result<Element, ShapeError> {
    let width = (stroke.width * pose.scale).abs() + 2.0 * reach;
    let cap = match stroke.cap {
        Cap::Butt => None,
        Cap::Round => Some("round"),
        Cap::Square => Some("square"),
    };
    let (join, limit) = match stroke.join {
        Join::Miter { limit } => (None, Some(limit).filter(|limit| (limit - SVG_MITER_LIMIT).abs() > 1e-9)),
        Join::Round => (Some("round"), None),
        Join::Bevel => (Some("bevel"), None),
    };
    let boundary = placed(Path { rings: stroke.rings.clone(), fill: FillRule::EvenOdd }.boundary()?, pose);
    let whole = if stroke.rings.len() == 1 && stroke.rings[0].is_closed() { figure(&boundary.pieces) } else { None };
    let data = whole.is_none().then(|| lines(&boundary, &stroke.rings, false));
    let element = whole.unwrap_or_else(|| Element::new("path"));
    let mut element = element.text("fill", "none").numbers(&[("stroke-width", width)]);
    for (name, value) in [("stroke-linecap", cap), ("stroke-linejoin", join)] {
        if let Some(value) = value {
            element = element.text(name, value);
        }
    }
    if let Some(limit) = limit {
        element = element.numbers(&[("stroke-miterlimit", limit)]);
    }
    if let Some(data) = data {
        element = element.text("d", &data);
    }
    Ok(Element { is_stroke: true, ..element })
}

fn closed_path(boundary: &Boundary<f64>, decimals: usize) -> Element {
    let mut data = PathData::new(decimals);
    boundary.rings().for_each(|ring| data.ring(ring, true));
    Element::new("path").text("fill-rule", "evenodd").text("d", &data.into_text())
}

/// Rings that stand for smooth curves.
fn smoothed(rings: &[Vec<Vec2<f64>>]) -> Boundary<f64> {
    // Rounding takes its part of the tolerance.
    let tolerance = TOLERANCE_PX - 0.5 * 0.1_f64.powi(2);
    let mut boundary = Boundary::default();
    for ring in rings {
        boundary.start_ring();
        boundary.pieces.extend(smooth(ring, tolerance));
    }
    boundary
}

/// The rings of an object as renderers paint it, where it stands.
///
/// # Errors
/// [`ShapeError`] if the numbers describe no shape.
pub(super) fn polygons(object: &Object<f64>, basis: &OutlineBasis<f64>) -> Result<Vec<Vec<Vec2<f64>>>, ShapeError> {
    let mut outline = Outline::default();
    let how = Flattening::new(basis, FLATTENING_PX).magnified(object.pose.scale);
    object.shape.flatten(&how, &mut outline)?;
    object.pose.transform(&mut outline.vertices);
    Ok(outline.rings().iter().map(|ring| ring.iter().copied().map(Vec2::from).collect()).collect())
}

/// Lengths along x and y of a shape that looks the same after half a turn, and the degrees, at most 45, that it is turned by:
/// a quarter of a turn exchanges the lengths.
fn upright([x, y]: [f64; 2], rotation: f64) -> ([f64; 2], f64) {
    let degrees = rotation.to_degrees();
    let quarters = (degrees / 90.0).round();
    let is_odd = quarters.rem_euclid(2.0) > 0.5;
    (if is_odd { [y, x] } else { [x, y] }, degrees - 90.0 * quarters)
}

/// Where a pose takes a boundary; bulges are the same in all sizes and directions.
fn placed(mut boundary: Boundary<f64>, pose: &Pose<f64>) -> Boundary<f64> {
    let turn = Vec2::from_angle(pose.rotation) * pose.scale;
    let place = |point: Vec2<f64>| point.turned(turn) + Vec2::from(pose.translation);
    for piece in &mut boundary.pieces {
        *piece = match *piece {
            Piece::Line { from, to } => Piece::Line { from: place(from), to: place(to) },
            Piece::Arc { from, to, bulge } => Piece::Arc { from: place(from), to: place(to), bulge },
            Piece::Ellipse { center, axes } => {
                Piece::Ellipse { center: place(center), axes: axes.map(|axis| axis.turned(turn)) }
            }
            Piece::Cubic(points) => Piece::Cubic(points.map(place)),
        };
    }
    boundary
}

/// Corners as the attribute `points` has them.
fn points(sides: &[Piece<f64>]) -> String {
    let mut text = String::new();
    for side in sides {
        if !text.is_empty() {
            text.push(' ');
        }
        push(&mut text, side.from().x, KNOWN);
        text.push(',');
        push(&mut text, side.from().y, KNOWN);
    }
    text
}
