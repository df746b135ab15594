//! Things that are others again, elsewhere, in another size, or reflected: what is seen of one tells what is hidden of the other.
//!
//! A thing that others hide in part is held against the outlines of every other thing of the picture. Three straight stretches of
//! its boundary tell of a shift and a scale; what agrees best with all that is seen is refined, and taken if it
//! covers what it should and three numbers in place of an outline are the shorter description. Things may be upside down or mirrored, but are
//! not turned.

use alloc::rc::Rc;
use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::geometry::{LineSegment, Similarity};
use dvp_core::sort;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::complete::{Completed, Completion};
use super::join::Group;
use super::junction::solve;
use super::raster;
use super::visible::Hidden;
use crate::outline::Outline;
use crate::sample::{RingSamples, Sample};
use crate::tuning;

/// Straight stretches of a boundary that are held against a template first: three of them make a guess.
const STRETCHES: usize = 6;
/// Edges of a template that each of them may be of: the longest ones.
const LIKE: usize = 3;
/// Most edges of a template: more are no straight shape.
const MOST_EDGES: usize = 96;
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
/// Steps of the refinement.
const STEPS: usize = 6;
/// Pixels that shift and scale of a thing are known to.
const SIGMA: f64 = 0.01;

/// How many templates are held against samples in the time that an outline through these takes, about.
const QUICKER: usize = 64;

/// Takes another thing's outlines for what is hidden in part, where that is the shorter description; then leaves out what was painted in the
/// color of the background only because others were thought to lie there.
pub(super) fn repeat(completion: &mut Completion<'_>, groups: &mut Vec<Group>) {
    if groups.len() < 2 || completion.is_spent() {
        return;
    }
    unite(completion, groups);
    for at in 0..groups.len() {
        if let Some(found) = best(completion, groups, &groups[at].faces, groups[at].completed.bits, &[at]) {
            groups[at].completed = Rc::new(found);
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
        let apart = completion.apart();
        let is_wanted = |at: &usize| color(&groups[*at], completion) == wanted;
        let is_apart = |at: &usize| groups[*at].faces.iter().any(|face| apart.contains(face));
        let of_color: Vec<usize> = (0..groups.len()).filter(is_wanted).filter(|at| !is_apart(at)).collect();
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
            groups[first] = Group { faces, completed: Rc::new(completed) };
            of_color[1..].iter().rev().for_each(|&at| drop(groups.remove(at)));
        } else {
            faces.iter().zip(ranks).for_each(|(&face, rank)| completion.rank[face as usize] = rank);
        }
    }
}

/// The outlines of another thing, moved, that faces are described by in less than `most` bits; `own`: the things that they are now.
fn best(completion: &Completion<'_>, groups: &[Group], faces: &[u32], most: f64, own: &[usize]) -> Option<Completed> {
    let place = completion.place(faces);
    let rank = place.rank;
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
    let others = (0..groups.len()).filter(|at| !own.contains(at)).map(|at| &*groups[at].completed);
    let agreeing = others.filter(|template| !template.outlines.is_empty() && template.agrees);
    let with_edges = agreeing.map(|template| {
        let polygons = template.outlines.iter().filter_map(raster::polygon);
        (template, polygons.flat_map(|points| LineSegment::closed(&points).collect::<Vec<_>>()).collect())
    });
    let straight: Vec<(&Completed, Vec<LineSegment<f64>>)> =
        with_edges.filter(|(_, edges): &(_, Vec<_>)| edges.len() <= MOST_EDGES).collect();
    for ((template, edges), flip) in straight.iter().flat_map(|straight| flips().map(move |flip| (straight, flip))) {
        completion.memo.spent.set(completion.memo.spent.get() + samples.len().div_ceil(QUICKER));
        if completion.is_spent() {
            break;
        }
        let flipped = |edge: &LineSegment<f64>| LineSegment {
            from: flip.point(edge.from),
            along: flip.direction(edge.along),
            ..*edge
        };
        let edges: Vec<LineSegment<f64>> = edges.iter().map(flipped).collect();
        let Some(guess) = guess(&stretches, &edges) else { continue };
        let Some((map, misfit)) = refined(guess, &edges, &samples) else { continue };
        let choices = groups.len() * flips().len();
        let numbers = 3.0 * completion.ruler.number(SIGMA) + (choices as f64).log2() + tuning::OUTLINE_PIECE_BITS;
        let bits = numbers + completion.ruler.misfit(misfit);
        if bits >= best.as_ref().map_or(most - tuning::LEAST_SAVED, |best| best.bits) {
            continue;
        }
        let count = template.outlines.len() as f64;
        let map = flip.then(&map);
        let moved = |outline: &Outline| Outline {
            shape: outline.shape.moved(&map),
            bits: numbers / count,
            misfit: completion.ruler.misfit(misfit) / count,
            covariance: Vec::new(),
        };
        let outlines: Vec<Outline> = template.outlines.iter().map(moved).collect();
        if completion.check(&outlines, &place).is_ok() {
            best = Some(Completed::new(outlines, true));
        }
    }
    best
}

