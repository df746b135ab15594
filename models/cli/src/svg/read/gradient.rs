//! Gradients to color ramps, or where a scene has no such ramp to their mean color.

use dvp_core::scene::{ColorRamp, ColorStop, Paint, RampKind};
use kurbo::{Affine, Point, Vec2};
use usvg::{BaseGradient, LinearGradient, RadialGradient, SpreadMethod, Stop};

use super::losses::Losses;
use super::paint::{Coat, rgb};
use super::place::array;
use super::walk::affine_of;

/// Most stops of a ramp, as in scene files.
const MOST_STOPS: usize = 256;

/// Farthest point of a ramp, scene units, as in scene files.
const FARTHEST: f64 = 1e3;

/// The focus of a radial gradient may be so far off its center, and have so much of its radius.
const CENTERED: f64 = 1e-5;

/// Offsets nearer to each other are equal: usvg moves equal ones apart by the precision of 32 bits.
const STEP: f64 = 2.5e-7;

/// Where the colors of a gradient lie in the drawing, scene units; none where its points say nothing: its end is everywhere then.
type Kind = Option<RampKind<f64>>;

/// Where a gradient's colors lie, or what keeps it from being a ramp.
type Ramp = Result<Kind, &'static str>;

/// The ramp of a linear gradient. usvg has put bounding boxes into its transform; `to_scene` leads from there to scene units.
pub(super) fn linear(gradient: &LinearGradient, to_scene: Affine) -> Ramp {
    let affine = to_scene * affine_of(gradient.transform());
    let [x1, y1, x2, y2] = [gradient.x1(), gradient.y1(), gradient.x2(), gradient.y2()].map(f64::from);
    let way = Vec2::new(x2 - x1, y2 - y1);
    // Lines of one color stay parallel, but not at right angles to the way: only the part of the way that crosses them counts.
    let (across, way) = (turned(affine, Vec2::new(-way.y, way.x)), turned(affine, way));
    let along = way - across * (way.dot(across) / across.hypot2());
    let start = affine * Point::new(x1, y1);
    Ok(along.hypot2().is_normal().then(|| RampKind::Linear([start, start + along].map(array))))
}

/// The ramp of a radial gradient, as [`linear`].
pub(super) fn radial(gradient: &RadialGradient, to_scene: Affine) -> Ramp {
    let affine = to_scene * affine_of(gradient.transform());
    let [cx, cy, fx, fy] = [gradient.cx(), gradient.cy(), gradient.fx(), gradient.fy()].map(f64::from);
    let [radius, inner] = [gradient.r(), gradient.fr()].map(|radius| f64::from(radius.get()));
    if inner.max((fx - cx).hypot(fy - cy)) > CENTERED * radius {
        return Err("radialGradient with fx, fy or fr off its center: painted in its mean color");
    }
    let (a, b) = (turned(affine, Vec2::new(radius, 0.0)), turned(affine, Vec2::new(0.0, radius)));
    let center = affine * Point::new(cx, cy);
    Ok(a.cross(b).is_normal().then(|| RampKind::Radial([center, center + a, center + b].map(array))))
}

/// What a gradient paints with; none if it has no stops. What a ramp cannot say is lost.
pub(super) fn coat(gradient: &BaseGradient, ramp: Ramp, losses: &mut Losses) -> Option<Coat> {
    let stops = gradient.stops();
    let (first, last) = (stops.first()?, stops.last()?);
    let opacity = f64::from(last.opacity().get());
    let plain = |color: usvg::Color| Coat { paint: rgb(color).into(), opacity };
    let is_even = stops.iter().all(|stop| stop.opacity() == last.opacity());
    if is_even && stops.iter().all(|stop| stop.color() == first.color()) {
        return Some(plain(first.color()));
    }
    let loss = match ramp {
        _ if gradient.spread_method() != SpreadMethod::Pad => {
            "spreadMethod reflect or repeat: gradient painted in its mean color"
        }
        _ if !is_even => "stop-opacity that changes along a gradient: painted in its mean color",
        Err(loss) => loss,
        Ok(None) => return Some(plain(last.color())),
        Ok(Some(_)) if stops.len() > MOST_STOPS => "gradient of more than 256 stops: painted in its mean color",
        Ok(Some(kind)) => {
            if kind.points().as_flattened().iter().all(|value| value.abs() <= FARTHEST) {
                let paint = Paint::Ramp(ColorRamp { kind, stops: color_stops(stops) });
                return Some(Coat { paint, opacity });
            }
            "gradient of points too far away: painted in its mean color"
        }
    };
    losses.add(loss);
    Some(mean(stops, last))
}

/// A vector under a transform.
fn turned(affine: Affine, vector: Vec2) -> Vec2 {
    let [a, b, c, d, _, _] = affine.as_coeffs();
    Vec2::new(a * vector.x + c * vector.y, b * vector.x + d * vector.y)
}

/// The stops in their order, steps between colors at one place.
fn color_stops(stops: &[Stop]) -> Vec<ColorStop<f64>> {
    let mut found: Vec<ColorStop<f64>> = Vec::with_capacity(stops.len());
    for stop in stops {
        let mut offset = f64::from(stop.offset().get());
        if let Some(before) = found.last_mut() {
            offset = offset.max(before.offset);
            if offset - before.offset <= STEP {
                // Of two equal offsets usvg moves the first one down, at 0 the second one up.
                if before.offset > 0.0 {
                    before.offset = offset;
                } else {
                    offset = before.offset;
                }
            }
        }
        found.push(ColorStop { offset, color: rgb(stop.color()) });
    }
    found
}

/// The mean along the whole gradient, colors weighted with their opacity; that of the last stop if all of it is transparent.
fn mean(stops: &[Stop], last: &Stop) -> Coat {
    let offset = |stop: &Stop| f64::from(stop.offset().get());
    let mut sum = Sum::default();
    if let Some(first) = stops.first() {
        sum.add(first, offset(first));
    }
    sum.add(last, 1.0 - offset(last));
    for (start, end) in stops.iter().zip(stops.iter().skip(1)) {
        let half = 0.5 * (offset(end) - offset(start)).max(0.0);
        sum.add(start, half);
        sum.add(end, half);
    }
    let Sum { color, weight } = sum;
    if weight > 0.0 {
        return Coat { paint: color.map(|value| value / weight).into(), opacity: weight };
    }
    Coat { paint: rgb(last.color()).into(), opacity: f64::from(last.opacity().get()) }
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
