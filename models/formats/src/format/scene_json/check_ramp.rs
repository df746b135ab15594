//! Checks the colors of objects, and their ramps.

use dvp_core::Real;
use dvp_core::scene::{ColorRamp, ColorStop, Paint, RampKind};

use super::super::error::FormatError;
use super::check::Checker;
use super::{ColorStopJson, ObjectJson, RampJson, RampKindJson};

/// Most colors of a ramp.
const MAX_STOPS: usize = 256;
/// Largest offset of a color: a ramp is no millionth of what is painted with it.
const MAX_OFFSET: f64 = 1e6;

impl Checker<'_> {
    /// What the object at `own` is painted with. Its one color is checked as well where a ramp paints instead.
    pub(super) fn paint<T: Real>(&self, own: &str, from: &ObjectJson) -> Result<Paint<T>, FormatError> {
        let color = self.color(&format!("{own}.color"), from.color)?;
        match &from.ramp {
            None => Ok(Paint::Flat(color)),
            Some(ramp) => self.ramp(&format!("{own}.ramp"), ramp).map(Paint::Ramp),
        }
    }

    fn ramp<T: Real>(&self, field: &str, ramp: &RampJson) -> Result<ColorRamp<T>, FormatError> {
        let own = format!("{field}.points");
        let points: Vec<[T; 2]> = self.points(&own, &ramp.points)?;
        let kind = match (ramp.kind, &points[..]) {
            (RampKindJson::Linear, &[start, end]) => RampKind::Linear([start, end]),
            (RampKindJson::Radial, &[center, a, b]) => RampKind::Radial([center, a, b]),
            (kind, other) => {
                let (must, name) = match kind {
                    RampKindJson::Linear => (2, "linear"),
                    RampKindJson::Radial => (3, "radial"),
                };
                return self.wrong(own, format!("has {} points, must have {must} in a {name} ramp", other.len()));
            }
        };
        Ok(ColorRamp { kind, stops: self.stops(&format!("{field}.stops"), &ramp.stops)? })
    }

    fn stops<T: Real>(&self, field: &str, stops: &[ColorStopJson]) -> Result<Vec<ColorStop<T>>, FormatError> {
        if stops.is_empty() || stops.len() > MAX_STOPS {
            return self.wrong(field, format!("has {} stops, must have 1 to {MAX_STOPS}", stops.len()));
        }
        let mut least = -MAX_OFFSET;
        let mut checked = Vec::with_capacity(stops.len());
        for (k, stop) in stops.iter().enumerate() {
            let own = format!("{field}[{k}]");
            let offset = self.within(&format!("{own}.offset"), stop.offset, [-MAX_OFFSET, MAX_OFFSET])?;
            if stop.offset < least {
                return self.wrong(
                    format!("{own}.offset"),
                    format!("is {}, must be at least {least}, that of the stop before", stop.offset),
                );
            }
            least = stop.offset;
            checked.push(ColorStop { offset, color: self.color(&format!("{own}.color"), stop.color)? });
        }
        Ok(checked)
    }
}
