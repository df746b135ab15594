//! Things that are others again, elsewhere and in another size: what is seen of one tells what is hidden of the other.
//!
//! A thing that others hide in part is held against the outlines of every other thing of the picture. Three straight stretches of
//! its boundary tell of a shift and a scale; what agrees best with all that is seen is refined, and taken if it
//! covers what it should and three numbers in place of an outline are the shorter description. Things are not turned.

use alloc::vec::Vec;

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::complete::{Completed, Completion};
use super::join::Group;
use super::raster;
use super::visible::Hidden;
use crate::outline::Outline;
use crate::sample::{RingSamples, Sample};
use crate::tuning;

/// Straight stretches of a boundary that are held against a template first: three of them make a guess.
const STRETCHES: usize = 9;
/// Pixels that a straight stretch may be off its direction.
const STRAIGHT: f64 = 0.5;
/// Steps of samples to both sides that tell the direction of a boundary, and fewest of a stretch.
const BESIDE: usize = 2;
/// Sine of the angle up to which a stretch may be an edge of a template: of five windows in a row it is known to a few degrees.
const ALIKE: f64 = 0.1;
/// Most that one thing is larger than another.
const MOST_SCALE: f64 = 4.0;
/// Squared pixels that a place may be off before how far counts no more.
const FAR2: f64 = 0.25;
/// Least determinant of three directions, with the template's size for a unit: three of them that are nearly parallel tell nothing.
const LEAST_SPREAD: f64 = 0.02;
/// Steps of the refinement.
const STEPS: usize = 6;
/// Pixels that shift and scale of a thing are known to.
const SIGMA: f64 = 0.01;

/// Takes another thing's outlines for what is hidden in part, where that is the shorter description; then leaves out what was painted in the
/// color of the background only because others were thought to lie there.
pub(super) fn repeat(completion: &mut Completion<'_>, groups: &mut Vec<Group>) {
    if groups.len() < 2 || completion.is_spent() {
        return;
    }
    unite(completion, groups);
    for at in 0..groups.len() {
        if let Some(found) = best(completion, groups, &groups[at].faces, groups[at].completed.bits, &[at]) {
            groups[at].completed = found;
        }
    }
    let painted_ground = |at: &usize| completion.shows_background(groups[*at].faces[0]);
    for at in (0..groups.len()).rev().filter(painted_ground).collect::<Vec<_>>() {
        let ranks: Vec<usize> = groups[at].faces.iter().map(|&face| completion.rank(face)).collect();
        groups[at].faces.iter().for_each(|&face| completion.rank[face as usize] = 0);
        let leaves_it = |(other, group): (usize, &Group)| {
            let is_pen = completion.pen(&group.faces).is_some();
            other == at || !is_pen && completion.shows_only(&group.faces, &group.completed)
        };
        if groups.iter().enumerate().all(leaves_it) {
            groups.remove(at);
        } else {
            groups[at].faces.iter().zip(ranks).for_each(|(&face, rank)| completion.rank[face as usize] = rank);
        }
    }
}

/// Makes one thing of all things of a color, where they are another thing again together.
fn unite(completion: &mut Completion<'_>, groups: &mut Vec<Group>) {
    let color = |group: &Group, completion: &Completion<'_>| completion.partition.faces[group.faces[0] as usize].color;
    let mut colors: Vec<usize> = groups.iter().map(|group| color(group, completion)).collect();
    colors.sort_unstable();
    colors.dedup();
    for wanted in colors {
        let of_color: Vec<usize> = (0..groups.len()).filter(|&at| color(&groups[at], completion) == wanted).collect();
        let [first, .., _] = of_color[..] else { continue };
        if of_color.len() > tuning::MOST_PAIRED {
            continue;
        }
        let faces: Vec<u32> = of_color.iter().flat_map(|&at| &groups[at].faces).copied().collect();
        let ranks: Vec<usize> = faces.iter().map(|&face| completion.rank(face)).collect();
        let apart: f64 = of_color.iter().map(|&at| groups[at].completed.bits + tuning::THING_BITS).sum();
        completion.sink(&faces);
        // What lies in front of all of it now must leave it seen.
        let is_seen = |completion: &Completion<'_>| {
            let others = groups.iter().enumerate().filter(|(at, _)| !of_color.contains(at)).map(|(_, group)| group);
            others.into_iter().all(|group| completion.holds(&group.faces, &group.completed))
        };
        let united = best(completion, groups, &faces, apart - tuning::THING_BITS, &of_color);
        if let Some(completed) = united.filter(|_| is_seen(completion)) {
            groups[first] = Group { faces, completed };
            of_color[1..].iter().rev().for_each(|&at| drop(groups.remove(at)));
        } else {
            faces.iter().zip(ranks).for_each(|(&face, rank)| completion.rank[face as usize] = rank);
        }
    }
}

