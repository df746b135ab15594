//! Loops of a closed polygon, cut off.
//!
//! What is moved along its normals crosses itself at corners that are sharper than the way is long, and where noise leaves spurs. No
//! sample is nearest to such a loop, so that no fit takes it back; it is cut off where it crosses, as offsets of polygons are.

#[cfg(test)]
mod tests;

use alloc::vec::Vec;

use dvp_core::Real;

/// Cuts off whichever side has fewer vertices, wherever the closed polygon `ring`, whose last vertex is joined to the first, crosses
/// itself; says whether it did. As each cut takes a vertex at least, there is an end.
pub(crate) fn cut_loops<T: Real>(ring: &mut Vec<[T; 2]>) -> bool {
    let before = ring.len();
    while let Some((i, j, at)) = first_crossing(ring) {
        // Vertices i + 1 to j lie on the one side of the crossing, the others on the other side.
        if 2 * (j - i) <= ring.len() {
            ring.splice(i + 1..=j, [at]);
        } else {
            ring.truncate(j + 1);
            ring.drain(..=i);
            ring.push(at);
        }
    }
    ring.len() < before
}

/// The first two edges, each by its first vertex, that cross, and where.
fn first_crossing<T: Real>(ring: &[[T; 2]]) -> Option<(usize, usize, [T; 2])> {
    let n = ring.len();
    let next = |i: usize| ring[if i + 1 == n { 0 } else { i + 1 }];
    (0..n).find_map(|i| {
        let (a, b) = (ring[i], next(i));
        let (low, high) = ([a[0].min(b[0]), a[1].min(b[1])], [a[0].max(b[0]), a[1].max(b[1])]);
        // The last edge ends where the first one begins.
        (i + 2..n - usize::from(i == 0)).find_map(|j| {
            let (c, d) = (ring[j], next(j));
            if (0..2).any(|k| c[k].max(d[k]) < low[k] || c[k].min(d[k]) > high[k]) {
                return None;
            }
            let (from, to) = (side(a, b, c), side(a, b, d));
            let do_cross = from * to < T::zero() && side(c, d, a) * side(c, d, b) < T::zero();
            let share = from / (from - to);
            do_cross.then(|| (i, j, [c[0] + share * (d[0] - c[0]), c[1] + share * (d[1] - c[1])]))
        })
    })
}

/// On which side of the line through `a` and `b` a point lies, by the sign.
fn side<T: Real>(a: [T; 2], b: [T; 2], point: [T; 2]) -> T {
    (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0])
}
