//! The resolved tree of a drawing to objects, in the order in which they are painted.

use alloc::rc::Rc;
use std::collections::HashMap;

use dvp_core::Object;
use dvp_core::scene::Region;
use dvp_core::shape::{FillRule, ShapeError};
use kurbo::Affine;
use usvg::roxmltree::{Document, Node as Element};
use usvg::{BlendMode, Group, Node, PaintOrder, Rect, Transform};

use super::clip::cut;
use super::error::SvgError;
use super::figure::Figure;
use super::forms::Forms;
use super::losses::Losses;
use super::paint::{Coat, coat};
use super::place::{Frame, Placed};
use super::source::by_id;
use super::stroke;

/// Most lines and curves, and stops of gradients in all that is painted with them.
const MOST_SEGMENTS: usize = 1 << 18;

/// Farthest place, pixels.
const FARTHEST_PX: f32 = 1e6;

/// How far curves may stray where they cannot be kept, pixels.
const TOLERANCE_PX: f64 = 1e-3;

/// Most objects of a translucent group that are tested for overlaps; more are taken to have some.
const MOST_TESTED: usize = 64;

/// Objects as they are found.
pub(super) struct Walk<'a> {
    document: &'a Document<'a>,
    /// What drew, by the ids that usvg hands on.
    elements: HashMap<&'a str, Element<'a, 'a>>,
    /// What drew, where usvg hands on no id; none until it is asked for.
    forms: Option<Forms<'a>>,
    /// Scene units per pixel.
    pub(super) px: f64,
    pub(super) objects: Vec<Object<f64>>,
    /// Where each object is seen, pixels.
    boxes: Vec<Rect>,
    pub(super) losses: Losses,
    segments: usize,
}

/// What is painted, and with what.
pub(super) type Layer = (Placed, Coat);

/// What groups do to everything in them.
#[derive(Clone)]
pub(super) struct Inherited {
    opacity: f64,
    region: Option<Rc<Region>>,
}

impl Default for Inherited {
    fn default() -> Self {
        Self { opacity: 1.0, region: None }
    }
}

/// A figure of the drawing and how to place it.
pub(super) struct Sketch {
    pub(super) figure: Figure,
    pub(super) frame: Frame,
    /// For what cannot be kept, in the figure's units.
    pub(super) tolerance: f64,
    /// Whether an element says what it is.
    is_known: bool,
}

impl<'a> Walk<'a> {
    pub(super) fn new(document: &'a Document<'a>, px: f64) -> Self {
        let (objects, boxes, losses) = (Vec::new(), Vec::new(), Losses::default());
        Self { document, elements: by_id(document), forms: None, px, objects, boxes, losses, segments: 0 }
    }

    /// The element that drew a path, or one that draws the same.
    fn element(&mut self, path: &usvg::Path) -> Result<Option<Element<'a, 'a>>, SvgError> {
        if let Some(&element) = self.elements.get(path.id()) {
            return Ok(Some(element));
        }
        if self.forms.is_none() {
            self.forms = Some(Forms::new(self.document)?);
        }
        Ok(self.forms.as_ref().and_then(|forms| forms.get(path)))
    }

    /// Appends the objects of a group.
    pub(super) fn group(&mut self, group: &Group, inherited: &Inherited) -> Result<(), SvgError> {
        if group.blend_mode() != BlendMode::Normal {
            self.losses.add("mix-blend-mode: drawn as normal");
        }
        if !group.filters().is_empty() {
            self.losses.add("filter: not applied");
        }
        let region = self.narrowed(group, inherited.region.clone())?;
        let opacity = f64::from(group.opacity().get());
        let inner = Inherited { opacity: inherited.opacity * opacity, region };
        let first = self.objects.len();
        for child in group.children() {
            match child {
                Node::Group(group) => self.group(group, &inner)?,
                Node::Path(path) => self.path(path, &inner)?,
                Node::Image(_) => self.losses.add("image: not drawn"),
                Node::Text(_) => self.losses.add("text: not drawn"),
            }
        }
        if opacity < 1.0 && overlap(&self.boxes[first..]) {
            self.losses.add("opacity of a group: of each of its objects, which show where they overlap");
        }
        Ok(())
    }

    /// What a path draws, with the transform `before` its own.
    pub(super) fn sketch(&mut self, path: &usvg::Path, before: Affine) -> Result<Sketch, SvgError> {
        let affine = before * affine_of(path.abs_transform());
        let frame = Frame::new(Affine::scale(self.px) * affine, self.px);
        let tolerance = TOLERANCE_PX * self.px / frame.scale().max(f64::MIN_POSITIVE);
        let element = self.element(path)?;
        let figure = Figure::of(path, element, tolerance, &mut self.losses);
        self.count(figure.segment_count())?;
        Ok(Sketch { figure, frame, tolerance, is_known: element.is_some() })
    }