/// The outlines of another thing, moved, that faces are described by in less than `most` bits; `own`: the things that they are now.
fn best(completion: &Completion<'_>, groups: &[Group], faces: &[u32], most: f64, own: &[usize]) -> Option<Completed> {
    let rank = completion.hindmost(faces);
    let mut walks = completion.walks(faces, rank);
    walks.retain(|walk| !walk.is_filled);
    let is_hidden = walks.iter().any(|walk| walk.hidden.contains(&Some(Hidden::Free)));
    if rank == 0 || completion.pen(faces).is_some() || !is_hidden {
        return None;
    }
    let seen: Vec<RingSamples> = walks.iter().map(|walk| walk.samples()).collect();
    let runs: Vec<&Vec<Sample>> = seen.iter().flat_map(|ring| &ring.runs).collect();
    let stretches = stretches(&runs);
    let samples: Vec<Sample> = runs.into_iter().flatten().copied().collect();
    let mut best: Option<Completed> = None;
    for template in (0..groups.len()).filter(|at| !own.contains(at)).map(|at| &groups[at].completed) {
        if template.outlines.is_empty() || !template.agrees {
            continue;
        }
        let edges = edges(&template.outlines);
        let Some(guess) = guess(&stretches, &edges) else { continue };
        let Some((placed, misfit)) = refined(guess, &edges, &samples) else { continue };
        let numbers = 3.0 * completion.ruler.number(SIGMA) + (groups.len() as f64).log2() + tuning::OUTLINE_PIECE_BITS;
        let bits = numbers + completion.ruler.misfit(misfit);
        if bits >= best.as_ref().map_or(most - tuning::LEAST_SAVED, |best| best.bits) {
            continue;
        }
        let count = template.outlines.len() as f64;
        let moved = |outline: &Outline| Outline {
            shape: outline.shape.moved(placed.scale, placed.shift),
            bits: numbers / count,
            misfit: completion.ruler.misfit(misfit) / count,
            covariance: Vec::new(),
        };
        let outlines: Vec<Outline> = template.outlines.iter().map(moved).collect();
        if completion.check(&outlines, |face| completion.wanted(face, faces, rank)).is_ok() {
            best = Some(Completed::new(outlines, true));
        }
    }
    best
}

/// A straight stretch of a boundary: its direction, and its first, middle and last place.
struct Stretch {
    direction: Vec2<f64>,
    places: [Vec2<f64>; 3],
    count: usize,
}

/// The longest straight stretches of what is seen, at most [`STRETCHES`].
fn stretches(runs: &[&Vec<Sample>]) -> Vec<Stretch> {
    let mut all: Vec<Stretch> = Vec::new();
    for run in runs {
        let direction = |k: usize| {
            let [from, to] = [k.saturating_sub(BESIDE), (k + BESIDE).min(run.len() - 1)];
            (run[to].point - run[from].point).normalized()
        };
        let mut first = 0;
        while let Some(along) = (first < run.len()).then(|| direction(first)).flatten() {
            let goes_on = |k: &usize| {
                let is_along = direction(*k).is_some_and(|direction| direction.cross(along).abs() < ALIKE);
                is_along && (run[*k].point - run[first].point).cross(along).abs() < STRAIGHT
            };
            let last = (first + 1..run.len()).take_while(goes_on).last().unwrap_or(first);
            if let Some(direction) =
                (run[last].point - run[first].point).normalized().filter(|_| last - first >= BESIDE)
            {
                let places = [first, usize::midpoint(first, last), last].map(|k| run[k].point);
                all.push(Stretch { direction, places, count: last - first });
            }
            first = last + 1;
        }
    }
    all.sort_by_key(|stretch| core::cmp::Reverse(stretch.count));
    all.truncate(STRETCHES);
    all
}

/// An edge of a template: from, to, direction.
type Edge = (Vec2<f64>, Vec2<f64>, Vec2<f64>);

fn edges(outlines: &[Outline]) -> Vec<Edge> {
    let of_polygon = |points: Vec<[f64; 2]>| {
        let points: Vec<Vec2<f64>> = points.into_iter().map(Vec2::from).collect();
        let next = points.iter().cycle().skip(1);
        points.iter().zip(next).filter_map(|(&a, &b)| Some((a, b, (b - a).normalized()?))).collect::<Vec<Edge>>()
    };
    outlines.iter().filter_map(raster::polygon).flat_map(of_polygon).collect()
}

/// Where a template goes: every point times `scale`, plus `shift`.
#[derive(Clone, Copy)]
struct Placed {
    scale: f64,
    shift: Vec2<f64>,
}

impl Placed {
    /// The nearest edge of the placed template to a point: the edge, the nearest point on it, the squared distance.
    fn nearest<'a>(&self, edges: &'a [Edge], point: Vec2<f64>) -> Option<(&'a Edge, Vec2<f64>, f64)> {
        let at = (point - self.shift) * (1.0 / self.scale);
        let near = |edge: &'a Edge| {
            let &(from, to, direction) = edge;
            let along = (at - from).dot(direction).clamp(0.0, (to - from).length());
            let on = from + direction * along;
            (edge, on, (at - on).length_squared())
        };
        let (edge, on, off) = edges.iter().map(near).min_by(|a, b| a.2.total_cmp(&b.2))?;
        Some((edge, on * self.scale + self.shift, off * self.scale * self.scale))
    }
}

