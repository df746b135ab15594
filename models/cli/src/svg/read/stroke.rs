//! Strokes: what a pen covers along the outline of a figure.

use dvp_core::shape::{
    Cap, Flattening, Join, Outline, OutlineBasis, PathRing, Polygon, Segment, Shape as _, ShapeError, Stroke,
};
use dvp_core::{Pose, Real as _};
use kurbo::{BezPath, PathEl, PathSeg};
use usvg::{LineCap, LineJoin};

use super::figure::Figure;
use super::losses::Losses;
use super::path_data;
use super::place::{Frame, Placed, arc_of, point_of};

/// Most dashes of one stroke.
const MOST_DASHES: f64 = 1e5;

/// The line of a pen along a figure, in the figure's units, its curves within `tolerance`. None for figures without any line.
///
/// # Errors
/// [`ShapeError`] if the numbers of the figure describe no line.
pub(super) fn line(
    figure: &Figure,
    style: &usvg::Stroke,
    tolerance: f64,
    losses: &mut Losses,
) -> Result<Option<Stroke<f64>>, ShapeError> {
    let mut rings = figure.rings(tolerance);
    if let Some(dashes) = style.dasharray() {
        rings = dashed(&rings, dashes, style.dashoffset(), tolerance, losses);
    }
    if rings.is_empty() {
        return Ok(None);
    }
    let cap = match style.linecap() {
        LineCap::Butt => Cap::Butt,
        LineCap::Round => Cap::Round,
        LineCap::Square => Cap::Square,
    };
    let limit = f64::from(style.miterlimit().get());
    let join = match style.linejoin() {
        LineJoin::Miter => Join::Miter { limit },
        LineJoin::MiterClip => {
            losses.add("stroke-linejoin miter-clip: drawn as miter");
            Join::Miter { limit }
        }
        LineJoin::Round => Join::Round,
        LineJoin::Bevel => Join::Bevel,
    };
    Stroke::new(rings, f64::from(style.width().get()), cap, join).map(Some)
}

/// How many lines and curves a stroke has: what is round at its joins and caps is a curve, too.
pub(super) fn segment_count(stroke: &Stroke<f64>) -> usize {
    let is_round = stroke.join == Join::Round || stroke.cap == Cap::Round;
    let round = |ring: &PathRing<f64>| if is_round { ring.points.len() } else { 0 };
    stroke.rings.iter().map(|ring| ring.segments.len() + round(ring)).sum()
}

impl Frame {
    /// A stroke where it stands, or where its pen is no disk any more what it covers; `tolerance` in the units of the stroke. None for
    /// what covers nothing.
    ///
    /// # Errors
    /// [`ShapeError`] if its numbers describe no shape.
    pub(super) fn stroke(
        &self,
        stroke: Stroke<f64>,
        tolerance: f64,
        losses: &mut Losses,
    ) -> Result<Option<Placed>, ShapeError> {
        if let Some(scale) = self.similarity() {
            let rings = self.rings(&stroke.rings, tolerance);
            let placed = Stroke::new(rings, stroke.width * scale, stroke.cap, stroke.join)?;
            return Ok(Some((placed.into(), Pose::identity())));
        }
        let covered = flattened(&stroke, tolerance)?;
        if covered.vertices.is_empty() {
            return Ok(None);
        }
        losses.add("stroke under a transform that is not the same in all directions: drawn as polygons");
        let corners = covered.rings().iter().map(|ring| ring.iter().map(|&point| self.point(point)).collect());
        Ok(Some((Polygon::new(corners.collect())?.into(), Pose::identity())))
    }
}

fn flattened(stroke: &Stroke<f64>, tolerance: f64) -> Result<Outline<f64>, ShapeError> {
    let mut outline = Outline::default();
    stroke.flatten(&Flattening::new(&OutlineBasis::new(4, 1)?, tolerance), &mut outline)?;
    Ok(outline)
}

/// The dashes of lines.
fn dashed(
    rings: &[PathRing<f64>],
    dashes: &[f32],
    offset: f32,
    tolerance: f64,
    losses: &mut Losses,
) -> Vec<PathRing<f64>> {
    let path: BezPath = rings.iter().flat_map(|ring| elements(ring, tolerance)).collect();
    let dashes: Vec<f64> = dashes.iter().map(|&dash| f64::from(dash)).collect();
    let (total, length) = (dashes.iter().sum::<f64>(), path.segments().map(length).sum::<f64>());
    let is_valid = dashes.iter().all(|&dash| dash >= 0.0) && total > 0.0;
    if !is_valid || length / total * f64::of_usize(dashes.len()) > MOST_DASHES {
        losses.add("stroke-dasharray: drawn without gaps");
        return rings.to_vec();
    }
    let dashed: BezPath = kurbo::dash(path.iter(), f64::from(offset), &dashes).collect();
    path_data::rings(&dashed.to_svg(), tolerance).0
}

/// At most the length of a segment: that of its control polygon.
fn length(segment: PathSeg) -> f64 {
    let cubic = segment.to_cubic();
    [(cubic.p0, cubic.p1), (cubic.p1, cubic.p2), (cubic.p2, cubic.p3)].iter().map(|(a, b)| (*b - *a).hypot()).sum()
}

fn elements(ring: &PathRing<f64>, tolerance: f64) -> Vec<PathEl> {
    let mut elements = Vec::new();
    let count = ring.points.len();
    let point = |k: usize| point_of(ring.points[k % count]);
    if count > 0 {
        elements.push(PathEl::MoveTo(point(0)));
    }
    for (k, &segment) in ring.segments.iter().enumerate() {
        match segment {
            Segment::Cubic { controls: [first, second] } => {
                elements.push(PathEl::CurveTo(point_of(first), point_of(second), point(k + 1)));
            }
            _ => match arc_of(segment, point(k), point(k + 1)) {
                Some(arc) => elements.extend(arc.append_iter(tolerance.max(1e-9 * arc.radii.x))),
                None => elements.push(PathEl::LineTo(point(k + 1))),
            },
        }
    }
    if ring.is_closed() {
        elements.push(PathEl::ClosePath);
    }
    elements
}
