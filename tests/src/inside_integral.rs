//! A number that depends on what an outline encloses, not on the order of its vertices: the judge of outlines whose crossings
//! were resolved.

use dvp_core::shape::{AnyShape, FillRule, Rings};

/// A number that depends on what an outline encloses alone, and its gradient with respect to the vertices: the integral of
/// 1 + x - 2 y + 3 x y over the inside, rings that turn from +y to +x subtracted.
#[must_use]
pub fn integral(rings: Rings<'_, f64>) -> (f64, Vec<[f64; 2]>) {
    // By Green's theorem it is the integral of (x + x^2 / 2 - 2 x y + 3 x^2 y / 2) dy along the rings, of degree 4 along an edge: three points
    // of Gauss are exact.
    const GAUSS: [(f64, f64); 3] =
        [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
    let (mut sum, mut grad) = (0.0, vec![[0.0; 2]; rings.vertices.len()]);
    for range in rings.ranges() {
        for i in range.clone() {
            let j = if i + 1 < range.end { i + 1 } else { range.start };
            let ([px, py], [qx, qy]) = (rings.vertices[i], rings.vertices[j]);
            for (t, weight) in GAUSS {
                let (x, y) = (px + t * (qx - px), py + t * (qy - py));
                let value = x + x * x / 2.0 - 2.0 * x * y + 1.5 * x * x * y;
                let (by_x, by_y) = (1.0 + x - 2.0 * y + 3.0 * x * y, -2.0 * x + 1.5 * x * x);
                let height = weight * (qy - py);
                sum += value * height;
                for (k, share, sign) in [(i, 1.0 - t, -1.0), (j, t, 1.0)] {
                    grad[k][0] += by_x * share * height;
                    grad[k][1] += by_y * share * height + sign * weight * value;
                }
            }
        }
    }
    (sum, grad)
}

/// Whether the outline is made by resolving crossings, so that the order of its vertices may change at any number.
#[must_use]
pub fn is_resolved(shape: &AnyShape<f64>) -> bool {
    match shape {
        AnyShape::Path(path) => path.fill == FillRule::NonZero,
        AnyShape::Stroke(_) => true,
        _ => false,
    }
}
