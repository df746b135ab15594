//! Color ramps as SVG's gradients.

use dvp_core::geometry::Vec2;
use dvp_core::scene::{ColorRamp, ColorStop, RampKind};

use super::number::{KNOWN, hex, short};

/// Decimals of offsets: a step of a color over a thousand pixels.
const OFFSET: usize = 4;
/// Decimals of the numbers of a matrix.
const MATRIX: usize = 4;
/// How far (pixels) the rim of an ellipse may lie from that of a circle to be written as one.
const ROUND: f64 = 1e-3;

/// The definition of a ramp under a name, its points in pixels, for an element that is turned by `degrees` around `center` after it is painted.
pub(super) fn definition(id: &str, ramp: &ColorRamp<f64>, (degrees, center): (f64, Vec2<f64>)) -> String {
    let turn = Vec2::from_angle(-degrees.to_radians());
    let mut kind = ramp.kind;
    for point in kind.points_mut() {
        *point = ((Vec2::from(*point) - center).turned(turn) + center).to_array();
    }
    let (first, last, stops) = within(ramp, matches!(kind, RampKind::Radial(_)));
    let attribute = |name: &str, value: f64| format!(" {name}=\"{}\"", short(value, KNOWN));
    let (tag, place) = match kind {
        RampKind::Linear(ends) => {
            let [start, end] = ends.map(Vec2::from);
            let [from, to] = [start.lerp(end, first), start.lerp(end, last)];
            let numbers = [("x1", from.x), ("y1", from.y), ("x2", to.x), ("y2", to.y)];
            ("linearGradient", numbers.map(|(name, value)| attribute(name, value)).concat())
        }
        RampKind::Radial(points) => {
            let [center, a, b] = points.map(Vec2::from);
            let (a, b) = ((a - center) * last, (b - center) * last);
            let is_round = a.dot(b).abs() <= ROUND * a.length() && (a.length() - b.length()).abs() <= ROUND;
            let place = if is_round {
                let numbers = [("cx", center.x), ("cy", center.y), ("r", a.length())];
                numbers.map(|(name, value)| attribute(name, value)).concat()
            } else {
                let numbers = [a.x, a.y, b.x, b.y, center.x, center.y].map(|value| short(value, MATRIX));
                format!(" cx=\"0\" cy=\"0\" r=\"1\" gradientTransform=\"matrix({})\"", numbers.join(" "))
            };
            ("radialGradient", place)
        }
    };
    let stop = |stop: &ColorStop<f64>| {
        format!("<stop offset=\"{}\" stop-color=\"{}\"/>", short(stop.offset, OFFSET), hex(stop.color))
    };
    let stops: String = stops.iter().map(stop).collect();
    format!("<defs><{tag} id=\"{id}\" gradientUnits=\"userSpaceOnUse\"{place}>{stops}</{tag}></defs>\n")
}

/// The stops with offsets from 0 to 1, which is all that SVG has; and the ramp's own offsets there. About a center 0 stays where it is.
fn within(ramp: &ColorRamp<f64>, is_radial: bool) -> (f64, f64, Vec<ColorStop<f64>>) {
    let (Some(start), Some(end)) = (ramp.stops.first(), ramp.stops.last()) else { return (0.0, 1.0, Vec::new()) };
    let first = if is_radial { 0.0 } else { start.offset };
    let last = if end.offset > first { end.offset } else { first + 1.0 };
    let mut stops: Vec<ColorStop<f64>> = ramp.stops.iter().filter(|stop| stop.offset >= first).copied().collect();
    if start.offset < first {
        stops.insert(0, ColorStop { offset: first, color: ramp.color_at(first) });
    }
    stops.iter_mut().for_each(|stop| stop.offset = (stop.offset - first) / (last - first));
    (first, last, stops)
}
