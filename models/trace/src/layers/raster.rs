//! Which pixels an outline covers: the check that a layer hides nothing that lies behind it, and shows all that is its own.

use alloc::vec::Vec;

use crate::partition::Partition;

/// Pixels that an outline gets wrong.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Wrong {
    /// Pixels of its own that it does not cover.
    pub(super) bare: usize,
    /// Pixels of what lies behind it that it covers.
    pub(super) hidden: usize,
}

/// Compares what polygons (pixels, even-odd) cover with what they should; pixels that are mixed count for neither.
///
/// `wanted`: Some(true) for pixels to cover, Some(false) for those not to, none where either will do.
pub(super) fn compare(partition: &Partition, polygons: &[Vec<[f64; 2]>], wanted: impl Fn(usize) -> Option<bool>) -> Wrong {
    let [width, height] = partition.size;
    let mut wrong = Wrong::default();
    let mut crossings: Vec<f64> = Vec::new();
    for y in 0..height {
        crossings.clear();
        let center = y as f64 + 0.5;
        for polygon in polygons {
            let mut last = polygon[polygon.len() - 1];
            for &point in polygon {
                let (a, b) = (last, point);
                if (a[1] <= center) != (b[1] <= center) {
                    crossings.push(a[0] + (center - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
                }
                last = point;
            }
        }
        crossings.sort_by(f64::total_cmp);
        let mut crossed = 0;
        for x in 0..width {
            while crossed < crossings.len() && crossings[crossed] <= x as f64 + 0.5 {
                crossed += 1;
            }
            let i = y * width + x;
            if partition.shares[i] < 0.9 {
                continue;
            }
            match (wanted(i), crossed % 2 == 1) {
                (Some(true), false) => wrong.bare += 1,
                (Some(false), true) => wrong.hidden += 1,
                _ => (),
            }
        }
    }
    wrong
}
