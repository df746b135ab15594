//! The checks at the border: nothing behind it meets a number that is not finite or a slice of the wrong length.

use crate::dims::ImageSize;
use crate::real::Real;
use crate::render::RenderError;
use crate::scene::{Drawing, DrawingGrad};

/// Largest size of a confidence: steps of an optimizer may leave \[0, 1\], the weight exp(10 (f - 1)) must stay finite.
const MOST_CONFIDENT: f64 = 4.0;

/// Checks layout and numbers of a drawing.
pub(super) fn check_drawing<T: Real>(drawing: &Drawing<T>) -> Result<(), RenderError> {
    let objects = drawing.object_count();
    check_length("confidences", objects, drawing.confidences.len())?;
    if objects > 0 || !drawing.starts.is_empty() {
        check_length("starts", objects + 1, drawing.starts.len())?;
        check_length("vertices", drawing.starts[objects], drawing.vertices.len())?;
        if drawing.starts[0] != 0 || drawing.starts.windows(2).any(|pair| pair[0] > pair[1]) {
            return Err(RenderError::Starts);
        }
    }
    check_breaks(&drawing.breaks, drawing.vertices.len())?;
    if !all_finite(&drawing.background) {
        return Err(RenderError::NotFinite { what: "background", object: None });
    }
    check_ramps(drawing)?;
    let finite = all_finite(drawing.vertices.as_flattened())
        && all_finite(drawing.colors.as_flattened())
        && all_finite(&drawing.confidences);
    if !finite {
        return Err(culprit(drawing));
    }
    let wild = drawing.confidences.iter().map(|f| f.as_f64()).find(|f| f.abs() > MOST_CONFIDENT);
    wild.map_or(Ok(()), |value| Err(RenderError::Setting { what: "confidence", value, must: "in [0, 1]" }))
}

/// Checks that each ramp paints an object of its own in stops of its own, one after the other.
fn check_ramps<T: Real>(drawing: &Drawing<T>) -> Result<(), RenderError> {
    let (mut least_object, mut first) = (0, 0);
    for ramp in &drawing.ramps {
        let (object, range) = (ramp.object, ramp.stops.clone());
        let stops = drawing.stops.get(range.clone()).filter(|stops| range.start == first && !stops.is_empty());
        let Some(stops) = stops.filter(|_| (least_object..drawing.object_count()).contains(&object)) else {
            return Err(RenderError::Ramp { object });
        };
        let numbers = stops.iter().flat_map(|stop| stop.color.iter().chain([&stop.offset]));
        if !numbers.chain(ramp.kind.points().as_flattened()).all(|v| v.is_finite()) {
            return Err(RenderError::NotFinite { what: "color ramp", object: Some(object) });
        }
        if stops.windows(2).any(|pair| pair[0].offset > pair[1].offset) {
            return Err(RenderError::Ramp { object });
        }
        (least_object, first) = (object + 1, range.end);
    }
    check_length("stops", first, drawing.stops.len())
}

/// Checks the length of planar image data of `N` channels.
pub(super) fn check_image<T, const N: usize>(
    what: &'static str,
    data: &[T],
    size: ImageSize,
) -> Result<(), RenderError> {
    check_length(what, N * size.pixels(), data.len())
}

/// Checks that image data is finite.
pub(super) fn check_finite<T: Real>(what: &'static str, data: &[T]) -> Result<(), RenderError> {
    if all_finite(data) { Ok(()) } else { Err(RenderError::NotFinite { what, object: None }) }
}

/// Checks that a gradient has the layout of its drawing.
pub(super) fn check_grad<T: Real>(drawing: &Drawing<T>, grad: &DrawingGrad<T>) -> Result<(), RenderError> {
    check_length("grad.vertices", drawing.vertices.len(), grad.vertices.len())?;
    check_length("grad.colors", drawing.colors.len(), grad.colors.len())?;
    check_length("grad.ramps", drawing.ramps.len(), grad.ramps.len())?;
    check_length("grad.stops", drawing.stops.len(), grad.stops.len())?;
    check_length("grad.confidences", drawing.confidences.len(), grad.confidences.len())
}

/// Checks that rings begin one after the other among `most` vertices.
pub(in crate::render) fn check_breaks(breaks: &[usize], most: usize) -> Result<(), RenderError> {
    let mut least = 0;
    for (index, &start) in breaks.iter().enumerate() {
        if !(least..=most).contains(&start) {
            return Err(RenderError::Breaks { index, start, least, most });
        }
        least = start;
    }
    Ok(())
}

fn check_length(what: &'static str, expected: usize, len: usize) -> Result<(), RenderError> {
    if len == expected { Ok(()) } else { Err(RenderError::Length { what, expected, len }) }
}

/// v * 0 is 0 for finite v, NaN for others; eight sums side by side vectorize.
fn all_finite<T: Real>(values: &[T]) -> bool {
    let (blocks, rest) = values.as_chunks::<8>();
    let mut sums = [T::zero(); 8];
    for block in blocks {
        for (sum, &v) in sums.iter_mut().zip(block) {
            *sum += v * T::zero();
        }
    }
    sums.iter().chain(rest).all(|v| v.is_finite())
}

/// Names the first number that is not finite.
fn culprit<T: Real>(drawing: &Drawing<T>) -> RenderError {
    for k in 0..drawing.object_count() {
        let object = Some(k);
        if !all_finite(drawing.outline(k).as_flattened()) {
            return RenderError::NotFinite { what: "outline", object };
        }
        if !all_finite(&drawing.colors[k]) {
            return RenderError::NotFinite { what: "color", object };
        }
        if !drawing.confidences[k].is_finite() {
            return RenderError::NotFinite { what: "confidence", object };
        }
    }
    RenderError::NotFinite { what: "drawing", object: None }
}
