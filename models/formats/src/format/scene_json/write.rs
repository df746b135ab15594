//! From a scene, or a fit, to the text's structure.

use dvp_core::render::{Compositing, EdgeLaw, EdgeProfile};
use dvp_core::scene::{ColorRamp, ColorStop, RampKind};
use dvp_core::shape::{
    AnyShape, Cap, Circle, Ellipse, FillRule, Join, Path, PathRing, Prototype, Rectangle, RegularPolygon,
    SYMMETRY_TOLERANCE, Segment, Shape as _, Star, Stroke, Symmetry,
};
use dvp_core::{Efd, ImageSize, Object, Real, Scene};
use dvp_fit::Fit;

use super::super::{FormatError, Picture};
use super::edge::edge_cut;
use super::{
    CapJson, ColorStopJson, CompositingJson, EdgeJson, EdgeLawJson, FillJson, JoinJson, ObjectJson, ObjectKnownJson,
    RampJson, RampKindJson, RingJson, SceneJson, SceneKnownJson, SegmentJson, ShapeJson, VERSION,
};

impl SceneJson {
    /// The text's structure of a scene. Colors and confidences are clamped to [0, 1], which optimisers overshoot by
    /// rounding; lengths whose sign changes nothing are written without it; numbers are written as short as `T` allows, and
    /// read back as they were.
    ///
    /// # Errors
    /// [`FormatError::Kind`] for a kind of shape that the format has no name for.
    pub fn from_scene<T: Real>(scene: &Scene<T>, size: ImageSize) -> Result<Self, FormatError> {
        let behind = shortest_color(scene.background);
        Ok(Self {
            version: VERSION,
            id: None,
            width: Some(size.width()),
            height: Some(size.height()),
            background: (!scene.transparent).then_some(behind),
            matte: scene.transparent.then_some(behind),
            objects: scene.objects.iter().map(ObjectJson::from_object).collect::<Result<_, _>>()?,
            edge: Some(EdgeJson::from_profile(&scene.edge)),
            compositing: match scene.compositing {
                Compositing::Blend => CompositingJson::Blend,
                Compositing::Over => CompositingJson::Over,
            },
            known: None,
        })
    }

    /// The text's structure of the scene that was found in a picture, with what the fit knows of it.
    ///
    /// # Errors
    /// As [`Self::from_scene`].
    pub fn from_fit<T: Real>(fit: &Fit<T>, picture: &Picture<T>) -> Result<Self, FormatError> {
        let mut json = Self::from_scene(&fit.scene, picture.image.size())?;
        json.known = Some(SceneKnownJson::of(fit, picture.visible));
        for (object, known) in json.objects.iter_mut().zip(ObjectKnownJson::of(fit)) {
            object.known = (!known.is_empty()).then_some(known);
        }
        Ok(json)
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
        let is_default = T::of(edge_cut(edge.law, offset, sigma)) == edge.cut;
        Self { law, offset: Some(offset), sigma: Some(sigma), cut: (!is_default).then_some(cut) }
    }
}

impl ObjectJson {
    fn from_object<T: Real>(object: &Object<T>) -> Result<Self, FormatError> {
        Ok(Self {
            shape: ShapeJson::from_shape(&object.shape)?,
            translation: object.pose.translation.map(shortest),
            scale: shortest(object.pose.scale),
            rotation: shortest(object.pose.rotation),
            color: shortest_color(object.color()),
            ramp: object.paint.ramp().map(RampJson::from_ramp),
            confidence: shortest(object.confidence).clamp(0.0, 1.0),
            known: None,
        })
    }
}

impl RampJson {
    fn from_ramp<T: Real>(ramp: &ColorRamp<T>) -> Self {
        let stop =
            |&ColorStop { offset, color }| ColorStopJson { offset: shortest(offset), color: shortest_color(color) };
        Self {
            kind: match ramp.kind {
                RampKind::Linear(_) => RampKindJson::Linear,
                RampKind::Radial(_) => RampKindJson::Radial,
            },
            points: points(ramp.kind.points()),
            stops: ramp.stops.iter().map(stop).collect(),
        }
    }
}

