//! Where pieces may meet: a few of the places between samples, found with a polygon along them.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::track::Track;
use crate::tuning;

/// Places where pieces may meet; place k lies between samples k - 1 and k.
#[derive(Clone, Debug)]
pub(super) struct Nodes {
    /// Rising, from 0 to the number of samples.
    pub(super) places: Vec<usize>,
    /// Of each place: how sharply the polygon turns there, radians; 0 beside its vertices.
    pub(super) turns: Vec<f64>,
    /// Of each place: whether cubics may start and end there; beside vertices without a corner they may not.
    pub(super) cubic: Vec<bool>,
}

impl Nodes {
    /// The places along `track`.
    pub(super) fn of(track: &Track) -> Self {
        let count = track.len();
        let polygon = polygon(track);
        let mut marks = vec![None::<(f64, bool)>; count + 1];
        let mut mark = |place: usize, turn: f64, cubic: bool| {
            if let Some(old) = marks.get_mut(place) {
                let (turn_before, cubic_before) = old.unwrap_or_default();
                *old = Some((turn_before.max(turn), cubic_before || cubic));
            }
        };
        for (k, &corner) in polygon.iter().enumerate() {
            let turn = turn(track, &polygon, k);
            mark(corner, turn, true);
            if turn > tuning::OUTLINE_SHARP {
                for place in corner.saturating_sub(2)..=corner + 3 {
                    mark(place, 0.0, true);
                }
            } else {
                mark(corner + 1, 0.0, false);
            }
        }
        for place in [0, 1, 2, count - 2, count - 1, count] {
            mark(place, 0.0, true);
        }
        for place in (0..count).filter(|&k| track.hidden[k]) {
            mark(place, 0.0, true);
        }
        if count <= tuning::OUTLINE_ALL_PLACES {
            (0..=count).for_each(|place| mark(place, 0.0, false));
        }
        let mut nodes = Self { places: Vec::new(), turns: Vec::new(), cubic: Vec::new() };
        for (place, mark) in marks.iter().enumerate() {
            if let &Some((turn, cubic)) = mark {
                nodes.places.push(place);
                nodes.turns.push(turn);
                nodes.cubic.push(cubic);
            }
        }
        nodes
    }

    /// The sample at the sharpest corner, if there is one.
    pub(super) fn sharpest(track: &Track) -> Option<usize> {
        let polygon = polygon(track);
        let strength = |k: usize| {
            let turn = turn(track, &polygon, k);
            let [before, after] = neighbors(track, &polygon, k);
            (turn > tuning::OUTLINE_SHARP).then(|| turn * before.length().min(after.length()).min(8.0))
        };
        let corners = (0..polygon.len()).filter_map(|k| Some((strength(k)?, polygon[k])));
        corners.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, sample)| sample)
    }
}

/// Edges of the polygon before and after its vertex `k`.
fn neighbors(track: &Track, polygon: &[usize], k: usize) -> [Vec2<f64>; 2] {
    let count = polygon.len();
    let [before, here, after] = [(k + count - 1) % count, k, (k + 1) % count].map(|i| track.point(polygon[i]));
    [here - before, after - here]
}

/// How sharply a polygon turns at its vertex `k`, radians; 0 at the ends of an open one.
fn turn(track: &Track, polygon: &[usize], k: usize) -> f64 {
    if !track.closed && (k == 0 || k + 1 == polygon.len()) {
        return 0.0;
    }
    let [before, after] = neighbors(track, polygon, k);
    before.cross(after).atan2(before.dot(after)).abs()
}

/// Samples such that the straight lines between them pass all others within what noise explains, rising.
///
/// *Source*: Ramer 1972, Douglas and Peucker 1973.
fn polygon(track: &Track) -> Vec<usize> {
    let count = track.len();
    let tolerance = tuning::OUTLINE_POLYGON_SIGMAS * track.sigma;
    let mut kept = vec![false; count];
    let far = if track.closed {
        let start = track.point(0);
        let distance = |k: usize| (track.point(k) - start).length_squared();
        (1..count).max_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(count - 1)
    } else {
        count - 1
    };
    kept[0] = true;
    kept[far] = true;
    let mut open = vec![(0, far)];
    if track.closed && far + 1 < count {
        // Back to the start: the last stretch ends at sample 0, which comes after the last.
        open.push((far, count));
    }
    while let Some((first, last)) = open.pop() {
        let [from, to] = [first, last].map(|k| track.point(k % count));
        let chord = to - from;
        let length = chord.length();
        let distance = |k: usize| {
            let offset = track.point(k) - from;
            if length > 0.0 { chord.cross(offset).abs() / length } else { offset.length() }
        };
        let Some((gap, middle)) = (first + 1..last).map(|k| (distance(k), k)).max_by(|a, b| a.0.total_cmp(&b.0)) else {
            continue;
        };
        if gap > tolerance {
            kept[middle] = true;
            open.extend([(first, middle), (middle, last)]);
        }
    }
    (0..count).filter(|&k| kept[k]).collect()
}
