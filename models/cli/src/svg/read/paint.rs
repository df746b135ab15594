//! Paints to colors and an opacity.

use dvp_core::Pose;
use dvp_core::scene::{ColorRamp, Paint};
use kurbo::Affine;
use usvg::Opacity;

use super::gradient;
use super::losses::Losses;

/// What a shape is painted with.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Coat {
    /// The points of a ramp stand in the drawing, scene units.
    pub(super) paint: Paint<f64>,
    /// [0, 1].
    pub(super) opacity: f64,
}

impl Coat {
    /// The same paint, its ramp in the frame of an object that stands at `pose`.
    pub(super) fn into_frame(self, pose: &Pose<f64>) -> Paint<f64> {
        match (self.paint, pose.inverse()) {
            (Paint::Ramp(ColorRamp { kind, stops }), Some(back)) => {
                Paint::Ramp(ColorRamp { kind: kind.posed(&back), stops })
            }
            // An object of no size has no place for more than one color.
            (paint, _) => Paint::Flat(paint.color()),
        }
    }
}

/// What a scene has for a paint; none for what paints nothing. `to_scene` leads from the user space of the shape to scene units.
pub(super) fn coat(paint: &usvg::Paint, opacity: Opacity, to_scene: Affine, losses: &mut Losses) -> Option<Coat> {
    let coat = match paint {
        usvg::Paint::Color(color) => Coat { paint: rgb(*color).into(), opacity: 1.0 },
        usvg::Paint::LinearGradient(own) => gradient::coat(own, gradient::linear(own, to_scene), losses)?,
        usvg::Paint::RadialGradient(own) => gradient::coat(own, gradient::radial(own, to_scene), losses)?,
        usvg::Paint::Pattern(_) => {
            losses.add("pattern: not painted");
            return None;
        }
    };
    let opacity = coat.opacity * f64::from(opacity.get());
    (opacity > 0.0).then_some(Coat { opacity, ..coat })
}

pub(super) fn rgb(color: usvg::Color) -> [f64; 3] {
    [color.red, color.green, color.blue].map(|value| f64::from(value) / 255.0)
}
