//! What lies along the border of the picture ends there.
//!
//! Nothing beyond can be seen, so that outlines are held to the border loosely (`BORDER_SIGMA`) and what they share with others may
//! draw them away from it; what is behind would then be seen as a hairline.

use dvp_core::Vec2;
use dvp_core::shape::{PathRing, Segment};

use crate::outline::OutlineShape;

/// Sides that are no further from the border, pixels, lie on it: were more of the pixels along it of something else, they would be a face of its
/// own.
const BESIDE: f64 = 0.5;

/// Puts sides along the border of a picture of this width and height on it.
pub(super) fn tie(shape: &mut OutlineShape, size: [f64; 2]) {
    match shape {
        OutlineShape::Path(ring) => lines(ring, size),
        OutlineShape::Rectangle { center, size: sides, corner_radius, angle }
            if *corner_radius == 0.0 && *angle == 0.0 =>
        {
            let tied = |axis: usize| {
                let (middle, side) = (center.to_array()[axis], sides[axis]);
                let [low, high] = [middle - 0.5 * side, middle + 0.5 * side]
                    .map(|value| border([value; 2], size[axis]).unwrap_or(value));
                [0.5 * (low + high), high - low]
            };
            let [[x, width], [y, height]] = [0, 1].map(tied);
            (*center, *sides) = (Vec2::new(x, y), [width, height]);
        }
        _ => (),
    }
}

fn lines(ring: &mut PathRing<f64>, size: [f64; 2]) {
    let count = ring.points.len();
    for (k, _) in ring.segments.iter().enumerate().filter(|(_, segment)| matches!(segment, Segment::Line)) {
        let next = (k + 1) % count;
        for (axis, side) in size.into_iter().enumerate() {
            // What is as short as it may be far off does not lie along anything.
            let is_long = (ring.points[next][1 - axis] - ring.points[k][1 - axis]).abs() > 2.0 * BESIDE;
            let border = border([ring.points[k][axis], ring.points[next][axis]], side);
            if let Some(border) = border.filter(|_| is_long) {
                (ring.points[k][axis], ring.points[next][axis]) = (border, border);
            }
        }
    }
}

/// The border that both ends of a side lie beside, one way.
fn border(ends: [f64; 2], size: f64) -> Option<f64> {
    [0.0, size].into_iter().find(|border| ends.iter().all(|end| (end - border).abs() <= BESIDE))
}
