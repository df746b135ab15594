//! Partitioning around medoids (k-medoids), and how good a partition is.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Real;
use num_traits::Float;

/// Distances between `count` things, symmetric, 0 on the diagonal.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DistanceMatrix {
    count: usize,
    values: Vec<f64>,
}

impl DistanceMatrix {
    /// Distances from a function of two different indices, the lower one second.
    #[must_use]
    pub fn new(count: usize, mut distance: impl FnMut(usize, usize) -> f64) -> Self {
        let mut values = vec![0.0; count * count];
        for i in 0..count {
            for j in 0..i {
                let value = distance(i, j);
                values[i * count + j] = value;
                values[j * count + i] = value;
            }
        }
        Self { count, values }
    }

    /// Number of things.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Distances from thing `i` to all.
    #[must_use]
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.count..(i + 1) * self.count]
    }
}

/// A partition by nearest medoid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Partition {
    /// The thing in the middle of each cluster.
    pub medoids: Vec<usize>,
    /// Cluster of each thing.
    pub clusters: Vec<usize>,
    /// Sum of the distances to the medoids.
    pub cost: f64,
}

/// Splits into `k` clusters around medoids: greedy start, then the best swap of a medoid while one gains; from the
/// greedy start, and from each thing as the first medoid if there are few. Deterministic. `k` is cut to the number of things.
///
/// *Source*: Kaufman and Rousseeuw, "Finding Groups in Data", 1990, chapter 2 (PAM).
#[must_use]
pub fn k_medoids(distances: &DistanceMatrix, k: usize) -> Partition {
    let k = k.min(distances.count);
    let mut best = swap(distances, build(distances, Vec::new(), k));
    if distances.count <= FEW {
        for first in 0..distances.count {
            let other = swap(distances, build(distances, vec![first], k));
            if other.cost < best.cost {
                best = other;
            }
        }
    }
    best
}

/// Up to this many things every one is tried as the first medoid.
const FEW: usize = 64;

/// Adds the medoid that lowers the cost most until there are `k`.
fn build(distances: &DistanceMatrix, mut medoids: Vec<usize>, k: usize) -> Vec<usize> {
    let mut nearest = vec![f64::INFINITY; distances.count];
    let take = |nearest: &mut [f64], medoid: usize| {
        nearest.iter_mut().zip(distances.row(medoid)).for_each(|(near, &d)| *near = near.min(d));
    };
    for &medoid in &medoids {
        take(&mut nearest, medoid);
    }
    while medoids.len() < k {
        let cost = |i: usize| nearest.iter().zip(distances.row(i)).map(|(&near, &d)| near.min(d)).sum::<f64>();
        let free = (0..distances.count).filter(|i| !medoids.contains(i));
        let best = free.map(|i| (cost(i), i)).reduce(|best, next| if next.0 < best.0 { next } else { best });
        let Some((_, medoid)) = best else { break };
        take(&mut nearest, medoid);
        medoids.push(medoid);
    }
    medoids
}

/// Exchanges a medoid for another thing, the best exchange first, while the cost falls.
fn swap(distances: &DistanceMatrix, mut medoids: Vec<usize>) -> Partition {
    let mut partition = assign(distances, &medoids);
    loop {
        let mut best: Option<(f64, usize, usize)> = None;
        for at in 0..medoids.len() {
            // Distance to the nearest of the other medoids.
            let mut others = vec![f64::INFINITY; distances.count];
            for (_, &medoid) in medoids.iter().enumerate().filter(|&(i, _)| i != at) {
                others.iter_mut().zip(distances.row(medoid)).for_each(|(near, &d)| *near = near.min(d));
            }
            for candidate in (0..distances.count).filter(|i| !medoids.contains(i)) {
                let cost: f64 = others.iter().zip(distances.row(candidate)).map(|(&near, &d)| near.min(d)).sum();
                if best.is_none_or(|(c, _, _)| cost < c) {
                    best = Some((cost, at, candidate));
                }
            }
        }
        // A gain of rounding errors alone could go round in circles.
        let Some((_, at, candidate)) = best.filter(|best| best.0 < partition.cost * (1.0 - 1e-12)) else {
            return partition;
        };
        medoids[at] = candidate;
        partition = assign(distances, &medoids);
    }
}

fn assign(distances: &DistanceMatrix, medoids: &[usize]) -> Partition {
    let mut clusters = vec![0; distances.count];
    let mut cost = 0.0;
    for (i, cluster) in clusters.iter_mut().enumerate() {
        let row = distances.row(i);
        let near = medoids.iter().map(|&m| row[m]).enumerate();
        if let Some((at, d)) = near.reduce(|best, next| if next.1 < best.1 { next } else { best }) {
            *cluster = at;
            cost += d;
        }
    }
    Partition { medoids: medoids.to_vec(), clusters, cost }
}

/// How good a partition is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Silhouette {
    /// Mean over all things of (b - a) / max(a, b), in \[-1, 1\].
    pub mean: f64,
    /// Standard error of that mean.
    pub error: f64,
}

/// The silhouette of a partition: (b - a) / max(a, b) per thing, a the mean distance within the own cluster, b that to the
/// nearest other one; 0 for things alone in their cluster, where both distances are 0, and below two clusters.
///
/// *Source*: Rousseeuw, "Silhouettes", 1987.
#[must_use]
pub fn silhouette(distances: &DistanceMatrix, partition: &Partition) -> Silhouette {
    let k = partition.medoids.len();
    if k < 2 || distances.count == 0 {
        return Silhouette::default();
    }
    let mut sizes = vec![0.0; k];
    partition.clusters.iter().for_each(|&cluster| sizes[cluster] += 1.0);
    let (mut sum, mut squares) = (0.0, 0.0);
    for (i, &own) in partition.clusters.iter().enumerate() {
        let mut sums = vec![0.0; k];
        distances.row(i).iter().zip(&partition.clusters).for_each(|(&d, &cluster)| sums[cluster] += d);
        if sizes[own] < 1.5 {
            continue;
        }
        let within = sums[own] / (sizes[own] - 1.0);
        let others = sums.iter().zip(&sizes).enumerate().filter(|&(cluster, (_, &size))| cluster != own && size > 0.0);
        let beyond = others.map(|(_, (sum, size))| sum / size).fold(f64::INFINITY, f64::min);
        let largest = within.max(beyond);
        if largest > 0.0 && largest.is_finite() {
            let value = (beyond - within) / largest;
            sum += value;
            squares += value * value;
        }
    }
    let n = f64::of_usize(distances.count);
    let mean = sum / n;
    Silhouette { mean, error: Float::sqrt((squares / n - mean * mean).max(0.0) / n) }
}
