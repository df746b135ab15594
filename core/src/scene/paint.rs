//! What objects are filled with.

use super::{ColorRamp, ColorStop};
use crate::real::Real;

/// What an object is filled with.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Paint<T> {
    /// One color everywhere, RGB, [0, 1].
    Flat([T; 3]),
    /// Colors that change from place to place, in the object's own frame.
    Ramp(ColorRamp<T>),
}

impl<T> From<[T; 3]> for Paint<T> {
    fn from(color: [T; 3]) -> Self {
        Self::Flat(color)
    }
}

impl<T: Real> Paint<T> {
    /// The one color, RGB, [0, 1]; of a ramp the mean of its stops (black without any).
    #[inline]
    #[must_use]
    pub fn color(&self) -> [T; 3] {
        match self {
            Self::Flat(color) => *color,
            Self::Ramp(ramp) => {
                let share = T::of_usize(ramp.stops.len().max(1)).recip();
                [0, 1, 2].map(|i| share * ramp.stops.iter().map(|stop| stop.color[i]).sum())
            }
        }
    }

    /// Moves to another color: of a ramp all stops are moved alike, so that [`Self::color`] is `color` then.
    pub fn set_color(&mut self, color: [T; 3]) {
        let old = self.color();
        match self {
            Self::Flat(own) => *own = color,
            Self::Ramp(ramp) => {
                for stop in &mut ramp.stops {
                    for i in 0..3 {
                        stop.color[i] += color[i] - old[i];
                    }
                }
            }
        }
    }

    /// The one color, or that of every stop, to write to.
    pub fn colors_mut(&mut self) -> impl Iterator<Item = &mut [T; 3]> {
        let (flat, stops) = match self {
            Self::Flat(color) => (Some(color), None),
            Self::Ramp(ramp) => (None, Some(&mut ramp.stops)),
        };
        flat.into_iter().chain(stops.into_iter().flatten().map(|stop| &mut stop.color))
    }

    /// The ramp, if it is one.
    #[inline]
    #[must_use]
    pub fn ramp(&self) -> Option<&ColorRamp<T>> {
        match self {
            Self::Flat(_) => None,
            Self::Ramp(ramp) => Some(ramp),
        }
    }

    /// The same paint in another precision, every number rounded to the nearest.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Paint<U> {
        let color = |color: [T; 3]| color.map(|v| U::of(v.as_f64()));
        match self {
            Self::Flat(own) => Paint::Flat(color(*own)),
            Self::Ramp(ColorRamp { kind, stops }) => {
                let stop =
                    |stop: &ColorStop<T>| ColorStop { offset: U::of(stop.offset.as_f64()), color: color(stop.color) };
                Paint::Ramp(ColorRamp { kind: kind.cast(), stops: stops.iter().map(stop).collect() })
            }
        }
    }
}
