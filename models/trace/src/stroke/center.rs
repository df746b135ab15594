//! From chains of center points to lines of lines, arcs and cubics, with their ends.

use alloc::vec::Vec;

use dvp_core::Vec2;
use dvp_core::shape::{Cap, PathRing, Piece, Segment};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::border::{Border, Mark};
use super::chain::{Chain, Tip, meeting};
use super::draw::{Drawing, Line};
use super::piece::{halve_turns, move_tip, pieces, tip};
use crate::outline::{OutlineShape, fit_closed, fit_open};
use crate::ruler::Ruler;
use crate::sample::RingSamples;

/// The lines of all chains, each with the ends that its marks show; none if a center line cannot be fitted.
pub(super) fn lines(border: &Border, chains: &[Chain], width: f64, ruler: &Ruler) -> Option<Drawing> {
    let mut lines = Vec::with_capacity(chains.len());
    // How much less the marks at free ends miss straight ends than round ones.
    let mut butt_gain = 0.0;
    let mut gains = Vec::with_capacity(chains.len());
    for chain in chains {
        let (mut ring, figure) = center_line(chain, width, ruler)?;
        let mut gain = 0.0;
        for (at_finish, end) in [false, true].into_iter().zip(&chain.tips) {
            let (Tip::Free { marks, is_cut }, false) = (end, ring.is_closed()) else { continue };
            let marks: Vec<_> = marks.iter().filter_map(|&mark| border.marks.get(mark)).collect();
            let Ends { round, butt, none } = ends(tip(&ring, at_finish)?, &marks, 0.5 * width);
            let to = if *is_cut && none <= round.1.min(butt.1) + END_CHI2 {
                // Far enough for its end not to show.
                ahead(&ring, at_finish, width)?
            } else {
                gain += round.1 - butt.1;
                if round.1 <= butt.1 { round.0 } else { butt.0 }
            };
            move_tip(&mut ring, at_finish, to);
        }
        butt_gain += gain;
        gains.push(gain);
        lines.push(Line::new(ring, Cap::Round)?.with_figure(figure));
    }
    // Lines that show no end are drawn as the others; if none does, as their corners.
    for (line, gain) in lines.iter_mut().zip(gains) {
        if gain > 0.0 || (gain == 0.0 && butt_gain > 0.0) {
            line.cap = Cap::Butt;
        }
    }
    let mut drawing = Drawing { lines, half_width: 0.5 * width, is_mitered: false };
    for (line, chain) in drawing.lines.iter_mut().zip(chains) {
        line.is_covered = [0, 1].map(|end| matches!(chain.tips[end], Tip::Junction));
    }
    run_together(&mut drawing);
    Some(drawing)
}

/// Lets lines that others hide the ends of end on the center lines of these.
pub(super) fn run_together(drawing: &mut Drawing) {
    for line in 0..drawing.lines.len() {
        for at_finish in [false, true] {
            if drawing.lines[line].is_covered[usize::from(at_finish)] {
                // What cannot be moved stays where it is.
                let _ = run_into(drawing, line, at_finish);
            }
        }
    }
}

/// The center line of a chain, corners where its stretches meet, and the whole outline that it is, if it is one.
fn center_line(chain: &Chain, width: f64, ruler: &Ruler) -> Option<(PathRing<f64>, Option<OutlineShape>)> {
    if chain.is_smooth {
        let samples = RingSamples { runs: alloc::vec![chain.stretches.first()?.clone()], closed: true };
        let shape = fit_closed(&samples, ruler)?.shape;
        return Some((shape.ring(), shape.numbers().map(|_| shape)));
    }
    let mut stretches =
        chain.stretches.iter().map(|samples| Some(fit_open(samples, ruler)?.path)).collect::<Option<Vec<_>>>()?;
    let count = stretches.len();
    let corners = if chain.is_closed { count } else { count - 1 };
    for i in 0..corners {
        let next = (i + 1) % count;
        let [from, to] = [tip(stretches.get(i)?, true)?, tip(stretches.get(next)?, false)?];
        let middle = from[0].lerp(to[0], 0.5);
        let corner = meeting(from, to).filter(|&corner| (corner - middle).length() < 2.0 * width).unwrap_or(middle);
        move_tip(stretches.get_mut(i)?, true, corner);
        move_tip(stretches.get_mut(next)?, false, corner);
    }
    let mut ring = PathRing::default();
    for stretch in stretches {
        // The corner itself belongs to both stretches.
        ring.points.pop();
        ring.points.extend(stretch.points);
        ring.segments.extend(stretch.segments);
    }
    if chain.is_closed {
        ring.points.pop();
    }
    halve_turns(&mut ring);
    Some((ring, None))
}

/// Sum of squares that an end must explain where the line may as well go on beyond the border: ten bits, what its place costs.
const END_CHI2: f64 = 20.0 * core::f64::consts::LN_2;

