//! The measures of objects.

use dvp_core::geometry::Bounds;
use dvp_core::render::{Compositing, ExactArea, ExactRenderer};
use dvp_core::shape::{
    Axes, Flattening, Moments, Outline, OutlineBasis, REFERENCE_VERTICES, SYMMETRY_TOLERANCE, Shape as _, Symmetry,
};
use dvp_core::{Drawing, Efd, ImageSize, Object, Pose, Scene};
use dvp_fit::Bank;
use dvp_fit::paint::drawing_of;

use super::error::ExportError;
use super::region::Region;
use crate::format::to_byte;

/// How far polygons may stray from the curves that they stand for, px.
const TOLERANCE_PX: f64 = 1e-3;

/// Harmonics that tell whether an outline repeats itself when it is turned.
const SYMMETRY_HARMONICS: usize = 16;

/// An object, measured.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct MeasuredObject {
    /// What it is called in this picture, by label maps too: its place in the order of painting, from 1, or its label in the
    /// label map that it comes from.
    pub number: u32,
    /// The kind of its shape, as in scene files.
    pub kind: &'static str,
    /// The name of the prototype that it is, if it is one of a bank.
    pub prototype: Option<String>,
    /// What it encloses, px.
    pub region: Region,
    /// Area and centroid; none if it encloses nothing.
    pub moments: Option<Moments<f64>>,
    /// The axes of the ellipse with the same second moments, px; none if it encloses nothing.
    pub axes: Option<Axes<f64>>,
    /// The direction of the longer axis in degrees from +x toward +y (clockwise as pictures are shown), in (-90, 90\]; none
    /// for shapes that a third of a turn or less maps on themselves, whose axes are equal.
    pub angle: Option<f64>,
    /// The length of its outline, those of holes included, px.
    pub perimeter: f64,
    /// The smallest upright box around it, px.
    pub bounds: Option<Bounds<f64>>,
    /// RGB.
    pub color: [u8; 3],
    /// Probability of being there, and opacity; [0, 1].
    pub confidence: f64,
    /// Share of its area that is in the picture and not behind other objects, [0, 1].
    pub visible: f64,
    /// Standard deviations, where the fit knows them.
    pub deviations: Option<Deviations>,
}

/// Standard deviations of measures, from the covariance of the pose: what the noise of the picture does to position, size
/// and angle of a shape, and to the stretch of one that has a width and a height of its own. Every length changes with the size in the same ratio; bounds, which change with the
/// angle in ways of their own, and colors have none.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Deviations {
    /// Of the coordinates of the centroid, px.
    pub centroid: [f64; 2],
    /// Of the area, px^2.
    pub area: f64,
    /// Of the perimeter, px.
    pub perimeter: f64,
    /// Of the lengths of the longer and the shorter axis, px.
    pub axes: [f64; 2],
    /// Of the angle, degrees.
    pub angle: f64,
}

impl MeasuredObject {
    /// 4 pi area / perimeter^2: 1 for a disk, less for everything else.
    #[must_use]
    pub fn circularity(&self) -> Option<f64> {
        let area = self.moments?.area;
        (self.perimeter > 0.0).then(|| 4.0 * core::f64::consts::PI * area / (self.perimeter * self.perimeter))
    }

    /// The name that a class of such objects goes by: that of the prototype, or else the kind.
    #[must_use]
    pub fn class(&self) -> &str {
        self.prototype.as_deref().unwrap_or(self.kind)
    }
}

/// Measures the objects of a scene of `size`.
///
/// `covariance` is that of the fit ([`Fit::covariance`](dvp_fit::Fit)), one per object or none at all; `bank` names
/// prototypes; `numbers` are what the objects are called, one per object.
///
/// # Errors
/// [`ExportError::Shape`] if the numbers of an object describe no shape, [`ExportError::Draw`] and
/// [`ExportError::Render`] if it cannot be drawn.
pub fn measure(
    scene: &Scene<f32>,
    covariance: &[[f32; 25]],
    bank: Option<&Bank<f32>>,
    numbers: &[u32],
    size: ImageSize,
) -> Result<Vec<MeasuredObject>, ExportError> {
    let unit = f64::from(u32::try_from(size.unit_px()).unwrap_or(u32::MAX));
    let seen = seen_areas(scene, size)?;
    let scene = scene.cast::<f64>();
    let basis = OutlineBasis::new(REFERENCE_VERTICES, scene.harmonic_count().max(1));
    let basis = basis.map_err(|source| ExportError::Shape { object: 1, source })?;
    let mut objects = Vec::with_capacity(scene.objects.len());
    for ((k, object), (&number, seen)) in scene.objects.iter().enumerate().zip(numbers.iter().zip(seen)) {
        let refused = |source| ExportError::Shape { object: k + 1, source };
        let mut outline = Outline::default();
        let how = Flattening::new(&basis, TOLERANCE_PX / unit).magnified(object.pose.scale);
        object.shape.flatten(&how, &mut outline).map_err(refused)?;
        object.pose.transform(&mut outline.vertices);
        outline.vertices.iter_mut().for_each(|vertex| *vertex = vertex.map(|x| x * unit));
        let region = Region::new(&outline).map_err(refused)?;
        let prototype = object.prototype().map(|index| prototype_name(bank, index));
        let moments = region.moments().map_err(refused)?;
        let measured = measured(object, region, moments);
        let pose_covariance = covariance.get(k).map(|covariance| covariance.map(f64::from));
        let deviations =
            pose_covariance.and_then(|covariance| Deviations::of(&covariance, &object.pose, &measured, unit));
        objects.push(MeasuredObject {
            number,
            prototype,
            deviations: deviations.filter(Deviations::are_finite),
            visible: moments.map_or(0.0, |moments| (seen / moments.area).clamp(0.0, 1.0)),
            ..measured
        });
    }
    Ok(objects)
}

