//! Walks around what is seen of a layer, and where they follow what hides it.

use alloc::vec::Vec;

use dvp_core::Vec2;

use super::visible::{self, Hidden};
use crate::boundary::Ring;
use crate::partition::OUTSIDE;
use crate::sample::RingSamples;

/// Most pixels that are asked which stretch makes them wrong.
const MOST_ASKED: usize = 32;

/// A boundary, and what of it is hidden.
pub(super) struct Walk<'a> {
    pub(super) ring: &'a Ring,
    /// How each of its steps is hidden, if it is.
    pub(super) hidden: Vec<Option<Hidden>>,
}

impl Walk<'_> {
    /// What is seen of it, and what lies along others.
    pub(super) fn samples(&self) -> RingSamples {
        visible::samples(self.ring, &self.hidden)
    }

    /// The hidden stretch around step `k` follows what hides it.
    fn pin(&mut self, k: usize) {
        let n = self.hidden.len();
        let is_free = |hidden: &Option<Hidden>| *hidden == Some(Hidden::Free);
        let back = (0..n).find(|&j| !is_free(&self.hidden[(k + n - j) % n])).unwrap_or(n - 1);
        let forth = (1..n).find(|&j| !is_free(&self.hidden[(k + j) % n])).unwrap_or(1);
        // Beyond the border is another matter than behind others.
        let is_beyond = |k: usize| self.ring.steps[k].other == OUTSIDE;
        let kind = is_beyond(k);
        for j in 0..back.max(1) {
            let at = (k + n - j) % n;
            if is_beyond(at) != kind {
                break;
            }
            self.hidden[at] = None;
        }
        for j in 1..forth {
            let at = (k + j) % n;
            if is_beyond(at) != kind {
                break;
            }
            self.hidden[at] = None;
        }
    }
}

/// Pins what is nearest to every pixel that is wrong; everything if there is no outline at all. Whether there was anything to pin.
pub(super) fn pin(walks: &mut [Walk<'_>], wrong: &[[usize; 2]]) -> bool {
    if wrong.is_empty() {
        let free = walks.iter_mut().flat_map(|walk| &mut walk.hidden).filter(|hidden| **hidden == Some(Hidden::Free));
        return free.map(|hidden| *hidden = None).count() > 0;
    }
    let nearest = |&[x, y]: &[usize; 2]| {
        let at = Vec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let free = walks.iter().enumerate().flat_map(|(w, walk)| {
            let free = (0..walk.hidden.len()).filter(|&k| walk.hidden[k] == Some(Hidden::Free));
            free.map(move |k| (w, k, (Ring::middle(walk.ring.steps[k].crack) - at).length_squared()))
        });
        free.min_by(|a, b| a.2.total_cmp(&b.2)).map(|(w, k, _)| (w, k))
    };
    // Few of many tell as much.
    let every = wrong.len().div_ceil(MOST_ASKED);
    let places: Vec<(usize, usize)> = wrong.iter().step_by(every.max(1)).filter_map(nearest).collect();
    for &(w, k) in &places {
        if walks[w].hidden[k].is_some() {
            walks[w].pin(k);
        }
    }
    !places.is_empty()
}
