//! Where coverage by distance is smooth, so that differences tell its derivative.
//!
//! Coverage follows one part of the outline, the closest: an edge or a vertex. Where two are equally close it has a kink
//! (two edges) or a jump of its curvature (an edge and its end, both of which differences of this step still see); it
//! jumps at the cut, by up to 0.015, and where it saturates, by 1e-6. None of these is within reach of a difference if no
//! coordinate, moved by twice the step to either side, makes the pixel follow anything else.

use dvp_core::render::{ContourRenderer, EdgeLaw};
use dvp_core::shape::Rings;
use dvp_core::{Drawing, ImageSize};
use dvp_tests::finite_difference::step;

/// Distance by itself bends around a vertex, the sharper the closer: up to this many steps off, differences see it. Their
/// error is (step / distance)^2 / 6, here 7e-7.
const BEND_STEPS: f64 = 500.0;

/// What the coverage of a pixel follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Follows {
    /// Nothing: it is beyond the cut.
    Beyond,
    /// Nothing: it is so far inside that it counts as 1.
    Full,
    /// The edge that starts at this vertex.
    Edge(usize),
    /// This vertex.
    Vertex(usize),
}

/// Per pixel, whether coverage is smooth within the steps of [`compare`](dvp_tests::finite_difference::compare) in every
/// coordinate of every outline.
pub(crate) fn smooth(renderer: &ContourRenderer<f64>, drawing: &Drawing<f64>, size: ImageSize) -> Vec<bool> {
    let mut smooth = vec![true; size.pixels()];
    for object in 0..drawing.object_count() {
        let mut alone = Drawing::default();
        let outline = drawing.outline(object);
        alone.push_rings(drawing.rings(object), drawing.colors[object], drawing.confidences[object]);
        let here = followed(renderer, &alone, size);
        for (smooth, &(_, bends)) in smooth.iter_mut().zip(&here) {
            *smooth &= !bends;
        }
        for (vertex, axis) in (0..outline.len()).flat_map(|vertex| [(vertex, 0), (vertex, 1)]) {
            let x = outline[vertex][axis];
            for moved in [x - 2.0 * step(x), x + 2.0 * step(x)] {
                alone.vertices[vertex][axis] = moved;
                for (smooth, (a, b)) in smooth.iter_mut().zip(here.iter().zip(followed(renderer, &alone, size))) {
                    *smooth &= a.0 == b.0;
                }
            }
            alone.vertices[vertex][axis] = x;
        }
    }
    smooth
}

/// What each pixel follows in a drawing of one object, and whether it is so close to a vertex that distance bends.
fn followed(renderer: &ContourRenderer<f64>, drawing: &Drawing<f64>, size: ImageSize) -> Vec<(Follows, bool)> {
    let mut coverage = vec![0.0; size.pixels()];
    renderer.object_coverage(drawing, size, &mut Default::default(), &mut coverage).unwrap();
    let unit = size.unit_px() as f64;
    let bends = |distance: f64| renderer.coverage.edge.law == EdgeLaw::Distance && distance < BEND_STEPS * step(1.0);
    let pixel = |(i, &coverage): (usize, &f64)| {
        if coverage <= 0.0 {
            return (Follows::Beyond, false);
        }
        if coverage >= 1.0 {
            return (Follows::Full, false);
        }
        let center = [i % size.width(), i / size.width()].map(|k| (k as f64 + 0.5) / unit);
        let (follows, distance) = closest(drawing.rings(0), center);
        (follows, bends(distance) && matches!(follows, Follows::Vertex(_)))
    };
    coverage.iter().enumerate().map(pixel).collect()
}

/// The closest part of closed rings, and how far it is.
fn closest(rings: Rings<'_, f64>, [x, y]: [f64; 2]) -> (Follows, f64) {
    let mut least = (Follows::Beyond, f64::INFINITY);
    let edges = rings
        .ranges()
        .flat_map(|ring| ring.clone().map(move |k| (k, if k + 1 < ring.end { k + 1 } else { ring.start })));
    for (from, to) in edges {
        let (a, b) = (rings.vertices[from], rings.vertices[to]);
        let along = [b[0] - a[0], b[1] - a[1]];
        let away = [x - a[0], y - a[1]];
        let position = (away[0] * along[0] + away[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
        let (follows, u) = if position <= 0.0 {
            (Follows::Vertex(from), 0.0)
        } else if position >= 1.0 {
            (Follows::Vertex(to), 1.0)
        } else {
            (Follows::Edge(from), position)
        };
        let distance = (away[0] - u * along[0]).hypot(away[1] - u * along[1]);
        if distance < least.1 {
            least = (follows, distance);
        }
    }
    least
}