/// What an object and its region tell.
fn measured(object: &Object<f64>, region: Region, moments: Option<Moments<f64>>) -> MeasuredObject {
    let axes = moments.map(|moments| moments.axes());
    MeasuredObject {
        number: 0,
        kind: object.shape.kind(),
        prototype: None,
        moments,
        axes,
        angle: axes.filter(|_| has_direction(&region)).map(|axes| axes.angle.to_degrees()),
        perimeter: region.perimeter(),
        bounds: region.bounds(),
        color: object.color().map(to_byte),
        confidence: object.confidence.clamp(0.0, 1.0),
        visible: 0.0,
        deviations: None,
        region,
    }
}

impl Deviations {
    /// From the covariance of (x, y, log scale, rotation, log stretch), row by row, positions in scene units; none for what encloses nothing.
    fn of(covariance: &[f64; 25], pose: &Pose<f64>, object: &MeasuredObject, unit: f64) -> Option<Self> {
        let (moments, axes) = (object.moments?, object.axes?);
        let [dx, dy] = [0, 1].map(|axis| moments.centroid[axis] / unit - pose.translation[axis]);
        // How a coordinate of the centroid moves with each number of the pose.
        let moves = [[1.0, 0.0, dx, -dy, 0.0], [0.0, 1.0, dy, dx, 0.0]];
        let rows = covariance.as_chunks::<5>().0;
        let variance = |by: [f64; 5]| -> f64 {
            rows.iter().zip(by).map(|(row, b)| b * row.iter().zip(by).map(|(c, b)| c * b).sum::<f64>()).sum()
        };
        let [scale, rotation] = [[0.0, 0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0, 0.0]].map(|by| variance(by).sqrt());
        // Stretching along a direction lengthens what lies along it and shortens what lies across, by the cosine of twice the angle between.
        let share = (2.0 * (axes.angle - pose.rotation)).cos();
        let axes = [(axes.major, share), (axes.minor, -share)]
            .map(|(length, share)| length * variance([0.0, 0.0, 1.0, 0.0, share]).sqrt());
        let along = object.region.perimeter_along(pose.rotation) / object.perimeter;
        let centroid = moves.map(|by| variance(by).sqrt() * unit);
        Some(Self {
            centroid,
            area: 2.0 * moments.area * scale,
            perimeter: object.perimeter * variance([0.0, 0.0, 1.0, 0.0, along]).sqrt(),
            axes,
            angle: rotation.to_degrees(),
        })
    }

    fn are_finite(&self) -> bool {
        self.centroid
            .iter()
            .chain(&self.axes)
            .chain([&self.area, &self.perimeter, &self.angle])
            .all(|value| value.is_finite())
    }
}

/// Whether the axes differ but by chance: not if a third of a turn or less maps the outline on itself.
fn has_direction(region: &Region) -> bool {
    let efd = region.largest_ring().and_then(|ring| Efd::from_contour(ring, SYMMETRY_HARMONICS).ok());
    efd.is_some_and(|(efd, _)| match efd.symmetry(SYMMETRY_TOLERANCE) {
        Symmetry::Finite(order) => order < 3,
        Symmetry::Continuous => false,
    })
}

/// The area (px^2) that is in the picture and not hidden, per object. Under `blend` objects show through one another.
fn seen_areas(scene: &Scene<f32>, size: ImageSize) -> Result<Vec<f64>, ExportError> {
    let drawing = drawing_of(scene, size, REFERENCE_VERTICES).map_err(ExportError::Draw)?;
    // From the last object, which nothing hides, to the first.
    let mut reversed = Drawing::default();
    for k in (0..drawing.object_count()).rev() {
        reversed.push_rings(drawing.rings(k), drawing.colors[k], drawing.confidences[k]);
    }
    let hides = scene.compositing == Compositing::Over;
    let renderer = ExactRenderer { coverage: ExactArea, compositing: scene.compositing };
    let mut open = vec![1.0_f32; size.pixels()];
    let mut seen = vec![0.0_f64; drawing.object_count()];
    renderer.visit_coverage(&reversed, size, &mut Default::default(), |object, pixel, coverage| {
        let opacity = if hides { reversed.confidences[object] } else { 0.0 };
        for (open, &coverage) in open[pixel..].iter_mut().zip(coverage) {
            seen[object] += f64::from(*open * coverage);
            *open *= 1.0 - opacity * coverage;
        }
    })?;
    seen.reverse();
    Ok(seen)
}

fn prototype_name(bank: Option<&Bank<f32>>, index: usize) -> String {
    let named = bank.and_then(|bank| bank.prototypes.get(index)).map(|(name, _)| name.clone());
    named.unwrap_or_else(|| format!("prototype {index}"))
}
