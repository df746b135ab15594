//! Whether results know what they do not know: failures against doubts, and true poses against stated uncertainties.

use core::f64::consts::TAU;

use anyhow::Result;
use dvp_core::{ImageSize, Object, Real, Scene};
use dvp_fit::Ambiguity;
use serde::Serialize;

use super::judge::Verdict;
use crate::agreement::Agreement;
use dvp_cli::method::Found;
use dvp_cli::paint::Painter;

/// Objects that agree less are not the same; their poses are not compared.
const SAME: f64 = 0.5;

/// What a pose is told by.
pub(super) const PARAMETERS: [&str; 4] = ["x", "y", "log scale", "rotation"];

/// How many true values lie within one and two stated standard deviations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Within {
    pub(super) stated: usize,
    pub(super) one: usize,
    pub(super) two: usize,
}

impl Within {
    fn add(&mut self, off: f64, deviation: f64) {
        self.stated += 1;
        self.one += usize::from(off.abs() <= deviation);
        self.two += usize::from(off.abs() <= 2.0 * deviation);
    }

    fn merge(&mut self, other: Self) {
        self.stated += other.stated;
        self.one += other.one;
        self.two += other.two;
    }

    /// Shares within one and two, if any were stated.
    pub(super) fn shares(self) -> Option<[f64; 2]> {
        let of = |part: usize| f64::of_usize(part) / f64::of_usize(self.stated);
        (self.stated > 0).then(|| [of(self.one), of(self.two)])
    }
}

/// How the true poses of a picture lie in the stated uncertainties, by [`PARAMETERS`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Stated(pub(super) [Within; 4]);

impl Stated {
    /// Compares the poses of objects that are the same. The root of the area within half coverage stands for the scale: an outline farther
    /// out under a profile that is as much narrower is the same. Where shapes are free, so that a pose stands for nothing by itself, the
    /// center of the area stands for the place, and rotations are left out. Outlines that cross themselves have no area to compare: the sum
    /// over their edges counts what they run around twice two times, and what is painted is something else.
    pub(super) fn of(truth: &Scene<f32>, found: &Found, agreement: &Agreement, size: ImageSize) -> Result<Self> {
        let fit = &found.fit;
        let mut stated = Self::default();
        if fit.covariance.is_empty() || fit.scene.objects.len() != found.there.objects.len() {
            return Ok(stated);
        }
        let painter = Painter::default();
        let [truly, drawn] = [painter.draw(truth, size)?, painter.draw(&found.there, size)?];
        let unit = f32::of_usize(size.unit_px());
        let outsets = [truth, &found.there].map(|scene| f64::from(scene.edge.in_pixels(unit).distance(0.5) / unit));
        for (k, pair) in agreement.matches.iter().enumerate() {
            let Some(pair) = pair.filter(|pair| pair.iou >= SAME) else { continue };
            let Some(covariance) = fit.covariance.get(pair.found) else { continue };
            let (true_object, object) = (&truth.objects[k], &found.there.objects[pair.found]);
            let [a, b] = [moments(truly.outline(k), outsets[0]), moments(drawn.outline(pair.found), outsets[1])];
            let is_simple = [truly.outline(k), drawn.outline(pair.found)].into_iter().all(turns_once);
            let growth = is_simple.then(|| 0.5 * (b[2] / a[2]).abs().ln());
            let off = if true_object.shape.efd() == object.shape.efd() {
                let turn = TAU / f64::of_usize(order(fit.ambiguity.iter(), pair.found).max(1));
                let [x, y, rotation] = pose_difference(true_object, object, turn);
                [Some(x), Some(y), growth, Some(rotation)]
            } else {
                [is_simple.then(|| b[0] - a[0]), is_simple.then(|| b[1] - a[1]), growth, None]
            };
            for (i, off) in off.into_iter().enumerate() {
                let deviation = f64::from(covariance[6 * i]).sqrt();
                if let Some(off) = off {
                    stated.0[i].add(off, deviation);
                }
            }
        }
        Ok(stated)
    }
}

/// Symmetry order that is stated for an object, 1 if none is.
fn order<'a>(mut ambiguity: impl Iterator<Item = &'a Ambiguity>, index: usize) -> usize {
    ambiguity
        .find_map(|ambiguity| match *ambiguity {
            Ambiguity::Symmetry { object, order } if object == index => Some(order),
            _ => None,
        })
        .unwrap_or(1)
}

/// Differences of x, y, and rotation modulo `turn`.
fn pose_difference(truth: &Object<f32>, found: &Object<f32>, turn: f64) -> [f64; 3] {
    let [a, b] = [truth, found].map(|object| {
        let pose = &object.pose;
        [pose.translation[0], pose.translation[1], pose.rotation].map(f64::from)
    });
    let turned = (b[2] - a[2]) / turn;
    [b[0] - a[0], b[1] - a[1], (turned - turned.round()) * turn]
}

