//! How many shapes there are, and which.

use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use dvp_core::sort;
use dvp_core::{Efd, Real};
use num_traits::Float;

use super::form::{Form, Freedom};
use super::medoids::{DistanceMatrix, Partition, Silhouette, k_medoids, silhouette};
use super::member::Member;
use crate::Bank;

/// Members beyond this many are not used, the smallest first: time grows with the square.
const MAX_MEMBERS: usize = 384;
/// A split into clusters must have at least this mean silhouette; below, there is one shape. "A reasonable structure has
/// been found" in the words of Kaufman and Rousseeuw, 1990.
const LEAST_SILHOUETTE: f64 = 0.5;
/// Outlines closer than this (root mean square, radii) are not told apart, however large.
const SAME_SHAPE: f64 = 0.02;
/// Typical distances larger than this are those of different shapes, not of one.
const LARGEST_TYPICAL: f64 = 0.06;
/// Outlines farther apart than this are different shapes, however small the objects.
const OTHER_SHAPE: f64 = 0.15;
/// Distances of members of one shape, in typical distances to the nearest other member.
const SPREAD: f64 = 2.0;
/// A member with too few neighbors within this many spreads belongs to no shape.
const OUTLIER: f64 = 2.0;
/// Standard errors of a mean within which a symmetry counts as evident.
const EVIDENT: f64 = 4.0;
/// An outline this close to a symmetry (root mean square, radii) has it, however small its standard error.
pub(super) const SYMMETRIC: f64 = 0.01;
/// Misfit of a mean's own truncation, radii.
const TRUNCATION: f64 = 2e-3;

/// Settings of [`learn`]. To change some: start with the default, set fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct PrototypeOptions {
    /// Most shapes that are looked for.
    pub max_shapes: usize,
    /// A shape must be seen at least this often.
    pub min_members: usize,
    /// Whether mirror images are one shape. The bank then holds both hands of a shape that is not its own mirror image
    /// if both were seen: poses do not mirror.
    pub mirror: bool,
    /// Whether objects stand as they are: turned shapes are other shapes then, and the bank holds each as it stands.
    pub upright: bool,
}

impl Default for PrototypeOptions {
    fn default() -> Self {
        Self { max_shapes: 24, min_members: 3, mirror: false, upright: false }
    }
}

impl PrototypeOptions {
    fn freedom(&self) -> Freedom {
        Freedom { turn: !self.upright, mirror: self.mirror }
    }
}

/// A shape that was found.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Prototype {
    /// The mean of its members, with the symmetry that it evidently has.
    pub form: Form,
    /// Indices of its members, as given to [`learn`].
    pub members: Vec<usize>,
    /// The member in the middle.
    pub medoid: usize,
    /// Median distance of the members from the mean, radii.
    pub spread: f64,
    /// Symmetry order; 0 for a disk.
    pub symmetry: usize,
    /// Whether it is its own mirror image.
    pub own_mirror: bool,
    /// How many of its members are mirrored.
    pub mirrored: usize,
    /// Whether it stands as its members do.
    pub upright: bool,
}

/// What was learned.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Learned {
    /// The shapes, those seen most often first.
    pub prototypes: Vec<Prototype>,
    /// Silhouette of the best partition into k = 2, 3, ... clusters.
    pub silhouettes: Vec<Silhouette>,
    /// Members that resemble no other, or a shape seen too rarely.
    pub outliers: Vec<usize>,
}

/// Why nothing was learned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LearnError {
    /// Too few objects show their whole shape.
    TooFewMembers {
        /// How many do.
        len: usize,
        /// How many are needed.
        least: usize,
    },
    /// No two members have the same shape.
    NoShape {
        /// Number of members.
        len: usize,
    },
    /// A setting is zero.
    Zero {
        /// Its name.
        what: &'static str,
    },
}

impl core::fmt::Display for LearnError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::TooFewMembers { len, least } => write!(
                f,
                "{len} objects stand alone, uncropped and large enough to show their shape, needs at least {least}: add pictures"
            ),
            Self::NoShape { len } => write!(f, "no shape repeats among {len} objects: add pictures of the same shapes"),
            Self::Zero { what } => write!(f, "{what} must be at least 1"),
        }
    }
}

impl core::error::Error for LearnError {}

