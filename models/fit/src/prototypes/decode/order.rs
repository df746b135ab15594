//! Which object is painted first: what covers pixels that show another one lies behind it.

use alloc::vec;
use alloc::vec::Vec;

use super::Found;
use super::demand::covered;
use super::flat::FlatPicture;
use super::search::Shapes;

/// Indices of the objects in the order in which they are painted: of two the one that covers more of what shows the other lies behind.
/// None if they lie behind one another in a circle.
pub(super) fn painting(picture: &FlatPicture, found: &[Found], shapes: &Shapes) -> Option<Vec<usize>> {
    let mut owner = vec![usize::MAX; picture.color_of.len()];
    for (at, Found { pixels, .. }) in found.iter().enumerate() {
        pixels.iter().for_each(|&pixel| owner[pixel] = at);
    }
    // Per object, how many of its covered pixels show each other one.
    let behind: Vec<Vec<usize>> = found
        .iter()
        .enumerate()
        .map(|(at, Found { posed, .. })| {
            let mut counts = vec![0; found.len()];
            let covered = covered(picture, &posed.pose, shapes.field(posed.prototype));
            for own in covered.into_iter().map(|pixel| owner[pixel]).filter(|&own| own != usize::MAX && own != at) {
                counts[own] += 1;
            }
            counts
        })
        .collect();
    let lies_behind = |a: usize, b: usize| behind[a][b] > behind[b][a] && behind[a][b] > 0;
    let mut left: Vec<usize> = (0..found.len()).collect();
    let mut order = Vec::new();
    while !left.is_empty() {
        // The next one lies in front of none of those that are left.
        let next = left.iter().position(|&a| !left.iter().any(|&b| b != a && lies_behind(b, a)))?;
        order.push(left.remove(next));
    }
    Some(order)
}
