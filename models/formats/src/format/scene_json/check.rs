//! From the text's structure to a scene with every number checked.

use dvp_core::render::{Compositing, EdgeLaw, EdgeProfile};
use dvp_core::{Efd, ImageSize, Object, Pose, Real, Scene};
use dvp_fit::Bank;

use super::super::error::{FormatError, Place};
use super::edge::edge_cut;
use super::{CompositingJson, EdgeJson, EdgeLawJson, ObjectJson, SceneJson, ShapeJson};

/// Most objects of a scene.
const MAX_OBJECTS: usize = 10_000;
/// Most points of the shapes of a scene, control points and corners of polygons and stars included.
const MAX_POINTS: usize = 1_000_000;
/// Most curves of the paths of a scene: each may become a thousand vertices.
const MAX_CURVES: usize = 100_000;
/// Largest coordinate or scale, scene units: a thousand images away.
pub(super) const MAX_COORDINATE: f64 = 1e3;
/// Where coordinates lie.
pub(super) const REACH: [f64; 2] = [-MAX_COORDINATE, MAX_COORDINATE];
/// What a transparent scene is shown on unless it says so.
const WHITE: [f64; 3] = [1.0; 3];

/// Checks values and says where a bad one stands.
pub(super) struct Checker<'a> {
    pub(super) place: &'a Place,
}

impl Checker<'_> {
    pub(super) fn wrong<V>(&self, field: impl Into<String>, problem: impl Into<String>) -> Result<V, FormatError> {
        Err(FormatError::Field { place: self.place.clone(), field: field.into(), problem: problem.into() })
    }

    pub(super) fn within<T: Real>(&self, field: &str, value: f64, [low, high]: [f64; 2]) -> Result<T, FormatError> {
        if (low..=high).contains(&value) {
            Ok(T::of(value))
        } else {
            self.wrong(field, format!("is {value}, must be from {low} to {high}"))
        }
    }

    pub(super) fn above_zero<T: Real>(&self, field: &str, value: f64, high: f64) -> Result<T, FormatError> {
        let real = T::of(value);
        if value <= high && real > T::zero() {
            Ok(real)
        } else {
            self.wrong(field, format!("is {value}, must be above 0 and at most {high}"))
        }
    }

    /// All of a list of fixed length.
    pub(super) fn all_within<T: Real, const N: usize>(
        &self,
        field: &str,
        values: [f64; N],
        range: [f64; 2],
    ) -> Result<[T; N], FormatError> {
        let mut checked = [T::zero(); N];
        for (to, value) in checked.iter_mut().zip(values) {
            *to = self.within(field, value, range)?;
        }
        Ok(checked)
    }

    pub(super) fn color<T: Real>(&self, field: &str, color: [f64; 3]) -> Result<[T; 3], FormatError> {
        self.all_within(field, color, [0.0, 1.0])
    }

    fn object<T: Real>(
        &self,
        [k, object_count]: [usize; 2],
        from: &ObjectJson,
        bank: Option<&Bank<T>>,
    ) -> Result<Object<T>, FormatError> {
        let own = format!("objects[{k}]");
        let field = |name: &str| format!("{own}.{name}");
        let pose = Pose {
            translation: self.all_within(&field("translation"), from.translation, REACH)?,
            scale: self.above_zero(&field("scale"), from.scale, MAX_COORDINATE)?,
            rotation: self.within(&field("rotation"), from.rotation, REACH)?,
        };
        let shape = self.shape(&own, &from.shape, bank)?;
        if let Some(known) = &from.known {
            self.object_known(&field("known"), known, &shape, object_count)?;
        }
        Ok(Object {
            shape,
            pose,
            paint: self.paint(&own, from)?,
            confidence: self.within(&field("confidence"), from.confidence, [0.0, 1.0])?,
        })
    }

    /// Whether there are too many objects, points or curves to be drawn.
    fn size_of_scene(&self, objects: &[ObjectJson]) -> Result<(), FormatError> {
        let sum = |count: fn(&ShapeJson) -> usize| objects.iter().map(|object| count(&object.shape)).sum();
        for (what, count, most) in [
            ("objects", objects.len(), MAX_OBJECTS),
            ("points", sum(ShapeJson::point_count), MAX_POINTS),
            ("curves", sum(ShapeJson::curve_count), MAX_CURVES),
        ] {
            if count > most {
                return self.wrong("objects", format!("has {count} {what}, at most {most}"));
            }
        }
        Ok(())
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
pub(in super::super) fn checked_efd<T: Real>(
    place: &Place,
    field: &str,
    rows: &[[f64; 4]],
) -> Result<Efd<T>, FormatError> {
    Checker { place }.efd_rows(field, rows)
}

impl SceneJson {
    /// The scene, every number checked, those of what is known as well; shapes that are only named come from `bank`.
    ///
    /// # Errors
    /// [`FormatError::Field`] with the first value that is missing or out of range.
    pub fn to_scene<T: Real>(&self, bank: Option<&Bank<T>>, place: &Place) -> Result<Scene<T>, FormatError> {
        let checker = Checker { place };
        checker.size_of_scene(&self.objects)?;
        let background = match (self.background, self.matte) {
            (Some(background), None) => checker.color("background", background)?,
            (None, matte) => checker.color("matte", matte.unwrap_or(WHITE))?,
            (Some(_), Some(_)) => return checker.wrong("matte", "is for transparent scenes, whose background is null"),
        };
        if let Some(known) = &self.known {
            checker.scene_known(known)?;
        }
        let count = self.objects.len();
        let objects = self.objects.iter().enumerate().map(|(k, object)| checker.object([k, count], object, bank));
        Ok(Scene {
            background,
            transparent: self.background.is_none(),
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
}