/// Finds the shapes of `members`: outliers are dropped, k-medoids for every k, the least k whose silhouette is the best
/// one up to its standard error, one shape if no silhouette reaches 0.5, and each shape as the mean of its members laid on each other.
///
/// The silhouette sees distances that saturate: 0 up to s and 1 - exp((1 - (d / s)^2) / 2) beyond, with the spread s of
/// members of one shape, from the distances to nearest neighbors and the sizes in pixels. So it asks whether clusters can
/// be told apart, not how far apart they are, and two similar shapes among very different ones are not merged. A single
/// cluster has no silhouette; splitting one gives distances within and between that are 0 or alike, hence a silhouette
/// near 0: that is how k = 1 is told.
///
/// # Errors
/// [`LearnError`] if there are too few members or nothing repeats.
pub fn learn(members: &[Member], options: &PrototypeOptions) -> Result<Learned, LearnError> {
    for (what, value) in [("max_shapes", options.max_shapes), ("min_members", options.min_members)] {
        if value == 0 {
            return Err(LearnError::Zero { what });
        }
    }
    let least = options.min_members.max(2);
    if members.len() < least {
        return Err(LearnError::TooFewMembers { len: members.len(), least });
    }
    let mut used: Vec<usize> = (0..members.len()).collect();
    sort::descending(&mut used, |&i| members[i].radius_px);
    used.truncate(MAX_MEMBERS);
    used.sort_unstable();
    let freedom = options.freedom();
    let distance = |i: usize, j: usize| members[i].form.align_by(&members[j].form, freedom).distance;
    let all = DistanceMatrix::new(used.len(), |i, j| distance(used[i], used[j]));
    let typical = (SPREAD * median(&neighbor_distances(&all, 1))).min(LARGEST_TYPICAL);
    let spread = |i: usize, j: usize| {
        let noise = |member: &Member| member.noise_px / member.radius_px;
        let from_pixels = Float::hypot(noise(&members[i]), noise(&members[j]));
        typical.max(from_pixels.min(OTHER_SHAPE)).max(SAME_SHAPE)
    };
    // In units of how far members of one shape may be apart.
    let relative = DistanceMatrix::new(used.len(), |i, j| all.row(i)[j] / spread(used[i], used[j]));
    // As many neighbors as make the least cluster.
    let nearest = neighbor_distances(&relative, least - 1);
    let kept: Vec<usize> = (0..used.len()).filter(|&i| nearest[i] <= OUTLIER).collect();
    if kept.len() < least {
        return Err(LearnError::NoShape { len: members.len() });
    }
    let saturating = DistanceMatrix::new(kept.len(), |i, j| {
        let ratio = relative.row(kept[i])[kept[j]];
        1.0 - Float::exp(-0.5 * (ratio * ratio - 1.0).max(0.0))
    });
    let (partition, silhouettes) = best_partition(&saturating, options.max_shapes);
    let mut learned = Learned { prototypes: Vec::new(), silhouettes, outliers: Vec::new() };
    for cluster in 0..partition.medoids.len() {
        let own = (0..kept.len()).filter(|&i| partition.clusters[i] == cluster).map(|i| used[kept[i]]).collect();
        let medoid = used[kept[partition.medoids[cluster]]];
        learned.prototypes.extend(prototype(members, own, medoid, options));
    }
    if learned.prototypes.is_empty() {
        return Err(LearnError::NoShape { len: members.len() });
    }
    sort::descending(&mut learned.prototypes, |prototype| prototype.members.len() as f64);
    let taken = |i: &usize| learned.prototypes.iter().any(|prototype| prototype.members.contains(i));
    learned.outliers = (0..members.len()).filter(|i| !taken(i)).collect();
    Ok(learned)
}

/// The partition into the fewest clusters whose silhouette is the best one, up to its standard error, or all in one
/// cluster; and the silhouettes of k = 2, 3, ...
fn best_partition(distances: &DistanceMatrix, max_shapes: usize) -> (Partition, Vec<Silhouette>) {
    // A cluster has two members at least.
    let most = max_shapes.min(distances.count() / 2);
    let partitions: Vec<Partition> = (2..=most).map(|k| k_medoids(distances, k)).collect();
    let silhouettes: Vec<Silhouette> = partitions.iter().map(|partition| silhouette(distances, partition)).collect();
    let best = silhouettes.iter().copied().reduce(|best, next| if next.mean > best.mean { next } else { best });
    let chosen = best.filter(|best| best.mean >= LEAST_SILHOUETTE).and_then(|best| {
        let enough = |(_, value): &(Partition, Silhouette)| value.mean >= best.mean - best.error;
        partitions.into_iter().zip(silhouettes.iter().copied()).find(enough)
    });
    (chosen.map_or_else(|| k_medoids(distances, 1), |(partition, _)| partition), silhouettes)
}

