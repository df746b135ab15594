//! Closed lines that SVG has an element of its own for: circles and upright rectangles, their corners sharp or round.

use dvp_core::geometry::Vec2;
use dvp_core::shape::Piece;

use super::element::Element;

/// How far (pixels) points may be off for a line to be such a figure: less than is written.
const TOLERANCE: f64 = 1e-4;

/// The element of one closed ring, if there is one.
pub(super) fn figure(pieces: &[Piece<f64>]) -> Option<Element> {
    circle(pieces).or_else(|| rectangle(pieces))
}

fn circle(pieces: &[Piece<f64>]) -> Option<Element> {
    let [Piece::Arc { from, to, bulge }, Piece::Arc { from: back, to: end, bulge: other }] = *pieces else {
        return None;
    };
    let is_whole = (end - from).length() < TOLERANCE && (back - to).length() < TOLERANCE;
    // An arc's middle is half the chord times the bulge off its chord.
    let is_half = |bulge: f64| (bulge.abs() - 1.0).abs() * (to - from).length() < TOLERANCE;
    if !is_whole || !is_half(bulge) || !is_half(other) || bulge * other < 0.0 {
        return None;
    }
    let center = from.lerp(to, 0.5);
    Some(Element::new("circle").numbers(&[("cx", center.x), ("cy", center.y), ("r", 0.5 * (to - from).length())]))
}

fn rectangle(pieces: &[Piece<f64>]) -> Option<Element> {
    let first = pieces.first()?.from();
    let (mut low, mut high) = (first, first);
    for piece in pieces {
        let Vec2 { x, y } = piece.to();
        (low.x, low.y, high.x, high.y) = (low.x.min(x), low.y.min(y), high.x.max(x), high.y.max(y));
    }
    let quarter = core::f64::consts::FRAC_PI_8.tan();
    let mut radii = Vec::new();
    let (mut sides, mut turn) = (0, 0.0_f64);
    for piece in pieces {
        match *piece {
            Piece::Line { from, to } if (to.x - from.x).abs() < TOLERANCE || (to.y - from.y).abs() < TOLERANCE => {
                sides += 1
            }
            Piece::Arc { from, to, bulge } if (bulge.abs() - quarter).abs() < 1e-6 => {
                let span = to - from;
                if (span.x.abs() - span.y.abs()).abs() > TOLERANCE {
                    return None;
                }
                radii.push(span.x.abs());
                turn += bulge;
            }
            _ => return None,
        }
    }
    let size = high - low;
    let is_sharp = sides == 4 && radii.is_empty();
    let is_round = sides == 4 && radii.len() == 4 && (turn.abs() - 4.0 * quarter).abs() < 1e-5;
    let radius = radii.first().copied().unwrap_or(0.0);
    // Corners on the box, all alike: nothing but a rectangle has four sides along the axes and these.
    let corners = pieces.iter().map(Piece::from).filter(|point| {
        let [left, right] = [(point.x - low.x).abs(), (point.x - high.x).abs()];
        let [top, bottom] = [(point.y - low.y).abs(), (point.y - high.y).abs()];
        let near = |a: f64, b: f64, c: f64| a.min(b) < TOLERANCE && c < radius + TOLERANCE;
        near(left, right, top.min(bottom)) || near(top, bottom, left.min(right))
    });
    let is_on_box = corners.count() == pieces.len();
    let is_even = radii.iter().all(|other| (other - radius).abs() < TOLERANCE);
    if !(is_sharp || is_round) || !is_on_box || !is_even || size.x < TOLERANCE || size.y < TOLERANCE {
        return None;
    }
    let numbers = [("x", low.x), ("y", low.y), ("width", size.x), ("height", size.y)];
    let rounded = [("rx", radius)];
    Some(Element::new("rect").numbers(&numbers).numbers(if is_round { &rounded } else { &[] }))
}