/// What the end of a line may be, and what the marks there miss it by: the sum of squares.
struct Ends {
    round: (Vec2<f64>, f64),
    butt: (Vec2<f64>, f64),
    /// If the line goes on.
    none: f64,
}

/// Where a round and a butt end would be, given the end of the line so far and the marks beyond it.
fn ends([from, out]: [Vec2<f64>; 2], marks: &[&Mark], half: f64) -> Ends {
    let places: Vec<_> =
        marks.iter().map(|mark| ((mark.point - from).dot(out), (mark.point - from).cross(out).abs())).collect();
    // The reach of the disk of each mark that is on its front.
    let fronts = places
        .iter()
        .filter(|place| place.1 < 0.8 * half)
        .map(|place| place.0 - (half * half - place.1 * place.1).sqrt());
    let faces = places.iter().filter(|place| place.1 < half - 1.0).map(|place| place.0);
    let reach = |of: Vec<f64>, tip: f64| {
        if of.is_empty() { tip } else { of.iter().sum::<f64>() / of.len() as f64 }
    };
    let furthest = places.iter().map(|place| place.0).fold(0.0, f64::max);
    let round = reach(fronts.collect(), furthest - half);
    let butt = reach(faces.collect(), furthest);
    let misses = |gap: &dyn Fn(f64, f64) -> f64| -> f64 {
        places.iter().zip(marks).map(|(place, mark)| (gap(place.0, place.1) / mark.sigma).powi(2)).sum()
    };
    let miss_round =
        misses(&|along, aside| if along > round { (along - round).hypot(aside) - half } else { aside - half });
    let miss_butt = misses(&|along, aside| (along - butt).max(aside - half));
    let none = misses(&|_, aside| aside - half);
    Ends { round: (from + out * round, miss_round), butt: (from + out * butt, miss_butt), none }
}

/// The place that a line comes to if it goes on beyond an end, so many pixels: arcs as arcs.
fn ahead(ring: &PathRing<f64>, at_finish: bool, reach: f64) -> Option<Vec2<f64>> {
    let pieces = pieces(ring);
    match if at_finish { pieces.last() } else { pieces.first() }? {
        piece @ Piece::Arc { .. } => {
            let share = reach / piece.length();
            Some(piece.point(if at_finish { 1.0 + share } else { -share }))
        }
        _ => tip(ring, at_finish).map(|[from, out]| from + out * reach),
    }
}

/// Lets a line that ends at a junction go on, or end earlier, on the center line of another.
fn run_into(drawing: &mut Drawing, line: usize, at_finish: bool) -> Option<()> {
    let own = drawing.lines.get(line)?;
    let [from, out] = tip(&own.ring, at_finish)?;
    let skipped = if at_finish { own.pieces.len() - 1 } else { 0 };
    let piece = *own.pieces.get(skipped)?;
    let length = piece.length();
    let straight = |reach: f64| from + out * reach;
    let around = |reach: f64| piece.point(if at_finish { 1.0 + reach / length } else { -reach / length });
    let distance = |point: Vec2<f64>| drawing.distance(point, (line, skipped));
    let mut ring = own.ring.clone();
    let to = nearest_ahead(&straight, &distance, drawing.half_width);
    // Arcs go on as arcs if that leads there.
    let bent = matches!(piece, Piece::Arc { .. }).then(|| nearest_ahead(&around, &distance, drawing.half_width));
    match bent {
        Some(bent) if distance(bent) < 0.1 * drawing.half_width => move_tip(&mut ring, at_finish, bent),
        Some(_) if (to - from).dot(out) > 0.0 => {
            let end = if at_finish { ring.points.len() } else { 0 };
            ring.points.insert(end, to.to_array());
            ring.segments.insert(if at_finish { end - 1 } else { 0 }, Segment::Line);
        }
        _ => move_tip(&mut ring, at_finish, to),
    }
    *drawing.lines.get_mut(line)? = own.with_ring(ring)?;
    Some(())
}

/// The place along a way from an end that is nearest to something: from half a width back to one and a half ahead.
fn nearest_ahead(place: &dyn Fn(f64) -> Vec2<f64>, distance: &dyn Fn(Vec2<f64>) -> f64, half: f64) -> Vec2<f64> {
    const PLACES: u8 = 24;
    let distance = |reach: f64| distance(place(reach));
    let reaches = (0..=PLACES).map(|k| (f64::from(k) * 4.0 / f64::from(PLACES) - 1.0) * half);
    let mut reach = reaches.min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or_default();
    // Toward a line the distance falls in proportion: halving steps, down to a hundredth of a pixel.
    let mut step = half * 2.0 / f64::from(PLACES);
    while step > 0.005 {
        let [ahead, behind, here] = [reach + step, reach - step, reach].map(distance);
        reach = if ahead < here {
            reach + step
        } else if behind < here {
            reach - step
        } else {
            reach
        };
        step *= 0.5;
    }
    place(reach)
}
