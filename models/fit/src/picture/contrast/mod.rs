//! Pictures that take a small part of the levels of their file, as the 12 bits of a camera do in a file of 16: read as if they took most of them.

#[cfg(test)]
mod tests;

use dvp_core::ImageView;

use crate::Fit;
use crate::colors::is_rounded;
use crate::stretched::Stretched;

/// Largest range of values that is a small part, of 1: that of 14 bits in a file of 16 is a quarter.
const SMALL: f32 = 0.3;
/// What the darkest and the brightest value become: what noise adds to them is not cut off.
const ENDS: [f32; 2] = [0.05, 0.95];

/// The picture stretched; none if its values take a large part of [0, 1], or are those of 8 bits: where there are no levels between these, stretching
/// makes steps of them.
#[inline(never)]
pub(super) fn stretched(image: &ImageView<'_, f32>) -> Option<Stretched<f32>> {
    let [low, high] = range(image)?;
    if is_rounded(image.data().iter().copied()) {
        return None;
    }
    Some(Stretched::new(image, [low; 3], ENDS[0], (ENDS[1] - ENDS[0]) / (high - low)))
}

/// A fit of the stretched picture as one of the picture.
pub(super) fn restored(stretched: &Stretched<f32>, fit: Fit<f32>) -> Fit<f32> {
    let mut fit = stretched.undo(fit);
    let colors = fit.scene.objects.iter_mut().flat_map(|object| object.paint.colors_mut());
    for color in colors.chain([&mut fit.scene.background]) {
        *color = color.map(|value| value.clamp(0.0, 1.0));
    }
    fit
}

/// The darkest and the brightest value of two pixels beside one another, since single ones may be a camera's dead ones; none if these are far apart, or one.
fn range(image: &ImageView<'_, f32>) -> Option<[f32; 2]> {
    let width = image.size().width();
    let [mut low, mut high] = [f32::INFINITY, f32::NEG_INFINITY];
    for channel in [0, 1, 2].map(|c| image.channel(c)) {
        let mut above: Option<&[f32]> = None;
        for row in channel.chunks_exact(width) {
            let beside = row.iter().zip(&row[1..]).chain(above.unwrap_or_default().iter().zip(row));
            for (&a, &b) in beside {
                low = low.min(a.max(b));
                high = high.max(a.min(b));
            }
            if high - low > SMALL {
                return None;
            }
            above = Some(row);
        }
    }
    (high > low).then_some([low, high])
}
