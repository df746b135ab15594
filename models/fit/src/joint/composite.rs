//! The color of a pixel that several objects cover, and how it follows their coverages and colors.

use dvp_core::Real;
use dvp_core::render::Compositing;

use super::JointScene;

/// An object at a pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cover<T> {
    pub(super) object: usize,
    pub(super) coverage: T,
    /// Derivative of the coverage with respect to x, y, log scale, rotation.
    pub(super) slope: [T; 4],
    /// Products and weights of compositing: derivative of a channel is `to_color` for the object's own color, and
    /// `to_coverage[c]` for its coverage.
    pub(super) to_color: T,
    pub(super) to_coverage: [T; 3],
}

/// Color of the pixel and its derivatives; the derivative with respect to the background is returned.
pub(super) fn composite<T: Real>(
    compositing: Compositing,
    scene: &JointScene<T>,
    covers: &mut [Cover<T>],
) -> ([T; 3], T) {
    let one = T::one();
    let background = scene.background;
    let mut clear = one;
    for cover in covers.iter() {
        clear *= one - cover.coverage * scene.objects[cover.object].confidence;
    }
    match compositing {
        Compositing::Blend => {
            let (mut total, mut mean) = (T::zero(), [T::zero(); 3]);
            let importance = |k: usize| ((scene.objects[k].confidence - one) * T::of(Compositing::SHARPNESS)).exp();
            for cover in covers.iter() {
                let weight = cover.coverage * importance(cover.object);
                total += weight;
                for c in 0..3 {
                    mean[c] += weight * scene.objects[cover.object].color[c];
                }
            }
            let total = total.max(T::of(Compositing::SMALLEST_WEIGHT));
            let mean = mean.map(|value| value / total);
            let alpha = one - clear;
            for at in 0..covers.len() {
                let mut others = one;
                for (j, cover) in covers.iter().enumerate() {
                    if j != at {
                        others *= one - cover.coverage * scene.objects[cover.object].confidence;
                    }
                }
                let object = &scene.objects[covers[at].object];
                let weight = importance(covers[at].object);
                covers[at].to_color = alpha * covers[at].coverage * weight / total;
                for c in 0..3 {
                    covers[at].to_coverage[c] = (mean[c] - background[c]) * object.confidence * others
                        + alpha * weight * (object.color[c] - mean[c]) / total;
                }
            }
            (core::array::from_fn(|c| background[c] + alpha * (mean[c] - background[c])), clear)
        }
        Compositing::Over => {
            let mut color = background;
            for at in 0..covers.len() {
                let object = &scene.objects[covers[at].object];
                let opacity = covers[at].coverage * object.confidence;
                let above = covers[at + 1..].iter().fold(one, |product, cover| {
                    product * (one - cover.coverage * scene.objects[cover.object].confidence)
                });
                covers[at].to_color = opacity * above;
                for c in 0..3 {
                    covers[at].to_coverage[c] = object.confidence * (object.color[c] - color[c]) * above;
                    color[c] += opacity * (object.color[c] - color[c]);
                }
            }
            (color, clear)
        }
    }
}
