//! The mean contour length of the unit-scale outlines, which keeps free shapes from growing spikes.

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
        let length = factor * length_and_grad(&drawing.vertices[vertices], factor, grads);
        grad.scale -= length / object.pose.scale;
        sum += length;
    }
    sum
}

/// The length of a closed polygon; adds `factor` times its gradient.
fn length_and_grad<T: Real>(outline: &[[T; 2]], factor: T, grads: &mut [[T; 2]]) -> T {
    let mut length = T::zero();
    for i in 0..outline.len() {
        let j = if i + 1 == outline.len() { 0 } else { i + 1 };
        let (dx, dy) = (outline[j][0] - outline[i][0], outline[j][1] - outline[i][1]);
        let edge = (dx * dx + dy * dy).sqrt();
        if edge > T::zero() {
            let (gx, gy) = (factor * dx / edge, factor * dy / edge);
            grads[i] = [grads[i][0] - gx, grads[i][1] - gy];
            grads[j] = [grads[j][0] + gx, grads[j][1] + gy];
            length += edge;
        }
    }
    length
}
