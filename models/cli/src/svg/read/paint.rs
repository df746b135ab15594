//! Paints to a color and an opacity.

use usvg::{Opacity, Paint, Stop};

use super::losses::Losses;

/// RGB and opacity, each in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FlatPaint {
    pub(super) color: [f64; 3],
    pub(super) opacity: f64,
}

/// The one color nearest to a paint; none for what paints nothing.
pub(super) fn flat(paint: &Paint, opacity: Opacity, losses: &mut Losses) -> Option<FlatPaint> {
    let opacity = f64::from(opacity.get());
    let flat = match paint {
        Paint::Color(color) => FlatPaint { color: rgb(*color), opacity },
        Paint::LinearGradient(gradient) => {
            losses.add("linearGradient: painted in its mean color");
            mean(gradient.stops(), opacity)?
        }
        Paint::RadialGradient(gradient) => {
            losses.add("radialGradient: painted in its mean color");
            mean(gradient.stops(), opacity)?
        }
        Paint::Pattern(_) => {
            losses.add("pattern: not painted");
            return None;
        }
    };
    (flat.opacity > 0.0).then_some(flat)
}

fn rgb(color: usvg::Color) -> [f64; 3] {
    [color.red, color.green, color.blue].map(|value| f64::from(value) / 255.0)
}

/// The mean along the whole gradient, colors weighted with their opacity; none if all of it is transparent.
fn mean(stops: &[Stop], opacity: f64) -> Option<FlatPaint> {
    let offset = |stop: &Stop| f64::from(stop.offset().get());
    let alpha = |stop: &Stop| f64::from(stop.opacity().get());
    let (first, last) = (stops.first()?, stops.last()?);
    let mut sum = Sum::default();
    sum.add(first, offset(first));
    sum.add(last, 1.0 - offset(last));
    for (start, end) in stops.iter().zip(stops.iter().skip(1)) {
        let half = 0.5 * (offset(end) - offset(start)).max(0.0);
        sum.add(start, half);
        sum.add(end, half);
    }
    let Sum { color, weight } = sum;
    if weight > 0.0 {
        return Some(FlatPaint { color: color.map(|value| value / weight), opacity: opacity * weight });
    }
    Some(FlatPaint { color: rgb(last.color()), opacity: opacity * alpha(last) })
}

/// Colors times opacities, and opacities, along a gradient of length 1.
#[derive(Default)]
struct Sum {
    color: [f64; 3],
    weight: f64,
}

impl Sum {
    fn add(&mut self, stop: &Stop, length: f64) {
        let weight = length * f64::from(stop.opacity().get());
        self.color.iter_mut().zip(rgb(stop.color())).for_each(|(sum, value)| *sum += weight * value);
        self.weight += weight;
    }
}
