//! Things that reach as far as the picture does: stripes behind a round opening end at nothing that is seen.

use alloc::vec::Vec;

use dvp_core::Vec2;

use super::link::Tip;
use crate::sample::{RingSamples, Sample};
use crate::tuning;

/// Pixels from one place of the border to the next that stands for it.
const STEP: f64 = 4.0;

/// The rings with their open stretches led straight to the border of the picture and along it to the next stretch, where nothing is seen on
/// the way (`is_seen`, of a place in pixels); none if no stretch can be led so. `size`: width and height, pixels.
pub(super) fn bordered(
    rings: &[RingSamples],
    size: [usize; 2],
    is_seen: impl Fn(Vec2<f64>) -> bool,
) -> Option<Vec<RingSamples>> {
    let border = Border { size: size.map(|side| side as f64) };
    let mut is_led = false;
    let mut led: Vec<RingSamples> = Vec::new();
    for ring in rings {
        let count = ring.runs.len();
        let mut runs = Vec::new();
        for (k, run) in ring.runs.iter().enumerate() {
            runs.push(run.clone());
            let next = &ring.runs[(k + 1) % count];
            let tips = Tip::of(run.iter().rev()).zip(Tip::of(next.iter())).filter(|_| !ring.closed);
            let exits = tips.and_then(|(from, to)| Some([border.exit(&from, &is_seen)?, border.exit(&to, &is_seen)?]));
            if let Some([from, to]) = exits {
                is_led = true;
                runs.push(border.run(from, to));
            }
        }
        led.push(RingSamples { runs, closed: ring.closed });
    }
    is_led.then_some(led)
}

/// The border of a picture. Its places are told by their way from the upper left corner, pixels, with the picture on the right hand.
struct Border {
    size: [f64; 2],
}

impl Border {
    /// Where the straight way on from a tip leaves the picture; none if something else is seen on it.
    fn exit(&self, tip: &Tip, is_seen: impl Fn(Vec2<f64>) -> bool) -> Option<f64> {
        let [width, height] = self.size;
        let until = |at: f64, along: f64, side: f64| match along {
            along if along > 1e-9 => (side - at) / along,
            along if along < -1e-9 => -at / along,
            _ => f64::INFINITY,
        };
        let across = until(tip.at.x, tip.direction.x, width);
        let down = until(tip.at.y, tip.direction.y, height);
        let length = across.min(down).max(0.0);
        let is_free = (2..length as usize).all(|k| !is_seen(tip.at + tip.direction * k as f64));
        let at = tip.at + tip.direction * length;
        let place = match (across < down, tip.direction.x > 0.0, tip.direction.y > 0.0) {
            (true, true, _) => width + at.y,
            (true, false, _) => 2.0 * width + height + (height - at.y),
            (false, _, true) => width + height + (width - at.x),
            (false, _, false) => at.x,
        };
        (is_free && length.is_finite()).then_some(place)
    }

    /// Samples of the border from one place to another.
    fn run(&self, from: f64, to: f64) -> Vec<Sample> {
        let [width, height] = self.size;
        let whole = 2.0 * (width + height);
        let length = if to < from { to + whole - from } else { to - from };
        let count = (length / STEP) as usize + 1;
        let at = |k: usize| (from + length * (k as f64 + 0.5) / count as f64) % whole;
        (0..count).map(|k| self.sample(at(k))).collect()
    }

    fn sample(&self, place: f64) -> Sample {
        let [width, height] = self.size;
        let (upright, level) = (Vec2::new(0.0, 1.0), Vec2::new(1.0, 0.0));
        let (point, axis) = if place < width {
            (Vec2::new(place, 0.0), upright)
        } else if place < width + height {
            (Vec2::new(width, place - width), level)
        } else if place < 2.0 * width + height {
            (Vec2::new(2.0 * width + height - place, height), upright)
        } else {
            (Vec2::new(0.0, 2.0 * (width + height) - place), level)
        };
        Sample::new(point, axis, tuning::BORDER_SIGMA)
    }
}