impl ShapeJson {
    fn from_shape<T: Real>(shape: &AnyShape<T>) -> Result<Self, FormatError> {
        Ok(match shape {
            AnyShape::Circle(Circle { radius }) => Self::Circle { radius: shortest(radius.abs()) },
            AnyShape::Ellipse(Ellipse { radii }) => Self::Ellipse { radii: radii.map(T::abs).map(shortest) },
            AnyShape::Rectangle(Rectangle { size, corner_radius }) => Self::Rectangle {
                size: size.map(T::abs).map(shortest),
                corner_radius: shortest(corner_radius.max(T::zero())),
            },
            AnyShape::RegularPolygon(RegularPolygon { sides, radius }) => {
                Self::RegularPolygon { sides: *sides, radius: shortest(*radius) }
            }
            AnyShape::Star(Star { points, radius, inner_radius }) => {
                Self::Star { points: *points, radius: shortest(*radius), inner_radius: shortest(*inner_radius) }
            }
            AnyShape::Polygon(polygon) => {
                Self::Polygon { rings: polygon.rings.iter().map(|ring| points(ring)).collect() }
            }
            AnyShape::Path(Path { rings, fill }) => Self::Path {
                rings: rings.iter().map(RingJson::from_ring).collect(),
                fill: match fill {
                    FillRule::EvenOdd => FillJson::EvenOdd,
                    FillRule::NonZero => FillJson::NonZero,
                },
            },
            AnyShape::Stroke(Stroke { rings, width, cap, join }) => {
                let (join, miter_limit) = match *join {
                    Join::Miter { limit } => (JoinJson::Miter, Some(shortest(limit))),
                    Join::Round => (JoinJson::Round, None),
                    Join::Bevel => (JoinJson::Bevel, None),
                };
                Self::Stroke {
                    rings: rings.iter().map(RingJson::from_ring).collect(),
                    width: shortest(width.abs()),
                    cap: match cap {
                        Cap::Butt => CapJson::Butt,
                        Cap::Round => CapJson::Round,
                        Cap::Square => CapJson::Square,
                    },
                    join,
                    miter_limit,
                }
            }
            AnyShape::Efd(efd) => Self::Efd { efd: rows(efd), symmetry: Some(symmetry(efd)) },
            AnyShape::Prototype(Prototype { index, efd }) => {
                Self::Prototype { prototype: *index, efd: Some(rows(efd)), symmetry: Some(symmetry(efd)) }
            }
            shape => return Err(FormatError::Kind { kind: shape.kind() }),
        })
    }
}

impl RingJson {
    fn from_ring<T: Real>(ring: &PathRing<T>) -> Self {
        Self { points: points(&ring.points), segments: ring.segments.iter().map(SegmentJson::from_segment).collect() }
    }
}

impl SegmentJson {
    fn from_segment<T: Real>(segment: &Segment<T>) -> Self {
        match *segment {
            Segment::Line => Self::Line {},
            Segment::Arc { bulge } => Self::Arc { bulge: shortest(bulge) },
            Segment::SmoothArc => Self::SmoothArc {},
            Segment::Cubic { controls } => Self::Cubic { controls: controls.map(|point| point.map(shortest)) },
            Segment::SmoothCubic { handle, control } => {
                Self::SmoothCubic { handle: shortest(handle), control: control.map(shortest) }
            }
        }
    }
}

fn points<T: Real>(points: &[[T; 2]]) -> Vec<[f64; 2]> {
    points.iter().map(|point| point.map(shortest)).collect()
}

fn rows<T: Real>(efd: &Efd<T>) -> Vec<[f64; 4]> {
    efd.rows().iter().map(|row| row.map(shortest)).collect()
}

fn symmetry<T: Real>(efd: &Efd<T>) -> usize {
    match efd.symmetry(T::of(SYMMETRY_TOLERANCE)) {
        Symmetry::Finite(order) => order,
        Symmetry::Continuous => 0,
    }
}

fn shortest_color<T: Real>(color: [T; 3]) -> [f64; 3] {
    color.map(|value| shortest(value).clamp(0.0, 1.0))
}

/// The f64 with the shortest decimal text that still reads back as `value`: 0.1, not 0.10000000149011612.
pub(super) fn shortest<T: Real>(value: T) -> f64 {
    let exact = value.as_f64();
    // Rounding twice, by way of f64, may miss.
    value.to_string().parse().ok().filter(|&short| T::of(short) == value).unwrap_or(exact)
}
