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

impl Frame {
    /// A figure that is stroked, as a stroke, or where the pen is no disk any more as what the stroke covers; `tolerance` in the
    /// figure's units. None for figures without any line.
    pub(super) fn stroke(
        &self,
        figure: &Figure,
        style: &usvg::Stroke,
        tolerance: f64,
        losses: &mut Losses,
    ) -> Option<Placed> {
        let mut rings = figure.rings(tolerance);
        if let Some(dashes) = style.dasharray() {
            rings = dashed(&rings, dashes, style.dashoffset(), tolerance, losses);
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
        let width = f64::from(style.width().get());
        if let Some(scale) = self.similarity() {
            let stroke = Stroke::new(self.rings(&rings, tolerance), width * scale, cap, join).ok()?;
            return (!stroke.rings.is_empty()).then(|| (stroke.into(), Pose::identity()));
        }
        losses.add("stroke under a transform that is not the same in all directions: drawn as polygons");
        let covered = Stroke::new(rings, width, cap, join).and_then(|stroke| flattened(&stroke, tolerance)).ok()?;
        let corners = covered.rings().iter().map(|ring| ring.iter().map(|&point| self.point(point)).collect());
        Some((Polygon::new(corners.collect()).ok()?.into(), Pose::identity()))
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
