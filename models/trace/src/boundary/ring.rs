//! Walks around faces.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::contour::{Connectivity, Crack, Heading};
use dvp_core::sort;

use super::{Ring, Step};
use crate::partition::{OUTSIDE, Partition};

/// The rings of every face: the outer one first, then those of holes.
pub(super) fn walk_faces(partition: &Partition) -> Vec<Vec<Ring>> {
    let mut rings: Vec<Vec<Ring>> = vec![Vec::new(); partition.faces.len()];
    let [width, height] = partition.size;
    // Every ring heads +x somewhere along the upper side of a pixel.
    let mut visited = vec![false; width * height];
    for y in 0..height {
        for x in 0..width {
            let face = partition.labels[y * width + x];
            if visited[y * width + x] || (y > 0 && partition.labels[(y - 1) * width + x] == face) {
                continue;
            }
            let ring =
                walk(Crack { start: [x, y], heading: Heading::PlusX }, |at| partition.face_at(at) == face, partition);
            mark(&ring, width, &mut visited);
            rings[face as usize].push(ring);
        }
    }
    for of_face in &mut rings {
        sort::descending(of_face, |ring| ring.area);
    }
    rings
}

/// The rings around a set of faces, given as the answer whether a pixel belongs to it.
pub(super) fn walk_mask(partition: &Partition, inside: impl Fn([usize; 2]) -> bool, bounds: [usize; 4]) -> Vec<Ring> {
    let [width, height] = partition.size;
    let inside = |at: [usize; 2]| at[0] < width && at[1] < height && inside(at);
    let [left, top, right, bottom] = bounds;
    let columns = right - left;
    let mut visited = vec![false; columns * (bottom - top)];
    let mut rings = Vec::new();
    for y in top..bottom {
        for x in left..right {
            if visited[(y - top) * columns + x - left] || !inside([x, y]) || (y > 0 && inside([x, y - 1])) {
                continue;
            }
            let ring = walk(Crack { start: [x, y], heading: Heading::PlusX }, inside, partition);
            for step in ring.steps.iter().filter(|step| step.crack.heading == Heading::PlusX) {
                let [x, y] = step.crack.start;
                if (left..right).contains(&x) && (top..bottom).contains(&y) {
                    visited[(y - top) * columns + x - left] = true;
                }
            }
            rings.push(ring);
        }
    }
    rings
}

fn mark(ring: &Ring, width: usize, visited: &mut [bool]) {
    for step in ring.steps.iter().filter(|step| step.crack.heading == Heading::PlusX) {
        visited[step.crack.start[1] * width + step.crack.start[0]] = true;
    }
}

fn walk(first: Crack, inside: impl Fn([usize; 2]) -> bool + Copy, partition: &Partition) -> Ring {
    let mut ring = Ring { steps: Vec::new(), area: 0.0 };
    let mut crack = first;
    loop {
        let [inner, other] = crack.sides().map(|at| partition.face_at(at));
        ring.steps.push(Step { crack, inner, other, sample: None, is_across: false });
        let ([x, y], [to_x, to_y]) = (crack.start, crack.end());
        ring.area += 0.5 * (x as f64 * to_y as f64 - to_x as f64 * y as f64);
        // The pixel on the right hand is to the upper left or lower right of the corner ahead where the walk is vertical.
        let falling = matches!(crack.heading, Heading::PlusY | Heading::MinusY);
        let joins = partition.joins_at(crack.end(), falling);
        crack = crack.next(inside, if joins { Connectivity::Eight } else { Connectivity::Four });
        if crack == first || other == OUTSIDE && inner == OUTSIDE {
            return ring;
        }
    }
}
