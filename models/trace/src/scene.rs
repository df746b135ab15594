//! Layers to a scene: objects in scene units, each with a pose.

use alloc::vec::Vec;

use dvp_core::render::{Compositing, EdgeProfile};
use dvp_core::shape::{
    AnyShape, Circle, Ellipse, FillRule, Path, PathRing, Rectangle, RegularPolygon, Segment, Star, Stroke,
};
use dvp_core::{ImageSize, Object, Pose, Real as _, Scene};

use crate::layers::{Form, Layer, Layers};
use crate::outline::{Outline, OutlineShape};

/// The scene that layers make of a picture of some size, and what is in doubt of its objects. `is_hard`: no
/// pixel of the picture is mixed.
#[must_use]
pub fn scene(layers: &Layers, size: ImageSize, transparent: bool, is_hard: bool) -> (Scene<f32>, Vec<ObjectDoubt>) {
    let unit = size.unit_px() as f64;
    let doubt = |layer: &Layer| ObjectDoubt { pose: covariance(layer, unit), heap: layer.heap };
    let objects = layers.layers.iter().filter_map(|layer| Some((object(layer, unit)?, doubt(layer))));
    let (objects, doubts) = objects.unzip();
    let background = layers.background.map(|value| f32::of(value.clamp(0.0, 1.0)));
    let edge = if is_hard { EdgeProfile::hard(f32::of(unit)) } else { EdgeProfile::area() };
    (Scene { background, transparent, objects, edge, compositing: Compositing::Over }, doubts)
}

/// What a drawing leaves open of an object.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjectDoubt {
    /// How far its pose may be off, where that is known.
    pub pose: Option<PoseCovariance>,
    /// Which of the picture's heaps, things of one color that have run together, it lies in, if it lies in one.
    pub heap: Option<usize>,
}

/// How far the pose of an object may be off.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseCovariance {
    /// Covariance of x and y (scene units), log scale, rotation (radians) and log stretch: the scale is the square root of width times
    /// height, the stretch that of width over height, along the object's own axes.
    pub numbers: [[f64; 5]; 5],
    /// Whether it looks alike at every angle.
    pub is_round: bool,
}

/// What is known of the pose of a layer's object, if it is a whole outline.
fn covariance(layer: &Layer, unit: f64) -> Option<PoseCovariance> {
    let Form::Filled(outlines) = &layer.form else { return None };
    let [Outline { shape, covariance, .. }] = &outlines[..] else { return None };
    // How the numbers of the pose change with those of the outline, which come in the order of the columns.
    let [x, y] = [[1.0 / unit, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0 / unit, 0.0, 0.0, 0.0]];
    let (count, changes) = match *shape {
        OutlineShape::Circle { radius, .. } => (3, [x, y, [0.0, 0.0, 1.0 / radius, 0.0, 0.0], [0.0; 5], [0.0; 5]]),
        OutlineShape::Ellipse { radii: [a, b], .. } => {
            let [of_a, of_b] = [0.5 / a, 0.5 / b];
            let scale = [0.0, 0.0, of_a, of_b, 0.0];
            (5, [x, y, scale, [0.0, 0.0, 0.0, 0.0, 1.0], [0.0, 0.0, of_a, -of_b, 0.0]])
        }
        _ => return None,
    };
    if covariance.len() != count * count {
        return None;
    }
    let entry = |one: &[f64; 5], other: &[f64; 5]| -> f64 {
        let rows = covariance.chunks_exact(count).zip(one);
        rows.map(|(row, by)| by * row.iter().zip(other).map(|(value, by)| value * by).sum::<f64>()).sum()
    };
    let numbers = changes.each_ref().map(|one| changes.each_ref().map(|other| entry(one, other)));
    Some(PoseCovariance { numbers, is_round: count == 3 })
}

/// The object of a layer; none if it has no outline.
pub(crate) fn object(layer: &Layer, unit: f64) -> Option<Object<f32>> {
    let (shape, pose) = match &layer.form {
        Form::Stroked(stroke) if stroke.width.is_nan() || stroke.width <= 0.0 => return None,
        Form::Stroked(stroke) => stroked(stroke, unit),
        Form::Filled(outlines) => filled(outlines, unit)?,
    };
    let [x, y, rotation] = pose;
    let pose = Pose {
        translation: [x / unit, y / unit].map(f32::of),
        scale: 1.0,
        rotation: f32::of(rotation % core::f64::consts::TAU),
    };
    let color = layer.color.map(|value| f32::of(value.clamp(0.0, 1.0)));
    Some(Object { shape: shape.cast(), pose, paint: color.into(), confidence: 1.0 })
}

/// A shape in scene units around its place; its place in pixels and its turn.
type Placed = (AnyShape<f64>, [f64; 3]);

fn filled(outlines: &[Outline], unit: f64) -> Option<Placed> {
    Some(match outlines {
        [] => return None,
        [Outline { shape: OutlineShape::Circle { center, radius }, .. }] => {
            (AnyShape::Circle(Circle { radius: radius / unit }), [center.x, center.y, 0.0])
        }
        [Outline { shape: OutlineShape::Ellipse { center, radii, angle }, .. }] => {
            (AnyShape::Ellipse(Ellipse { radii: radii.map(|radius| radius / unit) }), [center.x, center.y, *angle])
        }
        [Outline { shape: OutlineShape::Rectangle { center, size, corner_radius, angle }, .. }] => (
            AnyShape::Rectangle(Rectangle { size: size.map(|side| side / unit), corner_radius: corner_radius / unit }),
            [center.x, center.y, *angle],
        ),
        [Outline { shape: OutlineShape::RegularPolygon { center, sides, radius, angle }, .. }] => (
            AnyShape::RegularPolygon(RegularPolygon { sides: *sides, radius: radius / unit }),
            [center.x, center.y, *angle],
        ),
        [Outline { shape: OutlineShape::Star { center, points, radii, angle }, .. }] => (
            AnyShape::Star(Star { points: *points, radius: radii[0] / unit, inner_radius: radii[1] / unit }),
            [center.x, center.y, *angle],
        ),
        outlines => {
            let mut rings: Vec<PathRing<f64>> = outlines.iter().map(|outline| outline.shape.ring()).collect();
            let center = recenter(&mut rings, unit);
            (AnyShape::Path(Path { rings, fill: FillRule::EvenOdd }), center)
        }
    })
}

fn stroked(stroke: &Stroke<f64>, unit: f64) -> Placed {
    let mut rings = stroke.rings.clone();
    let center = recenter(&mut rings, unit);
    (AnyShape::Stroke(Stroke { rings, width: stroke.width / unit, ..*stroke }), center)
}

/// Moves rings (pixels) to scene units around the middle of their points, which is returned.
fn recenter(rings: &mut [PathRing<f64>], unit: f64) -> [f64; 3] {
    let points = rings.iter().flat_map(|ring| &ring.points);
    let [mut low, mut high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for point in points {
        for k in 0..2 {
            low[k] = low[k].min(point[k]);
            high[k] = high[k].max(point[k]);
        }
    }
    let center = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
    let place = |point: &mut [f64; 2]| *point = [0, 1].map(|k| (point[k] - center[k]) / unit);
    for ring in rings {
        ring.points.iter_mut().for_each(place);
        for segment in &mut ring.segments {
            match segment {
                Segment::Cubic { controls } => controls.iter_mut().for_each(place),
                Segment::SmoothCubic { handle, control } => {
                    *handle /= unit;
                    place(control);
                }
                Segment::Line | Segment::Arc { .. } | Segment::SmoothArc => (),
            }
        }
    }
    [center[0], center[1], 0.0]
}
