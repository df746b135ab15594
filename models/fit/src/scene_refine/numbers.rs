//! All numbers of a scene that may move, as one vector, and back.

use alloc::vec::Vec;

use dvp_core::shape::{Shape as _, ShapeError};
use dvp_core::{Object, Paint, Real, Scene, SceneGrad};

/// Writes the numbers of `scene` that may move to `values`.
///
/// Background unless there is none; per object what of its pose its shape does not say itself, the numbers of its shape
/// unless they are given from outside, its color or the points and colors of its ramp, and its confidence where it is an opacity in `start`: neither 0 nor 1. One
/// that has come to 0 or 1 on the way may leave it again.
pub(super) fn load<T: Real>(start: &Scene<T>, scene: &Scene<T>, values: &mut Vec<T>) {
    values.clear();
    if !scene.transparent {
        values.extend(scene.background);
    }
    for (object, before) in scene.objects.iter().zip(&start.objects) {
        let (pose, free) = (object.pose, object.shape.pose_freedom());
        values.extend(pose.translation.iter().filter(|_| free.translation));
        values.extend(free.scale.then_some(pose.scale));
        values.extend(free.rotation.then_some(pose.rotation));
        if !object.shape.is_given() {
            object.shape.numbers(values);
        }
        match object.paint.ramp() {
            None => values.extend(object.color()),
            Some(ramp) => ramp.numbers(values),
        }
        values.extend(is_opacity(before).then_some(object.confidence));
    }
}

/// Writes the range of each number to `bounds`, in the order of [`load`]: colors and opacities lie in \[0, 1\], scales are
/// not negative.
pub(super) fn bounds<T: Real>(start: &Scene<T>, bounds: &mut Vec<[T; 2]>) {
    let (zero, one) = (T::zero(), T::one());
    let (anything, unit) = ([T::neg_infinity(), T::infinity()], [zero, one]);
    bounds.clear();
    if !start.transparent {
        bounds.extend([unit; 3]);
    }
    for object in &start.objects {
        let free = object.shape.pose_freedom();
        bounds.extend([anything; 2].into_iter().filter(|_| free.translation));
        bounds.extend(free.scale.then_some([zero, T::infinity()]));
        bounds.extend(free.rotation.then_some(anything));
        if !object.shape.is_given() {
            bounds.extend((0..object.shape.number_count()).map(|_| anything));
        }
        if let Some(ramp) = object.paint.ramp() {
            bounds.extend(ramp.kind.points().iter().flat_map(|_| [anything; 2]));
        }
        let colors = object.paint.ramp().map_or(1, |ramp| ramp.stops.len());
        bounds.extend((0..3 * colors).map(|_| unit));
        bounds.extend(is_opacity(object).then_some(unit));
    }
}

/// Writes the gradient of each number to `values`, in the order of [`load`].
pub(super) fn load_grad<T: Real>(start: &Scene<T>, grad: &SceneGrad<T>, values: &mut Vec<T>) {
    values.clear();
    if !start.transparent {
        values.extend(grad.background);
    }
    for (object, grad) in start.objects.iter().zip(&grad.objects) {
        let free = object.shape.pose_freedom();
        values.extend(grad.translation.iter().filter(|_| free.translation));
        values.extend(free.scale.then_some(grad.scale));
        values.extend(free.rotation.then_some(grad.rotation));
        if !object.shape.is_given() {
            values.extend_from_slice(&grad.numbers);
        }
        match &grad.ramp {
            None => values.extend(grad.color),
            Some(ramp) => ramp.numbers(values),
        }
        values.extend(is_opacity(object).then_some(grad.confidence));
    }
}

/// Writes `values`, in the order of [`load`], to a scene of the same structure.
///
/// # Errors
/// [`ShapeError`] if a shape refuses its numbers.
pub(super) fn store<T: Real>(values: &[T], start: &Scene<T>, scene: &mut Scene<T>) -> Result<(), ShapeError> {
    let mut rest = values.iter().copied();
    let mut take = |place: &mut T| {
        if let Some(value) = rest.next() {
            *place = value;
        }
    };
    if !scene.transparent {
        scene.background.iter_mut().for_each(&mut take);
    }
    let mut numbers = Vec::new();
    for (object, before) in scene.objects.iter_mut().zip(&start.objects) {
        let free = object.shape.pose_freedom();
        if free.translation {
            object.pose.translation.iter_mut().for_each(&mut take);
        }
        if free.scale {
            take(&mut object.pose.scale);
        }
        if free.rotation {
            take(&mut object.pose.rotation);
        }
        if !object.shape.is_given() {
            numbers.clear();
            object.shape.numbers(&mut numbers);
            numbers.iter_mut().for_each(&mut take);
            object.shape.set_numbers(&numbers)?;
        }
        match &mut object.paint {
            Paint::Ramp(ramp) => ramp.numbers_mut().for_each(&mut take),
            paint => {
                let mut color = paint.color();
                color.iter_mut().for_each(&mut take);
                paint.set_color(color);
            }
        }
        if is_opacity(before) {
            take(&mut object.confidence);
        }
    }
    Ok(())
}

/// Whether a confidence says how opaque an object is, not whether it is there.
fn is_opacity<T: Real>(object: &Object<T>) -> bool {
    object.confidence > T::zero() && object.confidence < T::one()
}
