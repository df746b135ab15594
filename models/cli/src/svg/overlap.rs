//! Which sets of objects share pixels.

use alloc::collections::BTreeSet;

/// Most samples along a side; overlaps narrower than a sample step may be missed.
const MAX_SAMPLES: f64 = 512.0;

/// A posed outline in pixels, fattened by `reach` pixels.
pub(super) struct Body {
    pub(super) vertices: Vec<[f64; 2]>,
    pub(super) reach: f64,
}

impl Body {
    fn bounds(&self) -> [[f64; 2]; 2] {
        let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for vertex in &self.vertices {
            for axis in 0..2 {
                bounds[0][axis] = bounds[0][axis].min(vertex[axis] - self.reach);
                bounds[1][axis] = bounds[1][axis].max(vertex[axis] + self.reach);
            }
        }
        bounds
    }

    /// Inside by the even-odd rule, or no farther than `reach` from the outline.
    fn covers(&self, [x, y]: [f64; 2]) -> bool {
        let mut inside = false;
        let mut previous = self.vertices[self.vertices.len() - 1];
        for &vertex in &self.vertices {
            let edge = [vertex[0] - previous[0], vertex[1] - previous[1]];
            let from = [x - previous[0], y - previous[1]];
            let length2 = edge[0] * edge[0] + edge[1] * edge[1];
            let along = if length2 > 0.0 { (from[0] * edge[0] + from[1] * edge[1]) / length2 } else { 0.0 };
            let along = along.clamp(0.0, 1.0);
            if (from[0] - along * edge[0]).hypot(from[1] - along * edge[1]) <= self.reach {
                return true;
            }
            if (previous[1] > y) != (vertex[1] > y) && from[0] < edge[0] * (from[1] / edge[1]) {
                inside = !inside;
            }
            previous = vertex;
        }
        inside
    }
}

/// Every set of two or more bodies that some point of a `width` x `height` image lies in, smaller sets first.
pub(super) fn shared_regions(bodies: &[Body], width: f64, height: f64) -> Vec<Vec<usize>> {
    let bounds: Vec<[[f64; 2]; 2]> = bodies.iter().map(Body::bounds).collect();
    let mut sets = BTreeSet::new();
    for (k, body) in bodies.iter().enumerate() {
        // Where this body is the first of a set: in its bounds, shared with a later one.
        let later: Vec<usize> = (k + 1..bodies.len()).filter(|&other| meet(&bounds[k], &bounds[other])).collect();
        if later.is_empty() {
            continue;
        }
        let [low, high] = clipped(&bounds[k], [width, height]);
        let step = ((high[0] - low[0]).max(high[1] - low[1]) / MAX_SAMPLES).max(1.0);
        let mut y = low[1] + 0.5;
        while y < high[1] {
            let mut x = low[0] + 0.5;
            while x < high[0] {
                let others = later.iter().filter(|&&other| within(&bounds[other], [x, y]));
                let mut set: Vec<usize> = others.copied().filter(|&other| bodies[other].covers([x, y])).collect();
                if !set.is_empty() && body.covers([x, y]) {
                    set.insert(0, k);
                    sets.insert(set);
                }
                x += step;
            }
            y += step;
        }
    }
    let mut sets: Vec<Vec<usize>> = sets.into_iter().collect();
    sets.sort_by_key(Vec::len);
    sets
}

fn clipped([low, high]: &[[f64; 2]; 2], size: [f64; 2]) -> [[f64; 2]; 2] {
    [[low[0].max(0.0).floor(), low[1].max(0.0).floor()], [high[0].min(size[0]), high[1].min(size[1])]]
}

fn meet(a: &[[f64; 2]; 2], b: &[[f64; 2]; 2]) -> bool {
    (0..2).all(|axis| a[0][axis] <= b[1][axis] && b[0][axis] <= a[1][axis])
}

fn within([low, high]: &[[f64; 2]; 2], point: [f64; 2]) -> bool {
    (0..2).all(|axis| low[axis] <= point[axis] && point[axis] <= high[axis])
}