/// The shift and scale of a template that agrees with most of some stretches.
fn guess(stretches: &[Stretch], edges: &[Edge]) -> Option<Placed> {
    let is_like = |stretch: &Stretch, edge: &&Edge| edge.2.cross(stretch.direction).abs() < ALIKE;
    let like: Vec<Vec<&Edge>> =
        stretches.iter().map(|stretch| edges.iter().filter(|edge| is_like(stretch, edge)).collect()).collect();
    let places = || stretches.iter().flat_map(|stretch| stretch.places);
    let off = |placed: &Placed, limit: f64| {
        let mut sum = 0.0;
        for point in places() {
            sum += placed.nearest(edges, point).map_or(FAR2, |(_, _, off)| off.min(FAR2));
            if sum >= limit {
                break;
            }
        }
        sum
    };
    // At most a third of the places may be of something else.
    let (mut best, mut least) = (None, FAR2 * places().count() as f64 / 3.0);
    for k in 0..stretches.len() {
        for j in 0..k {
            for i in 0..j {
                let at = [i, j, k].map(|k| stretches[k].places[1]);
                for a in &like[i] {
                    for b in &like[j] {
                        for c in &like[k] {
                            let Some(placed) = through([(at[0], *a), (at[1], *b), (at[2], *c)]) else { continue };
                            let sum = off(&placed, least);
                            if sum < least {
                                (best, least) = (Some(placed), sum);
                            }
                        }
                    }
                }
            }
        }
    }
    best
}

/// The shift and scale that bring three edges to three points.
fn through(three: [(Vec2<f64>, &Edge); 3]) -> Option<Placed> {
    let rows = three.map(|(point, edge)| {
        let normal = edge.2.perp();
        ([normal.dot(edge.0), normal.x, normal.y], normal.dot(point))
    });
    // Cramer's rule; the scale's column has the size of the template.
    let minor = |a: usize, b: usize| rows[a].0[1] * rows[b].0[2] - rows[a].0[2] * rows[b].0[1];
    let minors = [minor(1, 2), minor(2, 0), minor(0, 1)];
    let determinant: f64 = (0..3).map(|k| rows[k].0[0] * minors[k]).sum();
    let size = rows.iter().map(|row| row.0[0].abs()).fold(0.0, f64::max);
    if determinant.abs() < LEAST_SPREAD * size {
        return None;
    }
    let scale = (0..3).map(|k| rows[k].1 * minors[k]).sum::<f64>() / determinant;
    if !(1.0 / MOST_SCALE..=MOST_SCALE).contains(&scale) {
        return None;
    }
    // The two rows whose directions differ most tell the shift.
    let [a, b] = *[[1, 2], [2, 0], [0, 1]]
        .iter()
        .max_by(|&&[a, b], &&[c, d]| minor(a, b).abs().total_cmp(&minor(c, d).abs()))?;
    let rest = [a, b].map(|k| rows[k].1 - scale * rows[k].0[0]);
    let shift =
        Vec2::new(rest[0] * rows[b].0[2] - rest[1] * rows[a].0[2], rows[a].0[1] * rest[1] - rows[b].0[1] * rest[0])
            * (1.0 / minor(a, b));
    Some(Placed { scale, shift })
}

/// The same, nearest to all samples; and by how much it misses them, squares of standard deviations, each up to a bound.
fn refined(mut placed: Placed, edges: &[Edge], samples: &[Sample]) -> Option<(Placed, f64)> {
    let mut chi2 = 0.0;
    for step in 0..=STEPS {
        let mut matrix = [[0.0; 3]; 3];
        let mut right = [0.0; 3];
        chi2 = 0.0;
        for sample in samples {
            let (edge, on, _) = placed.nearest(edges, sample.point)?;
            let normal = edge.2.perp();
            // What is known is the position along the axis of the window.
            let sigma = (sample.sigma * normal.dot(sample.axis).abs()).hypot(tuning::RENDERER_SIGMA);
            let miss = (sample.point - on).dot(normal) / sigma;
            let end = ((sample.point - on).length_squared() / (sigma * sigma) - miss * miss).max(0.0);
            let off = (miss * miss + end).sqrt();
            // Windows at the ends of what is seen have a third thing in them: what is off by more tells nothing.
            let weight = (tuning::OUTLINE_HUBER / off.max(tuning::OUTLINE_HUBER)).powi(2);
            chi2 += weight * off * off;
            let row = [normal.dot(on - placed.shift) / placed.scale, normal.x, normal.y].map(|value| value / sigma);
            for i in 0..3 {
                right[i] += weight * row[i] * miss;
                for j in 0..3 {
                    matrix[i][j] += weight * row[i] * row[j];
                }
            }
        }
        if step == STEPS {
            break;
        }
        let [scale, x, y] = super::junction::solve(matrix, right)?;
        placed = Placed { scale: placed.scale + scale, shift: placed.shift + Vec2::new(x, y) };
        if !(1.0 / MOST_SCALE..=MOST_SCALE).contains(&placed.scale) {
            return None;
        }
    }
    Some((placed, chi2))
}
