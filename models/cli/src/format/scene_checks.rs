//! From the text's structure to a scene with every number checked, and back.

use dvp_core::render::{Compositing, EdgeLaw, EdgeProfile};
use dvp_core::shape::{SYMMETRY_TOLERANCE, Symmetry};
use dvp_core::{Efd, ImageSize, Object, Pose, Real, Scene};
use dvp_fit::Bank;

use super::error::{FormatError, Place};
use super::scene_json::{CompositingJson, EdgeJson, EdgeLawJson, ObjectJson, SceneJson};

/// Most objects of a scene.
const MAX_OBJECTS: usize = 10_000;
/// Most harmonics of a shape.
const MAX_HARMONICS: usize = 1024;
/// Largest coordinate or scale, scene units: a thousand images away.
const MAX_COORDINATE: f64 = 1e3;
/// ln(1e4 - 1) - 5: the reference cuts at d2 = ln(1e4 - 1) sigma, which is its offset plus this many sigma.
const CUT_SIGMAS: f64 = 4.210_240_366_975_849;

/// Where coverage becomes 0, for a profile that does not say: where it falls to 0.0146, as in the reference profile, and in
/// distance to 0.001.
#[must_use]
pub fn edge_cut(law: EdgeLaw, offset: f64, sigma: f64) -> f64 {
    match law {
        EdgeLaw::SquaredDistance => offset + CUT_SIGMAS * sigma,
        _ => offset + EdgeProfile::distance(sigma).cut,
    }
}

/// Checks values and says where a bad one stands.
struct Checker<'a> {
    place: &'a Place,
}

