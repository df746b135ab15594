//! Which of many points lie inside of rings under the even-odd rule, in a time that grows about linearly.

use alloc::vec::Vec;

use crate::real::Real;

/// A point to be told inside from outside, and whose it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Probe<T, O> {
    pub(super) point: [T; 2],
    pub(super) owner: O,
    /// Whether an odd number of edges were met so far.
    pub(super) inside: bool,
}

impl<T, O> Probe<T, O> {
    /// A point that no edge was held against yet.
    pub(super) fn new(point: [T; 2], owner: O) -> Self {
        Self { point, owner, inside: false }
    }
}

/// Probes from the top down, so that an edge finds those beside it without looking at the others.
#[derive(Clone, Debug, Default)]
pub(super) struct Probes<T, O> {
    probes: Vec<Probe<T, O>>,
}

impl<T: Real, O> Probes<T, O> {
    /// Replaces the probes; keeps the memory.
    pub(super) fn fill(&mut self, probes: impl IntoIterator<Item = Probe<T, O>>) {
        self.probes.clear();
        self.probes.extend(probes);
        self.probes.sort_unstable_by(|a, b| a.point[1].as_f64().total_cmp(&b.point[1].as_f64()));
    }

    /// Holds the edges of a closed ring against the probes whose owner is `held`: those that have an edge to their left
    /// change sides. An edge meets the rows from its upper end on and above its lower end, so that each row meets a ring
    /// an even number of times.
    pub(super) fn cross(&mut self, ring: &[[T; 2]], held: impl Fn(&O) -> bool) {
        let Some(&last) = ring.last() else { return };
        let mut a = last;
        for &b in ring {
            let (upper, lower) = if a[1] <= b[1] { (a, b) } else { (b, a) };
            a = b;
            let first = self.probes.partition_point(|probe| probe.point[1] < upper[1]);
            for probe in &mut self.probes[first..] {
                let [x, y] = probe.point;
                if y >= lower[1] {
                    break;
                }
                let share = (y - upper[1]) / (lower[1] - upper[1]);
                if x > upper[0] + share * (lower[0] - upper[0]) && held(&probe.owner) {
                    probe.inside = !probe.inside;
                }
            }
        }
    }

    /// The probes, from the top down.
    pub(super) fn iter(&self) -> impl Iterator<Item = &Probe<T, O>> {
        self.probes.iter()
    }
}