    fn path(&mut self, path: &usvg::Path, inherited: &Inherited) -> Result<(), SvgError> {
        if !path.is_visible() {
            return Ok(());
        }
        let seen = path.abs_stroke_bounding_box();
        let farthest =
            [seen.left(), seen.top(), seen.right(), seen.bottom()].into_iter().map(f32::abs).fold(0.0, f32::max);
        if !farthest.is_finite() || farthest > FARTHEST_PX {
            return Err(SvgError::TooFar { distance: farthest, limit: FARTHEST_PX });
        }
        let sketch = self.sketch(path, Affine::IDENTITY)?;
        if sketch.frame.is_flat() {
            return Ok(());
        }
        if !sketch.is_known {
            self.losses.add("use or marker: shape became a path");
        }
        let mut paint = [true, false];
        if path.paint_order() == PaintOrder::StrokeAndFill {
            paint.reverse();
        }
        for is_fill in paint {
            let layer = if is_fill { self.fill_of(path, &sketch) } else { self.stroke_of(path, &sketch)? };
            if let Some((placed, coat)) = layer {
                self.push(placed, coat, seen, inherited)?;
            }
        }
        Ok(())
    }

    /// What a path fills, and with what.
    pub(super) fn fill_of(&mut self, path: &usvg::Path, sketch: &Sketch) -> Option<Layer> {
        let fill = path.fill()?;
        let coat = coat(fill.paint(), fill.opacity(), sketch.frame.affine, &mut self.losses)?;
        let rule = match fill.rule() {
            usvg::FillRule::NonZero => FillRule::NonZero,
            usvg::FillRule::EvenOdd => FillRule::EvenOdd,
        };
        let placed = sketch.frame.fill(&sketch.figure, rule, sketch.tolerance);
        Some((self.drawable(placed)??, coat))
    }

    /// What a path strokes, and with what.
    ///
    /// # Errors
    /// [`SvgError::TooManySegments`] if dashes make too many.
    pub(super) fn stroke_of(&mut self, path: &usvg::Path, sketch: &Sketch) -> Result<Option<Layer>, SvgError> {
        let Some(stroke) = path.stroke() else { return Ok(None) };
        let coat = coat(stroke.paint(), stroke.opacity(), sketch.frame.affine, &mut self.losses);
        let Some(coat) = coat else { return Ok(None) };
        let line = stroke::line(&sketch.figure, stroke, sketch.tolerance, &mut self.losses);
        let Some(line) = self.drawable(line).flatten() else { return Ok(None) };
        // Those of the figure are counted already.
        self.count(stroke::segment_count(&line).saturating_sub(sketch.figure.segment_count()))?;
        let placed = sketch.frame.stroke(line, sketch.tolerance, &mut self.losses);
        Ok(self.drawable(placed).flatten().map(|placed| (placed, coat)))
    }

    /// What the scene accepts; the rest is lost.
    fn drawable<V>(&mut self, shape: Result<V, ShapeError>) -> Option<V> {
        if shape.is_err() {
            self.losses.add("shape without a boundary: not drawn");
        }
        shape.ok()
    }

    fn count(&mut self, segments: usize) -> Result<(), SvgError> {
        self.segments = self.segments.saturating_add(segments);
        if self.segments > MOST_SEGMENTS {
            return Err(SvgError::TooManySegments { limit: MOST_SEGMENTS });
        }
        Ok(())
    }

    fn push(&mut self, placed: Placed, coat: Coat, seen: Rect, inherited: &Inherited) -> Result<(), SvgError> {
        let (shape, pose) = match &inherited.region {
            None => placed,
            Some(region) => match cut(placed, region, self.tolerance(), self.px)? {
                None => return Ok(()),
                Some((placed, false)) => placed,
                Some((placed, true)) => {
                    self.losses.add("clip-path or mask: curves of what it cuts became polygons");
                    placed
                }
            },
        };
        // The stops of one gradient are as many times in memory as shapes are painted with it.
        self.count(coat.paint.ramp().map_or(0, |ramp| ramp.stops.len()))?;
        let confidence = coat.opacity * inherited.opacity;
        self.objects.push(Object { shape, pose, paint: coat.into_frame(&pose), confidence });
        self.boxes.push(seen);
        Ok(())
    }

    /// How far curves of regions may stray, scene units.
    pub(super) fn tolerance(&self) -> f64 {
        10.0 * TOLERANCE_PX * self.px
    }
}

pub(super) fn affine_of(transform: Transform) -> Affine {
    let Transform { sx, ky, kx, sy, tx, ty } = transform;
    Affine::new([sx, ky, kx, sy, tx, ty].map(f64::from))
}

/// Whether two of the boxes have more in common than a border.
fn overlap(boxes: &[Rect]) -> bool {
    let meet = |a: &Rect, b: &Rect| {
        a.left() < b.right() && b.left() < a.right() && a.top() < b.bottom() && b.top() < a.bottom()
    };
    boxes.len() > MOST_TESTED || boxes.iter().enumerate().any(|(k, a)| boxes[..k].iter().any(|b| meet(a, b)))
}