impl Checker<'_> {
    fn wrong<V>(&self, field: impl Into<String>, problem: impl Into<String>) -> Result<V, FormatError> {
        Err(FormatError::Field { place: self.place.clone(), field: field.into(), problem: problem.into() })
    }

    fn within<T: Real>(&self, field: &str, value: f64, [low, high]: [f64; 2]) -> Result<T, FormatError> {
        if (low..=high).contains(&value) {
            Ok(T::of(value))
        } else {
            self.wrong(field, format!("is {value}, must be from {low} to {high}"))
        }
    }

    fn above_zero<T: Real>(&self, field: &str, value: f64, high: f64) -> Result<T, FormatError> {
        let real = T::of(value);
        if value <= high && real > T::zero() {
            Ok(real)
        } else {
            self.wrong(field, format!("is {value}, must be above 0 and at most {high}"))
        }
    }

    fn color<T: Real>(&self, field: &str, color: [f64; 3]) -> Result<[T; 3], FormatError> {
        let mut checked = [T::zero(); 3];
        for (to, value) in checked.iter_mut().zip(color) {
            *to = self.within(field, value, [0.0, 1.0])?;
        }
        Ok(checked)
    }

    fn object<T: Real>(&self, k: usize, from: &ObjectJson, bank: Option<&Bank<T>>) -> Result<Object<T>, FormatError> {
        let field = |name: &str| format!("objects[{k}].{name}");
        let rotation = match (from.rotation, from.rotation_vec) {
            (Some(angle), None) => angle,
            (None, Some([sine, cosine])) if sine.hypot(cosine) > 0.0 => sine.atan2(cosine),
            (None, Some(_)) => return self.wrong(field("rotation_vec"), "is [0, 0], which is no direction"),
            _ => return self.wrong(field("rotation"), "is needed: either `rotation` or `rotation_vec`"),
        };
        let reach = [-MAX_COORDINATE, MAX_COORDINATE];
        let place = field("translation");
        let translation =
            [self.within(&place, from.translation[0], reach)?, self.within(&place, from.translation[1], reach)?];
        let pose = Pose {
            translation,
            scale: self.above_zero(&field("scale"), from.scale, MAX_COORDINATE)?,
            rotation: self.within(&field("rotation"), rotation, reach)?,
        };
        let prototype = match (from.prototype, from.shape) {
            (Some(_), Some(_)) => return self.wrong(field("shape"), "is the old name of `prototype`; keep one"),
            (index, None) | (None, index) => index,
        };
        Ok(Object::of_efd(
            pose,
            self.color(&field("color"), from.color)?,
            self.within(&field("confidence"), from.confidence, [0.0, 1.0])?,
            self.efd(&field("efd"), from.efd.as_deref(), prototype, bank)?,
            prototype,
        ))
    }

    fn efd<T: Real>(
        &self,
        field: &str,
        rows: Option<&[[f64; 4]]>,
        prototype: Option<usize>,
        bank: Option<&Bank<T>>,
    ) -> Result<Efd<T>, FormatError> {
        match (rows, prototype, bank) {
            (Some(rows), _, _) => self.efd_rows(field, rows),
            (None, None, _) => self.wrong(field, "is missing, and there is no `prototype` to take it from"),
            (None, Some(k), None) => self.wrong(
                field,
                format!("is missing, and there is no bank to take prototype {k} from; name one with --bank"),
            ),
            (None, Some(k), Some(bank)) => match bank.prototypes.get(k) {
                Some((_, efd)) => Ok(efd.clone()),
                None => self.wrong(
                    field,
                    format!("is missing, and the bank has only {} prototypes: no number {k}", bank.prototypes.len()),
                ),
            },
        }
    }

    fn efd_rows<T: Real>(&self, field: &str, rows: &[[f64; 4]]) -> Result<Efd<T>, FormatError> {
        if rows.is_empty() || rows.len() > MAX_HARMONICS {
            return self.wrong(field, format!("has {} rows, must have 1 to {MAX_HARMONICS}", rows.len()));
        }
        let mut checked = Vec::with_capacity(rows.len());
        for (n, row) in rows.iter().enumerate() {
            let mut to = [T::zero(); 4];
            for (to, &value) in to.iter_mut().zip(row) {
                *to = self.within(&format!("{field}[{n}]"), value, [-MAX_COORDINATE, MAX_COORDINATE])?;
            }
            checked.push(to);
        }
        Ok(Efd::new(checked))
    }

    fn edge<T: Real>(&self, edge: EdgeJson) -> Result<EdgeProfile<T>, FormatError> {
        let law = match edge.law {
            EdgeLawJson::SquaredDistance => EdgeLaw::SquaredDistance,
            EdgeLawJson::Distance => EdgeLaw::Distance,
            EdgeLawJson::Area if edge == (EdgeJson { law: edge.law, ..EdgeJson::default() }) => {
                return Ok(EdgeProfile::area());
            }
            EdgeLawJson::Area => return self.wrong("edge.law", "is \"area\", which has no offset, sigma or cut"),
        };
        let (Some(offset), Some(sigma)) = (edge.offset, edge.sigma) else {
            return self.wrong("edge", "needs offset and sigma; only \"law\":\"area\" has none");
        };
        let cut = edge.cut.unwrap_or_else(|| edge_cut(law, offset, sigma));
        Ok(EdgeProfile {
            law,
            offset: self.within("edge.offset", offset, [-4.0, 4.0])?,
            sigma: self.above_zero("edge.sigma", sigma, 4.0)?,
            cut: self.within("edge.cut", cut, [offset, 64.0])?,
        })
    }
}

/// The rows of a bank's prototype, checked as those of an object.
pub(super) fn checked_efd<T: Real>(place: &Place, field: &str, rows: &[[f64; 4]]) -> Result<Efd<T>, FormatError> {
    Checker { place }.efd_rows(field, rows)
}

impl SceneJson {
    /// The scene, every number checked; shapes that are only named come from `bank`.
    ///
    /// # Errors
    /// [`FormatError::Field`] with the first value that is missing or out of range.
    pub fn to_scene<T: Real>(&self, bank: Option<&Bank<T>>, place: &Place) -> Result<Scene<T>, FormatError> {
        let checker = Checker { place };
        if self.objects.len() > MAX_OBJECTS {
            return checker.wrong("objects", format!("has {} entries, at most {MAX_OBJECTS}", self.objects.len()));
        }
        let objects = self.objects.iter().enumerate().map(|(k, object)| checker.object(k, object, bank));
        Ok(Scene {
            background: checker.color("background", self.background)?,
            transparent: false,
            objects: objects.collect::<Result<_, _>>()?,
            edge: self.edge.map_or_else(|| Ok(EdgeProfile::reference()), |edge| checker.edge(edge))?,
            compositing: match self.compositing {
                CompositingJson::Blend => Compositing::Blend,
                CompositingJson::Over => Compositing::Over,
            },
        })
    }