/// Whether the edges of a closed outline turn once in all, as those of every outline do that does not cross itself.
fn turns_once(outline: &[[f32; 2]]) -> bool {
    let ends = outline.iter().skip(1).chain(outline.first());
    let steps: Vec<[f64; 2]> = outline.iter().zip(ends).map(|(a, b)| [0, 1].map(|c| f64::from(b[c] - a[c]))).collect();
    let steps: Vec<&[f64; 2]> = steps.iter().filter(|step| step[0].hypot(step[1]) > 0.0).collect();
    let next = steps.iter().cycle().skip(1);
    let turn: f64 =
        steps.iter().zip(next).map(|(a, b)| (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])).sum();
    (turn.abs() - TAU).abs() < 0.5 * TAU
}

/// Center of the area of a polygon, and its signed area with a border of width `outset` around it.
fn moments(outline: &[[f32; 2]], outset: f64) -> [f64; 3] {
    let ends = outline.iter().skip(1).chain(outline.first());
    let (mut sums, mut length) = ([0.0; 3], 0.0);
    for (a, b) in outline.iter().zip(ends) {
        let ([ax, ay], [bx, by]) = (a.map(f64::from), b.map(f64::from));
        let cross = ax * by - bx * ay;
        sums[0] += (ax + bx) * cross;
        sums[1] += (ay + by) * cross;
        sums[2] += cross;
        length += (bx - ax).hypot(by - ay);
    }
    let area = sums[2] / 2.0;
    let border = outset * length + core::f64::consts::PI * outset * outset;
    [sums[0] / (6.0 * area), sums[1] / (6.0 * area), area + border * area.signum()]
}

/// Runs by outcome and doubt, and the stated uncertainties of all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub(super) struct Calibration {
    pub(super) failed_doubted: usize,
    pub(super) failed_silently: usize,
    pub(super) succeeded_doubted: usize,
    pub(super) succeeded_surely: usize,
    #[serde(skip)]
    pub(super) stated: [Within; 4],
}

impl Calibration {
    pub(super) fn of<'a>(verdicts: impl IntoIterator<Item = &'a Verdict>) -> Self {
        let mut all = Self::default();
        for verdict in verdicts {
            let counter = match (verdict.failure.is_some(), verdict.is_doubted()) {
                (true, true) => &mut all.failed_doubted,
                (true, false) => &mut all.failed_silently,
                (false, true) => &mut all.succeeded_doubted,
                (false, false) => &mut all.succeeded_surely,
            };
            *counter += 1;
            all.stated.iter_mut().zip(verdict.stated.0).for_each(|(sum, own)| sum.merge(own));
        }
        all
    }
}

impl Calibration {
    /// How many runs there are of each kind: failed and doubted, failed silently, succeeded and doubted, succeeded surely.
    pub(super) fn outcomes(&self) -> [usize; 4] {
        [self.failed_doubted, self.failed_silently, self.succeeded_doubted, self.succeeded_surely]
    }

    /// Adds the runs of another sweep.
    pub(super) fn merge(&mut self, other: &Self) {
        self.failed_doubted += other.failed_doubted;
        self.failed_silently += other.failed_silently;
        self.succeeded_doubted += other.succeeded_doubted;
        self.succeeded_surely += other.succeeded_surely;
        self.stated.iter_mut().zip(other.stated).for_each(|(sum, own)| sum.merge(own));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_by_hand() {
        // A square of side 2 about (3, 4), either way round.
        let square = [[2.0, 3.0], [4.0, 3.0], [4.0, 5.0], [2.0, 5.0]];
        let turned: Vec<[f32; 2]> = square.into_iter().rev().collect();
        for (found, expected) in [(moments(&square, 0.0), [3.0, 4.0, 4.0]), (moments(&turned, 0.0), [3.0, 4.0, -4.0])] {
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        }
        // A border of 1/2 around it has four sides of 2 and the corners of a disk.
        let area = 4.0 + 4.0 + core::f64::consts::FRAC_PI_4;
        for (outline, expected) in [(&square[..], area), (&turned, -area)] {
            assert!((moments(outline, 0.5)[2] - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn outlines_that_cross_themselves_turn_more_than_once() {
        // r = 1 + second cos(angle), run through as often: above 1 it has a loop within.
        let outline = |second: f32, times: f32| -> Vec<[f32; 2]> {
            let point = |i: u16| {
                let angle = f32::from(i) / 64.0 * core::f32::consts::TAU * times;
                let radius = 1.0 + second * angle.cos();
                [radius * angle.cos(), radius * angle.sin()]
            };
            (0..64).map(point).collect()
        };
        assert!(turns_once(&outline(0.0, 1.0)) && turns_once(&outline(0.9, -1.0)));
        assert!(!turns_once(&outline(1.5, 1.0)) && !turns_once(&outline(0.0, 3.0)));
        // Twice the same point is no turn.
        assert!(turns_once(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]]));
    }

    #[test]
    fn shares_are_counted() {
        let mut within = Within::default();
        for off in [-0.5, 0.9, 1.5, -3.0] {
            within.add(off, 1.0);
        }
        assert_eq!(within.shares(), Some([0.5, 0.75]));
        assert_eq!(Within::default().shares(), None);
    }
}
