//! Walks around what is seen of a layer, and where they follow what hides it.

use alloc::vec;
use alloc::vec::Vec;

use dvp_core::Vec2;

use super::visible::{self, Hidden, Known};
use crate::boundary::Ring;
use crate::partition::OUTSIDE;
use crate::sample::RingSamples;

/// How far (pixels) from a pixel that is wrong the boundary is doubted: half the length of a window, beyond which others were read.
const DOUBTED: f64 = 2.5;

/// Most pixels that are asked which stretch makes them wrong.
const MOST_ASKED: usize = 32;

/// What is seen of boundaries, and what lies along others.
pub(super) fn samples(walks: &[Walk<'_>]) -> Vec<RingSamples> {
    walks.iter().filter(|walk| !walk.is_filled).map(Walk::samples).collect()
}

/// A boundary, and what of it is hidden.
pub(super) struct Walk<'a> {
    pub(super) ring: &'a Ring,
    /// How each of its steps is hidden, if it is.
    pub(super) hidden: Vec<Option<Hidden>>,
    /// Whether it is the boundary of a hole that is taken for none.
    pub(super) is_filled: bool,
    /// What is known of its steps.
    known: Vec<Known>,
}

impl<'a> Walk<'a> {
    /// A hole that is filled by what lies in front of it is none, as long as nothing else is seen in it.
    pub(super) fn new(ring: &'a Ring, hidden: Vec<Option<Hidden>>) -> Self {
        let is_filled = ring.area <= 0.0 && !hidden.contains(&None);
        let known = vec![Known::Read; hidden.len()];
        Self { ring, hidden, is_filled, known }
    }

    /// What is seen of it, and what lies along others.
    pub(super) fn samples(&self) -> RingSamples {
        visible::samples(self.ring, &self.hidden, &self.known)
    }

    /// Believes no more than `known` of what was read near some pixels; whether that is new anywhere.
    fn doubt(&mut self, wrong: &[[usize; 2]], known: Known) -> bool {
        let mut is_new = false;
        for (k, step) in self.ring.steps.iter().enumerate() {
            // Cracks fill what is this layer's own boundary.
            let may_help = match known {
                Known::Filled => self.known[k] == Known::Read && step.sample.is_none() && self.hidden[k].is_none(),
                _ => self.known[k] != known,
            };
            let middle = Ring::middle(step.crack);
            let is_near = |&[x, y]: &[usize; 2]| {
                (Vec2::new(x as f64 + 0.5, y as f64 + 0.5) - middle).length_squared() < DOUBTED * DOUBTED
            };
            if may_help && wrong.iter().any(is_near) {
                self.known[k] = known;
                is_new = true;
            }
        }
        is_new
    }

    /// How far (pixels, squared) its nearest step is from a pixel.
    fn distance_squared(&self, [x, y]: [usize; 2]) -> f64 {
        let at = Vec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let steps = self.ring.steps.iter().map(|step| (Ring::middle(step.crack) - at).length_squared());
        steps.fold(f64::INFINITY, f64::min)
    }

    /// A hole after all, where it is seen.
    fn open(&mut self) {
        self.is_filled = false;
        self.tuck();
    }

    /// Follows what hides it, a little way under it; whether it did not yet.
    fn tuck(&mut self) -> bool {
        let free = self.hidden.iter_mut().filter(|hidden| **hidden == Some(Hidden::Free));
        free.map(|hidden| *hidden = Some(Hidden::Tucked)).count() > 0
    }

    /// The hidden stretch around step `k` follows what hides it, a little way under it; closely, if it did so before.
    fn pin(&mut self, k: usize) {
        let n = self.hidden.len();
        let was = self.hidden[k];
        // Beyond the border is another matter than behind others.
        let is_beyond = |k: usize| self.ring.steps[k].other == OUTSIDE;
        let kind = is_beyond(k);
        let now = (was == Some(Hidden::Free) && !kind).then_some(Hidden::Tucked);
        let belongs = |&at: &usize| self.hidden[at] == was && is_beyond(at) == kind;
        let back = (1..n).map(|j| (k + n - j) % n).take_while(belongs).count();
        let forth = (1..n - back).map(|j| (k + j) % n).take_while(belongs).count();
        for j in 0..=back + forth {
            self.hidden[(k + n - back + j) % n] = now;
        }
    }
}

/// Which of some walks are nearest to pixels that are wrong.
pub(super) fn blamed(walks: &[Walk<'_>], wrong: &[[usize; 2]]) -> Vec<bool> {
    let mut blamed = vec![false; walks.len()];
    for &pixel in wrong {
        let distances = walks.iter().enumerate().map(|(w, walk)| (w, walk.distance_squared(pixel)));
        if let Some((w, _)) = distances.min_by(|a, b| a.1.total_cmp(&b.1)) {
            blamed[w] = true;
        }
    }
    blamed
}

/// Pins what is nearest to every pixel that is wrong; everything if there is no outline at all. Where nothing is left to pin, what was read
/// there is doubted. Whether that changed anything.
pub(super) fn pin(walks: &mut [Walk<'_>], wrong: &[[usize; 2]]) -> bool {
    if wrong.is_empty() {
        let outer = walks.iter_mut().filter(|walk| !walk.is_filled);
        return outer.map(Walk::tuck).fold(false, |any, new| any | new);
    }
    let nearest = |&[x, y]: &[usize; 2]| {
        let at = Vec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let free = walks.iter().enumerate().flat_map(|(w, walk)| {
            let is_open = |&k: &usize| walk.is_filled || matches!(walk.hidden[k], Some(Hidden::Free | Hidden::Tucked));
            let free = (0..walk.hidden.len()).filter(is_open);
            free.map(move |k| (w, k, (Ring::middle(walk.ring.steps[k].crack) - at).length_squared()))
        });
        free.min_by(|a, b| a.2.total_cmp(&b.2)).map(|(w, k, _)| (w, k))
    };
    // Few of many tell as much.
    let every = wrong.len().div_ceil(MOST_ASKED);
    let places = wrong.iter().step_by(every.max(1)).filter_map(nearest);
    let places: Vec<_> = places.map(|(w, k)| (w, k, walks[w].is_filled, walks[w].hidden[k])).collect();
    for &(w, k, was_filled, was) in &places {
        // Once for all that makes the same stretch wrong.
        if walks[w].is_filled {
            walks[w].open();
        } else if !was_filled && walks[w].hidden[k] == was {
            walks[w].pin(k);
        }
    }
    // What no window reads well, corners of three colors and hairs, the pixels themselves tell.
    !places.is_empty() || doubt(walks, wrong, Known::Crack)
}

/// Takes the cracks where no window reads anything near pixels that are wrong, as of short sides; whether that is new anywhere.
pub(super) fn fill(walks: &mut [Walk<'_>], wrong: &[[usize; 2]]) -> bool {
    doubt(walks, wrong, Known::Filled)
}

/// Doubts what was read near pixels; whether that is new anywhere.
fn doubt(walks: &mut [Walk<'_>], wrong: &[[usize; 2]], known: Known) -> bool {
    let outer = walks.iter_mut().filter(|walk| !walk.is_filled);
    outer.map(|walk| walk.doubt(wrong, known)).fold(false, |any, new| any | new)
}