    /// The image size, if the file gives one.
    ///
    /// # Errors
    /// [`FormatError::Field`] if only one side is given, or the size is empty or too large.
    pub fn size(&self, place: &Place) -> Result<Option<ImageSize>, FormatError> {
        match (self.width, self.height) {
            (None, None) => Ok(None),
            (Some(width), Some(height)) => match ImageSize::new(width, height) {
                Ok(size) => Ok(Some(size)),
                Err(error) => Checker { place }.wrong("width", error.to_string()),
            },
            _ => Checker { place }.wrong("width", "and `height` belong together; one is missing"),
        }
    }

    /// The text's structure of a scene. Colors and confidences are clamped to [0, 1], which optimisers overshoot by
    /// rounding; numbers are written as short as `T` allows.
    #[must_use]
    pub fn from_scene<T: Real>(scene: &Scene<T>, size: ImageSize) -> Self {
        let edge = EdgeJson::from_profile(&scene.edge);
        Self {
            version: if edge.law == EdgeLawJson::SquaredDistance { 1 } else { 2 },
            id: None,
            width: Some(size.width()),
            height: Some(size.height()),
            background: shortest_color(scene.background),
            objects: scene.objects.iter().map(ObjectJson::from_object).collect(),
            edge: Some(edge),
            compositing: match scene.compositing {
                Compositing::Blend => CompositingJson::Blend,
                Compositing::Over => CompositingJson::Over,
            },
        }
    }
}

impl EdgeJson {
    /// The text's structure of an edge profile.
    #[must_use]
    pub fn from_profile<T: Real>(edge: &EdgeProfile<T>) -> Self {
        let law = match edge.law {
            EdgeLaw::SquaredDistance => EdgeLawJson::SquaredDistance,
            EdgeLaw::Distance => EdgeLawJson::Distance,
            EdgeLaw::Area => return Self { law: EdgeLawJson::Area, ..Self::default() },
        };
        let [offset, sigma, cut] = [edge.offset, edge.sigma, edge.cut].map(shortest);
        // The default cut is left out; equal up to the rounding of `T`.
        let is_default = (cut - edge_cut(edge.law, offset, sigma)).abs() <= 1e-6 * cut.abs();
        Self { law, offset: Some(offset), sigma: Some(sigma), cut: (!is_default).then_some(cut) }
    }
}

impl ObjectJson {
    /// The text's structure of an object, with its descriptors.
    #[must_use]
    pub fn from_object<T: Real>(object: &Object<T>) -> Self {
        let descriptors = object.shape.efd();
        Self {
            translation: object.pose.translation.map(shortest),
            scale: shortest(object.pose.scale),
            rotation: Some(shortest(object.pose.rotation)),
            rotation_vec: None,
            color: shortest_color(object.color()),
            confidence: shortest(object.confidence).clamp(0.0, 1.0),
            prototype: object.prototype(),
            shape: None,
            symmetry: descriptors.map(|efd| match efd.symmetry(T::of(SYMMETRY_TOLERANCE)) {
                Symmetry::Finite(order) => order,
                Symmetry::Continuous => 0,
            }),
            efd: descriptors.map(|efd| efd.rows().iter().map(|row| row.map(shortest)).collect()),
        }
    }
}

fn shortest_color<T: Real>(color: [T; 3]) -> [f64; 3] {
    color.map(|value| shortest(value).clamp(0.0, 1.0))
}

/// The f64 with the shortest decimal text that still reads back as `value`: 0.1, not 0.10000000149011612.
fn shortest<T: Real>(value: T) -> f64 {
    value.to_string().parse().unwrap_or_else(|_| value.as_f64())
}
