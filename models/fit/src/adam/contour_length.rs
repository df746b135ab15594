//! The mean contour length of the unit-scale outlines, which keeps free shapes from growing spikes: the value and
//! gradient of [`dvp_core::loss::ContourLength`], taken from a drawing that is there already.

use dvp_core::loss::outline_length_vjp;
use dvp_core::{Drawing, DrawingGrad, Real, Scene, SceneGrad};

/// `weight` times the mean over the objects of the length of their outlines at scale 1; adds its gradient to that of the
/// drawing and, for what the drawing alone does not tell, to that of the scene. 0 without objects.
///
/// A unit length is the posed length over the scale, so that no unit outline is drawn again. It does not depend on the
/// scale: what the vertices will pull back to the scale is taken off there.
///
/// *Dimensions*: `drawing` as drawn from `scene`, the gradients in their layouts; objects beyond the shortest are left
/// out. *Derivative*: edges of length 0 count as having none.
///
/// *Source*: the evaluation of Opt-Iter and Rand-OptP, weight 0.01.
pub fn mean_length_and_grad<T: Real>(
    scene: &Scene<T>,
    drawing: &Drawing<T>,
    weight: T,
    grad_drawing: &mut DrawingGrad<T>,
    grad_scene: &mut SceneGrad<T>,
) -> T {
    let share = weight / T::of_usize(scene.objects.len());
    let outlines = drawing.starts.windows(2).map(|pair| pair[0]..pair[1]);
    let mut sum = T::zero();
    for ((object, grad), vertices) in scene.objects.iter().zip(&mut grad_scene.objects).zip(outlines) {
        let factor = share / object.pose.scale;
        let grads = &mut grad_drawing.vertices[vertices.clone()];
        let length = factor * outline_length_vjp(&drawing.vertices[vertices], factor, grads);
        grad.scale -= length / object.pose.scale;
        sum += length;
    }
    sum
}