/// A template as it is, upside down, and mirrored.
fn flips() -> [Similarity<f64>; 3] {
    let flip = |x: f64, reflected: bool| Similarity { turn: Vec2::new(x, 0.0), reflected, ..Similarity::identity() };
    [flip(1.0, false), flip(1.0, true), flip(-1.0, true)]
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
    sort::descending(&mut all, |stretch| stretch.count as f64);
    all.truncate(STRETCHES);
    all
}

/// A shift and a scale as a map; none if it makes things too large or too small.
fn shift_and_scale([scale, x, y]: [f64; 3]) -> Option<Similarity<f64>> {
    let map = Similarity { turn: Vec2::new(scale, 0.0), translation: Vec2::new(x, y), reflected: false };
    (1.0 / MOST_SCALE..=MOST_SCALE).contains(&scale).then_some(map)
}

/// The edge of a template that is nearest to a point where `map` puts it, and from there to the point.
fn nearest<'a>(
    map: &Similarity<f64>,
    edges: &'a [LineSegment<f64>],
    point: Vec2<f64>,
) -> Option<(&'a LineSegment<f64>, Vec2<f64>)> {
    let at = map.inverse()?.point(point);
    let offsets = edges.iter().map(|edge| (edge, edge.nearest(at).offset));
    let (edge, offset) = offsets.min_by(|a, b| a.1.length_squared().total_cmp(&b.1.length_squared()))?;
    Some((edge, map.direction(offset)))
}

/// The shift and scale of a template that agrees with most of some stretches.
fn guess(stretches: &[Stretch], edges: &[LineSegment<f64>]) -> Option<Similarity<f64>> {
    let is_like = |stretch: &Stretch, edge: &&LineSegment<f64>| {
        edge.along.normalized().is_some_and(|along| along.cross(stretch.direction).abs() < ALIKE)
    };
    let like = |stretch: &Stretch| {
        let mut like: Vec<&LineSegment<f64>> = edges.iter().filter(|edge| is_like(stretch, edge)).collect();
        sort::descending(&mut like, |edge| edge.along.length_squared());
        like.truncate(LIKE);
        like
    };
    let like: Vec<Vec<&LineSegment<f64>>> = stretches.iter().map(like).collect();
    let places = || stretches.iter().flat_map(|stretch| stretch.places);
    let off = |map: &Similarity<f64>, limit: f64| {
        let mut sum = 0.0;
        for point in places() {
            sum += nearest(map, edges, point).map_or(FAR2, |(_, off)| off.length_squared().min(FAR2));
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
                            let Some(map) = through([(at[0], *a), (at[1], *b), (at[2], *c)]) else { continue };
                            let sum = off(&map, least);
                            if sum < least {
                                (best, least) = (Some(map), sum);
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
fn through(three: [(Vec2<f64>, &LineSegment<f64>); 3]) -> Option<Similarity<f64>> {
    let mut matrix = [[0.0; 3]; 3];
    let mut right = [0.0; 3];
    for (k, (point, edge)) in three.into_iter().enumerate() {
        let normal = edge.along.normalized()?.perp();
        matrix[k] = [normal.dot(edge.from), normal.x, normal.y];
        right[k] = normal.dot(point);
    }
    shift_and_scale(solve(matrix, right)?)
}

/// The same, nearest to all samples; and by how much it misses them, squares of standard deviations, each up to a bound.
fn refined(mut map: Similarity<f64>, edges: &[LineSegment<f64>], samples: &[Sample]) -> Option<(Similarity<f64>, f64)> {
    let mut chi2 = 0.0;
    for step in 0..=STEPS {
        let mut matrix = [[0.0; 3]; 3];
        let mut right = [0.0; 3];
        chi2 = 0.0;
        for sample in samples {
            let (edge, off) = nearest(&map, edges, sample.point)?;
            let normal = edge.along.normalized()?.perp();
            // What is known is the position along the axis of the window.
            let sigma = (sample.sigma * normal.dot(sample.axis).abs()).hypot(tuning::RENDERER_SIGMA);
            let sigmas = off.length() / sigma;
            // Windows at the ends of what is seen have a third thing in them: what is off by more tells nothing.
            let weight = (tuning::OUTLINE_HUBER / sigmas.max(tuning::OUTLINE_HUBER)).powi(2);
            chi2 += weight * sigmas * sigmas;
            let on = (sample.point - off - map.translation) / map.scale();
            let row = [normal.dot(on), normal.x, normal.y].map(|value| value / sigma);
            for i in 0..3 {
                right[i] += weight * row[i] * off.dot(normal) / sigma;
                for j in 0..3 {
                    matrix[i][j] += weight * row[i] * row[j];
                }
            }
        }
        if step < STEPS {
            let [scale, x, y] = solve(matrix, right)?;
            map = shift_and_scale([map.scale() + scale, map.translation.x + x, map.translation.y + y])?;
        }
    }
    Some((map, chi2))
}
