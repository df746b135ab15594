//! Checks what is known of the numbers of a scene.

use dvp_core::Real;
use dvp_core::shape::{AnyShape, Shape as _};

use super::super::error::FormatError;
use super::check::Checker;
use super::known::doubt_names;
use super::{DoubtJson, ObjectKnownJson, SceneKnownJson};

const SHARE: [f64; 2] = [0.0, 1.0];

impl Checker<'_> {
    pub(super) fn scene_known(&self, known: &SceneKnownJson) -> Result<(), FormatError> {
        self.share("known.unexplained", known.unexplained)?;
        self.at_least("known.noise", known.noise.unwrap_or(0.0), 0.0)?;
        match known.doubts.iter().enumerate().find(|(_, doubt)| !doubt_names().any(|name| name == doubt.as_str())) {
            Some((k, doubt)) => self.wrong(
                format!("known.doubts[{k}]"),
                format!("is \"{doubt}\", must be one of {}", doubt_names().collect::<Vec<_>>().join(", ")),
            ),
            None => Ok(()),
        }
    }

    pub(super) fn object_known<T: Real>(
        &self,
        field: &str,
        known: &ObjectKnownJson,
        shape: &AnyShape<T>,
        object_count: usize,
    ) -> Result<(), FormatError> {
        self.share(&format!("{field}.expected_iou"), known.expected_iou)?;
        if let Some(deviations) = &known.deviations {
            let one = |name: &str, value: f64| self.at_least(&format!("{field}.deviations.{name}"), value, 0.0);
            let translation = deviations.translation.iter().flatten().map(|&value| ("translation", value));
            let scale = deviations.scale.map(|value| ("scale", value));
            let rotation = deviations.rotation.map(|value| ("rotation", value));
            let color = deviations.color.iter().flatten().map(|&value| ("color", value));
            let mut own = translation.chain(scale).chain(rotation).chain(color);
            own.try_for_each(|(name, value)| one(name, value))?;
            if !deviations.numbers.is_empty() {
                let names = shape.number_names();
                for (name, &value) in &deviations.numbers {
                    if !names.contains(name) {
                        let kind = shape.kind();
                        return self.wrong(
                            format!("{field}.deviations.numbers"),
                            format!("names \"{name}\", which is no number of this {kind}"),
                        );
                    }
                    one(&format!("numbers[\"{name}\"]"), value)?;
                }
            }
        }
        let mut doubts = known.doubts.iter().enumerate();
        doubts.try_for_each(|(k, doubt)| self.doubt(&format!("{field}.doubts[{k}]"), doubt, object_count))
    }

    fn doubt(&self, field: &str, doubt: &DoubtJson, object_count: usize) -> Result<(), FormatError> {
        match *doubt {
            DoubtJson::Symmetry { .. } => Ok(()),
            DoubtJson::Merged { other, .. } if other >= object_count => self.wrong(
                format!("{field}.other"),
                format!("is {other}, must be the index of one of the {object_count} objects"),
            ),
            DoubtJson::Cropped { visible } | DoubtJson::Merged { visible, .. } => {
                self.share(&format!("{field}.visible"), Some(visible))
            }
            DoubtJson::Hidden { share, .. } => self.share(&format!("{field}.share"), Some(share)),
            DoubtJson::Twin { ratio, .. } => self.at_least(&format!("{field}.ratio"), ratio, 1.0),
        }
    }

    fn at_least(&self, field: &str, value: f64, least: f64) -> Result<(), FormatError> {
        if value >= least { Ok(()) } else { self.wrong(field, format!("is {value}, must be at least {least}")) }
    }

    fn share(&self, field: &str, share: Option<f64>) -> Result<(), FormatError> {
        share.map_or(Ok(()), |share| self.within::<f64>(field, share, SHARE).map(|_| ()))
    }
}
