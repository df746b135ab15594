//! What of an object's outline is seen, and where the rest of it may run.

use alloc::vec::Vec;

use dvp_core::{ImageSize, Real};

use crate::segment::Segmentation;

/// Pixels around a point of an outline in which its soft pixels lie, and in which what hides it does.
const SEEN_REACH: usize = 1;
const HIDDEN_REACH: usize = 2;

/// What the picture says of one object's outline.
#[derive(Debug)]
pub(crate) struct Sight<'a, T> {
    segmentation: &'a Segmentation<T>,
    object: u32,
    size: ImageSize,
    /// Indices of the pixels at the object's rim, ascending.
    rim: Vec<usize>,
}

impl<'a, T: Real> Sight<'a, T> {
    /// `pixels` are the soft ones of the outline, with their coverage.
    pub(crate) fn new(
        pixels: &[([u32; 2], T)],
        object: u32,
        segmentation: &'a Segmentation<T>,
        size: ImageSize,
    ) -> Self {
        let mut rim: Vec<usize> = pixels.iter().map(|&([x, y], _)| y as usize * size.width() + x as usize).collect();
        rim.sort_unstable();
        Self { segmentation, object, size, rim }
    }

    /// Whether the outline is seen at the point (px).
    pub(crate) fn shows(&self, point: [T; 2]) -> bool {
        self.around(point, SEEN_REACH, |index| self.rim.binary_search(&index).is_ok())
    }

    /// Whether the outline may pass through the point (px): it is seen there, or it would not be.
    pub(crate) fn allows(&self, point: [T; 2]) -> bool {
        let [x, y] = point;
        let (width, height) = (T::of_usize(self.size.width()), T::of_usize(self.size.height()));
        let outside = x < T::one() || y < T::one() || x > width - T::one() || y > height - T::one();
        outside
            || self.around(point, HIDDEN_REACH, |index| {
                self.rim.binary_search(&index).is_ok() || self.segmentation.may_be_hidden(index, self.object)
            })
    }

    /// Whether any pixel within `reach` of that of the point is so.
    fn around(&self, [x, y]: [T; 2], reach: usize, is: impl Fn(usize) -> bool) -> bool {
        let range = |v: T, extent: usize| {
            let at = v.to_count();
            at.saturating_sub(reach).min(extent)..(at + reach + 1).min(extent)
        };
        let (columns, mut rows) = (range(x, self.size.width()), range(y, self.size.height()));
        rows.any(|row| columns.clone().any(|column| is(row * self.size.width() + column)))
    }
}