/// The mean of a cluster laid on its medoid, large objects first in weight; none if it was seen too rarely.
fn prototype(members: &[Member], own: Vec<usize>, medoid: usize, options: &PrototypeOptions) -> Option<Prototype> {
    if own.len() < options.min_members {
        return None;
    }
    let mut mean = members[medoid].form.clone();
    let mut distances = vec![0.0; own.len()];
    let mut mirrored = 0;
    // Laid on the medoid, then once more on the mean, without those that are far off.
    for round in 0..2 {
        let alignments: Vec<_> = own.iter().map(|&i| mean.align_by(&members[i].form, options.freedom())).collect();
        distances = alignments.iter().map(|alignment| alignment.distance).collect();
        mirrored = alignments.iter().filter(|alignment| alignment.mirrored).count();
        let limit = if round == 0 { f64::INFINITY } else { SPREAD * median(&distances) };
        let laid: Vec<(Form, f64)> = own
            .iter()
            .zip(&alignments)
            .filter(|(_, alignment)| alignment.distance <= limit)
            .map(|(&i, alignment)| (members[i].form.aligned(alignment), Float::powi(members[i].radius_px, 2)))
            .collect();
        mean = Form::mean(laid.iter().map(|(form, weight)| (form, *weight)))?;
    }
    let spread = median(&distances);
    let tolerance = (EVIDENT * spread / Float::sqrt(f64::of_usize(own.len()))).clamp(SYMMETRIC, SAME_SHAPE);
    let (form, symmetry, own_mirror) = mean.symmetrized(tolerance);
    let mirrored = if own_mirror { 0 } else { mirrored };
    let upright = options.upright;
    Some(Prototype { form, members: own, medoid, spread, symmetry, own_mirror, mirrored, upright })
}

impl Learned {
    /// The shapes as a bank: "shape 1", "shape 2", ...; of a shape that was seen in both hands also "shape 1 mirrored".
    #[must_use]
    #[inline(never)]
    pub fn bank<T: Real>(&self) -> Bank<T> {
        let mut bank = Bank { prototypes: Vec::new() };
        for (number, prototype) in (1..).zip(&self.prototypes) {
            let name = format!("shape {number}");
            if prototype.mirrored > 0 && prototype.mirrored < prototype.members.len() {
                push(&mut bank, format!("{name} mirrored"), &prototype.form.mirrored(), prototype.upright);
            }
            push(&mut bank, name, &prototype.form, prototype.upright);
        }
        bank
    }
}

fn push<T: Real>(bank: &mut Bank<T>, name: String, form: &Form, upright: bool) {
    let mut efd = form.efd(TRUNCATION);
    match efd.normalize() {
        // Its own size is that of the first harmonic, as of all shapes of banks; it stays as it stands.
        Ok(normal) if upright => efd.rotate_scale(0.0, normal.scale.recip()),
        Ok(normal) => efd = normal.efd,
        // What has no first harmonic is as large as a disk of its area.
        Err(_) => (),
    }
    let rows = efd.rows().iter().map(|row| row.map(T::of)).collect();
    bank.prototypes.push((name, Efd::new(rows)));
}

/// Distance of each thing to its `rank`-th nearest neighbor.
fn neighbor_distances(distances: &DistanceMatrix, rank: usize) -> Vec<f64> {
    let nearest = |i: usize| {
        let mut row = distances.row(i).to_vec();
        sort::ascending(&mut row, |&distance| distance);
        // The nearest of all is the thing itself.
        row.get(rank).copied().unwrap_or(f64::INFINITY)
    };
    (0..distances.count()).map(nearest).collect()
}

fn median(values: &[f64]) -> f64 {
    sort::median(&mut values.to_vec()).unwrap_or(0.0)
}
