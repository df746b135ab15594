//! Which slots of a proposed scene are objects.

use dvp_core::{Object, Scene};

/// Two candidates stand for one thing if their centers are less than this apart, in units of the smaller scale...
const SAME_PLACE: f32 = 0.35;
/// ... the larger scale is less than this many times the smaller ...
const SAME_SCALE: f32 = 1.5;
/// ... and no channel of their colors differs by more than this.
const SAME_COLOR: f32 = 0.15;

/// Of candidates for one thing keeps the most confident, the first of equals; the order stays.
pub(super) fn drop_doubles(scene: &mut Scene<f32>) {
    let mut order: Vec<usize> = (0..scene.objects.len()).collect();
    order.sort_by(|&a, &b| scene.objects[b].confidence.total_cmp(&scene.objects[a].confidence));
    let mut kept: Vec<usize> = Vec::with_capacity(order.len());
    for candidate in order {
        if !kept.iter().any(|&other| is_double(&scene.objects[candidate], &scene.objects[other])) {
            kept.push(candidate);
        }
    }
    let mut index = 0..scene.objects.len();
    scene.objects.retain(|_| index.next().is_some_and(|index| kept.contains(&index)));
}

fn is_double(one: &Object<f32>, other: &Object<f32>) -> bool {
    let [a, b] = [one, other].map(|object| object.pose);
    let apart = (a.translation[0] - b.translation[0]).hypot(a.translation[1] - b.translation[1]);
    let (smaller, larger) = (a.scale.min(b.scale), a.scale.max(b.scale));
    let colors = one.color.iter().zip(&other.color);
    apart < SAME_PLACE * smaller
        && larger < SAME_SCALE * smaller
        && colors.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) < SAME_COLOR
}
