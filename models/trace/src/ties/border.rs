//! What lies along the border of the picture ends there.
//!
//! Nothing beyond can be seen, so that outlines are held to the border loosely (`BORDER_SIGMA`) and what they share with others may
//! draw them away from it; what is behind would then be seen as a hairline.

use dvp_core::Vec2;
use dvp_core::contour::signed_area;
use dvp_core::shape::{PathRing, Segment};

use super::figure::Sides;
use crate::layers;
use crate::outline::{Outline, OutlineShape};

/// Sides that are no further from the border, pixels, lie on it: were more of the pixels along it of something else, they would be a face of its
/// own.
const BESIDE: f64 = 0.5;

/// Puts sides along the border of a picture of this width and height on it, where the outline is on the inner hand of them: of a strip along
/// the border the outer side alone.
pub(super) fn tie(outline: &mut Outline, [width, height]: [f64; 2]) {
    let polygon = layers::polygon(outline);
    match &mut outline.shape {
        OutlineShape::Path(ring) => {
            if let Some(polygon) = polygon {
                lines(ring, signed_area(&polygon).signum(), [width, height]);
            }
        }
        OutlineShape::Rectangle { center, size, angle, .. } => {
            let Some(Sides { low, high }) = Sides::of(*center, *size, *angle) else { return };
            let on = |value: f64, border: f64| if is_beside(value, border) { border } else { value };
            let low = Vec2::new(on(low.x, 0.0), on(low.y, 0.0));
            let high = Vec2::new(on(high.x, width), on(high.y, height));
            (*center, *size, *angle) = ((low + high) * 0.5, (high - low).to_array(), 0.0);
        }
        _ => (),
    }
}

/// The same of the lines of a ring that turns from +x to +y if `turn` is positive.
fn lines(ring: &mut PathRing<f64>, turn: f64, size: [f64; 2]) {
    let count = ring.points.len();
    for (k, _) in ring.segments.iter().enumerate().filter(|(_, segment)| matches!(segment, Segment::Line)) {
        let next = (k + 1) % count;
        let [from, to] = [k, next].map(|k| Vec2::from(ring.points[k]));
        let inward = ((to - from).perp() * turn).to_array();
        for (axis, side) in size.into_iter().enumerate() {
            // What is as short as it may be far off does not lie along anything.
            let is_long = inward[axis].abs() > 2.0 * BESIDE;
            let border = if inward[axis] > 0.0 { 0.0 } else { side };
            if is_long && [from, to].iter().all(|end| is_beside(end.to_array()[axis], border)) {
                (ring.points[k][axis], ring.points[next][axis]) = (border, border);
            }
        }
    }
}

fn is_beside(value: f64, border: f64) -> bool {
    (value - border).abs() <= BESIDE
}
