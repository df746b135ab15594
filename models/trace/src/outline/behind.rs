//! Regular polygons and stars of which a part is seen: one side tells all of a polygon but how many it has, one tip with the corners
//! beside it all of a star but how many points it has.

use alloc::vec::Vec;
use core::f64::consts::PI;

use dvp_core::Vec2;
use dvp_core::shape::{PathRing, Segment};
use dvp_core::sort;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::figure::{Figure, MOST_NUMBERS, as_f64};
use super::whole::Start;

/// How many sides or points are tried; four sides are a rectangle.
const COUNTS: [usize; 4] = [3, 5, 6, 8];

/// Sides and tips of a path that figures start from: the longest.
const MOST_TRIED: usize = 3;

/// Polygons on the longest sides of a path, and stars on its longest tips.
pub(super) fn starts(ring: &PathRing<f64>, starts: &mut Vec<Start>) {
    let count = ring.points.len();
    if count < 2 || ring.segments.len() != count {
        return;
    }
    let point = |k: usize| Vec2::from(ring.points[k % count]);
    // Around a hole the walk goes the other way.
    let area: f64 = (0..count).map(|k| point(k).cross(point(k + 1))).sum();
    let way = area.signum();
    let is_line = |k: usize| matches!(ring.segments[k % count], Segment::Line);
    let side = |k: usize| point(k + 1) - point(k);
    let mut sides: Vec<usize> = (0..count).filter(|&k| is_line(k)).collect();
    sort::descending(&mut sides, |&k| side(k).length_squared());
    for &k in sides.iter().take(MOST_TRIED) {
        let (from, chord) = (point(k), side(k));
        let Some(along) = chord.normalized() else { continue };
        for sides in COUNTS {
            let half = PI / as_f64(sides);
            let length = chord.length();
            let center = from + chord * 0.5 + along.perp() * (way * 0.5 * length / half.tan());
            push(starts, Figure::Polygon { sides }, center, &[0.5 * length / half.sin()], (from - center).angle());
        }
    }
    // Of a star the sides are lines that meet in a tip, which turns the way that the ring does.
    let is_tip = |k: usize| is_line(k) && is_line(k + 1) && side(k).cross(side(k + 1)) * way > 0.0;
    let mut tips: Vec<usize> = (0..count).filter(|&k| count > 2 && is_tip(k)).collect();
    let length = |k: usize| side(k).length_squared().min(side(k + 1).length_squared());
    sort::descending(&mut tips, |&k| length(k));
    for &k in tips.iter().take(MOST_TRIED) {
        let (before, tip, after) = (point(k), point(k + 1), point(k + 2));
        let middle = before.lerp(after, 0.5);
        let Some(inward) = (middle - tip).normalized() else { continue };
        for points in COUNTS {
            let half = PI / as_f64(points);
            let inner = 0.5 * (after - before).length() / half.sin();
            let outer = (middle - tip).length() + inner * half.cos();
            let center = tip + inward * outer;
            push(starts, Figure::Star { points }, center, &[outer, inner], (tip - center).angle());
        }
    }
}

/// A figure with free numbers: middle, radii, angle.
fn push(starts: &mut Vec<Start>, figure: Figure, center: Vec2<f64>, radii: &[f64], angle: f64) {
    let mut numbers = [center.x, center.y, 0.0, 0.0, 0.0, 0.0];
    numbers[2..2 + radii.len()].copy_from_slice(radii);
    numbers[2 + radii.len()] = angle;
    starts.push((figure, numbers, [true; MOST_NUMBERS]));
}
